//! Kalthoff and Winkler's plate: the angle of the cracks, their speed.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, CRACKED, fastest, rayleigh, slope};
use crate::{Context, Failure, Findings};

experiment!(
    Kalthoff,
    "kalthoff",
    "Kalthoff and Winkler's plate",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Height of the notches, from where the cracks leave them to where their line is fitted (m).
const NOTCH: f64 = 0.025;
const FITTED: [f64; 2] = [0.03, 0.08];
/// Width over which a tip's speed is taken (s).
const WINDOW: f64 = 1e-5;

/// Degrees between the notch and a crack that goes up (`side` 1) or down (−1), over a range of heights.
fn angle(x: &[[f64; 2]], damage: &[f64], side: f64, [low, high]: [f64; 2]) -> Result<f64, Failure> {
    let count = (1e3 * (high - low)).round() as u32;
    let heights: Vec<f64> = (0..count).map(|k| low + 1e-3 * f64::from(k)).collect();
    let at = heights.iter().map(|height| {
        let near = |k: &usize| damage[*k] > CRACKED && (side * x[*k][1] - height).abs() < 1e-3;
        let first = (0..x.len()).filter(near).map(|k| x[k][0]);
        first.fold(f64::INFINITY, f64::min)
    });
    let at: Vec<f64> = at.collect();
    if at.iter().any(|x| x.is_infinite()) {
        return Err(Failure::new(format!("the crack does not reach {high} m")));
    }
    Ok(90.0 - slope(&heights, &at).atan().to_degrees())
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let h = if context.small { "1 mm" } else { "0.5 mm" };
    let mut bench = Bench::new(DECK, &[("constants.h", h)])?;
    let x = bench.places();
    let steps = bench.steps();
    let every = steps / 100;
    let [mut time, mut tip] = [vec![], vec![]];
    for n in 1..=steps {
        bench.step()?;
        if n % every == 0 {
            let damage = bench.values("damage", 0)?;
            let at = (0..x.len()).filter(|k| damage[*k] > CRACKED && x[*k][0] > 0.045);
            // the length of a crack that goes straight
            let high = at.map(|k| x[k][1]).fold(NOTCH, f64::max);
            time.push(bench.sim.time());
            tip.push(high - NOTCH);
        }
    }
    let damage = bench.values("damage", 0)?;
    let both = [
        angle(&x, &damage, 1.0, FITTED)?,
        angle(&x, &damage, -1.0, FITTED)?,
    ];
    bench.damage(context, "damage", &mut found)?;
    found.number("angle", 0.5 * (both[0] + both[1]));
    let part = |low: f64| angle(&x, &damage, 1.0, [low, low + 0.02]);
    found.measured("angle over the first 20 mm of these", part(FITTED[0])?, "°");
    found.measured("over the last 20 mm", part(FITTED[1] - 0.02)?, "°");
    found.number("symmetric", (both[0] - both[1]).abs());
    let c_r = rayleigh(190e9, 0.3, 8000.0);
    let lean = (0.5 * (both[0] + both[1])).to_radians().sin();
    let speed = fastest(&time, &tip, WINDOW) / lean;
    found.holds(
        "speed",
        format!("{speed:.0} m/s at most, {:.2} c_R", speed / c_r),
        speed > 0.0 && speed < c_r,
    );
    let start = time.iter().zip(&tip).find(|(_, tip)| **tip > 2e-3);
    let start = start.map_or(f64::NAN, |(t, _)| 1e6 * t);
    found.measured("when the upper crack is 2 mm high", start, "µs");
    let micro: Vec<f64> = time.iter().map(|t| 1e6 * t).collect();
    let milli: Vec<f64> = tip.iter().map(|t| 1e3 * t).collect();
    let plot = Plot::new("Height of the upper crack over its notch")
        .x("t", "µs")
        .y("height", "mm")
        .line("tip", &micro, &milli);
    found.picture(plot.save(&context.out, "tip")?);
    let path = context.out.join("tip.csv");
    Table::new()
        .column("time", "s", time)
        .column("height", "m", tip)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
