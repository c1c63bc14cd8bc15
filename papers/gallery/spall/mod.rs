//! Spall of a bar: where the layer comes off, and how fast it flies.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    Spall,
    "spall",
    "A flyer throws a layer off a bar (spall)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (m, m/s).
const TARGET: f64 = 0.04;
const V: f64 = 40.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut bench = Bench::finished(DECK, &[])?;
    let x: Vec<f64> = bench.places().iter().map(|x| x[0]).collect();
    let v = bench.values("velocity", 0)?;
    let damage = bench.values("damage", 0)?;
    // the middle of what is damaged
    let worn: f64 = damage.iter().sum();
    let place = x.iter().zip(&damage).map(|(x, d)| x * d).sum::<f64>() / worn;
    let mean = |of: &dyn Fn(f64) -> bool| {
        let all: Vec<f64> = { x.iter().zip(&v) }
            .filter(|(x, _)| of(**x))
            .map(|(_, v)| *v)
            .collect();
        all.iter().sum::<f64>() / all.len() as f64
    };
    let path = context.out.join("spall.csv");
    Table::new()
        .column("x", "m", x.clone())
        .column("velocity", "m/s", v.clone())
        .column("damage", "", damage)
        .save(&path)?;
    found.file(path);
    let mut plot = Plot::new("Velocity after 20 µs: the layer flies")
        .x("x", "m")
        .y("velocity", "m/s");
    plot = plot.line("velocity", &x, &v);
    found.picture(plot.save(&context.out, "velocity")?);
    found.number("thickness", 1e3 * (TARGET - place));
    found.number("layer", mean(&|x| x > place) / V);
    found.number("rest", mean(&|x| x < place) / V);
    // a strong bar holds
    let strong = ("material.fracture.critical_stretch", "0.0045");
    let whole = Bench::finished(DECK, &[strong])?;
    let broken = whole.sim.broken();
    found.holds("holds", format!("{broken} bonds broken"), broken == 0);
    Ok(found)
}
