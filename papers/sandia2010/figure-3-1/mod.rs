//! Fig. 3.1: the nodal volume scaling ν over the length of a bond, from the forces of two points.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Figure31,
    "figure-3-1",
    "Volume of particles at the rim of the horizon",
    ["../../gallery/bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Micromodulus (N/m⁶), stretch and volume (m³) of the deck.
const C: f64 = 1e18;
const STRETCH: f64 = 0.01;
const VOLUME: f64 = 1e-9;

/// ν of a bond of a spacing, the horizon in spacings: the force density over c s V.
fn scaling(horizon: f64) -> Result<f64, Failure> {
    let horizon = format!("{horizon} mm");
    let mut bench = Bench::new(DECK, &[("horizon", &horizon)])?;
    Ok(bench.values("force_density", 0)?[0] / (C * STRETCH * VOLUME))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    found.number("at-horizon", scaling(1.0)?);
    // r is half a spacing
    found.number("within", scaling(1.5)?);
    let horizons: Vec<f64> = (0..=40).map(|k| 1.0 + 0.025 * f64::from(k)).collect();
    let seen: Vec<f64> = { horizons.iter() }
        .map(|d| scaling(*d))
        .collect::<Result<_, _>>()?;
    let printed = |d: &f64| (0.5 + (d - 1.0)).min(1.0);
    let off = seen
        .iter()
        .zip(&horizons)
        .map(|(v, d)| (v - printed(d)).abs());
    found.number("line", largest(off));
    // δ − ξ in radii of a particle: 0 at the rim
    let inside: Vec<f64> = horizons.iter().map(|d| 2.0 * (d - 1.0)).collect();
    let plot = Plot::new("Volume scaling ν")
        .x("(δ − ξ)/r", "")
        .y("ν", "")
        .y_range(0.0, 1.1)
        .line("ν", &inside, &seen);
    found.picture(plot.save(&context.out, "scaling")?);
    let path = context.out.join("scaling.csv");
    Table::new()
        .column("(delta - xi)/r", "", inside)
        .column("nu", "", seen)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
