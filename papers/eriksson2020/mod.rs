//! Eriksson, Stenström, "Homogenization of the 1D peri-static/dynamic bar with triangular micromodulus", J. Peridyn.
//! Nonlocal Model. 2 (2020).

mod pulled;
mod rod;

#[path = "equations/mod.rs"]
mod equations;
#[path = "figure-2/mod.rs"]
mod figure_2;
#[path = "figure-3/mod.rs"]
mod figure_3;
#[path = "figure-4/mod.rs"]
mod figure_4;
#[path = "figure-5/mod.rs"]
mod figure_5;
#[path = "figure-6/mod.rs"]
mod figure_6;
#[path = "figure-7/mod.rs"]
mod figure_7;
#[path = "figure-8/mod.rs"]
mod figure_8;
#[path = "figure-9/mod.rs"]
mod figure_9;
#[path = "table-1/mod.rs"]
mod table_1;

use crate::{Experiment, Failure};
use peridyne_theory::homogenize::bar::{Bar, Ends};

pub fn all() -> Vec<&'static dyn Experiment> {
    vec![
        &equations::Equations,
        &table_1::Table1,
        &figure_2::Figure2,
        &figure_3::Figure3,
        &figure_4::Figure4,
        &figure_5::Figure5,
        &figure_6::Figure6,
        &figure_7::Figure7,
        &figure_8::Figure8,
        &figure_9::Figure9,
    ]
}

/// σ/E of all figures: 200 MPa over 200 GPa; also the initial strain of the vibrating bar.
const STRAIN: f64 = 1e-3;

/// A bar of m spacings per horizon.
fn bar(m: usize, points: usize, ends: Ends, homogenized: bool) -> Result<Bar, Failure> {
    Bar::new(m, points, ends, homogenized).map_err(|e| Failure::new(e.to_string()))
}

/// What a plot calls it.
fn kind(homogenized: bool) -> &'static str {
    if homogenized {
        "homogenized"
    } else {
        "not homogenized"
    }
}
