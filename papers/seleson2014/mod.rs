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

use crate::{Experiment, Failure};
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

/// The energy less what the time stepper adds is conserved but for what is not linear in displacements: of the order of
/// the strains, 1e-3, times the share of the energy that the stepper exchanges.
const CONSERVED: f64 = 1e-3;

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
