//! Noll's flux (sandia2010 (2.0.9a), Noll's Lemma I), whose divergence is the operator (2.0.9b): both by quadrature, of a function u on the line.
//!
//! With `φ_a(y, x) = φ(y − x)` odd, `φ_a(x − (1−λ)z, x + λz) = φ(−z)`, and the flux is `∫₀^δ z φ(z) ∫₀¹ F(u(x − (1−λ)z), u(x + λz)) dλ dz`; its derivative
//! is the operator without an error in δ.

use crate::flux::Flux;
use crate::kernel::Kernel;
use crate::quadrature::Gauss;

/// Both sides of (2.0.9b) for one u.
#[derive(Debug, Clone)]
pub struct Noll<'a, U> {
    pub flux: &'a Flux,
    /// Odd, on a line.
    pub kernel: &'a Kernel,
    pub u: U,
    pub gauss: Gauss,
}

impl<U: Fn(f64) -> f64> Noll<'_, U> {
    /// The flux at x (u² for Burgers).
    pub fn flux(&self, x: f64) -> f64 {
        let line = |z: f64| {
            let pair = |l: f64| {
                self.flux
                    .value((self.u)(x - (1.0 - l) * z), (self.u)(x + l * z))
            };
            z * self.kernel.value(z) * self.gauss.integral(0.0, 1.0, pair)
        };
        self.gauss.between(&self.kernel.parts(), line)
    }

    /// `∫ F(u(x), u(y)) φ_a(y, x) dy` at x.
    pub fn operator(&self, x: f64) -> f64 {
        let here = (self.u)(x);
        let both = |z: f64| {
            self.flux.value(here, (self.u)(x + z)) - self.flux.value(here, (self.u)(x - z))
        };
        self.gauss
            .between(&self.kernel.parts(), |z| self.kernel.value(z) * both(z))
    }

    /// `f(b) − f(a)` and the integral of the operator from a to b: the identity, without a derivative.
    pub fn identity(&self, a: f64, b: f64) -> [f64; 2] {
        [
            self.flux(b) - self.flux(a),
            self.gauss.integral(a, b, |x| self.operator(x)),
        ]
    }
}
