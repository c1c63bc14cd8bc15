//! Extended XYZ of atoms: ASE, OVITO and [`crate::read::extxyz`] read it.

use std::io::{self, Write};

use super::fields::invalid;
use crate::read::Atoms;

/// Writes one frame; numbers read back to the same f64. A trajectory is frames one after another, see
/// [`super::trajectory::Trajectory`]. Velocities are the column velo; where masses are known, they are also momenta, as ASE reads
/// velocities: in its unit, of which a velocity of 1 is `1/ase_velocity`.
///
/// # Errors
/// Those of `w`; `InvalidInput` for arrays of unequal lengths, and names that would not read back.
pub fn write_frame<W: Write>(w: &mut W, atoms: &Atoms, ase_velocity: f64) -> io::Result<()> {
    check(atoms)?;
    writeln!(w, "{}", atoms.len())?;
    let [x, y, z]: [f64; 3] = std::array::from_fn(|a| atoms.high[a] - atoms.low[a]);
    write!(w, "Lattice=\"{x:?} 0.0 0.0 0.0 {y:?} 0.0 0.0 0.0 {z:?}\" ")?;
    if atoms.low != [0.0; 3] {
        let [x, y, z] = atoms.low;
        write!(w, "Origin=\"{x:?} {y:?} {z:?}\" ")?;
    }
    let pbc = atoms.periodic.map(|p| if p { "T" } else { "F" });
    write!(w, "pbc=\"{}\" ", pbc.join(" "))?;
    if let Some(step) = atoms.step {
        write!(w, "step={step} ")?;
    }
    if let Some(time) = atoms.time {
        write!(w, "time={time:?} ")?;
    }
    let masses = atoms.species.iter().all(|s| s.mass.is_some()) && !atoms.is_empty();
    write!(w, "Properties=species:S:1:pos:R:3")?;
    let columns = [
        (masses, "masses:R:1"),
        (atoms.velocity.is_some(), "velo:R:3"),
        (masses && atoms.velocity.is_some(), "momenta:R:3"),
        (atoms.force.is_some(), "forces:R:3"),
        (atoms.energy.is_some(), "energies:R:1"),
    ];
    for (_, name) in columns.iter().filter(|c| c.0) {
        write!(w, ":{name}")?;
    }
    writeln!(w)?;
    for i in 0..atoms.len() {
        write!(w, "{}", atoms.name(i))?;
        vector(w, &atoms.position[i])?;
        if let (true, Some(mass)) = (masses, atoms.species[atoms.kind[i] as usize].mass) {
            write!(w, " {mass:?}")?;
        }
        if let Some(velocity) = &atoms.velocity {
            vector(w, &velocity[i])?;
            let mass = atoms.species[atoms.kind[i] as usize].mass;
            if let Some(mass) = mass.filter(|_| masses) {
                vector(w, &velocity[i].map(|v| mass * (v / ase_velocity)))?;
            }
        }
        if let Some(force) = &atoms.force {
            vector(w, &force[i])?;
        }
        if let Some(e) = &atoms.energy {
            write!(w, " {:?}", e[i])?;
        }
        writeln!(w)?;
    }
    Ok(())
}

fn vector<W: Write>(w: &mut W, v: &[f64; 3]) -> io::Result<()> {
    v.iter().try_for_each(|c| write!(w, " {c:?}"))
}

/// Arrays of one length, kinds that exist, names that read back.
pub(super) fn check(atoms: &Atoms) -> io::Result<()> {
    let n = atoms.len();
    let lengths = [
        ("kinds", Some(atoms.kind.len())),
        ("velocities", atoms.velocity.as_ref().map(Vec::len)),
        ("forces", atoms.force.as_ref().map(Vec::len)),
        ("energies", atoms.energy.as_ref().map(Vec::len)),
    ];
    for (what, length) in lengths {
        if let Some(length) = length.filter(|l| *l != n) {
            return Err(invalid(format!("{n} atoms, but {length} {what}")));
        }
    }
    if let Some(kind) = atoms
        .kind
        .iter()
        .find(|k| **k as usize >= atoms.species.len())
    {
        let known = atoms.species.len();
        return Err(invalid(format!(
            "an atom is of kind {kind}, there are {known} species"
        )));
    }
    let bad = |s: &str| s.is_empty() || s.contains(|c: char| c.is_whitespace() || c == '#');
    if let Some(s) = atoms.species.iter().find(|s| bad(&s.name)) {
        return Err(invalid(format!(
            "`{}` cannot be the name of a species",
            s.name
        )));
    }
    Ok(())
}
