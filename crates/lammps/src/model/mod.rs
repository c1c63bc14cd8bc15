//! LAMMPS scripts on peridyne's own engine.
//!
//! The reference configuration is that of the first `run`. Lattice sites that were never moved become a stencil, all
//! else a cloud. The first force evaluation has no bonds yet (contact and conditions only), like LAMMPS's.

mod build;
mod conditions;
mod engine;
mod sharing;
mod spec;
mod types;

pub use build::{ModelHost, Prepared};
pub use engine::ModelEngine;
pub use sharing::Sharing;
