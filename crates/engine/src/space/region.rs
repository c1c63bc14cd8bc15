//! Regions: which points of space belong to a body or a set.

/// A region of space. Boundaries belong to the region.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    Everything,
    /// Axis-parallel box; ±∞ allowed.
    Block {
        low: [f64; 3],
        high: [f64; 3],
    },
    /// Cylinder along `axis` (0, 1, 2) around `center` (the component along the axis is ignored), from `low` to `high`.
    Cylinder {
        axis: usize,
        center: [f64; 3],
        radius: f64,
        low: f64,
        high: f64,
    },
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    /// Points with `normal · (x − point) ≤ 0`.
    HalfSpace {
        point: [f64; 3],
        normal: [f64; 3],
    },
    Union(Vec<Region>),
    /// The first minus all others.
    Difference(Box<Region>, Vec<Region>),
    Intersection(Vec<Region>),
}
