//! `repulsion_energy_density`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "repulsion_energy_density",
        Shape::Scalar,
        Dimension::PRESSURE,
        "Energy of points that are too close: inside families and of contact, half of a pair at either end.",
    ).derived(),
    equation: "Σ_j ¼ K (r − d)² V_j, r < d",
    source: "Parks et al. 2008, (3.0.6)",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(state.energies().repulsion.clone()))
}
