//! Correspondence (Silling et al. 2007): any classical stress P(F) that is the slope of a stored energy ψ(F), by
//! [`non_ordinary`](super).

use super::rest::{exp_rest, ln_rest};
use super::{Classical, Stressed, Unseen};
use crate::columns::Dimension;
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, MODULI, Registered, number, word,
};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::Number;
use crate::spec::{LawSpec, Parameters, Plane};

/// Classical stored energy of one material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stress {
    /// Linear in Green's strain: `S = λ tr(E) 1 + 2μE`, `P = F S` (Saint Venant–Kirchhoff).
    Linear,
    /// `ψ = μ/2 (I₁ − 3) − μ ln J + λ/2 ln²J` (Bonet & Wood 1997, (5.28)).
    NeoHookean,
    /// `ψ = C₁₀ (J^(−2/3) I₁ − 3) + C₀₁ (J^(−4/3) I₂ − 3) + κ/2 (J − 1)²`, `C₁₀ = μ/2 − C₀₁` (Mooney 1940; Rivlin 1948; the volume
    /// apart as by Simo & Taylor 1982).
    MooneyRivlin,
}

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorrespondenceConstants {
    /// Lamé's λ of the solid and shear modulus μ.
    pub lame: f64,
    pub shear: f64,
    /// C₀₁ of Mooney and Rivlin.
    pub second: f64,
}

/// See the module. All materials have the same kind of stress.
#[derive(Debug, Clone)]
pub struct Correspondence {
    pub stress: Stress,
    /// In the plane: does the thickness give way until the stress across is 0?
    pub plane_stress: bool,
    /// Per material.
    pub materials: Vec<CorrespondenceConstants>,
}

const LAME: usize = 0;
const SHEAR: usize = 1;
const SECOND: usize = 2;

/// Steps of Newton's method for the thickness: from the linear estimate six reach round-off for stretches of 0.3 to 3.
const THICKNESS_STEPS: usize = 6;

impl<const D: usize> Classical<D> for Correspondence {
    type Constants<N: Number> = [N; 3];
    type Past<N: Number> = [N; 0];

    fn constants(&self, material: usize, _: f64) -> [f64; 3] {
        let m = &self.materials[material];
        [m.lame, m.shear, m.second]
    }

    fn shear(&self, material: usize) -> f64 {
        self.materials[material].shear
    }

    /// Where the thickness has no closed form or search of its own.
    fn is_sheet(&self) -> bool {
        self.plane_stress && self.stress == Stress::MooneyRivlin
    }

