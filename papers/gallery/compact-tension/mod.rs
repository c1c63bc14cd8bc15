//! Compact tension: compliance, and the load at which the first bonds break, against ASTM E399.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    CompactTension,
    "compact-tension",
    "Compact tension (ASTM E399)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): modulus, energy of fracture, thickness, width; a/W = 0.5.
const E: f64 = 3e9;
const G: f64 = 500.0;
const B: f64 = 0.01;
const W: f64 = 0.05;
/// f(a/W) of E399 at 0.5, and E B v/P there.
const F: f64 = 9.66;

/// E B v/P on the line of load (Saxena and Hudak 1978, in E399 and E1820).
fn compliance(ratio: f64) -> f64 {
    let c = [2.163, 12.219, -20.065, -0.9925, 20.609, -9.9314];
    let sum = c.iter().rev().fold(0.0, |sum, c| sum * ratio + c);
    ((1.0 + ratio) / (1.0 - ratio)).powi(2) * sum
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let h = if context.small { "2 mm" } else { "1 mm" };
    let mut bench = Bench::new(DECK, &[("constants.h", h)])?;
    let columns = bench.sim.probe_columns();
    let at = |name: &str| {
        let k = columns.iter().position(|c| c.name == name);
        k.ok_or_else(|| Failure::new(format!("no probe {name}")))
    };
    let [load, upper] = [at("load_y")?, at("upper_y")?];
    let [mut opening, mut force, mut broken] = [vec![0.0], vec![0.0], vec![0.0]];
    for _ in 0..bench.steps() {
        bench.step()?;
        let probes = bench.sim.measure();
        opening.push(2.0 * probes[upper]);
        force.push(probes[load]);
        broken.push(bench.sim.broken() as f64);
    }
    let critical = (E * G).sqrt() * B * W.sqrt() / F;
    let first = broken.iter().position(|b| *b > 0.0);
    let first = first.ok_or_else(|| Failure::new("nothing breaks"))?;
    if !context.small {
        let soft = E * B * opening[1] / force[1] / compliance(0.5);
        found.number("compliance", soft);
        found.number("first", force[first] / critical);
    }
    found.measured("load at which K is K_c", critical, "N");
    found.measured(
        "load of the increment before the first bonds break",
        force[first - 1],
        "N",
    );
    found.measured(
        "load of the increment in which they break",
        force[first],
        "N",
    );
    let top = force.iter().fold(0.0, |t: f64, f| t.max(*f));
    found.measured("largest load", top, "N");
    let last = force[force.len() - 1];
    found.holds(
        "descends",
        format!("{last:.0} N at the end, {top:.0} N at most"),
        last < 0.8 * top,
    );
    bench.damage(context, "damage", &mut found)?;
    let milli: Vec<f64> = opening.iter().map(|v| 1e3 * v).collect();
    let plot = Plot::new("Load over opening")
        .x("opening", "mm")
        .y("load", "N")
        .line("load", &milli, &force)
        .dashed(
            "elastic (ASTM E399)",
            &[0.0, 1e3 * compliance(0.5) * critical / (E * B)],
            &[0.0, critical],
        );
    found.picture(plot.save(&context.out, "load")?);
    let path = context.out.join("load.csv");
    Table::new()
        .column("opening", "m", opening)
        .column("load", "N", force)
        .column("broken directed bonds", "", broken)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
