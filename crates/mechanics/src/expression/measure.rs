//! What the parts of an expression measure: the seam to units, which the engine does not know.

use std::fmt::Debug;
use std::ops::Range;

/// What an operation asks of its arguments, and what it makes of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// All of a kind, and so is the result: `+`, `min`, `abs`, `clamp`.
    Alike,
    /// All of a kind, and a number results: `<`, `atan2`.
    Compare,
    Product,
    Quotient,
    Power,
    Root,
    /// Numbers only, and a number results: `sin`, `floor`, `noise`.
    Numbers,
    /// Of any kind, and a number results: `&&`, `sign`, `step`.
    Any,
    /// The first of any kind, the others and the result of one.
    Choice,
}

/// Why parts do not fit together.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    pub message: String,
    pub help: Option<String>,
}

/// Knows units and what variables and constants measure. An expression is evaluated as if all of it were plain numbers:
/// kinds only decide whether it is taken.
pub trait Measure {
    type Kind: Clone + Debug;

    /// A number as it stands.
    fn number(&self, value: f64) -> Self::Kind;
    /// `pi`, `e`.
    fn pure(&self) -> Self::Kind;
    /// Names of the variables. Where these are others than x, y, z there is no `t` either.
    fn variables(&self) -> &'static [&'static str] {
        PLACE
    }
    /// `x`, `y`, `z`, or whatever the variables are.
    fn coordinate(&self) -> Self::Kind;
    /// `t`.
    fn time(&self) -> Self::Kind;
    /// The constant of this place.
    fn constant(&self, index: usize) -> Self::Kind;
    /// The unit that `rest` begins with, if it does: its length in bytes, and value and kind of `value` of it.
    ///
    /// # Errors
    /// Where in `rest` stands what is no unit.
    #[allow(clippy::type_complexity)]
    fn quantity(
        &self,
        value: f64,
        rest: &str,
    ) -> Result<Option<(usize, f64, Self::Kind)>, (Range<usize>, Misfit)>;
    /// What an operation called `name` makes of its arguments; `exponent` is a power's, where it is a number.
    ///
    /// # Errors
    /// The arguments do not fit.
    fn combine(
        &self,
        name: &str,
        rule: Rule,
        of: &[Self::Kind],
        exponent: Option<f64>,
    ) -> Result<Self::Kind, Misfit>;
}

/// The variables of a place.
pub(super) const PLACE: &[&str] = &["x", "y", "z"];

/// Plain numbers everywhere.
pub(super) struct Plain(pub &'static [&'static str]);

impl Measure for Plain {
    type Kind = ();

    fn variables(&self) -> &'static [&'static str] {
        self.0
    }
    fn number(&self, _: f64) {}
    fn pure(&self) {}
    fn coordinate(&self) {}
    fn time(&self) {}
    fn constant(&self, _: usize) {}
    fn quantity(
        &self,
        _: f64,
        _: &str,
    ) -> Result<Option<(usize, f64, ())>, (Range<usize>, Misfit)> {
        Ok(None)
    }
    fn combine(&self, _: &str, _: Rule, _: &[()], _: Option<f64>) -> Result<(), Misfit> {
        Ok(())
    }
}
