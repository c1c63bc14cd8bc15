//! `energy_density`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "energy_density",
        Shape::Scalar,
        Dimension::PRESSURE,
        "Strain and repulsion energy density.",
    )
    .derived(),
    equation: "strain_energy_density + repulsion_energy_density",
    source: "",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    let seen = state.energies();
    let both = seen.strain.iter().zip(&seen.repulsion);
    Some(Values::Scalars(both.map(|(a, b)| a + b).collect()))
}
