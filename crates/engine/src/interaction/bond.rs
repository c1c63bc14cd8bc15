//! The arithmetic of one bond, shared by all families.

use crate::execute::lane::Lane;
use crate::execute::lane::series::{Function, Stretch};

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
