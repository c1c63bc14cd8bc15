//! The ordinary elastic–plastic solid (Mitchell 2011, "A nonlocal, ordinary, state-based plasticity model for peridynamics",
//! SAND2011-3166), in D dimensions and with linear isotropic hardening.
//!
//! The linear peridynamic solid of [`Solid`], whose bonds keep a plastic extension e^p:
//! `W = ½κθ² + (α/2) Σ ω (e − e^p)²`, `α = β/m`, `θ = (n/m) Σ ω |ξ| e`. The deviatoric force state of a bond is
//! `t = α ω e^d`, `e^d = e − e^p − μ|ξ|` with `μ = Σ ω |ξ| (e − e^p) / Σ ω |ξ|²` over the intact bonds. In an intact family e^p has no
//! part along |ξ| and `μ = θ/n`, which is Mitchell's; in a damaged one this deviator, and no other, is orthogonal to the pressure, so that
//! flow dissipates what the energy loses. It yields where `½ Σ t²/ω = ψ0`, and flows along it, `ė^p = λ t/ω`.
//! With the stress that this norm stands for in shear, `σ = ‖t‖ √(3m/(n(n+2)))`, the return is the classical one:
//! `Δε̄ = (σ_trial − σ_y(ε̄))/(3G + H)`, and `ψ0 = n(n+2) σ_y²/(6m)`: for a full ball and ω = 1 that is Mitchell's `25 σ_y²/(8πδ⁵)`,
//! which points near a surface have, too, where constants are those of the continuum. Perfect plasticity is H = 0. Step by step the energy is the incremental potential, whose derivative is the force.
//!
//! The deviator that flows is that of the three-dimensional solid: in one and two dimensions a point remembers the plastic part z of the
//! deviator d across ([`section`]), and yields where `σ_b² + σ_a² = σ_y²`, with the σ_b of its bonds and `σ_a = 3G √(2c/D) (d − z)`. Both return by the same
//! `γ = Δε̄/σ`, to `σ_b/(1 + S_b γ)` and `σ_a/(1 + S_a γ)`, with S = 3G where d is given, less by what a free section gives way, and `S_b = α m_y/(n(n+2)/3)` of the bonds.

use super::section::{self, Section};
use super::{Along, Bond, Columns, End, Material, ReferenceFamily, Site};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::descriptor::{self, Bounds, Descriptor, Given, Key, MODULI, Memory, Registered};
use crate::law::number::Number;
use crate::law::solid::eam_like::Solid;
use crate::spec::{Influence, LawSpec, Parameters, Plane};

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticPlasticConstants {
    pub solid: Solid,
    pub section: Section<f64>,
    /// Weighted volume of the family that the yield surface is that of; `None`: of each point's own.
    pub weighted_volume: Option<f64>,
    /// Yield stress σ_y in tension.
    pub yield_stress: f64,
    /// Hardening modulus `H = dσ_y/dε̄`, 0 or positive.
    pub hardening: f64,
}

/// See the module.
#[derive(Debug, Clone)]
pub struct ElasticPlastic {
    /// Per material.
    pub materials: Vec<ElasticPlasticConstants>,
}

/// Numbers of a material.
const BULK: usize = 0; // n²κ
const BETA: usize = 1;
const RADIUS: usize = 2; // n(n+2)/3
const YIELD: usize = 3;
const HARDENING: usize = 4;
const BALL: usize = 5; // 1/m that the yield surface has; 0: the point's own

/// Numbers of a point; partners read the first two.
const ALONG: usize = 0; // of |ξ| in a force state, nκθ/m + αρμ, with ρ the part of the deviator that flows
const STIFF: usize = 1; // of e − e^p in it, α (1 − ρ)
const ALPHA: usize = 2; // β/m
const MEAN: usize = 3; // μ
const REST: usize = 4; // ρ
const FLOW: usize = 5; // Δε̄
const DILATED: usize = 6; // θ/n
const ACROSS: usize = 7; // z

type Constants<N> = ([N; 6], Section<N>);
type Ends<'a, N> = End<'a, Constants<N>, [N; 8], [N; 1]>;
/// ε̄, z
type SiteOf<'a, N> = Site<'a, N, Constants<N>, N, [N; 2]>;

