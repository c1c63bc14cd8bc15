//! Metals and soils that flow: the rate form of [`hypoelastic`](super::hypoelastic) with a yield surface that depends on the stress
//! deviator and the pressure, hardens, feels rate and heat ([`hardening`]), and is damaged.
//!
//! With `q = √(3/2 s:s)` of the deviator s and the mean stress p (tension positive), it yields where `q + a p = σ_y` (von Mises for a = 0,
//! Drucker & Prager 1952) and flows by `Δε^p = Δε̄ (3/2 s/q + ⅓ b 1)`. A step tries the elastic stress first and returns along the
//! flow (Wilkins 1964; Simo & Hughes 1998, 3.3): `q′ + a p′ − (3μ + aKb) Δε̄ = σ_y(ε̄ + Δε̄, Δε̄/Δt, T)`, in the plane with the deviator
//! across. Where that leaves no deviator the stress is the apex, `p = σ_y(ε̄ + q′/3μ)/a`.
//!
//! With an [equation of state](super::equation_of_state) the mean stress is `−p(J, E) − q` of the volume and of the internal energy E, which is all work that
//! was done on the point, and the viscosity of shocks: metals under impact (Wilkins 1964). Flow then is von Mises's.
//!
//! Plastic work, by the trapezoidal rule, is what is dissipated; a part β of it heats the point, `ρ c ΔT = β Δw_p`, which keeps that heat or gives it to a body that
//! conducts it ([`Classical::temperature`]). A step flows at the temperature of its start. Damage of Johnson & Cook (1985):
//! `ΔD = Δε̄/ε_f`, `ε_f = (D₁ + D₂ exp(D₃ p/q)) (1 + D₄ ln(ε̄̇/ε̇₀)) (1 + D₅ T*)`; what it does to bonds is a matter of their fracture.

mod registered;

use super::equation_of_state::{self, EquationOfState};
use super::hardening::{self, Hardening, Kind};
use super::rate::{self, Increment, Step};
use super::{Classical, Stressed, Unseen};
use crate::columns::{Declaration, Dimension, Shape};
use crate::law::material::tensor::{self, Matrix};
use crate::law::number::Number;

/// Constants of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HypoelasticPlasticConstants {
    /// Lamé's λ and shear modulus μ.
    pub lame: f64,
    pub shear: f64,
    /// a and b (–).
    pub friction: f64,
    pub dilatancy: f64,
    /// Rise of the temperature by plastic work, β/(ρ c) (temperature / pressure).
    pub heating: f64,
    /// D₁ to D₅.
    pub damage: [f64; 5],
    pub hardening: Hardening,
    pub state: EquationOfState,
}

/// See the module. All materials have the same kind of increment, of hardening and of equation of state.
#[derive(Debug, Clone)]
pub struct HypoelasticPlastic {
    pub increment: Increment,
    pub kind: Kind,
    /// In the plane: are its faces free?
    pub sheet: bool,
    /// Do they have damage?
    pub damages: bool,
    pub state: equation_of_state::Kind,
    /// Per material.
    pub materials: Vec<HypoelasticPlasticConstants>,
}

const LAME: usize = 0;
const SHEAR: usize = 1;
const FRICTION: usize = 2;
const DILATANCY: usize = 3;
const HEATING: usize = 4;
const DAMAGE: usize = 5;
type Constants<N> = (
    [N; 10],
    (hardening::Constants<N>, equation_of_state::Constants<N>),
);

/// Numbers that a point remembers.
const WORK: usize = 0;
const MEAN: usize = 1;
const STRAIN: usize = 2;
const PLASTIC_WORK: usize = 3;
const RISE: usize = 4;
const DAMAGED: usize = 5;
/// What the control has lost of its stiffness (–), `Σ ω ν V z²`, and the energy that went with it.
const SOFTENED: usize = 6;
const UNSEEN: usize = 7;
const LOST: usize = 8;
const SHOCK: usize = 9;
const ACROSS: usize = 10;
/// U − 1 and σ_u, and the rest.
type Past<N, const D: usize> = ([Matrix<N, D>; 2], [N; 11]);

/// Most steps of the search for Δε̄; from the elastic estimate it takes 2 to 8.
const STEPS: usize = 80;
/// Where that search begins to doubt, beside the largest possible.
const LEAST: f64 = 1e-30;
/// Triaxiality p/q beyond which damage is that of here.
const TRIAXIALITY: f64 = 10.0;

/// A trial stress.
struct Trial<N, const D: usize> {
    deviator: Matrix<N, D>,
    /// q and p of it.
    q: N,
    p: N,
}

