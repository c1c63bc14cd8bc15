//! Numbers that somebody typed, taken for the fractions they mean.

/// Largest denominator that a typed number is taken to mean.
const DENOMINATOR: i64 = 64;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fraction {
    pub numerator: i64,
    pub denominator: i64,
}

impl Fraction {
    pub fn value(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

/// How far a number in lattice units may be off the fraction that is meant: typed decimals and the round-off of
/// the division by the spacing.
pub(super) fn tolerance(v: f64) -> f64 {
    1e-9 + 1e-14 * v.abs()
}

/// The fraction with the smallest denominator (up to 64, or `also`) within [`tolerance`] of `v`.
pub(super) fn snap(v: f64, also: i64) -> Option<Fraction> {
    if v.abs() > 1e15 {
        return None;
    }
    (1..=DENOMINATOR).chain([also]).find_map(|denominator| {
        let numerator = (v * denominator as f64).round();
        let near = (v - numerator / denominator as f64).abs() <= tolerance(v);
        near.then_some(Fraction {
            numerator: numerator as i64,
            denominator,
        })
    })
}

pub(super) fn lcm(a: i64, b: i64) -> i64 {
    let (mut g, mut r) = (a, b);
    while r != 0 {
        (g, r) = (r, g % r);
    }
    a / g * b
}
