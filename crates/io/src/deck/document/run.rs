//! How a body moves or comes to rest, and what is measured of it.

use super::{ControlName, MeasureName};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Vector, Written};
use peridyne::spec::{Integrator, Method, Stepper};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use serde_json::json;
use std::borrow::Cow;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Number of time steps.
    pub steps: Option<At<u64>>,
    /// Instead of steps.
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub duration: Option<Number>,
    /// A time, or { safety = 0.8 } of the estimated limit (when left out).
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub time_step: Option<At<Or<Written, Safety>>>,
    /// Run even if the step is above the stability limit.
    #[serde(default)]
    pub force_unstable: bool,
    /// verlet when left out. newmark and hht are implicit: stable at any step, which must be given; bonds break at the end of a step. still: no
    /// point moves while heat or a species spreads.
    pub integrator: Option<At<IntegratorName>>,
    /// newmark: 1/4 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub beta: Option<Number>,
    /// newmark: 1/2 when left out; more damps what is fast beside the step.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub gamma: Option<Number>,
    /// hht: -0.1 when left out, from -1/3 (most damping of what is fast) to 0 (none); sets beta and gamma.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub alpha: Option<Number>,
    /// newmark, hht: auto when left out, factors of small systems, conjugate gradients of large ones.
    pub solver: Option<At<SolverName>>,
    /// newmark, hht: residual force over loads, reactions and inertia; 1e-10 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub tolerance: Option<Number>,
    /// newmark, hht: iterations of conjugate gradients; 100,000 when left out.
    pub iterations: Option<At<usize>>,
    /// All cores when left out; results do not depend on it.
    pub threads: Option<At<usize>>,
}

/// When a bond past its critical stretch lets go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ReleaseName {
    /// In the force evaluation that finds it there, as in CabanaPD.
    AtOnce,
    /// After the force of that evaluation, as in LAMMPS: it pulls once more.
    AfterForce,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Statics {
    /// linear (about the reference) when left out, newton before [run]; newton for large deformation, relaxation or fire for contact.
    pub method: Option<MethodName>,
    /// load when left out; breaking follows bond after bond, also where load and displacement fall (snap-back), with method = "linear";
    /// opening and arc_length follow softening and large deformation there, with method = "newton".
    pub control: Option<At<ControlName>>,
    /// control = "opening": growth of the stretch of the bonds that open fastest, per increment. A part of the critical stretch less that
    /// at which bonds begin to soften, a tenth, say.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub opening: Option<Number>,
    /// control = "arc_length": how far points go in an increment, the root of the mean square of all.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub arc_length: Option<Number>,
    /// auto when left out: factors of small systems, conjugate gradients of large ones.
    pub solver: Option<SolverName>,
    /// Increments of load while t goes from 0 to 1 (or to `duration`); 1 when left out, and 0 looks at modes only. With control =
    /// "breaking" so many equilibria, in each of which the next bonds are about to break.
    pub increments: Option<At<u64>>,
    /// Increments are cycles of load, for materials with fatigue: conditions are the greatest load and stay as they are.
    pub cycles: Option<At<LoadCycles>>,
    /// t is a time that goes to this one, in which heat or a species spreads; t is a number that goes to 1 when left out. Before [run] the
    /// stage is as long in records, which count time from the beginning of motion; when left out an increment is as long as a step.
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub duration: Option<Number>,
    /// Residual force over loads and reactions; 1e-10 when left out, 1e-8 with newton, 1e-6 with relaxation.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub tolerance: Option<Number>,
    /// Iterations of conjugate gradients or of relaxation; 100,000 when left out.
    pub iterations: Option<At<usize>>,
    /// So many lowest modes of vibration about the last state, before [run] those of the motion that follows; modes.csv and modes.pvd.
    pub modes: Option<At<usize>>,
    /// All cores when left out; results do not depend on it.
    pub threads: Option<At<usize>>,
}

