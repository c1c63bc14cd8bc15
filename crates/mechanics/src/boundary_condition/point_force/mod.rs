//! Forces on the points of a set that a spec names: a file each, and a line in [`each`].

mod absorbing_layer;
mod described;
mod of_function;

pub use absorbing_layer::AbsorbingLayer;
pub use described::{Described, Kinds, LocalForce, Placed, PointForce, Seen, Stiffness};
pub use of_function::OfFunction;

/// All that come with the engine.
pub fn each(kinds: &mut impl Kinds) {
    kinds.force::<AbsorbingLayer>();
}
