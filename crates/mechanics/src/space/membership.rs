//! Which sites of a lattice a region holds, decided by integers.
//!
//! A point that lies on the boundary of a region belongs to it; in floating point that is a lottery (the circle
//! of radius 37 mm through `24² + 70² = 74²` half millimetres loses eight sites). So each number of the region is
//! written in units of the lattice, coordinates in cell edges from the origin and squared radii in `spacing²`.
//! One that lies within round-off (`fraction::snap`) of a fraction with a small denominator *is* that fraction, and the
//! comparison is exact in 128-bit integers. A shape with a number that is no such fraction is compared in floating
//! point in the same units: no site can then be meant to lie exactly on its boundary.

mod compile;
mod fraction;
#[cfg(test)]
mod tests;

use super::lattice::Lattice;
use super::region::Region;
use crate::error::BuildError;
use compile::Units;

/// A region compiled for the sites of one lattice.
#[derive(Debug, Clone)]
pub struct Membership {
    shape: Shape,
}

/// Everything in quarters of the cell's edges.
#[derive(Debug, Clone)]
enum Shape {
    Everything,
    /// `low ≤ q ≤ high`
    Block {
        low: [i64; 3],
        high: [i64; 3],
    },
    /// `Σ weight (q·scale − center)² ≤ limit` and `low ≤ q ≤ high`; weight 0 along the axis of a cylinder
    Round {
        weight: [i128; 3],
        scale: i128,
        center: [i128; 3],
        limit: i128,
        low: [i64; 3],
        high: [i64; 3],
    },
    RoundFloat {
        weight: [f64; 3],
        center: [f64; 3],
        limit: f64,
        low: [i64; 3],
        high: [i64; 3],
    },
    /// `Σ weight q ≤ limit`
    Plane {
        weight: [i128; 3],
        limit: i128,
    },
    PlaneFloat {
        weight: [f64; 3],
        limit: f64,
    },
    Union(Vec<Shape>),
    Difference(Box<Shape>, Vec<Shape>),
    Intersection(Vec<Shape>),
}

impl Membership {
    /// # Errors
    /// The region's numbers make no shape ([`Region::check`]), or the lattice has no positive spacing.
    pub fn new(lattice: &Lattice, region: &Region) -> Result<Self, BuildError> {
        let spacing = lattice.spacing;
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(BuildError::invalid(
                "body.spacing",
                format!("the lattice spacing must be positive, it is {spacing}"),
            ));
        }
        if !lattice.origin.iter().all(|o| o.is_finite()) {
            return Err(BuildError::invalid(
                "body.origin",
                format!("the origin must be finite, it is {:?}", lattice.origin),
            ));
        }
        region
            .check()
            .map_err(|message| BuildError::invalid("body.region", message))?;
        Ok(Membership {
            shape: Units::new(lattice).compile(region),
        })
    }

    /// Whether the site `quarter` (see [`Lattice::position`]) is inside or on the boundary.
    pub fn contains(&self, quarter: [i32; 3]) -> bool {
        self.shape.contains(quarter)
    }
}

impl Shape {
    fn contains(&self, q: [i32; 3]) -> bool {
        let within = |low: &[i64; 3], high: &[i64; 3]| {
            (0..3).all(|a| low[a] <= q[a] as i64 && q[a] as i64 <= high[a])
        };
        match self {
            Shape::Everything => true,
            Shape::Block { low, high } => within(low, high),
            Shape::Round {
                weight,
                scale,
                center,
                limit,
                low,
                high,
            } => {
                within(low, high)
                    && (0..3)
                        .map(|a| weight[a] * (q[a] as i128 * scale - center[a]).pow(2))
                        .sum::<i128>()
                        <= *limit
            }
            Shape::RoundFloat {
                weight,
                center,
                limit,
                low,
                high,
            } => {
                within(low, high)
                    && (0..3)
                        .map(|a| weight[a] * (q[a] as f64 - center[a]).powi(2))
                        .sum::<f64>()
                        <= *limit
            }
            Shape::Plane { weight, limit } => {
                (0..3).map(|a| weight[a] * q[a] as i128).sum::<i128>() <= *limit
            }
            Shape::PlaneFloat { weight, limit } => {
                (0..3).map(|a| weight[a] * q[a] as f64).sum::<f64>() <= *limit
            }
            Shape::Union(parts) => parts.iter().any(|part| part.contains(q)),
            Shape::Difference(from, minus) => {
                from.contains(q) && !minus.iter().any(|part| part.contains(q))
            }
            Shape::Intersection(parts) => parts.iter().all(|part| part.contains(q)),
        }
    }
}
