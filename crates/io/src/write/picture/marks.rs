//! What is drawn over a body: cracks, supports and loads. They are carried by its points.

use peridyne::columns::Dimension;
use peridyne::expression::Expression;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::{ConditionKind, ConditionSpec, CrackShape, Spec};

use super::camera::{Camera, Frame};
use super::extent::{bounds_of, principal};
use super::image::{Color, Image};

const CRACK: Color = [232, 236, 240];
const EDGE: Color = [34, 38, 46];
const LOAD: Color = [0, 122, 92];
const SUPPORT: Color = [46, 84, 158];

/// Arrows or supports along a set.
const ALONG: usize = 7;
/// The same along the longest side of one in space, and along a cut.
const ACROSS: usize = 3;
const SECTION: usize = 5;
/// Points so many spacings from a cut are seen on it.
const NEAR: f64 = 0.75;
/// Parts of a line of a crack, and how far around the points are that carry it (spacings).
const PARTS: usize = 24;
const AROUND: f64 = 1.6;
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
    supports: Vec<Mark>,
    loads: Vec<Mark>,
    /// The same where a solid is cut open.
    section: [Vec<Mark>; 2],
}

/// Something that is done to a set, at one of its points.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    pub at: Point,
    pub point: usize,
    /// Where to; 0 of a support.
    pub toward: Point,
    /// What is done, the set, and the largest of the run.
    pub what: &'static str,
    pub set: String,
    pub size: f64,
    pub dimension: Dimension,
}

impl Marks {
    /// Of what a spec does to a body until the time `end`.
    pub fn of(spec: &Spec, sim: &mut dyn Simulation, end: f64) -> Marks {
        let mut marks = Marks::default();
        for crack in &spec.damage.precracks {
            marks.cracks.extend(corners(&crack.shape));
        }
        let reference = sim.vectors("reference");
        let spacing = sim.info().spacing;
        for condition in &spec.loading.conditions {
            let members = sim.members(&condition.set).unwrap_or_default();
            let there = members.iter().map(|i| *i as usize);
            let members: Vec<usize> = there.filter(|i| *i < reference.len()).collect();
            for point in spread(&reference, &members, spec.space.dimension) {
                let mark = made(condition, (point, reference[point]), end);
                put(&mut marks.supports, &mut marks.loads, mark);
            }
            if spec.space.dimension == 3 {
                let [supports, loads] = &mut marks.section;
                for point in along_cut(&reference, &members, spacing) {
                    let mark = made(condition, (point, reference[point]), end);
                    put(supports, loads, mark);
                }
            }
        }
        marks
    }

    /// What holds, what loads, and the corners of cracks.
    pub fn seen(&self) -> (&[Mark], &[Mark], &[Vec<Point>]) {
        (&self.supports, &self.loads, &self.cracks)
    }
}

fn put(supports: &mut Vec<Mark>, loads: &mut Vec<Mark>, mark: Option<Mark>) {
    match mark {
        Some(mark) if mark.size != 0.0 => loads.push(mark),
        Some(mark) if !supports.iter().any(|s| s.point == mark.point) => supports.push(mark),
        Some(_) | None => {}
    }
}

