//! Hyperelastic solids of any stored energy ψ(I₁, I₂, J) that a user writes ([`energy`](super::energy)), by [`non_ordinary`](super).
//!
//! `P = 2ψ₁ F + 2ψ₂ (I₁ F − F C) + ψ_J cof F` (Holzapfel 2000, (6.32) with J beside I₁ and I₂). With slopes g at the reference, where
//! `2g₁ + 4g₂ + g_J = 0` as it is without stress, and h beyond them,
//! `P = (2g₁ + 4g₂) (F − cof F) + 2g₂ B + 2h₁ F + 2h₂ (2F + B) + h_J cof F`, `B = tr A F − F A`, `A = C − 1`: nothing large is taken away.
//! In plane strain nothing is stretched across but by temperature or swelling; in plane stress the [thickness](super::thickness) gives way.

use super::energy::{Energy, INVARIANTS};
use super::{Classical, Stressed, Unseen};
use crate::columns::Dimension;
use crate::law::descriptor::{Descriptor, Given, Key, Need, Registered, Value};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::{Dual, Number};
use crate::spec::{LawSpec, Moduli, Parameters, Plane};

/// See the module.
#[derive(Debug, Clone)]
pub struct Hyperelastic {
    /// Per material: its energy and its shear modulus.
    materials: Vec<(Energy, f64)>,
    /// In the plane: are its faces free?
    sheet: bool,
}

/// How much of the slopes may be stress of the reference: what rounding leaves, and constants of a few digits do not.
const AT_REST: f64 = 1e-9;

impl Hyperelastic {
    /// Of one material; moduli are not known yet.
    fn of(parameters: &Parameters) -> Result<Hyperelastic, String> {
        let formula = parameters
            .formula(ENERGY.name)
            .ok_or("`energy` is an expression of I1, I2, J")?;
        let energy = Energy::new(formula)
            .map_err(|why| format!("`energy` = \"{}\": {why}", formula.source()))?;
        Ok(Hyperelastic {
            materials: vec![(energy, 0.0)],
            sheet: false,
        })
    }

    /// Those of small strains.
    fn moduli(parameters: &Parameters) -> Result<Moduli, String> {
        let law = Hyperelastic::of(parameters)?;
        let [w1, w2, wj] = law.materials[0].0.slope;
        let (rest, all) = (
            2.0 * w1 + 4.0 * w2 + wj,
            (2.0 * w1).abs() + (4.0 * w2).abs() + wj.abs(),
        );
        if rest.abs() > AT_REST * all {
            return Err(format!(
                "`energy` has a stress of {rest:e} in the reference, 2 ∂ψ/∂I1 + 4 ∂ψ/∂I2 + ∂ψ/∂J, expected 0: for example I1 − 3 comes with −2*ln(J), or as I1*J^(-2/3) − 3"
            ));
        }
        // a stretch along the first axis
        let stretched: Dual<f64> = Dual::variable(0.0);
        let zero = Dual::constant(0.0);
        let mut h = [[zero; 3]; 3];
        h[0][0] = stretched;
        let seen = Unseen {
            stiffness: zero,
            square: zero,
            across: zero,
            reach: Dual::constant(1.0),
        };
        let (p, _, _) = law.at(0, &h, &seen);
        let (along, across) = (p[0][0].slope, p[1][1].slope);
        let shear = 0.5 * (along - across);
        let bulk = across + 2.0 / 3.0 * shear;
        if !(shear > 0.0 && bulk > 0.0 && shear.is_finite() && bulk.is_finite()) {
            return Err(format!(
                "`energy` has a shear modulus of {shear:e} and a bulk modulus of {bulk:e} at small strains, expected both positive: without a term that grows with (J − 1)^2 or ln(J)^2 nothing resists a change of volume"
            ));
        }
        let moduli = Moduli::from_bulk_shear(bulk, shear);
        // of what can hardly change its volume Poisson's ratio is ½ to the last digits
        match moduli.poisson < 0.5 {
            true => Ok(moduli),
            false => Err(format!(
                "`energy` has a bulk modulus {:e} times its shear modulus",
                bulk / shear
            )),
        }
    }

