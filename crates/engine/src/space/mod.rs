//! Space: lattices and regions. Everything here is three numbers wide; unused axes are 0.

pub mod fill;
pub mod lattice;
pub mod membership;
pub mod region;

/// A point or vector of physical space; unused axes are 0.
pub type Point = [f64; 3];

pub const AXES: [char; 3] = ['x', 'y', 'z'];
