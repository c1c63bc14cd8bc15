//! LAMMPS data files of `atom_style peri`: each point with its volume and density, the atom type as mark.

use super::{ReadError, Sourced};
use crate::lammps::{Atoms, Column, DataFile, Place, Style, read_data};
use peridyne::spec::Cloud;

pub(super) fn file(text: &str, name: &str) -> Result<DataFile, ReadError> {
    read_data(text.as_bytes(), name).map_err(|problem| {
        let line = match problem.place {
            Place::File { line, .. } if line > 0 => Some(line),
            _ => None,
        };
        let message = match &problem.help {
            Some(help) => format!("{} ({help})", problem.message),
            None => problem.message,
        };
        error(name, line, message)
    })
}

pub(super) fn parse(text: &str, name: &str) -> Result<Sourced, ReadError> {
    let DataFile {
        atoms,
        had_images,
        style,
        ..
    } = file(text, name)?;
    if style != Style::Peri {
        return Err(error(
            name,
            None,
            "the file is of atom_style atomic, without volumes; points need atom_style peri: id type volume density x y z",
        ));
    }
    let n = atoms.len();
    if n == 0 {
        return Err(error(name, None, "the file has no atoms"));
    }
    if had_images {
        return Err(error(
            name,
            None,
            "image flags other than 0: write unwrapped positions and leave the flags out",
        ));
    }
    if let Some(i) = (0..n).find(|i| atoms.velocity.get(*i) != [0.0; 3]) {
        let id = atoms.ids.get(i);
        return Err(error(
            name,
            None,
            format!(
                "the atom with id {id} has a velocity, which a deck does not take from the file: delete the section `Velocities` and write [[initial]]"
            ),
        ));
    }
    let mark = (0..n)
        .map(|i| i32::try_from(atoms.types.get(i)))
        .collect::<Result<_, _>>()
        .map_err(|_| error(name, None, "atom types above 2147483647 cannot be marks"))?;
    Ok(Sourced {
        atoms: None,
        cloud: Cloud {
            position: (0..n).map(|i| atoms.position(i)).collect(),
            volume: each(&atoms, &atoms.volume),
            density: each(&atoms, &atoms.density),
            mark,
            ..Cloud::default()
        },
        dimension: None,
        // the file is in no order; the engine names points in one place by their number
        lines: vec![],
        notes: vec![],
    })
}

fn each(atoms: &Atoms, column: &Column<f64>) -> Vec<f64> {
    (0..atoms.len()).map(|i| column.get(i)).collect()
}

pub(super) fn error(name: &str, line: Option<usize>, message: impl Into<String>) -> ReadError {
    ReadError {
        file: name.into(),
        line,
        message: message.into(),
    }
}
