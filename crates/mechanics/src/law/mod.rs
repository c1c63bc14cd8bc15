//! Laws: what one bond answers. A law is a small pure function, written once over any lane.
//!
//! Families hand every law the same three numbers of a bond: a constant `k` made from the reference, and
//! `e = |ξ+η|²/|ξ|² − 1` in the form the law asks for: extension over current length `g = (r − r0)/r`, or stretch
//! `s = (r − r0)/r0`.

pub mod blocks;
pub mod bonded;
pub mod descriptor;
pub mod fracture_energy;
pub mod function;
pub mod influence;
pub mod jet;
pub mod many_body;
pub mod material;
pub mod micromodulus;
mod moduli;
pub mod number;
pub mod partner;
pub mod potential;
pub mod quadrature;
pub mod scaled;
pub mod slopes;
pub mod solid;
pub mod soundness;
pub mod spline;
pub mod terms;

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

/// What one bond answers, of laws that the fast families run. Point fields (`i`, `j`: up to two numbers at either end) carry what differs
/// from point to point: materials, weighted volumes, the pressure of the last share pass.
///
/// # Contract
/// These laws are linear in the stretch `s = (r − r0)/r0` of their bonds, and kernels, tangents and released energies take that for granted.
/// Nothing checks it: a law that is otherwise compiles, and has wrong tangents and releases. Such laws are [`material::Material`]s.
///
/// With `S = Σ k r0² s` over the intact bonds of a point, `q` its [`pressure_factor`](Law::pressure_factor) and `P = q S` its pressure:
/// - The force density on i is `Σ pull (ξ+η)`. `pull` is of first degree in `g = (r − r0)/r`: its slope is taken as a difference of two
///   values. At `g = 0` and without pressures it is 0.
/// - Laws with [`SHARES`](Law::SHARES) have P in field 0. `pull` is of first degree in it, with one slope for both ends that depends on no
///   other field.
/// - `pull` of i and of j is the same where fields and factors of the ends change places: action is reaction.
/// - The energy density is `W = ½ q S² + Σ pair_energy(k r0² s²)`, `pair_energy` is proportional to its argument, and `pull` follows from
///   W: a bond that breaks sets free what W loses with it, at any stretch.
/// - All functions are pure, and every number of a lane is answered by itself. Nothing is remembered but what families keep for any law:
///   which bonds are whole, and critical stretches.
pub trait Law: Copy + Send + Sync + 'static {
    /// Does the force need a point scalar summed over the family first?
    const SHARES: bool;
    /// How many point fields `pull` reads.
    const FIELDS: usize;

    /// The bond constant `k` from reference length and `ω ν V_j`.
    fn constant<L: Lane>(self, r0: L, inv_r0: L, weight: L) -> L;

    /// `k` times what lists multiply it with for both ends of the bond ξ, whose length is r0: 1 but for horizons of points.
    #[inline(always)]
    fn between_ends<L: Lane, const D: usize>(
        self,
        k: L,
        _xi: &[L; D],
        _r0: L,
        _i: [L; 2],
        _j: [L; 2],
    ) -> L {
        k
    }

    /// Force density on i along `ξ + η`: the coefficient of `ξ + η`, of first degree in `g = (r − r0)/r`.
    fn pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2]) -> L;

    /// The same of a bond with factors.
    #[inline(always)]
    fn scaled_pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2], factors: BondFactors<L>) -> L {
        self.pull(k, g, i, j) * factors.pair
    }

    /// The part of [`Law::scaled_pull`] that W_i alone has for a slope: `∂W_i/∂r / r`.
    #[inline(always)]
    fn own_pull<L: Lane>(self, k: L, g: L, i: [L; 2], j: [L; 2], factors: BondFactors<L>) -> L {
        // x = k r0² s² has the slope 2 k g r
        let pair = self.pair_energy(k * g * factors.pair, i, j);
        let own = pair + pair;
        match Self::SHARES {
            // r0/r = 1 − g
            true => (i[0] * factors.own * k).fma(L::splat(1.0) - g, own),
            false => own,
        }
    }

    /// Energy density at i of one bond, proportional to `x = k r0² s²`.
    fn pair_energy<L: Lane>(self, x: L, i: [L; 2], j: [L; 2]) -> L;

    /// Pressure factor at i: `P = factor · Σ k r0² s` (0 for laws that share nothing), from i's own fields.
    fn pressure_factor<L: Lane>(self, own: L) -> L;
}
