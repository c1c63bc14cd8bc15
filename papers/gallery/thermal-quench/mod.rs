//! Quench of a plate of alumina: cracks that grow from its edge, their number and lengths at three temperatures.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, CRACKED};
use crate::{Context, Failure, Findings};

experiment!(
    ThermalQuench,
    "thermal-quench",
    "Quench of a plate of alumina",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): length of the plate, conductivity, diffusivity, coefficient of convection, water.
const LENGTH: f64 = 0.024;
const CONDUCTIVITY: f64 = 31.0;
const DIFFUSIVITY: f64 = CONDUCTIVITY / (3980.0 * 880.0);
const CONVECTION: f64 = 70e3;
const WATER: f64 = 293.0;

/// Temperature of the surface of a half-space with convection over what it was, beyond the water's (Carslaw & Jaeger): `e^{s²} erfc s`, `s = h√(κt)/k`.
fn surface(t: f64) -> f64 {
    let s = CONVECTION * (DIFFUSIVITY * t).sqrt() / CONDUCTIVITY;
    // the continued fraction of erfc; of 200 terms the rest is below 1e-5 for s above 0.3
    let tail = (1..200)
        .rev()
        .fold(s, |below, n| s + 0.5 * f64::from(n) / below);
    1.0 / (std::f64::consts::PI.sqrt() * tail)
}

/// Cracks at a depth: runs of points of a row that have lost as much as those beside a crack.
fn cracks(bench: &mut Bench, depth: f64) -> Result<usize, Failure> {
    let h = bench.sim.info().spacing;
    let damage = bench.values("damage", 0)?;
    let mut row: Vec<(f64, f64)> = bench
        .places()
        .into_iter()
        .zip(damage)
        .filter(|(x, _)| (x[1] - depth).abs() < 0.5 * h)
        .map(|(x, d)| (x[0], d))
        .collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    let torn: Vec<bool> = row.iter().map(|(_, d)| *d > CRACKED).collect();
    Ok((0..torn.len())
        .filter(|k| torn[*k] && (*k == 0 || !torn[k - 1]))
        .count())
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let temperatures: &[&str] = if context.small {
        &["573 K", "873 K"]
    } else {
        &["573 K", "673 K", "873 K"]
    };
    // cells of 0.2 mm: depths between rows of their middles
    let depths = [0.5e-3, 0.9e-3, 1.5e-3, 2.1e-3, 2.9e-3, 3.5e-3];
    let small: &[(&str, &str)] = match context.small {
        true => &[("constants.h", "0.25 mm"), ("statics.increments", "8")],
        false => &[],
    };
    let mut counts = vec![];
    let mut table = Table::new().column("depth", "m", depths.to_vec());
    let mut plot = Plot::new("Cracks that reach a depth")
        .x("depth", "mm")
        .y("cracks on 24 mm", "");
    let milli = depths.map(|d| 1e3 * d);
    for hot in temperatures {
        context.say(&format!("from {hot}"));
        let mut set = vec![("constants.hot", *hot)];
        set.extend(small);
        let mut bench = Bench::finished(DECK, &set)?;
        let all = depths.map(|d| cracks(&mut bench, d));
        let all: Vec<f64> = all
            .into_iter()
            .map(|n| n.map(|n| n as f64))
            .collect::<Result<_, _>>()?;
        found.measured(
            &format!("cracks at depths of {milli:?} mm, from {hot}"),
            format!("{all:?}"),
            "",
        );
        table = table.column(&format!("cracks from {hot}"), "", all.clone());
        plot = plot.points(&format!("from {hot}"), &milli, &all);
        bench.damage(context, &format!("damage-{}", &hot[..3]), &mut found)?;
        counts.push(all);
    }
    found.picture(plot.save(&context.out, "cracks")?);
    let path = context.out.join("cracks.csv");
    table.save(&path)?;
    found.file(path);
    let (cold, warm) = (&counts[0], &counts[counts.len() - 1]);
    let words = |all: &[f64]| format!("{} and {}", all[0], all[3]);
    found.holds(
        "more",
        format!(
            "{} cracks from {}, {} from {}",
            cold[0],
            temperatures[0],
            warm[0],
            temperatures[temperatures.len() - 1]
        ),
        cold[0] < warm[0],
    );
    found.holds(
        "longer",
        format!("{} and {} cracks at 2.1 mm", cold[3], warm[3]),
        cold[3] < warm[3],
    );
    found.holds(
        "classes",
        format!("at 0.5 mm and 2.1 mm {} cracks", words(warm)),
        warm[3] >= 1.0 && warm[3] < warm[0],
    );
    found.measured("spacing at 0.5 mm from the hottest", LENGTH / warm[0], "m");
    // heat alone, at 2 ms
    let heat = [
        ("statics.duration", "2 ms"),
        ("statics.increments", "20"),
        ("material.fracture.energy", "1 MJ/m^2"),
        ("constants.h", "0.1 mm"),
        ("constants.L", "2 mm"),
    ];
    let mut bench = Bench::finished(DECK, &heat)?;
    let at = bench.places();
    let t = bench.values("temperature", 0)?;
    let nearest = |depth: f64| {
        let off = |k: &usize| (at[*k][1] - depth).abs() + (at[*k][0] - 1e-3).abs();
        (0..at.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    // the surface is half a spacing below the first row, and exchange is at that row
    let edge = nearest(0.05e-3).map_or(f64::NAN, |k| t[k]);
    found.number("heat", (edge - WATER) / (673.0 - WATER) / surface(2e-3));
    Ok(found)
}
