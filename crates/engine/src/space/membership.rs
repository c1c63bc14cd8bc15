//! Which sites of a lattice a region holds, decided by integers.
//!
//! A point that lies on the boundary of a region belongs to it; in floating point that is a lottery (the circle
//! of radius 37 mm through `24² + 70² = 74²` half millimetres loses eight sites). So each number of the region is
//! written in units of the lattice, coordinates in cell edges from the origin and squared radii in `spacing²`.
//! One that lies within round-off ([`snap`]) of a fraction with a small denominator *is* that fraction, and the
//! comparison is exact in 128-bit integers. A shape with a number that is no such fraction is compared in floating
//! point in the same units: no site can then be meant to lie exactly on its boundary.

use super::lattice::Lattice;
use super::region::Region;
use crate::error::BuildError;

/// Largest denominator that a typed number is taken to mean.
const DENOMINATOR: i64 = 64;

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
            return Err(BuildError::new(
                "body.spacing",
                format!("the lattice spacing must be positive, it is {spacing}"),
            ));
        }
        if !lattice.origin.iter().all(|o| o.is_finite()) {
            return Err(BuildError::new(
                "body.origin",
                format!("the origin must be finite, it is {:?}", lattice.origin),
            ));
        }
        region
            .check()
            .map_err(|message| BuildError::new("body.region", message))?;
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

/// Lengths in units of a lattice.
struct Units {
    origin: [f64; 3],
    spacing: f64,
    edge: [f64; 3],
    edge_squared: [i64; 3],
}

