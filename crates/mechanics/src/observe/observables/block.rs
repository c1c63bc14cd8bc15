//! `block`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "block",
        Shape::Scalar,
        Dimension::NUMBER,
        "Block id of the point in its mesh or file; 0 without.",
    ),
    equation: "",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Integers(by_id(state, |s, i| s.mark(i))))
}
