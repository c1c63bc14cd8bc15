//! Types of numbers, and attributes.

/// External types that are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    Char,
    Int,
    Float,
    Double,
}

impl Type {
    /// How the file says it.
    pub(super) fn number(self) -> u32 {
        match self {
            Type::Char => 2,
            Type::Int => 4,
            Type::Float => 5,
            Type::Double => 6,
        }
    }

    pub fn bytes(self) -> usize {
        match self {
            Type::Char => 1,
            Type::Int | Type::Float => 4,
            Type::Double => 8,
        }
    }
}

/// Bytes up to the first zero, without blanks at the end.
pub(super) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end])
        .trim_end()
        .to_string()
}

/// Values of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    Text(String),
    Ints(Vec<i32>),
    Floats(Vec<f32>),
}
