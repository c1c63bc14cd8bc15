//! Expressions of x, y, z, t and named constants, such as `"0.1*sin(pi*x/L)"`.
//!
//! | | |
//! |---|---|
//! | numbers | `2`, `0.5`, `.5`, `1e-3` |
//! | names | `x y z t`, the constants given, `pi`, `e` |
//! | arithmetic | `+ - * / ^`; `^` is right associative and binds tighter than a sign: `-x^2 = -(x^2)` |
//! | logic (0 or 1) | `< <= > >= == !=`, `&& \|\| !`; anything but 0 is true |
//! | choice | `a ? b : c`, `if(a, b, c)` |
//! | functions | `sin cos tan asin acos atan atan2 sinh cosh tanh exp log` (natural; also `ln`) `log10 sqrt abs min max floor ceil sign step clamp hypot` |
//! | random fields | `random(a, b, c)`, `noise(a, b, c)` |
//!
//! `step(a)` is 0 for a < 0 and 1 otherwise; `clamp(a, low, high)`; `min` and `max` take two or more.
//! `random` is uniform in [0, 1), one number per unit cell of its arguments; `noise` is smooth, in [−1, 1], with a correlation
//! length of about one unit. Both are functions of place: other seeds are other places, `noise(x/l + 100, y/l, 0)`.
//! Both sides of a choice are evaluated; the one not taken may be NaN without harm.

mod error;
mod measure;
mod op;
mod parse;
mod random;
#[cfg(test)]
mod tests;

pub use error::ExpressionError;
pub use measure::{Measure, Misfit, Rule};
pub(crate) use op::{Binary, Op, Ternary, Unary};
pub use parse::nearest;

/// A compiled expression: a flat stack program, evaluated without allocation.
///
/// ```
/// use peridyne_mechanics::expression::Expression;
/// let u = Expression::parse("a*x^2 + (t > 1 ? 1 : 0)", &[("a", 3.0)]).unwrap();
/// assert_eq!(u.eval(&[2.0, 0.0, 0.0], 2.0), 13.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    source: String,
    program: Vec<Op>,
}

impl Expression {
    /// Compiles `source`; `constants` are names and values that may be used in it beside `pi` and `e`.
    ///
    /// `x`, `y`, `z`, `t` and function names are never looked up among the constants.
    pub fn parse(source: &str, constants: &[(&str, f64)]) -> Result<Self, ExpressionError> {
        Ok(Self::measured(source, constants, &measure::Plain(measure::PLACE))?.0)
    }

    /// The same of other variables in place of x, y, z and t; those of more than three are evaluated by [`Expression::of_variables`].
    ///
    /// ```
    /// use peridyne_mechanics::expression::Expression;
    /// let w = Expression::of(&["I1", "J"], "mu/2*(I1 - 3) - mu*ln(J)", &[("mu", 2.0)]).unwrap();
    /// assert_eq!(w.eval(&[5.0, 1.0, 0.0], 0.0), 2.0);
    /// ```
    pub fn of(
        variables: &'static [&'static str],
        source: &str,
        constants: &[(&str, f64)],
    ) -> Result<Self, ExpressionError> {
        Ok(Self::measured(source, constants, &measure::Plain(variables))?.0)
    }

    /// The same where parts measure something, and what the whole measures.
    pub fn measured<M: Measure>(
        source: &str,
        constants: &[(&str, f64)],
        measure: &M,
    ) -> Result<(Self, M::Kind), ExpressionError> {
        let (program, kind) = parse::program(source, constants, measure)?;
        let expression = Expression {
            source: source.to_string(),
            program,
        };
        Ok((expression, kind))
    }

    /// So many times its value; the text stays.
    pub fn times(mut self, factor: f64) -> Self {
        match self.program[..] {
            [Op::Push(value)] => self.program = vec![Op::Push(value * factor)],
            _ => self
                .program
                .extend([Op::Push(factor), Op::Two(Binary::Multiply)]),
        }
        self
    }

    pub fn constant(value: f64) -> Self {
        Expression {
            source: format!("{value}"),
            program: vec![Op::Push(value)],
        }
    }

    /// Value at the point `x` (length) at time `t`.
    pub fn eval(&self, x: &[f64; 3], t: f64) -> f64 {
        op::run(&self.program, x, t)
    }

    /// Value where the variables that it was compiled of are these.
    pub fn of_variables(&self, values: &[f64]) -> f64 {
        op::run(&self.program, values, 0.0)
    }

    /// Does it depend on the variable of this place?
    pub fn depends_on(&self, variable: usize) -> bool {
        self.program.contains(&Op::Coordinate(variable))
    }

    /// The value, if it depends on nothing.
    pub fn as_constant(&self) -> Option<f64> {
        match self.program[..] {
            [Op::Push(value)] => Some(value),
            _ => None,
        }
    }

    pub fn depends_on_time(&self) -> bool {
        self.program.contains(&Op::Time)
    }

    pub fn depends_on_position(&self) -> bool {
        self.program
            .iter()
            .any(|op| matches!(op, Op::Coordinate(_)))
    }

    /// Its operations, in the order in which they are done.
    pub(crate) fn program(&self) -> &[Op] {
        &self.program
    }

    /// The text it was compiled from.
    pub fn source(&self) -> &str {
        &self.source
    }
}
