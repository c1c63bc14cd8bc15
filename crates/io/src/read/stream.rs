//! Lines of a file one at a time: trajectories do not fit in memory.

use super::encoding::{Bad, next_line};
use super::error::ReadError;
use super::number::{comma, number};
use super::source;
use flate2::bufread::MultiGzDecoder;
use std::io::{BufRead, BufReader};
use std::path::Path;

pub(super) struct Stream<R> {
    reader: R,
    name: String,
    /// 1-based number of the line last taken.
    number: usize,
    line: String,
    /// Bytes of the line.
    raw: Vec<u8>,
    packed: bool,
}

/// Of a file, packed or not.
pub(super) type Source = Box<dyn BufRead + Send>;

/// What a gzip file begins with.
const GZIP: [u8; 2] = [0x1f, 0x8b];
const ROOM: usize = 1 << 18;

impl Stream<Source> {
    /// A text, or a text packed by gzip, which its first bytes tell.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let name = path.display().to_string();
        let wrong = |e: std::io::Error| ReadError {
            file: name.clone(),
            line: None,
            message: format!("cannot read it: {e}"),
        };
        let mut file = BufReader::with_capacity(ROOM, source::open(path).map_err(wrong)?);
        let packed = file.fill_buf().map_err(wrong)?.starts_with(&GZIP);
        let source: Source = match packed {
            true => Box::new(BufReader::with_capacity(ROOM, MultiGzDecoder::new(file))),
            false => Box::new(file),
        };
        let mut stream = Stream::new(source, &name);
        stream.packed = packed;
        Ok(stream)
    }
}

impl<R: BufRead> Stream<R> {
    pub fn new(reader: R, name: &str) -> Self {
        Stream {
            reader,
            name: name.to_string(),
            number: 0,
            line: String::new(),
            raw: Vec::new(),
            packed: false,
        }
    }

    /// The next line, without its end; `None` at the end of the file.
    pub fn next(&mut self) -> Result<Option<&str>, ReadError> {
        self.number += 1;
        let number = self.number;
        match next_line(&mut self.reader, number, &mut self.raw, &mut self.line) {
            Ok(true) => Ok(Some(self.line.trim_end())),
            Ok(false) => {
                self.number -= 1;
                Ok(None)
            }
            Err(Bad::Text(why)) => Err(self.error(why)),
            Err(Bad::Read(e)) => {
                let why = match self.packed {
                    true => " (the packed file is damaged or cut off)",
                    false => "",
                };
                Err(self.error(format!("cannot read this line: {e}{why}")))
            }
        }
    }

    /// The next line, which must exist; `missing` says what ends too early.
    pub fn expect(&mut self, missing: impl FnOnce() -> String) -> Result<&str, ReadError> {
        if self.next()?.is_none() {
            return Err(self.error(format!("the file ends: {}", missing())));
        }
        Ok(self.line.trim_end())
    }

    pub fn current(&self) -> &str {
        self.line.trim_end()
    }

    pub fn error(&self, message: impl Into<String>) -> ReadError {
        ReadError {
            file: self.name.clone(),
            line: Some(self.number),
            message: message.into(),
        }
    }

    /// A problem of the whole file.
    pub fn whole(&self, message: impl Into<String>) -> ReadError {
        ReadError {
            line: None,
            ..self.error(message)
        }
    }

    /// Room for so many atoms of so many columns, before the first is read: the header is not trusted with memory.
    pub fn room(&self, atoms: usize, columns: usize) -> Result<(), ReadError> {
        // rows as they are read and sorted, and the columns that are made of them
        let bytes = atoms as f64 * (250.0 + 16.0 * columns as f64);
        source::room(&format!("a frame of {atoms} atoms"), bytes)
            .map_err(|e| self.error(e.to_string()))
    }

    pub fn finite(&self, word: &str, what: &str) -> Result<f64, ReadError> {
        match number(word) {
            Some(x) if x.is_finite() => Ok(x),
            Some(x) => Err(self.error(format!("{what} is {x}"))),
            None => {
                let hint = comma(word);
                Err(self.error(format!("expected {what}, a number, found `{word}`{hint}")))
            }
        }
    }

    pub fn count(&self, word: &str, what: &str) -> Result<usize, ReadError> {
        match word.trim().parse::<u32>() {
            Ok(n) => Ok(n as usize),
            Err(_) => Err(self.error(format!("expected {what}, a whole number, found `{word}`"))),
        }
    }
}
