//! Functions ψ(u), of which fluxes are made.

/// Highest power of a polynomial flux.
pub const HIGHEST: usize = 8;

/// A function `ψ(u)`.
pub trait Psi: Send + Sync {
    fn value(&self, u: f64) -> f64;

    /// ψ in the place of each u; to round-off what [`Psi::value`] gives.
    fn values(&self, u: &mut [f64]) {
        u.iter_mut().for_each(|u| *u = self.value(*u));
    }
}

impl<F: Fn(f64) -> f64 + Send + Sync> Psi for F {
    fn value(&self, u: f64) -> f64 {
        self(u)
    }
}
