//! Versions, dimensions and variables of a file.

use super::value::Attribute;
use super::value::Type;

/// What the fourth byte of a file says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// CDF-2: offsets of 64 bits.
    Offset64,
    /// CDF-5: numbers of things have 64 bits, too.
    Data64,
}

impl Version {
    pub(super) fn byte(self) -> u8 {
        match self {
            Version::Offset64 => 2,
            Version::Data64 => 5,
        }
    }

    /// Bytes of a number of things.
    pub(super) fn count(self) -> usize {
        match self {
            Version::Offset64 => 4,
            Version::Data64 => 8,
        }
    }
}

/// Lists of the header, by what stands before them.
pub(super) const DIMENSIONS: u32 = 0x0A;
pub(super) const VARIABLES: u32 = 0x0B;
pub(super) const ATTRIBUTES: u32 = 0x0C;

#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    pub version: Version,
    /// Records that are whole.
    pub records: u64,
    /// Name and length; 0 is that of records.
    pub dimensions: Vec<(String, u64)>,
    pub attributes: Vec<(String, Attribute)>,
    pub variables: Vec<Variable>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    pub name: String,
    pub kind: Type,
    /// Places of its dimensions in the header.
    pub dimensions: Vec<usize>,
    pub attributes: Vec<(String, Attribute)>,
    /// First byte in the file; of what is recorded, in the first record.
    pub begin: u64,
}

impl Header {
    pub fn new(version: Version) -> Self {
        Header {
            version,
            records: 0,
            dimensions: vec![],
            attributes: vec![],
            variables: vec![],
        }
    }

    /// A new dimension; 0 is that of records. Answers its place.
    pub fn dimension(&mut self, name: &str, length: usize) -> usize {
        self.dimensions.push((name.into(), length as u64));
        self.dimensions.len() - 1
    }

    /// A new variable.
    pub fn variable(&mut self, name: &str, kind: Type, dimensions: &[usize]) -> &mut Variable {
        let at = self.variables.len();
        self.variables.push(Variable {
            name: name.into(),
            kind,
            dimensions: dimensions.into(),
            attributes: vec![],
            begin: 0,
        });
        &mut self.variables[at]
    }

    /// Has the variable a value in every record?
    pub fn is_recorded(&self, v: &Variable) -> bool {
        let first = v.dimensions.first();
        first.is_some_and(|d| self.dimensions[*d].1 == 0)
    }

    /// Lengths of a variable, without that of records.
    pub fn shape(&self, v: &Variable) -> Vec<u64> {
        let skipped = usize::from(self.is_recorded(v));
        let own = v.dimensions[skipped..].iter();
        own.map(|d| self.dimensions[*d].1).collect()
    }

    /// Bytes of a variable, of one record if it is recorded; `None`: more than there can be.
    pub fn bytes(&self, v: &Variable) -> Option<u64> {
        let mut shape = self.shape(v).into_iter();
        shape.try_fold(v.kind.bytes() as u64, |n, length| n.checked_mul(length))
    }

    /// Bytes of a record; `None`: more than there can be. A single recorded variable is not filled up.
    pub fn record_bytes(&self) -> Option<u64> {
        let recorded: Vec<&Variable> = { self.variables.iter() }
            .filter(|v| self.is_recorded(v))
            .collect();
        match recorded[..] {
            [one] => self.bytes(one),
            _ => recorded
                .iter()
                .try_fold(0u64, |sum, v| sum.checked_add(filled(self.bytes(v)?)?)),
        }
    }
}

/// The next multiple of 4.
pub(super) fn filled(bytes: u64) -> Option<u64> {
    bytes.checked_next_multiple_of(4)
}
