//! Lines and numbers of data files and dumps.

use crate::read::encoding::{Bad, next_line};
use crate::read::number::{comma, number};
use std::io::BufRead;

/// What is wrong in a file, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{path}:{}: {message}", .line.as_ref().map_or(0, |l| l.0))]
pub struct FileError {
    pub path: String,
    /// Number (from 1) and text of the line; `None` where the file itself is to blame.
    pub line: Option<(usize, String)>,
    pub message: String,
    pub help: Option<String>,
}

/// Boxed: errors are rare, results are not.
pub type Result<T> = std::result::Result<T, Box<FileError>>;

impl FileError {
    #[must_use]
    pub fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Self> {
        self.help = Some(help.into());
        self
    }
}

/// Lines of a file with their numbers, for messages.
pub struct Lines<R> {
    reader: R,
    pub path: String,
    pub number: usize,
    pub text: String,
    /// Bytes of the line.
    raw: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    pub fn new(reader: R, path: &str) -> Self {
        Lines {
            reader,
            path: path.to_string(),
            number: 0,
            text: String::new(),
            raw: Vec::new(),
        }
    }

    /// The next line without its comment; `None` at the end of the file.
    pub fn advance(&mut self) -> Result<Option<&str>> {
        self.number += 1;
        let number = self.number;
        match next_line(&mut self.reader, number, &mut self.raw, &mut self.text) {
            Ok(true) => {}
            Ok(false) => return Ok(None),
            Err(Bad::Text(why)) => return Err(self.fail(why)),
            Err(Bad::Read(e)) => {
                return Err(Box::new(FileError {
                    path: self.path.clone(),
                    line: None,
                    message: format!("cannot read {}: {e}", self.path),
                    help: None,
                }));
            }
        }
        self.text.truncate(self.text.trim_end().len());
        Ok(Some(self.text.split('#').next().unwrap_or("").trim()))
    }

    /// A mistake in the line last taken.
    pub fn fail(&self, message: impl Into<String>) -> Box<FileError> {
        self.fail_at(self.number, &self.text, message)
    }

    /// A mistake in another line.
    pub fn fail_at(&self, number: usize, text: &str, message: impl Into<String>) -> Box<FileError> {
        Box::new(FileError {
            path: self.path.clone(),
            line: Some((number, text.to_string())),
            message: message.into(),
            help: None,
        })
    }
}

/// A finite number.
pub fn finite(word: &str) -> std::result::Result<f64, String> {
    match number(word) {
        Some(x) if x.is_finite() => Ok(x),
        Some(_) => Err(format!("`{word}` is not a finite number")),
        None => Err(format!("expected a number, found `{word}`{}", comma(word))),
    }
}