/// `s:s` of a deviator, of which in the plane a part is across it.
#[inline(always)]
fn double<N: Number, const D: usize>(a: &Matrix<N, D>, b: &Matrix<N, D>) -> N {
    let inside = tensor::contraction(a, b);
    match D {
        2 => tensor::trace(a).fma(tensor::trace(b), inside),
        _ => inside,
    }
}

/// σ and what it is across a plane, from its mean.
#[inline(always)]
fn with_across<N: Number, const D: usize>(stress: &Matrix<N, D>, p: N) -> (&Matrix<N, D>, N) {
    (stress, N::constant(3.0) * p - tensor::trace(stress))
}

/// `σ − p 1`
#[inline(always)]
fn beside<N: Number, const D: usize>(stress: &Matrix<N, D>, p: N) -> Matrix<N, D> {
    let mut s = *stress;
    for a in 0..D {
        s[a][a] = s[a][a] - p;
    }
    s
}

/// How a step flows: Δε̄, what is left of the deviator (–), the mean stress, and the plastic part of the dilation.
struct Flow<N> {
    strain: N,
    rest: N,
    mean: N,
    dilation: N,
}

impl HypoelasticPlastic {
    /// The return from a trial stress.
    #[inline(always)]
    fn flow<N: Number, const D: usize>(
        &self,
        (c, (hard, _)): &Constants<N>,
        memory: &[N; 11],
        trial: &Trial<N, D>,
    ) -> Flow<N> {
        let (zero, one, third) = (N::constant(0.0), N::constant(1.0), N::constant(1.0 / 3.0));
        let elastic = Flow {
            strain: zero,
            rest: one,
            mean: trial.p,
            dilation: zero,
        };
        let kind = self.kind;
        let soft = kind.softened(hard, memory[RISE]);
        let along = c[FRICTION].fma(trial.p, trial.q);
        let begins = kind.begins(hard, memory[STRAIN], soft);
        // above 0: it flows
        let beyond = zero.choose(kind.flows(hard), along - begins, zero);
        if !(zero - beyond).any_below(0.0) {
            return elastic;
        }
        let bulk = (N::constant(2.0) * third).fma(c[SHEAR], c[LAME]);
        let triple = N::constant(3.0) * c[SHEAR];
        let stiff = (c[FRICTION] * bulk).fma(c[DILATANCY], triple);
        let (mut high, mut x) = (along.div(stiff), beyond.div(stiff));
        // lanes that do not flow look for something that they find at once
        let flows = zero.choose(beyond, one, zero);
        x = zero.choose(beyond, x, one);
        high = zero.choose(beyond, high, one);
        let mut low = N::constant(LEAST) * high;
        // 1 until it is found: what other lanes are still after changes no last digit of this one
        let mut sought = flows;
        for _ in 0..STEPS {
            let [y, slope] = kind.yields(hard, memory[STRAIN], x, soft);
            let over = flows * (along - stiff * x - y);
            low = zero.choose(over, x, low);
            high = zero.choose(over, high, x);
            let newton = x + over.div(stiff + slope);
            // where Newton leaves what is known, halve that on a scale of logarithms
            let half = (low * high).sqrt();
            let next = newton.choose(low, half, high.choose(newton, half, newton));
            let next = zero.choose(sought, next, x);
            let step = (next - x).most(x - next);
            x = next;
            sought = (N::constant(1e-14) * x - step).choose(zero, sought, zero);
            if !(zero - sought).any_below(0.0) {
                break;
            }
        }
        // the apex
        let deviator = triple * x;
        let all = trial.q.div(triple);
        let sharp = trial.q.choose(deviator, flows * c[FRICTION], zero);
        let at_apex = kind.yields(hard, memory[STRAIN], all, soft)[0].div(c[FRICTION]);
        let apex = |a: N, b: N| zero.choose(sharp, a, b);
        let strain = apex(all, x);
        let dilation = apex((trial.p - at_apex).div(bulk), c[DILATANCY] * x);
        let rest = apex(zero, one - deviator.div(trial.q));
        let pick = |a: N, b: N| zero.choose(flows, a, b);
        Flow {
            strain: pick(strain, zero),
            rest: pick(rest, one),
            mean: pick(trial.p - bulk * dilation, trial.p),
            dilation: pick(dilation, zero),
        }
    }

