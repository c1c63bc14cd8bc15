//! Fracture beyond the single bond: cracks that are there from the start, and the pieces that are left in the end.

pub mod fragments;
pub mod precrack;