/// What a condition does at a point; `None`: nothing that is marked.
fn made(condition: &ConditionSpec, (point, at): (usize, Point), end: f64) -> Option<Mark> {
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
    let (what, dimension, v) = match &condition.kind {
        ConditionKind::Displacement(v) => ("displacement", Dimension::LENGTH, v),
        ConditionKind::Velocity(v) => ("velocity", Dimension::VELOCITY, v),
        ConditionKind::BodyForce(v) => ("body force", Dimension::FORCE_DENSITY, v),
        ConditionKind::SetForce(v) => ("force density", Dimension::FORCE_DENSITY, v),
        ConditionKind::Traction { value: v, .. } => ("traction", Dimension::PRESSURE, v),
        ConditionKind::Damping(_) | ConditionKind::Force(_) => return None,
    };
    let holds = matches!(
        condition.kind,
        ConditionKind::Displacement(_) | ConditionKind::Velocity(_)
    );
    let toward = towards(v);
    let mark = Mark {
        at,
        point,
        toward,
        what,
        set: condition.set.clone(),
        size: toward.iter().map(|c| c * c).sum::<f64>().sqrt(),
        dimension,
    };
    // no force is none, and a velocity of 0 holds
    (holds || mark.size != 0.0).then_some(mark)
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

/// A few points of a set: along its longest side, across it in the middle; of one that bends around its middle, far from each other.
fn spread(reference: &[Point], members: &[usize], dimension: usize) -> Vec<usize> {
    if members.is_empty() || dimension < 2 {
        return vec![];
    }
    let bounds = bounds_of(members.iter().map(|i| &reference[*i]));
    let counts = counts(&bounds, dimension);
    let step = |a: usize| (bounds[a][1] - bounds[a][0]) / counts[a] as f64;
    let place = |a: usize, n: usize| bounds[a][0] + (n as f64 + 0.5) * step(a);
    let mut chosen = vec![];
    let mut off = false;
    for n in 0..counts.iter().product() {
        let (i, j, k) = (
            n % counts[0],
            n / counts[0] % counts[1],
            n / counts[0] / counts[1],
        );
        let at = [place(0, i), place(1, j), place(2, k)];
        let point = nearest(reference, members, &at);
        let far = |a: usize| counts[a] > 1 && (reference[point][a] - at[a]).abs() > 0.5 * step(a);
        off |= (0..3).any(far);
        if !chosen.contains(&point) {
            chosen.push(point);
        }
    }
    match off {
        false => chosen,
        true => spread_out(reference, members, ALONG),
    }
}

/// How many marks along each axis.
fn counts(bounds: &[[f64; 2]; 3], dimension: usize) -> [usize; 3] {
    let extent = bounds.map(|[low, high]| high - low);
    let longest = extent.iter().copied().fold(0.0, f64::max);
    if !(longest > 0.0) {
        return [1; 3];
    }
    let [thin, long, _] = principal(bounds);
    std::array::from_fn(|a| match dimension {
        2 if a == (if extent[0] >= extent[1] { 0 } else { 1 }) => ALONG,
        2 => 1,
        _ if a == long => ACROSS,
        _ if a == thin => 1,
        _ => ((ACROSS as f64 * extent[a] / longest).round() as usize).max(1),
    })
}

fn square(a: &Point, b: &Point) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
}

fn nearest(reference: &[Point], members: &[usize], at: &Point) -> usize {
    let far = |i: &&usize| square(&reference[**i], at);
    let all = members.iter().min_by(|i, j| far(i).total_cmp(&far(j)));
    all.copied().unwrap_or(0)
}

/// So many points of a set, each the one that is furthest from those before.
fn spread_out(reference: &[Point], members: &[usize], count: usize) -> Vec<usize> {
    let mut chosen = vec![members[0]];
    let mut far: Vec<f64> = vec![f64::INFINITY; members.len()];
    while chosen.len() < count.min(members.len()) {
        let last = reference[chosen[chosen.len() - 1]];
        for (far, i) in far.iter_mut().zip(members) {
            *far = far.min(square(&reference[*i], &last));
        }
        let most = (0..far.len()).max_by(|i, j| far[*i].total_cmp(&far[*j]));
        let Some(most) = most.filter(|n| far[*n] > 0.0) else {
            break;
        };
        chosen.push(members[most]);
    }
    chosen
}

/// Points of a set along the cut through the middle of a body.
fn along_cut(reference: &[Point], members: &[usize], spacing: f64) -> Vec<usize> {
    let bounds = bounds_of(reference.iter());
    let [_, long, deep] = principal(&bounds);
    let middle = 0.5 * (bounds[deep][0] + bounds[deep][1]);
    let on = |i: &usize| (reference[*i][deep] - middle).abs() < NEAR * spacing;
    let on: Vec<usize> = members.iter().copied().filter(on).collect();
    if on.is_empty() {
        return vec![];
    }
    let own = bounds_of(on.iter().map(|i| &reference[*i]));
    let mut chosen = vec![];
    for n in 0..SECTION {
        let mut at = own.map(|b| 0.5 * (b[0] + b[1]));
        let [low, high] = own[long];
        at[long] = low + (n as f64 + 0.5) / SECTION as f64 * (high - low);
        let point = nearest(reference, &on, &at);
        if !chosen.contains(&point) {
            chosen.push(point);
        }
    }
    chosen
}

