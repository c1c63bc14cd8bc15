//! A hot bar touches a cold one: the temperature of the contact, and how it spreads.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit};
use crate::{Context, Failure, Findings};

experiment!(
    TouchingBars,
    "touching-bars",
    "A hot bar touches a cold one",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// What is plotted (mm), and every how many points.
const SHOWN: [f64; 2] = [-100.0, 30.0];
const EACH: usize = 4;
/// Of the deck: conductivity (W/m/K), density (kg/m³), capacity (J/kg/K) of copper and steel; how much hotter copper is (K).
const COPPER: [f64; 3] = [400.0, 8960.0, 385.0];
const STEEL: [f64; 3] = [45.0, 7800.0, 460.0];
const HOT: f64 = 100.0;

/// √(k ρ c)
fn effusivity([k, rho, c]: [f64; 3]) -> f64 {
    (k * rho * c).sqrt()
}

/// Temperature of the contact, the same at all times: Carslaw and Jaeger.
fn contact() -> f64 {
    let [a, b] = [COPPER, STEEL].map(effusivity);
    HOT * a / (a + b)
}

/// On each side what spreads from a face of that temperature.
fn exact(x: f64, t: f64) -> f64 {
    let part = |[k, rho, c]: [f64; 3]| libm::erf(x.abs() / (2.0 * (k / (rho * c) * t).sqrt()));
    match x > 0.0 {
        true => contact() * (1.0 - part(STEEL)),
        false => contact() + (HOT - contact()) * part(COPPER),
    }
}

/// Temperature of the contact: copper's gradient, a ninth of that of steel, goes on over the last half of a spacing.
fn face(x: &[f64], values: &[f64]) -> f64 {
    let right = x.iter().position(|x| *x > 0.0).unwrap_or(0);
    match right {
        2.. => 1.5 * values[right - 1] - 0.5 * values[right - 2],
        _ => f64::NAN,
    }
}

/// Places, temperatures at 1, 2 and 4 s, and the largest difference at 4 s.
fn spread(spacing: &str) -> Result<(Vec<f64>, Vec<(f64, Vec<f64>)>, f64), Failure> {
    let mut bench = Bench::new(DECK, &[("constants.h", spacing)])?;
    let x: Vec<f64> = bench.places().iter().map(|x| x[0]).collect();
    let mut seen = vec![];
    for _ in 0..bench.steps() {
        bench.step()?;
        let wanted = [1.0, 2.0, 4.0].get(seen.len());
        let t = bench.sim.time();
        if wanted.is_some_and(|w| t >= w * (1.0 - 1e-9)) {
            seen.push((t, bench.values("temperature", 0)?));
        }
    }
    let Some((t, last)) = seen.last() else {
        return Err(Failure::new("no step was made"));
    };
    let off = x.iter().zip(last).map(|(x, v)| (v - exact(*x, *t)).abs());
    let off = off.fold(0.0, f64::max);
    Ok((x, seen, off))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [double, spacing] = match context.small {
        true => ["2 mm", "1 mm"],
        false => ["1 mm", "0.5 mm"],
    };
    let (wide, before, coarse) = spread(double)?;
    let (x, seen, fine) = spread(spacing)?;
    let last =
        |x: &[f64], seen: &[(f64, Vec<f64>)]| seen.last().map_or(f64::NAN, |s| face(x, &s.1));
    let [rough, near] = [last(&wide, &before), last(&x, &seen)];
    found.measured(&format!("spacing {double}"), rough, "K");
    found.measured(&format!("spacing {spacing}"), near, "K");
    found.number("contact", limit(rough, near));
    found.measured(
        "order of the largest difference",
        (coarse / fine).log2(),
        "",
    );
    let milli: Vec<f64> = x.iter().map(|x| 1e3 * x).collect();
    let mut plot =
        Plot::new("A hot bar of copper touches one of steel: exact (lines) and computed")
            .x("x", "mm")
            .y("temperature", "K")
            .x_range(SHOWN[0], SHOWN[1]);
    // discs that do not touch let the line be seen
    let some = |all: &[f64]| all.iter().step_by(EACH).copied().collect::<Vec<f64>>();
    let mut table = Table::new().column("x", "m", x.clone());
    for (t, values) in &seen {
        found.measured(&format!("contact at {t:.2} s"), face(&x, values), "K");
        let closed: Vec<f64> = x.iter().map(|x| exact(*x, *t)).collect();
        let label = format!("t = {t:.1} s");
        plot = plot
            .line(&label, &milli, &closed)
            .points_of_it(&some(&milli), &some(values));
        table = table.column(&label, "K", values.clone()).column(
            &format!("{label}, exact"),
            "K",
            closed,
        );
    }
    match context.small {
        true => found.measured("largest difference", fine, "K"),
        false => found.number("profile", fine),
    }
    found.picture(plot.save(&context.out, "temperature")?);
    let path = context.out.join("temperature.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_face_is_between_and_heat_that_leaves_one_bar_enters_the_other() {
        assert!((contact() - 74.51).abs() < 0.01, "{}", contact());
        let (t, d) = (2.0, 1e-7);
        let flux = |k: f64, side: f64| k * (exact(side * d, t) - contact()) / (side * d);
        let [left, right] = [flux(COPPER[0], -1.0), flux(STEEL[0], 1.0)];
        assert!((left / right - 1.0).abs() < 1e-6, "{left} {right}");
    }
}
