//! `dilatation`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "dilatation",
        Shape::Scalar,
        Dimension::NUMBER,
        "Change of volume; of laws without a dilatation of their own that of an isotropic strain with the same mean stretch.",
    ).derived(),
    equation: "θ = (n/m) Σ_j ω V_j r0 e, n = 3 (2 in plane models); Σ_j over intact bonds",
    source: "Silling et al. 2007, (103)",
    needs: Needs::Nothing,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Scalars(state.energies().dilatation.clone()))
}
