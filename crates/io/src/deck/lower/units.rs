//! What plain numbers of a deck mean.

use super::context::{Context, Result};
use crate::deck::document::{Document, UnitName, Units};
use crate::deck::units::{Constants, UnitSystem};
use crate::deck::value::{At, Or};

/// What plain numbers of the deck mean.
pub(in crate::deck) fn units(document: &Document) -> UnitSystem {
    units_of(document.units.as_ref())
}

pub(in crate::deck) fn units_of(written: Option<&At<Or<UnitName, Units>>>) -> UnitSystem {
    match written.map(|u| &u.value) {
        None => UnitSystem::default(),
        Some(Or::Bare(name)) => name.system(Constants::default()),
        Some(Or::Table(u)) => {
            let constants = u.constants.as_ref().map(|c| c.value);
            u.system.system(constants.unwrap_or_default())
        }
    }
}

/// Only metal is made of measured constants.
pub(super) fn measured_constants(context: &Context, document: &Document) -> Result<()> {
    let written = document.units.as_ref().map(|u| &u.value);
    if let Some(Or::Table(u)) = written
        && let Some(constants) = &u.constants
        && !matches!(context.units, UnitSystem::Metal(_))
    {
        return Err(context.error_with(
            &constants.span,
            format!("units = \"{}\" takes no constants", context.units.name()),
            "constants are chosen for system = \"metal\": g/mol, bar and kelvin are made with them",
        ));
    }
    Ok(())
}
