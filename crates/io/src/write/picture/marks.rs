//! What is drawn over a body: cracks, indenters, supports and loads.

use peridyne::columns::Dimension;
use peridyne::condition::rigid::Rigid;
use peridyne::expression::Expression;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::space::rigid::RigidShape;
use peridyne::space::triangles::Triangles;
use peridyne::spec::{ConditionKind, CrackShape, IndenterMotion, IndenterSpec, Spec};
use std::collections::HashMap;

use super::image::{Color, Image};
use super::view::{Camera, Frame};

const CRACK: Color = [232, 236, 240];
const EDGE: Color = [34, 38, 46];
const INDENTER: Color = [90, 98, 110];
const LOAD: Color = [0, 122, 92];
const SUPPORT: Color = [46, 84, 158];

/// Arrows or supports along a set.
const ALONG: usize = 7;
/// The same along the longest side of one in space.
const ACROSS: usize = 5;
/// Times of a run at which loads are looked at.
const TIMES: u32 = 32;
/// Length of an arrow, and size of a support (pixels).
const ARROW: f64 = 34.0;
const SIZE: f64 = 9.0;

/// Things in the reference configuration (lengths).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Marks {
    /// Corners of pre-cracks.
    cracks: Vec<Vec<Point>>,
    /// Rigid bodies whose place is known at every time, and lines along the axes of their shapes.
    rigid: Vec<(IndenterSpec, Vec<[Point; 2]>)>,
    supports: Vec<Mark>,
    loads: Vec<Mark>,
}

/// Something that is done to a set, at one place of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    pub at: Point,
    /// Where to; 0 of a support.
    pub toward: Point,
    /// What is done, the set, and the largest of the run.
    pub what: &'static str,
    pub set: String,
    pub size: f64,
    pub dimension: Dimension,
}

impl Marks {
    /// Of what a spec does to a body until the time `end`. Free indenters are left out: where they go is not known beforehand.
    pub fn of(spec: &Spec, sim: &mut dyn Simulation, end: f64) -> Marks {
        let mut marks = Marks::default();
        for crack in &spec.precracks {
            marks.cracks.extend(corners(&crack.shape));
        }
        for indenter in &spec.indenters {
            if let IndenterMotion::Kinematic(_) = &indenter.motion {
                let lines = outline(&indenter.shape, spec.dimension);
                marks.rigid.push((indenter.clone(), lines));
            }
        }
        let reference = sim.vectors("reference");
        for condition in &spec.conditions {
            let members = sim.members(&condition.set).unwrap_or_default();
            let points = members.iter().filter_map(|i| reference.get(*i as usize));
            let places = spread(points.copied().collect(), spec.dimension);
            for at in places {
                marks.add(&condition.kind, &condition.set, at, end);
            }
        }
        marks
    }

    /// Ends of what is drawn of rigid bodies at this time.
    pub fn rigid_places(&self, time: f64) -> Vec<Point> {
        let mut all = vec![];
        for (indenter, lines) in &self.rigid {
            let mut body = Rigid::<3>::new(indenter);
            body.place(time);
            if let RigidShape::Sphere { radius } = indenter.shape {
                for (a, way) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                    let mut x = body.center;
                    x[a] += way * radius;
                    all.push(x);
                }
            }
            all.extend(lines.iter().flatten().map(|x| body.in_space(x)));
        }
        all
    }

    /// What holds, what loads, and the corners of cracks.
    pub fn seen(&self) -> (&[Mark], &[Mark], &[Vec<Point>]) {
        (&self.supports, &self.loads, &self.cracks)
    }

    fn add(&mut self, kind: &ConditionKind, set: &str, at: Point, end: f64) {
        // a pulse is over in the end, what grows begins with nothing: the largest of the run counts
        let towards = |v: &[Option<Expression>; 3]| -> Point {
            let then = |k: u32| -> Point {
                let t = end * f64::from(k) / f64::from(TIMES);
                std::array::from_fn(|a| v[a].as_ref().map_or(0.0, |e| e.eval(&at, t)))
            };
            let size = |p: &Point| p.iter().map(|c| c * c).sum::<f64>();
            let all = (0..=TIMES).map(then).filter(|p| size(p).is_finite());
            all.fold(
                [0.0; 3],
                |most, p| if size(&p) > size(&most) { p } else { most },
            )
        };
        let (what, dimension, v) = match kind {
            ConditionKind::Displacement(v) => ("displacement", Dimension::LENGTH, v),
            ConditionKind::Velocity(v) => ("velocity", Dimension::VELOCITY, v),
            ConditionKind::BodyForce(v) => ("body force", Dimension::FORCE_DENSITY, v),
            ConditionKind::SetForce(v) => ("force density", Dimension::FORCE_DENSITY, v),
            ConditionKind::Traction { value: v, .. } => ("traction", Dimension::PRESSURE, v),
            ConditionKind::Damping(_) | ConditionKind::Own(_) => return,
        };
        let holds = matches!(
            kind,
            ConditionKind::Displacement(_) | ConditionKind::Velocity(_)
        );
        let toward = towards(v);
        let mark = Mark {
            at,
            toward,
            what,
            set: set.into(),
            size: toward.iter().map(|c| c * c).sum::<f64>().sqrt(),
            dimension,
        };
        match (mark.size == 0.0, holds) {
            (false, _) => self.loads.push(mark),
            (true, true) if !self.supports.iter().any(|s| s.at == at) => self.supports.push(mark),
            (true, _) => {}
        }
    }
}

