//! The ordinary viscoelastic solid (Mitchell 2011, "A non-local, ordinary-state-based viscoelasticity model for peridynamics",
//! SAND2011-8064), in D dimensions and with up to [`BRANCHES`] branches.
//!
//! The linear peridynamic solid of [`Solid`], whose shear relaxes: `G(t) = G (1 − Σ λ_b + Σ λ_b e^(−t/τ_b))`. A bond keeps its
//! extension e of the last step and a back extension of each branch, `q̇_b = (e − q_b)^d/τ_b`, integrated exactly for an e that is
//! linear over the step. The deviator `x^d = x − (Σ ω |ξ| x / Σ ω |ξ|²) |ξ|` is over the intact bonds. In an intact family it is Mitchell's
//! e − θ|ξ|/n, and q is a deviator itself; in a damaged one this deviator, and no other, is orthogonal to the pressure, so that no branch
//! can gain energy.
//! `W = ½κθ² + (α/2) Σ ω ((1 − Σλ) e² + Σ_b λ_b (e − q_b)²)`, `α = β/m`, `θ = (n/m) Σ ω |ξ| e`.
//!
//! The deviator that relaxes is that of the three-dimensional solid: in one and two dimensions W has what is across, too, as
//! [`section`] has it, where a point remembers a back strain `ż_b = (d − z_b)/τ_b` of each branch, exact for a d that is linear over the step. It
//! begins at the d of the bonds that are whole now: what breaks changes d at once.

use super::section::{self, Section};
use super::{Along, Bond, Columns, End, Material, ReferenceFamily, Site};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{
    self, Bounds, Descriptor, Given, Key, MODULI, Need, Registered, Value,
};
use crate::law::number::Number;
use crate::law::solid::eam_like::Solid;
use crate::spec::{Influence, LawSpec, Parameters, Plane};
use std::borrow::Cow;

/// Constants of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct ViscoelasticConstants {
    pub solid: Solid,
    pub section: Section<f64>,
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

/// Numbers of a point: `nκθ/m` with what is across, β/m, θ/n and that at the end of the last step; and of each branch the part along |ξ| of what its back extension would grow by.
const P: usize = 0;
const ALPHA: usize = 1;
const DILATED: usize = 2;
const BEFORE: usize = 3;
type Point<N, const B: usize> = ([N; 4], [N; B]);

/// A branch: part λ; what a back extension approaches over the step, `1 − e^(−Δt/τ)`; and its growth per growth of e,
/// `1 − (1 − e^(−Δt/τ)) τ/Δt`.
type Branch<N> = [N; 3];
type Constants<N, const B: usize> = (([N; 2], Section<N>), [Branch<N>; B]);
/// e at the end of the last step, back extensions.
type Memory<N, const B: usize> = (N, [N; B]);
/// Strain of the section at the end of the last step, back strains z.
type Past<N, const B: usize> = (N, [N; B]);
type SiteOf<'a, N, const B: usize> = Site<'a, N, Constants<N, B>, N, Past<N, B>>;
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

/// What is across a body at the end of a step.
struct Across<N, const B: usize> {
    dilatation: N,
    /// d at both ends of the step, and z_b.
    ends: [N; 2],
    back: [N; B],
    /// `Σ λ_b z_b`, `Σ λ_b z_b²`.
    gone: (N, N),
}

impl<N: Number, const B: usize> Across<N, B> {
    #[inline(always)]
    fn new<const D: usize>(site: &SiteOf<N, B>, point: &[N; 4]) -> Self {
        let ((_, section), branches) = site.constants;
        let (thin, back) = *site.past;
        let n = N::constant(D as f64);
        let [dilatation, past] = [n * point[DILATED], n * point[BEFORE]];
        let zero = N::constant(0.0);
        let mut before = section::deviator::<N, D>(section, past, thin);
        for b in 0..B {
            before = (section::gives(section) * branches[b][0]).fma(back[b], before);
        }
        // of a d that ends at 0; and how Z grows with it
        let (mut rest, mut grows) = (zero, zero);
        let mut now = back;
        for b in 0..B {
            let [part, nears, growth] = branches[b];
            now[b] = nears.fma(before - back[b], back[b]) - growth * before;
            rest = part.fma(now[b], rest);
            grows = part.fma(growth, grows);
        }
        let own = section::deviator::<N, D>(section, dilatation, site.around.section);
        let g = section::gives(section);
        let d = g.fma(rest, own).div(N::constant(1.0) - g * grows);
        let (mut gone, mut squares) = (zero, zero);
        for b in 0..B {
            let [part, _, growth] = branches[b];
            now[b] = growth.fma(d, now[b]);
            gone = part.fma(now[b], gone);
            squares = (part * now[b]).fma(now[b], squares);
        }
        Across {
            dilatation,
            ends: [before, d],
            back: now,
            gone: (gone, squares),
        }
    }

