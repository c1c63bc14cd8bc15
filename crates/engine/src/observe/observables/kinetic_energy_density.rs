//! `kinetic_energy_density`

use super::{Needs, Observable};
use super::{by_id, square};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "kinetic_energy_density",
        Shape::Scalar,
        Dimension::PRESSURE,
        "Energy of motion per volume.",
    )
    .derived(),
    equation: "½ ρ v·v",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(by_id(state, |s, i| {
        0.5 * s.density(i) * square(s.velocity(i))
    })))
}
