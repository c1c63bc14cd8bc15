//! Higher-order-gradient (HOG) equations: what a model of points is as a partial differential equation.
//!
//! The force density of a smooth deformation y(x) is ordered by powers of the model's length:
//! `ρ ÿ = Σ_p P_p(y′, y″, …)`, where P_p is of gradient order 2p + 2 (seleson2009 sections 3–5).

pub mod comparison;
pub mod fractions;
pub mod inner;
pub mod law_sum;
pub mod linear;
pub mod matrix;
pub mod nonlinear;
pub mod power_law;
pub mod universal;

use crate::exact::Field;
use crate::exact::polynomial::JetPolynomial;

/// Force density of a smooth deformation of a chain, by gradient order.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion<F> {
    /// `orders[p]`: the part of gradient order 2p + 2 (force / length³, in 1-D with a section).
    pub orders: Vec<JetPolynomial<F>>,
}

/// The length scale of a gradient equation `ρ ü = c₂ u″ + c₄ u⁗ + …`: `L = √|c₄/c₂|` (length; seleson2009 (3.2), where b is −c₄). Waves much longer than L
/// do not know it. `None`: one of them is missing.
pub fn length_scale(coefficients: &[f64]) -> Option<f64> {
    match coefficients {
        [c2, c4, ..] if *c2 != 0.0 => Some((c4 / c2).abs().sqrt()),
        _ => None,
    }
}

impl<F: Field> Expansion<F> {
    /// `Σ_p c_p ∂^{2p+2} y`.
    pub fn linear(coefficients: &[F]) -> Self {
        let term = |(p, c): (usize, &F)| JetPolynomial::derivative_of_order(2 * p + 2, c.clone());
        Expansion {
            orders: coefficients.iter().enumerate().map(term).collect(),
        }
    }

    /// Sum of all orders where `jet = [y′, y″, …]`.
    pub fn at(&self, jet: &[f64]) -> f64 {
        self.orders.iter().map(|p| p.at(jet)).sum()
    }

    /// Coefficients in floating point.
    pub fn approximate(&self) -> Expansion<f64> {
        Expansion {
            orders: self.orders.iter().map(|p| p.map(F::value)).collect(),
        }
    }
}
