//! Influence functions ω of the bond length.

use crate::spec::Influence;

/// ω(r) for a horizon δ.
pub fn influence(kind: Influence, r: f64, horizon: f64) -> f64 {
    let q = r / horizon;
    match kind {
        Influence::Constant => 1.0,
        Influence::Inverse => 1.0 / r,
        Influence::Conical => 1.0 - q,
        Influence::Gaussian => (-4.0 * q * q).exp(),
        // B-spline with knots at δ/2 and δ, scaled to 1 at the centre
        Influence::CubicSpline if q <= 0.5 => 1.0 - 6.0 * q * q + 6.0 * q * q * q,
        Influence::CubicSpline if q <= 1.0 => 2.0 * (1.0 - q).powi(3),
        Influence::CubicSpline => 0.0,
    }
}
