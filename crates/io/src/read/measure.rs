//! Centroids and volumes of mesh cells, whose corners decide whether they are cells at all.
//!
//! A solid is what its trilinear map makes of a cube (Hughes, "The Finite Element Method", chapter 3); prisms and pyramids are cubes of
//! which some corners coincide. Volume and moments are of third degree along each axis of the cube, for which Simpson's rule is exact.
//! The Jacobian has one sign at all corners, else the cell is tangled.

use super::ReadError;
use super::cell::{Cell, Kind, Nodes};
use super::lines::Lines;
use peridyne::space::{cross, length};

type Point = [f64; 3];

/// Sine of an angle, below which a corner is flat.
const FLAT: f64 = 1e-9;

/// Corners, each with the neighbours that make a right-handed system with it; the tip of a pyramid has four neighbours, and the base says it
/// all.
fn corners(kind: Kind) -> &'static [(usize, &'static [usize])] {
    match kind {
        Kind::Vertex | Kind::Line | Kind::Sphere => &[],
        // one Jacobian everywhere
        Kind::Triangle => &[(0, &[1, 2])],
        Kind::Quad => &[(0, &[1, 3]), (1, &[2, 0]), (2, &[3, 1]), (3, &[0, 2])],
        Kind::Tetra => &[(0, &[1, 2, 3])],
        Kind::Pyramid => &[
            (0, &[1, 3, 4]),
            (1, &[2, 0, 4]),
            (2, &[3, 1, 4]),
            (3, &[0, 2, 4]),
        ],
        Kind::Prism => &[
            (0, &[1, 2, 3]),
            (1, &[2, 0, 4]),
            (2, &[0, 1, 5]),
            (3, &[5, 4, 0]),
            (4, &[3, 5, 1]),
            (5, &[4, 3, 2]),
        ],
        Kind::Hexa => &[
            (0, &[1, 3, 4]),
            (1, &[2, 0, 5]),
            (2, &[3, 1, 6]),
            (3, &[0, 2, 7]),
            (4, &[7, 5, 0]),
            (5, &[4, 6, 1]),
            (6, &[5, 7, 2]),
            (7, &[6, 4, 3]),
        ],
    }
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: &Point, b: &Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Centroid and volume of a cell (area of a flat one, which lies in x and y).
///
/// # Errors
/// A node does not exist; the cell is tangled or has no volume.
pub(super) fn measure(lines: &Lines, nodes: &Nodes, cell: &Cell) -> Result<(Point, f64), ReadError> {
    let error = |message: String| lines.error_where(cell.line, message);
    let mut x = Vec::with_capacity(8);
    for id in &cell.nodes {
        let missing = || {
            let element = cell.id;
            error(format!("element {element} refers to node {id}, which does not exist"))
        };
        x.push(*nodes.get(id).ok_or_else(missing)?);
    }
    if let Some(volume) = cell.volume {
        return Ok((x[0], volume));
    }
    let of = |corners: [usize; 8]| cube(&corners.map(|c| x[c]));
    let (volume, moment) = match cell.kind {
        Kind::Hexa => of([0, 1, 2, 3, 4, 5, 6, 7]),
        Kind::Prism => of([0, 1, 2, 2, 3, 4, 5, 5]),
        Kind::Pyramid => of([0, 1, 2, 3, 4, 4, 4, 4]),
        Kind::Tetra => tetrahedron(&x),
        Kind::Vertex | Kind::Line | Kind::Sphere | Kind::Triangle | Kind::Quad => flat(&x),
    };
    let jacobians = jacobians(cell.kind, &x);
    let named = || format!("element {} ({})", cell.id, cell.kind.name());
    let least = jacobians.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let most = jacobians.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    if let (Some(least), Some(most)) = (least, most)
        && least.1 < -FLAT
        && most.1 > FLAT
    {
        let negative = jacobians.iter().filter(|j| j.1 < 0.0).count();
        let odd = match 2 * negative <= jacobians.len() {
            true => least,
            false => most,
        };
        return Err(error(format!(
            "{} is tangled: its Jacobian at the corner of node {} has not the sign that it has elsewhere; are its nodes in the order of the format?",
            named(),
            cell.nodes[odd.0]
        )));
    }
    // the orientation of a cell does not matter, its emptiness does
    let centroid: Point = std::array::from_fn(|a| x[0][a] + moment[a] / volume);
    if !(volume.abs() > 0.0 && volume.is_finite() && centroid.iter().all(|c| c.is_finite())) {
        let what = match cell.kind.dimension() {
            2 => "area in the x-y plane",
            _ => "volume",
        };
        return Err(error(format!("{} has no positive {what}: {volume}", named())));
    }
    match jacobians.iter().find(|j| j.1.abs() <= FLAT) {
        Some(j) => Err(error(format!(
            "{} is flat at the corner of node {}: its Jacobian is zero there",
            named(),
            cell.nodes[j.0]
        ))),
        None => Ok((centroid, volume.abs())),
    }
}

/// Jacobians at the corners of a cell over the lengths of their edges. Nodes may coincide, as of a prism that is written as a hexahedron:
/// their corners are left out.
fn jacobians(kind: Kind, x: &[Point]) -> Vec<(usize, f64)> {
    let at = |(corner, neighbours): &(usize, &[usize])| {
        let edge = |n: usize| minus(&x[neighbours[n]], &x[*corner]);
        let (e, f) = (edge(0), edge(1));
        let (jacobian, size) = match neighbours.len() {
            2 => (e[0] * f[1] - e[1] * f[0], length(&e) * length(&f)),
            _ => {
                let g = edge(2);
                let size = length(&e) * length(&f) * length(&g);
                (dot(&e, &cross(&f, &g)), size)
            }
        };
        (size > 0.0).then(|| (*corner, jacobian / size))
    };
    corners(kind).iter().filter_map(at).collect()
}

/// Volume, and moments about the first corner, of what a cube becomes with these corners: 0 to 3 turn about its bottom, 4 to 7 lie above.
fn cube(corners: &[Point; 8]) -> (f64, Point) {
    let y = corners.map(|c| minus(&c, &corners[0]));
    let weights = [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)];
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for (a, u) in weights {
        for (b, v) in weights {
            for (c, w) in weights {
                let (place, jacobian) = map(&y, [a, b, c]);
                let part = u * v * w * jacobian;
                volume += part;
                (0..3).for_each(|k| moment[k] += part * place[k]);
            }
        }
    }
    (volume / 216.0, moment.map(|m| m / 216.0))
}

