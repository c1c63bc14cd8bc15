//! Bytes as a header, and the numbers of its variables. Nothing is reserved by what a file promises: what it has not, it cannot ask
//! for.

use super::format::{ATTRIBUTES, DIMENSIONS, Header, VARIABLES, Variable, Version};
use super::value::{Attribute, Type, fixed};

/// A file at hand.
pub struct Reader<'a> {
    pub header: Header,
    bytes: &'a [u8],
}

/// Bytes of a name (NC_MAX_NAME of netCDF).
const NAME: u64 = 256;
/// How netCDF-4 files begin.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

impl<'a> Reader<'a> {
    /// # Errors
    /// What is wrong with the header, in words.
    pub fn new(bytes: &'a [u8]) -> Result<Self, String> {
        if bytes.starts_with(HDF5) {
            return Err(
                "it is netCDF-4 (HDF5), which is not read: write it as netCDF-3, `nccopy -k cdf5 OLD NEW` or `ncks -3 OLD NEW`".into(),
            );
        }
        let version = bytes
            .strip_prefix(b"CDF")
            .and_then(|rest| rest.first())
            .ok_or("it is no netCDF file: it does not begin with CDF")?;
        let version = Version::ALL.iter().find(|(byte, _)| byte == version);
        let (_, version) =
            version.ok_or("it is netCDF of an unknown version; 1, 2 and 5 are read")?;
        let mut head = Head {
            rest: &bytes[4..],
            version: *version,
        };
        Ok(Reader {
            header: head.header()?,
            bytes,
        })
    }

    /// Bytes of a variable; of one that is recorded in a record (from 0).
    fn of(&self, v: &Variable, record: Option<u64>) -> Result<&'a [u8], String> {
        let name = &v.name;
        let short = || format!("the file is cut short: {name} is not whole");
        if self.header.is_recorded(v) != record.is_some() {
            return Err(match record {
                Some(_) => format!("{name} should be recorded, one value after another in time"),
                None => format!("{name} should have one value, not one of each record"),
            });
        }
        let place = || {
            let step = self.header.record_bytes()?;
            let begin = v
                .begin
                .checked_add(step.checked_mul(record.unwrap_or(0))?)?;
            let end = begin.checked_add(self.header.bytes(v)?)?;
            self.bytes
                .get(usize::try_from(begin).ok()?..usize::try_from(end).ok()?)
        };
        place().ok_or_else(short)
    }

    fn numbers<T>(
        &self,
        name: &str,
        record: Option<u64>,
        what: &str,
        read: impl Fn(Type, &[u8]) -> Option<T>,
    ) -> Result<Option<Vec<T>>, String> {
        let Some(v) = self.header.find(name) else {
            return Ok(None);
        };
        let bytes = self.of(v, record)?.chunks_exact(v.kind.bytes());
        let all: Option<Vec<T>> = bytes.map(|b| read(v.kind, b)).collect();
        match all {
            Some(all) => Ok(Some(all)),
            None => Err(format!("{name} should hold {what}, it holds {:?}", v.kind)),
        }
    }

    /// Numbers with a point; `None`: there is no such variable.
    ///
    /// # Errors
    /// It is of another type, is recorded, or the file is cut short.
    pub fn floats(&self, name: &str) -> Result<Option<Vec<f64>>, String> {
        self.numbers(name, None, "numbers with a point", Type::float)
    }

    /// Whole numbers, likewise.
    pub fn wholes(&self, name: &str) -> Result<Option<Vec<i64>>, String> {
        self.numbers(name, None, "whole numbers", Type::whole)
    }

    /// Those of one record (from 0) of a recorded variable: only tests look into results.
    #[cfg(test)]
    pub fn record(&self, name: &str, record: u64) -> Result<Option<Vec<f64>>, String> {
        self.numbers(name, Some(record), "numbers with a point", Type::float)
    }

    /// Texts, the last dimension being that of letters; they end at the first zero, blanks at the end do not count.
    ///
    /// # Errors
    /// It is no text, or the file is cut short.
    pub fn texts(&self, name: &str) -> Result<Option<Vec<String>>, String> {
        let Some(v) = self.header.find(name) else {
            return Ok(None);
        };
        if v.kind != Type::Char {
            return Err(format!("{name} should hold text, it holds {:?}", v.kind));
        }
        let bytes = self.of(v, None)?;
        let width = self.header.shape(v).last().copied().unwrap_or(1);
        let Some(width) = usize::try_from(width).ok().filter(|w| *w > 0) else {
            return Ok(Some(vec![]));
        };
        Ok(Some(bytes.chunks_exact(width).map(text).collect()))
    }
}

fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end])
        .trim_end()
        .to_string()
}

