//! Hypoelastic correspondence: a stress that grows with the rate of deformation, as rate forms of classical codes have it: in
//! a step ([`rate`]) the unrotated stress grows by `λ tr(Δε) 1 + 2μ Δε`.
//!
//! In one direction `σ = (λ + 2μ) ln F`. In simple shear it does not oscillate (Dienes 1979).
//!
//! Such a law has no potential: what it has for energy is the work of its stress, `ẇ = J σ_u : d`, by the trapezoidal rule, which a closed path
//! does not give back in full. Energy is balanced with it to second order in the step. Where
//! bonds let go, what that changes of the gradient is a step of no length of its own.

use super::rate::{self, INCREMENT, Increment, Step};
use super::{Classical, Stressed, Unseen};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{self, Descriptor, Given, MODULI, Memory, Registered};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::Number;
use crate::spec::{LawSpec, Parameters, Plane};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HypoelasticConstants {
    /// Lamé's λ and shear modulus μ.
    pub lame: f64,
    pub shear: f64,
}

/// See the module. All materials have the same kind of increment.
#[derive(Debug, Clone)]
pub struct Hypoelastic {
    pub increment: Increment,
    /// In the plane: are its faces free?
    pub sheet: bool,
    /// Per material.
    pub materials: Vec<HypoelasticConstants>,
}

const LAME: usize = 0;
const SHEAR: usize = 1;

/// U − 1 and σ_u at the end of the last step; the work so far; strain and stress across a plane.
type Past<N, const D: usize> = ([Matrix<N, D>; 2], [N; 3]);

impl<const D: usize> Classical<D> for Hypoelastic {
    type Constants<N: Number> = [N; 2];
    type Past<N: Number> = Past<N, D>;
    const POTENTIAL: bool = false;
    const ACROSS: bool = true;

    fn columns(&self) -> Vec<Declaration> {
        let mut all = rate::columns();
        if D == 2 {
            all.push(rate::across_column());
            all.push(Declaration::of_points(
                "stress_across",
                Shape::Scalar,
                Dimension::PRESSURE,
                "Cauchy stress across a plane.",
            ));
        }
        all
    }

    fn constants(&self, material: usize, _: f64) -> [f64; 2] {
        let m = &self.materials[material];
        [m.lame, m.shear]
    }

    fn shear(&self, material: usize) -> f64 {
        self.materials[material].shear
    }

    #[inline(always)]
    fn across<N: Number>(&self, ([stretch, _], own): &Past<N, D>) -> N {
        tensor::dilation(stretch).fma(own[2], own[2])
    }

    fn is_sheet(&self) -> bool {
        self.sheet
    }

    #[inline(always)]
    fn thickness<N: Number>(&self, (_, own): &Past<N, D>, _: N) -> N {
        own[1]
    }