/// Where a place of the unit cube is, and the Jacobian there.
fn map(y: &[Point; 8], [a, b, c]: Point) -> (Point, f64) {
    let mut place = [0.0; 3];
    let mut slopes = [[0.0; 3]; 3];
    for (k, corner) in y.iter().enumerate() {
        // corners turn about the bottom: 0 0, 1 0, 1 1, 0 1
        let of = |far: bool, t: f64| if far { (t, 1.0) } else { (1.0 - t, -1.0) };
        let (x, dx) = of(matches!(k % 4, 1 | 2), a);
        let (y, dy) = of(k % 4 >= 2, b);
        let (z, dz) = of(k >= 4, c);
        for axis in 0..3 {
            place[axis] += x * y * z * corner[axis];
            slopes[0][axis] += dx * y * z * corner[axis];
            slopes[1][axis] += x * dy * z * corner[axis];
            slopes[2][axis] += x * y * dz * corner[axis];
        }
    }
    (place, dot(&slopes[0], &cross(&slopes[1], &slopes[2])))
}

/// Area, and moments about the first corner, of a triangle or quadrilateral in x and y.
fn flat(x: &[Point]) -> (f64, Point) {
    let (mut area, mut moment) = (0.0, [0.0; 3]);
    for k in 2..x.len() {
        let (e, f) = (minus(&x[k - 1], &x[0]), minus(&x[k], &x[0]));
        let part = (e[0] * f[1] - e[1] * f[0]) / 2.0;
        area += part;
        (0..3).for_each(|a| moment[a] += part * (e[a] + f[a]) / 3.0);
    }
    (area, moment)
}

/// Volume, and moments about the first corner.
fn tetrahedron(x: &[Point]) -> (f64, Point) {
    let [e, f, g] = [1, 2, 3].map(|k| minus(&x[k], &x[0]));
    let volume = dot(&e, &cross(&f, &g)) / 6.0;
    let moment = std::array::from_fn(|a| volume * (e[a] + f[a] + g[a]) / 4.0);
    (volume, moment)
}
