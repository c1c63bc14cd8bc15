//! `*NODE` and `*SYSTEM`.

use super::super::error::ReadError;
use super::input::{Block, Rows};
use super::model::{Frame, Model, Of};
use peridyne::space::{cross, length};

/// How places are given.
#[derive(Clone, Copy)]
pub(super) enum System {
    Rectangular,
    Cylindrical,
    Spherical,
}

impl System {
    /// Of the option `SYSTEM`.
    pub fn of(block: &Block) -> Result<System, ReadError> {
        match block.keyword.value("SYSTEM").map(str::to_uppercase) {
            None => Ok(System::Rectangular),
            Some(name) => match &*name {
                "R" | "RC" => Ok(System::Rectangular),
                "C" => Ok(System::Cylindrical),
                "S" => Ok(System::Spherical),
                other => Err(block.error(format!("SYSTEM={other} is none of R, C, S"))),
            },
        }
    }

    /// In x, y, z. Angles are in degrees: θ about z from x on, φ from the x-y plane towards z.
    pub fn place(self, x: [f64; 3]) -> [f64; 3] {
        let [r, theta, c] = x;
        match self {
            System::Rectangular => x,
            System::Cylindrical => {
                let (sine, cosine) = libm::sincos(theta.to_radians());
                [r * cosine, r * sine, c]
            }
            System::Spherical => {
                let (sine, cosine) = libm::sincos(theta.to_radians());
                let (height, out) = libm::sincos(c.to_radians());
                [r * out * cosine, r * out * sine, r * height]
            }
        }
    }
}

/// `*NODE`: number, place, and perhaps a normal, which only beams and shells have.
pub(super) fn nodes(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&["NSET", "SYSTEM", "INPUT"])?;
    let system = System::of(block)?;
    let here = model.here();
    let frame = here.system;
    let mut numbers = Vec::new();
    let mut rows = block.rows();
    while rows.next() {
        let number = rows.number(0, "a node number")?;
        if rows.fields.len() > 7 {
            return Err(rows.error("a line of *NODE has a number, x, y, z and perhaps a normal"));
        }
        let x = system.place(rows.point(1)?);
        let x = frame.map_or(x, |frame| frame.apply(&x));
        here.node(&rows, number, x)?;
        numbers.push(number);
    }
    if let Some(label) = block.label("NSET") {
        here.add(Of::Nodes, label, numbers, false);
    }
    Ok(())
}

fn scaled(x: &[f64; 3]) -> Option<[f64; 3]> {
    let size = length(x);
    (size > 0.0).then(|| x.map(|c| c / size))
}

/// `*SYSTEM`: a the origin, b on the x axis, c in the x-y plane; without c the z axis stays, without b all axes do, without
/// data nodes are given in the coordinates outside again.
pub(super) fn system(block: &Block, model: &mut Model) -> Result<(), ReadError> {
    block.only(&[])?;
    let mut rows = block.rows();
    let mut points: Vec<[f64; 3]> = Vec::new();
    while rows.next() {
        for from in (0..rows.fields.len()).step_by(3) {
            if from == 0 || rows.any(from..from + 3) {
                points.push(rows.point(from)?);
            }
        }
    }
    model.here().system = frame(&rows, &points)?;
    Ok(())
}

fn frame(rows: &Rows, points: &[[f64; 3]]) -> Result<Option<Frame>, ReadError> {
    let less = |x: &[f64; 3], y: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| x[k] - y[k]) };
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let columns = match points {
        [] => return Ok(None),
        [_] => Some(unit),
        [a, b] => {
            let [x, y, _] = less(b, a);
            scaled(&[x, y, 0.0]).map(|x| [x, [-x[1], x[0], 0.0], unit[2]])
        }
        [a, b, c] => scaled(&less(b, a)).and_then(|x| {
            let z = scaled(&cross(&x, &less(c, a)))?;
            Some([x, cross(&z, &x), z])
        }),
        _ => return Err(rows.error("*SYSTEM has at most three points")),
    };
    let Some(columns) = columns else {
        return Err(rows.error("the points of *SYSTEM lie on one another, or on a line"));
    };
    Ok(Some(Frame {
        axes: std::array::from_fn(|r| std::array::from_fn(|c| columns[c][r])),
        origin: points[0],
    }))
}
