//! The ordinary viscoelastic solid (Mitchell 2011, "A non-local, ordinary-state-based viscoelasticity model for peridynamics",
//! SAND2011-8064), in D dimensions and with up to [`BRANCHES`] branches.
//!
//! The linear peridynamic solid of [`Solid`], whose shear relaxes: `G(t) = G (1 − Σ λ_b + Σ λ_b e^(−t/τ_b))`. A bond keeps its
//! extension e of the last step and a back extension of each branch, `q̇_b = (e − q_b)^d/τ_b`, integrated exactly for an e that is
//! linear over the step. The deviator `x^d = x − (Σ ω |ξ| x / Σ ω |ξ|²) |ξ|` is over the whole bonds. In an intact family it is Mitchell's
//! e − θ|ξ|/n, and q is a deviator itself; in a torn one this deviator, and no other, is orthogonal to the pressure, so that no branch
//! can gain energy.
//! `W = ½κθ² + (α/2) Σ ω ((1 − Σλ) e² + Σ_b λ_b (e − q_b)²)`, `α = β/m`, `θ = (n/m) Σ ω |ξ| e`.

use super::{Along, Bond, Columns, End, Kin, Material, Site};
use crate::columns::{Declaration, Dimension};
use crate::law::descriptor::{self, Bounds, Descriptor, Given, Key, MODULI, Need, Shelved, Value};
use crate::law::number::Number;
use crate::law::solid::eam_like::Solid;
use crate::spec::{Influence, LawSpec, Parameters, Plane};
use std::borrow::Cow;

/// Constants of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct ViscoelasticConstants {
    pub solid: Solid,
    /// `(λ_b, τ_b)`: part of the shear modulus that relaxes, and its time.
    pub branches: Vec<(f64, f64)>,
}

/// Most branches of a material of a deck.
pub const BRANCHES: usize = 4;

/// See the module; materials have up to B branches.
#[derive(Debug, Clone)]
pub struct Viscoelastic<const B: usize = BRANCHES> {
    /// Per material.
    pub materials: Vec<ViscoelasticConstants>,
}

/// n²κ, β.
const BULK: usize = 0;
const BETA: usize = 1;

/// Numbers of a point: nκθ/m, β/m, θ/n; and of each branch the part along |ξ| of what its back extension would grow by.
const P: usize = 0;
const ALPHA: usize = 1;
const DILATED: usize = 2;
type Point<N, const B: usize> = ([N; 3], [N; B]);

/// A branch: part λ; what a back extension approaches over the step, `1 − e^(−Δt/τ)`; and its growth per growth of e,
/// `1 − (1 − e^(−Δt/τ)) τ/Δt`.
type Branch<N> = [N; 3];
type Constants<N, const B: usize> = ([N; 2], [Branch<N>; B]);
/// e at the end of the last step, back extensions.
type Memory<N, const B: usize> = (N, [N; B]);
type EndOf<'a, N, const B: usize> = End<'a, Constants<N, B>, Point<N, B>, Memory<N, B>>;

impl<const B: usize> Viscoelastic<B> {
    /// What back extensions would grow by over the step, were they not deviators.
    #[inline(always)]
    fn growth<N: Number, const D: usize>(bond: &Bond<N, D>, end: &EndOf<N, B>) -> [N; B] {
        let (before, mut back) = *end.memory;
        let change = bond.extension() - before;
        for b in 0..B {
            let [_, nears, grows] = end.constants.1[b];
            back[b] = grows.fma(change, nears * (before - back[b]));
        }
        back
    }

    /// Back extensions at the end of the step.
    #[inline(always)]
    fn next<N: Number, const D: usize>(bond: &Bond<N, D>, end: &EndOf<N, B>) -> [N; B] {
        let mut back = Self::growth(bond, end);
        for b in 0..B {
            let along = end.point.1[b] * bond.length;
            back[b] = end.memory.1[b] + (back[b] - along);
        }
        back
    }

