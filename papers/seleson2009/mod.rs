//! Seleson, Parks, Gunzburger, Lehoucq, "Peridynamics as an upscaling of molecular dynamics", Multiscale Model. Simul. 8 (2009).

mod chain;
#[path = "table-4-1/mod.rs"]
mod table_4_1;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![&table_4_1::Table41]
}
