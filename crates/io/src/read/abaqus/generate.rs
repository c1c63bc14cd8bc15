//! Nodes from nodes: `*NGEN`, `*NFILL`, `*NCOPY`.

use super::super::error::ReadError;
use super::input::{Block, Rows};
use super::keyword::Label;
use super::model::{Frame, ITEM, Model, Of};
use super::node::System;
use peridyne::space::rotation::{Quaternion, times};
use peridyne::space::{cross, dot, length};

type Point = [f64; 3];

fn less(x: &Point, y: &Point) -> Point {
    std::array::from_fn(|a| x[a] - y[a])
}

/// x + s·y.
fn plus(x: &Point, s: f64, y: &Point) -> Point {
    std::array::from_fn(|a| x[a] + s * y[a])
}

/// Along, then about the axis from a to b by an angle in degrees: as a point, and a line of a, b and the angle.
pub(super) fn shift(rows: &mut Rows, times: f64) -> Result<(Point, Option<Frame>), ReadError> {
    let (mut along, mut turned, mut first) = ([0.0; 3], None, true);
    while rows.next() {
        let count = rows.fields.len();
        let points = rows.any(0..count);
        match (std::mem::take(&mut first), count) {
            (true, 0..=3) => along = rows.point(0)?,
            (_, 7) if turned.is_none() => {
                let degrees = times * rows.real(6, "an angle")?;
                turned = Some(turn(rows, &rows.point(0)?, &rows.point(3)?, degrees)?);
            }
            _ if !points => {}
            _ => {
                return Err(rows.error(
                    "expected x, y, z of a shift, then two points of an axis and an angle in degrees",
                ));
            }
        }
    }
    Ok((along, turned))
}

fn turn(rows: &Rows, a: &Point, b: &Point, degrees: f64) -> Result<Frame, ReadError> {
    if degrees == 0.0 {
        return Ok(Frame::NONE);
    }
    let axis = less(b, a);
    let size = length(&axis);
    if size <= 0.0 {
        return Err(rows.error("the two points of the axis of rotation are one"));
    }
    let axes = Quaternion::about(&axis.map(|c| c / size), degrees.to_radians()).axes();
    Ok(Frame {
        axes,
        origin: less(a, &times(&axes, a)),
    })
}

/// The numbers after `first` on the way to `last`, which is the last of them.
fn numbers(rows: &Rows, first: u64, last: u64, step: u64) -> Result<Vec<u64>, ReadError> {
    let apart = first.abs_diff(last);
    if step == 0 || apart == 0 || !apart.is_multiple_of(step) {
        return Err(rows.error(format!(
            "steps of {step} do not lead from node {first} to node {last}"
        )));
    }
    let each = 1..=apart / step;
    Ok(match first < last {
        true => each.map(|k| first + k * step).collect(),
        false => each.map(|k| first - k * step).collect(),
    })
}

/// `*NGEN`: nodes on a line, a parabola or an arc between two that are there.
pub(super) fn ngen(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["LINE", "NSET", "SYSTEM"])?;
    let system = System::of(block)?;
    let line = block.keyword.value("LINE").map(str::to_uppercase);
    let mut all = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        let first = rows.number(0, "the node at the beginning")?;
        let last = rows.number(1, "the node at the end")?;
        let step = rows.whole(2, "an increment")?.unwrap_or(1i64);
        let made = numbers(&rows, first, last, step.unsigned_abs())?;
        model.generate(&rows, made.len(), ITEM)?;
        let here = model.here();
        let ends = [here.place(&rows, first)?, here.place(&rows, last)?];
        let extra = extra(&rows, model, system)?;
        let curve = curve(&rows, line.as_deref(), ends, extra)?;
        let here = model.here();
        let (last, between) = made.split_last().unwrap_or((&last, &[]));
        for (k, number) in between.iter().enumerate() {
            let x = curve.at((k + 1) as f64 / made.len() as f64);
            here.node(&rows, *number, x)?;
        }
        all.extend([first, *last]);
        all.extend(between);
    }
    if let Some(label) = block.label("NSET") {
        model.here().add(Of::Nodes, label, all, false);
    }
    Ok(())
}

/// The middle of a parabola or the centre of an arc: a node, or its place.
fn extra(rows: &Rows, model: &mut Model, system: System) -> Result<Option<Point>, ReadError> {
    let here = model.here();
    if !rows.any(4..7) {
        let node = rows.field(3).map(|_| rows.number(3, "a node"));
        return node.transpose()?.map(|n| here.place(rows, n)).transpose();
    }
    if here.system.is_some() {
        return Err(rows.error("with *SYSTEM, give the extra point of *NGEN as a node"));
    }
    Ok(Some(system.place(rows.point(4)?)))
}

enum Curve {
    Line([Point; 2]),
    /// Begin, middle, end.
    Parabola([Point; 3]),
    /// Centre, directions of the beginning and across it, radii, angle.
    Arc(Point, [Point; 2], [f64; 2], f64),
}

