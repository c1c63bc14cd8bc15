//! Laws: what one bond answers. A law is a small pure function, written once over any lane.
//!
//! Families hand every law the same three numbers of a bond: a constant `k` made from the reference, and
//! `e = |ξ+η|²/|ξ|² − 1` in the form the law asks for: extension over current length `g = (r − r0)/r`, or stretch
//! `s = (r − r0)/r0`.

pub mod descriptor;
pub mod fracture_energy;
pub mod influence;
pub mod jet;
pub mod material;
pub mod micromodulus;
mod moduli;
pub mod number;
pub mod potential;
pub mod solid;
pub mod spline;

use crate::execute::lane::Lane;

/// What the parts of a bond's answer at i are multiplied by; laws without a point scalar know the first alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondFactors<L> {
    /// What depends on the bond alone.
    pub pair: L,
    /// What it adds to the scalar of i, and what that scalar adds to it.
    pub own: L,
    /// What the scalar of j adds to it.
    pub other: L,
}

impl BondFactors<f64> {
    /// No factors.
    pub const ONE: Self = BondFactors {
        pair: 1.0,
        own: 1.0,
        other: 1.0,
    };

    pub fn times(self, x: Self) -> Self {
        BondFactors {
            pair: self.pair * x.pair,
            own: self.own * x.own,
            other: self.other * x.other,
        }
    }
}

/// What one bond answers. Point fields (`i`, `j`: up to two numbers at either end) carry what differs from point to
/// point: materials, weighted volumes, the pressure of the last share pass.
pub trait Law: Copy + Send + Sync + 'static {
    /// Does the force need a point scalar summed over the family first?
    const SHARES: bool;
    /// How many point fields `pull` reads.
    const FIELDS: usize;

    /// The bond constant `k` from reference length and `ω ν V_j`.
    fn constant<L: Lane>(self, r0: L, inv_r0: L, weight: L) -> L;

    /// Force density on i along `ξ + η`: the coefficient of `ξ + η`, with `g = (r − r0)/r`.
    fn pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2]) -> L;

    /// The same of a bond with factors.
    #[inline(always)]
    fn scaled_pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2], factors: BondFactors<L>) -> L {
        self.pull(k, g, i, j) * factors.pair
    }

    /// Energy density at i of one bond, with `x = k r0² s²`.
    fn pair_energy<L: Lane>(self, x: L, i: [L; 2], j: [L; 2]) -> L;

    /// Pressure factor at i: `P = factor · Σ k r0² s` (0 for laws that share nothing), from i's own fields.
    fn pressure_factor<L: Lane>(self, own: L) -> L;
}
