//! `kinetic_energy_density`

use super::{Needs, Observable};
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
    equation: "½ ρ v·v; where masses couple points ½ v_i·Σ_j M_ij v_j / V_i",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(state.kinetic_energy_density()))
}
