//! `region`: which positions belong, with LAMMPS's floating-point tests.

use std::rc::Rc;

use super::fix::Input;

/// Stands for infinity, as in LAMMPS.
pub const INF: f64 = 1e20;

/// The shape of a region; lengths are in box units already.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    Block {
        low: [f64; 3],
        high: [f64; 3],
    },
    /// Along `axis`, around `center` (the two other axes in ascending order, y-axis: x, z).
    Cylinder {
        axis: usize,
        center: [f64; 2],
        radius: f64,
        low: f64,
        high: f64,
    },
    Sphere {
        center: [f64; 3],
        radius: f64,
    },
    /// A cylinder whose radius goes from `radii[0]` at `low` to `radii[1]` at `high`.
    Cone {
        axis: usize,
        center: [f64; 2],
        radii: [f64; 2],
        low: f64,
        high: f64,
    },
    /// Semi-axes along x, y, z; in two dimensions z counts for nothing.
    Ellipsoid {
        center: [f64; 3],
        semi: [f64; 3],
        flat: bool,
    },
    /// What a plane's unit normal points to.
    Plane {
        point: [f64; 3],
        normal: [f64; 3],
    },
    /// A block whose edges are tilted by xy, xz, yz.
    Prism {
        low: [f64; 3],
        high: [f64; 3],
        tilt: [f64; 3],
    },
    Union(Vec<Region>),
    Intersect(Vec<Region>),
}

/// A shape, or everything outside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    pub shape: Shape,
    pub outside: bool,
}

/// A region as it was defined: numbers in box units, variables (which are in `unit`) to be evaluated whenever it is used.
#[derive(Debug, Clone, PartialEq)]
pub struct Definition {
    pub kind: Kind,
    pub values: Vec<Input>,
    /// Lattice constant, or 1.
    pub unit: f64,
    pub outside: bool,
    pub parts: Vec<Rc<Definition>>,
    /// Regions without parts in it.
    pub leaves: usize,
    /// Two dimensions.
    pub flat: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Block,
    Cylinder(usize),
    Sphere,
    Cone(usize),
    Ellipsoid,
    Plane,
    Prism,
    Union,
    Intersect,
}

impl Definition {
    /// The region for these values, one for each of `values`.
    ///
    /// # Errors
    /// A sentence about a region that cannot be.
    pub fn shape(&self, v: &[f64], parts: Vec<Region>) -> Result<Region, String> {
        let three = |k: usize| [v[k], v[k + 1], v[k + 2]];
        let positive = |r: f64, what: &str| match r >= 0.0 {
            true => Ok(r),
            false => Err(format!("has the negative {what} {r}")),
        };
        let ends = |low: f64, high: f64| match low <= high {
            true => Ok((low, high)),
            false => Err(format!("is empty: {low} is above {high}")),
        };
        let shape = match self.kind {
            Kind::Block | Kind::Prism => {
                let (low, high) = ([v[0], v[2], v[4]], [v[1], v[3], v[5]]);
                if let Some(a) = (0..3).find(|&a| low[a] > high[a]) {
                    let (l, h) = (low[a], high[a]);
                    let a = ["x", "y", "z"][a];
                    return Err(format!("is empty: {a}lo = {l} is above {a}hi = {h}"));
                }
                if self.kind == Kind::Prism {
                    Shape::Prism {
                        low,
                        high,
                        tilt: three(6),
                    }
                } else {
                    Shape::Block { low, high }
                }
            }
            Kind::Cylinder(axis) => {
                let (low, high) = ends(v[3], v[4])?;
                Shape::Cylinder {
                    axis,
                    center: [v[0], v[1]],
                    radius: positive(v[2], "radius")?,
                    low,
                    high,
                }
            }
            Kind::Sphere => Shape::Sphere {
                center: three(0),
                radius: positive(v[3], "radius")?,
            },
            Kind::Cone(axis) => {
                let (low, high) = ends(v[4], v[5])?;
                if low == high {
                    return Err("is a cone without height".to_string());
                }
                Shape::Cone {
                    axis,
                    center: [v[0], v[1]],
                    radii: [positive(v[2], "radius")?, positive(v[3], "radius")?],
                    low,
                    high,
                }
            }
            Kind::Ellipsoid => Shape::Ellipsoid {
                center: three(0),
                semi: [
                    positive(v[3], "semi-axis")?,
                    positive(v[4], "semi-axis")?,
                    positive(v[5], "semi-axis")?,
                ],
                flat: self.flat,
            },
            Kind::Plane => {
                let n = three(3);
                let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
                if length == 0.0 {
                    return Err("is a plane without a normal".to_string());
                }
                Shape::Plane {
                    point: three(0),
                    normal: n.map(|c| c / length),
                }
            }
            Kind::Union => Shape::Union(parts),
            Kind::Intersect => Shape::Intersect(parts),
        };
        Ok(Region {
            shape,
            outside: self.outside,
        })
    }
}

