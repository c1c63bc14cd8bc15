//! What pulls surfaces together.

/// What pulls what is near, and takes the work of adhesion w to be pulled off.
///
/// A rigid surface: the traction on a point at a gap g is `27/4 σ s (1 − s)²` with `s = g/δ`, greatest (σ) at a third of its
/// range `δ = 16 w/(9 σ)`, and what it does from there to the end of the range is w (Needleman 1987, with one direction
/// and no path of its own for unloading). Bodies of points: [`Adhesion`](crate::interaction::cohesion::Adhesion), where σ is the traction of
/// faces that touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CohesionSpec {
    /// w (energy / area)
    pub energy: f64,
    /// σ (force / area)
    pub strength: f64,
}

impl CohesionSpec {
    /// δ of a rigid surface (length)
    pub fn range(&self) -> f64 {
        16.0 / 9.0 * self.energy / self.strength
    }
}
