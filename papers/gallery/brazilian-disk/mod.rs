//! The Brazilian disk: stresses in its middle, and along the loaded diameter.

use std::f64::consts::PI;

use peridyne_io::write::plot::Plot;

use crate::gallery::bench::{Bench, level};
use crate::{Context, Failure, Findings};

experiment!(
    BrazilianDisk,
    "brazilian-disk",
    "A disk pressed along its diameter (Brazilian test)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// 2P/(π D t) of the deck (Pa).
const SPLITTING: f64 = 2.0 * 1e3 / (PI * 0.05 * 0.01);
const RADIUS: f64 = 0.025;

/// Stresses over 2P/(π D t): in the middle across and along, and across on the horizontal diameter.
struct Disk {
    spacing: f64,
    middle: [f64; 2],
    x: Vec<f64>,
    across: Vec<f64>,
}

fn disk(context: &Context, h: &str, drawn: bool, found: &mut Findings) -> Result<Disk, Failure> {
    context.say(&format!("spacing {h}"));
    let mut bench = Bench::finished(DECK, &[("constants.h", h)])?;
    let places = bench.places();
    let over = |v: Vec<f64>| v.iter().map(|s| s / SPLITTING).collect::<Vec<f64>>();
    let [xx, yy] = [
        over(bench.values("stress", 0)?),
        over(bench.values("stress", 1)?),
    ];
    if drawn {
        bench.map(context, ["stress_xx/(2P/πDt)", ""], &xx, [-1.0, 1.0], found)?;
    }
    let spacing = bench.sim.info().spacing;
    let mut line: Vec<usize> = (0..places.len())
        .filter(|k| places[*k][1].abs() < 0.1 * spacing)
        .collect();
    line.sort_by(|a, b| places[*a][0].total_cmp(&places[*b][0]));
    let x: Vec<f64> = line.iter().map(|k| places[*k][0] / RADIUS).collect();
    let on = |v: &[f64]| line.iter().map(|k| v[*k]).collect::<Vec<f64>>();
    let (across, along) = (on(&xx), on(&yy));
    let middle = |v: &[f64]| level(&x, v, 0.0).ok_or_else(|| Failure::new("no middle"));
    Ok(Disk {
        spacing,
        middle: [middle(&across)?, middle(&along)?],
        across,
        x,
    })
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let spacings: &[&str] = if context.small {
        &["2 mm", "1 mm"]
    } else {
        &["1 mm", "0.5 mm", "0.25 mm"]
    };
    let mut disks = vec![];
    for (k, h) in spacings.iter().enumerate() {
        disks.push(disk(context, h, k + 1 == spacings.len(), &mut found)?);
    }
    let mut plot = Plot::new("Stress across the load on the level diameter")
        .x("x/R", "")
        .y("stress_xx/(2P/πDt)", "");
    for d in &disks {
        plot = plot.points(&format!("h = R/{:.0}", RADIUS / d.spacing), &d.x, &d.across);
        for (what, value) in ["across", "along"].iter().zip(d.middle) {
            let label = format!("{what} the load, h = R/{:.0}", RADIUS / d.spacing);
            found.measured(&label, value, "2P/(πDt)");
        }
    }
    let x: Vec<f64> = (-100..=100).map(|k| 0.01 * f64::from(k)).collect();
    // Hertz: (1 − x²)²/(1 + x²)² across
    let exact: Vec<f64> = x
        .iter()
        .map(|x| ((1.0 - x * x) / (1.0 + x * x)).powi(2))
        .collect();
    plot = plot.line("Hertz", &x, &exact);
    found.picture(plot.save(&context.out, "diameter")?);
    let fine = &disks[disks.len() - 1];
    found.number("across", fine.middle[0]);
    found.number("along", fine.middle[1]);
    let off: Vec<f64> = disks.iter().map(|d| (d.middle[0] - 1.0).abs()).collect();
    found.holds(
        "trend",
        format!("off by {off:.4?}"),
        off.windows(2).all(|o| o[1] < o[0]),
    );
    Ok(found)
}