    /// The mean stress −p − q of the equation of state, and q, at the end of a step that has this deviator there.
    #[inline(always)]
    fn pressed<N: Number, const D: usize>(
        &self,
        c: &equation_of_state::Constants<N>,
        ([_, s0], memory): &Past<N, D>,
        (step, reach): (&Step<N, D>, N),
        deviator: &Matrix<N, D>,
    ) -> (N, N) {
        let (zero, one, half) = (N::constant(0.0), N::constant(1.0), N::constant(0.5));
        let (ends, volumes) = (step.dilations, step.volumes);
        let q = (self.state).viscosity(c, ends, memory[WORK], reach, memory[SHOCK]);
        let state = self.state.at(c, ends[1]);
        // E′ = E + the work of all but the new mean stress m, and ½ J′ m tr Δε of that: linear in m = −a − q − b E′
        let known =
            memory[WORK] + step.work(with_across(s0, memory[MEAN]), with_across(deviator, zero));
        let spread = half * volumes[1] * step.spread()[1];
        let mean = zero - (state.pressure(known) + q);
        (mean.div(state.per_energy.fma(spread, one)), q)
    }

    /// What a growth of the plastic strain adds to the damage, at this p/q.
    #[inline(always)]
    fn damaged<N: Number>(
        &self,
        (c, (hard, _)): &Constants<N>,
        rise: N,
        strain: N,
        triaxiality: N,
    ) -> N {
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        if !self.damages {
            return zero;
        }
        let most = N::constant(TRIAXIALITY);
        let triaxiality = triaxiality.least(most).most(zero - most);
        let d = |k: usize| c[DAMAGE + k];
        let shape = d(1).fma((d(2) * triaxiality).exp(), d(0));
        let quick = d(3).fma(hardening::rate(hard, strain), one);
        let hot = d(4).fma(hardening::homologous(hard, rise), one);
        zero.choose(strain, strain.div(shape * quick * hot), zero)
    }
}

impl<const D: usize> Classical<D> for HypoelasticPlastic {
    type Constants<N: Number> = Constants<N>;
    type Past<N: Number> = Past<N, D>;
    const POTENTIAL: bool = false;
    const ACROSS: bool = true;
    const SOFTENS: bool = true;

    fn columns(&self) -> Vec<Declaration> {
        let scalar =
            |name, dimension, doc| Declaration::of_points(name, Shape::Scalar, dimension, doc);
        let mut all = rate::columns();
        all.extend([
            scalar(
                "mean_stress",
                Dimension::PRESSURE,
                "Mean Cauchy stress ⅓ tr σ, tension positive, with that across a plane.",
            ),
            scalar(
                "plastic_strain",
                Dimension::NUMBER,
                "Equivalent plastic strain ε̄.",
            ),
            scalar(
                "plastic_work",
                Dimension::PRESSURE,
                "Plastic work per reference volume, ∫ J σ : D^p dt, which is dissipated.",
            ),
            scalar(
                "temperature_rise",
                Dimension::TEMPERATURE,
                "Temperature T − T_r above that of reference: by plastic work alone, β w_p/(ρ c), or that of a body that conducts heat.",
            ),
            scalar(
                "ductile_damage",
                Dimension::NUMBER,
                "D = ∫ dε̄/ε_f (Johnson & Cook 1985); at 1 it fails.",
            ),
            scalar(
                "control_softening",
                Dimension::NUMBER,
                "Part of the control's stiffness that flow has taken, 3με̄/(q + 3με̄).",
            ),
            scalar(
                "unseen_square",
                Dimension([5, 0, 0, 0]),
                "Σ ω ν V z² of the part z of the deformation that F does not see.",
            ),
            scalar(
                "control_loss",
                Dimension::PRESSURE,
                "Energy per reference volume that went with the control's stiffness, which is dissipated.",
            ),
            equation_of_state::column(),
        ]);
        if D == 2 {
            all.push(rate::across_column());
        }
        all
    }

    fn failure(&self) -> Option<usize> {
        // after U − 1 and the stress
        self.damages.then_some(2 * D * D + DAMAGED)
    }

    fn temperature(&self) -> Option<usize> {
        let heated = self.materials.iter().any(|m| m.heating > 0.0);
        (self.kind.heats || heated).then_some(2 * D * D + RISE)
    }

    fn constants(&self, material: usize, dt: f64) -> Constants<f64> {
        let m = &self.materials[material];
        let [d1, d2, d3, d4, d5] = m.damage;
        let own = [
            m.lame,
            m.shear,
            m.friction,
            m.dilatancy,
            m.heating,
            d1,
            d2,
            d3,
            d4,
            d5,
        ];
        (own, (m.hardening.constants(dt), m.state.constants(dt)))
    }

    fn shear(&self, material: usize) -> f64 {
        self.materials[material].shear
    }

    #[inline(always)]
    fn dissipated<N: Number>(&self, before: &Past<N, D>, after: &Past<N, D>) -> N {
        let lost = after.1[LOST] - before.1[LOST];
        (after.1[PLASTIC_WORK] - before.1[PLASTIC_WORK]) + lost
    }

