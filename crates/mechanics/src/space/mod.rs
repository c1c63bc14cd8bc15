//! Space: lattices, regions, rotations, rigid shapes and surfaces of triangles. Everything here is three numbers wide; unused axes are 0.

pub mod cells;
pub mod face;
pub mod fill;
pub mod lattice;
pub mod measure;
pub mod membership;
pub mod region;
pub mod rigid;
pub mod rotation;
pub mod triangles;

/// A point or vector of physical space; unused axes are 0.
pub type Point = [f64; 3];

pub fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: &Point, b: &Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// A place or vector of D axes, with 0 along the others.
pub fn full<const D: usize>(x: &[f64; D]) -> Point {
    crate::array::from_fn(|a| x.get(a).copied().unwrap_or(0.0))
}

pub fn length(a: &Point) -> f64 {
    dot(a, a).sqrt()
}

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
