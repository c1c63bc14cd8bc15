//! Bond filters of both programs as pre-cracks.
//!
//! A bond is cut there if it meets the plane at `0 ≤ t ≤ 1` of its length inside the shape. A plane is the set of in-plane `r` from its
//! corner with `0 ≤ r·b ≤ length` and, in 3-D, `0 ≤ r·(b × n) ≤ side`: vectors that are not perpendicular, or in Peridigm not of unit
//! length, change its edges. Rims of planes are cut, of disks not.
//!
//! A point on the plane loses its bonds to both sides there; a crack here counts it to one side. Two cracks, one on each side of the
//! plane, say the same.

use super::program::Program;
use super::tree::Entry;

/// What filters act on.
pub struct Target<'a> {
    pub program: Program,
    pub dimension: usize,
    pub position: &'a [[f64; 3]],
    pub horizon: f64,
}

/// Distance of two cracks from the plane of points on it, in horizons; round-off of the engine is 1e-9 of a bond.
const ASIDE: f64 = 1e-8;
/// By how much they reach over the rim: bonds that leave a point on it meet them a little beside.
const OVER: f64 = 1e-6;

type Vector = [f64; 3];

/// Pre-cracks of bond filters.
pub fn filters(all: &Entry, target: &Target, remarks: &mut Vec<String>) -> String {
    let mut out = String::new();
    for entry in all.lists() {
        match filter(entry, target, remarks) {
            Ok(text) => out += &text,
            Err(why) => entry.refuse(&why),
        }
    }
    out
}

/// Three numbers; in a plane z may be left out.
fn vector(entry: &Entry, name: &str) -> Result<Vector, String> {
    let mut v = [0.0; 3];
    for (c, axis) in v.iter_mut().zip(["X", "Y", "Z"]) {
        let key = format!("{name} {axis}");
        *c = match entry.number(&key) {
            Some(x) => x,
            None if axis == "Z" => 0.0,
            None => return Err(format!("it has no {key}")),
        };
    }
    Ok(v)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

fn length(v: Vector) -> f64 {
    dot(v, v).sqrt()
}

/// `a + s b`.
fn along(a: Vector, s: f64, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + s * b[i])
}

fn unit(v: Vector, name: &str) -> Result<Vector, String> {
    match length(v) {
        l if l > 0.0 => Ok(v.map(|x| x / l)),
        _ => Err(format!("its {name} is zero: no bond is cut there")),
    }
}

fn filter(entry: &Entry, target: &Target, remarks: &mut Vec<String>) -> Result<String, String> {
    let kind = entry.text("Type").unwrap_or("").to_lowercase();
    if entry.is_true("Allow Contact") {
        entry.refuse_entry(
            "Allow Contact",
            "cut bonds push nothing here: give the faces `contact`",
        );
    }
    match &*kind.replace('_', " ") {
        "rectangular plane" => plane(entry, target, remarks),
        "disk" if target.dimension == 3 => disk(entry, target, remarks),
        other => Err(format!(
            "no pre-crack of type \"{other}\" in {}-D",
            target.dimension
        )),
    }
}

fn positive(entry: &Entry, key: &str) -> Result<f64, String> {
    let x = entry
        .number(key)
        .ok_or_else(|| format!("it has no {key}"))?;
    match x > 0.0 {
        true => Ok(x),
        false => Err(format!("its {key} is {x}, expected a positive length")),
    }
}

/// Distances along the normal at which cracks stand: 0, or both sides of points on the plane.
fn sides(corner: Vector, normal: Vector, target: &Target) -> Vec<f64> {
    let aside = ASIDE * target.horizon;
    let near = 0.1 * aside * length(normal);
    let (mut on, mut below) = (false, false);
    for x in target.position {
        // the sum as it stands there: exactly on the plane or beside it is what decides
        let d = dot(along(corner, -1.0, *x), normal);
        on |= d == 0.0;
        below |= d > 0.0 && d <= near;
    }
    match (on, below) {
        (false, false) => vec![0.0],
        (false, true) => vec![aside],
        (true, _) => vec![-aside, aside],
    }
}

