//! Rigid bodies in pictures: their surfaces, and where they are in a frame.

use peridyne::boundary_condition::rigid::Rigid;
use peridyne::space::rigid::RigidShape;
use peridyne::space::rotation::{Axes, Quaternion, times};
use peridyne::space::{Point, cross, length};
use peridyne::spec::RigidBodySpec;
use peridyne::state::{Archive, Owner};
use std::collections::HashMap;
use std::sync::Arc;

use super::extent::bounds_of;

/// Sides of the rim of a cylinder.
const SIDES: usize = 48;
/// What is drawn of a plane: half of its width and its thickness, over the longest side of the body.
const PLANE: f64 = 0.62;
const DEEP: f64 = 0.05;

/// Triangles by the numbers of their corners; counter-clockwise seen from outside.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    pub corner: Vec<Point>,
    pub face: Vec<[u32; 3]>,
}

impl Surface {
    /// One of about so many triangles or fewer: corners of a cell of a grid become one, in their middle.
    pub fn coarser(&self, most: usize) -> Surface {
        let mut cells = 64.0;
        let mut surface = self.clone();
        while surface.face.len() > most {
            surface = self.clustered(cells);
            cells *= 0.8;
        }
        surface
    }

    /// With cells so many to the longest side.
    fn clustered(&self, cells: f64) -> Surface {
        let bounds = bounds_of(self.corner.iter());
        let long = bounds.iter().map(|b| b[1] - b[0]).fold(0.0, f64::max);
        let mut number: HashMap<[i64; 3], u32> = HashMap::new();
        let mut sums: Vec<[f64; 4]> = vec![];
        let mut of = |x: &Point| -> u32 {
            let cell = std::array::from_fn(|a| ((x[a] - bounds[a][0]) / long * cells) as i64);
            let n = *number.entry(cell).or_insert_with(|| {
                sums.push([0.0; 4]);
                sums.len() as u32 - 1
            });
            let sum = &mut sums[n as usize];
            (0..3).for_each(|a| sum[a] += x[a]);
            sum[3] += 1.0;
            n
        };
        let all: Vec<u32> = self.corner.iter().map(&mut of).collect();
        let face = self.face.iter().map(|f| f.map(|n| all[n as usize]));
        Surface {
            face: face
                .filter(|[a, b, c]| a != b && b != c && c != a)
                .collect(),
            corner: { sums.iter() }
                .map(|s| [s[0] / s[3], s[1] / s[3], s[2] / s[3]])
                .collect(),
        }
    }
}

/// What a body looks like, along its own axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// Of this radius; in 2-D a disk.
    Ball(f64),
    Surface(Arc<Surface>),
    /// All that is behind it; the normal points out.
    Plane(Point),
}

impl Owner for Form {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        let (mut kind, mut numbers, mut surface) = match self {
            Form::Ball(radius) => (0u8, [*radius, 0.0, 0.0], Surface::default()),
            Form::Surface(surface) => (1, [0.0; 3], (**surface).clone()),
            Form::Plane(normal) => (2, *normal, Surface::default()),
        };
        archive.one("kind", &mut kind);
        archive.one("numbers", &mut numbers);
        archive.list("corners", &mut surface.corner);
        archive.list("faces", &mut surface.face);
        if !archive.loads() {
            return;
        }
        let corners = surface.corner.len();
        let sound = { surface.face.iter().flatten() }.all(|n| (*n as usize) < corners);
        *self = match kind {
            0 => Form::Ball(numbers[0]),
            1 if sound => Form::Surface(Arc::new(surface)),
            2 => Form::Plane(numbers),
            _ => return archive.refuse("kind"),
        };
    }
}

/// A rigid body at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    pub form: Form,
    pub center: Point,
    /// Rows, from its own axes to space.
    pub axes: Axes,
}

