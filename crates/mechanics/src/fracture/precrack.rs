//! Pre-cracks: flat shapes and surfaces of triangles, and whether a bond crosses one.
//!
//! A crack has a normal: left of the segment from its first to its second end, the normal of the disk, the direction
//! around which the corners of the polygon turn counter-clockwise, +x for a point. A bond crosses the crack if its
//! ends lie on different sides of the crack's plane and it meets the plane inside the shape, rim included. A point on
//! the plane belongs to the side the normal points to, so a crack through a lattice plane cuts every bond across it
//! exactly once, and none within it. A surface is crossed where one of its triangles is, each a polygon of its own. "On" means within 1e-9 of the bond's length: round-off decides nothing.

use crate::error::BuildError;
use crate::message;
use crate::quantity::{Dimension, Message, place};
use crate::space::triangles::{Tree, Triangles};
use crate::spec::CrackShape;

/// Fraction of a bond's length that counts as nothing.
const TOLERANCE: f64 = 1e-9;

/// A crack ready to be tested against many bonds.
#[derive(Debug, Clone)]
pub struct Crack<const D: usize> {
    /// A point of the crack's plane.
    point: [f64; D],
    /// Unit normal.
    normal: [f64; D],
    /// Box around the shape.
    low: [f64; D],
    high: [f64; D],
    outline: Outline<D>,
    /// The crack recurs at these distances in a periodic body; the first is 0.
    shifts: Vec<[f64; D]>,
}

/// What of the plane is cracked.
#[derive(Debug, Clone)]
enum Outline<const D: usize> {
    /// All of it (a point on a chain).
    Whole,
    /// From `point` along a unit vector.
    Segment { along: [f64; D], length: f64 },
    /// Around `point`.
    Disk { radius: f64 },
    /// Polygons side by side, and which of them are near.
    Surface {
        triangles: Vec<Crack<D>>,
        tree: Tree,
    },
    /// Corners and the two axes that they are projected on.
    Polygon {
        corners: Vec<[f64; 2]>,
        axes: [usize; 2],
    },
}

impl<const D: usize> Crack<D> {
    /// A crack in D dimensions (lengths). On axes with a `period` it recurs, as everything in a periodic body does.
    ///
    /// Errors: a shape of another dimension, numbers that are not finite, a segment without length, a normal or
    /// radius of zero, a polygon with fewer than three corners, without area, or not flat (to 1e-6 of its size). A
    /// polygon that crosses itself is cracked where a ray from outside enters an odd number of times.
    pub fn new(shape: &CrackShape, period: [Option<f64>; D]) -> Result<Self, BuildError> {
        is_finite(shape)?;
        fits::<D>(shape)?;
        let crack = match shape {
            CrackShape::Surface(all) => return Crack::surface(all, period),
            CrackShape::Point { x } => Crack::point(*x),
            CrackShape::Segment { from, to } => Crack::segment(from, to)?,
            CrackShape::Disk {
                center,
                normal,
                radius,
            } => Crack::disk(center, normal, *radius)?,
            CrackShape::Polygon { corners } => Crack::polygon(corners)?,
        };
        Ok(Crack {
            shifts: shifts(period),
            ..crack
        })
    }

    fn point(x: f64) -> Self {
        let x = cut(&[x, 0.0, 0.0]);
        Crack {
            point: x,
            normal: cut(&[1.0, 0.0, 0.0]),
            low: x,
            high: x,
            outline: Outline::Whole,
            shifts: vec![],
        }
    }

    fn segment(from: &[f64; 3], to: &[f64; 3]) -> Result<Self, BuildError> {
        let t = [to[0] - from[0], to[1] - from[1], 0.0];
        let length = dot(&t, &t).sqrt();
        if length == 0.0 {
            return fail(message![
                "the crack's segment has no length: both ends are at ",
                place(&from[..2]),
                " in the plane",
            ]);
        }
        let t = t.map(|c| c / length);
        let bound = |pick: fn(f64, f64) -> f64, open: f64| {
            crate::array::from_fn(|a| if a < 2 { pick(from[a], to[a]) } else { open })
        };
        Ok(Crack {
            point: cut(from),
            normal: cut(&[-t[1], t[0], 0.0]),
            low: bound(f64::min, f64::NEG_INFINITY),
            high: bound(f64::max, f64::INFINITY),
            outline: Outline::Segment {
                along: cut(&t),
                length,
            },
            shifts: vec![],
        })
    }

    fn disk(center: &[f64; 3], normal: &[f64; 3], radius: f64) -> Result<Self, BuildError> {
        let Some(n) = unit(*normal) else {
            return fail("the normal of a crack's disk is zero".into());
        };
        if radius <= 0.0 {
            return fail(message![
                "the radius of a crack's disk is ",
                Dimension::LENGTH.of(radius),
                ", expected a positive length",
            ]);
        }
        // how far a disk reaches along an axis
        let half = |a: usize| radius * (1.0 - n[a] * n[a]).max(0.0).sqrt();
        Ok(Crack {
            point: cut(center),
            normal: cut(&n),
            low: crate::array::from_fn(|a| center[a] - half(a)),
            high: crate::array::from_fn(|a| center[a] + half(a)),
            outline: Outline::Disk { radius },
            shifts: vec![],
        })
    }

