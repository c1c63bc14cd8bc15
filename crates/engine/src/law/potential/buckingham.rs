//! Buckingham: `φ = A e^(−r/ρ) − C / r⁶` (Buckingham 1938). It falls to −∞ at r = 0.

use super::Potential;
use crate::law::number::Number;
use crate::spec::Buckingham;

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
