//! `body`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "body",
        Shape::Scalar,
        Dimension::NUMBER,
        "Place of the body in the list of bodies, from 0.",
    ),
    equation: "",
    source: "",
    needs: Needs::Bodies,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    if state.bodies() < 2 {
        return None;
    }
    Some(Values::Counts(by_id(state, |s, i| s.body(i) as u32)))
}
