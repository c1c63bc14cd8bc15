//! Types of numbers, and attributes.

/// External types, by their number in the file (from 1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    Byte,
    Char,
    Short,
    Int,
    Float,
    Double,
    UByte,
    UShort,
    UInt,
    Int64,
    UInt64,
}

impl Type {
    const ALL: [Type; 11] = [
        Type::Byte,
        Type::Char,
        Type::Short,
        Type::Int,
        Type::Float,
        Type::Double,
        Type::UByte,
        Type::UShort,
        Type::UInt,
        Type::Int64,
        Type::UInt64,
    ];

    pub(super) fn of(number: u32) -> Option<Type> {
        Type::ALL.get((number as usize).checked_sub(1)?).copied()
    }

    pub(super) fn number(self) -> u32 {
        let at = Type::ALL.iter().position(|t| *t == self);
        at.map_or(0, |at| at as u32 + 1)
    }

    pub fn bytes(self) -> usize {
        match self {
            Type::Byte | Type::Char | Type::UByte => 1,
            Type::Short | Type::UShort => 2,
            Type::Int | Type::Float | Type::UInt => 4,
            Type::Double | Type::Int64 | Type::UInt64 => 8,
        }
    }

    /// A whole number of this type; `None`: it is none, or too large.
    pub(super) fn whole(self, bytes: &[u8]) -> Option<i64> {
        Some(match self {
            Type::Byte => i8::from_be_bytes(fixed(bytes)).into(),
            Type::UByte => bytes[0].into(),
            Type::Short => i16::from_be_bytes(fixed(bytes)).into(),
            Type::UShort => u16::from_be_bytes(fixed(bytes)).into(),
            Type::Int => i32::from_be_bytes(fixed(bytes)).into(),
            Type::UInt => u32::from_be_bytes(fixed(bytes)).into(),
            Type::Int64 => i64::from_be_bytes(fixed(bytes)),
            Type::UInt64 => u64::from_be_bytes(fixed(bytes)).try_into().ok()?,
            Type::Char | Type::Float | Type::Double => return None,
        })
    }

    /// A number with a point; `None`: it is none.
    pub(super) fn float(self, bytes: &[u8]) -> Option<f64> {
        match self {
            Type::Float => Some(f32::from_be_bytes(fixed(bytes)).into()),
            Type::Double => Some(f64::from_be_bytes(fixed(bytes))),
            Type::Byte
            | Type::Char
            | Type::Short
            | Type::Int
            | Type::UByte
            | Type::UShort
            | Type::UInt
            | Type::Int64
            | Type::UInt64 => None,
        }
    }
}

/// The first bytes; callers give as many.
pub(super) fn fixed<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

/// Values of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    Text(String),
    Ints(Vec<i32>),
    Floats(Vec<f32>),
    /// Read, of a type that nobody asks for.
    Other,
}
