//! Surfaces of triangles: what they enclose, and how far a point is from them.
//!
//! A closed surface has a signed distance, negative inside: that to the nearest face, edge or corner, with the sign of the pseudonormal
//! of that feature (Bærentzen & Aanæs 2005, "Signed distance computation using the angle weighted pseudonormal"), which is exact for
//! closed surfaces that do not go through themselves. Volume, centre and moments of inertia are sums over the tetrahedra of its
//! triangles and a point, exact for polyhedra.

mod tree;

use super::{Point, cross, dot, length};
use std::collections::HashMap;
pub use tree::Tree;

/// Triangles by the numbers of their corners.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangles {
    pub corner: Vec<Point>,
    pub face: Vec<[u32; 3]>,
}

/// The part of a triangle that a point is nearest to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Feature {
    Face,
    /// From this corner to the next.
    Edge(usize),
    Corner(usize),
}

fn sub(a: &Point, b: &Point) -> Point {
    crate::array::from_fn(|k| a[k] - b[k])
}

fn place(x: &Point) -> String {
    format!("({:e}, {:e}, {:e})", x[0], x[1], x[2])
}

impl Triangles {
    /// Triangles of corners that may be written many times: those of the same coordinates are one.
    ///
    /// # Errors
    /// There is none, a number is not finite, or a triangle has no area; in words, triangles counted from 1.
    pub fn new(all: &[[Point; 3]]) -> Result<Triangles, String> {
        if all.is_empty() {
            return Err("the surface has no triangles".into());
        }
        let mut number = HashMap::with_capacity(all.len());
        let mut triangles = Triangles {
            corner: vec![],
            face: Vec::with_capacity(all.len()),
        };
        for (n, corners) in all.iter().enumerate() {
            if let Some(x) = corners.iter().flatten().find(|x| !x.is_finite()) {
                return Err(format!(
                    "a corner of triangle {} has the coordinate {x}",
                    n + 1
                ));
            }
            triangles.face.push(corners.map(|x| {
                // 0 and −0 are one place
                let bits = x.map(|c| (c + 0.0).to_bits());
                *number.entry(bits).or_insert_with(|| {
                    triangles.corner.push(x);
                    triangles.corner.len() as u32 - 1
                })
            }));
            let [a, b, c] = corners;
            let area = length(&cross(&sub(b, a), &sub(c, a)));
            let edges = [(a, b), (b, c), (c, a)].map(|(p, q)| length(&sub(p, q)));
            let longest = edges.into_iter().fold(0.0, f64::max);
            // thinner than the round-off of single precision, which is what files hold
            if !(area > 1e-9 * longest * longest) {
                return Err(format!(
                    "triangle {} has no area: its corners {}, {} and {} lie on a line",
                    n + 1,
                    place(a),
                    place(b),
                    place(c)
                ));
            }
        }
        Ok(triangles)
    }

    pub fn corners(&self, face: usize) -> [Point; 3] {
        self.face[face].map(|c| self.corner[c as usize])
    }

    /// Six times the volume between a triangle and `from`, and the edges from there.
    fn wedge(&self, face: usize, from: &Point) -> (f64, [Point; 3]) {
        let edges = self.corners(face).map(|x| sub(&x, from));
        (dot(&edges[0], &cross(&edges[1], &edges[2])), edges)
    }
}

/// A closed surface of triangles whose normals point out.
#[derive(Debug, Clone)]
pub struct Solid {
    triangles: Triangles,
    tree: Tree,
    /// Unit normals of faces; pseudonormals of their edges and of corners, of any length.
    face: Vec<Point>,
    edge: Vec<[Point; 3]>,
    corner: Vec<Point>,
    volume: f64,
    centroid: Point,
}

impl PartialEq for Solid {
    fn eq(&self, other: &Solid) -> bool {
        self.triangles == other.triangles
    }
}