    fn polygon(corners: &[[f64; 3]]) -> Result<Self, BuildError> {
        if corners.len() < 3 {
            return fail(message![format!(
                "a crack's polygon has {} corners, expected three or more",
                corners.len()
            )]);
        }
        let low: [f64; 3] =
            crate::array::from_fn(|a| corners.iter().map(|c| c[a]).fold(f64::MAX, f64::min));
        let high: [f64; 3] =
            crate::array::from_fn(|a| corners.iter().map(|c| c[a]).fold(f64::MIN, f64::max));
        let size = (0..3).map(|a| high[a] - low[a]).fold(0.0, f64::max);
        let area = area(corners);
        let n = match unit(area) {
            Some(n) if dot(&area, &n) > 1e-12 * size * size => n,
            _ => return fail("the corners of a crack's polygon enclose no area".into()),
        };
        for (k, c) in corners.iter().enumerate() {
            let off = dot(&sub(c, &corners[0]), &n);
            if off.abs() > 1e-6 * size {
                return fail(message![
                    format!("a crack's polygon must be flat; corner {} is ", k + 1),
                    Dimension::LENGTH.of(off),
                    " off the plane of the others",
                ]);
            }
        }
        // the projection along the largest component of the normal keeps the most
        let drop = (0..3)
            .max_by(|a, b| n[*a].abs().total_cmp(&n[*b].abs()))
            .unwrap_or(2);
        let axes = [(drop + 1) % 3, (drop + 2) % 3];
        let flat = corners.iter().map(|c| [c[axes[0]], c[axes[1]]]).collect();
        Ok(Crack {
            point: cut(&corners[0]),
            normal: cut(&n),
            low: cut(&low),
            high: cut(&high),
            outline: Outline::Polygon {
                corners: flat,
                axes,
            },
            shifts: vec![],
        })
    }

    /// One of many triangles.
    fn surface(all: &Triangles, period: [Option<f64>; D]) -> Result<Self, BuildError> {
        let of = |n: usize| {
            let corners = all.corners(n).to_vec();
            Crack::new(&CrackShape::Polygon { corners }, [None; D])
                .map_err(|e| BuildError::invalid("precracks", format!("triangle {}: {e}", n + 1)))
        };
        let triangles = (0..all.face.len())
            .map(of)
            .collect::<Result<Vec<Self>, _>>()?;
        let bound = |pick: fn(f64, f64) -> f64, side: fn(&Self) -> &[f64; D], from: f64| {
            crate::array::from_fn(|a| triangles.iter().map(|c| side(c)[a]).fold(from, pick))
        };
        Ok(Crack {
            point: [0.0; D],
            normal: [0.0; D],
            low: bound(f64::min, |c| &c.low, f64::INFINITY),
            high: bound(f64::max, |c| &c.high, f64::NEG_INFINITY),
            outline: Outline::Surface {
                tree: Tree::new(all.face.len(), |n| all.corners(n)),
                triangles,
            },
            shifts: shifts(period),
        })
    }

    /// Does the bond from `a` to `b` cross the crack? The same for `b` to `a`.
    pub fn crosses(&self, a: &[f64; D], b: &[f64; D]) -> bool {
        self.shifts.iter().any(|s| {
            let shifted = |x: &[f64; D]| crate::array::from_fn(|k| x[k] + s[k]);
            self.crosses_once(&shifted(a), &shifted(b))
        })
    }

    /// Is `x` on the crack, to `within` (length)? Of surfaces that is not known: no.
    pub fn carries(&self, x: &[f64; D], within: f64) -> bool {
        let beside = |way: f64| crate::array::from_fn(|k| x[k] + way * within * self.normal[k]);
        !matches!(self.outline, Outline::Surface { .. })
            && self.crosses(&beside(-1.0), &beside(1.0))
    }

    fn crosses_once(&self, a: &[f64; D], b: &[f64; D]) -> bool {
        let mut longest = 0.0;
        for k in 0..D {
            longest = f64::max(longest, (b[k] - a[k]).abs());
        }
        let tiny = TOLERANCE * longest;
        for k in 0..D {
            if a[k].min(b[k]) > self.high[k] + tiny || a[k].max(b[k]) < self.low[k] - tiny {
                return false;
            }
        }
        if let Outline::Surface { triangles, tree } = &self.outline {
            let bound = |pick: fn(f64, f64) -> f64, by: f64| -> [f64; 3] {
                crate::array::from_fn(|k| if k < D { pick(a[k], b[k]) + by } else { 0.0 })
            };
            let (low, high) = (bound(f64::min, -tiny), bound(f64::max, tiny));
            return tree.any(&low, &high, &mut |n| triangles[n].crosses_once(a, b));
        }
        let (da, db) = (
            dot(&sub(a, &self.point), &self.normal),
            dot(&sub(b, &self.point), &self.normal),
        );
        if (da >= -tiny) == (db >= -tiny) {
            return false;
        }
        // from below to above, whichever way the bond was given
        let (from, to, d0, d1) = if da < db {
            (a, b, da, db)
        } else {
            (b, a, db, da)
        };
        let t = d0 / (d0 - d1);
        let x: [f64; D] = crate::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
        match &self.outline {
            Outline::Whole | Outline::Surface { .. } => true,
            Outline::Segment { along, length } => {
                let s = dot(&sub(&x, &self.point), along);
                s >= -tiny && s <= length + tiny
            }
            Outline::Disk { radius } => {
                let r = sub(&x, &self.point);
                dot(&r, &r) <= (radius + tiny) * (radius + tiny)
            }
            Outline::Polygon { corners, axes } => inside(corners, [x[axes[0]], x[axes[1]]], tiny),
        }
    }
}

