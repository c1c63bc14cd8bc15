//! Temperatures, as written.

use crate::deck::quantity::{Positive, Temperature};
use crate::deck::value::Quantity;
use schemars::JsonSchema;
use serde::Deserialize;

/// Velocities of a given temperature.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// In kelvin; k_B T, an energy, in reduced or no units. An expression of x, y, z at the start: "300 K + 30 K * cos(2*pi*x/80)".
    pub temperature: Quantity<Positive<Temperature>>,
    /// The same number gives the same velocities.
    pub seed: u64,
}
