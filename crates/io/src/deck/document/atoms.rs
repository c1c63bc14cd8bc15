//! Interatomic potentials and temperature, as written.

use crate::deck::value::{At, Number};
use schemars::JsonSchema;
use serde::Deserialize;

/// `4ε [(σ/r)¹² − (σ/r)⁶]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LennardJones {
    pub epsilon: Number,
    pub sigma: Number,
    /// Needed where neighbours are the current ones.
    pub cutoff: Option<Number>,
    pub end: Option<EndName>,
    /// Where a smooth end begins; 0.9 of the cut-off when left out.
    pub smooth_from: Option<Number>,
}

/// `D [e^(−2α(r − r0)) − 2 e^(−α(r − r0))]`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Morse {
    pub depth: Number,
    /// Inverse length.
    pub alpha: Number,
    pub distance: Number,
    pub cutoff: Option<Number>,
    pub end: Option<EndName>,
    pub smooth_from: Option<Number>,
}

/// `A e^(−r/ρ) − C/r⁶`
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Buckingham {
    pub strength: Number,
    pub range: Number,
    /// Energy times length⁶.
    pub dispersion: Number,
    pub cutoff: Option<Number>,
    pub end: Option<EndName>,
    pub smooth_from: Option<Number>,
}

/// Embedded-atom model from a table: eam/alloy (setfl) or eam (funcfl).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Eam {
    /// Relative to the deck; names that end in .eam are funcfl files. In eV and Å.
    pub file: At<String>,
    /// Needed where the file has several.
    pub element: Option<At<String>>,
    /// Lengths of the table are multiplied by this; 1 when left out.
    pub length_scale: Option<Number>,
    /// Energies of the table are multiplied by this; 1 when left out.
    pub energy_scale: Option<Number>,
}

/// Embedded-atom model in closed form (Mei, Davenport & Fernando 1991, with a cut-off function).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EamForm {
    pub cohesive: Number,
    /// Energy of the pair term.
    pub pair: Number,
    pub alpha: Number,
    pub beta: Number,
    pub gamma: Number,
    pub lambda: Number,
    /// c_0 to c_5.
    pub density: At<Vec<Number>>,
    /// f_e/ρ_e
    pub density_scale: Number,
    /// Nearest distance of the crystal at equilibrium; the lattice's when left out.
    pub nearest: Option<Number>,
    /// Length scale μ of the pair term in nearest distances; 1 when left out.
    pub pair_length: Option<Number>,
    /// Length scale of the density in nearest distances; 1 when left out.
    pub density_length: Option<Number>,
    /// What the shells' distances are multiplied by in the embedding energy; 1/pair_length when left out.
    pub shell_scale: Option<Number>,
    /// Where the cut-off function begins to fall, and where it is 0, in nearest distances.
    pub near: Number,
    pub cutoff: Number,
}

/// Velocities of a given temperature.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// In kelvin; k_B T, an energy, in reduced or no units.
    pub temperature: Number,
    pub seed: u64,
}

/// How a pair potential ends at its cut-off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EndName {
    /// Cut (when left out).
    Truncated,
    /// No jump of the energy.
    Shifted,
    /// No jump of the force either.
    ShiftedForce,
    /// Switched off smoothly.
    Smooth,
}