impl Solid {
    /// What a surface encloses, moved so that its centroid is the origin.
    ///
    /// # Errors
    /// The surface is open, an edge belongs to more than two triangles, neighbours turn different ways, or the normals point in; in words.
    pub fn new(mut triangles: Triangles) -> Result<Solid, String> {
        closed(&triangles)?;
        let first = triangles.corner[0];
        let (mut six, mut moment) = (0.0, [0.0; 3]);
        for n in 0..triangles.face.len() {
            let (wedge, edges) = triangles.wedge(n, &first);
            six += wedge;
            for a in 0..3 {
                moment[a] += wedge * (edges[0][a] + edges[1][a] + edges[2][a]);
            }
        }
        if !(six > 0.0) {
            return Err(if six < 0.0 {
                "the normals of the surface point inwards: corners of a triangle turn counter-clockwise when seen from outside. Reverse the order of the corners".into()
            } else {
                "the surface encloses no volume".into()
            });
        }
        let centroid = crate::array::from_fn(|a| first[a] + 0.25 * moment[a] / six);
        for x in &mut triangles.corner {
            *x = sub(x, &centroid);
        }
        let count = triangles.face.len();
        let mut solid = Solid {
            tree: Tree::new(count, |n| triangles.corners(n)),
            face: Vec::with_capacity(count),
            edge: vec![[[0.0; 3]; 3]; count],
            corner: vec![[0.0; 3]; triangles.corner.len()],
            volume: six / 6.0,
            centroid,
            triangles,
        };
        solid.make_normals();
        Ok(solid)
    }

    fn make_normals(&mut self) {
        let mut of_edge: HashMap<(u32, u32), Point> = HashMap::new();
        for n in 0..self.triangles.face.len() {
            let face = self.triangles.face[n];
            let x = self.triangles.corners(n);
            let normal = cross(&sub(&x[1], &x[0]), &sub(&x[2], &x[0]));
            let normal = normal.map(|c| c / length(&normal));
            self.face.push(normal);
            for k in 0..3 {
                let (next, last) = ((k + 1) % 3, (k + 2) % 3);
                let (p, q) = (sub(&x[next], &x[k]), sub(&x[last], &x[k]));
                let angle = libm::atan2(length(&cross(&p, &q)), dot(&p, &q));
                let ends = (face[k].min(face[next]), face[k].max(face[next]));
                let sum = of_edge.entry(ends).or_insert([0.0; 3]);
                for a in 0..3 {
                    self.corner[face[k] as usize][a] += angle * normal[a];
                    sum[a] += normal[a];
                }
            }
        }
        for (n, face) in self.triangles.face.iter().enumerate() {
            for k in 0..3 {
                let next = (k + 1) % 3;
                let ends = (face[k].min(face[next]), face[k].max(face[next]));
                self.edge[n][k] = of_edge[&ends];
            }
        }
    }

    /// Where its centroid was before it became the origin.
    pub fn centroid(&self) -> Point {
        self.centroid
    }

    /// Length³
    pub fn volume(&self) -> f64 {
        self.volume
    }

    pub fn triangles(&self) -> &Triangles {
        &self.triangles
    }

    /// The longest way from the centroid to its surface.
    pub fn reach(&self) -> f64 {
        let all = self.triangles.corner.iter();
        all.map(length).fold(0.0, f64::max)
    }

    /// `∫ x_a x_b dV / V` about the centroid (length²), of each tetrahedron with a corner at the origin
    /// `det/120 (Σ_k x_a Σ_k x_b + Σ_k x_a x_b)`.
    pub fn second_moments(&self) -> [Point; 3] {
        let mut sum = [[0.0; 3]; 3];
        for n in 0..self.triangles.face.len() {
            let (six, x) = self.triangles.wedge(n, &[0.0; 3]);
            for (a, row) in sum.iter_mut().enumerate() {
                for (b, sum) in row.iter_mut().enumerate() {
                    let all = |c: usize| x[0][c] + x[1][c] + x[2][c];
                    let each: f64 = x.iter().map(|x| x[a] * x[b]).sum();
                    *sum += six / 120.0 * (all(a) * all(b) + each);
                }
            }
        }
        sum.map(|row| row.map(|c| c / self.volume))
    }

