//! What a model knows of healing.

use crate::expression::Expression;

/// Where and when bonds heal.
pub(in crate::run) struct Healing {
    /// Size of the stretch below which they do, an expression of t.
    pub below: Expression,
    /// `[slots]`, 0: it does not.
    pub may: Vec<u8>,
}
