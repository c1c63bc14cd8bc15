//! The bond-based solid with a horizon for each point (H. Ren, X. Zhuang, Y. Cai and T. Rabczuk 2016, Dual-horizon peridynamics, Int. J.
//! Numer. Methods Eng. 108, 1451–1476, eq. 13–16).
//!
//! A point pulls at those within its own horizon, and is pulled at by those in whose horizon it is (its dual horizon): force density on i
//! `Σ_j ½ (c_i ω_i ν_i + c_j ω_j ν_j) V_j s (ξ+η)/|ξ+η|`, with `ν = clamp(½ + (δ − r0)/h, 0, 1)` the part of a cell of width h that is within δ, so
//! that nothing jumps where a horizon passes a point. Either half is action and reaction, so momentum and angular momentum stay; with the
//! micropotential `½ (…) s² r0` so does energy. State-based laws weigh their bonds by `ω ν_i` at i and `ω ν_j` at j
//! (`interaction/bonds/cloud.rs`): what T_i gives to j it takes from i.

use crate::execute::lane::Lane;
use crate::law::Law;
use crate::law::influence::InfluenceFunction;

/// Micromodulus (field 0) and `½ + δ/h` (field 1) per point.
#[derive(Debug, Clone, Copy)]
pub struct DualHorizon {
    /// `1/h` (1 / length).
    pub rate: f64,
    /// ω, the same from both ends of a bond; at either of its horizon.
    pub influence: InfluenceFunction,
}

/// ν of a bond of length r0, with `reach` = ½ + δ/h and `rate` = 1/h.
#[inline(always)]
pub fn part_within<L: Lane>(r0: L, reach: L, rate: f64) -> L {
    let part = r0.fma(L::splat(-rate), reach);
    part.min(L::splat(1.0)).max(L::splat(0.0))
}

impl DualHorizon {
    /// `c ω ν` of a bond at one of its ends.
    #[inline(always)]
    fn half<L: Lane, const D: usize>(self, xi: &[L; D], r0: L, end: [L; 2]) -> L {
        let part = end[0] * part_within(r0, end[1], self.rate);
        if self.influence.is_constant() {
            return part;
        }
        let horizon = (end[1] - L::splat(0.5)).div(L::splat(self.rate));
        let inv_r0 = L::splat(1.0).div(r0);
        part * self.influence.within(xi, r0, inv_r0, horizon)
    }
}

impl Law for DualHorizon {
    const SHARES: bool = false;
    const FIELDS: usize = 2;

    #[inline(always)]
    fn constant<L: Lane>(self, _r0: L, inv_r0: L, weight: L) -> L {
        weight * inv_r0
    }
    #[inline(always)]
    fn between_ends<L: Lane, const D: usize>(
        self,
        k: L,
        xi: &[L; D],
        r0: L,
        i: [L; 2],
        j: [L; 2],
    ) -> L {
        L::splat(0.5) * (self.half(xi, r0, i) + self.half(xi, r0, j)) * k
    }
    #[inline(always)]
    fn pull<L: Lane>(self, k: L, g: L, _: [L; 2], _: [L; 2]) -> L {
        k * g
    }
    #[inline(always)]
    fn pair_energy<L: Lane>(self, x: L, _: [L; 2], _: [L; 2]) -> L {
        L::splat(0.25) * x
    }
    #[inline(always)]
    fn pressure_factor<L: Lane>(self, _: L) -> L {
        L::splat(0.0)
    }
}
