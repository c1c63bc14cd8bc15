//! Seleson, Parks, Gunzburger, Lehoucq, "Peridynamics as an upscaling of molecular dynamics", Multiscale Model. Simul. 8 (2009).

mod chain;
mod deck;
mod equations;
#[path = "figure-4-2/mod.rs"]
mod figure_4_2;
#[path = "figure-4-3/mod.rs"]
mod figure_4_3;
#[path = "figure-4-4/mod.rs"]
mod figure_4_4;
#[path = "figure-4-5/mod.rs"]
mod figure_4_5;
#[path = "figure-4-6/mod.rs"]
mod figure_4_6;
#[path = "figure-5-1/mod.rs"]
mod figure_5_1;
#[path = "figure-5-2/mod.rs"]
mod figure_5_2;
mod lennard_jones;
mod modes;
mod motion;
mod runs;
#[path = "table-4-1/mod.rs"]
mod table_4_1;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &figure_4_2::Figure42,
        &figure_4_3::Figure43,
        &figure_4_4::Figure44,
        &figure_4_5::Figure45,
        &figure_4_6::Figure46,
        &figure_5_1::Figure51,
        &figure_5_2::Figure52,
        &table_4_1::Table41,
        &equations::Equations,
    ]
}
