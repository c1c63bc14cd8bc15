//! A mistake in a file.

use std::path::Path;

/// What is wrong in a file of points.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}{}: {message}", line.map_or(String::new(), |l| format!(":{l}")))]
pub struct ReadError {
    pub file: String,
    /// 1-based; `None` when no line is to blame.
    pub line: Option<usize>,
    pub message: String,
}

impl ReadError {
    /// Of the file as a whole.
    pub(crate) fn file(path: &Path, message: String) -> ReadError {
        ReadError {
            file: path.display().to_string(),
            line: None,
            message,
        }
    }
}
