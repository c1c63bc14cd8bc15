//! Lines of a text file with their numbers, and numbers of a line.

use super::error::ReadError;
use super::number::{comma, number};
use std::str::FromStr;

pub(super) struct Lines<'a> {
    name: &'a str,
    rest: std::iter::Enumerate<std::str::Lines<'a>>,
    /// 1-based number of the line last taken.
    pub number: usize,
}

impl<'a> Lines<'a> {
    pub fn new(text: &'a str, name: &'a str) -> Self {
        Lines {
            name,
            rest: text.lines().enumerate(),
            number: 0,
        }
    }

    /// Of a file without lines: it makes errors without them.
    pub fn binary(name: &'a str) -> Self {
        Lines::new("", name)
    }

    /// The number of the line last taken, if the file has lines.
    pub fn place(&self) -> Option<usize> {
        Some(self.number).filter(|n| *n > 0)
    }

    /// The next line that is not blank, trimmed.
    pub fn next(&mut self) -> Option<&'a str> {
        for (index, line) in self.rest.by_ref() {
            self.number = index + 1;
            if !line.trim().is_empty() {
                return Some(line.trim());
            }
        }
        None
    }

    /// The line after this one, blank or not, untouched.
    pub fn next_raw(&mut self) -> Option<&'a str> {
        let (index, line) = self.rest.next()?;
        self.number = index + 1;
        Some(line)
    }

    /// The next line, which must exist.
    pub fn expect(&mut self, what: &str) -> Result<&'a str, ReadError> {
        self.next()
            .ok_or_else(|| self.error(format!("the file ends where {what} should follow")))
    }

    pub fn error(&self, message: impl Into<String>) -> ReadError {
        self.error_where(self.place(), message)
    }

    pub fn error_at(&self, line: usize, message: impl Into<String>) -> ReadError {
        self.error_where(Some(line), message)
    }

    pub fn error_where(&self, line: Option<usize>, message: impl Into<String>) -> ReadError {
        ReadError {
            file: self.name.to_string(),
            line,
            message: message.into(),
        }
    }

    pub fn parse<T: FromStr>(&self, text: Option<&str>, what: &str) -> Result<T, ReadError> {
        let text = text
            .ok_or_else(|| self.error(format!("expected {what}, the line ends")))?
            .trim();
        text.parse().map_err(|_| self.unexpected(text, what))
    }

    fn unexpected(&self, text: &str, what: &str) -> ReadError {
        self.error(format!("expected {what}, found `{text}`{}", comma(text)))
    }

    /// A number that is neither NaN nor infinite.
    pub fn finite(&self, text: Option<&str>, what: &str) -> Result<f64, ReadError> {
        let text: String = self.parse(text, what)?;
        let value = number(&text).ok_or_else(|| self.unexpected(&text, what))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(format!("{what} is {value}")))
        }
    }
}
