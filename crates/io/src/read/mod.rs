//! Files in: point clouds (plain text, Abaqus `.inp`, gmsh `.msh`, Exodus II `.g`, LAMMPS `.data`), atoms
//! ([`extxyz`], [`dump`], [`data`]), linear bodies (`.npz`), surfaces of triangles ([`stl`]), tables and constants of
//! potentials ([`eam`], [`entries`]), and columns of what was measured ([`measured`]).
//!
//! A mesh becomes one point per cell, at its centroid, with its volume. Only cells of the highest dimension count; what
//! else the mesh names becomes sets (`mesh`). Second-order cells are taken by their corners.

mod abaqus;
mod atoms;
mod body;
mod cell;
mod cells;
pub mod data;
pub mod dump;
pub mod eam;
pub mod encoding;
pub mod entries;
mod error;
pub mod exodus;
pub mod extxyz;
pub mod frames;
mod gmsh;
pub mod lammps;
mod linear;
mod lines;
mod measure;
pub mod measured;
mod mesh;
pub mod molecules;
pub mod npz;
pub mod number;
pub(crate) mod plane;
pub mod source;
pub(crate) mod spacing;
pub mod stl;
mod stream;
pub mod tag;
#[cfg(test)]
mod tests;
mod text;
pub mod vtu;
mod whole;

pub use atoms::{Atoms, Frame, Species};
use body::Sourced;
pub use body::{AtomsFile, Points};
pub use cells::Cells;
pub use error::ReadError;
pub use mesh::Holds;
use peridyne::spec::Cloud;
use std::collections::HashMap;
use std::io::{BufRead, Read};
use std::path::Path;
pub use whole::text_of;

const EXTENSIONS: [&str; 17] = [
    "npz",
    "g",
    "e",
    "exo",
    "ex2",
    "gen",
    "inp",
    "msh",
    "data",
    "lmp",
    "txt",
    "dat",
    "xyz",
    "csv",
    "extxyz",
    "lammpstrj",
    "dump",
];

/// Reads a file by its extension: `.inp`, `.msh`, Exodus II (`.g`, `.e`, `.exo`, `.ex2`, `.gen`), `.data` and `.lmp` (LAMMPS, `atom_style` peri or atomic), LAMMPS dumps of
/// atoms (`.lammpstrj`, `.dump`), extended XYZ (`.extxyz`, and `.xyz` whose second line says so), and plain text (`.txt`,
/// `.xyz`, `.csv` with blanks, `.dat`). `frame` is which of a dump's or of an extended XYZ file's; others have one state.
///
/// # Errors
/// The file cannot be read, is of another kind, truncated, has NaN, cells without volume, points that coincide, or not
/// this frame.
pub fn points(path: &Path, frame: Frame) -> Result<Points, ReadError> {
    let name = path.display().to_string();
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .unwrap_or("")
        .to_lowercase();
    let error = |message: String| ReadError {
        file: name.clone(),
        line: None,
        message,
    };
    if !EXTENSIONS.contains(&extension.as_str()) {
        return Err(error(format!(
            "unknown kind of file \".{extension}\": points come as .txt, .inp, .msh, .g, .data, .extxyz, .lammpstrj or .npz"
        )));
    }
    // trajectories may be larger than memory
    match extension.as_str() {
        "extxyz" | "xyz" if extension == "extxyz" || begins_extended(path) => {
            return whole(sourced(extxyz::extxyz(path, frame)?, false, &name)?, &name);
        }
        "lammpstrj" | "dump" => {
            return whole(sourced(dump::dump(path, frame)?, false, &name)?, &name);
        }
        _ => {}
    }
    if frame != Frame::Last {
        return Err(error(format!(
            "a file \".{extension}\" has one state: frames are in .lammpstrj and .extxyz"
        )));
    }
    if extension == "inp" {
        return whole(abaqus::read(path)?, &name);
    }
    if extension == "npz" {
        return linear::read(path);
    }
    let bytes = source::bytes(path).map_err(|e| error(format!("cannot read it: {e}")))?;
    if extension == "msh" {
        return whole(gmsh::read(bytes, &name)?, &name);
    }
    if matches!(&*extension, "g" | "e" | "exo" | "ex2" | "gen") {
        return exodus::parse_exodus(bytes, &name);
    }
    // a data file of LAMMPS has a title
    let titles = usize::from(matches!(&*extension, "data" | "lmp"));
    parse(&whole::text(bytes, &name, titles)?, &name, &extension)
}

/// Is the second line of a file that of extended XYZ?
fn begins_extended(path: &Path) -> bool {
    let Ok(file) = source::open(path) else {
        return false;
    };
    // a line of a frame is short; what is not a text file may have none
    let head = std::io::BufReader::new(file.take(1 << 16));
    head.lines()
        .nth(1)
        .is_some_and(|line| line.is_ok_and(|line| is_extended(&line)))
}