/// Edges of a rigid shape along its own axes; none of a sphere, and of a plane, which has no end.
fn outline(shape: &RigidShape, dimension: usize) -> Vec<[Point; 2]> {
    match shape {
        RigidShape::Sphere { .. } | RigidShape::Plane { .. } => vec![],
        RigidShape::Box { half } => {
            let corner = |n: usize| -> Point {
                std::array::from_fn(|a| match (n >> a & 1, a < dimension) {
                    (_, false) => 0.0,
                    (1, _) => half[a],
                    _ => -half[a],
                })
            };
            let edge = |n: usize, a: usize| [corner(n), corner(n | 1 << a)];
            let all = (0..1 << dimension).flat_map(|n: usize| (0..dimension).map(move |a| (n, a)));
            all.filter(|(n, a)| n >> a & 1 == 0)
                .map(|(n, a)| edge(n, a))
                .collect()
        }
        RigidShape::Cylinder { radius, half, axis } => rims(*radius, *half, axis),
        RigidShape::Solid(solid) => creases(solid.triangles()),
    }
}

/// Both ends of a cylinder, and lines between them.
fn rims(radius: f64, half: f64, axis: &Point) -> Vec<[Point; 2]> {
    const SIDES: usize = 48;
    let least = (1..3).fold(0, |m, a| if axis[a].abs() < axis[m].abs() { a } else { m });
    let mut e = [0.0; 3];
    e[least] = 1.0;
    let p = unit(&cross(axis, &e));
    let q = cross(axis, &p);
    let at = |n: usize, end: f64| -> Point {
        let (sine, cosine) = (std::f64::consts::TAU * n as f64 / SIDES as f64).sin_cos();
        std::array::from_fn(|a| radius * (cosine * p[a] + sine * q[a]) + end * axis[a])
    };
    let around = |end: f64| (0..SIDES).map(move |n| (n, end));
    let mut lines: Vec<[Point; 2]> = { around(-half).chain(around(half)) }
        .map(|(n, end)| [at(n, end), at(n + 1, end)])
        .collect();
    lines.extend(
        (0..SIDES)
            .step_by(SIDES / 4)
            .map(|n| [at(n, -half), at(n, half)]),
    );
    lines
}

/// Edges between triangles that meet at more than 30°.
fn creases(triangles: &Triangles) -> Vec<[Point; 2]> {
    let normal = |n: usize| {
        let [a, b, c] = triangles.corners(n);
        let way = |x: &Point| -> Point { std::array::from_fn(|k| x[k] - a[k]) };
        unit(&cross(&way(&b), &way(&c)))
    };
    let mut met: HashMap<(u32, u32), usize> = HashMap::new();
    let mut lines = vec![];
    for (n, face) in triangles.face.iter().enumerate() {
        for k in 0..3 {
            let (from, to) = (face[k], face[(k + 1) % 3]);
            let Some(other) = met.insert((from.min(to), from.max(to)), n) else {
                continue;
            };
            let (p, q) = (normal(n), normal(other));
            if (0..3).map(|a| p[a] * q[a]).sum::<f64>() < 30f64.to_radians().cos() {
                lines.push([from, to].map(|c| triangles.corner[c as usize]));
            }
        }
    }
    lines
}

fn cross(a: &Point, b: &Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: &Point) -> Point {
    let size = a.iter().map(|c| c * c).sum::<f64>().sqrt();
    a.map(|c| c / size)
}

/// Corners of a crack that has some.
fn corners(shape: &CrackShape) -> Option<Vec<Point>> {
    match shape {
        CrackShape::Segment { from, to } => {
            Some(vec![[from[0], from[1], 0.0], [to[0], to[1], 0.0]])
        }
        CrackShape::Polygon { corners } => {
            let mut all = corners.clone();
            all.extend(corners.first().copied());
            Some(all)
        }
        CrackShape::Disk { .. } | CrackShape::Point { .. } | CrackShape::Surface(_) => None,
    }
}

