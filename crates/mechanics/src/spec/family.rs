//! Families: how far bonds reach, how they are weighted, who enumerates them.

use crate::expression::{Expression, ExpressionError};
use std::sync::{Mutex, PoisonError};

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// Whole number of lattice spacings, inclusive, by integers.
    Ratio(u32),
    /// A length, inclusive.
    Length(f64),
}

impl Default for Horizon {
    fn default() -> Horizon {
        Horizon::Ratio(1)
    }
}

impl Horizon {
    /// δ (length) where points are `spacing` apart.
    pub fn length(self, spacing: f64) -> f64 {
        match self {
            Horizon::Ratio(m) => f64::from(m) * spacing,
            Horizon::Length(d) => d,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Calibration {
    /// Constants from the integrals over the full ball (disk, segment) of radius δ.
    Continuum,
    /// Constants from the sums over a full family in the bulk of this very body.
    #[default]
    Discrete,
}

/// Influence functions ω(ξ).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Influence {
    /// 1
    #[default]
    Constant,
    /// 1/ξ
    Inverse,
    /// 1 − ξ/δ
    Linear,
    /// exp(−(2ξ/δ)²)
    Gaussian,
    /// Cubic B-spline with support δ, 1 at ξ = 0.
    CubicSpline,
    /// As written.
    Formula(Formula),
}

/// An influence function as an expression of [`Formula::VARIABLES`] (sandia2010, Remark 3.0.2).
///
/// Each text is kept once, for the life of the program, so that an influence function can be copied like a word.
#[derive(Debug, Clone, Copy)]
pub struct Formula(&'static Expression);

impl Formula {
    /// |ξ|, the horizon δ and the components of ξ, lengths all of them.
    pub const VARIABLES: &'static [&'static str] = &["r", "delta", "xi_x", "xi_y", "xi_z"];

    /// Of an expression of [`Formula::VARIABLES`].
    pub fn new(expression: Expression) -> Formula {
        static ALL: Mutex<Vec<&'static Expression>> = Mutex::new(vec![]);
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        match all.iter().find(|known| ***known == expression) {
            Some(known) => Formula(known),
            None => {
                all.push(Box::leak(Box::new(expression)));
                Formula(all[all.len() - 1])
            }
        }
    }

    /// From its text, with named constants.
    ///
    /// # Errors
    /// It is no expression of these variables.
    pub fn parse(source: &str, constants: &[(&str, f64)]) -> Result<Formula, ExpressionError> {
        Expression::of(Self::VARIABLES, source, constants).map(Formula::new)
    }

    /// ω(ξ); `r` is |ξ| (length).
    pub fn at(self, xi: [f64; 3], r: f64, horizon: f64) -> f64 {
        self.0.of_variables(&[r, horizon, xi[0], xi[1], xi[2]])
    }

    /// Does it depend on the direction of the bond? Then ω(ξ) need not be ω(−ξ).
    pub fn is_directed(self) -> bool {
        (2..5).any(|k| self.0.depends_on(k))
    }

    /// Does it depend on the horizon?
    pub fn knows_horizon(self) -> bool {
        self.0.depends_on(1)
    }

    /// The text.
    pub fn source(self) -> &'static str {
        self.0.source()
    }
}

impl PartialEq for Formula {
    fn eq(&self, other: &Formula) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Formula {}

impl Influence {
    /// Is it another one at another horizon?
    pub fn knows_horizon(self) -> bool {
        match self {
            Influence::Constant | Influence::Inverse => false,
            Influence::Linear | Influence::Gaussian | Influence::CubicSpline => true,
            Influence::Formula(formula) => formula.knows_horizon(),
        }
    }

    /// Does it depend on the direction of the bond?
    pub fn is_directed(self) -> bool {
        matches!(self, Influence::Formula(f) if f.is_directed())
    }

    /// Those with a name.
    pub const ALL: [Influence; 5] = [
        Influence::Constant,
        Influence::Inverse,
        Influence::Linear,
        Influence::Gaussian,
        Influence::CubicSpline,
    ];
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FamilyChoice {
    #[default]
    Auto,
    Stencil,
    List,
    /// Current neighbours within the cut-off of a potential.
    Neighbours,
    /// Those within the horizon in the reference, for ever, of any potential: sandia2010, chapter 4.
    Reference,
}
