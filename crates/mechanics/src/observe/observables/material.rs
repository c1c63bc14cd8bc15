//! `material`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "material",
        Shape::Scalar,
        Dimension::NUMBER,
        "Place of the material in the list of materials, from 0.",
    ),
    equation: "",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Counts(by_id(state, |s, i| s.material(i) as u32)))
}
