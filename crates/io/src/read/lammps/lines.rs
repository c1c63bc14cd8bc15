//! Lines and numbers of data files and dumps.

use std::io::{BufRead, Read};

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

/// Characters of a line.
const LONGEST_LINE: u64 = 1 << 20;

/// Lines of a file with their numbers, for messages.
pub struct Lines<R> {
    reader: R,
    pub path: String,
    pub number: usize,
    pub text: String,
}

impl<R: BufRead> Lines<R> {
    pub fn new(reader: R, path: &str) -> Self {
        Lines {
            reader,
            path: path.to_string(),
            number: 0,
            text: String::new(),
        }
    }

    /// The next line without its comment; `None` at the end of the file.
    pub fn advance(&mut self) -> Result<Option<&str>> {
        self.text.clear();
        self.number += 1;
        let mut raw = Vec::new();
        let mut reader = (&mut self.reader).take(LONGEST_LINE);
        match reader.read_until(b'\n', &mut raw) {
            Ok(0) => return Ok(None),
            Ok(n) if n as u64 == LONGEST_LINE && raw.last() != Some(&b'\n') => {
                return Err(self.fail(format!(
                    "this line is longer than {LONGEST_LINE} characters (binary file?)"
                )));
            }
            Ok(_) => {}
            Err(e) => {
                return Err(Box::new(FileError {
                    path: self.path.clone(),
                    line: None,
                    message: format!("cannot read {}: {e}", self.path),
                    help: None,
                }));
            }
        }
        match std::str::from_utf8(&raw) {
            Ok(t) => self.text.push_str(t.trim_end()),
            Err(_) => return Err(self.fail("this line is not text (binary or compressed file?)")),
        }
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
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(format!("`{word}` is not a finite number")),
        Err(_) => Err(format!("expected a number, found `{word}`")),
    }
}
