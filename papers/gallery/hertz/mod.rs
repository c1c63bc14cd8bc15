//! A rigid sphere on a piece of a half-space: force and depth against Hertz, and the circle of contact.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, slope};
use crate::{Context, Failure, Findings};

experiment!(
    Hertz,
    "hertz",
    "A rigid sphere on an elastic half-space (Hertz)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI): modulus, Poisson's ratio of the law, radius of the sphere.
const E: f64 = 70e9;
const NU: f64 = 0.25;
const R: f64 = 0.6;

/// F = 4/3 E* √R d^1.5.
fn hertz(depth: f64) -> f64 {
    4.0 / 3.0 * E / (1.0 - NU * NU) * R.sqrt() * depth.powf(1.5)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let set: &[(&str, &str)] = if context.small {
        &[
            ("constants.h", "2 mm"),
            ("statics.increments", "2"),
            ("statics.tolerance", "1e-4"),
        ]
    } else {
        &[]
    };
    let mut bench = Bench::new(DECK, set)?;
    let [mut depth, mut force] = [vec![], vec![]];
    for n in 1..=bench.steps() {
        context.say(&format!("increment {n}"));
        bench.step()?;
        // on the surface, under the pole: what the sphere sinks into its points does not count
        depth.push(-bench.probe("depth_z")?);
        force.push(bench.probe("force_z")?);
    }
    let last = depth.len() - 1;
    let off: Vec<f64> = depth
        .iter()
        .zip(&force)
        .map(|(d, f)| f / hertz(*d))
        .collect();
    found.measured(
        "force over Hertz's, by increments",
        format!("{off:.3?}"),
        "",
    );
    found.measured("depth", 1e6 * depth[last], "µm");
    found.number("force", off[last]);
    if !context.small {
        let logs = |v: &[f64]| v.iter().map(|x| x.ln()).collect::<Vec<f64>>();
        found.number("exponent", slope(&logs(&depth), &logs(&force)));
    }
    // depth of the surface beside the contact, as Hertz has it: d(2 − (r/a)²)/2 within
    let x = bench.sim.vectors("reference");
    let u = bench.sim.vectors("displacement");
    let h = bench.sim.info().spacing;
    let mut line: Vec<[f64; 2]> = (0..x.len())
        .filter(|k| x[*k][2] > -0.1 * h && x[*k][1].abs() < 0.1 * h && x[*k][0] >= 0.0)
        .map(|k| [x[k][0], -u[k][2]])
        .collect();
    line.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let d = depth[last];
    let a = (R * d).sqrt();
    let exact = |r: f64| match r < a {
        true => d - r * r / (2.0 * R),
        false => {
            let q = a / r;
            let part = (2.0 - q.powi(-2)) * q.asin() + (q.powi(-2) - 1.0).sqrt();
            d / std::f64::consts::PI * part
        }
    };
    let within = line.iter().filter(|p| p[0] < 3.0 * a);
    let apart = within.map(|p| (p[1] - exact(p[0])).abs() / d);
    found.number("surface", apart.fold(0.0, f64::max));
    found.measured("radius of the contact, by Hertz", 1e3 * a, "mm");
    let milli: Vec<f64> = line.iter().map(|p| 1e3 * p[0]).collect();
    let micro: Vec<f64> = line.iter().map(|p| 1e6 * p[1]).collect();
    let fine: Vec<f64> = (0..=200).map(|k| 1e-4 * f64::from(k)).collect();
    let plot = Plot::new("The surface beside the sphere")
        .x("distance from the pole", "mm")
        .y("depth", "µm")
        .points("peridyne", &milli, &micro)
        .line(
            "Hertz",
            &fine.iter().map(|r| 1e3 * r).collect::<Vec<_>>(),
            &fine.iter().map(|r| 1e6 * exact(*r)).collect::<Vec<_>>(),
        );
    found.picture(plot.save(&context.out, "surface")?);
    let path = context.out.join("force.csv");
    Table::new()
        .column("depth", "m", depth)
        .column("force", "N", force)
        .column("over Hertz's", "", off)
        .save(&path)?;
    found.file(path);
    bench.drawn(
        context,
        "stress",
        ["stress", "zz"],
        About::Equilibrium,
        &mut found,
    )?;
    Ok(found)
}