/// A few places along the longest sides of a set, across it in the middle.
fn spread(points: Vec<Point>, dimension: usize) -> Vec<Point> {
    if points.is_empty() || dimension < 2 {
        return vec![];
    }
    let bound = |pick: fn(f64, f64) -> f64, start: f64| -> Point {
        std::array::from_fn(|a| points.iter().map(|x| x[a]).fold(start, pick))
    };
    let (low, high) = (
        bound(f64::min, f64::INFINITY),
        bound(f64::max, f64::NEG_INFINITY),
    );
    if dimension == 3 {
        return over(low, high);
    }
    let long = if high[0] - low[0] >= high[1] - low[1] {
        0
    } else {
        1
    };
    let middle: Point = std::array::from_fn(|a| 0.5 * (low[a] + high[a]));
    let count = if high[long] > low[long] { ALONG } else { 1 };
    let place = |n: usize| {
        let mut at = middle;
        if count > 1 {
            let part = (n as f64 + 0.5) / count as f64;
            at[long] = low[long] + part * (high[long] - low[long]);
        }
        at
    };
    (0..count).map(place).collect()
}

/// Places over the two longest sides of a box, in the middle of the third.
fn over(low: Point, high: Point) -> Vec<Point> {
    let extent = |a: usize| high[a] - low[a];
    let longest = (0..3).map(extent).fold(0.0, f64::max);
    let thin = (0..3).min_by(|a, b| extent(*a).total_cmp(&extent(*b)));
    let thin = thin.unwrap_or(2);
    let count = |a: usize| match a == thin || !(longest > 0.0) {
        true => 1,
        false => ((ACROSS as f64 * extent(a) / longest).round() as usize).max(1),
    };
    let at = |a: usize, n: usize| low[a] + (n as f64 + 0.5) / count(a) as f64 * extent(a);
    let mut all = vec![];
    for i in 0..count(0) {
        for j in 0..count(1) {
            all.extend((0..count(2)).map(|k| [at(0, i), at(1, j), at(2, k)]));
        }
    }
    all
}

/// Where on the image a view lies.
pub struct View<'a> {
    pub corner: [f64; 2],
    /// Distance of points (length).
    pub step: f64,
    /// Pixels per length.
    pub scale: f64,
    pub camera: &'a Camera,
    pub frame: &'a Frame,
    /// Is it a plate?
    pub flat: bool,
}

impl View<'_> {
    pub fn place(&self, x: Point) -> [f64; 2] {
        let p = self.camera.project(x);
        [
            self.corner[0] + (p[0] - self.frame.low[0]) * self.scale,
            self.corner[1] + (self.frame.high[1] - p[1]) * self.scale,
        ]
    }
}

/// Draws over a view what there is at this time.
pub fn draw(image: &mut Image, view: &View, marks: &Marks, time: f64) {
    for (indenter, lines) in &marks.rigid {
        let mut body = Rigid::<3>::new(indenter);
        body.place(time);
        if let RigidShape::Sphere { radius } = indenter.shape {
            circle(
                image,
                view.place(body.center),
                radius * view.scale,
                INDENTER,
            );
        }
        for line in lines {
            let [from, to] = line.each_ref().map(|x| view.place(body.in_space(x)));
            image.line(from, to, 2.5, INDENTER);
        }
    }
    if !view.flat {
        return;
    }
    for crack in &marks.cracks {
        for ends in crack.windows(2) {
            let (from, to) = (view.place(ends[0]), view.place(ends[1]));
            image.line(from, to, 4.0, EDGE);
            image.line(from, to, 2.0, CRACK);
        }
    }
    for mark in &marks.supports {
        let [x, y] = view.place(mark.at);
        let (l, r, b) = (
            [x - SIZE, y + 1.6 * SIZE],
            [x + SIZE, y + 1.6 * SIZE],
            [x, y],
        );
        for (from, to) in [(b, l), (l, r), (r, b)] {
            image.line(from, to, 5.0, [255; 3]);
            image.line(from, to, 3.0, SUPPORT);
        }
    }
    for mark in &marks.loads {
        let from = view.place(mark.at);
        let toward = view.camera.project(mark.toward);
        let length = toward[0].hypot(toward[1]);
        if length > 0.0 && length.is_finite() {
            arrow(image, from, [toward[0] / length, -toward[1] / length]);
        }
    }
}

fn arrow(image: &mut Image, from: [f64; 2], d: [f64; 2]) {
    let tip: [f64; 2] = std::array::from_fn(|a| from[a] + ARROW * d[a]);
    let barb = |side: f64| {
        [
            tip[0] - 11.0 * d[0] + side * 6.0 * d[1],
            tip[1] - 11.0 * d[1] - side * 6.0 * d[0],
        ]
    };
    for (width, color) in [(6.0, [255; 3]), (3.0, LOAD)] {
        image.line(from, tip, width, color);
        image.line(tip, barb(1.0), width, color);
        image.line(tip, barb(-1.0), width, color);
    }
}

fn circle(image: &mut Image, center: [f64; 2], radius: f64, color: Color) {
    let sides = (radius.abs().ceil() as usize).clamp(24, 720);
    let at = |n: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * n as f64 / sides as f64).sin_cos();
        [center[0] + radius * cosine, center[1] + radius * sine]
    };
    (0..sides).for_each(|n| image.line(at(n), at(n + 1), 2.5, color));
}
