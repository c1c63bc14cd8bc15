//! Files in: point clouds (plain text, Abaqus `.inp`, gmsh `.msh`, LAMMPS `.data`), atoms
//! ([`extxyz`], [`dump`], [`data`]), and tables of potentials ([`eam`]).
//!
//! A mesh becomes one point per cell, at its centroid, with its volume. Only cells of the highest dimension count;
//! second-order cells are taken by their corners.

mod abaqus;
mod atoms;
mod cell;
pub mod data;
pub mod dump;
pub mod eam;
pub mod extxyz;
mod gmsh;
mod lammps;
mod lines;
mod stream;
mod text;

pub use atoms::{Atoms, Frame, Species};

use peridyne::spec::Cloud;
use std::collections::HashMap;
use std::path::Path;

/// Points of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Volumes are lengths in 1-D, areas in 2-D if the file is a mesh, and as written in plain text.
    pub cloud: Cloud,
    /// Dimension of a mesh's cells; `None` where the file does not say.
    pub dimension: Option<usize>,
}

/// What is wrong in a file of points.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{file}{}: {message}", line.map_or(String::new(), |l| format!(":{l}")))]
pub struct ReadError {
    pub file: String,
    /// 1-based; `None` when no line is to blame.
    pub line: Option<usize>,
    pub message: String,
}

const EXTENSIONS: [&str; 8] = ["inp", "msh", "data", "lmp", "txt", "dat", "xyz", "csv"];

/// Reads a file by its extension: `.inp`, `.msh`, `.data` and `.lmp` (LAMMPS), and plain text (`.txt`, `.xyz`, `.csv`
/// with blanks, `.dat`).
///
/// # Errors
/// The file cannot be read, is of another kind, truncated, has NaN, cells without volume, or points that coincide.
pub fn points(path: &Path) -> Result<Points, ReadError> {
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
            "unknown kind of file \".{extension}\": points come as .txt, .inp, .msh or .data"
        )));
    }
    let bytes = std::fs::read(path).map_err(|e| error(format!("cannot read it: {e}")))?;
    let text = String::from_utf8(bytes)
        .map_err(|_| error("it is not text; save meshes as ASCII".into()))?;
    parse(&text, &name, &extension)
}

/// The same from a text; `extension` decides the format.
pub fn parse(text: &str, name: &str, extension: &str) -> Result<Points, ReadError> {
    let points = match extension {
        "inp" => abaqus::parse(text, name)?,
        "msh" => gmsh::parse(text, name)?,
        "data" | "lmp" => lammps::parse(text, name)?,
        _ => text::parse(text, name)?,
    };
    let mut seen = HashMap::with_capacity(points.cloud.position.len());
    for (i, (x, line)) in points.cloud.position.iter().zip(&points.lines).enumerate() {
        // + 0.0 makes −0 and 0 one
        if let Some(first) = seen.insert(x.map(|c| (c + 0.0).to_bits()), *line) {
            let message = format!(
                "point {} at ({}, {}, {}) coincides with that of line {first}",
                i + 1,
                x[0],
                x[1],
                x[2]
            );
            return Err(ReadError {
                file: name.into(),
                line: Some(*line),
                message,
            });
        }
    }
    Ok(Points {
        cloud: points.cloud,
        dimension: points.dimension,
    })
}

/// Points and the line that each came from, where that is known.
struct Sourced {
    cloud: Cloud,
    dimension: Option<usize>,
    lines: Vec<usize>,
}

#[cfg(test)]
mod tests;
