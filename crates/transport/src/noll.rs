//! Noll's flux (sandia2010 (2.0.9a), Noll's Lemma I), whose divergence is the operator (2.0.9b): both by quadrature, of a function u on the line.
//!
//! With `φ_a(y, x) = φ(y − x)` odd, `φ_a(x − (1−λ)z, x + λz) = φ(−z)`, and the flux is `∫₀^δ z φ(z) ∫₀¹ F(u(x − (1−λ)z), u(x + λz)) dλ dz`; its derivative
//! is the operator without an error in δ. On a grid its sum over bonds is what they carry through a face, with the operator for its difference.

use crate::flux::Flux;
use crate::grid::Padded;
use crate::kernel::Kernel;
use crate::law::{Direction, Law};
use crate::quadrature::Gauss;
use crate::weights::Stencil;

/// What flows through each face of the cells of a line, from the lower end on (u · length/time; a face more than points): (2.0.9a) summed over bonds,
/// `f_{i+1/2} = h Σ_m w_m Σ_{j = i−m+1}^{i} F(u_j, u_{j+m})`, less what spreads, `ε h Σ_m w_m Σ_j (u_{j+m} − u_j)`. Every bond that crosses a face carries through it, so that
/// `u_t = −(f_{i+1/2} − f_{i−1/2})/h` holds to round-off. Zeros of a plane, where it is no number.
pub fn through_faces(law: &Law, u: &[f64], t: f64) -> Vec<f64> {
    let n = law.grid.cells[0];
    let mut flux = vec![0.0; n + 1];
    if law.grid.dimension > 1 {
        return flux;
    }
    let padded = Padded::new(law.grid, law.reach());
    let mut v = vec![];
    padded.fill(u, &law.boundary, t, &mut v);
    let mut add = |stencil: &Stencil, pair: &dyn Fn(usize, usize) -> f64| {
        for (step, w) in stencil.steps.iter().zip(&stencil.weights) {
            let m = step[0].unsigned_abs();
            // bonds of the first face begin in the m cells before it, of the last in the last m
            let first = padded.row(0) - m;
            let bonds: Vec<f64> = { first..first + m + n }.map(|j| pair(j, j + m)).collect();
            let scale = law.grid.spacing * w[0];
            let mut crossing: f64 = bonds[..m].iter().sum();
            for (face, flux) in flux.iter_mut().enumerate() {
                *flux += scale * crossing;
                if face < n {
                    crossing += bonds[face + m] - bonds[face];
                }
            }
        }
    };
    if let Some(a) = &law.advection {
        let field = law.direction(&padded);
        let along = |i: usize, j: usize| match &a.direction {
            Direction::Constant(d) => d[0],
            Direction::Field(_) => 0.5 * (field[0][i] + field[0][j]),
        };
        add(&a.stencil, &|i, j| along(i, j) * a.flux.value(v[i], v[j]));
    }
    if let Some(d) = &law.diffusion {
        add(&d.stencil, &|i, j| d.viscosity * (v[i] - v[j]));
    }
    flux
}

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
