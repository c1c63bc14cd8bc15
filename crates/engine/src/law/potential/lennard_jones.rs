//! Lennard-Jones: `φ = 4ε [(σ/r)¹² − (σ/r)⁶]` (Jones 1924; seleson2009 (5.1)).

use super::Potential;
use crate::law::number::Number;
use crate::spec::LennardJones;

impl Potential for LennardJones {
    fn cutoff(&self) -> f64 {
        f64::INFINITY
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let s6 = q.recip().times(self.sigma * self.sigma).power(3);
        (s6 * s6 - s6).times(4.0 * self.epsilon)
    }
}
