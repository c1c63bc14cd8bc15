//! Laws that take a deformation gradient for each bond (Breitzman & Dayal 2018): the family's, changed so that it maps its bond exactly,
//! `F_b = F + z⊗ξ/|ξ|²`, `z = η − Hξ`, with the volume of the family (F̄, de Souza Neto et al. 1996), so that what cannot change its
//! volume does not lock: `F̄_b = (J/J_b)^(1/D) F_b`. The energy is their mean, `W = Σ ω ν V ψ(F̄_b) / Σ ω ν V`.
//!
//! With `τ_b = P̄_b F̄_bᵀ` and `A_b = (J/J_b)^(1/D) P̄_b − ⅟D tr τ_b F_b⁻ᵀ`, means ⟨·⟩ over ω ν V, and n = ξ/|ξ|,
//! `T⟨ξ⟩ = ω/Σων V A_b n/|ξ| + ω (⟨A_b (1 − n⊗n)⟩ + ⅟D ⟨tr τ_b⟩ F⁻ᵀ) K⁻¹ ξ`.
//!
//! No deformation of a family but a rigid one is without energy: with tr H = 0 and all deviators of `sym(H + z⊗n/|ξ|)` zero, their sum over
//! `ω|ξ|²`, in which z vanishes, leaves sym H = 0, and then z = 0. So nothing needs a control. `Σ ν V T⊗y = ⟨τ_b⟩` is symmetric:
//! any classical law keeps angular momentum, and an affine deformation has the classical stress exactly, at surfaces too.
//! Breitzman and Dayal take the mean of the F of both ends; here each end has its own, so that its energy is of its own family.
//!
//! Every directed bond remembers what the law remembers; the point has the mean over its bonds to show. Points whose bonds span no space
//! have no force state.

use super::equation_of_state::is_pressed;
use super::family::CONTROL;
use super::{Asked, Classical, GRADIENT, Stressed, Unseen, answered, on_a_family, takes_bonds};
use crate::columns::{Declaration, On};
use crate::law::descriptor::{Descriptor, Given, Registered};
use crate::law::material::tensor::{self, Matrix};
use crate::law::material::{Bond, Columns, End, Free, Material, Numbers, ReferenceFamily, Site};
use crate::law::number::Number;
use crate::space::Point as Place;
use crate::spec::{LawSpec, Parameters, Plane};

/// A classical law on the bonds of a family.
#[derive(Debug, Clone)]
pub struct BondAssociated<L> {
    pub law: L,
}

/// `K⁻¹`, and 1 where K can be inverted.
type Form<N, const D: usize> = (Matrix<N, D>, N);
/// H and what T is linear in ωξ with, and `1/Σ ω ν V`, 0 where bonds span no space, and the strain of the section.
type Point<N, const D: usize> = ([Matrix<N, D>; 2], [N; 2]);
type EndOf<'a, N, L, const D: usize> =
    End<'a, <L as Classical<D>>::Constants<N>, Point<N, D>, <L as Classical<D>>::Past<N>>;
type SiteOf<'a, N, L, const D: usize> =
    Site<'a, N, <L as Classical<D>>::Constants<N>, Form<N, D>, <L as Classical<D>>::Past<N>>;

/// What a bond's gradient gives.
struct Answered<N, P, const D: usize> {
    /// A_b, and tr τ_b.
    across: Matrix<N, D>,
    trace: N,
    energy: N,
    past: P,
}