    #[inline(always)]
    fn dissipated<const D: usize>(&self, site: &SiteOf<N, B>) -> N {
        let ((_, section), branches) = site.constants;
        let (old, new) = (site.past.1, self.back);
        let [before, now] = self.ends;
        let mut sum = N::constant(0.0);
        for b in 0..B {
            let both = (before - old[b]) + (now - new[b]);
            let lost = section::dissipated::<N, D>(section, both, new[b] - old[b]);
            sum = branches[b][0].fma(lost, sum);
        }
        sum
    }
}

/// Of `1 − (1 − e^(−x))/x`, without cancellation where x is small.
fn growth(x: f64) -> f64 {
    if x > 1e-3 {
        1.0 + libm::expm1(-x) / x
    } else {
        x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)))
    }
}

impl<const D: usize, const B: usize> Material<D> for Viscoelastic<B> {
    type Constants<N: Number> = Constants<N, B>;
    /// 1/m
    type Form<N: Number> = N;
    /// `Σ ω|ξ|e`, `Σ ω|ξ|²`, and the first with the e of the last step; `Σ ω|ξ|` of what back extensions would grow by.
    type Sum<N: Number> = ([N; 3], [N; B]);
    type Point<N: Number> = Point<N, B>;
    type Past<N: Number> = Past<N, B>;
    type Memory<N: Number> = Memory<N, B>;
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    const OF_FAMILY: bool = true;
    const SECTION: bool = true;
    const ACROSS: bool = true;

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
        let mut past = vec![];
        if D < 3 {
            let scalar = |name: String, doc| Declaration {
                name: Cow::Owned(name),
                ..Declaration::of_points("", Shape::Scalar, Dimension::NUMBER, doc)
            };
            past.push(scalar(
                "strain_across".into(),
                "Elastic strain across a plane at the end of the last step, the reverse of what temperature or swelling would give it.",
            ));
            past.extend((1..=B).map(|b| {
                scalar(
                    format!("back_strain_across_{b}"),
                    "Back strain z of a branch across a line or a plane, which follows d.",
                )
            }));
        }
        Columns {
            memory,
            past,
            ..Columns::default()
        }
    }

    fn constants(&self, material: usize, dt: f64) -> Constants<f64, B> {
        let m = &self.materials[material];
        let n = m.solid.n;
        let branch = |(part, time): &(f64, f64)| {
            let x = dt / time;
            [*part, -libm::expm1(-x), growth(x)]
        };
        let none = [0.0; 3];
        (
            ([n * n * m.solid.kappa, m.solid.beta], m.section),
            crate::array::from_fn(|b| m.branches.get(b).map_or(none, branch)),
        )
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> f64 {
        reference.inverse_weight()
    }

    #[inline(always)]
    fn pair_pass<N: Number>(
        &self,
        _: usize,
        bond: &Bond<N, D>,
        end: &EndOf<N, B>,
    ) -> ([N; 3], [N; B]) {
        let weight = bond.omega * bond.length;
        let mut growth = Self::growth(bond, end);
        for b in 0..B {
            growth[b] = weight * growth[b];
        }
        let sums = [
            weight * bond.extension(),
            weight * bond.length,
            weight * end.memory.0,
        ];
        (sums, growth)
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &SiteOf<N, B>,
        ([dilated, whole, before], growth): ([N; 3], [N; B]),
        (point, along): &mut Point<N, B>,
    ) {
        let ((c, section), per_m) = (&site.constants.0, *site.form);
        point[DILATED] = per_m * dilated;
        point[P] = c[BULK] * per_m * point[DILATED];
        if D < 3 {
            let n = N::constant(D as f64);
            point[BEFORE] = per_m * before;
            let across = Across::new::<D>(site, point);
            let pressure = section::pressure::<N, D>(section, across.gone.0, site.around.section);
            point[P] = (n * per_m).fma(pressure, point[P]);
        }
        point[ALPHA] = c[BETA] * per_m;
        let zero = N::constant(0.0);
        let per_whole = zero.choose(whole, N::constant(1.0).div(whole), zero);
        for b in 0..B {
            along[b] = per_whole * growth[b];
        }
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &EndOf<N, B>) -> Along<N> {
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
        site: &SiteOf<N, B>,
        _: ([N; 3], [N; B]),
        (point, _): &Point<N, B>,
    ) -> N {
        let (c, section) = &site.constants.0;
        let volume = N::constant(0.5) * c[BULK] * point[DILATED] * point[DILATED];
        if D == 3 {
            return volume;
        }
        let across = Across::new::<D>(site, point);
        let strain = site.around.section;
        let stored = section::energy::<N, D>(section, across.dilatation, across.gone, strain);
        volume + stored + across.dissipated::<D>(site)
    }

    #[inline(always)]
    fn across<N: Number>(&self, site: &SiteOf<N, B>, (point, _): &Point<N, B>) -> N {
        let across = Across::new::<D>(site, point);
        let (_, section) = &site.constants.0;
        section::stress(
            section,
            across.dilatation,
            across.gone.0,
            site.around.section,
        )
    }

    #[inline(always)]
    fn state_update<N: Number>(
        &self,
        bond: &Bond<N, D>,
        end: &EndOf<N, B>,
        memory: &mut Memory<N, B>,
    ) -> N {
        let back = Self::next(bond, end);
        *memory = (bond.extension(), back);
        Self::dissipation(bond, end, &back)
    }

    #[inline(always)]
    fn remember<N: Number>(
        &self,
        site: &SiteOf<N, B>,
        (point, _): &Point<N, B>,
        past: &mut Past<N, B>,
    ) -> N {
        if D == 3 {
            return N::constant(0.0);
        }
        let across = Across::new::<D>(site, point);
        *past = (site.around.section, across.back);
        across.dissipated::<D>(site)
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

impl<const B: usize> Registered for Viscoelastic<B> {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "viscoelastic",
            "Linear peridynamic solid whose shear relaxes, G(t) = G (1 − Σλ + Σλ e^(−t/τ)). Two of young, poisson, bulk, shear of the unrelaxed solid.",
        )
        .source("Mitchell 2011, SAND2011-8064")
        .example("{ young = \"3 GPa\", poisson = 0.35, branches = [[0.5, \"1 ms\"], [0.2, \"0.1 s\"]] }")
        .influence(Influence::Inverse)
        .memory(descriptor::Memory::Time)
        .keys(&MODULI)
        .keys(&[Key {
            name: "branches",
            value: Value::Rows(&BRANCH),
            need: Need::Given,
            doc: "[part λ, time τ] of each branch of the shear modulus G (1 − Σλ + Σλ e^(−t/τ)); up to four, Σλ at most 1.",
        }])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| {
            let rows = m.parameters.rows("branches").unwrap_or(&[]);
            if rows.is_empty() || rows.len() > B {
                return Err(format!(
                    "there are {} branches, expected one to {B}",
                    rows.len()
                ));
            }
            let sum: f64 = rows.iter().map(|r| r[0]).sum();
            if sum > 1.0 + 1e-12 {
                return Err(format!(
                    "the parts of the branches add up to {sum}, more than the shear modulus"
                ));
            }
            Ok(ViscoelasticConstants {
                solid: { m.solid }.ok_or("a viscoelastic solid needs its moduli")?,
                section: section::of(d, plane, &descriptor::moduli(m.parameters)?),
                branches: rows.iter().map(|r| (r[0], r[1])).collect(),
            })
        };
        let materials = descriptor::each(materials, of)?;
        Ok(Viscoelastic { materials })
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
