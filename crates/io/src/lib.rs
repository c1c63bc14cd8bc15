//! peridyne-io: decks, meshes and files of atoms in; VTU, VTKHDF, CSV, JSON, dumps and pictures out.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

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
