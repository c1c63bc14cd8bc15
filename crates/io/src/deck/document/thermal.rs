//! Temperatures, as written.

use crate::deck::value::Number;
use schemars::JsonSchema;
use serde::Deserialize;

/// Velocities of a given temperature.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// In kelvin; k_B T, an energy, in reduced or no units.
    pub temperature: Number,
    pub seed: u64,
}
