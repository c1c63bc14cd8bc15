//! Axes of a material: two directions, each the same everywhere or an expression of the place in the reference.

use crate::expression::Expression;
use crate::law::descriptor::{Key, Need, Value};
use crate::space::Point;
use crate::spec::Parameters;

/// The keys of axis 1 and axis 3.
pub const FIBRE: Key = key(
    "fibre",
    "Direction of axis 1, numbers or expressions of x, y, z in the reference; [1, 0, 0] by default.",
);
pub const NORMAL: Key = key(
    "normal",
    "Direction of axis 3, from which its part along the fibre is taken, as `fibre`; [0, 0, 1] by default.",
);

const fn key(name: &'static str, doc: &'static str) -> Key {
    Key {
        name,
        value: Value::Direction,
        need: Need::Optional,
        doc,
    }
}

/// A direction; its length does not matter.
#[derive(Debug, Clone)]
enum Direction {
    Everywhere(Point),
    Of([Expression; 3]),
}

impl Direction {
    fn written(parameters: &Parameters, key: &Key, default: Point) -> Direction {
        if let Some(components) = parameters.direction(key.name) {
            return Direction::Of(components.clone());
        }
        Direction::Everywhere(match parameters.list(key.name) {
            Some(list) => [list[0], list[1], list[2]],
            None => default,
        })
    }

    fn varies(&self) -> bool {
        matches!(self, Direction::Of(_))
    }

    fn at(&self, place: &Point) -> Point {
        match self {
            Direction::Everywhere(direction) => *direction,
            Direction::Of(components) => crate::array::from_fn(|a| components[a].eval(place, 0.0)),
        }
    }
}

/// Axes 1 and 3 as they are written; axis 2 is `e₃ × e₁`.
#[derive(Debug, Clone)]
pub struct Axes {
    fibre: Direction,
    normal: Direction,
}

impl Axes {
    /// Of the keys [`FIBRE`] and [`NORMAL`].
    pub fn written(parameters: &Parameters) -> Axes {
        Axes {
            fibre: Direction::written(parameters, &FIBRE, [1.0, 0.0, 0.0]),
            normal: Direction::written(parameters, &NORMAL, [0.0, 0.0, 1.0]),
        }
    }

    /// Do they differ from place to place?
    pub fn varies(&self) -> bool {
        self.fibre.varies() || self.normal.varies()
    }

    /// e₁, e₂, e₃ at a place of the reference (length), each of length one.
    ///
    /// # Errors
    /// No axes: a direction is 0 or no number, or both are parallel.
    pub fn at(&self, place: &Point) -> Result<[Point; 3], String> {
        let size = |v: &Point| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [first, third] = [self.fibre.at(place), self.normal.at(place)];
        let [a, b] = [size(&first), size(&third)];
        for (key, length) in [(FIBRE, a), (NORMAL, b)] {
            if !(length > 0.0 && length.is_finite()) {
                let found = if length == 0.0 { "0" } else { "no number" };
                let name = key.name;
                return Err(format!("`{name}` is {found}, expected a direction"));
            }
        }
        let first = first.map(|x| x / a);
        let along = (0..3).map(|k| first[k] * third[k]).sum::<f64>() / b;
        let mut third: Point = crate::array::from_fn(|k| third[k] / b - along * first[k]);
        let rest = size(&third);
        if !(rest > 1e-6) {
            return Err("`fibre` and `normal` are parallel: say another `normal`, the third axis of the material ([0, 0, 1] by default)".into());
        }
        third = third.map(|x| x / rest);
        // e₂ = e₃ × e₁
        let second = crate::array::from_fn(|k| {
            let [l, m] = [(k + 1) % 3, (k + 2) % 3];
            third[l] * first[m] - third[m] * first[l]
        });
        Ok([first, second, third])
    }

    /// The same of axes that are the same everywhere; `None`: they are not.
    ///
    /// # Errors
    /// As of [`Axes::at`].
    pub fn everywhere(&self) -> Result<Option<[Point; 3]>, String> {
        match self.varies() {
            true => Ok(None),
            false => self.at(&[0.0; 3]).map(Some),
        }
    }
}
