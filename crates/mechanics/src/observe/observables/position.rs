//! `position`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "position",
        Shape::Vector,
        Dimension::LENGTH,
        "Position now, not wrapped into periods.",
    )
    .derived(),
    equation: "y = x + u",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Vectors(by_id(state, |s, i| {
        let (x, u) = (s.reference(i), s.displacement(i));
        crate::array::from_fn(|a| x[a] + u[a])
    })))
}
