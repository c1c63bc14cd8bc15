//! Space: lattices, regions, rigid shapes and surfaces of triangles. Everything here is three numbers wide; unused axes are 0.

pub mod fill;
pub mod lattice;
pub mod membership;
pub mod region;
pub mod rigid;
pub mod triangles;

/// A point or vector of physical space; unused axes are 0.
pub type Point = [f64; 3];

/// Volume of a ball in `d` dimensions (length^d).
pub fn ball_volume(d: usize, radius: f64) -> f64 {
    use std::f64::consts::PI;
    match d {
        1 => 2.0 * radius,
        2 => PI * radius.powi(2),
        _ => 4.0 / 3.0 * PI * radius.powi(3),
    }
}

pub const AXES: [char; 3] = ['x', 'y', 'z'];
