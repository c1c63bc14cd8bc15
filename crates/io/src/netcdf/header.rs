//! A header as bytes.

use std::io::{self, Write};

use super::format::{ATTRIBUTES, DIMENSIONS, Header, VARIABLES, Version, filled};
use super::value::{Attribute, Type};

/// Gives every variable its place: what is not recorded first, in order, then those of a record. Answers the length of the file
/// without records.
///
/// # Errors
/// `InvalidInput`: something is larger than this version of the format can say.
pub fn lay_out(header: &mut Header) -> io::Result<u64> {
    let too_large = || {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            "more numbers than the format can hold",
        )
    };
    let mut counted = Counted(0);
    header.write(&mut counted)?;
    let mut at = counted.0;
    for recorded in [false, true] {
        let start = at;
        for v in 0..header.variables.len() {
            if header.is_recorded(&header.variables[v]) != recorded {
                continue;
            }
            header.variables[v].begin = at;
            let bytes = header.bytes(&header.variables[v]);
            let bytes = bytes.and_then(filled).ok_or_else(too_large)?;
            if !header.version.holds(bytes) {
                return Err(too_large());
            }
            at = at.checked_add(bytes).ok_or_else(too_large)?;
        }
        if recorded {
            return Ok(start);
        }
    }
    Ok(at)
}

impl Version {
    /// Can it say so many bytes of a variable?
    pub(super) fn holds(self, bytes: u64) -> bool {
        match self {
            Version::Offset64 => bytes <= u64::from(u32::MAX) - 3,
            Version::Data64 => bytes < 1 << 62,
        }
    }
}

/// Counts bytes.
struct Counted(u64);

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Header {
    /// Where the number of records stands, and its bytes: what a writer of records puts there when one is whole.
    pub fn records_mark(&self, records: u64) -> (u64, Vec<u8>) {
        let mut bytes = vec![];
        // a vector takes everything
        let _ = self.count(&mut bytes, records);
        (4, bytes)
    }

    /// # Errors
    /// Those of `w`.
    pub fn write<W: Write>(&self, w: &mut W) -> io::Result<()> {
        w.write_all(b"CDF")?;
        w.write_all(&[self.version.byte()])?;
        self.count(w, self.records)?;
        self.list(w, DIMENSIONS, self.dimensions.len())?;
        for (name, length) in &self.dimensions {
            self.name(w, name)?;
            self.count(w, *length)?;
        }
        self.attributes(w, &self.attributes)?;
        self.list(w, VARIABLES, self.variables.len())?;
        for v in &self.variables {
            self.name(w, &v.name)?;
            self.count(w, v.dimensions.len() as u64)?;
            for d in &v.dimensions {
                self.count(w, *d as u64)?;
            }
            self.attributes(w, &v.attributes)?;
            w.write_all(&v.kind.number().to_be_bytes())?;
            let bytes = self.bytes(v).and_then(filled).unwrap_or(u64::MAX);
            self.count(w, bytes)?;
            w.write_all(&v.begin.to_be_bytes())?;
        }
        Ok(())
    }

    fn count<W: Write>(&self, w: &mut W, n: u64) -> io::Result<()> {
        match self.version.count() {
            4 => w.write_all(&(n as u32).to_be_bytes()),
            _ => w.write_all(&n.to_be_bytes()),
        }
    }

    /// What a list begins with; an empty one has no mark.
    fn list<W: Write>(&self, w: &mut W, mark: u32, length: usize) -> io::Result<()> {
        let mark = if length == 0 { 0 } else { mark };
        w.write_all(&mark.to_be_bytes())?;
        self.count(w, length as u64)
    }

    fn name<W: Write>(&self, w: &mut W, name: &str) -> io::Result<()> {
        self.count(w, name.len() as u64)?;
        padded(w, name.as_bytes())
    }

    fn attributes<W: Write>(&self, w: &mut W, all: &[(String, Attribute)]) -> io::Result<()> {
        self.list(w, ATTRIBUTES, all.len())?;
        for (name, value) in all {
            self.name(w, name)?;
            let (kind, length, bytes) = match value {
                Attribute::Text(text) => (Type::Char, text.len(), text.clone().into_bytes()),
                Attribute::Ints(v) => {
                    let bytes = v.iter().flat_map(|x| x.to_be_bytes());
                    (Type::Int, v.len(), bytes.collect())
                }
                Attribute::Floats(v) => {
                    let bytes = v.iter().flat_map(|x| x.to_be_bytes());
                    (Type::Float, v.len(), bytes.collect())
                }
            };
            w.write_all(&kind.number().to_be_bytes())?;
            self.count(w, length as u64)?;
            padded(w, &bytes)?;
        }
        Ok(())
    }
}

/// Bytes filled up to a multiple of 4.
fn padded<W: Write>(w: &mut W, bytes: &[u8]) -> io::Result<()> {
    w.write_all(bytes)?;
    let end = bytes.len().next_multiple_of(4) - bytes.len();
    w.write_all(&[0; 4][..end])
}
