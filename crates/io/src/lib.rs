//! peridyne-io: decks, LAMMPS scripts and meshes in; VTU, CSV, JSON, dumps and pictures out.

pub mod balance;
pub mod deck;
pub mod drive;
pub mod lammps;
pub mod read;
pub mod write;