fn plane(entry: &Entry, target: &Target, remarks: &mut Vec<String>) -> Result<String, String> {
    let mut normal = vector(entry, "Normal")?;
    let corner = vector(entry, "Lower Left Corner")?;
    let mut bottom = vector(entry, "Bottom Unit Vector")?;
    let wide = positive(entry, "Bottom Length")?;
    let high = positive(entry, "Side Length")?;
    if target.program == Program::PeriLab {
        if target.dimension == 2 {
            (normal[2], bottom[2]) = (0.0, 0.0);
        }
        normal = unit(normal, "normal")?;
        bottom = unit(bottom, "bottom vector")?;
    }
    let n = unit(normal, "normal")?;
    unit(bottom, "bottom vector")?;
    let shapes = match target.dimension {
        2 => segments(corner, normal, bottom, [wide, high], target)?,
        _ => {
            let up = cross(bottom, normal);
            // edges: where the conditions end in the plane
            let flat = along(bottom, -dot(bottom, n), n);
            if length(flat) <= 1e-12 * length(bottom) {
                return Err("its bottom vector is along the normal: the whole plane is cut there; give the vector along the bottom edge".into());
            }
            let [a, b] = [wide / length(flat), high / length(up)];
            if (a / wide - 1.0).abs() > 1e-6 || (b / high - 1.0).abs() > 1e-6 {
                remarks.push(format!(
                    "line {}: the vectors of {} are not perpendicular and of unit length: it is cut as there, on {a:?} by {b:?}",
                    entry.line, entry.key
                ));
            }
            let [e, f] = [unit(flat, "bottom")?, unit(up, "side")?];
            let sides = sides(corner, normal, target);
            let over = if sides.len() > 1 {
                OVER * target.horizon
            } else {
                0.0
            };
            let at = |s: f64, x: f64, y: f64| along(along(along(corner, s, n), x, e), y, f);
            let shape = |s: &f64| {
                let (x, y) = ([-over, a + over], [-over, b + over]);
                let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| at(*s, x[i], y[j]));
                format!("polygon = {corners:?}")
            };
            sides.iter().map(shape).collect()
        }
    };
    Ok(written(shapes))
}

/// In the plane of the points: where both conditions hold on the line in which it meets that of the filter.
fn segments(
    corner: Vector,
    normal: Vector,
    bottom: Vector,
    [wide, high]: [f64; 2],
    target: &Target,
) -> Result<Vec<String>, String> {
    let lab = target.program == Program::PeriLab;
    let level = if lab {
        corner[2]
    } else {
        target.position[0][2]
    };
    let flat = unit(
        [normal[0], normal[1], 0.0],
        "normal in the plane of the points",
    )?;
    // from the corner to a point of the line
    let lift = (level - corner[2]) * normal[2] / (libm::hypot(normal[0], normal[1]));
    let base = along([corner[0], corner[1], level], -lift, flat);
    let line = [-flat[1], flat[0], 0.0];
    let far = |x: &Vector| length(along(*x, -1.0, base));
    let most = target.position.iter().map(far).fold(0.0, f64::max) + target.horizon;
    let (mut from, mut to) = (-most, most);
    let mut conditions = vec![(bottom, wide)];
    if !lab {
        conditions.push((cross(bottom, normal), high));
    }
    for (v, most) in conditions {
        let (at, slope) = (dot(along(base, -1.0, corner), v), dot(line, v));
        if slope.abs() <= 1e-12 * length(v) {
            if at < -1e-12 * most || at > most * (1.0 + 1e-12) {
                to = from;
            }
            continue;
        }
        let ends = [-at / slope, (most - at) / slope];
        from = from.max(ends[0].min(ends[1]));
        to = to.min(ends[0].max(ends[1]));
    }
    if from >= to {
        return Err("it does not meet the plane of the points: no bond is cut there".into());
    }
    let sides = sides(corner, normal, target);
    let over = if sides.len() > 1 {
        OVER * target.horizon
    } else {
        0.0
    };
    let flip = if dot(line, bottom) < 0.0 {
        [to + over, from - over]
    } else {
        [from - over, to + over]
    };
    let shape = |s: &f64| {
        let at = |x: f64| along(along(base, *s, flat), x, line);
        let [p, q] = flip.map(at);
        format!(
            "segment = {{ from = [{:?}, {:?}], to = [{:?}, {:?}] }}",
            p[0], p[1], q[0], q[1]
        )
    };
    Ok(sides.iter().map(shape).collect())
}

fn disk(entry: &Entry, target: &Target, remarks: &mut Vec<String>) -> Result<String, String> {
    let center = vector(entry, "Center")?;
    let normal = vector(entry, "Normal")?;
    let given = positive(entry, "Radius")?;
    let n = unit(normal, "normal")?;
    let (normal, radius) = match target.program {
        Program::Peridigm => (normal, given),
        Program::PeriLab => {
            if given != 1.0 {
                remarks.push(format!(
                    "line {}: PeriLab compares the distance from the center with the square of the radius: the disk has the radius {:?}, as there",
                    entry.line,
                    given * given
                ));
            }
            (n, given * given)
        }
    };
    let sides = sides(center, normal, target);
    // a bond through the rim is not cut there
    let within = if sides.len() > 1 { OVER } else { ASIDE } * target.horizon.min(radius);
    let shape = |s: &f64| {
        format!(
            "disk = {{ center = {:?}, normal = {normal:?}, radius = {:?} }}",
            along(center, *s, n),
            radius - within
        )
    };
    Ok(written(sides.iter().map(shape).collect()))
}

fn written(shapes: Vec<String>) -> String {
    let tables = shapes
        .iter()
        .map(|shape| format!("\n[[precrack]]\n{shape}\n"));
    tables.collect()
}
