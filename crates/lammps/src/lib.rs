//! peridyne-lammps: LAMMPS scripts for peridynamics: reads and runs them, with LAMMPS's language, formulas and output.
//!
//! [`run_file`] reads a script. What is set up before the first `run` is collected in a [`host::Setup`]; a
//! [`host::Host`] turns it into a [`host::Engine`], which then owns the atoms. The arithmetic of positions,
//! regions and formulas is LAMMPS's (observed on LAMMPS 22 Jul 2025), so that the same atoms are made.
//!
//! Differences that a user can see: snapshots and thermo lines are in order of atom id; the box of `boundary s`
//! is current at every output, and with it the volume in `press` (LAMMPS moves it when it rebuilds neighbour lists); positions on periodic axes are
//! always wrapped; anything unsupported is an error.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod atoms;
mod boolean;
mod command;
mod compute;
mod console;
mod domain;
mod dump;
mod error;
mod files;
mod fix;
pub mod host;
mod input;
mod lattice;
mod lost;
pub mod model;
mod momenta;
mod pair;
mod park;
mod particles;
mod printf;
mod quantity;
mod random;
mod read_data;
mod read_dump;
mod rebuild;
mod record;
mod region;
mod resume;
mod rigid;
mod script;
mod session;
mod text;
mod thermo;
mod units;
mod variable;
mod vector;
mod write_data;

pub use self::atoms::{Atoms, Column, Ids, Members, Reference, SiteLattice};
pub use self::domain::{Face, SimBox};
pub use self::error::{Place, Problem, ScriptError};
pub use self::read_dump::{Frame, read_frame};
pub use self::record::{Record, Row};
pub use self::script::{Options, Outcome, go_on_text, run_file, run_text};
pub use self::units::Units;
