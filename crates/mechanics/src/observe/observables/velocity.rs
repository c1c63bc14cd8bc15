//! `velocity`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "velocity",
        Shape::Vector,
        Dimension::VELOCITY,
        "Velocity at the whole step.",
    ),
    equation: "v = du/dt",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Vectors(by_id(state, |s, i| s.velocity(i))))
}
