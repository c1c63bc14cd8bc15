//! What plain numbers mean.

use crate::deck::units::{Constants, UnitSystem};
use crate::deck::value::At;
use schemars::JsonSchema;
use serde::Deserialize;

/// What plain numbers of a deck mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitName {
    /// m, kg, s
    Si,
    /// Å, ps, eV; masses in g/mol, densities in g/cm³, pressures in bar. Computed in Å, ps, eV throughout.
    Metal,
    /// Reduced units; numbers carry none.
    Lj,
    /// Any consistent units; numbers carry none.
    None,
}

impl UnitName {
    pub fn system(self, constants: Constants) -> UnitSystem {
        match self {
            UnitName::Si => UnitSystem::Si,
            UnitName::Metal => UnitSystem::Metal(constants),
            UnitName::Lj => UnitSystem::Lj,
            UnitName::None => UnitSystem::None,
        }
    }
}

/// A system of units, and the physical constants of metal.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Name of the system.
    pub system: UnitName,
    /// Of metal: codata2018 by default; lammps gives LAMMPS's kinetic energies, temperatures and pressures.
    pub constants: Option<At<Constants>>,
}
