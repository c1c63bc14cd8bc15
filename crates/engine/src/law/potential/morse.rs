//! Morse: `φ = D [e^(−2α(r−r0)) − 2 e^(−α(r−r0))]` (Morse 1929).

use super::Potential;
use crate::law::number::Number;
use crate::spec::Morse;

impl Potential for Morse {
    fn cutoff(&self) -> f64 {
        f64::INFINITY
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let e = q.sqrt().plus(-self.distance).times(-self.alpha).exp();
        (e * e - e.times(2.0)).times(self.depth)
    }
}