/// Every increment is as many cycles as it takes until some bonds are worn out.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadCycles {
    /// Least over greatest load, R, from -1 to below 1; 0 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub load_ratio: Option<Number>,
    /// Bonds that are worn out in an increment, with those that last no longer; 1 when left out.
    pub bonds: Option<At<usize>>,
    /// Number of cycles after which no bond wears any more; no end when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub most: Option<Number>,
}

/// A method of the engine's list.
#[derive(Debug, Clone, Copy)]
pub struct MethodName(pub Method);

/// An integrator of the engine's list.
#[derive(Debug, Clone, Copy)]
pub struct IntegratorName(pub Integrator);

/// The one of a list that a deck names.
fn named<'de, D: Deserializer<'de>, T: Copy>(
    deserializer: D,
    all: &[T],
    name: impl Fn(&T) -> &'static str,
) -> Result<T, D::Error> {
    let word = String::deserialize(deserializer)?;
    let found = all.iter().find(|x| name(x) == word);
    found.copied().ok_or_else(|| {
        let known: Vec<String> = all.iter().map(|x| format!("`{}`", name(x))).collect();
        let known = known.join(", ");
        D::Error::custom(format!("unknown variant `{word}`, expected one of {known}"))
    })
}

impl<'de> Deserialize<'de> for MethodName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        named(deserializer, &Method::ALL, |m| m.name()).map(MethodName)
    }
}

impl<'de> Deserialize<'de> for IntegratorName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        named(deserializer, &Stepper::integrators(), |i| i.name).map(IntegratorName)
    }
}

/// The schema of a word: each with what it means.
fn words(all: &[(&str, &str)]) -> Schema {
    let each = all
        .iter()
        .map(|(name, doc)| json!({ "type": "string", "const": name, "description": doc }));
    json_schema!({ "oneOf": each.collect::<Vec<_>>() })
}

impl JsonSchema for MethodName {
    fn schema_name() -> Cow<'static, str> {
        "MethodName".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        words(&Method::ALL.map(|m| (m.name(), m.words())))
    }
}

impl JsonSchema for IntegratorName {
    fn schema_name() -> Cow<'static, str> {
        "IntegratorName".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        words(&Stepper::integrators().map(|i| (i.name, i.doc)))
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolverName {
    Auto,
    Direct,
    Cg,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Safety {
    /// Part of the estimated limit of stability, above 0, at most 1.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub safety: Number,
}

/// A measurement of a set of points; its columns of history.csv begin with its name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Its columns of history.csv begin with it.
    pub name: At<String>,
    /// All points when left out.
    pub set: Option<At<String>>,
    /// What is measured.
    pub measure: At<MeasureName>,
    /// Field that is measured (`peridyne laws` lists them); of mean, min, max, sum and value. Of an indenter one of force, torque, center, velocity,
    /// turn, spin, energy; all when left out.
    pub of: Option<At<String>>,
    /// x, xy, … or magnitude; all components when left out.
    pub component: Option<At<String>>,
    /// Name of an [[indenter]]; of the measure of that name.
    pub indenter: Option<At<String>>,
    /// Fixed point of a moment.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub about: Option<Vector>,
    /// Place in the reference; of value.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub at: Option<Vector>,
    /// Two opposite corners of a rectangle around the tip of a crack, three horizons to every side at least; of contour.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub corners: Option<At<Vec<Vector>>>,
    /// Where the crack grows to; of contour and crack_tip, [1, 0] when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub direction: Option<Vector>,
    /// Where the crack starts, in the reference: damage counts that is connected with it by steps of at most a horizon; of crack_tip.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub from: Option<Vector>,
    /// Points with at least this damage are part of the crack, above 0, at most 1; of crack_tip, 0.3 when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub damage: Option<Number>,
    /// Two places in the reference: the points nearest to them are measured; of opening.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub between: Option<At<Vec<Vector>>>,
    /// Fragments of fewer points do not count, 1 when left out; of fragments.
    pub points: Option<At<u32>>,
}