/// Is this the second line of extended XYZ?
fn is_extended(line: &str) -> bool {
    line.contains("Lattice=") || line.contains("Properties=")
}

/// The same from a text, of the last frame; `extension` decides the format.
pub fn parse(text: &str, name: &str, extension: &str) -> Result<Points, ReadError> {
    let extended = text.lines().nth(1).is_some_and(is_extended);
    let points = match extension {
        "extxyz" => sourced(extxyz::parse_extxyz(text, name, Frame::Last)?, false, name)?,
        "xyz" if extended => sourced(extxyz::parse_extxyz(text, name, Frame::Last)?, false, name)?,
        "data" | "lmp" if lammps::file(text, name)?.style != lammps::Style::Peri => {
            sourced(data::parse_data(text, name)?, true, name)?
        }
        "lammpstrj" | "dump" => sourced(dump::parse_dump(text, name, Frame::Last)?, false, name)?,
        "inp" => abaqus::parse(text, name, None)?,
        "msh" => gmsh::parse(text, name)?,
        "data" | "lmp" => lammps::parse(text, name)?,
        _ => text::parse(text, name)?,
    };
    whole(points, name)
}

/// Refuses points that coincide.
fn whole(points: Sourced, name: &str) -> Result<Points, ReadError> {
    let mut seen = HashMap::with_capacity(points.cloud.position.len());
    for (i, (x, line)) in points.cloud.position.iter().zip(&points.lines).enumerate() {
        // + 0.0 makes −0 and 0 one
        if let Some(first) = &seen.insert(x.map(|c| (c + 0.0).to_bits()), *line) {
            let [place, line] = [*first, *line].map(|l| Some(l).filter(|l| *l > 0));
            let place = place.map_or("another".into(), |l| format!("that of line {l}"));
            let message = format!(
                "point {} at ({}, {}, {}) coincides with {place}",
                i + 1,
                x[0],
                x[1],
                x[2]
            );
            return Err(ReadError {
                file: name.into(),
                line,
                message,
            });
        }
    }
    Ok(Points {
        cloud: points.cloud,
        dimension: points.dimension,
        ends: points.ends,
        cells: points.cells,
        atoms: points.atoms,
        micromoduli: None,
        notes: points.notes,
    })
}

/// Periods from the cell at which a place keeps ten digits of it.
const FARTHEST: f64 = 1e6;

/// Atoms as points: each has its part of the box as volume. LAMMPS does not say which axes are periodic.
fn sourced(atoms: Atoms, lammps: bool, name: &str) -> Result<Sourced, ReadError> {
    let error = |message: String| ReadError {
        file: name.into(),
        line: None,
        message,
    };
    let n = atoms.len();
    if n == 0 {
        return Err(error("the file has no atoms".into()));
    }
    let cell: [f64; 3] = std::array::from_fn(|a| atoms.high[a] - atoms.low[a]);
    let far = |x: &[f64; 3]| {
        let off = |a: usize| (x[a] - atoms.low[a]).abs() / cell[a];
        (0..3).any(|a| !lammps && atoms.periodic[a] && cell[a] > 0.0 && !(off(a) < FARTHEST))
    };
    if let Some(i) = atoms.position.iter().position(far) {
        return Err(error(format!(
            "atom {} is at {:?}, more than {FARTHEST} periods from the cell: its place in it has lost its digits",
            i + 1,
            atoms.position[i]
        )));
    }
    let used: std::collections::BTreeSet<u32> = atoms.kind.iter().copied().collect();
    let kinds = || used.iter().map(|k| &atoms.species[*k as usize]);
    let of_none = |k: &u32| atoms.mass.is_some() && atoms.species[*k as usize].mass.is_none();
    let isotopes = { used.iter() }
        .find(|k| of_none(k))
        .map(|k| &atoms.species[*k as usize]);
    let volume = cell.iter().filter(|c| **c > 0.0).product::<f64>() / n as f64;
    Ok(Sourced {
        atoms: Some(AtomsFile {
            corner: atoms.low,
            cell,
            periodic: (!lammps).then_some(atoms.periodic),
            species: kinds().cloned().collect(),
            isotopes: isotopes.map(|s| s.name.clone()),
            units: atoms.units.clone(),
            from_momenta: atoms.from_momenta,
            bonded: atoms.bonded,
        }),
        cloud: Cloud {
            volume: vec![volume; n],
            mark: atoms.kind.iter().map(|k| *k as i32 + 1).collect(),
            // of several, each is a set
            names: { used.iter().filter(|_| used.len() > 1) }
                .map(|k| (*k as i32 + 1, atoms.species[*k as usize].name.clone()))
                .collect(),
            velocity: atoms.velocity.unwrap_or_default(),
            position: atoms.position,
            ..Cloud::default()
        },
        dimension: None,
        ends: None,
        cells: Cells::default(),
        lines: vec![],
        notes: vec![],
    })
}
