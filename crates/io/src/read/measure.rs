//! Centroids and volumes of mesh cells, whose corners decide whether they are cells at all.
//!
//! A solid is what its trilinear map makes of a cube (Hughes, "The Finite Element Method", chapter 3); prisms and pyramids are cubes of
//! which some corners coincide. Volume and moments are of third degree along each axis of the cube, for which Simpson's rule is exact.
//! The Jacobian has one sign at all corners, else the cell is tangled.

use super::cell::{Cell, Kind, Nodes};
use super::error::ReadError;
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
pub(super) fn measure(
    lines: &Lines,
    nodes: &Nodes,
    cell: &Cell,
) -> Result<(Point, f64), ReadError> {
    let error = |message: String| lines.error_where(cell.line, message);
    let mut x = Vec::with_capacity(8);
    for id in &cell.nodes {
        let missing = || {
            let element = cell.id;
            error(format!(
                "element {element} refers to node {id}, which does not exist"
            ))
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
        return Err(error(format!(
            "element {} has no positive {what}: {volume}",
            cell.id
        )));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Centroid and volume of a cell whose nodes are 1, 2, ….
    fn of(kind: Kind, places: &[Point]) -> Result<(Point, f64), String> {
        let nodes: Nodes = (1..).zip(places.iter().copied()).collect();
        let cell = Cell {
            kind,
            id: 9,
            nodes: (1..=places.len() as u64).collect(),
            groups: vec![],
            line: Some(7),
            volume: None,
        };
        measure(&Lines::binary("f"), &nodes, &cell).map_err(|e| e.to_string())
    }

    const CUBE: [Point; 8] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    const WEDGE: [Point; 6] = [CUBE[0], CUBE[1], CUBE[3], CUBE[4], CUBE[5], CUBE[7]];
    const PYRAMID: [Point; 5] = [CUBE[0], CUBE[1], CUBE[2], CUBE[3], CUBE[4]];

    fn close((centroid, volume): (Point, f64), wanted: (Point, f64)) {
        assert!(
            (volume - wanted.1).abs() < 1e-15,
            "{volume}, not {}",
            wanted.1
        );
        for (a, b) in centroid.iter().zip(wanted.0) {
            assert!((a - b).abs() < 1e-15, "{centroid:?}, not {:?}", wanted.0);
        }
    }

    /// Corner 6 moved by a along x: x = ξ + aξηζ, so the Jacobian is 1 + aηζ.
    #[test]
    fn a_warped_hexahedron_is_its_trilinear_map() {
        let a = 0.75;
        let mut warped = CUBE;
        warped[6][0] += a;
        let v = 1.0 + a / 4.0;
        let x = 0.5 + a / 4.0 + a * a / 18.0;
        let y = 0.5 + a / 6.0;
        close(of(Kind::Hexa, &warped).unwrap(), ([x / v, y / v, y / v], v));
        // other corners first, the other way round, far away: the same cell
        let turned = [2, 3, 0, 1, 6, 7, 4, 5].map(|k| warped[k]);
        close(of(Kind::Hexa, &turned).unwrap(), ([x / v, y / v, y / v], v));
        let over = [4, 5, 6, 7, 0, 1, 2, 3].map(|k| warped[k]);
        close(of(Kind::Hexa, &over).unwrap(), ([x / v, y / v, y / v], v));
    }

    /// The corner above node 2 raised by h: z = ζ(1 + hη) over the triangle.
    #[test]
    fn prisms_and_pyramids_with_warped_faces_are_integrals_of_their_jacobian() {
        let h = 0.5;
        let mut wedge = WEDGE;
        wedge[5][2] += h;
        let v = 0.5 + h / 6.0;
        let z = (0.5 + h / 3.0 + h * h / 12.0) / 2.0;
        let x = 1.0 / 6.0 + h / 24.0;
        let y = 1.0 / 6.0 + h / 12.0;
        close(of(Kind::Prism, &wedge).unwrap(), ([x / v, y / v, z / v], v));
        // base (u, v, a u v) under the tip (0, 0, 1): a third of ∫(1 + a u v)
        let a = 0.25;
        let mut pyramid = PYRAMID;
        pyramid[2][2] += a;
        let (_, volume) = of(Kind::Pyramid, &pyramid).unwrap();
        assert!((volume - (1.0 + a / 4.0) / 3.0).abs() < 1e-15, "{volume}");
    }

    #[test]
    fn any_two_nodes_of_a_cell_that_change_places_tangle_it() {
        for (kind, corners) in [
            (Kind::Hexa, &CUBE[..]),
            (Kind::Prism, &WEDGE),
            (Kind::Quad, &CUBE[..4]),
        ] {
            for i in 0..corners.len() {
                for j in 0..i {
                    // a quadrilateral whose opposite corners change places is turned over
                    if kind == Kind::Quad && i - j == 2 {
                        continue;
                    }
                    let mut swapped = corners.to_vec();
                    swapped.swap(i, j);
                    let error = of(kind, &swapped).unwrap_err();
                    let told = error.starts_with("f:7: element 9");
                    // opposite corners of a cube are flat at those beside them
                    let why = error.contains("tangled") || error.contains("flat");
                    assert!(told && why, "{i} {j} {error}");
                }
            }
        }
        // of a pyramid the tip and a corner of the base, or two of these
        for (i, j) in [(0, 1), (1, 2), (2, 3), (1, 4), (3, 4)] {
            let mut swapped = PYRAMID;
            swapped.swap(i, j);
            let error = of(Kind::Pyramid, &swapped).unwrap_err();
            let why = error.contains("tangled") || error.contains("flat");
            assert!(why, "{i} {j} {error}");
        }
    }

    #[test]
    fn one_corner_pushed_through_is_named() {
        let mut pushed = CUBE;
        pushed[6] = [0.1, 0.1, 0.1];
        let error = of(Kind::Hexa, &pushed).unwrap_err();
        assert!(error.contains("(hexahedron) is tangled"), "{error}");
        assert!(
            error.contains("the corner of node 7 has not the sign"),
            "{error}"
        );
        let arrow = [[0.0; 3], [1.0, 0.0, 0.0], [0.2, 0.2, 0.0], [0.0, 1.0, 0.0]];
        let error = of(Kind::Quad, &arrow).unwrap_err();
        assert!(error.contains("the corner of node 3"), "{error}");
        // a corner of half a turn
        let straight = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 1.0, 0.0]];
        let error = of(Kind::Quad, &straight).unwrap_err();
        assert!(error.contains("flat at the corner of node 3"), "{error}");
    }

    #[test]
    fn nodes_may_coincide_where_a_cell_is_written_as_another() {
        let as_cube = [0, 1, 2, 2, 3, 4, 5, 5].map(|k| WEDGE[k]);
        close(
            of(Kind::Hexa, &as_cube).unwrap(),
            of(Kind::Prism, &WEDGE).unwrap(),
        );
        let as_cube = [0, 1, 2, 3, 4, 4, 4, 4].map(|k| PYRAMID[k]);
        close(
            of(Kind::Hexa, &as_cube).unwrap(),
            of(Kind::Pyramid, &PYRAMID).unwrap(),
        );
        let half = [CUBE[0], CUBE[1], CUBE[2], CUBE[2]];
        close(
            of(Kind::Quad, &half).unwrap(),
            ([2.0 / 3.0, 1.0 / 3.0, 0.0], 0.5),
        );
        // opposite corners of a side that coincide fold it
        let folded = [0, 1, 2, 1, 4, 5, 6, 5].map(|k| CUBE[k]);
        assert!(of(Kind::Hexa, &folded).is_err());
    }

    #[test]
    fn the_other_orientation_is_the_same_cell() {
        let turned = [4, 5, 6, 7, 0, 1, 2, 3].map(|k| CUBE[k]);
        close(of(Kind::Hexa, &turned).unwrap(), ([0.5; 3], 1.0));
        let turned = [1, 0, 2, 3].map(|k| [CUBE[0], CUBE[1], CUBE[3], CUBE[4]][k]);
        close(of(Kind::Tetra, &turned).unwrap(), ([0.25; 3], 1.0 / 6.0));
    }
}
