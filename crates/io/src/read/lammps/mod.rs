//! LAMMPS data files of `atom_style peri`: each point with its volume and density, the atom type as mark.

mod file;
mod lines;

use super::body::Sourced;
use super::error::ReadError;
use super::spacing::Spacing;
pub use file::{DataAtoms, DataFile, Masses, Style, read_data};
pub use lines::{FileError, Lines, Result, finite};
use peridyne::spec::Cloud;

/// Volumes beyond this, or below its inverse, are none.
const FACTOR: f64 = 100.0;
const GUESSED: &str = "the file does not say its atom_style: it is taken as peri, id type volume density x y z (`Atoms # peri` says so)";

pub(super) fn file(text: &str, name: &str) -> std::result::Result<DataFile, ReadError> {
    read_data(text.as_bytes(), name).map_err(|problem| {
        let line = problem.line.map(|l| l.0);
        let message = match &problem.help {
            Some(help) => format!("{} ({help})", problem.message),
            None => problem.message,
        };
        error(name, line, message)
    })
}

pub(super) fn parse(text: &str, name: &str) -> std::result::Result<Sourced, ReadError> {
    let DataFile {
        atoms,
        had_images,
        style,
        named,
        ..
    } = file(text, name)?;
    if style != Style::Peri {
        return Err(error(
            name,
            None,
            "the file is one of atoms, without volumes; points need atom_style peri: id type volume density x y z",
        ));
    }
    if atoms.is_empty() {
        return Err(error(name, None, "the file has no atoms"));
    }
    if had_images {
        return Err(error(
            name,
            None,
            "image flags other than 0: write unwrapped positions and leave the flags out",
        ));
    }
    let spacing = Spacing::new(&atoms.position);
    let excess = spacing.excess(&atoms.volume, None);
    if !named && spacing.dimension() == 3 && excess.abs() > libm::log(FACTOR) {
        return Err(error(
            name,
            None,
            format!(
                "the file does not say its atom_style, and as peri (id type volume density x y z) its volumes are {:.1e} times those between its points: write `Atoms # peri` if they are right; sphere has diameters there, full molecules, types and charges",
                libm::exp(excess)
            ),
        ));
    }
    let moves = |v: &[f64; 3]| *v != [0.0; 3];
    if let Some(i) = atoms.velocity.iter().flatten().position(moves) {
        let id = atoms.ids[i];
        return Err(error(
            name,
            None,
            format!(
                "the atom with id {id} has a velocity, which a deck does not take from the file: delete the section `Velocities` and write [[initial]]"
            ),
        ));
    }
    let mark = atoms
        .types
        .iter()
        .map(|t| i32::try_from(*t))
        .collect::<std::result::Result<_, _>>()
        .map_err(|_| {
            error(
                name,
                None,
                "atom types above 2147483647 cannot be block ids",
            )
        })?;
    Ok(Sourced {
        atoms: None,
        cloud: Cloud {
            position: atoms.position,
            volume: atoms.volume,
            density: atoms.density,
            mark,
            ..Cloud::default()
        },
        dimension: None,
        ends: None,
        cells: crate::read::Cells::default(),
        // the file is in no order; the engine names points in one place by their number
        lines: vec![],
        notes: { [GUESSED].into_iter().filter(|_| !named) }
            .map(String::from)
            .collect(),
    })
}

pub(super) fn error(name: &str, line: Option<usize>, message: impl Into<String>) -> ReadError {
    ReadError {
        file: name.into(),
        line,
        message: message.into(),
    }
}
