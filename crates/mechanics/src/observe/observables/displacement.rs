//! `displacement`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "displacement",
        Shape::Vector,
        Dimension::LENGTH,
        "Displacement of the point from where it is in the reference.",
    ),
    equation: "u",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Vectors(by_id(state, |s, i| s.displacement(i))))
}
