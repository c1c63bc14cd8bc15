//! `force_density`

use super::by_id;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "force_density",
        Shape::Vector,
        Dimension::FORCE_DENSITY,
        "Force per volume of the last sweep, of all that acts but constraints.",
    )
    .derived(),
    equation: "f = Σ_j (t_ij − t_ji) V_j + b",
    source: "Silling 2000, (1)",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Vectors(by_id(state, |s, i| s.force_density(i))))
}