    /// `∫ αω Σ λ (e − q) dq` of the step, by the trapezoidal rule (energy / volume²).
    #[inline(always)]
    fn dissipation<N: Number, const D: usize>(
        bond: &Bond<N, D>,
        end: &EndOf<N, B>,
        back: &[N; B],
    ) -> N {
        let (before, old) = *end.memory;
        let now = bond.extension();
        let mut sum = N::constant(0.0);
        for b in 0..B {
            let force = (before - old[b]) + (now - back[b]);
            sum = (end.constants.1[b][0] * force).fma(back[b] - old[b], sum);
        }
        N::constant(0.5) * end.point.0[ALPHA] * bond.omega * sum
    }
}

/// Of `1 − (1 − e^(−x))/x`, without cancellation where x is small.
fn growth(x: f64) -> f64 {
    if x > 1e-3 {
        1.0 + (-x).exp_m1() / x
    } else {
        x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)))
    }
}

impl<const D: usize, const B: usize> Material<D> for Viscoelastic<B> {
    type Constants<N: Number> = Constants<N, B>;
    /// 1/m
    type Form<N: Number> = N;
    /// `Σ ω|ξ|e`, `Σ ω|ξ|²`; `Σ ω|ξ|` of what back extensions would grow by.
    type Sum<N: Number> = ([N; 2], [N; B]);
    type Point<N: Number> = Point<N, B>;
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = Memory<N, B>;
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    const OF_FAMILY: bool = true;

    fn columns(&self) -> Columns {
        let mut memory = vec![Declaration::of_bonds(
            "extension",
            Dimension::LENGTH,
            "Extension e of a bond at the end of the last step.",
        )];
        memory.extend((1..=B).map(|b| Declaration {
            name: Cow::Owned(format!("back_extension_{b}")),
            ..Declaration::of_bonds(
                "",
                Dimension::LENGTH,
                "Back extension q of a branch, which follows the deviator of e (Mitchell 2011).",
            )
        }));
        Columns {
            memory,
            ..Columns::default()
        }
    }

    fn constants(&self, material: usize, dt: f64) -> Constants<f64, B> {
        let m = &self.materials[material];
        let n = m.solid.n;
        let branch = |(part, time): &(f64, f64)| {
            let x = dt / time;
            [*part, -(-x).exp_m1(), growth(x)]
        };
        let none = [0.0; 3];
        (
            [n * n * m.solid.kappa, m.solid.beta],
            std::array::from_fn(|b| m.branches.get(b).map_or(none, branch)),
        )
    }

    fn form(&self, _: usize, kin: Kin<D>) -> f64 {
        kin.inverse_weight()
    }

    #[inline(always)]
    fn share<N: Number>(&self, _: usize, bond: &Bond<N, D>, end: &EndOf<N, B>) -> ([N; 2], [N; B]) {
        let weight = bond.omega * bond.length;
        let mut growth = Self::growth(bond, end);
        for b in 0..B {
            growth[b] = weight * growth[b];
        }
        ([weight * bond.extension(), weight * bond.length], growth)
    }

    #[inline(always)]
    fn settle<N: Number>(
        &self,
        _: usize,
        site: &Site<Constants<N, B>, N, [N; 0]>,
        ([dilated, whole], growth): ([N; 2], [N; B]),
        (point, along): &mut Point<N, B>,
    ) {
        let (c, per_m) = (site.constants.0, *site.form);
        point[DILATED] = per_m * dilated;
        point[P] = c[BULK] * per_m * point[DILATED];
        point[ALPHA] = c[BETA] * per_m;
        let zero = N::constant(0.0);
        let per_whole = zero.choose(whole, N::constant(1.0).div(whole), zero);
        for b in 0..B {
            along[b] = per_whole * growth[b];
        }
    }

