//! Two-point fluxes `F(u, v)`, symmetric, with the local flux `f(u) = F(u, u)`.
//!
//! A polynomial is a symmetric matrix, `F(u, v) = Σ A_pq u^p v^q`, so that `∫ F(u(x), u(y)) φ(y − x) dy = Σ_p u^p Σ_q A_pq (φ * u^q)`:
//! products with convolutions, though the operator is no convolution itself.

use crate::formula::Formula;
pub use crate::psi::{HIGHEST, Psi};
use peridyne::error::BuildError;
use std::fmt;
use std::sync::Arc;

/// How many values of u a flux is tried at.
const TRIED: usize = 65;

/// A two-point flux.
#[derive(Clone)]
pub enum Flux {
    /// The matrix A, symmetric.
    Polynomial(Vec<Vec<f64>>),
    /// `ψ((u + v)/2)`
    Function(Arc<dyn Psi>),
}

impl fmt::Debug for Flux {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Flux::Polynomial(a) => write!(f, "Polynomial({a:?})"),
            Flux::Function(_) => f.write_str("Function"),
        }
    }
}

impl Flux {
    /// `ψ = c u`, c a speed.
    pub fn linear(speed: f64) -> Flux {
        Flux::of_mean(&[0.0, speed])
    }

    /// `ψ = u²/2`: sandia2010 (2.0.18).
    pub fn burgers() -> Flux {
        Flux::of_mean(&[0.0, 0.0, 0.5])
    }

    /// `(u² + uv + v²)/6`, of Burgers' local flux: it conserves `∫u²`, as `F(u, v)(v − u) = (v³ − u³)/6`.
    pub fn energy_conserving() -> Flux {
        let s = 1.0 / 6.0;
        Flux::Polynomial(vec![
            vec![0.0, 0.0, s],
            vec![0.0, s, 0.0],
            vec![s, 0.0, 0.0],
        ])
    }

    /// `ψ((u + v)/2)` with `ψ(u) = Σ c_n uⁿ`, up to the power [`HIGHEST`]: `A_pq = c_n C(n, p)/2ⁿ`, n = p + q.
    pub fn of_mean(coefficients: &[f64]) -> Flux {
        let size = coefficients.len().clamp(1, HIGHEST + 1);
        let mut a = vec![vec![0.0; size]; size];
        for (n, c) in coefficients.iter().enumerate().take(size) {
            let mut binomial = 1.0;
            for p in 0..=n {
                a[p][n - p] = c * binomial / 2f64.powi(n as i32);
                binomial *= (n - p) as f64 / (p + 1) as f64;
            }
        }
        Flux::Polynomial(a)
    }

    /// `ψ((u + v)/2)` of an expression: as a polynomial where it is one and keeps its digits for u from `low` to `high`.
    pub fn of_formula(formula: Formula, low: f64, high: f64) -> Flux {
        match formula.expanded(low, high) {
            Some(coefficients) => Flux::of_mean(coefficients),
            None => Flux::Function(Arc::new(formula)),
        }
    }

    /// `F(u, v)`
    pub fn value(&self, u: f64, v: f64) -> f64 {
        match self {
            Flux::Polynomial(a) => {
                let row = |row: &Vec<f64>| row.iter().rev().fold(0.0, |sum, c| sum * v + c);
                a.iter().rev().fold(0.0, |sum, r| sum * u + row(r))
            }
            Flux::Function(psi) => psi.value(0.5 * (u + v)),
        }
    }

    /// The local flux `f(u)`.
    pub fn local(&self, u: f64) -> f64 {
        self.value(u, u)
    }

    /// The same flux `factor` times.
    #[must_use]
    pub fn times(&self, factor: f64) -> Flux {
        match self {
            Flux::Polynomial(a) => {
                let row = |row: &Vec<f64>| row.iter().map(|c| factor * c).collect();
                Flux::Polynomial(a.iter().map(row).collect())
            }
            Flux::Function(psi) => {
                let psi = psi.clone();
                Flux::Function(Arc::new(move |u: f64| factor * psi.value(u)))
            }
        }
    }

