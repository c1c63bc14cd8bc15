//! peridyne-io: decks, meshes and files of atoms in; VTU, VTKHDF, CSV, JSON, dumps and pictures out.

pub mod balance;
pub mod conservation;
pub mod continuum;
pub mod convert;
pub mod deck;
pub mod drive;
pub mod excerpt;
mod hdf5;
mod netcdf;
pub mod read;
pub mod write;