    #[inline(always)]
    fn stress<N: Number>(
        &self,
        c: &[N; 3],
        past: &[N; 0],
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, [N; 0], D> {
        let held = D == 2 && !self.plane_stress;
        let (half, two) = (N::constant(0.5), N::constant(2.0));
        let mut f = *h;
        for a in 0..D {
            f[a][a] = f[a][a] + N::constant(1.0);
        }
        // 2E = H + Hᵀ + HᵀH
        let square = tensor::transposed_product(h, h);
        let mut twice = square;
        for r in 0..D {
            for s in 0..D {
                twice[r][s] = square[r][s] + h[r][s] + h[s][r];
            }
        }
        let mut strain = tensor::trace(&twice);
        let across = unseen.across * (two + unseen.across);
        if held {
            strain = strain + across;
        }
        let mut wide = N::constant(0.0);
        let (stress, energy) = match self.stress {
            Stress::Linear => {
                let lame = if self.plane_stress {
                    (two * c[LAME] * c[SHEAR]).div(two.fma(c[SHEAR], c[LAME]))
                } else {
                    c[LAME]
                };
                let mut s = twice;
                let pressure = half * lame * strain;
                for r in 0..D {
                    for k in 0..D {
                        s[r][k] = c[SHEAR] * twice[r][k];
                    }
                    s[r][r] = s[r][r] + pressure;
                }
                let mut double = tensor::contraction(&twice, &twice);
                if held {
                    double = across.fma(across, double);
                }
                let energy =
                    half * half * (half * lame * strain * strain) + half * half * c[SHEAR] * double;
                (tensor::product(&f, &s), energy)
            }
            Stress::NeoHookean => {
                let beyond = tensor::dilation(h);
                let plane = beyond.ln_1p();
                // ln of the square of the stretch across
                let across = if self.plane_stress && D == 2 {
                    thickness(c, plane)
                } else if held && (N::constant(0.0) - across * across).any_below(0.0) {
                    two * unseen.across.ln_1p()
                } else {
                    N::constant(0.0)
                };
                let volume = half.fma(across, plane);
                let cofactors = tensor::cofactor_beyond(h);
                let inverse = (N::constant(1.0) + beyond).recip();
                let pull = c[LAME] * volume;
                let mut p = *h;
                for r in 0..D {
                    for k in 0..D {
                        // F − F⁻ᵀ = ((J − 1) F + H − (cof F − 1))/J
                        let shear = beyond.fma(f[r][k], h[r][k] - cofactors[r][k]);
                        let mut cofactor = cofactors[r][k];
                        if r == k {
                            cofactor = cofactor + N::constant(1.0);
                        }
                        p[r][k] = c[SHEAR].fma(shear, pull * cofactor) * inverse;
                    }
                }
                // I₁ − 3 − 2 ln J, in which all that is linear in H is gone
                let second = tensor::dilation_beyond(h);
                let shear =
                    tensor::contraction(h, h) - two * (second + ln_rest(beyond)) + exp_rest(across);
                let energy = half * c[SHEAR] * shear + half * pull * volume;
                (p, energy)
            }
            Stress::MooneyRivlin => {
                let (p, own, energy) = mooney_rivlin(c, h, &twice, unseen);
                wide = own;
                (p, energy)
            }
        };
        Stressed {
            stress,
            across: wide,
            energy,
            past: *past,
        }
    }
}

/// P, what it is across a plane, and ψ of Mooney and Rivlin, from H and A = C − 1: `F − ⅓ I₁ F⁻ᵀ = F⁻ᵀ dev A`, and so on, so that nothing large is taken away.
#[inline(always)]
fn mooney_rivlin<N: Number, const D: usize>(
    c: &[N; 3],
    h: &Matrix<N, D>,
    a: &Matrix<N, D>,
    unseen: &Unseen<N>,
) -> (Matrix<N, D>, N, N) {
    let (half, third, two) = (N::constant(0.5), N::constant(1.0 / 3.0), N::constant(2.0));
    let (one, three) = (N::constant(1.0), N::constant(3.0));
    let (mut trace, mut double) = (tensor::trace(a), tensor::contraction(a, a));
    let (cofactors, beyond) = unseen.space(h);
    // J² − 1 = tr A + rest, and t = ⅓ ln J²
    let mut rest = tensor::dilation_beyond(a);
    if D == 2 {
        let across = unseen.across * (two + unseen.across);
        rest = across.fma(trace + rest, rest);
        trace = trace + across;
        double = across.fma(across, double);
    }
    let second = half * (trace * trace - double);
    let square = trace + rest;
    let t = third * square.ln_1p();
    let log = ln_rest(square);
    let (first, other) = (half * c[SHEAR] - c[SECOND], c[SECOND]);
    // J^(−2/3) and J^(−4/3)
    let shrink = (N::constant(0.0) - t).exp();
    let both = shrink * shrink;
    let of_first = N::constant(0.0) - rest - log - three * exp_rest(t);
    let of_second = second - two * (rest + log) - three * exp_rest(two * t);
    let bulk = N::constant(2.0 / 3.0).fma(c[SHEAR], c[LAME]);
    let energy =
        first * shrink * of_first + other * both * of_second + half * bulk * beyond * beyond;
    // F⁻ᵀ times this, beside the volume
    let product = tensor::product(a, a);
    let (first, other) = (two * first * shrink, two * other * both);
    let level = third * (first * trace + other * (trace + two * second));
    let mut state = *a;
    for r in 0..D {
        for k in 0..D {
            let more = trace.fma(a[r][k], a[r][k] - product[r][k]);
            state[r][k] = first.fma(a[r][k], other * more);
        }
        state[r][r] = state[r][r] - level;
    }
    // A of the stretch 1 + z across, F⁻ᵀ = 1/(1 + z)
    let z = unseen.across;
    let wide = z * (two + z);
    let of_wide = first.fma(wide, other * trace.fma(wide, wide - wide * wide)) - level;
    let own = bulk * beyond * (tensor::dilation(h) + one) + of_wide.div(z + one);
    let mut cofactor = cofactors;
    for r in 0..D {
        cofactor[r][r] = cofactors[r][r] + one;
    }
    let inverse = (one + beyond).recip();
    let shear = tensor::product(&cofactor, &state);
    let mut p = shear;
    for r in 0..D {
        for k in 0..D {
            p[r][k] = inverse.fma(shear[r][k], bulk * beyond * cofactor[r][k]);
        }
    }
    (p, own, energy)
}

/// x = ln λ₃² with no stress across: `μ (e^x − 1) + λ (ln J₂ + x/2) = 0`.
#[inline(always)]
fn thickness<N: Number>(c: &[N; 3], plane: N) -> N {
    let (half, two) = (N::constant(0.5), N::constant(2.0));
    let mut x = (N::constant(0.0) - two * c[LAME] * plane).div(two.fma(c[SHEAR], c[LAME]));
    for _ in 0..THICKNESS_STEPS {
        let wide = x.exp_m1();
        let rest = c[SHEAR].fma(wide, c[LAME] * half.fma(x, plane));
        let slope = c[SHEAR].fma(wide, c[SHEAR]) + half * c[LAME];
        x = x - rest.div(slope);
    }
    x
}

const KEYS: [Key; 2] = [
    word(
        "stress",
        &[
            (
                "linear",
                "S = λ tr(E) 1 + 2μE of Green's strain E (Saint Venant-Kirchhoff)",
            ),
            (
                "neo_hookean",
                "ψ = μ/2 (I₁ − 3) − μ ln J + λ/2 ln²J (Bonet & Wood 1997)",
            ),
            (
                "mooney_rivlin",
                "ψ = C₁₀ (J^(−2/3) I₁ − 3) + C₀₁ (J^(−4/3) I₂ − 3) + κ/2 (J − 1)², C₁₀ = μ/2 − C₀₁ (Mooney 1940; Rivlin 1948)",
            ),
        ],
        "Classical law P(F).",
    ),
    number(
        "second_invariant",
        Dimension::PRESSURE,
        Bounds::NOT_NEGATIVE,
        "C₀₁ of mooney_rivlin, at most half the shear modulus.",
    )
    .or(0.0),
];

impl Registered for Correspondence {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "correspondence",
            "Non-ordinary: T = ω (P(F) K⁻¹ ξ + g z), F from the family, z the zero-energy modes. Two of young, poisson, bulk, shear.",
        )
        .source("Silling, Epton, Weckner, Xu & Askari 2007; Silling 2017")
        .example("{ young = \"1 GPa\", poisson = 0.45, stress = \"neo_hookean\" }")
        .keys(&MODULI)
        .keys(&KEYS)
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let word = |m: &Given| match m.parameters.word("stress") {
            Some("linear") => Some(Stress::Linear),
            Some("neo_hookean") => Some(Stress::NeoHookean),
            Some("mooney_rivlin") => Some(Stress::MooneyRivlin),
            Some(_) | None => None,
        };
        let plane_stress = d == 2 && plane == Plane::Stress;
        let Some(stress) = materials.first().and_then(word) else {
            return Err((
                0,
                "the stress is linear, neo_hookean or mooney_rivlin".into(),
            ));
        };
        let of = |m: &Given| {
            if word(m) != Some(stress) {
                return Err("all materials of a body have the same kind of stress".into());
            }
            let moduli = descriptor::moduli(m.parameters)?;
            let second = m.parameters.number("second_invariant").unwrap_or(0.0);
            if second > 0.0 && stress != Stress::MooneyRivlin {
                return Err("`second_invariant` is of mooney_rivlin alone".into());
            }
            if second > 0.5 * moduli.shear() {
                return Err(format!(
                    "`second_invariant` is {:.3} of the shear modulus, expected at most half of it: C₁₀ would be negative",
                    second / moduli.shear()
                ));
            }
            Ok(CorrespondenceConstants {
                lame: moduli.lame(),
                shear: moduli.shear(),
                second,
            })
        };
        Ok(Correspondence {
            stress,
            plane_stress,
            materials: descriptor::each(materials, of)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tried::{SEEN, is_slope};
    use super::*;

    /// P is the slope of ψ, in plane stress too, and small strains are Hooke's.
    #[test]
    fn stress_is_the_slope_of_energy() {
        let h = [[0.11, -0.07], [0.2, -0.05]];
        for stress in [Stress::Linear, Stress::NeoHookean, Stress::MooneyRivlin] {
            for plane_stress in [false, true] {
                if plane_stress && stress == Stress::MooneyRivlin {
                    continue;
                }
                let law = Correspondence {
                    stress,
                    plane_stress,
                    materials: vec![],
                };
                let c = [1.3, 0.7, 0.2];
                let p = law.stress(&c, &[], &h, &SEEN).stress;
                is_slope(&h, (&p, 1e-9), |h| law.stress(&c, &[], h, &SEEN).energy);
                let small = 1e-9;
                let strained = law.stress(&c, &[], &[[small, 0.0], [0.0, 0.0]], &SEEN);
                let (p, energy) = (strained.stress, strained.energy);
                let lame = if plane_stress {
                    2.0 * 1.3 * 0.7 / (1.3 + 1.4)
                } else {
                    1.3
                };
                assert!((p[0][0] / small - (lame + 1.4)).abs() < 1e-7);
                assert!((energy / (small * small) - 0.5 * (lame + 1.4)).abs() < 1e-7);
            }
        }
    }

    /// Mooney and Rivlin in space: P is the slope of ψ, and ψ that of the plain formula.
    #[test]
    fn mooney_and_rivlin_in_space() {
        let law = Correspondence {
            stress: Stress::MooneyRivlin,
            plane_stress: false,
            materials: vec![],
        };
        let c = [1.3, 0.7, 0.2];
        let h = [[0.11, -0.07, 0.3], [0.2, -0.05, 0.1], [-0.15, 0.02, 0.08]];
        let (p, energy) = {
            let made = law.stress(&c, &[], &h, &SEEN);
            (made.stress, made.energy)
        };
        let mut f = h;
        (0..3).for_each(|a| f[a][a] += 1.0);
        let right = tensor::transposed_product(&f, &f);
        let j = tensor::determinant(&f);
        let first = tensor::trace(&right);
        let second = 0.5 * (first * first - tensor::contraction(&right, &right));
        let bulk = 1.3 + 2.0 / 3.0 * 0.7;
        let plain = 0.15 * (j.powf(-2.0 / 3.0) * first - 3.0)
            + 0.2 * (j.powf(-4.0 / 3.0) * second - 3.0)
            + 0.5 * bulk * (j - 1.0) * (j - 1.0);
        assert!((energy - plain).abs() < 1e-14, "{energy} {plain}");
        is_slope(&h, (&p, 1e-9), |h| law.stress(&c, &[], h, &SEEN).energy);
        // Hooke's, to the last digits
        let small = 1e-9;
        let made = law.stress(&c, &[], &[[small, 0.0, 0.0], [0.0; 3], [0.0; 3]], &SEEN);
        assert!((made.stress[0][0] / small / (1.3 + 1.4) - 1.0).abs() < 1e-8);
        assert!((made.energy / (small * small) / (0.5 * (1.3 + 1.4)) - 1.0).abs() < 1e-8);
    }
}
