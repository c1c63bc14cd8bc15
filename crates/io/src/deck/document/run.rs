//! How a body moves or comes to rest, and what is measured of it.

use super::{ControlName, MeasureName};
use crate::deck::quantity::{Hht, Length, LoadRatio, Part, Positive, Time};
use crate::deck::value::{At, Measured, Or, Quantity, Vector};
use peridyne::spec::{Integrator, Method, Stepper};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use serde_json::json;
use std::borrow::Cow;

/// Motion: how long, with which time step and integrator.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Number of time steps.
    pub steps: Option<At<u64>>,
    /// Instead of steps.
    pub duration: Option<Quantity<Positive<Time>>>,
    /// A time, or a part of the estimated limit; { safety = 0.8 } by default.
    pub time_step: Option<At<Or<Measured<Positive<Time>>, Safety>>>,
    /// Run even if the step is above the stability limit.
    #[serde(default)]
    pub force_unstable: bool,
    /// verlet by default. newmark and hht are implicit: stable at any step, which must be given; bonds break at the end of a step. none: no
    /// point moves while heat or a species spreads.
    pub integrator: Option<At<IntegratorName>>,
    /// newmark: 1/4 by default.
    pub beta: Option<Quantity<Positive>>,
    /// newmark: 1/2 by default; more damps what is fast beside the step.
    pub gamma: Option<Quantity<Positive>>,
    /// hht: -0.1 by default, from -1/3 (most damping of what is fast) to 0 (none); sets beta and gamma.
    pub alpha: Option<Quantity<Hht>>,
    /// newmark, hht: auto by default, factors of small systems, conjugate gradients of large ones.
    pub solver: Option<At<SolverName>>,
    /// newmark, hht: residual force over loads, reactions and inertia; 1e-10 by default.
    pub tolerance: Option<Quantity<Positive>>,
    /// newmark, hht: iterations of conjugate gradients; 100,000 by default.
    pub iterations: Option<At<usize>>,
    /// Threads to compute on, whose number no result depends on; all cores by default.
    pub threads: Option<At<usize>>,
}

/// When a bond past its critical stretch breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BreakageName {
    /// Before the force evaluation, in which it no longer acts, as in CabanaPD.
    BeforeForce,
    /// After the force evaluation, in which it acts once more, as in LAMMPS.
    AfterForce,
}

/// Equilibrium: method, load increments, and how closely it is solved.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Statics {
    /// linear (about the reference) by default, newton before [run]; newton for large deformation, relaxation or fire for contact.
    pub method: Option<MethodName>,
    /// load by default; sequentially_linear breaks one bond in each increment, also where load and displacement fall (snap-back), with method = "linear";
    /// indirect_displacement and arc_length follow softening and large deformation there, with method = "newton".
    pub control: Option<At<ControlName>>,
    /// control = "indirect_displacement": growth of the stretch of the bonds that open fastest, per increment. A part of the critical stretch less that
    /// at which bonds begin to soften, a tenth, say.
    pub opening: Option<Quantity<Positive>>,
    /// control = "arc_length": how far points go in an increment, the root of the mean square of all.
    pub arc_length: Option<Quantity<Positive<Length>>>,
    /// auto by default: factors of small systems, conjugate gradients of large ones.
    pub solver: Option<SolverName>,
    /// Increments of load while t goes from 0 to 1 (or to `duration`); 1 by default, and 0 looks at modes only. With control =
    /// "sequentially_linear" so many equilibria, in each of which the next bonds are about to break.
    pub increments: Option<At<u64>>,
    /// Increments are cycles of load, for materials with fatigue: boundary conditions are the greatest load and stay as they are.
    pub cycles: Option<At<LoadCycles>>,
    /// t is a time that goes to this one, in which heat or a species spreads; t is a number that goes to 1 by default. Before [run] the
    /// stage is as long in records, which count time from the beginning of motion; by default an increment is as long as a step.
    pub duration: Option<Quantity<Positive<Time>>>,
    /// Residual force over loads and reactions, of linear, newton and relaxation; 1e-10, 1e-8 and 1e-6 by default.
    pub tolerance: Option<Quantity<Positive>>,
    /// Iterations of conjugate gradients or of relaxation; 100,000 by default.
    pub iterations: Option<At<usize>>,
    /// So many lowest modes of vibration about the last state, before [run] those of the motion that follows; modes.csv and modes.pvd.
    pub modes: Option<At<usize>>,
    /// Threads to compute on, whose number no result depends on; all cores by default.
    pub threads: Option<At<usize>>,
}

/// Every increment is as many cycles as it takes until some bonds are worn out.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadCycles {
    /// Least over greatest load, R, from -1 to below 1; 0 by default.
    pub load_ratio: Option<Quantity<LoadRatio>>,
    /// Bonds that are worn out in an increment, with those that last no longer; 1 by default.
    pub bonds: Option<At<usize>>,
    /// Number of cycles after which fatigue damage stops; no end by default.
    pub most: Option<Quantity<Positive>>,
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
    /// Factors of small systems, conjugate gradients of large ones.
    Auto,
    /// Sparse factors.
    Direct,
    /// Conjugate gradients.
    Cg,
}

/// The time step as a part of the estimated limit of stability.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Safety {
    /// Part of the estimated limit of stability, above 0, at most 1.
    pub safety: Quantity<Positive>,
}

/// A measurement of a set of points; its columns of history.csv begin with its name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Its columns of history.csv begin with it.
    pub name: At<String>,
    /// Set that is measured; all points by default.
    pub set: Option<At<String>>,
    /// What is measured.
    pub measure: At<MeasureName>,
    /// Field that is measured (`peridyne laws` lists them); of mean, min, max, sum and value. Of a rigid body one of force, torque, center, velocity,
    /// rotation, angular_velocity, energy; all by default.
    pub of: Option<At<String>>,
    /// x, xy, … or magnitude; all components by default.
    pub component: Option<At<String>>,
    /// Name of a [[rigid_body]]; of the measure of that name.
    pub rigid_body: Option<At<String>>,
    /// Fixed point of a moment.
    pub about: Option<Vector<Length>>,
    /// Place in the reference; of value.
    pub at: Option<Vector<Length>>,
    /// Two opposite corners of a rectangle around the tip of a crack, three horizons to every side at least; of j_integral.
    pub corners: Option<At<Vec<Vector<Length>>>>,
    /// Where the crack grows to, of j_integral and crack_tip; [1, 0] by default.
    pub direction: Option<Vector>,
    /// Where the crack starts, in the reference: damage counts that is connected with it by steps of at most a horizon; of crack_tip.
    pub from: Option<Vector<Length>>,
    /// Points with at least this damage are part of the crack, above 0, at most 1, of crack_tip; 0.3 by default.
    pub damage: Option<Quantity<Part>>,
    /// Two places in the reference: the points nearest to them are measured; of opening.
    pub between: Option<At<Vec<Vector<Length>>>>,
    /// Fragments of fewer points do not count, of fragments; 1 by default.
    pub points: Option<At<u32>>,
}
