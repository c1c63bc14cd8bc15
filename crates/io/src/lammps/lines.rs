//! Lines and numbers of data files and dumps.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::error::{Problem, Result};

/// Characters of a line.
const LONGEST_LINE: u64 = 1 << 20;
/// Bytes of a script, or of a file of values.
const LARGEST_TEXT: u64 = 16 << 20;

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
        let mut reader = (&mut self.reader).take(LONGEST_LINE);
        match reader.read_until(b'\n', &mut raw) {
            Ok(0) => return Ok(None),
            Ok(n) if n as u64 == LONGEST_LINE && raw.last() != Some(&b'\n') => {
                return Err(self.fail(format!(
                    "this line is longer than {LONGEST_LINE} characters (binary file?)"
                )));
            }
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

/// Opens a text file. Devices and pipes may have no end: they are refused.
pub(super) fn open(path: &Path, shown: &str) -> Result<BufReader<File>> {
    let cannot = |e| Problem::new(format!("cannot open {shown}: {e}"));
    let file = std::fs::metadata(path).map_err(cannot)?;
    if !file.is_file() {
        return Err(Problem::new(format!("{shown} is not a file"))
            .help("a folder, device or pipe cannot be read: write the name of a file"));
    }
    File::open(path).map(BufReader::new).map_err(cannot)
}

/// The text of a whole file.
pub(super) fn text(path: &Path, shown: &str) -> Result<String> {
    let mut bytes = Vec::new();
    let read = open(path, shown)?
        .take(LARGEST_TEXT + 1)
        .read_to_end(&mut bytes);
    read.map_err(|e| Problem::new(format!("cannot read {shown}: {e}")))?;
    if bytes.len() as u64 > LARGEST_TEXT {
        return Err(Problem::new(format!(
            "{shown} is larger than {} MiB, which no script is",
            LARGEST_TEXT >> 20
        )));
    }
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