    /// Coefficients of the local flux `Σ c_n uⁿ`, the last of which is not 0; none of a function.
    pub fn coefficients(&self) -> Option<Vec<f64>> {
        let Flux::Polynomial(a) = self else {
            return None;
        };
        let mut sum = vec![0.0; 2 * a.len()];
        for (p, row) in a.iter().enumerate() {
            for (q, c) in row.iter().enumerate() {
                sum[p + q] += c;
            }
        }
        while sum.last() == Some(&0.0) {
            sum.pop();
        }
        Some(sum)
    }

    /// `f′(u)`; of a function by a central difference, by one to the side on which it has a value where the other has none.
    pub fn speed(&self, u: f64) -> f64 {
        match self {
            Flux::Polynomial(a) => {
                let mut sum = 0.0;
                for (p, row) in a.iter().enumerate() {
                    for (q, c) in row
                        .iter()
                        .enumerate()
                        .filter(|(q, c)| **c != 0.0 && p + q > 0)
                    {
                        sum += c * (p + q) as f64 * u.powi((p + q) as i32 - 1);
                    }
                }
                sum
            }
            Flux::Function(psi) => {
                let d = 6e-6 * u.abs().max(1.0);
                let [low, here, high] = [u - d, u, u + d].map(|u| psi.value(u));
                match (low.is_finite(), high.is_finite()) {
                    (false, true) => (high - here) / d,
                    (true, false) => (here - low) / d,
                    _ => (high - low) / (2.0 * d),
                }
            }
        }
    }

    /// Largest `|f′|` for u from `low` to `high`, at 65 values of it.
    pub fn fastest(&self, low: f64, high: f64) -> f64 {
        range(low, high).fold(0.0, |most: f64, u| match self.speed(u).abs() {
            speed if speed.is_nan() => speed,
            speed => most.max(speed),
        })
    }

    /// Can it be evaluated for all u from `low` to `high`?
    ///
    /// # Errors
    /// The first u where it cannot.
    pub fn evaluable(&self, low: f64, high: f64, path: &str) -> Result<(), BuildError> {
        match range(low, high).find(|u| !self.local(*u).is_finite()) {
            None => Ok(()),
            Some(u) => Err(BuildError::invalid(
                path,
                format!(
                    "the flux is {} at u = {u:.6}; u goes from {low:.6} to {high:.6} at the start",
                    self.local(u)
                ),
            )
            .help("write a flux that has a value for all u that can occur")),
        }
    }
}

fn range(low: f64, high: f64) -> impl Iterator<Item = f64> {
    (0..TRIED).map(move |k| low + (high - low) * k as f64 / (TRIED - 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fluxes_are_what_they_say() {
        let (u, v) = (0.7, -1.3);
        let mean: f64 = 0.5 * (u + v);
        assert!((Flux::burgers().value(u, v) - 0.5 * mean * mean).abs() < 1e-16);
        assert!((Flux::linear(3.0).value(u, v) - 3.0 * mean).abs() < 1e-15);
        let e = Flux::energy_conserving();
        assert!((e.value(u, v) - (u * u + u * v + v * v) / 6.0).abs() < 1e-16);
        assert!((e.local(u) - 0.5 * u * u).abs() < 1e-16);
        let cubic = Flux::of_mean(&[1.0, -2.0, 0.5, 4.0]);
        let psi = |u: f64| 1.0 - 2.0 * u + 0.5 * u * u + 4.0 * u * u * u;
        assert!((cubic.value(u, v) - psi(mean)).abs() < 1e-15);
        assert!((cubic.speed(u) - (-2.0 + u + 12.0 * u * u)).abs() < 1e-14);
        assert_eq!(cubic.coefficients().unwrap(), [1.0, -2.0, 0.5, 4.0]);
        assert!((e.times(-2.0).local(u) + u * u).abs() < 1e-15);
        let same = Flux::Function(Arc::new(psi));
        assert!((same.speed(u) - cubic.speed(u)).abs() < 1e-9);
        assert!((same.times(3.0).local(u) - 3.0 * psi(u)).abs() < 1e-15);
        assert!(same.coefficients().is_none());
    }

    #[test]
    fn what_cannot_be_evaluated_is_told() {
        let root = Flux::Function(Arc::new(f64::sqrt));
        assert!(root.evaluable(0.0, 1.0, "flux").is_ok());
        let told = root.evaluable(-1.0, 1.0, "flux").unwrap_err();
        assert!(told.message.contains("u = -1.0"), "{told}");
    }
}