fn fail<T>(message: Message) -> Result<T, BuildError> {
    Err(BuildError::invalid("precracks", message))
}

fn is_finite(shape: &CrackShape) -> Result<(), BuildError> {
    let numbers: Vec<f64> = match shape {
        CrackShape::Segment { from, to } => [*from, *to].concat(),
        CrackShape::Disk {
            center,
            normal,
            radius,
        } => [center.as_slice(), normal, &[*radius]].concat(),
        CrackShape::Polygon { corners } => corners.concat(),
        CrackShape::Point { x } => vec![*x],
        CrackShape::Surface(triangles) => triangles.corner.concat(),
    };
    if numbers.iter().any(|x| !x.is_finite()) {
        return fail(message![format!(
            "a crack's numbers must be finite, this one has {numbers:?}"
        )]);
    }
    Ok(())
}

/// Is it a crack in D dimensions?
fn fits<const D: usize>(shape: &CrackShape) -> Result<(), BuildError> {
    let (fits, name) = match shape {
        CrackShape::Segment { .. } => (D == 2 || D == 3, "segment"),
        CrackShape::Disk { .. } => (D == 3, "disk"),
        CrackShape::Polygon { .. } => (D == 3, "polygon"),
        CrackShape::Surface(_) => (D == 3, "surface of triangles"),
        CrackShape::Point { .. } => (D == 1, "point"),
    };
    if fits {
        return Ok(());
    }
    let instead = [
        "a point x",
        "a segment",
        "a segment (extruded along z), a disk, a polygon or a surface of triangles",
    ];
    Err(BuildError::conflict(
        "precracks",
        format!("a {name} cannot crack a body in {D} dimensions"),
    )
    .help(format!("use {}", instead[D.clamp(1, 3) - 1])))
}

/// The components that D dimensions have.
fn cut<const D: usize>(x: &[f64; 3]) -> [f64; D] {
    crate::array::from_fn(|a| x[a])
}

/// Is `x` inside the polygon (even–odd rule) or within `tiny` of its rim?
fn inside(corners: &[[f64; 2]], x: [f64; 2], tiny: f64) -> bool {
    let mut odd = false;
    for (k, q) in corners.iter().enumerate() {
        let p = &corners[(k + corners.len() - 1) % corners.len()];
        let (e, r) = (sub(q, p), sub(&x, p));
        let along = (dot(&e, &r) / dot(&e, &e).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let off = [r[0] - along * e[0], r[1] - along * e[1]];
        if dot(&off, &off) <= tiny * tiny {
            return true;
        }
        if (p[1] > x[1]) != (q[1] > x[1]) && r[0] < e[0] * r[1] / e[1] {
            odd = !odd;
        }
    }
    odd
}

/// Twice the area vector of a closed polygon (Newell).
fn area(corners: &[[f64; 3]]) -> [f64; 3] {
    let mut n = [0.0; 3];
    for (k, q) in corners.iter().enumerate() {
        // relative to the first corner: no cancellation far from the origin
        let p = sub(
            &corners[(k + corners.len() - 1) % corners.len()],
            &corners[0],
        );
        let q = sub(q, &corners[0]);
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            n[a] += p[b] * q[c] - p[c] * q[b];
        }
    }
    n
}

/// Where a crack recurs: every sum of a period back, none, or on, along each axis; first none.
fn shifts<const D: usize>(period: [Option<f64>; D]) -> Vec<[f64; D]> {
    let mut shifts = vec![[0.0; D]];
    for a in 0..D {
        if let Some(p) = period[a] {
            for k in 0..shifts.len() {
                for s in [-p, p] {
                    let mut shift = shifts[k];
                    shift[a] += s;
                    shifts.push(shift);
                }
            }
        }
    }
    shifts
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    // scaled first, so that very small and very large vectors have a length
    let most = v.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
    if most == 0.0 {
        return None;
    }
    let v = v.map(|c| c / most);
    let length = dot(&v, &v).sqrt();
    Some(v.map(|c| c / length))
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|k| a[k] * b[k]).sum()
}

fn sub<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    crate::array::from_fn(|k| a[k] - b[k])
}

#[cfg(test)]
#[path = "precrack_tests.rs"]
mod tests;
