//! What increments need of a body, and what acts on it.

use peridyne::spec::LinearBody;

/// A body of any law, as increments see it. Points are those of its reference, in order; forces are per point.
pub trait Nonlinear<const D: usize> {
    /// Forces of bonds at displacements `u`, nothing breaking and laws remembering what they did before.
    fn forces(&mut self, u: &[[f64; D]]) -> Vec<[f64; D]>;
    /// The linear body about `u`. Its positions are those about which a rotation meets no force: where points are now, or the reference of a body
    /// that is linear.
    fn tangent(&mut self, u: &[[f64; D]]) -> LinearBody<D>;
    /// An increment has come to `u`: bonds that do not bear it break, and laws remember. How many bonds broke; each of its ends counts.
    fn arrive(&mut self, u: &[[f64; D]]) -> u64;
}

/// What acts at the end of an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct Load<const D: usize> {
    /// `[N]` (force).
    pub force: Vec<[f64; D]>,
    /// `[N]` prescribed displacements (length); the same components in every increment.
    pub held: Vec<[Option<f64>; D]>,
}