    #[inline(always)]
    fn stress<N: Number>(
        &self,
        c: &[N; 2],
        past: &Past<N, D>,
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, Past<N, D>, D> {
        let ([before, s0], [work, thin, across]) = past;
        let step = Step::new(self.increment, (before, *thin), (h, unseen.across));
        let strain = &step.strain;
        let two = N::constant(2.0);
        let pressure = c[LAME] * step.spread()[0];
        let mut s = *s0;
        for r in 0..D {
            for k in 0..D {
                s[r][k] = (two * c[SHEAR]).fma(strain[r][k], s0[r][k]);
            }
            s[r][r] = s[r][r] + pressure;
        }
        let mut now = *across;
        if D == 2 {
            now = (two * c[SHEAR]).fma(step.across.grown, *across + pressure);
        }
        let work = *work + step.work((s0, *across), (&s, now));
        Stressed {
            stress: step.nominal(&s),
            across: step.nominal_across(now),
            energy: work,
            past: ([step.stretch, s], [work, unseen.across, now]),
        }
    }
}

impl Registered for Hypoelastic {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "hypoelastic",
            "Non-ordinary, in rate form: the unrotated Cauchy stress grows by λ tr(d) 1 + 2μ d (Green-Naghdi rate). Two of young, poisson, bulk, shear; in plane stress the thickness gives way.",
        )
        .source("Green & Naghdi 1965; Flanagan & Taylor 1987; Silling et al. 2007")
        .example("{ young = \"200 GPa\", poisson = 0.3 }")
        .memory(Memory::Path)
        .keys(&MODULI)
        .keys(&[INCREMENT])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let word = |m: &Given| Increment::of(m.parameters);
        let Some(increment) = materials.first().and_then(word) else {
            return Err((0, "the increment is middle or end".into()));
        };
        let of = |m: &Given| {
            if word(m) != Some(increment) {
                return Err("all materials of a body have the same kind of increment".into());
            }
            let moduli = descriptor::moduli(m.parameters)?;
            Ok(HypoelasticConstants {
                lame: moduli.lame(),
                shear: moduli.shear(),
            })
        };
        Ok(Hypoelastic {
            increment,
            sheet: d == 2 && plane == Plane::Stress,
            materials: descriptor::each(materials, of)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tried::SEEN;
    use super::*;

    const LAMBDA: f64 = 1.3;
    const MU: f64 = 0.7;

    /// P after `steps` equal steps along `path` from 0 to 1, which gives H.
    fn along<const D: usize>(
        increment: Increment,
        steps: u32,
        path: impl Fn(f64) -> Matrix<f64, D>,
    ) -> (Matrix<f64, D>, Past<f64, D>) {
        let law = Hypoelastic {
            increment,
            sheet: false,
            materials: vec![],
        };
        let mut past = ([[[0.0; D]; D]; 2], [0.0; 3]);
        let mut p = [[0.0; D]; D];
        for n in 1..=steps {
            let h = path(f64::from(n) / f64::from(steps));
            let now = law.stress(&[LAMBDA, MU], &past, &h, &SEEN);
            (p, past) = (now.stress, now.past);
        }
        (p, past)
    }

    /// Simple shear of γ: the closed form of Dienes (1979), `tan β = γ/2`, which neither rule reaches but in the limit.
    #[test]
    fn simple_shear_is_that_of_dienes() {
        let gamma = 4.0;
        let beta = f64::atan(0.5 * gamma);
        let ln = beta.cos().ln();
        let (s2, c2) = (2.0 * beta).sin_cos();
        let normal = 4.0 * MU * (c2 * ln + beta * s2 - beta.sin().powi(2));
        let shear = 2.0 * MU * c2 * (2.0 * beta - 2.0 * (2.0 * beta).tan() * ln - beta.tan());
        // J = 1: σ = P Fᵀ
        let cauchy = |increment, steps| {
            let (p, _) = along(increment, steps, |t| [[0.0, gamma * t], [0.0, 0.0]]);
            [p[0][0] + gamma * p[0][1], p[0][1], p[1][1]]
        };
        let off = |increment, steps| {
            let [xx, xy, yy] = cauchy(increment, steps);
            let apart = (xx - normal).abs().max((xy - shear).abs());
            apart.max((yy + normal).abs())
        };
        for (increment, order) in [(Increment::Middle, 4.0), (Increment::End, 2.0)] {
            let errors = [200, 400, 800].map(|n| off(increment, n));
            let falls = [errors[0] / errors[1], errors[1] / errors[2]];
            assert!(
                falls.iter().all(|f| (f / order - 1.0).abs() < 0.03),
                "{increment:?}: {errors:?}"
            );
        }
        assert!(off(Increment::Middle, 6400) < 1e-6);
    }

    /// Uniaxial strain: σ = (λ + 2μ) ln F, in space too; the work is that of the stress.
    #[test]
    fn a_line_has_logarithmic_strain() {
        let stretch: f64 = 1.6;
        let path = |t: f64| {
            [
                [(stretch - 1.0) * t, 0.0, 0.0],
                [0.0, 0.0, 0.0],
                [0.0, 0.0, 0.0],
            ]
        };
        let exact = (LAMBDA + 2.0 * MU) * stretch.ln();
        // ∫ σ dF
        let work = (LAMBDA + 2.0 * MU) * (stretch * stretch.ln() - stretch + 1.0);
        let errors = [20, 40, 80].map(|n| {
            let (p, past) = along(Increment::Middle, n, path);
            assert!((past.0[1][1][1] - LAMBDA * p[0][0] / (LAMBDA + 2.0 * MU)).abs() < 1e-14);
            [p[0][0] - exact, past.1[0] - work]
        });
        for k in 0..2 {
            let falls = [errors[0][k] / errors[1][k], errors[1][k] / errors[2][k]];
            assert!(
                falls.iter().all(|f| (f / 4.0 - 1.0).abs() < 0.01),
                "{errors:?}"
            );
        }
    }

    /// Rotations are not seen, however large a step is; and what is turned has its stress turned.
    #[test]
    fn steps_may_turn() {
        let (s, c) = 2.3f64.sin_cos();
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let h = [[0.1, -0.2, 0.05], [0.3, 0.2, 0.1], [-0.1, 0.15, -0.2]];
        let mut f = h;
        (0..3).for_each(|a| f[a][a] += 1.0);
        let mut turned = tensor::product(&turn, &f);
        (0..3).for_each(|a| turned[a][a] -= 1.0);
        let (p, past) = along(Increment::Middle, 1, |_| h);
        let (q, turned) = along(Increment::Middle, 1, |_| turned);
        let expected = tensor::product(&turn, &p);
        for r in 0..3 {
            for k in 0..3 {
                assert!(
                    (q[r][k] - expected[r][k]).abs() < 1e-14,
                    "{q:?} {expected:?}"
                );
            }
        }
        assert!((past.1[0] - turned.1[0]).abs() < 1e-15);
        let mut rigid = turn;
        (0..3).for_each(|a| rigid[a][a] -= 1.0);
        let (p, _) = along(Increment::Middle, 1, |_| rigid);
        assert!(p.iter().flatten().all(|x| x.abs() < 1e-15), "{p:?}");
    }
}
