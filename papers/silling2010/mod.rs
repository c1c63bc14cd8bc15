//! Silling, "A coarsening method for linear peridynamics" (2010): its examples, and the same in two and three dimensions.

mod bar;
mod compare;
mod crystal;

#[path = "beyond-atoms/mod.rs"]
mod beyond_atoms;
#[path = "beyond-block/mod.rs"]
mod beyond_block;
#[path = "beyond-increments/mod.rs"]
mod beyond_increments;
#[path = "beyond-motion/mod.rs"]
mod beyond_motion;
#[path = "beyond-plates/mod.rs"]
mod beyond_plates;
#[path = "beyond-temperature/mod.rs"]
mod beyond_temperature;
#[path = "equations/mod.rs"]
mod equations;
#[path = "figure-3/mod.rs"]
mod figure_3;
#[path = "figure-4/mod.rs"]
mod figure_4;
#[path = "figure-5/mod.rs"]
mod figure_5;
#[path = "figure-7/mod.rs"]
mod figure_7;
#[path = "section-6/mod.rs"]
mod section_6;

use crate::Experiment;

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &equations::Equations,
        &figure_3::Figure3,
        &figure_4::Figure4,
        &figure_5::Figure5,
        &figure_7::Figure7,
        &section_6::Section6,
        &beyond_plates::BeyondPlates,
        &beyond_block::BeyondBlock,
        &beyond_atoms::BeyondAtoms,
        &beyond_motion::BeyondMotion,
        &beyond_temperature::BeyondTemperature,
        &beyond_increments::BeyondIncrements,
    ]
}