/// The two axes across `axis`.
fn across(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

impl Region {
    /// Is `x` in the region? Surfaces belong to the inside.
    pub fn contains(&self, x: [f64; 3]) -> bool {
        let inside = match &self.shape {
            Shape::Block { low, high } => (0..3).all(|a| x[a] >= low[a] && x[a] <= high[a]),
            Shape::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let [p, q] = across(*axis);
                let (d, e) = (x[p] - center[0], x[q] - center[1]);
                (d * d + e * e).sqrt() <= *radius && x[*axis] >= *low && x[*axis] <= *high
            }
            Shape::Sphere { center, radius } => {
                let d = [0, 1, 2].map(|a| x[a] - center[a]);
                (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() <= *radius
            }
            Shape::Cone {
                axis,
                center,
                radii,
                low,
                high,
            } => {
                let [p, q] = across(*axis);
                let (d, e) = (x[p] - center[0], x[q] - center[1]);
                let radius = radii[0] + (x[*axis] - low) * (radii[1] - radii[0]) / (high - low);
                (d * d + e * e).sqrt() <= radius && x[*axis] >= *low && x[*axis] <= *high
            }
            Shape::Ellipsoid { center, semi, flat } => {
                let [a, b, c] = *semi;
                let d = [0, 1, 2].map(|k| x[k] - center[k]);
                if *flat {
                    let (d, e) = (b * d[0], a * d[1]);
                    d * d + e * e <= a * a * b * b
                } else {
                    let d = [b * c * d[0], a * c * d[1], a * b * d[2]];
                    d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= a * a * b * b * c * c
                }
            }
            Shape::Plane { point, normal } => {
                let d = [0, 1, 2].map(|a| (x[a] - point[a]) * normal[a]);
                d[0] + d[1] + d[2] >= 0.0
            }
            Shape::Prism { low, high, tilt } => {
                // in the coordinates of the edges
                let [w, h, d] = [0, 1, 2].map(|a| high[a] - low[a]);
                let [xy, xz, yz] = *tilt;
                let p = [0, 1, 2].map(|a| x[a] - low[a]);
                let edges = [
                    p[0] / w - xy / (w * h) * p[1] + (xy * yz - h * xz) / (w * h * d) * p[2],
                    p[1] / h - yz / (h * d) * p[2],
                    p[2] / d,
                ];
                edges.iter().all(|c| (0.0..=1.0).contains(c))
            }
            Shape::Union(parts) => parts.iter().any(|r| r.contains(x)),
            Shape::Intersect(parts) => parts.iter().all(|r| r.contains(x)),
        };
        inside != self.outside
    }

    /// Smallest box around it, if it is bounded.
    pub fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        if self.outside {
            return None;
        }
        let bounds = match &self.shape {
            Shape::Block { low, high } => (*low, *high),
            Shape::Cylinder {
                axis,
                center,
                radius,
                low,
                high,
            } => {
                let [p, q] = across(*axis);
                let (mut a, mut b) = ([0.0; 3], [0.0; 3]);
                (a[p], b[p]) = (center[0] - radius, center[0] + radius);
                (a[q], b[q]) = (center[1] - radius, center[1] + radius);
                (a[*axis], b[*axis]) = (*low, *high);
                (a, b)
            }
            Shape::Sphere { center, radius } => {
                (center.map(|c| c - radius), center.map(|c| c + radius))
            }
            Shape::Cone {
                axis,
                center,
                radii,
                low,
                high,
            } => {
                let cylinder = Shape::Cylinder {
                    axis: *axis,
                    center: *center,
                    radius: radii[0].max(radii[1]),
                    low: *low,
                    high: *high,
                };
                let outside = false;
                Region {
                    shape: cylinder,
                    outside,
                }
                .bounds()?
            }
            Shape::Ellipsoid { center, semi, .. } => (
                [0, 1, 2].map(|a| center[a] - semi[a]),
                [0, 1, 2].map(|a| center[a] + semi[a]),
            ),
            Shape::Plane { .. } => return None,
            Shape::Prism { low, high, tilt } => {
                let [xy, xz, yz] = *tilt;
                let least = |a: &[f64]| a.iter().copied().fold(0.0, f64::min);
                let most = |a: &[f64]| a.iter().copied().fold(0.0, f64::max);
                let along_x = [xy, xz, xy + xz];
                (
                    [low[0] + least(&along_x), low[1] + least(&[yz]), low[2]],
                    [high[0] + most(&along_x), high[1] + most(&[yz]), high[2]],
                )
            }
            Shape::Union(parts) => {
                let all: Option<Vec<_>> = parts.iter().map(Region::bounds).collect();
                all?.into_iter()
                    .reduce(|a, b| pick(a, b, f64::min, f64::max))?
            }
            Shape::Intersect(parts) => parts
                .iter()
                .filter_map(Region::bounds)
                .reduce(|a, b| pick(a, b, f64::max, f64::min))?,
        };
        let finite = bounds.0.iter().chain(&bounds.1).all(|x| x.abs() < INF);
        finite.then_some(bounds)
    }
}

