//! Regions in units of a lattice: integers where the region's numbers are fractions, floating point where not.

use super::Shape;
use super::fraction::{Fraction, lcm, snap, tolerance};
use crate::space::lattice::Lattice;
use crate::space::region::Region;

/// Lengths in units of a lattice.
pub(super) struct Units {
    origin: [f64; 3],
    spacing: f64,
    edge: [f64; 3],
    edge_squared: [i64; 3],
}

impl Units {
    pub fn new(lattice: &Lattice) -> Self {
        let dimension = lattice.kind.dimension();
        // unused axes have their sites at 0 whatever the origin says
        let origin = crate::array::from_fn(|a| {
            if a < dimension {
                lattice.origin[a]
            } else {
                0.0
            }
        });
        Units {
            origin,
            spacing: lattice.spacing,
            edge: lattice.kind.edges(),
            edge_squared: lattice.kind.edge_squared(),
        }
    }

    /// A coordinate in quarters of the cell's edge.
    fn quarters(&self, axis: usize, x: f64) -> f64 {
        4.0 * ((x - self.origin[axis]) / (self.spacing * self.edge[axis]))
    }

    /// The integers between two coordinates, inclusive.
    fn range(&self, axis: usize, low: f64, high: f64) -> (i64, i64) {
        let end = |x: f64, round: fn(f64) -> f64| {
            let q = self.quarters(axis, x);
            // a quarter that is off by round-off is meant; `as` saturates at the infinite ends
            let whole = q.round();
            if (q - whole).abs() <= 4.0 * tolerance(q) {
                whole as i64
            } else {
                round(q) as i64
            }
        };
        (end(low, f64::ceil), end(high, f64::floor))
    }

    pub fn compile(&self, region: &Region) -> Shape {
        let all = |parts: &[Region]| parts.iter().map(|part| self.compile(part)).collect();
        match region {
            Region::Everything => Shape::Everything,
            Region::Block { low, high } => {
                let ends: [(i64, i64); 3] =
                    crate::array::from_fn(|a| self.range(a, low[a], high[a]));
                Shape::Block {
                    low: ends.map(|e| e.0),
                    high: ends.map(|e| e.1),
                }
            }
            Region::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let (mut from, mut to) = ([i64::MIN; 3], [i64::MAX; 3]);
                (from[*axis], to[*axis]) = self.range(*axis, *low, *high);
                let axes = crate::array::from_fn(|a| a != *axis);
                self.round(axes, center, *radius, from, to)
            }
            Region::Sphere { center, radius } => {
                self.round([true; 3], center, *radius, [i64::MIN; 3], [i64::MAX; 3])
            }
            Region::HalfSpace { point, normal } => self.plane(point, normal),
            Region::Union(parts) => Shape::Union(all(parts)),
            Region::Difference(from, minus) => {
                Shape::Difference(Box::new(self.compile(from)), all(minus))
            }
            Region::Intersection(parts) => Shape::Intersection(all(parts)),
        }
    }

    fn round(
        &self,
        axes: [bool; 3],
        center: &[f64; 3],
        radius: f64,
        low: [i64; 3],
        high: [i64; 3],
    ) -> Shape {
        let used = |a: usize| if axes[a] { self.edge_squared[a] } else { 0 };
        let radius = radius / self.spacing;
        let quarters: [f64; 3] = crate::array::from_fn(|a| {
            if axes[a] {
                self.quarters(a, center[a])
            } else {
                0.0
            }
        });
        let exact = || {
            let cells: [Fraction; 3] = try_array(|a| snap(quarters[a] / 4.0, 1))?;
            let common = cells.iter().fold(4, |n, c| lcm(n, c.denominator));
            // squared distances of sites from this centre are multiples of 1/common²
            let squared = snap(radius * radius, common * common)?;
            // i128 holds (2³¹ · common)² · 3 · denominator for all of these
            if common > 4096
                || quarters.iter().any(|q| q.abs() > 2e9)
                || squared.numerator > 1 << 62
            {
                return None;
            }
            let d = i128::from(squared.denominator);
            let common = i128::from(common);
            Some(Shape::Round {
                weight: crate::array::from_fn(|a| i128::from(used(a)) * d),
                scale: common / 4,
                center: cells
                    .map(|c| i128::from(c.numerator) * (common / i128::from(c.denominator))),
                limit: i128::from(squared.numerator).checked_mul(common * common)?,
                low,
                high,
            })
        };
        exact().unwrap_or_else(|| Shape::RoundFloat {
            weight: crate::array::from_fn(|a| used(a) as f64),
            center: quarters,
            limit: 16.0 * radius * radius,
            low,
            high,
        })
    }

    fn plane(&self, point: &[f64; 3], normal: &[f64; 3]) -> Shape {
        let mut weight: [f64; 3] = crate::array::from_fn(|a| normal[a] * self.edge[a]);
        let largest = weight.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        weight = weight.map(|w| w / largest);
        let quarters: [f64; 3] = crate::array::from_fn(|a| {
            let q = self.quarters(a, point[a]);
            snap(q, 1).map_or(q, |f| f.value())
        });
        let limit = (0..3)
            .map(|a| {
                if weight[a] == 0.0 {
                    0.0
                } else {
                    weight[a] * quarters[a]
                }
            })
            .sum::<f64>();
        let exact = || {
            let weights: [Fraction; 3] = try_array(|a| snap(weight[a], 1))?;
            let common = weights.iter().fold(1, |n, w| lcm(n, w.denominator));
            let limit = snap(limit, common)?;
            let d = i128::from(limit.denominator);
            Some(Shape::Plane {
                weight: weights.map(|w| i128::from(w.numerator * (common / w.denominator)) * d),
                limit: i128::from(limit.numerator) * i128::from(common),
            })
        };
        exact().unwrap_or(Shape::PlaneFloat { weight, limit })
    }
}

fn try_array(f: impl Fn(usize) -> Option<Fraction>) -> Option<[Fraction; 3]> {
    Some([f(0)?, f(1)?, f(2)?])
}