/// Most steps of the search for γ, which Newton's method finds from below: where both return alike in one.
const STEPS: usize = 40;

impl ElasticPlastic {
    /// `e^d` before the step's flow.
    #[inline(always)]
    fn trial<N: Number, const D: usize>(bond: &Bond<N, D>, end: &Ends<N>) -> N {
        bond.extension() - end.memory[0] - end.point[MEAN] * bond.length
    }

    /// `e − e^p` after it.
    #[inline(always)]
    fn elastic<N: Number, const D: usize>(bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let flow = end.point[REST] * Self::trial(bond, end);
        bond.extension() - end.memory[0] - flow
    }
}

impl<const D: usize> Material<D> for ElasticPlastic {
    type Constants<N: Number> = Constants<N>;
    /// 1/m
    type Form<N: Number> = N;
    /// `Σ ω|ξ|e`, `Σ ω|ξ|(e − e^p)`, `Σ ω (e − e^p)²`, `Σ ω|ξ|²`.
    type Sum<N: Number> = [N; 4];
    type Point<N: Number> = [N; 8];
    /// ε̄, z
    type Past<N: Number> = [N; 2];
    /// e^p
    type Memory<N: Number> = [N; 1];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 1;
    const OF_FAMILY: bool = true;
    const SECTION: bool = true;
    const ACROSS: bool = true;

    fn columns(&self) -> Columns {
        let mut past = vec![Declaration::of_points(
            "plastic_strain",
            Shape::Scalar,
            Dimension::NUMBER,
            "Equivalent plastic strain ε̄, work-conjugate to the yield stress.",
        )];
        if D < 3 {
            past.push(Declaration::of_points(
                "plastic_strain_across",
                Shape::Scalar,
                Dimension::NUMBER,
                "Plastic part z of the deviatoric strain across a line or a plane.",
            ));
        }
        Columns {
            memory: vec![Declaration::of_bonds(
                "plastic_extension",
                Dimension::LENGTH,
                "Plastic part e^p of the extension of a bond (Mitchell 2011).",
            )],
            past,
            point: vec![],
            ..Columns::default()
        }
    }

    fn constants(&self, material: usize, _: f64) -> Constants<f64> {
        let m = &self.materials[material];
        let n = m.solid.n;
        let own = [
            n * n * m.solid.kappa,
            m.solid.beta,
            n * (n + 2.0) / 3.0,
            m.yield_stress,
            m.hardening,
            m.weighted_volume.map_or(0.0, f64::recip),
        ];
        (own, m.section)
    }

    fn form(&self, _: usize, reference: ReferenceFamily<D>) -> f64 {
        reference.inverse_weight()
    }

    #[inline(always)]
    fn pair_pass<N: Number>(&self, _: usize, bond: &Bond<N, D>, end: &Ends<N>) -> [N; 4] {
        let (weight, e) = (bond.omega * bond.length, bond.extension());
        let elastic = e - end.memory[0];
        [
            weight * e,
            weight * elastic,
            bond.omega * elastic * elastic,
            weight * bond.length,
        ]
    }