impl<L> BondAssociated<L> {
    /// The stress of the law at F̄_b.
    #[inline(always)]
    fn stressed<N: Number, const D: usize>(
        &self,
        bond: &Bond<N, D>,
        end: &EndOf<N, L, D>,
    ) -> Answered<N, L::Past<N>, D>
    where
        L: Classical<D>,
    {
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        let [family, _] = &end.point.0;
        let seen = tensor::times(family, &bond.xi);
        // where a bond is not whole F_b is F: what is at rest beside a family that turns may be far from it
        let inverse = zero.choose(bond.omega, bond.inv_length * bond.inv_length, zero);
        let mut own = *family;
        for r in 0..D {
            let z = inverse * (bond.eta[r] - seen[r]);
            for c in 0..D {
                own[r][c] = z.fma(bond.xi[c], family[r][c]);
            }
        }
        let (dilation, whole) = (tensor::dilation(&own), tensor::dilation(family));
        let scale = inverse_root::<N, D>((dilation - whole).div(one + whole));
        let mut h = own;
        for r in 0..D {
            for c in 0..D {
                h[r][c] = scale.fma(own[r][c], own[r][c]);
            }
            h[r][r] = h[r][r] + scale;
        }
        let Stressed {
            stress,
            energy,
            past,
            ..
        } = answered(Asked {
            law: &self.law,
            constants: end.constants,
            past: end.memory,
            h: &h,
            unseen: Unseen {
                stiffness: zero,
                square: zero,
                across: end.point.1[1],
                reach: one,
            },
        });
        let trace = tensor::contraction(&stress, &h) + tensor::trace(&stress);
        let mean = (N::constant(1.0 / D as f64) * trace).div(one + dilation);
        let cofactors = tensor::cofactor_beyond(&own);
        let mut across = stress;
        for r in 0..D {
            for c in 0..D {
                let all = scale.fma(stress[r][c], stress[r][c]);
                across[r][c] = all - mean * cofactors[r][c];
            }
            across[r][r] = across[r][r] - mean;
        }
        Answered {
            across,
            trace,
            energy,
            past,
        }
    }
}

/// `(1 + x)^(−1/D) − 1`, without cancellation.
#[inline(always)]
fn inverse_root<N: Number, const D: usize>(x: N) -> N {
    let (zero, one, two) = (N::constant(0.0), N::constant(1.0), N::constant(2.0));
    let whole = one + x;
    if D == 2 {
        let root = whole.sqrt();
        return (zero - x).div(root * (one + root));
    }
    // Halley's steps on x + (1 + x)(3t + 3t² + t³) = 0, of third order
    let mut t = (zero - x).div(two.fma(x, N::constant(3.0)));
    for _ in 0..STEPS {
        let scaled = one + t;
        let square = scaled * scaled;
        let cube = t * (N::constant(3.0).fma(scaled, t * t));
        let rest = whole.fma(cube, x);
        // 2 f f′/(2 f′² − f f″) with f′ = 3(1 + x)(1 + t)², f″ = 6(1 + x)(1 + t)
        let below = N::constant(3.0) * whole * square * scaled - rest;
        t = t - (rest * scaled).div(below);
    }
    t
}

/// From a thousandth to a thousand times the volume to the last digits.
const STEPS: usize = 5;

/// `x` where the family's F is known, else 0.
#[inline(always)]
fn known<N: Number, const D: usize>(point: &Point<N, D>, x: N) -> N {
    let zero = N::constant(0.0);
    zero.choose(point.1[0], x, zero)
}

impl<const D: usize, L: Classical<D>> Material<D> for BondAssociated<L> {
    type Constants<N: Number> = L::Constants<N>;
    type Form<N: Number> = Form<N, D>;
    type Sum<N: Number> = (Matrix<N, D>, N);
    type Point<N: Number> = Point<N, D>;
    type Past<N: Number> = L::Past<N>;
    type Memory<N: Number> = L::Past<N>;
    type State<N: Number> = Free<N, D>;
    const PASSES: usize = 2;
    const OF_FAMILY: bool = true;
    const SECTION: bool = true;
    const ACROSS: bool = L::ACROSS;
    const STRETCHES: bool = false;
    const POTENTIAL: bool = L::POTENTIAL;
    const STIFFENS: bool = true;
    const STIFFENS_DAMAGED: bool = true;
    const FORM_OF_WHOLE: bool = true;
    const GATHERS: bool = true;
    const PLACED: bool = L::PLACED;