    #[inline(always)]
    fn control<N: Number>(&self, past: &Past<N, D>) -> N {
        N::constant(1.0) - past.1[SOFTENED]
    }

    #[inline(always)]
    fn across<N: Number>(&self, ([stretch, s], memory): &Past<N, D>) -> N {
        let (_, across) = with_across(s, memory[MEAN]);
        across * (N::constant(1.0) + tensor::dilation(stretch))
    }

    fn is_sheet(&self) -> bool {
        self.sheet
    }

    #[inline(always)]
    fn thickness<N: Number>(&self, (_, memory): &Past<N, D>, _: N) -> N {
        memory[ACROSS]
    }

    #[inline(always)]
    fn stress<N: Number>(
        &self,
        constants: &Constants<N>,
        past: &Past<N, D>,
        h: &Matrix<N, D>,
        unseen: &Unseen<N>,
    ) -> Stressed<N, Past<N, D>, D> {
        let c = &constants.0;
        let ([before, s0], memory) = past;
        let (zero, half, two) = (N::constant(0.0), N::constant(0.5), N::constant(2.0));
        let step = Step::new(self.increment, (before, memory[ACROSS]), (h, unseen.across));
        // the elastic trial
        let [spread, _] = step.spread();
        let third = N::constant(1.0 / 3.0) * spread;
        let bulk = N::constant(2.0 / 3.0).fma(c[SHEAR], c[LAME]);
        let old = beside(s0, memory[MEAN]);
        let mut deviator = beside(&step.strain, third);
        for r in 0..D {
            for k in 0..D {
                deviator[r][k] = (two * c[SHEAR]).fma(deviator[r][k], old[r][k]);
            }
        }
        // at rest q has no slope: the least number has none either
        let square = N::constant(1.5) * double(&deviator, &deviator);
        let trial = Trial {
            q: square.most(N::constant(f64::MIN_POSITIVE)).sqrt(),
            p: bulk.fma(spread, memory[MEAN]),
            deviator,
        };
        let mut flow = self.flow(constants, memory, &trial);
        let mut s = trial.deviator;
        for r in 0..D {
            for k in 0..D {
                s[r][k] = flow.rest * trial.deviator[r][k];
            }
        }
        let mut shock = memory[SHOCK];
        if self.state != equation_of_state::Kind::Elastic {
            let wide = (&step, unseen.reach);
            (flow.mean, shock) = self.pressed(&constants.1.1, past, wide, &s);
        }
        let q = flow.rest * trial.q;
        // plastic work at both ends, Δε^p : s = 3/2 Δε̄ s′:s/q′
        let share = zero.choose(flow.strain, flow.strain.div(trial.q), zero);
        let direction = N::constant(1.5) * share * double(&trial.deviator, &old);
        let early = memory[MEAN].fma(flow.dilation, direction);
        let late = flow.mean.fma(flow.dilation, q * flow.strain);
        let plastic = half * (step.volumes[0] * early + step.volumes[1] * late);
        for a in 0..D {
            s[a][a] = s[a][a] + flow.mean;
        }
        let mut now = *memory;
        let work = step.work(with_across(s0, memory[MEAN]), with_across(&s, flow.mean));
        now[WORK] = memory[WORK] + work;
        now[ACROSS] = unseen.across;
        now[MEAN] = flow.mean;
        now[STRAIN] = memory[STRAIN] + flow.strain;
        now[PLASTIC_WORK] = memory[PLASTIC_WORK] + plastic;
        now[RISE] = c[HEATING].fma(plastic, memory[RISE]);
        // molten: no q
        let triaxiality = flow.mean.div(q.most(N::constant(f64::MIN_POSITIVE)));
        now[DAMAGED] =
            memory[DAMAGED] + self.damaged(constants, memory[RISE], flow.strain, triaxiality);
        // the secant modulus of shear, q/(q + 3με̄) of the elastic one
        let flown = N::constant(3.0) * c[SHEAR] * now[STRAIN];
        let soft = zero.choose(flow.strain, flown.div(q + flown), memory[SOFTENED]);
        now[SOFTENED] = soft.most(memory[SOFTENED]);
        now[UNSEEN] = unseen.square;
        // ½ Δg z z′, of second order
        let mean = half * (memory[UNSEEN] + unseen.square);
        let lost = half * unseen.stiffness * (now[SOFTENED] - memory[SOFTENED]) * mean;
        now[LOST] = memory[LOST] + lost;
        now[SHOCK] = shock;
        Stressed {
            stress: step.nominal(&s),
            across: step.nominal_across(with_across(&s, flow.mean).1),
            energy: now[WORK] - memory[PLASTIC_WORK] + lost,
            past: ([step.stretch, s], now),
        }
    }
}
