//! Cracks of a quench: when they begin, how far apart and how long they are.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, CRACKED, level};
use crate::{Context, Failure, Findings};

experiment!(
    Quench,
    "quench",
    "Cracks of a quench",
    ["../bench.rs", "deck.toml"],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: conductivity (W/m/K), heat per volume (J/m³/K), exchange with water (W/m²/K), how much hotter and how hot (K),
/// expansion (1/K).
const CONDUCTIVITY: f64 = 31.0;
const CAPACITY: f64 = 3980.0 * 880.0;
const EXCHANGE: f64 = 65e3;
const HOTTER: f64 = 280.0;
const HOT: f64 = 573.15;
const EXPANSION: f64 = 7.5e-6;
/// The weakest bonds break at this part of the critical stretch.
const WEAKEST: f64 = 0.95;

/// `verify/classical/quench.py`, 32 elements: lengths (mm) up to which cracks so far apart (mm) stay equal.
const LENGTHS: [f64; 5] = [0.786, 1.316, 1.872, 2.454, 3.661];
const NEAREST: [f64; 5] = [1.5, 2.0, 2.5, 3.0, 4.0];
/// From the same: how far apart (mm), how long (mm) after 0.1 s.
const SPACINGS: [f64; 5] = [2.0, 2.5, 3.0, 4.0, 5.0];
const EQUAL: [f64; 5] = [1.883, 2.021, 2.152, 2.412, 2.664];

/// Depths (mm) at which cracks are counted.
const DEPTHS: [f64; 2] = [1.0, 1.5];
/// Cracked points of a row that are further apart than this (mm) are of two cracks; a crack leans by no more than that per row.
const GAP: f64 = 0.35;

/// Temperature (K) at a depth (m) after a time (s): a half space and a fluid, Carslaw and Jaeger 2.7.
fn exact(y: f64, t: f64) -> f64 {
    let reach = (CONDUCTIVITY / CAPACITY * t).sqrt();
    let (z, b) = (y / (2.0 * reach), EXCHANGE * reach / CONDUCTIVITY);
    let film = (2.0 * z * b + b * b).exp() * libm::erfc(z + b);
    HOT - HOTTER * (libm::erfc(z) - film)
}

/// Where cracks cross a row (mm).
fn crossings(x: &[[f64; 2]], damage: &[f64], row: f64, h: f64) -> Vec<f64> {
    let of_row = |k: &usize| (1e3 * x[*k][1] - row).abs() < 0.51 * h && damage[*k] > CRACKED;
    let mut cracked: Vec<f64> = (0..x.len()).filter(of_row).map(|k| 1e3 * x[k][0]).collect();
    cracked.sort_by(f64::total_cmp);
    let cracks = cracked.chunk_by(|a, b| b - a < GAP);
    cracks
        .map(|c| c.iter().sum::<f64>() / c.len() as f64)
        .collect()
}

/// How deep the crack reaches that crosses a row here (mm).
fn tip(x: &[[f64; 2]], damage: &[f64], [mut at, mut row]: [f64; 2], h: f64) -> f64 {
    loop {
        let next = crossings(x, damage, row + h, h);
        match next.into_iter().find(|c| (c - at).abs() < GAP) {
            Some(here) => [at, row] = [here, row + h],
            None => return row,
        }
    }
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (length, seconds) = match context.small {
        true => (10.0, "0.004"),
        false => (50.0, "0.1"),
    };
    let mut bench = Bench::new(
        DECK,
        &[
            ("constants.L", &format!("{length} mm")),
            ("constants.seconds", seconds),
        ],
    )?;
    let x = bench.places();
    let h = 1e3 * bench.sim.info().spacing;
    let critical = bench.sim.info().critical_stretch[0];
    let steps = bench.steps();
    let mut first = f64::NAN;
    for n in 1..=steps {
        bench.step()?;
        if first.is_nan() && n % 10 == 0 && bench.sim.broken() > 0 {
            let coldest = bench.values("temperature", 0)?;
            let coldest = coldest.into_iter().fold(f64::INFINITY, f64::min);
            first = EXPANSION * (HOT - coldest) / (WEAKEST * critical);
        }
    }
    found.number("first", first);
    let seconds: f64 = seconds.parse().map_err(|e| Failure::new(format!("{e}")))?;
    let temperature = bench.values("temperature", 0)?;
    let off = x.iter().zip(&temperature);
    let off = off.map(|(x, t)| (t - exact(x[1], seconds)).abs());
    found.measured(
        "largest difference from the temperature of a half space, all points",
        off.fold(0.0, f64::max),
        "K",
    );
    let column = 0..x.len();
    let column: Vec<usize> = column.filter(|k| 1e3 * x[*k][0] < h).collect();
    let depth: Vec<f64> = column.iter().map(|k| 1e3 * x[*k][1]).collect();
    let closed: Vec<f64> = column.iter().map(|k| exact(x[*k][1], seconds)).collect();
    let here: Vec<f64> = column.iter().map(|k| temperature[*k]).collect();
    let deep = 3.0 * h;
    let off = depth.iter().zip(here.iter().zip(&closed));
    let off = off
        .filter(|(y, _)| **y > deep)
        .map(|(_, (a, b))| (a - b).abs());
    found.number("temperature", off.fold(0.0, f64::max));
    let plot = Plot::new("Temperature below the edge")
        .x("y", "mm")
        .y("temperature", "K")
        .line("exact", &depth, &closed)
        .points("computed", &depth, &here);
    found.picture(plot.save(&context.out, "temperature")?);
    bench.damage(context, "damage", &mut found)?;
    if context.small {
        return Ok(found);
    }
    let damage = bench.values("damage", 0)?;
    let mut said = vec![];
    let (mut within, mut apart) = (true, f64::NAN);
    for depth in DEPTHS {
        apart = length / crossings(&x, &damage, depth, h).len() as f64;
        let nearest = level(&LENGTHS, &NEAREST, depth).unwrap_or(f64::NAN);
        let between = [nearest, 2.0 * nearest];
        within &= between[0] <= apart && apart <= between[1];
        said.push(format!(
            "{apart:.2} mm at a depth of {depth} mm ({between:.2?})"
        ));
    }
    found.holds("spacing", said.join(", "), within);
    let long = crossings(&x, &damage, DEPTHS[1], h);
    let lengths: Vec<f64> = long
        .iter()
        .map(|c| tip(&x, &damage, [*c, DEPTHS[1]], h))
        .collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    found.measured("mean length of the long cracks", mean, "mm");
    found.measured("long cracks", long.len() as f64, "");
    let equal = level(&SPACINGS, &EQUAL, apart).unwrap_or(f64::NAN);
    found.number("length", mean / equal);
    let path = context.out.join("cracks.csv");
    Table::new()
        .column("x", "mm", long)
        .column("length", "mm", lengths)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