/// The line of a crack, carried by the points around it: the mean of both of its sides.
fn carried(ends: &[Point], reference: &[Point], moved: &[Point], reach: f64) -> Vec<Point> {
    let way = |x: &Point| -> Point {
        let mut sum = [0.0; 4];
        for (r, m) in reference.iter().zip(moved) {
            if square(r, x) < reach * reach && m.iter().all(|c| c.is_finite()) {
                (0..3).for_each(|a| sum[a] += m[a] - r[a]);
                sum[3] += 1.0;
            }
        }
        match sum[3] > 0.0 {
            true => std::array::from_fn(|a| x[a] + sum[a] / sum[3]),
            // beyond the body there is none
            false => [f64::NAN; 3],
        }
    };
    let part = |n: usize| -> Point {
        let part = n as f64 / PARTS as f64;
        std::array::from_fn(|a| ends[0][a] + part * (ends[1][a] - ends[0][a]))
    };
    (0..=PARTS).map(|n| way(&part(n))).collect()
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
    /// Is it a plate? If not, is it cut open?
    pub flat: bool,
    pub open: bool,
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

/// Draws over a view of points that were at `reference` and are at `moved`; on a cut what is seen there, of a solid as a whole nothing.
pub fn draw(
    image: &mut Image,
    view: &View,
    marks: &Marks,
    (reference, moved): (&[Point], &[Point]),
) {
    let (supports, loads) = match (view.flat, view.open) {
        (true, _) => (&marks.supports, &marks.loads),
        (false, true) => (&marks.section[0], &marks.section[1]),
        (false, false) => return,
    };
    let cracks = marks.cracks.iter().filter(|_| view.flat);
    for ends in cracks.flat_map(|c| c.windows(2)) {
        let line = carried(ends, reference, moved, AROUND * view.step);
        for (width, color) in [(4.0, EDGE), (2.0, CRACK)] {
            for part in line.windows(2) {
                image.line(view.place(part[0]), view.place(part[1]), width, color);
            }
        }
    }
    let place = |mark: &Mark| moved.get(mark.point).map(|x| view.place(*x));
    for [x, y] in supports.iter().filter_map(place) {
        let (l, r, b) = (
            [x - SIZE, y + 1.6 * SIZE],
            [x + SIZE, y + 1.6 * SIZE],
            [x, y],
        );
        for (width, color) in [(5.5, [255; 3]), (3.0, SUPPORT)] {
            for (from, to) in [(b, l), (l, r), (r, b)] {
                image.line(from, to, width, color);
            }
        }
    }
    for mark in loads {
        let Some(from) = place(mark) else { continue };
        let toward = view.camera.project(mark.toward);
        let length = libm::hypot(toward[0], toward[1]);
        if length > 1e-6 * mark.size && length.is_finite() {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_points_of_their_set_and_few() {
        let all: Vec<Point> = (0..400)
            .map(|n| [f64::from(n % 20), f64::from(n / 20), 0.0])
            .collect();
        let of = |keep: &dyn Fn(&Point) -> bool| -> Vec<usize> {
            (0..all.len()).filter(|i| keep(&all[*i])).collect()
        };
        // a band, a frame around an empty middle, a single point
        let round = |x: &Point| x[0] < 1.0 || x[0] > 18.0 || x[1] < 1.0 || x[1] > 18.0;
        let sets = [
            of(&|x| x[1] < 2.5),
            of(&round),
            of(&|x| x[0] == 7.0 && x[1] == 3.0),
        ];
        for (set, count) in sets.iter().zip([ALONG, ALONG, 1]) {
            let chosen = spread(&all, set, 2);
            assert_eq!(chosen.len(), count);
            assert!(chosen.iter().all(|i| set.contains(i)));
        }
        // of the frame they are on all four sides
        let chosen = spread(&all, &sets[1], 2);
        for side in [
            of(&|x| x[0] < 1.0),
            of(&|x| x[0] > 18.0),
            of(&|x| x[1] < 1.0),
            of(&|x| x[1] > 18.0),
        ] {
            assert!(chosen.iter().any(|i| side.contains(i)));
        }
        // of a solid at most nine, and some on the cut
        let solid: Vec<Point> = (0..1000)
            .map(|n| {
                [
                    f64::from(n % 10),
                    f64::from(n / 10 % 10),
                    f64::from(n / 100),
                ]
            })
            .collect();
        let floor: Vec<usize> = (0..100).collect();
        assert!(spread(&solid, &floor, 3).len() <= 9);
        let cut = along_cut(&solid, &floor, 1.0);
        assert_eq!(cut.len(), SECTION);
        assert!(cut.iter().all(|i| solid[*i][2] == 0.0));
    }

    #[test]
    fn a_crack_goes_with_its_points() {
        let reference: Vec<Point> = (0..100)
            .map(|n| [f64::from(n % 10), f64::from(n / 10), 0.0])
            .collect();
        // the halves above and below come apart, and all of it moves to the right
        let moved: Vec<Point> = { reference.iter() }
            .map(|x| [x[0] + 3.0, x[1] + if x[1] > 4.5 { 0.5 } else { -0.5 }, 0.0])
            .collect();
        let line = carried(
            &[[-9.0, 4.5, 0.0], [4.0, 4.5, 0.0]],
            &reference,
            &moved,
            1.6,
        );
        let there: Vec<&Point> = line.iter().filter(|x| x[0].is_finite()).collect();
        // what lies outside is not drawn
        assert!(there.len() < line.len() && there.len() > 4);
        assert!(
            there
                .iter()
                .all(|x| (x[1] - 4.5).abs() < 1e-12 && x[0] > 1.0)
        );
        assert!((there[there.len() - 1][0] - 7.0).abs() < 1e-12);
    }
}
