//! `displacement_gradient`

use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::least_squares;
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "displacement_gradient",
        Shape::Tensor,
        Dimension::NUMBER,
        "Gradient of the displacement in the reference, by weighted least squares over the intact bonds; exact for homogeneous deformations. 0 at points whose intact bonds do not span the space.",
    ).derived(),
    equation: "H = (Σ_j ω V_j η ⊗ ξ) K⁻¹, K = Σ_j ω V_j ξ ⊗ ξ",
    source: "Silling et al. 2007, (134)",
    needs: Needs::Family,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    Some(Values::Tensors(least_squares::gradient(state)))
}
