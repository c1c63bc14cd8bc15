//! Molecules, as written.

use crate::deck::value::At;
use schemars::JsonSchema;
use serde::Deserialize;

/// Bonds, angles, dihedrals and impropers of `body.file`, a LAMMPS data file whose sections of coefficients name their styles
/// (`Bond Coeffs # harmonic`).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Molecules {
    /// What is left of the potential between atoms that are one, two and three bonds apart; [0, 0, 0] by default.
    pub special: Option<At<Vec<f64>>>,
}