    #[inline(always)]
    fn answer<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, B>) -> Along<N> {
        let back = Self::next(bond, end);
        let mut e = bond.extension();
        for b in 0..B {
            e = e - end.constants.1[b][0] * back[b];
        }
        let t = end.point.0[ALPHA].fma(e, end.point.0[P] * bond.length);
        Along(bond.omega * t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, B>) -> N {
        let back = Self::next(bond, end);
        let e = bond.extension();
        let (mut lasting, mut sum) = (N::constant(1.0), N::constant(0.0));
        for b in 0..B {
            let part = end.constants.1[b][0];
            lasting = lasting - part;
            let branch = e - back[b];
            sum = (part * branch).fma(branch, sum);
        }
        sum = (lasting * e).fma(e, sum);
        let stored = N::constant(0.5) * end.point.0[ALPHA] * bond.omega * sum;
        stored + Self::dissipation(bond, end, &back)
    }

    #[inline(always)]
    fn point_energy<N: Number>(
        &self,
        site: &Site<Constants<N, B>, N, [N; 0]>,
        _: ([N; 2], [N; B]),
        (point, _): &Point<N, B>,
    ) -> N {
        N::constant(0.5) * site.constants.0[BULK] * point[DILATED] * point[DILATED]
    }

    #[inline(always)]
    fn advance<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &EndOf<N, B>,
        memory: &mut Memory<N, B>,
    ) -> N {
        let back = Self::next(bond, end);
        *memory = (bond.extension(), back);
        Self::dissipation(bond, end, &back)
    }
}

/// Part and time of a branch.
static BRANCH: [(&str, Dimension, Bounds); 2] = [
    ("part of the shear modulus", Dimension::NUMBER, Bounds::PART),
    ("relaxation time", Dimension::TIME, Bounds::POSITIVE),
];

/// Does a law of one branch do?
pub fn one_branch(parameters: &Parameters) -> bool {
    parameters.rows("branches").is_some_and(|r| r.len() == 1)
}

impl<const B: usize> Shelved for Viscoelastic<B> {
    fn descriptor() -> Descriptor {
        let mut keys = MODULI.to_vec();
        keys.push(Key {
            name: "branches",
            value: Value::Rows(&BRANCH),
            need: Need::Given,
            doc: "[part λ, time τ] of each branch of the shear modulus G (1 − Σλ + Σλ e^(−t/τ)); up to four, Σλ at most 1.",
        });
        Descriptor {
            name: "viscoelastic".into(),
            doc: "Linear peridynamic solid whose shear relaxes, G(t) = G (1 − Σλ + Σλ e^(−t/τ)). Two of young, poisson, bulk, shear of the unrelaxed solid.".into(),
            source: "Mitchell 2011, SAND2011-8064".into(),
            example: "{ young = \"3 GPa\", poisson = 0.35, branches = [[0.5, \"1 ms\"], [0.2, \"0.1 s\"]] }".into(),
            influence: Influence::Inverse,
            memory: descriptor::Memory::Time,
            keys,
        }
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(_: usize, _: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let mut made = vec![];
        for (n, m) in materials.iter().enumerate() {
            let refused = |message: String| Err((n, message));
            let rows = m.parameters.rows("branches").unwrap_or(&[]);
            if rows.is_empty() || rows.len() > B {
                return refused(format!(
                    "there are {} branches, expected one to {B}",
                    rows.len()
                ));
            }
            let sum: f64 = rows.iter().map(|r| r[0]).sum();
            if sum > 1.0 + 1e-12 {
                return refused(format!(
                    "the parts of the branches add up to {sum}, more than the shear modulus"
                ));
            }
            let Some(solid) = m.solid else {
                return refused("a viscoelastic solid needs its moduli".into());
            };
            made.push(ViscoelasticConstants {
                solid,
                branches: rows.iter().map(|r| (r[0], r[1])).collect(),
            });
        }
        Ok(Viscoelastic { materials: made })
    }
}

#[cfg(test)]
mod tests {
    use super::growth;

    #[test]
    fn growth_is_one_function_on_both_sides_of_its_border() {
        for x in [1e-6f64, 1e-4, 0.9e-3, 1.1e-3, 0.1, 3.0, 50.0] {
            // Σ (−x)^(k+1) / (k+2)! as far as it matters, or the closed form
            let exact = if x < 0.5 {
                let (mut term, mut sum) = (-1.0, 0.0);
                for k in 1..20 {
                    term *= -x / (k + 1) as f64;
                    sum += term;
                }
                sum
            } else {
                1.0 - (1.0 - (-x).exp()) / x
            };
            assert!((growth(x) - exact).abs() <= 1e-13 * exact, "{x}");
        }
        assert_eq!(growth(0.0), 0.0);
    }
}