impl Curve {
    fn at(&self, s: f64) -> Point {
        match self {
            Curve::Line([a, b]) => plus(&a.map(|c| (1.0 - s) * c), s, b),
            Curve::Parabola([a, m, b]) => {
                let weights = [
                    (1.0 - s) * (1.0 - 2.0 * s),
                    4.0 * s * (1.0 - s),
                    s * (2.0 * s - 1.0),
                ];
                std::array::from_fn(|k| weights[0] * a[k] + weights[1] * m[k] + weights[2] * b[k])
            }
            Curve::Arc(centre, [along, across], [begin, end], angle) => {
                let radius = begin + s * (end - begin);
                let (sine, cosine) = libm::sincos(s * angle);
                plus(&plus(centre, radius * cosine, along), radius * sine, across)
            }
        }
    }
}

fn curve(
    rows: &Rows,
    line: Option<&str>,
    [a, b]: [Point; 2],
    extra: Option<Point>,
) -> Result<Curve, ReadError> {
    match (line, extra) {
        (None, None) => Ok(Curve::Line([a, b])),
        (None, Some(_)) => Err(rows.error("an extra point of *NGEN needs LINE=C or LINE=P")),
        (Some("P"), Some(middle)) => Ok(Curve::Parabola([a, middle, b])),
        (Some("C"), Some(centre)) => arc(rows, [a, b], centre),
        (Some("P" | "C"), None) => Err(rows.error(
            "LINE=C and LINE=P need an extra point: its node in the fourth field, or its place after it",
        )),
        (Some(other), _) => Err(rows.error(format!("LINE={other} is none of C, P"))),
    }
}

fn arc(rows: &Rows, ends: [Point; 2], centre: Point) -> Result<Curve, ReadError> {
    let [u, v] = ends.map(|x| less(&x, &centre));
    let radii = [length(&u), length(&v)];
    let longest = radii[0].max(radii[1]);
    if radii[0].min(radii[1]) <= 0.0 || (radii[0] - radii[1]).abs() > 1e-3 * longest {
        return Err(rows.error(format!(
            "the ends of the arc are {} and {} from its centre",
            radii[0], radii[1]
        )));
    }
    let own = cross(&u, &v);
    let given = rows.any(7..10).then(|| {
        let of = |k| rows.real(k, "a component of the normal");
        Ok::<_, ReadError>([of(7)?, of(8)?, of(9)?])
    });
    let normal = given.transpose()?;
    let axis = normal.unwrap_or(own);
    let size = length(&axis);
    if size
        <= if normal.is_some() {
            0.0
        } else {
            1e-6 * longest * longest
        }
    {
        return Err(rows.error("an arc of 180° or more needs a normal in fields 8 to 10"));
    }
    let axis = axis.map(|c| c / size);
    if dot(&axis, &u).abs().max(dot(&axis, &v).abs()) > 1e-3 * longest {
        return Err(rows.error("the normal of the arc is not normal to it"));
    }
    let mut angle = libm::atan2(dot(&axis, &own), dot(&u, &v));
    if angle <= 1e-9 {
        angle += std::f64::consts::TAU;
    }
    let along = u.map(|c| c / radii[0]);
    let across = cross(&axis, &along);
    Ok(Curve::Arc(centre, [along, across], radii, angle))
}

/// `*NFILL`: nodes on straight lines between those of two sets.
pub(super) fn nfill(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    if let Some(other) = ["BIAS", "SINGULAR", "TWOSTEP"]
        .iter()
        .find(|o| block.keyword.has(o))
    {
        return Err(block.error(format!(
            "*NFILL with {other} is not read: write the nodes, or export the mesh with them"
        )));
    }
    block.only(&["NSET"])?;
    let mut all = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        let ends = [0, 1].map(|k| {
            let name = rows.field(k);
            let name = name.ok_or_else(|| rows.error("*NFILL needs two node sets"))?;
            let found = model.named(name, Of::Nodes, None);
            found.map_err(|message| rows.error(message))
        });
        let [begin, end] = ends;
        let (begin, end) = (begin?, end?);
        let intervals: u64 = rows.number(2, "the number of intervals")?;
        let step = rows.whole(3, "an increment")?.unwrap_or(1i64);
        if begin.len() != end.len() {
            model.notes.push(format!(
                "*NFILL between sets of {} and {} nodes: what the longer has more is left out",
                begin.len(),
                end.len()
            ));
        }
        for (a, b) in begin.into_iter().zip(end) {
            model.generate(&rows, intervals as usize, ITEM)?;
            if i128::from(a) + i128::from(step) * i128::from(intervals) != i128::from(b) {
                return Err(rows.error(format!(
                    "{intervals} intervals with an increment of {step} do not lead from node {a} to node {b}"
                )));
            }
            let here = model.here();
            let line = Curve::Line([here.place(&rows, a)?, here.place(&rows, b)?]);
            for k in 1..intervals {
                let number = a.saturating_add_signed(step * k as i64);
                here.node(&rows, number, line.at(k as f64 / intervals as f64))?;
                all.push(number);
            }
            all.extend([a, b]);
        }
    }
    if let Some(label) = block.label("NSET") {
        model.here().add(Of::Nodes, label, all, false);
    }
    Ok(())
}

