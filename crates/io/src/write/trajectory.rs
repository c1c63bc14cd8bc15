//! Trajectories: frames of atoms appended to one file, extended XYZ or LAMMPS dump.
//!
//! Frames are whole or not there ([`Grown`]).

use std::io::{self, Write};
use std::path::Path;

use super::Grown;
use super::atomic::{WriteError, write_file};
use super::{dump, extxyz};
use crate::read::Atoms;
use peridyne::state::{Archive, Owner};

/// Format of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Extxyz,
    /// LAMMPS text dump: `id type x y z`, and velocities and forces where the atoms have them.
    Dump,
}

impl Format {
    fn write<W: Write>(self, w: &mut W, atoms: &Atoms, ase_velocity: f64) -> io::Result<()> {
        match self {
            Format::Extxyz => extxyz::write_frame(w, atoms, ase_velocity),
            Format::Dump => dump::write_atoms(w, atoms),
        }
    }
}

/// Writes frames to a file, all or nothing; their velocities are those of ASE.
pub fn write_atoms(path: &Path, format: Format, frames: &[Atoms]) -> Result<(), WriteError> {
    write_file(path, |w| {
        frames.iter().try_for_each(|f| format.write(w, f, 1.0))
    })
}

/// An open trajectory.
#[derive(Debug)]
pub struct Trajectory {
    frames: Grown,
    format: Format,
    /// How much velocity one of ASE is.
    ase_velocity: f64,
}

impl Owner for Trajectory {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("frames", &mut self.frames);
    }
}

impl Trajectory {
    /// Starts an empty file; an older one is replaced.
    pub fn create(path: &Path, format: Format) -> Result<Self, WriteError> {
        Ok(Trajectory {
            frames: Grown::create(path, b"")?,
            format,
            ase_velocity: 1.0,
        })
    }

    /// [`Grown::rewind`], of a file that was [appended](Trajectory::append) to and whose state was read.
    pub fn rewind(&mut self) -> Result<(), WriteError> {
        self.frames.rewind()
    }

    /// Goes on with an existing file.
    pub fn append(path: &Path, format: Format) -> Result<Self, WriteError> {
        Ok(Trajectory {
            frames: Grown::open(path)?,
            format,
            ase_velocity: 1.0,
        })
    }

    /// Appends a frame; it is in the file when this returns.
    ///
    /// # Errors
    /// The operating system's, and those of the format; the file then ends with the frame before.
    pub fn push(&mut self, atoms: &Atoms) -> Result<(), WriteError> {
        let (format, unit) = (self.format, self.ase_velocity);
        self.frames.push(|mut w| format.write(&mut w, atoms, unit))
    }

    /// The velocities to come are in other units than ASE's: `unit` is how much one of those is.
    pub fn with_ase_velocity(mut self, unit: f64) -> Self {
        self.ase_velocity = unit;
        self
    }

    /// Waits until all frames are on the disk.
    pub fn finish(self) -> Result<(), WriteError> {
        self.frames.finish()
    }
}
