//! Ends of pair potentials: cut, shifted to zero energy, shifted to zero energy and force, or switched off smoothly.

use super::Potential;
use crate::law::number::{Dual, Number};
use crate::spec::End;

/// `g` of seleson2014 (3.9): 1 below x = 0, 0 above x = 1, `g′ = −30 x² (1 − x)²` in between.
#[inline(always)]
pub fn switch<N: Number>(x: N) -> N {
    let one = N::constant(1.0);
    let rest = one - x;
    let inside = rest.power(3) * (one + x.times(3.0) + (x * x).times(6.0));
    x.below(0.0, one, x.below(1.0, inside, N::constant(0.0)))
}

/// A pair potential with an end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut<P> {
    potential: P,
    cutoff: f64,
    end: End,
    /// Energy and slope in r that are taken away.
    level: f64,
    slope: f64,
    center: f64,
}

impl<P: Potential> Cut<P> {
    /// `potential`, ended at `cutoff` (length; ∞ leaves it whole).
    pub fn new(potential: P, cutoff: f64, end: End) -> Self {
        let mut cut = Cut {
            potential,
            cutoff,
            end,
            level: 0.0,
            slope: 0.0,
            center: 0.0,
        };
        if cutoff.is_finite() && matches!(end, End::Shifted | End::ShiftedForce) {
            let last = cut.potential.pair(Dual::variable(cutoff * cutoff));
            cut.level = last.value;
            if end == End::ShiftedForce {
                // dφ/dr = 2 r dφ/dq
                (cut.slope, cut.center) = (2.0 * cutoff * last.slope, cutoff);
            }
        }
        cut
    }
}

impl<P: Potential> Potential for Cut<P> {
    const EMBEDDED: bool = P::EMBEDDED;

    fn cutoff(&self) -> f64 {
        self.cutoff.min(self.potential.cutoff())
    }

    #[inline(always)]
    fn pair<N: Number>(&self, q: N) -> N {
        let whole = self.potential.pair(q);
        match self.end {
            End::Truncated => whole,
            End::Shifted => whole.plus(-self.level),
            End::ShiftedForce => {
                whole.plus(-self.level) - q.sqrt().plus(-self.center).times(self.slope)
            }
            End::Smooth(near) => {
                whole * switch(q.sqrt().plus(-near).times(1.0 / (self.cutoff - near)))
            }
        }
    }

    #[inline(always)]
    fn density<N: Number>(&self, q: N) -> N {
        self.potential.density(q)
    }

    #[inline(always)]
    fn embedding<N: Number>(&self, density: N) -> N {
        self.potential.embedding(density)
    }

    fn least_density(&self) -> f64 {
        self.potential.least_density()
    }
}