    #[inline(always)]
    fn point_update<N: Number>(
        &self,
        _: usize,
        site: &SiteOf<N>,
        [dilated, elastic, square, whole]: [N; 4],
        point: &mut [N; 8],
    ) {
        let ((c, section), per_m) = (site.constants, *site.form);
        let zero = N::constant(0.0);
        point[DILATED] = per_m * dilated;
        point[ALPHA] = c[BETA] * per_m;
        let mean = zero.choose(whole, elastic.div(whole), zero);
        point[MEAN] = mean;
        // Pythagoras: what is orthogonal to |ξ|
        let deviator = square - mean * elastic;
        let norm = point[ALPHA] * zero.choose(deviator, deviator.sqrt(), zero);
        // ‖t‖ per stress
        let per_ball = zero.choose(c[BALL], c[BALL], per_m);
        let scale = (c[RADIUS] * per_ball).sqrt();
        let limit = c[HARDENING].fma(site.past[0], c[YIELD]);
        // α/scale², 3G in a family of that weighted volume
        let shear = point[ALPHA].div(c[RADIUS] * per_ball);
        let (rest, pressure);
        if D == 3 {
            let limit = scale * limit;
            let beyond = norm - limit;
            let part = (beyond * shear).div((shear + c[HARDENING]) * norm);
            let flow = beyond.div((shear + c[HARDENING]) * scale);
            rest = limit.choose(norm, part, zero);
            point[FLOW] = limit.choose(norm, flow, zero);
            pressure = zero;
        } else {
            let strain = site.around.section;
            let theta = N::constant(D as f64) * point[DILATED];
            let kept = N::constant(1.0) - section::gives(section);
            let across = section::deviator::<N, D>(section, theta, strain) - kept * site.past[1];
            let triple = N::constant(3.0) * section::shear(section);
            let returned = Return {
                stresses: [norm.div(scale), section::mises::<N, D>(section, across)],
                stiffnesses: [shear, triple * kept],
                limit,
                hardening: c[HARDENING],
            }
            .of_step();
            let stiff = shear * returned.per_stress;
            // a point without bonds has no stiffness, and no flow; at the yield surface bonds and what is across have their slopes both
            let part = stiff.div(N::constant(1.0) + stiff);
            rest = zero.choose(per_ball, part, zero);
            point[FLOW] = returned.strain;
            let stiff = triple * returned.per_stress;
            let moved = (stiff * across).div(N::constant(1.0) + kept * stiff);
            point[ACROSS] = site.past[1] + moved;
            let along = section::pressure::<N, D>(section, point[ACROSS], strain);
            pressure = N::constant(D as f64) * per_m * along;
        }
        point[REST] = rest;
        let flows = point[ALPHA] * rest;
        point[STIFF] = point[ALPHA] - flows;
        let volume = (c[BULK] * per_m).fma(point[DILATED], pressure);
        point[ALONG] = flows.fma(mean, volume);
    }

    #[inline(always)]
    fn force_state<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> Along<N> {
        let elastic = bond.extension() - end.memory[0];
        let t = end.point[STIFF].fma(elastic, end.point[ALONG] * bond.length);
        Along(bond.omega * t * bond.inv_current)
    }

    #[inline(always)]
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>) -> N {
        let e = Self::elastic(bond, end);
        N::constant(0.5) * end.point[ALPHA] * bond.omega * e * e
    }

    #[inline(always)]
    fn point_energy<N: Number>(&self, site: &SiteOf<N>, _: [N; 4], point: &[N; 8]) -> N {
        let (c, section) = site.constants;
        let (dilated, z) = (point[DILATED], point[ACROSS]);
        let mut lost = work(site, point);
        if D < 3 {
            let theta = N::constant(D as f64) * dilated;
            let strain = site.around.section;
            lost = lost + section::energy::<N, D>(section, theta, (z, z * z), strain);
        }
        (N::constant(0.5) * c[BULK] * dilated).fma(dilated, lost)
    }

    #[inline(always)]
    fn across<N: Number>(&self, site: &SiteOf<N>, point: &[N; 8]) -> N {
        let theta = N::constant(D as f64) * point[DILATED];
        section::stress(&site.constants.1, theta, point[ACROSS], site.around.section)
    }

    #[inline(always)]
    fn moves<N: Number>(&self, point: &[N; 8]) -> bool {
        (N::constant(0.0) - point[FLOW]).any_below(0.0)
    }

    #[inline(always)]
    fn state_update<N: Number>(&self, bond: &Bond<N, D>, end: &Ends<N>, memory: &mut [N; 1]) -> N {
        memory[0] = end.memory[0] + end.point[REST] * Self::trial(bond, end);
        N::constant(0.0)
    }

    #[inline(always)]
    fn remember<N: Number>(&self, site: &SiteOf<N>, point: &[N; 8], past: &mut [N; 2]) -> N {
        past[0] = site.past[0] + point[FLOW];
        if D < 3 {
            past[1] = point[ACROSS];
        }
        work(site, point)
    }
}

/// `∫σ_y dε̄` of the step's flow: what it dissipates, by the trapezoidal rule, which is exact for linear hardening.
#[inline(always)]
fn work<N: Number>(site: &SiteOf<N>, point: &[N; 8]) -> N {
    let c = &site.constants.0;
    let middle = N::constant(0.5).fma(point[FLOW], site.past[0]);
    c[HARDENING].fma(middle, c[YIELD]) * point[FLOW]
}

