//! Families: how far bonds reach, how they are weighted, who enumerates them.

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Horizon {
    /// Whole number of lattice spacings, inclusive, by integers.
    Ratio(u32),
    /// A length, inclusive.
    Length(f64),
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

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Calibration {
    /// Constants from the integrals over the full ball (disk, segment) of radius δ.
    Continuum,
    /// Constants from the sums over a full family in the bulk of this very body.
    Discrete,
}

/// Influence functions ω(ξ) of the bond length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Influence {
    /// 1
    Constant,
    /// 1/ξ
    Inverse,
    /// 1 − ξ/δ
    Conical,
    /// exp(−(2ξ/δ)²)
    Gaussian,
    /// Cubic B-spline with support δ, 1 at ξ = 0.
    CubicSpline,
}

impl Influence {
    pub const ALL: [Influence; 5] = [
        Influence::Constant,
        Influence::Inverse,
        Influence::Conical,
        Influence::Gaussian,
        Influence::CubicSpline,
    ];
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FamilyChoice {
    Auto,
    Stencil,
    List,
    /// Current neighbours within the cut-off of a potential.
    Neighbours,
}
