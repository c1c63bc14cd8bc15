//! `strain`

use super::PAIRS;
use super::{Needs, Observable};
use crate::columns::{Declaration, Dimension, Shape};
use crate::observe::least_squares;
use crate::observe::{State, Values};

pub static OBSERVABLE: Observable = Observable {
    declaration: Declaration::of_points(
        "strain",
        Shape::Symmetric,
        Dimension::NUMBER,
        "Green-Lagrange strain of the displacement gradient: no rotation shows in it, and for small gradients it is the linear strain. 0 at points whose intact bonds do not span the space.",
    ).derived(),
    equation: "E = ½ (H + Hᵀ + Hᵀ H), H = displacement_gradient",
    source: "Silling et al. 2007, (134)",
    needs: Needs::Family,
    of,
};

fn of(state: &mut dyn State) -> Option<Values> {
    let gradients = least_squares::gradient(state);
    let strain = gradients.iter().map(|h| {
        PAIRS.map(|(m, n)| {
            let product: f64 = (0..3).map(|k| h[3 * k + m] * h[3 * k + n]).sum();
            0.5 * (h[3 * m + n] + h[3 * n + m] + product)
        })
    });
    Some(Values::Symmetric(strain.collect()))
}
