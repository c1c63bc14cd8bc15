//! A crack through a film on a pulled substrate: the energy that it releases against that of channelling cracks (Beuth).

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit};
use crate::{Context, Failure, Findings};

experiment!(
    ThinFilm,
    "thin-film",
    "A crack through a film on a pulled substrate (Beuth)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): modulus in plane strain (ν = 1/4), strain, thickness of the film, of the body.
const PLANE: f64 = 70e9 / (1.0 - 0.0625);
const STRAIN: f64 = 1e-3;
const FILM: f64 = 10e-6;
const THICKNESS: f64 = 1e-3;
/// An edge crack in a half-plane: K = 1.1215 σ √(πa).
const EDGE: f64 = 1.1215;

/// Energy per length that a channel through a film of the same material releases, over σ² f²/E': that of all its depths.
fn beuth() -> f64 {
    0.5 * EDGE * EDGE * std::f64::consts::PI
}

/// Strain energy with a crack of this depth, and with the film's stress drawn.
fn energy(n: usize, crack: &str, drawn: Option<(&Context, &mut Findings)>) -> Result<f64, Failure> {
    let set = [("constants.n", &*n.to_string()), ("constants.crack", crack)];
    let mut bench = Bench::finished(DECK, &set)?;
    if let Some((context, found)) = drawn {
        bench.drawn(
            context,
            "stress",
            ["stress", "xx"],
            About::Equilibrium,
            found,
        )?;
    }
    bench.probe("body_strain")
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let layers: &[usize] = if context.small { &[3, 5] } else { &[5, 10] };
    let scale = PLANE * (STRAIN * FILM).powi(2) * THICKNESS;
    let depths = [0.2, 0.4, 0.6, 0.8, 1.0];
    let mut plot = Plot::new("Energy that a crack through the film releases")
        .x("depth/thickness of the film", "")
        .y("energy E'/(σ² f²)", "");
    let all: Vec<f64> = (0..=50).map(|k| 0.02 * f64::from(k)).collect();
    let exact: Vec<f64> = all.iter().map(|a| beuth() * a * a).collect();
    plot = plot.line("half-plane", &all, &exact);
    let mut released = vec![];
    for (k, n) in layers.iter().enumerate() {
        context.say(&format!("{n} spacings in the film"));
        let last = k + 1 == layers.len();
        let whole = energy(*n, "0", None)?;
        let depths: Vec<f64> = match context.small || last {
            true => vec![1.0],
            false => depths.to_vec(),
        };
        let mut row = vec![];
        for d in &depths {
            let drawn = (last && *d == 1.0).then_some((context, &mut found));
            row.push((whole - energy(*n, &format!("{d}*f"), drawn)?) / scale);
        }
        plot = plot.points(&format!("f = {n} spacings"), &depths, &row);
        let full = row[row.len() - 1];
        found.measured(
            &format!("energy E'/(σ² f²), {n} spacings in the film"),
            full,
            "",
        );
        let path = context.out.join(format!("released-{n}.csv"));
        Table::new()
            .column("depth/f", "", depths)
            .column("energy E'/(σ² f²)", "", row)
            .save(&path)?;
        found.file(path);
        released.push(full);
    }
    found.picture(plot.save(&context.out, "released")?);
    let end = released.len() - 1;
    let ratio = layers[end] as f64 / layers[end - 1] as f64;
    // the error is of first order in the spacing
    let near = match context.small {
        true => (ratio * released[end] - released[end - 1]) / (ratio - 1.0),
        false => limit(released[end - 1], released[end]),
    };
    found.measured("Beuth's, no mismatch", beuth(), "");
    found.number("released", near / beuth());
    Ok(found)
}
