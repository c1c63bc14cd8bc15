//! LAMMPS data files of `atom_style atomic`, `molecular` and `full`.

use super::atoms::{Atoms, Species};
use super::error::ReadError;
use super::lammps;
use super::lammps::{DataFile, Style};
use std::path::Path;

/// Reads the atoms, in order of the ids; species are named by the comments of `Masses`, else by the number of the type.
/// The file does not say which axes are periodic: all are.
///
/// # Errors
/// File and line of the first mistake; another atom style.
pub fn data(path: &Path) -> Result<Atoms, ReadError> {
    let (text, name) = super::whole::titled(path, 1)?;
    parse_data(&text, &name)
}

/// `units = metal` in the title, as LAMMPS writes it.
fn units(text: &str) -> Option<String> {
    let (_, rest) = text.lines().next()?.split_once("units = ")?;
    let word = rest.split(|c: char| !c.is_alphanumeric()).next();
    word.filter(|w| !w.is_empty()).map(str::to_string)
}

/// The same from a text; `name` is for messages.
pub fn parse_data(text: &str, name: &str) -> Result<Atoms, ReadError> {
    let file: DataFile = lammps::file(text, name)?;
    if file.style == Style::Peri {
        return Err(lammps::error(
            name,
            None,
            "the file is of atom_style peri; here atoms are read: id type x y z [ix iy iz]",
        ));
    }
    if file.types > 1 << 16 {
        let message = format!("{} atom types, of which 65536 are read", file.types);
        return Err(lammps::error(name, None, message));
    }
    let species = (0..file.types)
        .map(|t| {
            let mass = file.masses.get(t).cloned().flatten();
            let own = (t + 1).to_string();
            Species {
                name: mass.as_ref().and_then(|m| m.1.clone()).unwrap_or(own),
                mass: mass.map(|m| m.0),
            }
        })
        .collect();
    Ok(Atoms {
        species,
        kind: file.atoms.types.iter().map(|t| t - 1).collect(),
        position: file.atoms.position,
        velocity: file.atoms.velocity,
        low: file.low,
        high: file.high,
        periodic: [true; 3],
        bonded: file.bonded,
        units: units(text),
        ..Atoms::default()
    })
}
