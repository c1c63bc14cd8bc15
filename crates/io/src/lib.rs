//! io
pub mod lammps;
