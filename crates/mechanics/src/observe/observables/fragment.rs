//! `fragment`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "fragment",
        Shape::Scalar,
        Dimension::NUMBER,
        "Number of the piece that intact bonds connect the point to; 0 is the largest.",
    )
    .derived(),
    equation: "",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Counts(state.fragments()))
}
