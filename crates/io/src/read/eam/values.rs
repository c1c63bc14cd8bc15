//! Numbers of a table, any number of them per line, with exponents as Fortran writes them.

use super::super::error::ReadError;
use super::super::lines::Lines;
use super::super::number::number;

/// Lines and, between them, numbers one after another.
pub(super) struct Values<'a> {
    pub lines: Lines<'a>,
    /// What is left of the line last taken.
    rest: std::str::SplitWhitespace<'a>,
}

impl<'a> Values<'a> {
    pub fn new(text: &'a str, name: &'a str) -> Self {
        Values {
            lines: Lines::new(text, name),
            rest: "".split_whitespace(),
        }
    }

    fn next_line(&mut self) -> Option<&'a str> {
        loop {
            let line = self.lines.next()?.split('#').next().unwrap_or("").trim();
            if !line.is_empty() {
                return Some(line);
            }
        }
    }

    fn next_word(&mut self) -> Option<&'a str> {
        loop {
            if let Some(word) = self.rest.next() {
                return Some(word);
            }
            self.rest = self.next_line()?.split_whitespace();
        }
    }

    /// A line of its own, after the tables before it: `what` says what it should hold.
    pub fn header(&mut self, what: &str) -> Result<Vec<&'a str>, ReadError> {
        if let Some(word) = self.rest.next() {
            return Err(self.lines.error(format!(
                "`{word}` stands after the last value of a table, where {what} should follow on a line of its own: do Nrho and Nr in the header fit the tables?"
            )));
        }
        match self.next_line() {
            Some(line) => Ok(line.split_whitespace().collect()),
            None => Err(self
                .lines
                .error(format!("the file ends where {what} should follow"))),
        }
    }

    /// `count` finite numbers.
    pub fn table(&mut self, what: &str, count: usize) -> Result<Vec<f64>, ReadError> {
        // the header is not trusted with memory
        let mut values = Vec::with_capacity(count.min(1 << 16));
        for k in 0..count {
            let Some(word) = self.next_word() else {
                return Err(self.lines.error(format!(
                    "the file ends within the table of {what}: {} of its {count} values are missing; is the file complete?",
                    count - k
                )));
            };
            let value = self.number(word, || format!("value {} of {count} of {what}", k + 1))?;
            values.push(value);
        }
        Ok(values)
    }

    /// The number that a word of the current line is.
    pub fn number(&self, word: &str, what: impl Fn() -> String) -> Result<f64, ReadError> {
        match number(word) {
            Some(x) if x.is_finite() => Ok(x),
            Some(x) => Err(self.lines.error(format!("{} is {x}", what()))),
            None => Err(self.lines.error(format!(
                "expected {}, a number such as 1.5E-3, found `{word}`: is a line missing, or do Nrho and Nr in the header not fit?",
                what()
            ))),
        }
    }

    /// A number of the header that must be positive.
    pub fn positive(&self, word: Option<&&str>, what: &str) -> Result<f64, ReadError> {
        let word =
            word.ok_or_else(|| self.lines.error(format!("expected {what}, the line ends")))?;
        let value = self.number(word, || what.to_string())?;
        if value > 0.0 {
            Ok(value)
        } else {
            Err(self
                .lines
                .error(format!("{what} must be positive, found {word}")))
        }
    }

    /// A count of the header, at least `least`.
    pub fn count(&self, word: Option<&&str>, what: &str, least: usize) -> Result<usize, ReadError> {
        let value: usize = self.lines.parse(word.copied(), what)?;
        if value >= least && value <= u32::MAX as usize {
            Ok(value)
        } else {
            Err(self.lines.error(format!(
                "{what} must be between {least} and {}, found {value}",
                u32::MAX
            )))
        }
    }

    /// Nothing but comments may follow.
    pub fn end(&mut self, hint: &str) -> Result<(), ReadError> {
        match self.next_word() {
            None => Ok(()),
            Some(word) => Err(self.lines.error(format!(
                "`{word}` stands after the last table: the counts in the header do not fit the tables{hint}"
            ))),
        }
    }
}
