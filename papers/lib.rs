//! The experiments of the papers, regenerated: each figure or table is a folder with code, claims and what the paper
//! leaves unsaid; [`reproduce()`] runs them and compares what is computed with what was printed.
//!
//! Adding one: a folder `PAPER/FIGURE/` with `mod.rs` (an [`Experiment`]), `claims.toml`, `README.md`, and one line in
//! the paper's `mod.rs`.

pub mod checkpoint;
pub mod claim;
pub mod experiment;
mod page;
pub mod profile;
pub mod reproduce;
mod seleson2009;
mod seleson2014;
mod silling2010;

pub use claim::{Claim, Kind};
pub use experiment::{Context, Experiment, Failure, Findings};
pub use reproduce::{Options, Outcome, Report, reproduce};

/// All experiments, in the order of the papers.
pub fn all() -> Vec<&'static dyn Experiment> {
    [seleson2009::all(), seleson2014::all(), silling2010::all()].concat()
}
