//! Bytes of a binary file of gmsh: numbers, lines, sections.

use crate::read::error::ReadError;
use crate::read::lines::Lines;

pub(super) struct Bytes<'a> {
    pub rest: &'a [u8],
    /// The file has its lowest byte last.
    pub swapped: bool,
    pub lines: Lines<'a>,
}

impl<'a> Bytes<'a> {
    pub fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], ReadError> {
        match self.rest.split_at_checked(count) {
            Some((head, rest)) => {
                self.rest = rest;
                Ok(head)
            }
            None => Err(self
                .lines
                .error(format!("the file ends where {what} should follow"))),
        }
    }

    fn word<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ReadError> {
        let mut word = [0; N];
        word.copy_from_slice(self.take(N, what)?);
        if self.swapped {
            word.reverse();
        }
        Ok(word)
    }

    pub fn int(&mut self, what: &str) -> Result<i32, ReadError> {
        Ok(i32::from_le_bytes(self.word(what)?))
    }

    /// A whole number that is not negative.
    pub fn unsigned(&mut self, what: &str) -> Result<u64, ReadError> {
        let value = self.int(what)?;
        u64::try_from(value).map_err(|_| self.lines.error(format!("{what} is {value}")))
    }

    /// gmsh's `size_t`.
    pub fn size(&mut self, what: &str) -> Result<u64, ReadError> {
        Ok(u64::from_le_bytes(self.word(what)?))
    }

    pub fn point(&mut self) -> Result<[f64; 3], ReadError> {
        let mut x = [0.0; 3];
        for c in &mut x {
            *c = f64::from_le_bytes(self.word("a coordinate")?);
        }
        Ok(x)
    }

    pub fn line(&mut self, what: &str) -> Result<&'a str, ReadError> {
        let end = self.rest.iter().position(|b| *b == b'\n');
        let end = end.ok_or_else(|| {
            self.lines
                .error(format!("the file ends where {what} should follow"))
        })?;
        let line = self.take(end, what)?;
        self.rest = &self.rest[1..];
        let line = std::str::from_utf8(line).map(str::trim);
        line.map_err(|_| {
            self.lines
                .error(format!("expected {what}, found bytes that are no text"))
        })
    }

    /// The next line that is not blank; `None` at the end.
    pub fn section(&mut self) -> Result<Option<&'a str>, ReadError> {
        while !self.rest.is_empty() {
            let line = match self.rest.contains(&b'\n') {
                true => self.line("a section")?,
                false => std::str::from_utf8(std::mem::take(&mut self.rest))
                    .unwrap_or("?")
                    .trim(),
            };
            if !line.is_empty() {
                return Ok(Some(line));
            }
        }
        Ok(None)
    }

    pub fn end(&mut self, closing: &str) -> Result<(), ReadError> {
        match self.section()? {
            Some(line) if line == closing => Ok(()),
            Some(line) => Err(self
                .lines
                .error(format!("expected {closing}, found `{line}`"))),
            None => Err(self
                .lines
                .error(format!("the file ends where {closing} should follow"))),
        }
    }
}
