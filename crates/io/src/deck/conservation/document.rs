//! The deck of a conservation law as written.

use crate::deck::document::{UnitName, Units};
use crate::deck::units::Dim;
use crate::deck::value::{At, Number, Or, Vector, Written};
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
    /// What plain numbers mean: "si" when left out.
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
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<Number>,
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
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub x: At<[Number; 2]>,
    /// Of a plane.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub y: Option<At<[Number; 2]>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoundaryName {
    Periodic,
}

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

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Transport {
    /// "burgers" (u²/2 of the mean of both ends), "energy_conserving" ((u² + uv + v²)/6), { linear = SPEED }, { polynomial = [c0, c1, …] } or { expression = "sin(u)" }.
    pub flux: At<Or<FluxName, FluxForm>>,
    /// Odd; its first moment is 2.
    pub kernel: At<KernelForm>,
    /// Its own, instead of that of the deck.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<Number>,
    /// Where it carries: components, which may depend on x and y; along x when left out.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub direction: Option<Vector>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FluxName {
    Burgers,
    EnergyConserving,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluxForm {
    /// The speed c of ψ = c u.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub linear: Option<Number>,
    /// ψ = c0 + c1 u + c2 u² + …, up to u⁸.
    #[schemars(extend("dimension" = Dim::VELOCITY.name()))]
    pub polynomial: Option<At<Vec<Number>>>,
    /// ψ as an expression of u, in plain numbers of the deck. Polynomials up to u⁸ are found and expanded, the rest is evaluated many values at a time.
    pub expression: Option<At<String>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spreading {
    /// ε
    #[schemars(extend("dimension" = (Dim::AREA / Dim::TIME).to_string()))]
    pub viscosity: Number,
    /// Even; its second moment is 2.
    pub kernel: At<KernelForm>,
    /// Its own, instead of that of the deck.
    #[schemars(extend("dimension" = Dim::LENGTH.name()))]
    pub horizon: Option<Number>,
}

/// A kernel of z = y − x, 0 beyond the horizon.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KernelForm {
    /// Of transport: −2b′ of this bump b; of diffusion as `form` says.
    pub bump: Option<BumpName>,
    /// p of the bump (1 − s²)^p; 2 when left out.
    pub power: Option<At<u32>>,
    /// Of diffusion: value when left out.
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

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawRun {
    /// Until t is this.
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub duration: Number,
    /// A time, or { safety = 0.8 } of what is stable, step by step (when left out), or shorter where `tolerance` asks for it.
    #[schemars(extend("dimension" = Dim::TIME.name()))]
    pub time_step: Option<At<Or<Written, LawSafety>>>,
    /// What steps may add to u until the end, over its largest |u|: 1e-6 when left out, from 1e-12 on; inf: steps are as long as they are stable. Not beside a time_step that is a time. What they do add is estimated in any case.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub tolerance: Option<Number>,
    /// Run even if the step is above the stability limit.
    #[serde(default)]
    pub force_unstable: bool,
    /// rk4 when left out.
    pub method: Option<MethodName>,
    /// auto when left out: the faster one.
    pub evaluation: Option<At<EvaluationName>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawSafety {
    /// Part of what is stable, above 0, at most 1.
    #[schemars(extend("dimension" = Dim::NUMBER.name()))]
    pub safety: Number,
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

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawOutput {
    /// Folder of the results, relative to the deck; when left out, out/NAME in the working folder for the deck NAME.toml.
    pub dir: Option<String>,
    /// Frames of frames.npz after the first, at equal times; 100 when left out.
    pub frames: Option<At<u64>>,
    /// Rows of history.csv after the first, at equal times; 100 when left out.
    pub history: Option<At<u64>>,
    /// The solution of the local law u_t + f(u)_x = ε u_xx, to which the nonlocal one tends, beside u: `exact` in frames.npz, dashed in the profiles, and how far u is from it, over
    /// it, in the mean, the mean square and at most (`error_l1`, `error_l2`, `error_max` of history.csv, a line at the end). Refused where there is none. On a line.
    pub compare: Option<At<CompareName>>,
    /// Noll's flux, what flows through the faces of the cells, in frames.npz: `flux`, of places `faces`; u_t is −1 times its differences over the spacing. On a line; false when left out.
    pub flux: Option<At<bool>>,
    /// space_time.png (in a plane: last.png) and profiles.png; true when left out.
    pub pictures: Option<bool>,
    /// report.html at the end, the run in one file for browsers; true when left out.
    pub report: Option<bool>,
}
