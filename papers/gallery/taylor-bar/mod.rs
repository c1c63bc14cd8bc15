//! Taylor's bar of copper: its length, its foot, its profile, against axisymmetric finite elements.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, level};
use crate::{Context, Failure, Findings};

experiment!(
    TaylorBar,
    "taylor-bar",
    "A copper bar hits a rigid wall (Taylor)",
    [
        "../bench.rs",
        "deck.toml",
        "../../../verify/classical/taylor.csv"
    ],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
/// The profile of the finite elements: where a place of the side was, where it is, and its radius (mm).
const ELEMENTS: &str = include_str!("../../../verify/classical/taylor.csv");
/// Of the deck (m).
const RADIUS: f64 = 3.2e-3;

/// A layer of points: its height at first and now, and the radius of the bar there, all in m.
struct Layer {
    reference: f64,
    height: f64,
    radius: f64,
}

/// Layers from the foot up. The side of the bar is stretched as the outermost points are.
fn layers(bench: &mut Bench) -> Vec<Layer> {
    let x = bench.sim.vectors("reference");
    let u = bench.sim.vectors("displacement");
    let h = bench.sim.info().spacing;
    let of = |x: &[f64; 3]| (x[2] / h).floor() as usize;
    let radius = |x: f64, y: f64| x.hypot(y);
    let outermost = x.iter().map(|x| radius(x[0], x[1])).fold(0.0, f64::max);
    let count = x.iter().map(of).max().map_or(0, |n| n + 1);
    (0..count)
        .map(|k| {
            let here = || x.iter().zip(&u).filter(|(x, _)| of(x) == k);
            let height = here().map(|(x, u)| x[2] + u[2]).sum::<f64>() / here().count() as f64;
            let side = here().filter(|(x, _)| radius(x[0], x[1]) > outermost * (1.0 - 1e-9));
            let stretches: Vec<f64> = side
                .map(|(x, u)| radius(x[0] + u[0], x[1] + u[1]) / radius(x[0], x[1]))
                .collect();
            Layer {
                reference: (k as f64 + 0.5) * h,
                height,
                radius: RADIUS * stretches.iter().sum::<f64>() / stretches.len() as f64,
            }
        })
        .collect()
}

/// From the lower side of the first layer to the upper side of the last, each half a spacing that is as long as the next bonds say.
fn length(layers: &[Layer]) -> f64 {
    let n = layers.len();
    let spacing = layers[1].reference - layers[0].reference;
    let stretch = |k: usize| (layers[k + 1].height - layers[k].height) / spacing;
    layers[n - 1].height - layers[0].height + 0.5 * spacing * (stretch(0) + stretch(n - 2))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let set: &[(&str, &str)] = match context.small {
        true => &[("constants.h", "radius/3")],
        false => &[],
    };
    let mut bench = Bench::finished(DECK, set)?;
    let elements: Vec<[f64; 3]> = ELEMENTS
        .lines()
        .filter(|l| l.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| {
            let row: Vec<f64> = line.split(',').filter_map(|x| x.parse().ok()).collect();
            [row[0], row[1], row[2]].map(|x| 1e-3 * x)
        })
        .collect();
    let theirs = |c: usize| elements.iter().map(|row| row[c]).collect::<Vec<f64>>();
    let [reference, radii] = [theirs(0), theirs(2)];
    let top = theirs(1).into_iter().fold(0.0, f64::max);

    let layers = layers(&mut bench);
    let ours = |of: &dyn Fn(&Layer) -> f64| layers.iter().map(of).collect::<Vec<f64>>();
    let apart = layers.iter().filter_map(|l| {
        let there = level(&reference, &radii, l.reference)?;
        Some((l.radius - there).abs())
    });
    found.number("length", length(&layers) / top);
    if !context.small {
        found.number("foot", layers[0].radius / radii[0]);
        found.number("profile", apart.fold(0.0, f64::max) / RADIUS);
    }
    let ledger = { bench.sim.ledger() }.map_err(|e| Failure::new(e.to_string()))?;
    found.number("balance", (ledger.residual() / ledger.initial).abs());
    found.number("dissipated", ledger.dissipated / ledger.initial);
    found.measured("length", 1e3 * length(&layers), "mm");
    found.measured("foot radius", 1e3 * layers[0].radius, "mm");
    let strain = bench.values("plastic_strain", 0)?;
    found.measured(
        "largest plastic strain",
        strain.iter().fold(0.0, |m: f64, e| m.max(*e)),
        "",
    );
    bench.drawn(
        context,
        "bar",
        ["plastic_strain", ""],
        About::Motion,
        &mut found,
    )?;

    let milli = |all: Vec<f64>| all.into_iter().map(|x| 1e3 * x).collect::<Vec<f64>>();
    let plot = Plot::new("Profile of the bar after 80 µs")
        .x("radius", "mm")
        .y("height", "mm")
        .line("finite elements", &milli(theirs(2)), &milli(theirs(1)))
        .points(
            "points at the side",
            &milli(ours(&|l| l.radius)),
            &milli(ours(&|l| l.height)),
        );
    found.picture(plot.save(&context.out, "profile")?);
    let path = context.out.join("profile.csv");
    Table::new()
        .column("reference height", "mm", milli(ours(&|l| l.reference)))
        .column("height", "mm", milli(ours(&|l| l.height)))
        .column("radius", "mm", milli(ours(&|l| l.radius)))
        .save(&path)?;
    found.file(path);
    Ok(found)
}