impl Units {
    fn new(lattice: &Lattice) -> Self {
        let dimension = lattice.kind.dimension();
        // unused axes have their sites at 0 whatever the origin says
        let origin = std::array::from_fn(|a| {
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

    fn compile(&self, region: &Region) -> Shape {
        let all = |parts: &[Region]| parts.iter().map(|part| self.compile(part)).collect();
        match region {
            Region::Everything => Shape::Everything,
            Region::Block { low, high } => {
                let ends: [(i64, i64); 3] = std::array::from_fn(|a| self.range(a, low[a], high[a]));
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
                let axes = std::array::from_fn(|a| a != *axis);
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
        let quarters: [f64; 3] = std::array::from_fn(|a| {
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
                weight: std::array::from_fn(|a| i128::from(used(a)) * d),
                scale: common / 4,
                center: cells
                    .map(|c| i128::from(c.numerator) * (common / i128::from(c.denominator))),
                limit: i128::from(squared.numerator).checked_mul(common * common)?,
                low,
                high,
            })
        };
        exact().unwrap_or_else(|| Shape::RoundFloat {
            weight: std::array::from_fn(|a| used(a) as f64),
            center: quarters,
            limit: 16.0 * radius * radius,
            low,
            high,
        })
    }

    fn plane(&self, point: &[f64; 3], normal: &[f64; 3]) -> Shape {
        let mut weight: [f64; 3] = std::array::from_fn(|a| normal[a] * self.edge[a]);
        let largest = weight.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        weight = weight.map(|w| w / largest);
        let quarters: [f64; 3] = std::array::from_fn(|a| {
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

#[derive(Debug, Clone, Copy, PartialEq)]
struct Fraction {
    numerator: i64,
    denominator: i64,
}

impl Fraction {
    fn value(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

/// How far a number in lattice units may be off the fraction that is meant: typed decimals and the round-off of
/// the division by the spacing.
fn tolerance(v: f64) -> f64 {
    1e-9 + 1e-14 * v.abs()
}

/// The fraction with the smallest denominator (up to 64, or `also`) within [`tolerance`] of `v`.
fn snap(v: f64, also: i64) -> Option<Fraction> {
    if v.abs() > 1e15 {
        return None;
    }
    (1..=DENOMINATOR).chain([also]).find_map(|denominator| {
        let numerator = (v * denominator as f64).round();
        let near = (v - numerator / denominator as f64).abs() <= tolerance(v);
        near.then_some(Fraction {
            numerator: numerator as i64,
            denominator,
        })
    })
}

fn lcm(a: i64, b: i64) -> i64 {
    let (mut g, mut r) = (a, b);
    while r != 0 {
        (g, r) = (r, g % r);
    }
    a / g * b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::lattice::LatticeKind;

    fn holds(
        kind: LatticeKind,
        spacing: f64,
        origin: [f64; 3],
        region: &Region,
        q: [i32; 3],
    ) -> bool {
        Membership::new(
            &Lattice {
                kind,
                spacing,
                origin,
            },
            region,
        )
        .unwrap()
        .contains(q)
    }

    #[test]
    fn a_radius_means_its_fraction() {
        // 37 mm at half a millimetre: (24, 70) lies on the circle, and floating point says it does not
        let disk = Region::Cylinder {
            axis: 1,
            center: [0.0; 3],
            radius: 0.037,
            low: 0.0,
            high: 1.0,
        };
        let spacing = 0.0005;
        assert!(!disk.contains(&[24.0 * spacing, 0.0, 70.0 * spacing]));
        assert!(holds(
            LatticeKind::Cubic,
            spacing,
            [0.0; 3],
            &disk,
            [96, 0, 280]
        ));
        assert!(!holds(
            LatticeKind::Cubic,
            spacing,
            [0.0; 3],
            &disk,
            [96, 0, 284]
        ));
        // a centre off the sites: distances² are in quarters, 2.5² + 6² = 6.5²
        let off = Region::Sphere {
            center: [0.05, 0.1, 0.1],
            radius: 0.65,
        };
        assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &off, [12, 28, 4]));
        // thirds: (1 + 2/3)² + 4² = (13/3)²
        let third = Region::Sphere {
            center: [0.1 / 3.0, 0.0, 0.0],
            radius: 1.3 / 3.0,
        };
        assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &third, [8, 16, 0]));
    }

    #[test]
    fn blocks_and_planes_hold_their_faces() {
        let block = Region::Block {
            low: [0.1 + 0.2, 0.0, -f64::INFINITY],
            high: [0.7, f64::INFINITY, 0.0],
        };
        for (q, inside) in [
            ([12, 0, 0], true),
            ([28, 0, 0], true),
            ([11, 0, 0], false),
            ([29, 0, 0], false),
            ([12, -1, 0], false),
            ([12, 999, -999], true),
        ] {
            assert_eq!(
                holds(LatticeKind::Cubic, 0.1, [0.0; 3], &block, q),
                inside,
                "{q:?}"
            );
        }
        let n = 1.0 / 3.0f64.sqrt();
        let plane = Region::HalfSpace {
            point: [0.3, 0.3, 0.3],
            normal: [n, n, n],
        };
        assert!(holds(LatticeKind::Fcc, 0.1, [0.0; 3], &plane, [34, 2, 0]));
        assert!(!holds(LatticeKind::Fcc, 0.1, [0.0; 3], &plane, [34, 2, 1]));
        let skew = Region::HalfSpace {
            point: [0.0; 3],
            normal: [1.0, std::f64::consts::PI, 0.0],
        };
        assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &skew, [0, 0, 4]));
        assert!(!holds(
            LatticeKind::Cubic,
            0.1,
            [0.0; 3],
            &skew,
            [-12, 4, 0]
        ));
    }

    #[test]
    fn triangular_rows_are_exact() {
        let s = 0.3;
        let radius = s * 7.0; // 7² = 5.5² + 3·2.5²
        let disk = Region::Sphere {
            center: [0.0; 3],
            radius,
        };
        assert!(holds(
            LatticeKind::Triangular,
            s,
            [0.0; 3],
            &disk,
            [22, 10, 0]
        ));
        let rows = Region::Block {
            low: [-1.0; 3],
            high: [1.0, 3f64.sqrt() / 2.0 * s * 3.0, 1.0],
        };
        assert!(holds(
            LatticeKind::Triangular,
            s,
            [0.0; 3],
            &rows,
            [2, 6, 0]
        ));
    }

    #[test]
    fn the_origin_moves_the_sites_but_not_the_unused_axes() {
        let block = Region::Block {
            low: [1.0, 0.0, 0.0],
            high: [2.0, 0.0, 0.0],
        };
        assert!(holds(
            LatticeKind::Chain,
            0.1,
            [0.05, 9.0, 9.0],
            &block,
            [38, 0, 0]
        ));
        assert!(!holds(
            LatticeKind::Chain,
            0.1,
            [0.05, 9.0, 9.0],
            &block,
            [37, 0, 0]
        ));
    }
}
