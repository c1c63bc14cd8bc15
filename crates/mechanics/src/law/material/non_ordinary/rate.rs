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

/// The column of [`Step::across`] that a plane remembers.
pub fn across_column() -> Declaration {
    Declaration::of_points(
        "strain_across",
        Shape::Scalar,
        Dimension::NUMBER,
        "Elastic strain across a plane, the reverse of what temperature or swelling would give it.",
    )
}

/// What is across a plane.
#[derive(Debug, Clone, Copy)]
pub struct Across<N> {
    /// Stretch less 1, at the end of a step.
    pub strain: N,
    /// Δε, and with the mean of both ends.
    pub grown: N,
    pub mean: N,
}

impl<N: Number> Across<N> {
    /// From the strain before to that of now.
    #[inline(always)]
    fn new(rule: Increment, before: N, now: N) -> Self {
        let (one, half) = (N::constant(1.0), N::constant(0.5));
        let change = now - before;
        let mean = change.div(half.fma(before + now, one));
        let grown = match rule {
            Increment::Middle => mean,
            Increment::End => change.div(one + now),
        };
        Across {
            strain: now,
            grown,
            mean,
        }
    }
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
    pub across: Across<N>,
    /// J − 1 and J at both ends.
    pub dilations: [N; 2],
    pub volumes: [N; 2],
}

impl<N: Number, const D: usize> Step<N, D> {
    /// From U − 1 before to `F = 1 + H`, each with the strain across a plane.
    #[inline(always)]
    pub fn new(
        rule: Increment,
        (before, thin): (&Matrix<N, D>, N),
        (h, thick): (&Matrix<N, D>, N),
    ) -> Self {
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
        let mut dilations = [tensor::dilation(before), tensor::dilation(&stretch)];
        if D == 2 {
            dilations = [
                thin.fma(dilations[0], dilations[0]) + thin,
                thick.fma(dilations[1], dilations[1]) + thick,
            ];
        }
        Step {
            turn,
            stretch,
            strain,
            mean,
            across: Across::new(rule, thin, thick),
            dilations,
            volumes: [one + dilations[0], one + dilations[1]],
        }
    }

    /// tr Δε, and that with the mean of both ends.
    #[inline(always)]
    pub fn spread(&self) -> [N; 2] {
        let (spread, mean) = (tensor::trace(&self.strain), tensor::trace(&self.mean));
        match D {
            2 => [spread + self.across.grown, mean + self.across.mean],
            _ => [spread, mean],
        }
    }

    /// Work of stresses at both ends per reference volume, `½ Σ J σ_u : Δε`: the trapezoidal rule. Each comes with that across a plane.
    #[inline(always)]
    pub fn work(&self, before: (&Matrix<N, D>, N), after: (&Matrix<N, D>, N)) -> N {
        let of = [before, after];
        let mut ends = self.volumes;
        for k in 0..2 {
            let mut rate = tensor::contraction(of[k].0, &self.mean);
            if D == 2 {
                rate = self.across.mean.fma(of[k].1, rate);
            }
            ends[k] = ends[k] * rate;
        }
        N::constant(0.5) * (ends[0] + ends[1])
    }

    /// `P_zz = σ_zz J/λ_z` at its end.
    #[inline(always)]
    pub fn nominal_across(&self, s: N) -> N {
        tensor::dilation(&self.stretch).fma(s, s)
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
                if D == 2 {
                    p[r][c] = self.across.strain.fma(p[r][c], p[r][c]);
                }
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
