//! Steps of laws in rate form, whose stress grows with the rate of deformation, as the turned material sees them.
//!
//! With `F = RU` the Cauchy stress seen from the turned material, `σ_u = Rᵀ σ R`, is fed by the unrotated rate of deformation
//! `d = Rᵀ D R = sym(U̇ U⁻¹)`: the rate of Green & Naghdi (1965), as Flanagan & Taylor (1987) integrate it. A step has the increment of
//! strain `Δε = sym(ΔU Ū⁻¹)`: no rotation, however large, is seen. `P = J σ F⁻ᵀ = R σ_u cof(U)`.

use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{Key, Need, Value};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::Number;
use crate::spec::Parameters;

/// Where in a step Ū is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Increment {
    /// The mean of both ends, `½(U + U′)`: of second order (Hughes & Winget 1980).
    Middle,
    /// The end: of first order.
    End,
}

pub const INCREMENT: Key = Key {
    name: "increment",
    value: Value::Word(&[
        (
            "middle",
            "Ū = ½(U + U′), of second order in the step (Hughes & Winget 1980)",
        ),
        ("end", "Ū = U′ at the end of the step, of first order"),
    ]),
    need: Need::Word("middle"),
    doc: "The stretch Ū in the increment of strain sym(ΔU Ū⁻¹).",
};

impl Increment {
    /// What [`INCREMENT`] says.
    pub fn of(parameters: &Parameters) -> Option<Increment> {
        match parameters.word(INCREMENT.name) {
            Some("middle") => Some(Increment::Middle),
            Some("end") => Some(Increment::End),
            Some(_) | None => None,
        }
    }
}

/// What laws in rate form remember first: U − 1, σ_u, and the work so far.
pub fn columns() -> Vec<Declaration> {
    vec![
        Declaration::of_points(
            "biot_strain",
            Shape::Tensor,
            Dimension::NUMBER,
            "U − 1 of the right stretch U of the family's deformation gradient.",
        ),
        Declaration::of_points(
            "unrotated_stress",
            Shape::Tensor,
            Dimension::PRESSURE,
            "Cauchy stress seen from the turned material, Rᵀ σ R.",
        ),
        Declaration::of_points(
            "stress_work",
            Shape::Scalar,
            Dimension::PRESSURE,
            "Work of the stress so far per reference volume, ∫ J σ : D dt.",
        ),
    ]
}

/// A step of the deformation.
#[derive(Debug, Clone, Copy)]
pub struct Step<N, const D: usize> {
    /// R − 1 and U − 1 at its end.
    pub turn: Matrix<N, D>,
    pub stretch: Matrix<N, D>,
    /// Δε.
    pub strain: Matrix<N, D>,
    /// Δε with the mean of both ends.
    pub mean: Matrix<N, D>,
    /// J at both ends.
    pub volumes: [N; 2],
}

impl<N: Number, const D: usize> Step<N, D> {
    /// From U − 1 before to `F = 1 + H`.
    #[inline(always)]
    pub fn new(rule: Increment, before: &Matrix<N, D>, h: &Matrix<N, D>) -> Self {
        let (turn, stretch) = tensor::polar(h);
        let half = N::constant(0.5);
        let (mut change, mut middle) = (stretch, stretch);
        for r in 0..D {
            for c in 0..D {
                change[r][c] = stretch[r][c] - before[r][c];
                middle[r][c] = half.fma(change[r][c], before[r][c]);
            }
        }
        let mean = increment(&change, &middle);
        let strain = match rule {
            Increment::Middle => mean,
            Increment::End => increment(&change, &stretch),
        };
        let one = N::constant(1.0);
        Step {
            turn,
            stretch,
            strain,
            mean,
            volumes: [
                one + tensor::dilation(before),
                one + tensor::dilation(&stretch),
            ],
        }
    }

    /// Work of stresses at both ends per reference volume, `½ Σ J σ_u : Δε`: the trapezoidal rule.
    #[inline(always)]
    pub fn work(&self, before: &Matrix<N, D>, after: &Matrix<N, D>) -> N {
        let before = self.volumes[0] * tensor::contraction(before, &self.mean);
        let after = self.volumes[1] * tensor::contraction(after, &self.mean);
        N::constant(0.5) * (before + after)
    }

    /// `P = R σ_u cof(U)` at its end.
    #[inline(always)]
    pub fn nominal(&self, s: &Matrix<N, D>) -> Matrix<N, D> {
        let more = tensor::product(&self.turn, s);
        let mut turned = *s;
        for r in 0..D {
            for c in 0..D {
                turned[r][c] = s[r][c] + more[r][c];
            }
        }
        let more = tensor::product(&turned, &tensor::cofactor_beyond(&self.stretch));
        let mut p = turned;
        for r in 0..D {
            for c in 0..D {
                p[r][c] = turned[r][c] + more[r][c];
            }
        }
        p
    }
}

/// `sym(ΔU Ū⁻¹)` of `ΔU = change` and `Ū = 1 + v`.
#[inline(always)]
fn increment<N: Number, const D: usize>(change: &Matrix<N, D>, v: &Matrix<N, D>) -> Matrix<N, D> {
    let cofactors = tensor::cofactor_beyond(v);
    let half = N::constant(0.5) * (N::constant(1.0) + tensor::dilation(v)).recip();
    let more = tensor::product(change, &cofactors);
    let mut out = *change;
    for r in 0..D {
        for c in 0..D {
            out[r][c] = half * ((change[r][c] + more[r][c]) + (change[c][r] + more[c][r]));
        }
    }
    out
}
