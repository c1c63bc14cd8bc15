//! Rigid shapes: how far a point is from their surface, what they hold, and how they resist a turn.
//!
//! Coordinates are those of the shape: its centre is the origin, on the axis of a cylinder and on the surface of a plane.

use super::triangles::Solid;
use super::{Point, dot, length};
use std::f64::consts::PI;
use std::sync::Arc;

#[derive(Debug, Clone, PartialEq)]
pub enum RigidShape {
    /// In 2-D a disk.
    Sphere { radius: f64 },
    /// Along the axes, by half of its edges (length); in 2-D a rectangle.
    Box { half: Point },
    /// About an axis (of length 1), with flat ends (3-D).
    Cylinder { radius: f64, half: f64, axis: Point },
    /// All of space behind it; the normal, of length 1, points out.
    Plane { normal: Point },
    /// Inside a closed surface (3-D).
    Solid(Arc<Solid>),
}

impl RigidShape {
    pub fn name(&self) -> &'static str {
        match self {
            RigidShape::Sphere { .. } => "sphere",
            RigidShape::Box { .. } => "box",
            RigidShape::Cylinder { .. } => "cylinder",
            RigidShape::Plane { .. } => "plane",
            RigidShape::Solid(_) => "surface of triangles",
        }
    }

    /// In which dimensions it is something.
    pub fn fits(&self, dimension: usize) -> bool {
        match self {
            RigidShape::Sphere { .. } | RigidShape::Plane { .. } => true,
            RigidShape::Box { .. } => dimension > 1,
            RigidShape::Cylinder { .. } | RigidShape::Solid(_) => dimension == 3,
        }
    }

    /// Signed distance of a point from the surface, negative inside, and the direction in which it grows (a unit vector). Where several places
    /// of the surface are equally near, one of their directions.
    pub fn distance(&self, x: &Point) -> (f64, Point) {
        match self {
            RigidShape::Sphere { radius } => {
                let r = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
                let out = if r > 0.0 {
                    x.map(|c| c / r)
                } else {
                    [0.0, 0.0, 1.0]
                };
                (r - radius, out)
            }
            RigidShape::Box { half } => {
                let beyond: Point = crate::array::from_fn(|a| x[a].abs() - half[a]);
                let (far, out) = corner(&beyond);
                (far, crate::array::from_fn(|a| out[a].copysign(x[a])))
            }
            RigidShape::Cylinder { radius, half, axis } => {
                let along = dot(x, axis);
                let across: Point = crate::array::from_fn(|a| x[a] - along * axis[a]);
                let rho = dot(&across, &across).sqrt();
                let (far, out) = corner(&[rho - radius, along.abs() - half]);
                // a point on the axis is as near to the mantle on every side
                let round = if rho > 0.0 {
                    across.map(|c| c / rho)
                } else {
                    aside(axis)
                };
                let up = out[1].copysign(along);
                (
                    far,
                    crate::array::from_fn(|a| out[0] * round[a] + up * axis[a]),
                )
            }
            RigidShape::Plane { normal } => (dot(x, normal), *normal),
            RigidShape::Solid(solid) => solid.distance(x),
        }
    }

    /// The longest way from its centre to its surface (length).
    pub fn reach(&self, dimension: usize) -> f64 {
        match self {
            RigidShape::Sphere { radius } => *radius,
            RigidShape::Box { half } => half[..dimension].iter().map(|h| h * h).sum::<f64>().sqrt(),
            RigidShape::Cylinder { radius, half, .. } => libm::hypot(*radius, *half),
            RigidShape::Plane { .. } => f64::INFINITY,
            RigidShape::Solid(solid) => solid.reach(),
        }
    }

    /// Length^D; infinite of a plane.
    pub fn volume(&self, dimension: usize) -> f64 {
        match self {
            RigidShape::Sphere { radius } => super::ball_volume(dimension, *radius),
            RigidShape::Box { half } => half[..dimension].iter().map(|h| 2.0 * h).product(),
            RigidShape::Cylinder { radius, half, .. } => 2.0 * PI * radius * radius * half,
            RigidShape::Plane { .. } => f64::INFINITY,
            RigidShape::Solid(solid) => solid.volume(),
        }
    }

    /// Moments of inertia about its centre over its mass (length²), of the same density everywhere: `∫ (x² 1 − x⊗x) dV / V`. In 2-D that about
    /// z alone counts.
    pub fn inertia(&self, dimension: usize) -> [Point; 3] {
        // ∫ x⊗x dV / V
        let second = match self {
            RigidShape::Sphere { radius } => {
                let each = radius * radius / (dimension as f64 + 2.0);
                diagonal([each; 3])
            }
            RigidShape::Box { half } => diagonal(half.map(|h| h * h / 3.0)),
            RigidShape::Cylinder { radius, half, axis } => {
                let (round, long) = (0.25 * radius * radius, half * half / 3.0);
                crate::array::from_fn(|a| {
                    let each = |b: usize| (long - round) * axis[a] * axis[b];
                    crate::array::from_fn(|b| each(b) + if a == b { round } else { 0.0 })
                })
            }
            RigidShape::Plane { .. } => diagonal([f64::INFINITY; 3]),
            RigidShape::Solid(solid) => solid.second_moments(),
        };
        let all = second[0][0] + second[1][1] + second[2][2];
        crate::array::from_fn(|a| {
            crate::array::from_fn(|b| match (a == b, dimension) {
                (true, 2) if a == 2 => second[0][0] + second[1][1],
                (true, _) => all - second[a][a],
                (false, _) => -second[a][b],
            })
        })
    }
}

/// A direction across an axis.
fn aside(axis: &Point) -> Point {
    let least = (1..3).fold(0, |m, a| if axis[a].abs() < axis[m].abs() { a } else { m });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let along = dot(&e, axis);
    let way: Point = crate::array::from_fn(|a| e[a] - along * axis[a]);
    let size = length(&way);
    way.map(|c| c / size)
}

fn diagonal(x: Point) -> [Point; 3] {
    crate::array::from_fn(|a| crate::array::from_fn(|b| if a == b { x[a] } else { 0.0 }))
}

/// Signed distance from a corner of which the coordinates are so far beyond, and its direction: outside to the corner, inside to the nearest
/// face (of equal ones the first).
fn corner<const N: usize>(beyond: &[f64; N]) -> (f64, [f64; N]) {
    let most = (1..N).fold(0, |m, a| if beyond[a] > beyond[m] { a } else { m });
    if (0..N).filter(|a| beyond[*a] > 0.0).count() <= 1 {
        let face = crate::array::from_fn(|a| f64::from(u8::from(a == most)));
        return (beyond[most], face);
    }
    let outside = beyond.map(|b| b.max(0.0));
    let far = outside.iter().map(|b| b * b).sum::<f64>().sqrt();
    (far, outside.map(|b| b / far))
}
