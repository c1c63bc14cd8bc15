//! A bond, whatever its law and family: its arithmetic, what it bears, whether it is whole, and how bonds are visited.

use crate::body::Body;
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Function, Stretch};
use crate::law::BondFactors;

/// `e = |ξ+η|²/|ξ|² − 1` without cancellation: `|ξ+η|² − |ξ|² = 2 η·(ξ + ½η)`. Both vectors may point either way.
#[inline(always)]
pub fn relative_square_stretch<L: Lane, const D: usize>(
    eta: [L; D],
    xi: [L; D],
    two_by_r0_squared: L,
) -> L {
    let half = L::splat(0.5);
    let mut q = eta[0] * half.fma(eta[0], xi[0]);
    for a in 1..D {
        q = eta[a].fma(half.fma(eta[a], xi[a]), q);
    }
    q * two_by_r0_squared
}

/// The stretch that a critical `e` stands for.
pub fn critical_stretch(e0: f64) -> f64 {
    if e0.is_infinite() {
        e0
    } else {
        Stretch::exact(e0)
    }
}

/// Critical stretch of one material: `s0 = s00 − α s_min`; infinite `s00` never breaks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Toughness {
    pub s00: f64,
    pub alpha: f64,
}

/// Is a bond of the reference family whole?
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BondStatus {
    Whole,
    Broken,
    /// Of an absent crack: it counts neither as damage nor as one that heals, but its ends are of one family.
    Absent,
}

/// Axes of the components of a virial.
pub const VIRIAL: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Add `factor · y ⊗ pull` to a virial.
pub fn add_virial<const D: usize>(sum: &mut [f64; 6], pull: &[f64; D], y: &[f64; D], factor: f64) {
    for (sum, (m, n)) in sum.iter_mut().zip(VIRIAL) {
        if n < D {
            *sum += factor * y[m] * pull[n];
        }
    }
}

/// Of all points, those of slots, of all ranks.
pub(super) fn sum_of_virials<const D: usize>(body: &Body<D>, points: &[[f64; 6]]) -> [f64; 6] {
    let own = || body.slots.iter().map(|s| &points[*s as usize]);
    body.sums(crate::array::from_fn(|n| own().map(|v| v[n]).collect()))
}

/// `gradient · x`
pub(super) fn along<const D: usize>(gradient: &[[f64; D]; D], x: &[f64]) -> [f64; D] {
    gradient.map(|row| row.iter().zip(x).map(|(g, x)| g * x).sum())
}

/// A directed bond, and what it does to the point that it belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondForce<const D: usize> {
    /// Slots of points, images resolved.
    pub i: usize,
    pub j: usize,
    /// From i to j now; of linear laws in the reference (length).
    pub y: [f64; D],
    /// What i gets from the bond: that of its own force state and that of its partner's (force / volume).
    pub force: [f64; D],
    /// That of its own force state: `∂W_i/∂y`, with the memory of the law held, so that V_i times it is `∂(W_i V_i)/∂x_j`. `None`: the
    /// law has no potential, or terms of more than two points.
    pub own: Option<[f64; D]>,
}

/// Visits undirected bonds: slots i < j (images resolved), reference vector ξ, and whether they are whole.
pub type EachBond<'a, const D: usize> = dyn FnMut(usize, usize, [f64; D], BondStatus) + 'a;

/// Visits the ends of bonds, and ξ.
pub type EachPair<'a, const D: usize> = dyn FnMut(usize, usize, [f64; D]) + 'a;

/// Visits directed bonds with what they do.
pub type EachForce<'a, const D: usize> = dyn FnMut(BondForce<D>) + 'a;

/// Does a broken bond between two slots heal at this `e`?
pub type Heals<'a> = dyn Fn(usize, usize, f64) -> bool + 'a;

/// Does a crack cross the line between two places?
pub type Crosses<'a, const D: usize> = dyn Fn([f64; D], [f64; D]) -> bool + Sync + 'a;

/// Factors of the bond of a slot to another, so many cells away.
pub type FactorsOf<'a, const D: usize> = dyn Fn(usize, usize, [i32; D]) -> BondFactors<f64> + 'a;

/// A homogeneous displacement gradient `∂u_a/∂x_b`.
pub type Gradient<const D: usize> = [[f64; D]; D];
