//! The deck of a conservation law as written.

use crate::deck::document::{UnitName, Units};
use crate::deck::quantity::{Diffusivity, Length, Positive, Time, Velocity};
use crate::deck::value::{At, Measured, Number, Or, Quantity, Vector};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KindName {
    ConservationLaw,
}

/// A deck of a nonlocal conservation law, u_t + ∫ ψ((u(y) + u(x))/2) φ_a(y − x) dy = ε ∫ (u(y) − u(x)) φ_s(y − x) dy.
///
/// Numbers are plain (in the deck's units), carry a unit ("0.5 mm"), or are expressions of the constants.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawDocument {
    /// Says that this is a conservation law: "conservation_law".
    pub kind: KindName,
    /// One line for headers and pictures.
    pub title: Option<String>,
    /// What plain numbers mean: "si" by default.
    pub units: Option<At<Or<UnitName, Units>>>,
    /// Named numbers for use in any number.
    #[serde(default)]
    pub constants: BTreeMap<String, Number>,
    /// The line or the rectangle on which u lives.
    pub domain: At<Domain>,
    /// Points along x; cells of a plane are squares.
    pub points: At<usize>,
    /// "periodic", or what u is in the collars beyond the ends: { left = "1", right = "0" } on a line, { around = "0" } in a plane.
    pub boundary: At<Or<BoundaryName, Collars>>,
    /// δ, of both kernels.
    pub horizon: Option<Quantity<Positive<Length>>>,
    /// u at t = 0, of x (in a plane of x and y).
    #[schemars(extend("dimension" = "that of u"))]
    pub initial: Number,
    /// Transport; left out, there is diffusion alone.
    pub advection: Option<At<Transport>>,
    /// The regularization ε ∫ (u(y) − u(x)) φ_s dy.
    pub diffusion: Option<At<Spreading>>,
    /// How long and how.
    pub run: At<LawRun>,
    /// Files of the results.
    #[serde(default)]
    pub output: LawOutput,
}

/// From where to where.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Lower and upper end.
    pub x: At<[Quantity<Length>; 2]>,
    /// Of a plane.
    pub y: Option<At<[Quantity<Length>; 2]>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoundaryName {
    /// The grid goes on from its other end.
    Periodic,
}

/// What u is outside of a grid that does not go on periodically: a boundary condition on a collar as wide as the horizon.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Collars {
    /// Below the lower end of a line, of x and t.
    #[schemars(extend("dimension" = "that of u"))]
    pub left: Option<Number>,
    /// Above the upper end, of x and t.
    #[schemars(extend("dimension" = "that of u"))]
    pub right: Option<Number>,
    /// Around a rectangle, of x, y and t.
    #[schemars(extend("dimension" = "that of u"))]
    pub around: Option<Number>,
}

/// The transport term: flux, kernel, direction.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Transport {
    /// "burgers" (u²/2 of the mean of both ends), "energy_conserving" ((u² + uv + v²)/6), { linear = SPEED }, { polynomial = [c0, c1, …] } or { expression = "sin(u)" }.
    pub flux: At<Or<FluxName, FluxForm>>,
    /// Odd; its first moment is 2.
    pub kernel: At<KernelForm>,
    /// Its own, instead of that of the deck.
    pub horizon: Option<Quantity<Positive<Length>>>,
    /// Where it carries: components, which may depend on x and y; along x by default.
    pub direction: Option<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FluxName {
    /// u²/2 of the mean of both ends.
    Burgers,
    /// (u² + uv + v²)/6, which conserves ∫u², too.
    EnergyConserving,
}

/// The flux ψ, in one of these ways.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluxForm {
    /// The speed c of ψ = c u.
    pub linear: Option<Quantity<Velocity>>,
    /// ψ = c0 + c1 u + c2 u² + …, up to u⁸.
    pub polynomial: Option<At<Vec<Quantity<Velocity>>>>,
    /// ψ as an expression of u, in plain numbers of the deck. Polynomials up to u⁸ are found and expanded, the rest is evaluated many values at a time.
    pub expression: Option<At<String>>,
}

/// The diffusion term: viscosity and kernel.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spreading {
    /// ε
    pub viscosity: Quantity<Diffusivity>,
    /// Even; its second moment is 2.
    pub kernel: At<KernelForm>,
    /// Its own, instead of that of the deck.
    pub horizon: Option<Quantity<Positive<Length>>>,
}

