//! Buckingham: `φ = A e^(−r/ρ) − C / r⁶` (Buckingham 1938). It falls to −∞ at r = 0.

use super::Potential;
use crate::law::number::Number;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Buckingham {
    /// Strength A of the repulsion (energy).
    pub strength: f64,
    /// Its range ρ (length).
    pub range: f64,
    /// Dispersion constant C (energy · length⁶).
    pub dispersion: f64,
}

impl Potential for Buckingham {
    fn cutoff(&self) -> f64 {
        f64::INFINITY
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let repulsion = q.sqrt().times(-1.0 / self.range).exp();
        repulsion.times(self.strength) - q.recip().power(3).times(self.dispersion)
    }
}
