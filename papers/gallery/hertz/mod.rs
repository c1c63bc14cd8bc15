//! A rigid sphere on a piece of a half-space: force and depth against Hertz, and the circle of contact; then pushed along it, and back, against
//! Cattaneo and Mindlin.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, slope};
use crate::{Context, Failure, Findings};

experiment!(
    Hertz,
    "hertz",
    "A rigid sphere on an elastic half-space (Hertz)",
    ["../bench.rs", "deck.toml", "shear.toml"]
);

const DECK: &str = include_str!("deck.toml");
const SHEAR: &str = include_str!("shear.toml");
/// Of the deck (SI): modulus, Poisson's ratio of the law, radius of the sphere.
const E: f64 = 70e9;
const NU: f64 = 0.25;
const R: f64 = 0.6;
/// Of the deck that pushes: friction, and the depth.
const MU: f64 = 0.3;
const DEPTH: f64 = 6e-5;
/// Its increments: pressed, pushed, all.
const PRESSED: usize = 2;
const PUSHED: usize = 5;

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
    pushed_along(context, &mut found)?;
    Ok(found)
}

/// The way D at which all of the contact slides.
fn sliding_way() -> f64 {
    MU * DEPTH * (2.0 - NU) / (2.0 * (1.0 - NU))
}

/// Force along the surface over μ F at a way from the pressed state, all of it the first loading.
fn mindlin(way: f64) -> f64 {
    1.0 - (1.0 - way / sliding_way()).max(0.0).powf(1.5)
}

/// The same on the way back from a force and a way.
fn back_from([force, way]: [f64; 2], now: f64) -> f64 {
    force - 2.0 * mindlin(0.5 * (way - now))
}

/// Presses, pushes along and lets go; the way is that of the point under the pole, which sticks.
fn pushed_along(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let set: &[(&str, &str)] = match context.small {
        true => &[("constants.h", "2 mm"), ("statics.tolerance", "1e-4")],
        false => &[],
    };
    let mut bench = Bench::new(SHEAR, set)?;
    let [mut way, mut force] = [vec![], vec![]];
    let mut pressed = [0.0; 2];
    for n in 1..=bench.steps() as usize {
        context.say(&format!("pushed along, increment {n}"));
        bench.step()?;
        let now = [bench.probe("way_x")?, -bench.probe("force_x")?];
        if n == PRESSED {
            pressed = now;
        }
        if n >= PRESSED {
            way.push(now[0] - pressed[0]);
            force.push((now[1] - pressed[1]) / (MU * bench.probe("force_z")?));
        }
    }
    let turn = PUSHED - PRESSED;
    let exact: Vec<f64> = (0..way.len())
        .map(|n| match n <= turn {
            true => mindlin(way[n]),
            false => back_from([force[turn], way[turn]], way[n]),
        })
        .collect();
    let off: Vec<f64> = force.iter().zip(&exact).map(|(f, e)| f - e).collect();
    let most = |part: &[f64]| part.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    found.measured(
        "force along the surface over μF",
        format!("{force:.3?}"),
        "",
    );
    found.measured(
        "that of Mindlin at the same ways",
        format!("{exact:.3?}"),
        "",
    );
    found.number("shear", most(&off[..=turn]));
    found.number("shear_back", most(&off[turn..]));
    found.measured(
        "energy that slip took",
        format!("{:.3}", 1e3 * bench.probe("sphere_energy_dissipated")?),
        "mJ",
    );
    let d = sliding_way();
    let over = |v: &[f64]| v.iter().map(|x| x / d).collect::<Vec<f64>>();
    let fine: Vec<f64> = (0..=100).map(|k| 0.01 * d * f64::from(k)).collect();
    let top = way[turn];
    let back: Vec<f64> = fine.iter().map(|x| x * top / d).collect();
    let plot = Plot::new("A sphere is pushed along, and back")
        .x("way over that at which all slides", "")
        .y("force over μF", "")
        .points("peridyne", &over(&way), &force)
        .line(
            "Mindlin",
            &over(&fine),
            &fine.iter().map(|x| mindlin(*x)).collect::<Vec<_>>(),
        )
        .line(
            "Mindlin, back",
            &over(&back),
            &back
                .iter()
                .map(|x| back_from([force[turn], top], *x))
                .collect::<Vec<_>>(),
        );
    found.picture(plot.save(&context.out, "shear")?);
    let path = context.out.join("shear.csv");
    Table::new()
        .column("way", "m", way)
        .column("force over friction", "", force)
        .column("Mindlin's", "", exact)
        .save(&path)?;
    found.file(path);
    Ok(())
}