    fn columns(&self) -> Columns {
        let of_bond = |column: Declaration| Declaration {
            name: format!("bond_{}", column.name).into(),
            on: On::Bonds,
            ..column
        };
        Columns {
            memory: self.law.columns().into_iter().map(of_bond).collect(),
            past: self.law.columns(),
            places: self.law.places(),
            ..Columns::default()
        }
    }

    fn failure(&self) -> Option<usize> {
        self.law.failure()
    }

    fn temperature(&self) -> Option<usize> {
        self.law.temperature()
    }

    fn constants(&self, material: usize, dt: f64) -> L::Constants<f64> {
        self.law.constants(material, dt)
    }

    fn varies(&self) -> bool {
        self.law.varies()
    }

    fn constants_at(&self, material: usize, place: &Place) -> Result<L::Constants<f64>, String> {
        self.law.constants_at(material, place)
    }

    fn at_place(&self, material: usize, place: &Place) -> Vec<f64> {
        self.law.at_place(material, place)
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> Form<f64, D> {
        let (inverse, whole) = tensor::inverse(reference.shape());
        (inverse, if whole { 1.0 } else { 0.0 })
    }

    /// `|δF_b|² ≤ 4 |δF|² + 2 |η|²/|ξ|²`, whose mean is at most `Σ ω ν V |η|²` times `4 |K⁻¹| + 2/(|ξ|² Σ ω ν V)` of the shortest bond; points
    /// without F have no force state.
    fn stiffness(&self, _: usize, reference: ReferenceFamily<D>) -> f64 {
        let shape = reference.shape();
        if !tensor::inverse(shape).1 {
            return 0.0;
        }
        let (mut all, mut shortest) = (0.0, f64::INFINITY);
        reference.each(|p| {
            all += p.omega * p.volume;
            shortest = p.xi.iter().map(|x| x * x).sum::<f64>().min(shortest);
        });
        4.0 * tensor::greatest_of_inverse(shape) + 2.0 / (all * shortest)
    }

    /// `ω η⊗ξ` and ω; then `ω A_b (1 − n⊗n)` and ω tr τ_b
    #[inline(always)]
    fn pair_pass<N: Number>(
        &self,
        pass: usize,
        bond: &Bond<N, D>,
        end: &EndOf<N, L, D>,
    ) -> (Matrix<N, D>, N) {
        let mut sum = tensor::zero();
        if pass == 0 {
            for r in 0..D {
                let eta = bond.omega * bond.eta[r];
                for c in 0..D {
                    sum[r][c] = eta * bond.xi[c];
                }
            }
            return (sum, bond.omega);
        }
        let Answered { across, trace, .. } = self.stressed(bond, end);
        let along = tensor::times(&across, &bond.xi);
        let inverse = bond.inv_length * bond.inv_length;
        for r in 0..D {
            let along = inverse * along[r];
            for c in 0..D {
                let rest = across[r][c] - along * bond.xi[c];
                sum[r][c] = known(end.point, bond.omega * rest);
            }
        }
        (sum, known(end.point, bond.omega * trace))
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        pass: usize,
        site: &SiteOf<N, L, D>,
        (sum, weight): (Matrix<N, D>, N),
        point: &mut Point<N, D>,
    ) {
        let (inverse, sound) = site.form;
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        let ([h, q], [part, section]) = point;
        if pass == 0 {
            let whole = |x: N| sound.choose(N::constant(0.5), zero, x);
            let gradient = tensor::product(&sum, inverse);
            for r in 0..D {
                for c in 0..D {
                    h[r][c] = whole(gradient[r][c]);
                }
            }
            *section = site.around.section;
            *part = whole(sound.choose(N::constant(0.5), one, weight).recip());
            return;
        }
        // ⅟D ⟨tr τ⟩ F⁻ᵀ
        let mean = N::constant(1.0 / D as f64) * weight.div(one + tensor::dilation(h));
        let cofactors = tensor::cofactor_beyond(h);
        let mut all = sum;
        for r in 0..D {
            for c in 0..D {
                all[r][c] = mean.fma(cofactors[r][c], sum[r][c]);
            }
            all[r][r] = all[r][r] + mean;
        }
        let all = tensor::product(&all, inverse);
        for r in 0..D {
            for c in 0..D {
                q[r][c] = zero.choose(*part, *part * all[r][c], zero);
            }
        }
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, L, D>) -> Free<N, D> {
        let ([_, q], [part, _]) = end.point;
        let across = self.stressed(bond, end).across;
        let along = tensor::times(&across, &bond.xi);
        let mut t = tensor::times(q, &bond.xi);
        let own = *part * bond.inv_length * bond.inv_length;
        for a in 0..D {
            t[a] = known(end.point, bond.omega * own.fma(along[a], t[a]));
        }
        Free(t)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, L, D>) -> N {
        let energy = self.stressed(bond, end).energy;
        known(end.point, end.point.1[0] * bond.omega * energy)
    }

    #[inline(always)]
    fn state_update<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &EndOf<N, L, D>,
        memory: &mut L::Past<N>,
    ) -> N {
        let now = self.stressed(bond, end).past;
        for n in 0..<L::Past<N> as Numbers<N>>::COUNT {
            let zero = N::constant(0.0);
            memory.set(
                n,
                zero.choose(end.point.1[0], now.get(n), end.memory.get(n)),
            );
        }
        let lost = self.law.dissipated(end.memory, memory);
        end.point.1[0] * bond.omega * lost
    }

