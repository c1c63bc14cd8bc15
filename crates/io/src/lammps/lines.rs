//! Lines and numbers of data files and dumps.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::error::{Problem, Result};

/// Lines of a file with their numbers, for messages.
pub(super) struct Lines<R> {
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
    pub fn next(&mut self) -> Result<Option<&str>> {
        self.text.clear();
        self.number += 1;
        let mut raw = Vec::new();
        match self.reader.read_until(b'\n', &mut raw) {
            Ok(0) => return Ok(None),
            Ok(_) => {}
            Err(e) => return Err(Problem::new(format!("cannot read {}: {e}", self.path))),
        }
        match std::str::from_utf8(&raw) {
            Ok(t) => self.text.push_str(t.trim_end()),
            Err(_) => return Err(self.fail("this line is not text (binary or compressed file?)")),
        }
        Ok(Some(self.text.split('#').next().unwrap_or("").trim()))
    }

    pub fn fail(&self, message: impl Into<String>) -> Box<Problem> {
        Problem::in_file(&self.path, self.number, &self.text, message)
    }
}

/// A finite number.
pub(super) fn finite(word: &str) -> std::result::Result<f64, String> {
    match word.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(format!("`{word}` is not a finite number")),
        Err(_) => Err(format!("expected a number, found `{word}`")),
    }
}

/// Opens a text file.
pub(super) fn open(path: &Path, shown: &str) -> Result<BufReader<File>> {
    File::open(path)
        .map(BufReader::new)
        .map_err(|e| Problem::new(format!("cannot open {shown}: {e}")))
}
