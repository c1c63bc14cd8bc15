//! `damage`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "damage",
        Shape::Scalar,
        Dimension::NUMBER,
        "Part of the family that is broken; 0 without a family.",
    )
    .derived(),
    equation: "1 − Σ V_j (whole) / Σ V_j (family)",
    source: "Silling, Askari 2005, (33)",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(state.damage()))
}