/// The return of two stresses, whose squares add up, to the yield surface.
struct Return<N> {
    /// Of the trial.
    stresses: [N; 2],
    stiffnesses: [N; 2],
    /// σ_y before the flow.
    limit: N,
    hardening: N,
}

/// How much it is.
struct Returned<N> {
    /// Δε̄.
    strain: N,
    /// γ (1 / pressure).
    per_stress: N,
}

impl<N: Number> Return<N> {
    /// σ after a return by γ, and `d(1/σ)/dγ`.
    #[inline(always)]
    fn stress(&self, gamma: N) -> [N; 2] {
        let one = N::constant(1.0);
        let (mut square, mut slope) = (N::constant(0.0), N::constant(0.0));
        for k in 0..2 {
            let less = self.stiffnesses[k].fma(gamma, one);
            let stress = self.stresses[k].div(less);
            square = stress.fma(stress, square);
            slope = (self.stiffnesses[k] * stress * stress).fma(less.recip(), slope);
        }
        let stress = square.sqrt();
        [stress, slope.div(square * stress)]
    }

    /// `1/σ(γ) = (1 − Hγ)/σ_y`, whose left side is concave: from γ = 0 Newton's method comes from below.
    #[inline(always)]
    fn of_step(&self) -> Returned<N> {
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        let mut square = zero;
        for stress in self.stresses {
            square = stress.fma(stress, square);
        }
        // 1 where it flows
        let flows = (self.limit * self.limit).choose(square, one, zero);
        if !(zero - flows).any_below(0.0) {
            return Returned {
                strain: zero,
                per_stress: zero,
            };
        }
        let (inverse, mut gamma) = (self.limit.recip(), zero);
        // 1 until it is found: what other lanes are still after changes no last digit of this one
        let mut sought = flows;
        for _ in 0..STEPS {
            let [stress, slope] = self.stress(gamma);
            let off = stress.recip() - (one - self.hardening * gamma) * inverse;
            let step = off.div(self.hardening.fma(inverse, slope));
            let next = zero.choose(sought, gamma - step, gamma);
            let change = (next - gamma).most(gamma - next);
            gamma = next;
            sought = (N::constant(1e-15) * gamma - change).choose(zero, sought, zero);
            if !(zero - sought).any_below(0.0) {
                break;
            }
        }
        Returned {
            strain: zero.choose(flows, gamma * self.stress(gamma)[0], zero),
            per_stress: gamma,
        }
    }
}

const HARDENS: Key = descriptor::number(
    "hardening",
    Dimension::PRESSURE,
    Bounds::NOT_NEGATIVE,
    "Hardening modulus H = dσ_y/dε̄; 0 is perfect plasticity.",
)
.or(0.0);

impl Registered for ElasticPlastic {
    fn descriptor() -> Descriptor {
        Descriptor::new(
            "elastic_plastic",
            "Linear peridynamic solid whose deviatoric extensions flow: ½ Σ t²/ω = n(n+2) σ_y²/(6m), ė^p = λ t/ω. Two of young, poisson, bulk, shear.",
        )
        .source("Mitchell 2011, SAND2011-3166")
        .example("{ young = \"200 GPa\", poisson = 0.3, yield_stress = \"250 MPa\", hardening = \"1 GPa\" }")
        .influence(Influence::Inverse)
        .memory(Memory::Path)
        .keys(&MODULI)
        .number("yield_stress", Dimension::PRESSURE, Bounds::POSITIVE, "Yield stress σ_y in tension (von Mises).")
        .keys(&[HARDENS])
    }

    fn linear(parameters: &Parameters) -> Result<LawSpec, String> {
        descriptor::moduli(parameters).map(LawSpec::Lps)
    }

    fn make(d: usize, plane: Plane, materials: &[Given]) -> Result<Self, (usize, String)> {
        let of = |m: &Given| {
            let number = |key| m.parameters.number(key).unwrap_or(0.0);
            Ok(ElasticPlasticConstants {
                solid: { m.solid }.ok_or("an elastic-plastic solid needs its moduli")?,
                section: section::of(d, plane, &descriptor::moduli(m.parameters)?),
                weighted_volume: m.weighted_volume,
                yield_stress: number("yield_stress"),
                hardening: number("hardening"),
            })
        };
        let materials = descriptor::each(materials, of)?;
        Ok(ElasticPlastic { materials })
    }
}