impl Form {
    pub fn of(shape: &RigidShape, dimension: usize) -> Form {
        match shape {
            RigidShape::Sphere { radius } => Form::Ball(*radius),
            RigidShape::Box { half } => Form::surface(block(half, dimension)),
            RigidShape::Cylinder { radius, half, axis } => {
                Form::surface(cylinder(*radius, *half, axis))
            }
            RigidShape::Plane { normal } => Form::Plane(*normal),
            RigidShape::Solid(solid) => Form::surface(Surface {
                corner: solid.triangles().corner.clone(),
                face: solid.triangles().face.clone(),
            }),
        }
    }

    fn surface(surface: Surface) -> Form {
        Form::Surface(Arc::new(surface))
    }
}

impl Placed {
    /// One that does not turn.
    pub fn new(form: Form, center: Point) -> Placed {
        Placed {
            form,
            center,
            axes: Quaternion::ONE.axes(),
        }
    }

    /// At a time, of one that is moved; of a free one where it begins.
    pub fn at(spec: &RigidBodySpec, dimension: usize, time: f64) -> Placed {
        let mut body = Rigid::<3>::new(spec);
        body.place(time);
        Placed {
            form: Form::of(&spec.shape, dimension),
            center: body.center,
            axes: body.axes,
        }
    }

    /// Where a place of the body is.
    pub fn in_space(&self, x: &Point) -> Point {
        let arm = times(&self.axes, x);
        std::array::from_fn(|a| self.center[a] + arm[a])
    }

    /// With a surface in place of a plane, as large as what it is beside.
    pub fn bounded(&self, bounds: &[[f64; 2]; 3], dimension: usize) -> Placed {
        let Form::Plane(normal) = &self.form else {
            return self.clone();
        };
        let normal = times(&self.axes, normal);
        let long = bounds.iter().map(|b| b[1] - b[0]).fold(0.0, f64::max);
        let long = if long > 0.0 { long } else { 1.0 };
        let middle = bounds.map(|b| 0.5 * (b[0] + b[1]));
        let above: f64 = (0..3)
            .map(|a| (middle[a] - self.center[a]) * normal[a])
            .sum();
        let p = match dimension {
            2 => [-normal[1], normal[0], 0.0],
            _ => aside(&normal),
        };
        let q = cross(&normal, &p);
        let (wide, deep) = (PLANE * long, DEEP * long);
        let center =
            std::array::from_fn(|a| middle[a] - above * normal[a] - 0.5 * deep * normal[a]);
        let axes = std::array::from_fn(|r| [p[r], normal[r], q[r]]);
        let half = [wide, 0.5 * deep, wide];
        // a rectangle lies in the plane of the first two axes, and p, n and q turn left or right
        let form = match dimension {
            2 => Form::surface(block(&half, 2)),
            _ => Form::surface(mirrored(block(&half, 3))),
        };
        Placed { form, center, axes }
    }

    /// Places of its surface that are furthest along these directions, or all of its corners.
    pub fn ends(&self, directions: &[Point]) -> Vec<Point> {
        match &self.form {
            Form::Ball(radius) => { directions.iter().flat_map(|d| [(d, 1.0), (d, -1.0)]) }
                .map(|(d, way)| std::array::from_fn(|a| self.center[a] + way * radius * d[a]))
                .collect(),
            Form::Surface(surface) => surface.corner.iter().map(|x| self.in_space(x)).collect(),
            Form::Plane(_) => vec![],
        }
    }
}

/// A box; in 2-D its middle, a rectangle.
fn block(half: &Point, dimension: usize) -> Surface {
    let at = |n: usize| -> Point {
        std::array::from_fn(|a| match (n >> a & 1, a < dimension) {
            (_, false) => 0.0,
            (1, _) => half[a],
            _ => -half[a],
        })
    };
    if dimension < 3 {
        return Surface {
            corner: (0..4).map(at).collect(),
            face: vec![[0, 1, 3], [0, 3, 2]],
        };
    }
    let sides: [[u32; 4]; 6] = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let halves = |s: &[u32; 4]| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]];
    Surface {
        corner: (0..8).map(at).collect(),
        face: sides.iter().flat_map(halves).collect(),
    }
}

