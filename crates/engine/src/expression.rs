//! Expressions of x, y, z, t.

/// A compiled expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression;
