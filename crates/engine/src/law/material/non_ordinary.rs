//! What laws have in common that take the deformation gradient of a family (Silling et al. 2007), with control of zero-energy modes
//! (Silling 2017).
//!
//! `H = (Σ ω ν V η⊗ξ) K⁻¹`, `F = 1 + H`, `T⟨ξ⟩ = ω (P K⁻¹ ξ + g z)` with the part of the deformation that F does not see,
//! `z = η − Hξ`, and `g = G_z β/m`, `β = D(D+2) μ`: a control of G_z = 1 resists it as the linear peridynamic solid of the same shear
//! modulus would. `Σ ω ν V z⊗ξ = 0`, so it does no work on F: `W = ψ + (g/2) Σ ω ν V z²`.
//! K is that of the whole bonds. Points whose bonds span no space have no P, but keep the control.

use super::tensor::{self, Matrix};
use super::{Bond, Free};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{self, Bounds, Key};
use crate::law::number::Number;

/// `K⁻¹`, 1/m, and 1 where K can be inverted.
pub type Form<N, const D: usize> = (Matrix<N, D>, [N; 2]);
/// `P K⁻¹ − g H`, g.
pub type Answers<N, const D: usize> = (Matrix<N, D>, N);

/// `G_z β` (pressure).
pub fn control<const D: usize>(part: f64, shear: f64) -> f64 {
    let d = D as f64;
    part * d * (d + 2.0) * shear
}

pub fn form<const D: usize>(shape: [[f64; D]; D]) -> Form<f64, D> {
    let (inverse, whole) = tensor::inverse(shape);
    let sound = if whole { 1.0 } else { 0.0 };
    (inverse, [super::inverse_weight(&shape), sound])
}

/// `ω η⊗ξ`
#[inline(always)]
pub fn share<N: Number, const D: usize>(bond: &Bond<N, D>) -> Matrix<N, D> {
    let mut sum = tensor::zero();
    for r in 0..D {
        let eta = bond.omega * bond.eta[r];
        for c in 0..D {
            sum[r][c] = eta * bond.xi[c];
        }
    }
    sum
}

/// H from the sum of the shares.
#[inline(always)]
pub fn gradient<N: Number, const D: usize>(form: &Form<N, D>, sum: &Matrix<N, D>) -> Matrix<N, D> {
    tensor::product(sum, &form.0)
}

/// `x` of a point whose bonds span the space, else `otherwise`: where F is not known a stress may be anything.
#[inline(always)]
pub fn known<N: Number, const D: usize>(form: &Form<N, D>, x: N, otherwise: N) -> N {
    form.1[1].choose(N::constant(0.5), otherwise, x)
}

/// What the bonds of a point answer with, under P and H; `control` is `G_z β`.
#[inline(always)]
pub fn answers<N: Number, const D: usize>(
    form: &Form<N, D>,
    stress: &Matrix<N, D>,
    h: &Matrix<N, D>,
    control: N,
) -> Answers<N, D> {
    let along = tensor::product(stress, &form.0);
    let g = control * form.1[0];
    let mut out = along;
    for r in 0..D {
        for c in 0..D {
            out[r][c] = known(form, along[r][c], N::constant(0.0)) - g * h[r][c];
        }
    }
    (out, g)
}

#[inline(always)]
pub fn answer<N: Number, const D: usize>(bond: &Bond<N, D>, answers: &Answers<N, D>) -> Free<N, D> {
    let (along, g) = answers;
    let mut t = tensor::times(along, &bond.xi);
    for a in 0..D {
        t[a] = bond.omega * g.fma(bond.eta[a], t[a]);
    }
    Free(t)
}

/// `(g/2) ω η²`, of which the point takes back what F sees.
#[inline(always)]
pub fn bond_energy<N: Number, const D: usize>(bond: &Bond<N, D>, answers: &Answers<N, D>) -> N {
    let mut square = bond.eta[0] * bond.eta[0];
    for a in 1..D {
        square = bond.eta[a].fma(bond.eta[a], square);
    }
    N::constant(0.5) * answers.1 * bond.omega * square
}

/// That of the point, of which `energy` is ψ.
#[inline(always)]
pub fn point_energy<N: Number, const D: usize>(
    form: &Form<N, D>,
    sum: &Matrix<N, D>,
    h: &Matrix<N, D>,
    answers: &Answers<N, D>,
    energy: N,
) -> N {
    // H K Hᵀ = S Hᵀ
    let seen = N::constant(0.5) * answers.1 * tensor::contraction(sum, h);
    known(form, energy, N::constant(0.0)) - seen
}

/// The column of [`Answers`].
pub fn column() -> Declaration {
    let column = Declaration::of_points(
        "force_state_gradient",
        Shape::Tensor,
        Dimension([-6, 1, -2, 0]),
        "P K⁻¹ − g H: what the force state of a bond is linear in ξ with (Silling et al. 2007).",
    );
    column.derived()
}

/// The key of `G_z`.
pub const fn control_key() -> Key {
    descriptor::number(
        "control",
        Dimension::NUMBER,
        Bounds::NOT_NEGATIVE,
        "Stiffness G_z against deformations that F does not see, 1: that of the linear peridynamic solid.",
    )
    .or(0.1)
}
