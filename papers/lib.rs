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
mod impact;
mod measure;
mod page;
pub mod profile;
pub mod reproduce;
mod sandia2010;
mod seleson2009;
mod seleson2014;
mod silling2010;

pub use claim::{Claim, Kind, Value};
pub use experiment::{Context, Experiment, Failure, Findings, Measurement, Takes};
pub use reproduce::{Options, Outcome, Report, reproduce};

/// A paper, or the gallery.
pub struct Paper {
    pub key: &'static str,
    pub title: &'static str,
    pub figures: Vec<&'static dyn Experiment>,
}

/// All papers.
pub fn papers() -> Vec<Paper> {
    let paper = |key, title, figures| Paper {
        key,
        title,
        figures,
    };
    vec![
        paper(
            "seleson2009",
            "Seleson, Parks, Gunzburger & Lehoucq: Peridynamics as an upscaling of molecular dynamics",
            seleson2009::all(),
        ),
        paper(
            "seleson2014",
            "Seleson, Parks & Gunzburger: Peridynamic state-based models and the embedded-atom model",
            seleson2014::all(),
        ),
        paper(
            "eriksson2020",
            "Eriksson & Stenström: Homogenization of the 1D peri-static/dynamic bar with triangular micromodulus",
            eriksson2020::all(),
        ),
        paper(
            "silling2010",
            "Silling: A coarsening method for linear peridynamics",
            silling2010::all(),
        ),
        paper(
            "sandia2010",
            "Peridynamics as a rigorous coarse-graining of atomistics for multiscale materials design, chapters 2 to 4",
            sandia2010::all(),
        ),
        paper(
            "gallery",
            "The field's classics, beside closed forms, handbooks and experiments",
            gallery::all(),
        ),
    ]
}

/// All experiments, in the order of the papers.
pub fn all() -> Vec<&'static dyn Experiment> {
    papers().into_iter().flat_map(|p| p.figures).collect()
}
