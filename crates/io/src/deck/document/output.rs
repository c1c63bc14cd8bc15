//! What is written.

use crate::deck::value::At;
use schemars::JsonSchema;
use serde::Deserialize;

#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Folder of the results, relative to the deck; when left out, out/NAME in the working folder for the deck NAME.toml.
    pub dir: Option<String>,
    /// Steps between frames; only the first and the last state when left out.
    pub every: Option<At<u64>>,
    /// Point fields of a frame, by name (`peridyne laws` lists them), displacements always; displacement, velocity, damage,
    /// energy_density, dilatation, mark when left out.
    pub fields: Option<Vec<At<String>>>,
    /// VTU series for ParaView; true when left out.
    pub vtu: Option<bool>,
    /// Unbroken bonds as lines, too.
    #[serde(default)]
    pub bonds: bool,
    /// The linear body about the last state as linear_body.npz (NumPy): points and micromoduli.
    #[serde(default)]
    pub linear_body: bool,
    /// LAMMPS dump of this name, in the folder of the results: frames of points with their fields, of atoms with velocities,
    /// forces and energies.
    pub dump: Option<At<String>>,
    /// Steps between rows of history.csv; a hundredth of the run when left out.
    pub history: Option<At<u64>>,
    /// PNG of the damage at the end; when left out, true, and false for atoms.
    pub picture: Option<bool>,
    /// report.html at the end, the run in one file for browsers; true when left out.
    pub report: Option<bool>,
    /// Atoms only: one file with all frames, positions, velocities, forces and energies; .extxyz, or .lammpstrj for a
    /// LAMMPS dump.
    pub trajectory: Option<At<String>>,
    /// Atoms only: LAMMPS data file (`atom_style atomic`, with velocities) of the last state.
    pub data: Option<At<String>>,
}
