//! The tag of LAMMPS's files of potentials: `UNITS: real` in a comment at the head says what the numbers are in. Without one they are in
//! eV, Å and g/mol.

use super::error::ReadError;
use std::path::Path;

/// Units of a file (SI); reduced ones have no size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    pub length: f64,
    pub energy: f64,
    /// Of a mass.
    pub mass: f64,
}

const EV: f64 = 1.602176634e-19;
const DALTON: f64 = 1e-3 / 6.02214076e23;

/// Names of LAMMPS's systems of units, and their sizes: Howto of its manual, command `units`.
const SYSTEMS: [(&str, Option<Sizes>); 8] = [
    ("metal", size(1e-10, EV, DALTON)),
    // kcal/mol
    ("real", size(1e-10, 4184.0 / 6.02214076e23, DALTON)),
    ("si", size(1.0, 1.0, 1.0)),
    ("cgs", size(1e-2, 1e-7, 1e-3)),
    // hartree and bohr, CODATA 2018
    (
        "electron",
        size(5.29177210903e-11, 4.3597447222071e-18, DALTON),
    ),
    ("micro", size(1e-6, 1e-15, 1e-15)),
    ("nano", size(1e-9, 1e-21, 1e-21)),
    ("lj", None),
];

const fn size(length: f64, energy: f64, mass: f64) -> Option<Sizes> {
    Some(Sizes {
        length,
        energy,
        mass,
    })
}

/// What eV, Å and g/mol are.
pub const METAL: &str = "metal";

/// Sizes of a system; `None`: there is none of this name.
pub fn sizes(name: &str) -> Option<Option<Sizes>> {
    { SYSTEMS.iter() }
        .find(|(n, _)| *n == name)
        .map(|(_, s)| *s)
}

/// All names.
pub fn names() -> String {
    SYSTEMS.map(|(name, _)| name).join(", ")
}

/// The word after the tag, in the first of these comments that has one.
pub fn of_comments<'a>(comments: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const TAG: &str = "UNITS:";
    comments.into_iter().find_map(|line| {
        let rest = &line[line.find(TAG)? + TAG.len()..];
        rest.split_whitespace().next()
    })
}

/// Of a file of entries: of the comments before the first.
///
/// # Errors
/// It cannot be read.
pub fn of_entries(path: &Path) -> Result<Option<String>, ReadError> {
    let (text, _) = super::whole::text_of(path)?;
    let head = text.lines().map(str::trim);
    let head = head.take_while(|l| l.is_empty() || l.starts_with('#'));
    Ok(of_comments(head).map(str::to_string))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_are_found_at_the_head() {
        let line = "# DATE: 2020-01-01 UNITS: real CONTRIBUTOR: A. Nobody";
        assert_eq!(of_comments(["# words", line]), Some("real"));
        assert_eq!(of_comments(["# units metal", "# UNITS:"]), None);
        let real = sizes("real").flatten().unwrap();
        // what LAMMPS takes for an eV in kcal/mol, to its digits
        assert!((EV / real.energy - 23.060549).abs() < 2e-6);
        assert_eq!(sizes("lj"), Some(None));
        assert_eq!(sizes("imperial"), None);
    }
}