    /// P, what it is across a plane, and ψ of a material.
    #[inline(always)]
    fn at<N: Number, const D: usize>(
        &self,
        material: usize,
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> (Matrix<N, D>, N, N) {
        let (half, two) = (N::constant(0.5), N::constant(2.0));
        let energy = &self.materials[material].0;
        let mut f = *h;
        for a in 0..D {
            f[a][a] = f[a][a] + N::constant(1.0);
        }
        // A = H + Hᵀ + HᵀH
        let square = tensor::transposed_product(h, h);
        let mut a = square;
        for r in 0..D {
            for c in 0..D {
                a[r][c] = square[r][c] + h[r][c] + h[c][r];
            }
        }
        let (mut trace, mut double) = (tensor::trace(&a), tensor::contraction(&a, &a));
        // of H
        let (mut inner, mut volume) = (tensor::contraction(h, h), tensor::dilation_beyond(h));
        if D == 2 {
            let across = unseen.across * (two + unseen.across);
            trace = trace + across;
            double = across.fma(across, double);
            inner = unseen.across.fma(unseen.across, inner);
            volume = unseen.across.fma(tensor::dilation(h), volume);
        }
        let second = half * (trace * trace - double);
        let (cofactors, dilation) = unseen.space(h);
        let change = [trace, two.fma(trace, second), dilation];
        let beyond = energy.beyond(&change);
        let [w1, w2, _] = energy.slope;
        // F − cof F, B, cof F
        let product = tensor::product(&f, &a);
        let [h1, h2, hj] = beyond.slope;
        let (h1, h2) = (two * h1, two * h2);
        let (even, odd) = (N::constant(2.0 * w1 + 4.0 * w2), h2.plus(2.0 * w2));
        let along = two.fma(h2, h1);
        let mut p = f;
        for r in 0..D {
            for c in 0..D {
                let b = trace.fma(f[r][c], N::constant(0.0) - product[r][c]);
                let mut cofactor = cofactors[r][c];
                if r == c {
                    cofactor = cofactor + N::constant(1.0);
                }
                let rest = odd.fma(b, along.fma(f[r][c], hj * cofactor));
                p[r][c] = even.fma(h[r][c] - cofactors[r][c], rest);
            }
        }
        // the same of the stretch across, whose cofactor is J of the plane
        let (z, plane) = (unseen.across, tensor::dilation(h));
        let wide = z + N::constant(1.0);
        let b = wide * (trace - z * (two + z));
        let rest = odd.fma(b, along.fma(wide, hj * (plane + N::constant(1.0))));
        let across = even.fma(z - plane, rest);
        // ΔI₁ − 2ΔJ and ΔI₂ − 4ΔJ, in which all that is linear in H is gone
        let first = inner - two * volume;
        let other = two * first + second;
        let psi = first.times(w1) + other.times(w2) + beyond.rest;
        (p, across, psi)
    }
}

impl<const D: usize> Classical<D> for Hyperelastic {
    /// Which material it is.
    type Constants<N: Number> = [N; 1];
    type Past<N: Number> = [N; 0];

    fn constants(&self, material: usize, _: f64) -> [f64; 1] {
        [material as f64]
    }

    fn shear(&self, material: usize) -> f64 {
        self.materials[material].1
    }

    fn is_sheet(&self) -> bool {
        self.sheet
    }

