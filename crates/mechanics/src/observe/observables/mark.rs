//! `mark`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "mark",
        Shape::Scalar,
        Dimension::NUMBER,
        "Mark that the point came with, of a mesh or a file; else 0.",
    ),
    equation: "",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Integers(by_id(state, |s, i| s.mark(i))))
}