/// A kernel of z = y − x, 0 beyond the horizon.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KernelForm {
    /// Of transport: −2b′ of this bump b; of diffusion as `form` says.
    pub bump: Option<BumpName>,
    /// p of the bump (1 − s²)^p; 2 by default.
    pub power: Option<At<u32>>,
    /// Of diffusion: value by default.
    pub form: Option<At<FormName>>,
    /// An expression of z and delta (the horizon), in plain numbers of the deck.
    pub expression: Option<At<String>>,
    /// Points [z, φ] between which lines are drawn.
    pub table: Option<At<Vec<[Number; 2]>>>,
    /// Bring an expression or a table to the moment 2 by a positive factor.
    #[serde(default)]
    pub normalise: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BumpName {
    /// 1 − s
    Hat,
    /// (1 + cos πs)/2
    Cosine,
    /// (1 − s²)^power
    Polynomial,
    /// exp(−1/(1 − s²))
    Smooth,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FormName {
    /// b itself: not negative.
    Value,
    /// −2b′/z: not negative.
    SlopeOverDistance,
    /// b″, mollified +δ″: changes its sign, and is refused where it makes waves grow.
    SecondDerivative,
}

/// How long, with which method, and how closely.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawRun {
    /// Until t is this.
    pub duration: Quantity<Positive<Time>>,
    /// A time, or a part of what is stable, step by step, or shorter where `tolerance` asks for it; { safety = 0.8 } by default.
    pub time_step: Option<At<Or<Measured<Positive<Time>>, LawSafety>>>,
    /// What steps may add to u until the end, over its largest |u|: 1e-6 by default, from 1e-12 on; inf: steps are as long as they are stable. Not beside a time_step that is a time. What they do add is estimated in any case.
    pub tolerance: Option<Quantity>,
    /// Run even if the step is above the stability limit.
    #[serde(default)]
    pub force_unstable: bool,
    /// Method of the steps in time; rk4 by default.
    pub method: Option<MethodName>,
    /// auto by default: the faster one.
    pub evaluation: Option<At<EvaluationName>>,
}

/// The time step as a part of what is stable.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawSafety {
    /// Part of what is stable, above 0, at most 1.
    pub safety: Quantity<Positive>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MethodName {
    /// Strong-stability-preserving Runge–Kutta of order 3.
    Ssprk3,
    /// The classical Runge–Kutta method of order 4.
    Rk4,
    /// Diffusion implicit, order 2: for large ε.
    Imex,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EvaluationName {
    /// The faster one.
    Auto,
    /// Sums over bonds.
    Direct,
    /// Fourier transforms: periodic grids, fluxes that are polynomials (expressions too).
    Fourier,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CompareName {
    /// u = g(x − t f′(u)): without diffusion, from what does not jump, before the first shock.
    Characteristics,
    /// The entropy solution of Riemann's problem: without diffusion, from one step between two constants, in collars.
    Riemann,
    /// Cole and Hopf's solution: with diffusion, of a flux that is quadratic in u.
    ColeHopf,
}

/// Which files a run writes, how often.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawOutput {
    /// Folder of the results, relative to the deck; out/NAME for NAME.toml, in the working folder, by default.
    pub dir: Option<String>,
    /// Frames of frames.npz after the first, at equal times; 100 by default.
    pub frames: Option<At<u64>>,
    /// Rows of history.csv after the first, at equal times; 100 by default.
    pub history: Option<At<u64>>,
    /// The solution of the local law u_t + f(u)_x = ε u_xx, to which the nonlocal one tends, beside u: `exact` in frames.npz, dashed in the profiles, and how far u is from it, over
    /// it, in the mean, the mean square and at most (`error_l1`, `error_l2`, `error_max` of history.csv, a line at the end). Refused where there is none. On a line.
    pub compare: Option<At<CompareName>>,
    /// Noll's flux, what flows through the faces of the cells, in frames.npz: `flux`, of places `faces`; u_t is −1 times its differences over the spacing. On a line; false by default.
    pub flux: Option<At<bool>>,
    /// space_time.png (in a plane: last.png) and profiles.png; true by default.
    pub pictures: Option<bool>,
    /// report.html at the end, the run in one file for browsers; true by default.
    pub report: Option<bool>,
}