struct Head<'a> {
    rest: &'a [u8],
    version: Version,
}

impl<'a> Head<'a> {
    fn take(&mut self, count: u64) -> Result<&'a [u8], String> {
        let split = usize::try_from(count).ok();
        match split.and_then(|n| self.rest.split_at_checked(n)) {
            Some((head, rest)) => {
                self.rest = rest;
                Ok(head)
            }
            None => Err("the file is cut short: its header is not whole".into()),
        }
    }

    /// Bytes that are filled up to a multiple of 4.
    fn padded(&mut self, count: u64) -> Result<&'a [u8], String> {
        let bytes = self.take(count)?;
        self.take(count.next_multiple_of(4) - count)?;
        Ok(bytes)
    }

    fn word(&mut self) -> Result<u32, String> {
        Ok(u32::from_be_bytes(fixed(self.take(4)?)))
    }

    fn long(&mut self, bytes: usize) -> Result<u64, String> {
        Ok(match bytes {
            4 => self.word()?.into(),
            _ => u64::from_be_bytes(fixed(self.take(8)?)),
        })
    }

    fn count(&mut self) -> Result<u64, String> {
        self.long(self.version.count())
    }

    fn name(&mut self) -> Result<String, String> {
        let length = self.count()?;
        if length > NAME {
            return Err(format!(
                "the header is damaged: a name of {length} bytes, of which there are at most {NAME}"
            ));
        }
        let name = String::from_utf8_lossy(self.padded(length)?).into_owned();
        match name.contains(char::is_control) {
            true => Err(format!(
                "the header is damaged: the name {name:?} has control characters"
            )),
            false => Ok(name),
        }
    }

    /// How many things a list has; an absent one has no mark.
    fn list(&mut self, mark: u32, what: &str) -> Result<u64, String> {
        let (found, count) = (self.word()?, self.count()?);
        if found == mark || (found == 0 && count == 0) {
            return Ok(count);
        }
        Err(format!("the header is damaged: no list of {what}"))
    }

    fn kind(&mut self) -> Result<Type, String> {
        let number = self.word()?;
        Type::of(number).ok_or_else(|| format!("the header is damaged: type {number} is unknown"))
    }

    fn attributes(&mut self) -> Result<Vec<(String, Attribute)>, String> {
        let mut all = vec![];
        for _ in 0..self.list(ATTRIBUTES, "attributes")? {
            let name = self.name()?;
            let (kind, count) = (self.kind()?, self.count()?);
            let bytes = count.checked_mul(kind.bytes() as u64);
            let bytes = self.padded(bytes.unwrap_or(u64::MAX >> 1))?;
            let words = bytes.chunks_exact(4);
            let value = match kind {
                Type::Char => Attribute::Text(text(bytes)),
                Type::Int => Attribute::Ints(words.map(|b| i32::from_be_bytes(fixed(b))).collect()),
                Type::Float => {
                    Attribute::Floats(words.map(|b| f32::from_be_bytes(fixed(b))).collect())
                }
                Type::Byte
                | Type::Short
                | Type::Double
                | Type::UByte
                | Type::UShort
                | Type::UInt
                | Type::Int64
                | Type::UInt64 => Attribute::Other,
            };
            all.push((name, value));
        }
        Ok(all)
    }

    fn header(&mut self) -> Result<Header, String> {
        let mut header = Header::new(self.version);
        header.records = self.count()?;
        for _ in 0..self.list(DIMENSIONS, "dimensions")? {
            let entry = (self.name()?, self.count()?);
            header.dimensions.push(entry);
        }
        if header.dimensions.iter().filter(|d| d.1 == 0).count() > 1 {
            // a length of 0 is that of records, and nothing else can be empty
            return Err("the header is damaged: two dimensions of records".into());
        }
        header.attributes = self.attributes()?;
        for _ in 0..self.list(VARIABLES, "variables")? {
            let name = self.name()?;
            let mut dimensions = vec![];
            for n in 0..self.count()? {
                let d = self.count()?;
                let known = usize::try_from(d).ok();
                match known.and_then(|d| Some((d, header.dimensions.get(d)?.1))) {
                    Some((_, 0)) if n > 0 => {
                        return Err(format!(
                            "{name}: only the first dimension can be that of records"
                        ));
                    }
                    Some((d, _)) => dimensions.push(d),
                    None => return Err(format!("{name}: dimension {d} does not exist")),
                }
            }
            let attributes = self.attributes()?;
            let kind = self.kind()?;
            // follows from the dimensions, and is too small a number for large variables
            self.count()?;
            header.variables.push(Variable {
                name,
                kind,
                dimensions,
                attributes,
                begin: self.long(self.version.offset())?,
            });
        }
        Ok(header)
    }
}
