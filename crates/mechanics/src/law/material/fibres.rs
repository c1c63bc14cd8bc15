//! Bonds that lie along a direction of the reference, and all others.

use crate::law::number::Number;

/// Square of the sine of the angle up to which a bond lies along a direction. Rows of a lattice whose families reach m spacings are more than
/// 1/m² apart; what rounding leaves of positions and of directions as people write them is less.
const ALONG: f64 = 1e-8;

/// Fibres of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fibres<const D: usize> {
    /// Of length one.
    pub direction: [f64; D],
    /// Stretch beyond which a bond along them breaks; ∞: never.
    pub critical: f64,
}

/// `fibre` where ξ lies along the direction of length one, else `matrix`.
#[inline(always)]
pub fn of_kind<N: Number, const D: usize>(
    direction: &[N; D],
    xi: &[N; D],
    fibre: N,
    matrix: N,
) -> N {
    let mut along = direction[0] * xi[0];
    let mut square = xi[0] * xi[0];
    for a in 1..D {
        along = direction[a].fma(xi[a], along);
        square = xi[a].fma(xi[a], square);
    }
    // cos² of the angle
    (along * along).choose(square.times(1.0 - ALONG), matrix, fibre)
}