    /// Signed distance of a point from the surface, negative inside, and the direction in which it grows.
    pub fn distance(&self, x: &Point) -> (f64, Point) {
        let found = self.tree.nearest(x, |n| {
            let to = sub(x, &nearest(&self.triangles.corners(n), x).0);
            dot(&to, &to)
        });
        let n = found.expect("a solid has triangles");
        let corners = self.triangles.corners(n);
        let (at, feature) = nearest(&corners, x);
        let to = sub(x, &at);
        let pseudo = match feature {
            // beside a face: no difference of near numbers decides the direction
            Feature::Face => {
                let normal = self.face[n];
                return (dot(&sub(x, &corners[0]), &normal), normal);
            }
            Feature::Edge(k) => self.edge[n][k],
            Feature::Corner(k) => self.corner[self.triangles.face[n][k] as usize],
        };
        let far = length(&to);
        let sign = if dot(&to, &pseudo) < 0.0 { -1.0 } else { 1.0 };
        if far == 0.0 {
            let size = length(&pseudo);
            return (0.0, pseudo.map(|c| c / size));
        }
        (sign * far, to.map(|c| sign * c / far))
    }
}

/// The point of a triangle that is nearest to `x`, and on which feature it is (Ericson 2005, section 5.1.5).
fn nearest([a, b, c]: &[Point; 3], x: &Point) -> (Point, Feature) {
    let (ab, ac, ax) = (sub(b, a), sub(c, a), sub(x, a));
    let along = |from: &Point, way: &Point, part: f64| -> Point {
        crate::array::from_fn(|k| from[k] + part * way[k])
    };
    let (d1, d2) = (dot(&ab, &ax), dot(&ac, &ax));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Feature::Corner(0));
    }
    let bx = sub(x, b);
    let (d3, d4) = (dot(&ab, &bx), dot(&ac, &bx));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Feature::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (along(a, &ab, d1 / (d1 - d3)), Feature::Edge(0));
    }
    let cx = sub(x, c);
    let (d5, d6) = (dot(&ab, &cx), dot(&ac, &cx));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Feature::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (along(a, &ac, d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (along(b, &sub(c, b), part), Feature::Edge(1));
    }
    let all = 1.0 / (va + vb + vc);
    let at = crate::array::from_fn(|k| a[k] + ab[k] * vb * all + ac[k] * vc * all);
    (at, Feature::Face)
}

/// Every edge belongs to two triangles, which go along it in opposite directions.
fn closed(triangles: &Triangles) -> Result<(), String> {
    let mut count: HashMap<(u32, u32), [u32; 2]> = HashMap::with_capacity(2 * triangles.face.len());
    for face in &triangles.face {
        for k in 0..3 {
            let (from, to) = (face[k], face[(k + 1) % 3]);
            let ways = count.entry((from.min(to), from.max(to))).or_default();
            ways[usize::from(from > to)] += 1;
        }
    }
    // the one that is met first in the order of triangles, whatever the table's own order
    for (n, face) in triangles.face.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (face[k], face[(k + 1) % 3]);
            let ways = count[&(from.min(to), from.max(to))];
            let [p, q] = [from, to].map(|c| place(&triangles.corner[c as usize]));
            let edge = format!("the edge of triangle {} from {p} to {q}", n + 1);
            match (ways[0] + ways[1], ways) {
                (2, [1, 1]) => {}
                (1, _) => {
                    return Err(format!(
                        "the surface is not closed: {edge} belongs to no other triangle"
                    ));
                }
                (2, _) => {
                    return Err(format!(
                        "the surface has no inside: both triangles at {edge} run along it the same way, so their normals point to different sides"
                    ));
                }
                (more, _) => {
                    return Err(format!(
                        "the surface is no boundary of a body: {edge} belongs to {more} triangles"
                    ));
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
#[path = "../triangles_tests.rs"]
mod tests;
