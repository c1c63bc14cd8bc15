//! Seleson, Parks, Gunzburger, "Peridynamic state-based models and the embedded-atom model", Commun. Comput. Phys. 15 (2014).

mod chain;
mod cube;
mod plate;

#[path = "figure-1/mod.rs"]
mod figure_1;
#[path = "figure-2/mod.rs"]
mod figure_2;
#[path = "figure-3/mod.rs"]
mod figure_3;
#[path = "figure-4/mod.rs"]
mod figure_4;
#[path = "figure-4-paper-step/mod.rs"]
mod figure_4_paper_step;
#[path = "figure-5/mod.rs"]
mod figure_5;
#[path = "figure-6/mod.rs"]
mod figure_6;
#[path = "figure-6-paper-step/mod.rs"]
mod figure_6_paper_step;
#[path = "figure-7/mod.rs"]
mod figure_7;
#[path = "table-1/mod.rs"]
mod table_1;
#[path = "table-2/mod.rs"]
mod table_2;
#[path = "table-3/mod.rs"]
mod table_3;
#[path = "table-4/mod.rs"]
mod table_4;

use crate::checkpoint::Record;
use crate::measure::largest;
use crate::{Experiment, Failure, Findings};
use peridyne::run::{Options, Simulation, build};
use peridyne_io::deck::Deck;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &figure_1::Figure1,
        &figure_2::Figure2,
        &table_1::Table1,
        &table_2::Table2,
        &figure_3::Figure3,
        &figure_4::Figure4,
        &figure_4_paper_step::Figure4PaperStep,
        &figure_5::Figure5,
        &table_3::Table3,
        &table_4::Table4,
        &figure_6::Figure6,
        &figure_6_paper_step::Figure6PaperStep,
        &figure_7::Figure7,
    ]
}

/// What is not linear in displacements is not conserved by (Δt²/8) Σ m a²: small beside what the stepper exchanges.
const CONSERVED: f64 = 1e-4;

/// The claim `conserved`: the energy of runs, less what the time stepper adds.
fn conserved<'r>(records: impl IntoIterator<Item = &'r Record>, found: &mut Findings) {
    let both = |r: &Record| (r.drift(), r.invariant_drift());
    let (total, invariant): (Vec<f64>, Vec<f64>) = records.into_iter().map(both).unzip();
    let invariant = largest(invariant);
    found.holds(
        "conserved",
        format!(
            "the total changes by {:.1e} of it at most; less (Δt²/8) Σ m a², which velocity Verlet adds, by {invariant:.1e}",
            largest(total)
        ),
        invariant < CONSERVED,
    );
}

/// A deck with some of its entries replaced.
fn deck(text: &str, name: &str, set: &[(&str, String)]) -> Result<Deck, Failure> {
    let set: Vec<_> = set
        .iter()
        .map(|(k, v)| (k.to_string(), v.clone()))
        .collect();
    Deck::parse(text, name, &set).map_err(|e| Failure::new(e.to_string()))
}

/// The model of a deck; `measured`: with its stable step.
fn model(deck: &Deck, measured: bool) -> Result<Box<dyn Simulation>, Failure> {
    let options = Options {
        trust_time_step: !measured,
        ..Options::default()
    };
    build(&deck.spec, options).map_err(|e| Failure::new(e.to_string()))
}