    /// Lanes of several materials are asked one material after the other.
    #[inline(always)]
    fn stress<N: Number>(
        &self,
        c: &[N; 1],
        past: &[N; 0],
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, [N; 0], D> {
        let mut stress = *h;
        let (mut across, mut energy) = (N::constant(0.0), N::constant(0.0));
        for n in 0..self.materials.len() {
            let away = c[0] - N::constant(n as f64);
            let far = away * away;
            if !far.any_below(0.25) {
                continue;
            }
            let (p, own, psi) = self.at(n, h, unseen);
            energy = far.below(0.25, psi, energy);
            across = far.below(0.25, own, across);
            for r in 0..D {
                for k in 0..D {
                    stress[r][k] = far.below(0.25, p[r][k], stress[r][k]);
                }
            }
        }
        Stressed {
            stress,
            across,
            energy,
            past: *past,
        }
    }
}

const ENERGY: Key = Key {
    name: "energy",
    value: Value::Formula(INVARIANTS, Some(Dimension::PRESSURE)),
    need: Need::Given,
    doc: "Stored energy ψ per reference volume, an expression of I1 = tr C, I2 = ½ (tr²C − tr C²) and J = det F with + − * / ^ exp ln sqrt, numbers and [constants]: without stress in the reference, with positive moduli there.",
};

impl Registered for Hyperelastic {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "hyperelastic",
            "Non-ordinary, of any stored energy ψ(I1, I2, J): P = 2ψ₁ F + 2ψ₂ (I₁F − FC) + ψ_J cof F. Moduli of small strains are those of the energy; in plane stress the thickness gives way.",
        )
        .source("Holzapfel 2000; Silling, Epton, Weckner, Xu & Askari 2007; Silling 2017")
        .example("{ energy = \"0.5 MPa*(I1 - 3 - 2*ln(J)) + 5 MPa*(J - 1)^2\" }")
        .keys(&[ENERGY])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        Hyperelastic::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let mut all = vec![];
        for (n, m) in materials.iter().enumerate() {
            let shear = Hyperelastic::moduli(m.parameters)
                .map_err(|why| (n, why))?
                .shear();
            let law = Hyperelastic::of(m.parameters).map_err(|why| (n, why))?;
            all.extend(law.materials.into_iter().map(|(energy, _)| (energy, shear)));
        }
        Ok(Hyperelastic {
            materials: all,
            sheet: d == 2 && plane == Plane::Stress,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::correspondence::{Correspondence, CorrespondenceConstants, Stress};
    use super::super::tried::SEEN;
    use super::*;
    use crate::expression::Expression;
    use crate::spec::Parameter;

    const LAMBDA: f64 = 1.3;
    const MU: f64 = 0.7;
    const SECOND: f64 = 0.2;
    const NEO_HOOKEAN: &str = "mu/2*(I1 - 3) - mu*ln(J) + l/2*ln(J)^2";
    const MOONEY_RIVLIN: &str =
        "(mu/2 - c)*(J^(-2/3)*I1 - 3) + c*(J^(-4/3)*I2 - 3) + (l/2 + mu/3)*(J - 1)^2";

    fn written(text: &str) -> Parameters {
        let constants = [("mu", MU), ("l", LAMBDA), ("c", SECOND)];
        let formula = Expression::of(INVARIANTS, text, &constants).unwrap();
        Parameters::default().with("energy", Parameter::Formula(formula))
    }

    fn both(text: &str, stress: Stress) -> (Hyperelastic, Correspondence) {
        let second = if stress == Stress::MooneyRivlin {
            SECOND
        } else {
            0.0
        };
        let known = Correspondence {
            stress,
            plane_stress: false,
            materials: vec![CorrespondenceConstants {
                lame: LAMBDA,
                shear: MU,
                second,
            }],
        };
        (Hyperelastic::of(&written(text)).unwrap(), known)
    }

    fn compared<const D: usize>(h: Matrix<f64, D>) {
        for (text, stress) in [
            (NEO_HOOKEAN, Stress::NeoHookean),
            (MOONEY_RIVLIN, Stress::MooneyRivlin),
        ] {
            let (law, known) = both(text, stress);
            let c = Classical::<D>::constants(&known, 0, 0.0);
            let scale = h.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
            let (a, b) = (
                law.stress(&[0.0], &[], &h, &SEEN),
                known.stress(&c, &[], &h, &SEEN),
            );
            let most = b
                .stress
                .iter()
                .flatten()
                .fold(0.0f64, |m, x| m.max(x.abs()));
            assert!(
                (a.energy / b.energy - 1.0).abs() < 1e-13,
                "{text} {scale:e}: {} {}",
                a.energy,
                b.energy
            );
            for r in 0..D {
                for s in 0..D {
                    let off = (a.stress[r][s] - b.stress[r][s]).abs();
                    assert!(
                        off < 3e-15 * most,
                        "{text} {scale:e} {r}{s}: {off:e} of {most:e}"
                    );
                    // tangents: the slope of P along every direction
                    let dual = |n: usize, k: usize| Dual {
                        value: h[n][k],
                        slope: f64::from(u8::from(n == r && k == s)),
                    };
                    let h: Matrix<Dual<f64>, D> =
                        crate::array::from_fn(|n| crate::array::from_fn(|k| dual(n, k)));
                    let zero = Dual::constant(0.0);
                    let seen = Unseen {
                        stiffness: zero,
                        square: zero,
                        across: zero,
                        reach: Dual::constant(1.0),
                    };
                    let constant = c.map(Dual::constant);
                    let a = law.stress(&[zero], &[], &h, &seen).stress;
                    let b = known.stress(&constant, &[], &h, &seen).stress;
                    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
                        assert!(
                            (a.slope - b.slope).abs() < 4e-14,
                            "{text} {scale:e} {r}{s}: {} {}",
                            a.slope,
                            b.slope
                        );
                    }
                }
            }
        }
    }

    /// Stress, energy and tangents, at large strains and at those of the operator about the reference.
    #[test]
    fn known_energies_are_known_solids() {
        let h = [[0.11, -0.07, 0.3], [0.2, -0.05, 0.1], [-0.15, 0.02, 0.08]];
        for size in [1.0, 1e-3, 1e-9, 1e-60] {
            compared(h.map(|r| r.map(|x| size * x)));
            compared([[0.11, -0.07], [0.2, -0.05]].map(|r| r.map(|x| size * x)));
        }
    }

    #[test]
    fn moduli_are_those_of_small_strains() {
        for text in [NEO_HOOKEAN, MOONEY_RIVLIN] {
            let moduli = Hyperelastic::moduli(&written(text)).unwrap();
            assert!((moduli.shear() / MU - 1.0).abs() < 1e-14);
            assert!((moduli.lame() / LAMBDA - 1.0).abs() < 1e-13);
        }
        // Yeoh (1993) and Gent (1996): μ = 2 C₁₀, and μ
        for (text, shear) in [
            (
                "0.3*(I1*J^(-2/3) - 3) + 0.1*(I1*J^(-2/3) - 3)^2 + 0.02*(I1*J^(-2/3) - 3)^3 + (J - 1)^2",
                0.6,
            ),
            (
                "-0.35*30*ln(1 - (I1*J^(-2/3) - 3)/30) + 2*(J^2/2 - 1/2 - ln(J))",
                0.7,
            ),
        ] {
            let moduli = Hyperelastic::moduli(&written(text)).unwrap();
            assert!(
                (moduli.shear() / shear - 1.0).abs() < 1e-13,
                "{text}: {}",
                moduli.shear()
            );
        }
    }

    /// Treloar's test of Gent's and Yeoh's solids, by their closed forms: an isochoric stretch λ, λ^(−½), λ^(−½) with the pressure taken away,
    /// `P₁₁ − P₂₂ λ^(−3/2) = 2 ψ′ (λ − λ⁻²)`.
    #[test]
    fn a_stretched_band_has_its_closed_form() {
        let gent = |i1: f64| 0.5 * 0.7 * 30.0 / (30.0 - (i1 - 3.0));
        let yeoh = |i1: f64| 0.3 + 0.2 * (i1 - 3.0) + 0.06 * (i1 - 3.0) * (i1 - 3.0);
        type Slope<'a> = &'a dyn Fn(f64) -> f64;
        let cases: [(&str, Slope); 2] = [
            (
                "-0.35*30*ln(1 - (I1*J^(-2/3) - 3)/30) + 2*(J^2/2 - 1/2 - ln(J))",
                &gent,
            ),
            (
                "0.3*(I1*J^(-2/3) - 3) + 0.1*(I1*J^(-2/3) - 3)^2 + 0.02*(I1*J^(-2/3) - 3)^3 + (J - 1)^2",
                &yeoh,
            ),
        ];
        for (text, slope) in cases {
            let law = Hyperelastic::of(&written(text)).unwrap();
            for stretch in [0.6f64, 1.5, 3.0, 5.0] {
                let across = stretch.powf(-0.5);
                let h = [
                    [stretch - 1.0, 0.0, 0.0],
                    [0.0, across - 1.0, 0.0],
                    [0.0, 0.0, across - 1.0],
                ];
                let p = law.at(0, &h, &SEEN).0;
                let i1 = stretch * stretch + 2.0 / stretch;
                let pull = p[0][0] - p[1][1] * across / stretch;
                let exact = 2.0 * slope(i1) * (stretch - stretch.powi(-2));
                assert!(
                    (pull - exact).abs() < 1e-12 * (1.0 + exact.abs()),
                    "{text} {stretch}: {pull} {exact}"
                );
            }
        }
    }

    #[test]
    fn what_is_no_solid_is_refused() {
        let refused = |text: &str, part: &str| {
            let message = Hyperelastic::moduli(&written(text)).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        };
        refused(
            "mu/2*(I1 - 3) + l/2*ln(J)^2",
            "a stress of 7e-1 in the reference",
        );
        refused("mu/2*(I1 - 3) - mu*ln(J) - 5*ln(J)^2", "bulk modulus of");
        refused(
            "-mu/2*(I1 - 3) + mu*ln(J) + 5*ln(J)^2",
            "shear modulus of -",
        );
        refused("sin(J)", "smooth");
    }
}