/// Axes that are left-handed turn a surface inside out.
fn mirrored(mut surface: Surface) -> Surface {
    surface.face.iter_mut().for_each(|f| f.swap(1, 2));
    surface
}

fn cylinder(radius: f64, half: f64, axis: &Point) -> Surface {
    let p = aside(axis);
    let q = cross(axis, &p);
    let at = |n: usize, end: f64| -> Point {
        let (sine, cosine) = libm::sincos(std::f64::consts::TAU * n as f64 / SIDES as f64);
        std::array::from_fn(|a| radius * (cosine * p[a] + sine * q[a]) + end * axis[a])
    };
    let mut corner = vec![axis.map(|c| -half * c), axis.map(|c| half * c)];
    for n in 0..SIDES {
        corner.extend([at(n, -half), at(n, half)]);
    }
    let number = |n: usize, end: usize| (2 + 2 * (n % SIDES) + end) as u32;
    let around = |n: usize| {
        let [low, high] = [0, 1].map(|end| [number(n, end), number(n + 1, end)]);
        [
            [0, low[1], low[0]],
            [1, high[0], high[1]],
            [low[0], low[1], high[1]],
            [low[0], high[1], high[0]],
        ]
    };
    Surface {
        corner,
        face: (0..SIDES).flat_map(around).collect(),
    }
}

/// A direction across one of length 1.
fn aside(axis: &Point) -> Point {
    let least = (1..3).fold(0, |m, a| if axis[a].abs() < axis[m].abs() { a } else { m });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let across = cross(axis, &e);
    let size = length(&across);
    across.map(|c| c / size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use peridyne::space::dot;

    /// Volume that a surface encloses, positive where its normals point out.
    fn volume(placed: &Placed) -> f64 {
        let Form::Surface(surface) = &placed.form else {
            return 0.0;
        };
        let six = surface.face.iter().map(|f| {
            let [a, b, c] = f.map(|n| placed.in_space(&surface.corner[n as usize]));
            dot(&a, &cross(&b, &c))
        });
        six.sum::<f64>() / 6.0
    }

    #[test]
    fn surfaces_enclose_what_they_are_of_and_face_outwards() {
        let origin = |shape: RigidShape| Placed::new(Form::of(&shape, 3), [0.0; 3]);
        let half = [1.0, 2.0, 3.0];
        assert!((volume(&origin(RigidShape::Box { half })) - 48.0).abs() < 1e-12);
        let axis = [0.6, 0.0, 0.8];
        let round = origin(RigidShape::Cylinder {
            radius: 2.0,
            half: 1.5,
            axis,
        });
        // of a regular polygon: n/2 r² sin(2π/n) times the length
        let n = SIDES as f64;
        let polygon = 0.5 * n * 4.0 * (std::f64::consts::TAU / n).sin();
        assert!((volume(&round) / (3.0 * polygon) - 1.0).abs() < 1e-12);
        let bounds = [[0.0, 10.0], [0.0, 4.0], [0.0, 2.0]];
        for normal in [[0.0, 0.0, 1.0], [0.0, -0.6, 0.8], [1.0, 0.0, 0.0]] {
            let plane = Placed::new(Form::Plane(normal), [5.0, 2.0, -1.0]);
            let plane = plane.bounded(&bounds, 3);
            let all = 4.0 * 6.2 * 6.2 * 0.5;
            assert!((volume(&plane) / all - 1.0).abs() < 1e-9, "{normal:?}");
            // and none of it is in front of the plane
            let front = plane.ends(&[]).into_iter().map(|x| {
                let way: Point = std::array::from_fn(|a| x[a] - [5.0, 2.0, -1.0][a]);
                dot(&way, &normal)
            });
            assert!(front.fold(f64::NEG_INFINITY, f64::max) < 1e-9);
        }
    }
}
