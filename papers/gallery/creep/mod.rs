//! A viscoelastic bar under a constant load: its creep beside the closed form.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit};
use crate::{Context, Failure, Findings};

experiment!(
    Creep,
    "creep",
    "A viscoelastic bar creeps",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: E (Pa), ν, part that relaxes, its time and that of the ramp (s).
const YOUNG: f64 = 3e9;
const POISSON: f64 = 0.35;
const PART: f64 = 0.6;
const TIME: f64 = 1e-3;
const RAMP: f64 = 0.25e-3;
/// The same with a relaxation that no run lives to see.
const ELASTIC: &str = "[[0.6, \"1e9 s\"]]";

/// Strain over the elastic one, after the ramp.
fn exact(t: f64) -> f64 {
    let bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let left = 1.0 - PART;
    let slow = TIME / left;
    // the mean of e^(−(t − s)/τ) over loads at s, as the ramp brings them
    let spread = slow / RAMP * (RAMP / slow).exp_m1();
    let compliance = (1.0 / left - (1.0 / left - 1.0) * spread * (-t / slow).exp()) / (3.0 * shear);
    YOUNG * (1.0 / (9.0 * bulk) + compliance)
}

/// Stretch of the middle over the elastic one, at every tenth of a millisecond.
fn ratios(spacing: &str) -> Result<[Vec<f64>; 2], Failure> {
    // what damping leaves of the elastic bar's motion is gone by then
    let elastic = [
        ("constants.h", spacing),
        ("material.law.viscoelastic.branches", ELASTIC),
        ("run.duration", "3 ms"),
    ];
    let [_, elastic] = stretches(&elastic)?;
    let unit = elastic.last().copied().unwrap_or(f64::NAN);
    let [times, mut found] = stretches(&[("constants.h", spacing)])?;
    found.iter_mut().for_each(|s| *s /= unit);
    Ok([times, found])
}

/// Stretch of the middle (m) at every tenth of a millisecond.
fn stretches(set: &[(&str, &str)]) -> Result<[Vec<f64>; 2], Failure> {
    let mut bench = Bench::new(DECK, set)?;
    let [mut times, mut found] = [vec![], vec![]];
    for _ in 0..bench.steps() {
        bench.step()?;
        let t = bench.sim.time();
        if t >= 1e-4 * (times.len() + 1) as f64 {
            times.push(t);
            found.push(bench.probe("far_x")? - bench.probe("near_x")?);
        }
    }
    Ok([times, found])
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [t, coarse] = ratios("2.5 mm")?;
    let last = |ratios: &[f64]| ratios.last().copied().unwrap_or(f64::NAN);
    found.number("coarse", last(&coarse));
    found.measured("the closed form then", exact(6e-3), "");
    let fine = match context.small {
        true => coarse.clone(),
        false => ratios("1.25 mm")?[1].clone(),
    };
    let count = t.len().min(fine.len());
    let all: Vec<f64> = (0..count).map(|k| limit(coarse[k], fine[k])).collect();
    let closed: Vec<f64> = t[..count].iter().map(|t| exact(*t)).collect();
    let after = (0..count).filter(|k| t[*k] > TIME);
    let off = after.map(|k| (all[k] - closed[k]).abs());
    if !context.small {
        found.measured("of spacings of 1.25 mm", last(&fine), "");
        found.number("last", last(&all));
        found.number("creep", off.fold(0.0, f64::max));
    }
    let milli: Vec<f64> = t[..count].iter().map(|t| 1e3 * t).collect();
    let plot = Plot::new("Stretch over the elastic one")
        .x("t", "ms")
        .y("ratio", "")
        .line("closed form", &milli, &closed)
        .points("peridyne, limit", &milli, &all);
    found.picture(plot.save(&context.out, "creep")?);
    let path = context.out.join("creep.csv");
    Table::new()
        .column("t", "ms", milli)
        .column("spacing 2.5 mm", "", coarse[..count].to_vec())
        .column("spacing 1.25 mm", "", fine[..count].to_vec())
        .column("limit", "", all)
        .column("closed form", "", closed)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
