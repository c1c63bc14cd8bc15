//! The bond-based (prototype microelastic brittle, PMB) solid.
//!
//! Force density on i: `Σ_j c ω(r0) ν V_j s (ξ+η)/|ξ+η|`, `s = (|ξ+η| − |ξ|)/|ξ|`
//! (sandia2010 (3.0.5)–(3.0.7); Silling & Askari 2005). Micropotential `½ c s² r0`; energy density
//! `W_i = ½ Σ_j ½ c ω ν V_j s² r0`.

use crate::execute::lane::Lane;
use crate::law::Law;
use crate::spec::BondMixing;

/// One micromodulus for all bonds; it is part of the bond constant.
#[derive(Debug, Clone, Copy)]
pub struct BondBased {
    /// Micromodulus c (force / volume²).
    pub c: f64,
}

impl Law for BondBased {
    const SHARES: bool = false;
    const FIELDS: usize = 0;

    #[inline(always)]
    fn constant<L: Lane>(self, _r0: L, inv_r0: L, weight: L) -> L {
        L::splat(self.c) * weight * inv_r0
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

/// A micromodulus per point (field 0); bonds between unlike points follow an interface rule.
#[derive(Debug, Clone, Copy)]
pub struct BondBasedMixed {
    pub rule: BondMixing,
}

/// What a bond between unlike ends has of their two numbers.
#[inline(always)]
pub fn between<L: Lane>(rule: BondMixing, a: L, b: L) -> L {
    match rule {
        BondMixing::Arithmetic => L::splat(0.5) * (a + b),
        BondMixing::Harmonic => (L::splat(2.0) * a * b).div(a + b),
        BondMixing::Minimum => a.min(b),
    }
}

impl Law for BondBasedMixed {
    const SHARES: bool = false;
    const FIELDS: usize = 1;

    #[inline(always)]
    fn constant<L: Lane>(self, _r0: L, inv_r0: L, weight: L) -> L {
        weight * inv_r0
    }
    #[inline(always)]
    fn pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2]) -> L {
        between(self.rule, i[0], j[0]) * k * g
    }
    #[inline(always)]
    fn pair_energy<L: Lane>(self, x: L, i: [L; 2], j: [L; 2]) -> L {
        L::splat(0.25) * between(self.rule, i[0], j[0]) * x
    }
    #[inline(always)]
    fn pressure_factor<L: Lane>(self, _: L) -> L {
        L::splat(0.0)
    }
}
