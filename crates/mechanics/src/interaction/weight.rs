//! What a bond of a cloud weighs: influence function times volume fraction.

use crate::body::Body;
use crate::execute::lane::Lane;
use crate::law::influence::InfluenceFunction;
use crate::law::micromodulus::first_moments;
use crate::spec::Influence;
use std::collections::HashMap;

/// `ω(ξ) ν(r0)` with `ν = min(1, cut − rate r0)`, evaluated in lanes wherever a bond is met, so that nothing needs to be
/// stored.
#[derive(Debug, Clone, Copy)]
pub struct BondWeight {
    influence: InfluenceFunction,
    cut: f64,
    rate: f64,
}

impl BondWeight {
    /// Influence for a horizon δ; `scaling` is the spacing over which a partner's volume fades at the horizon
    /// ([`crate::family::volume_fraction`]), `None` for whole volumes.
    pub fn new(influence: Influence, horizon: f64, scaling: Option<f64>) -> Self {
        BondWeight {
            influence: InfluenceFunction::new(influence, horizon),
            cut: scaling.map_or(1.0, |h| 0.5 + horizon / h),
            rate: scaling.map_or(0.0, |h| 1.0 / h),
        }
    }

    /// The same with whole volumes.
    pub fn whole(self) -> Self {
        BondWeight {
            cut: 1.0,
            rate: 0.0,
            ..self
        }
    }

    /// The same from both ends: the mean of ω(ξ) and ω(−ξ).
    pub fn mean(self) -> Self {
        BondWeight {
            influence: self.influence.mean(),
            ..self
        }
    }

    /// `ω ν` of bonds ξ of these lengths.
    #[inline(always)]
    pub fn at<L: Lane, const D: usize>(&self, xi: &[L; D], r0: L, inv_r0: L) -> L {
        self.influence.at(xi, r0, inv_r0) * self.fraction(r0, L::splat(self.cut))
    }

    /// The same of bonds with a horizon of their own (length), at which the partner's volume fades: `cut` is `½ + δ/h` of that.
    #[inline(always)]
    pub fn within<L: Lane, const D: usize>(
        &self,
        xi: &[L; D],
        r0: L,
        inv_r0: L,
        [horizon, cut]: [L; 2],
    ) -> L {
        self.influence.within(xi, r0, inv_r0, horizon) * self.fraction(r0, cut)
    }

    /// What micromoduli of points with horizons of their own are of that at the longest, by slot: they go as the inverse of `∫ ω r dV`. Empty: points
    /// have none.
    pub fn stiffnesses<const D: usize>(&self, body: &Body<D>) -> Vec<f64> {
        let (kind, longest) = self.influence.kind();
        let mut known: HashMap<u64, f64> = HashMap::new();
        let mut of = |own: f64| {
            let known = known.entry(own.to_bits());
            *known.or_insert_with(|| first_moments(D, longest, own, kind))
        };
        let each = body.horizon.iter();
        each.map(|own| if *own > 0.0 { of(*own) } else { 1.0 })
            .collect()
    }

    /// Is ω another one at another horizon?
    #[inline(always)]
    pub fn knows_horizon(&self) -> bool {
        self.influence.knows_horizon()
    }

    /// How far beyond its horizon (length) a point with one of its own has bonds, of which it holds a part of a cell: half a spacing, or nothing where ω is
    /// 0 at the horizon.
    pub fn fringe(&self, spacing: f64) -> f64 {
        match self.influence.kind().0 {
            Influence::Linear | Influence::CubicSpline => 0.0,
            Influence::Constant
            | Influence::Inverse
            | Influence::Gaussian
            | Influence::Formula(_) => 0.5 * spacing,
        }
    }

    /// ω alone, of this end and of the other.
    #[inline(always)]
    pub fn influence<L: Lane, const D: usize>(&self, xi: &[L; D], r0: L, inv_r0: L) -> [L; 2] {
        let own = self.influence.at(xi, r0, inv_r0);
        if !self.influence.is_directed() {
            return [own; 2];
        }
        [own, self.influence.at(&turned(xi), r0, inv_r0)]
    }

    /// The same of two ends with horizons of their own (length).
    #[inline(always)]
    pub fn influence_within<L: Lane, const D: usize>(
        &self,
        xi: &[L; D],
        r0: L,
        inv_r0: L,
        [own, other]: [L; 2],
    ) -> [L; 2] {
        if !self.knows_horizon() {
            return self.influence(xi, r0, inv_r0);
        }
        let back = match self.influence.is_directed() {
            true => turned(xi),
            false => *xi,
        };
        [
            self.influence.within(xi, r0, inv_r0, own),
            self.influence.within(&back, r0, inv_r0, other),
        ]
    }

    /// ν alone.
    #[inline(always)]
    pub fn volume_fraction<L: Lane>(&self, r0: L) -> L {
        self.fraction(r0, L::splat(self.cut))
    }

    #[inline(always)]
    fn fraction<L: Lane>(&self, r0: L, cut: L) -> L {
        r0.fma(L::splat(-self.rate), cut).min(L::splat(1.0))
    }
}

/// −ξ
#[inline(always)]
fn turned<L: Lane, const D: usize>(xi: &[L; D]) -> [L; D] {
    let mut back = *xi;
    for a in 0..D {
        back[a] = L::splat(0.0) - xi[a];
    }
    back
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::volume_fraction;
    use crate::law::influence::influence;

    #[test]
    fn lanes_weigh_like_the_plain_formulas() {
        let (d, h) = (0.0031, 0.001);
        for kind in Influence::ALL {
            for scaling in [None, Some(h)] {
                let w = BondWeight::new(kind, d, scaling);
                for n in 1..=1000 {
                    let r = d * n as f64 / 1000.0;
                    let nu = scaling.map_or(1.0, |h| volume_fraction(r, d, h));
                    let exact = influence(kind, &[r], r, d) * nu;
                    let scale = influence(kind, &[0.1 * d], 0.1 * d, d);
                    assert!(
                        (w.at(&[r], r, 1.0 / r) - exact).abs() <= 1e-15 * scale.max(exact),
                        "{kind:?} at {r}: {} is not {exact}",
                        w.at(&[r], r, 1.0 / r)
                    );
                }
            }
        }
    }
}