type Corners = ([f64; 3], [f64; 3]);

fn pick(a: Corners, b: Corners, low: fn(f64, f64) -> f64, high: fn(f64, f64) -> f64) -> Corners {
    (
        [0, 1, 2].map(|k| low(a.0[k], b.0[k])),
        [0, 1, 2].map(|k| high(a.1[k], b.1[k])),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inside(shape: Shape) -> Region {
        Region {
            shape,
            outside: false,
        }
    }

    /// i² + k² = 74² in units of half a millimetre: four of these points lose to rounding, two do not.
    #[test]
    fn the_edge_of_a_cylinder_is_decided_by_rounding() {
        let c = inside(Shape::Cylinder {
            axis: 1,
            center: [0.0; 2],
            radius: 0.037,
            low: -0.0025,
            high: 0.0,
        });
        let at = |i: f64, k: f64| c.contains([i * 0.0005, 0.0, k * 0.0005]);
        assert!(at(74.0, 0.0) && at(0.0, -74.0));
        assert!(!at(24.0, 70.0) && !at(-70.0, 24.0));
    }

    #[test]
    fn bounds_of_combinations() {
        let b = |x: f64| {
            inside(Shape::Block {
                low: [x, 0.0, 0.0],
                high: [x + 2.0, 1.0, 1.0],
            })
        };
        let union = inside(Shape::Union(vec![b(0.0), b(1.0)]));
        assert_eq!(union.bounds(), Some(([0.0; 3], [3.0, 1.0, 1.0])));
        let both = inside(Shape::Intersect(vec![b(0.0), b(1.0)]));
        assert_eq!(both.bounds(), Some(([1.0, 0.0, 0.0], [2.0, 1.0, 1.0])));
        assert!(both.contains([1.5, 0.5, 0.5]) && !both.contains([0.5, 0.5, 0.5]));
        assert_eq!(
            Region {
                outside: true,
                ..b(0.0)
            }
            .bounds(),
            None
        );
    }
}