    #[inline(always)]
    fn gathered<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &EndOf<N, L, D>,
        memory: &L::Past<N>,
    ) -> L::Past<N> {
        <L::Past<N> as Numbers<N>>::constant(0.0).plus(end.point.1[0] * bond.omega, *memory)
    }

    /// Of the last step: what bonds remember in this one is not gathered yet.
    #[inline(always)]
    fn across<N: Number>(&self, site: &SiteOf<N, L, D>, _: &Point<N, D>) -> N {
        self.law.across(site.past)
    }

    /// Points whose bonds span no space any more show what they had.
    #[inline(always)]
    fn remember<N: Number>(
        &self,
        site: &SiteOf<N, L, D>,
        point: &Point<N, D>,
        past: &mut L::Past<N>,
    ) -> N {
        let zero = N::constant(0.0);
        for n in 0..<L::Past<N> as Numbers<N>>::COUNT {
            past.set(n, zero.choose(point.1[0], past.get(n), site.past.get(n)));
        }
        zero
    }
}

impl<L: Registered> Registered for BondAssociated<L> {
    const ISOTROPIC: bool = L::ISOTROPIC;
    const OWN_CRITICAL_STRETCH: bool = L::OWN_CRITICAL_STRETCH;

    fn descriptor() -> Descriptor {
        on_a_family::<L>()
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        L::linear(parameters)
    }

    fn brittle_energy(parameters: &Parameters, energy: f64) -> f64 {
        L::brittle_energy(parameters, energy)
    }

    fn of_one_horizon(parameters: &Parameters) -> Option<&'static str> {
        let pressed = is_pressed(parameters);
        pressed.then_some("with a gradient of each bond the viscosity of shocks knows one horizon")
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        for (n, m) in materials.iter().enumerate() {
            debug_assert!(takes_bonds(m.parameters));
            if m.parameters.number(CONTROL.name).is_some() {
                return Err((
                    n,
                    format!(
                        "`{}` is of {} = \"family\": the gradients of bonds leave nothing unseen; leave it out",
                        CONTROL.name, GRADIENT.name
                    ),
                ));
            }
        }
        Ok(BondAssociated {
            law: L::make(d, plane, materials)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_exact() {
        for x in [1e-60f64, -1e-20, 1e-9, -0.3, 0.5, -0.9, 3.0, -0.999, 999.0] {
            for (d, found) in [
                (2.0, inverse_root::<f64, 2>(x)),
                (3.0, inverse_root::<f64, 3>(x)),
            ] {
                let exact = (-x.ln_1p() / d).exp_m1();
                assert!(
                    (found / exact - 1.0).abs() < 4e-15,
                    "{d} {x}: {found} {exact}"
                );
            }
        }
    }
}
