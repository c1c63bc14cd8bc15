//! What a file says of a body.

use super::atoms::Species;
use super::cells::Cells;
use peridyne::spec::{AnyLinearBody, Cloud};
use std::sync::Arc;

/// Points of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// Volumes are lengths in 1-D, areas in 2-D if the file is a mesh, and as written in plain text.
    pub cloud: Cloud,
    /// Dimension of a mesh's cells; `None` where the file does not say.
    pub dimension: Option<usize>,
    /// Lowest and highest coordinates of a mesh's cells.
    pub ends: Option<[[f64; 2]; 3]>,
    /// Shapes of a mesh's cells.
    pub cells: Cells,
    /// What files of atoms say besides.
    pub atoms: Option<AtomsFile>,
    /// Of a linear body.
    pub micromoduli: Option<Arc<AnyLinearBody>>,
    /// What the user should know: what was passed over.
    pub notes: Vec<String>,
}

/// Box and mass of a file of atoms.
#[derive(Debug, Clone, PartialEq)]
pub struct AtomsFile {
    /// Lower corner of the box.
    pub corner: [f64; 3],
    /// Lengths of the box.
    pub cell: [f64; 3],
    /// Periodic axes, where the file says it.
    pub periodic: Option<[bool; 3]>,
    /// The kinds of atoms that occur, with their masses where the file says them.
    pub species: Vec<Species>,
    /// A kind whose atoms have different masses.
    pub isotopes: Option<String>,
    /// Units that the file says it is in, by LAMMPS's names.
    pub units: Option<String>,
    /// The velocities are in Å, eV and g/mol.
    pub from_momenta: bool,
    /// There are bonds, angles, dihedrals or impropers.
    pub bonded: bool,
}

/// Points and the line that each came from, where that is known; 0 in a file without lines.
pub(super) struct Sourced {
    pub(super) cloud: Cloud,
    pub(super) dimension: Option<usize>,
    pub(super) ends: Option<[[f64; 2]; 3]>,
    pub(super) cells: Cells,
    pub(super) lines: Vec<usize>,
    pub(super) atoms: Option<AtomsFile>,
    pub(super) notes: Vec<String>,
}
