//! Three-point bending: deflection of a beam, stress intensity of a notched one and the load at which it begins to break.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    ThreePointBend,
    "three-point-bend",
    "Three-point bending (Timoshenko, ASTM E399)",
    ["../bench.rs", "deck.toml", "beam.toml"]
);

const DECK: &str = include_str!("deck.toml");
const BEAM: &str = include_str!("beam.toml");
/// Of the decks (SI): modulus, thickness, height, load; Poisson's ratio of the law in plane stress.
const E: f64 = 3e9;
const B: f64 = 0.01;
const W: f64 = 0.02;
const P: f64 = 10.0;
const NU: f64 = 1.0 / 3.0;
/// Energy of fracture where the notched beam may break (J/m²).
const G: f64 = 500.0;
/// Part of the handbook's critical load by which an increment raises it.
const INCREMENT: f64 = 0.02;

/// K B √W/P of the bend specimen, four times as long as high, at a/W = x (Srawley 1976, in ASTM E399).
fn intensity(x: f64) -> f64 {
    let f = 3.0 * x.sqrt() * (1.99 - x * (1.0 - x) * (2.15 - 3.93 * x + 2.7 * x * x))
        / (2.0 * (1.0 + 2.0 * x) * (1.0 - x).powf(1.5));
    4.0 * f
}

/// Deflection of Timoshenko's beam: P L³/48 E I + P L/4 κ G A, with the κ of Cowper (1966) for a rectangle.
fn deflection(length: f64) -> f64 {
    let kappa = 10.0 * (1.0 + NU) / (12.0 + 11.0 * NU);
    let (inertia, area) = (B * W.powi(3) / 12.0, B * W);
    let shear = E / (2.0 * (1.0 + NU));
    P * length.powi(3) / (48.0 * E * inertia) + P * length / (4.0 * kappa * shear * area)
}

/// Deflection of the axis in the middle, seen from the axis above the supports.
fn bent(length: f64, h: &str) -> Result<f64, Failure> {
    let mut bench = Bench::finished(BEAM, &[("constants.h", h)])?;
    let (x, u) = (bench.places(), bench.values("displacement", 1)?);
    let at = |place: f64| {
        let near = |p: &[f64; 2]| (p[0] - place).hypot(p[1] - 0.5 * W) < 1e-6;
        let found = x.iter().position(near).map(|k| u[k]);
        found.ok_or_else(|| Failure::new(format!("no point on the axis at {place}")))
    };
    Ok(0.5 * (at(-0.5 * length)? + at(0.5 * length)?) - at(0.0)?)
}

/// K of the notched beam over the handbook's.
fn notched(context: &Context, part: f64, h: &str, found: &mut Findings) -> Result<f64, Failure> {
    let a = format!("{part}*W");
    let mut bench = Bench::finished(DECK, &[("constants.h", h), ("constants.a", &a)])?;
    if part == 0.5 {
        let about = peridyne_io::write::picture::shown::About::Equilibrium;
        bench.drawn(context, "stress", ["stress", "xx"], about, found)?;
    }
    Ok(bench.probe("tip_K")? * B * W.sqrt() / (P * intensity(part)))
}

/// Loads of the increment before the first bonds break and of that in which they do, over that at which K is K_c.
fn breaks(h: &str) -> Result<[f64; 2], Failure> {
    let critical = (E * G).sqrt() * B * W.sqrt() / intensity(0.5);
    // from 0.9 on in small increments
    let last = 0.9 + INCREMENT * 20.0;
    let set = [
        ("constants.h", h),
        ("constants.P", &*format!("{} N", last * critical)),
        ("constants.first", &*format!("{}", 0.9 / last)),
        ("material.fracture.energy", "500 J/m^2"),
        ("statics.method", "relaxation"),
        ("statics.tolerance", "1e-4"),
        ("statics.increments", "20"),
    ];
    let mut bench = Bench::new(DECK, &set)?;
    for n in 1..=bench.steps() {
        bench.step()?;
        if bench.sim.broken() > 0 {
            let now = 0.9 + INCREMENT * n as f64;
            return Ok([now - INCREMENT, now]);
        }
    }
    Err(Failure::new("nothing breaks"))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [beams, notches]: [&[&str]; 2] = if context.small {
        [&["1 mm"], &["0.5 mm"]]
    } else {
        [&["2 mm", "1 mm", "0.5 mm"], &["0.5 mm", "0.25 mm"]]
    };
    let mut ratio = f64::NAN;
    for h in beams {
        context.say(&format!("beam, spacing {h}"));
        ratio = bent(0.2, h)? / deflection(0.2);
        found.measured(&format!("deflection over Timoshenko's, h = {h}"), ratio, "");
    }
    found.number("deflection", ratio);
    let slender = P * 0.2f64.powi(3) / (4.0 * E * B * W.powi(3));
    let key = "Timoshenko's deflection over Euler and Bernoulli's";
    found.measured(key, deflection(0.2) / slender, "");
    let parts = [0.3, 0.5, 0.7];
    let mut plot = Plot::new("Stress intensity of a notched beam")
        .x("a/W", "")
        .y("K B sqrt(W)/P", "");
    let mut table = Table::new().column("a/W", "", parts.to_vec());
    let exact: Vec<f64> = (20..=80).map(|k| intensity(0.01 * f64::from(k))).collect();
    let along: Vec<f64> = (20..=80).map(|k| 0.01 * f64::from(k)).collect();
    plot = plot.line("ASTM E399", &along, &exact);
    let mut middle = vec![];
    for (k, h) in notches.iter().enumerate() {
        context.say(&format!("notched, spacing {h}"));
        let mut off = vec![];
        for part in parts {
            let mut own = Findings::new();
            off.push(notched(context, part, h, &mut own)?);
            if k + 1 == notches.len() {
                own.files.into_iter().for_each(|f| found.file(f));
            }
        }
        let all: Vec<f64> = off
            .iter()
            .zip(parts)
            .map(|(o, p)| o * intensity(p))
            .collect();
        plot = plot.points(&format!("h = {h}"), &parts, &all);
        table = table.column(&format!("K over ASTM's, h = {h}"), "", off.clone());
        found.measured(
            &format!("K over ASTM's, a/W = 0.3, 0.5, 0.7, h = {h}"),
            format!("{off:.4?}"),
            "",
        );
        middle.push(off[1]);
    }
    found.picture(plot.save(&context.out, "intensity")?);
    let path = context.out.join("intensity.csv");
    table.save(&path)?;
    found.file(path);
    found.number("intensity", middle[middle.len() - 1]);
    if !context.small {
        let [before, now] = breaks("0.5 mm")?;
        found.measured(
            "load before the first bonds break, over that of K_c",
            before,
            "",
        );
        found.number("first", now);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_specimen_of_half_a_notch_is_that_of_the_standard() {
        // E399 prints f(0.5) = 2.66
        assert!((intensity(0.5) / 4.0 - 2.66).abs() < 0.005);
    }
}
