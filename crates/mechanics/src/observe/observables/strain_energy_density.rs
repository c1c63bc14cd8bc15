//! `strain_energy_density`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "strain_energy_density",
        Shape::Scalar,
        Dimension::PRESSURE,
        "Energy of the intact bonds, half of a bond at either end.",
    )
    .derived(),
    equation: "W = Σ_j ½ w(r_ij) V_j",
    source: "Silling, Askari 2005, (3); Silling et al. 2007",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(state.energies().strain.clone()))
}