/// How nodes are copied.
enum Copy {
    /// First along, then about an axis.
    Shift(Point, Option<Frame>),
    /// Through a point.
    Point(Point),
    /// Through a line: a point and a direction.
    Line(Point, Point),
    /// Through a plane: a point and a normal.
    Mirror(Point, Point),
    /// The old node is half way from this point to the new one.
    Pole(Point),
}

impl Copy {
    fn place(&self, x: &Point) -> Point {
        match self {
            Copy::Shift(along, turn) => {
                let moved = plus(x, 1.0, along);
                turn.map_or(moved, |turn| turn.apply(&moved))
            }
            Copy::Point(a) => plus(&a.map(|c| 2.0 * c), -1.0, x),
            Copy::Line(a, e) => {
                let foot = plus(a, dot(&less(x, a), e), e);
                plus(&foot.map(|c| 2.0 * c), -1.0, x)
            }
            Copy::Mirror(a, n) => plus(x, -2.0 * dot(&less(x, a), n), n),
            Copy::Pole(a) => plus(&x.map(|c| 2.0 * c), -1.0, a),
        }
    }
}

/// `*NCOPY`: a set of nodes shifted, reflected or projected.
pub(super) fn ncopy(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&[
        "CHANGENUMBER",
        "OLDSET",
        "NEWSET",
        "SHIFT",
        "REFLECT",
        "POLE",
        "MULTIPLE",
    ])?;
    let mut rows = block.rows();
    let shift: i64 = match block.needed("CHANGENUMBER")?.parse() {
        Ok(shift) => shift,
        Err(_) => return Err(block.error("CHANGE NUMBER= of *NCOPY needs a whole number")),
    };
    let name = block.needed("OLDSET")?;
    let old = model.named(name, Of::Nodes, None);
    let old = old.map_err(|message| block.error(message))?;
    let copy = copy(block, &mut rows, model)?;
    model.generate(&rows, old.len(), ITEM)?;
    let here = model.here();
    let mut made = Vec::with_capacity(old.len());
    for number in old {
        let x = copy.place(&here.place(&rows, number)?);
        let number = number.checked_add_signed(shift).unwrap_or(0);
        let number = rows.allowed(number, "the number of a copied node")?;
        here.node(&rows, number, x)?;
        made.push(number);
    }
    if let Some(label) = block.label("NEWSET") {
        let old = here.set(Of::Nodes, &Label::new(name).key);
        let unsorted = old.is_some_and(|set| !set.sorted);
        here.add(Of::Nodes, label, made, unsorted);
    }
    Ok(())
}

fn copy(block: &Block, rows: &mut Rows, model: &mut Model) -> Result<Copy, ReadError> {
    let reflect = block.keyword.value("REFLECT").map(str::to_uppercase);
    let way = match (
        block.keyword.has("SHIFT"),
        block.keyword.has("POLE"),
        &reflect,
    ) {
        (true, false, None) => "SHIFT",
        (false, true, None) => "POLE",
        (false, false, Some(way)) => way,
        _ => return Err(block.error("*NCOPY needs one of SHIFT, REFLECT=, POLE")),
    };
    let times: f64 = match block.keyword.value("MULTIPLE").map(str::parse::<u32>) {
        None => 1.0,
        Some(Ok(times)) if way == "SHIFT" => f64::from(times),
        Some(_) => return Err(block.error("MULTIPLE= of *NCOPY is a whole number beside SHIFT")),
    };
    if way == "SHIFT" {
        let (along, turned) = shift(rows, times)?;
        return Ok(Copy::Shift(along, turned));
    }
    let mut numbers = Vec::new();
    while rows.next() {
        for k in 0..rows.fields.len() {
            numbers.push(rows.real(k, "a number")?);
        }
    }
    let point = |from: usize| -> Point {
        std::array::from_fn(|a| numbers.get(from + a).copied().unwrap_or(0.0))
    };
    let normal = |n: Point| {
        let size = length(&n);
        let message = "the points of the reflection lie on one another, or on a line";
        if size > 0.0 {
            Ok(n.map(|c| c / size))
        } else {
            Err(block.error(message))
        }
    };
    match way {
        "POINT" => Ok(Copy::Point(point(0))),
        "LINE" => Ok(Copy::Line(point(0), normal(less(&point(3), &point(0)))?)),
        "MIRROR" => {
            let [b, c] = [3, 6].map(|k| less(&point(k), &point(0)));
            Ok(Copy::Mirror(point(0), normal(cross(&b, &c))?))
        }
        "POLE" if numbers.len() == 1 => {
            let node = numbers[0] as u64;
            Ok(Copy::Pole(model.here().place(rows, node)?))
        }
        "POLE" => Ok(Copy::Pole(point(0))),
        other => Err(block.error(format!("REFLECT={other} is none of LINE, MIRROR, POINT"))),
    }
}
