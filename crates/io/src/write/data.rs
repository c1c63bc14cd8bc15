//! LAMMPS data files of `atom_style atomic`: LAMMPS, ASE, OVITO and [`crate::read::data`] read them.

use std::io::{self, Write};
use std::path::Path;

use super::atomic::{WriteError, write_file};
use super::extxyz::check;
use super::fields::invalid;
use crate::read::Atoms;

/// Writes the atoms, all or nothing; numbers read back to the same f64. Type t is species t − 1, whose name is the
/// comment of its mass; ids count from 1.
///
/// # Errors
/// The operating system's; `InvalidInput` for a species without mass, or a box without volume.
pub fn write_data(path: &Path, atoms: &Atoms) -> Result<(), WriteError> {
    write_file(path, |w| data_to(w, atoms))
}

/// The same to any writer.
///
/// # Errors
/// Those of `w`, and those of [`write_data`].
pub fn data_to<W: Write>(w: &mut W, atoms: &Atoms) -> io::Result<()> {
    check(atoms)?;
    let species = &atoms.species;
    let (n, types) = (atoms.len(), species.len());
    writeln!(
        w,
        "LAMMPS data file, atom_style atomic\n\n{n} atoms\n{types} atom types\n"
    )?;
    for (a, axis) in ["x", "y", "z"].iter().enumerate() {
        let (low, high) = (atoms.low[a], atoms.high[a]);
        if low.partial_cmp(&high) != Some(std::cmp::Ordering::Less) {
            return Err(invalid(format!(
                "the box has no length along {axis}: {low} to {high}"
            )));
        }
        writeln!(w, "{low:?} {high:?} {axis}lo {axis}hi")?;
    }
    writeln!(w, "\nMasses\n")?;
    for (t, s) in species.iter().enumerate() {
        let mass = s
            .mass
            .ok_or_else(|| invalid(format!("the species {} has no mass", s.name)))?;
        writeln!(w, "{} {mass:?} # {}", t + 1, s.name)?;
    }
    writeln!(w, "\nAtoms # atomic\n")?;
    for (i, [x, y, z]) in atoms.position.iter().enumerate() {
        writeln!(w, "{} {} {x:?} {y:?} {z:?}", i + 1, atoms.kind[i] + 1)?;
    }
    if let Some(velocity) = &atoms.velocity {
        writeln!(w, "\nVelocities\n")?;
        for (i, [x, y, z]) in velocity.iter().enumerate() {
            writeln!(w, "{} {x:?} {y:?} {z:?}", i + 1)?;
        }
    }
    Ok(())
}
