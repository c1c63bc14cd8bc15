//! A pulse in a bar against d'Alembert's solution.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::measure::relative_difference;
use crate::{Context, Failure, Findings};

experiment!(
    BarWave,
    "bar-wave",
    "A pulse in a bar (d'Alembert)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: modulus, density, height, width, place.
const E: f64 = 200e9;
const RHO: f64 = 7800.0;
const HEIGHT: f64 = 1e-6;
const WIDTH: f64 = 0.02;
const MIDDLE: f64 = 0.5;

/// d'Alembert's solution.
fn exact(x: f64, t: f64) -> f64 {
    let c = (E / RHO).sqrt();
    let pulse = |x: f64| HEIGHT * (-((x - MIDDLE) / WIDTH).powi(2)).exp();
    0.5 * (pulse(x - c * t) + pulse(x + c * t))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let spacings: &[&str] = if context.small {
        &["4 mm", "2 mm", "1 mm"]
    } else {
        &["4 mm", "2 mm", "1 mm", "0.5 mm"]
    };
    let mut plot = Plot::new("A pulse splits in two that run along a steel bar")
        .x("x", "m")
        .y("displacement", "µm")
        // room for the legend above
        .y_range(-0.1, 0.75);
    let mut off = vec![];
    let mut speed = f64::NAN;
    for (k, h) in spacings.iter().enumerate() {
        let mut bench = Bench::finished(DECK, &[("constants.h", h)])?;
        let x: Vec<f64> = bench.places().iter().map(|x| x[0]).collect();
        let u = bench.values("displacement", 0)?;
        let t = bench.sim.time();
        let true_u: Vec<f64> = x.iter().map(|x| exact(*x, t)).collect();
        off.push(relative_difference(&u, &true_u));
        let right = || x.iter().zip(&u).filter(|(x, _)| **x > MIDDLE);
        let weight: f64 = right().map(|(_, u)| u * u).sum();
        let place = right().map(|(x, u)| x * u * u).sum::<f64>() / weight;
        speed = (place - MIDDLE) / t;
        if k == 0 || k + 1 == spacings.len() {
            let micro: Vec<f64> = u.iter().map(|u| 1e6 * u).collect();
            plot = plot.line(&format!("h = {h}"), &x, &micro);
        }
        if k + 1 == spacings.len() {
            let micro: Vec<f64> = true_u.iter().map(|u| 1e6 * u).collect();
            plot = plot.dashed("d'Alembert", &x, &micro);
            let path = context.out.join("pulse.csv");
            Table::new()
                .column("x", "m", x)
                .column("displacement", "m", u)
                .column("d'Alembert", "m", true_u)
                .save(&path)?;
            found.file(path);
        }
        found.measured(
            &format!("difference from d'Alembert (root of the squares), h = {h}"),
            100.0 * off[k],
            "%",
        );
    }
    found.picture(plot.save(&context.out, "pulse")?);
    found.number("speed", speed);
    found.number("shape", off[off.len() - 1]);
    let n = off.len();
    found.number("order", (off[n - 2] / off[n - 1]).log2());
    Ok(found)
}
