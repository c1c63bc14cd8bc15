//! Trajectories: frames of atoms appended to one file, extended XYZ or LAMMPS dump.
//!
//! Frames are whole or not there: the part of a frame that did not fit (disk full) is cut off again. The
//! file can be read at any time between frames.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::atomic::{WriteError, open_to_append, write_file};
use super::{dump, extxyz};
use crate::read::Atoms;

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
    frames: Frames,
    format: Format,
    /// How much velocity one of ASE is.
    ase_velocity: f64,
}

impl Trajectory {
    /// Starts an empty file; an older one is replaced.
    pub fn create(path: &Path, format: Format) -> Result<Self, WriteError> {
        Ok(Trajectory {
            frames: Frames::create(path)?,
            format,
            ase_velocity: 1.0,
        })
    }

    /// Goes on with an existing file.
    pub fn append(path: &Path, format: Format) -> Result<Self, WriteError> {
        Ok(Trajectory {
            frames: Frames::append(path)?,
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
        self.frames.push(|w| format.write(w, atoms, unit))
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

/// A file that grows frame by frame.
#[derive(Debug)]
pub(super) struct Frames {
    path: PathBuf,
    file: File,
    /// Length of the file in bytes, whole frames only.
    length: u64,
}

impl Frames {
    /// Starts an empty file; an older one is replaced.
    pub fn create(path: &Path) -> Result<Self, WriteError> {
        write_file(path, |_| Ok(()))?;
        Frames::append(path)
    }

    fn append(path: &Path) -> Result<Self, WriteError> {
        let file = open_to_append(path)?;
        let length = file
            .metadata()
            .map_err(WriteError::at("append to", path))?
            .len();
        Ok(Frames {
            path: path.to_path_buf(),
            file,
            length,
        })
    }

    /// Appends what `write` writes, or nothing.
    pub fn push(
        &mut self,
        write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
    ) -> Result<(), WriteError> {
        let mut w = BufWriter::with_capacity(1 << 18, &self.file);
        let done = write(&mut w).and_then(|()| w.flush());
        // what is buffered of a failed frame must not follow when the writer is dropped
        drop(w.into_parts());
        if let Err(error) = done {
            // if cutting fails too, the error of the frame tells more
            let _ = self.file.set_len(self.length);
            return Err(WriteError::at("append to", &self.path)(error));
        }
        let end = self.file.metadata();
        self.length = end.map_err(WriteError::at("append to", &self.path))?.len();
        Ok(())
    }

    /// Waits until all frames are on the disk.
    pub fn finish(self) -> Result<(), WriteError> {
        self.file
            .sync_all()
            .map_err(WriteError::at("write", &self.path))
    }
}
