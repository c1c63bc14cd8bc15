//! The experiments of the papers, regenerated: each figure or table is a folder with code, claims and what the paper
//! leaves unsaid; [`reproduce()`] runs them and compares what is computed with what was printed.
//!
//! Adding one: a folder `PAPER/FIGURE/` with `mod.rs` (`experiment!` and a function `run`), `claims.toml`, `README.md`,
//! and two lines in the paper's `mod.rs`: the module and its place in `all`.

// first: its macro is that of the papers
#[macro_use]
pub mod experiment;

pub mod checkpoint;
pub mod claim;
mod eriksson2020;
mod gallery;
mod measure;
mod page;
pub mod profile;
pub mod reproduce;
mod sandia2010;
mod seleson2009;
mod seleson2014;
mod silling2010;

pub use claim::{Claim, Kind, Value};
pub use experiment::{Context, Experiment, Failure, Findings, Measurement};
pub use reproduce::{Options, Outcome, Report, reproduce};

/// All experiments, in the order of the papers.
pub fn all() -> Vec<&'static dyn Experiment> {
    [
        seleson2009::all(),
        seleson2014::all(),
        eriksson2020::all(),
        silling2010::all(),
        sandia2010::all(),
        gallery::all(),
    ]
    .concat()
}
