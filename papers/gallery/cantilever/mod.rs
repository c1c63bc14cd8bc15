//! Frequencies of a cantilever against the beams of Timoshenko and of Euler and Bernoulli.

use std::f64::consts::PI;

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::Bench;
use crate::{Context, Failure, Findings};

experiment!(
    Cantilever,
    "cantilever",
    "Frequencies of a cantilever (Timoshenko)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck (SI); Poisson's ratio of the law in plane stress.
const E: f64 = 200e9;
const RHO: f64 = 7850.0;
const L: f64 = 0.06;
const W: f64 = 0.006;
const NU: f64 = 1.0 / 3.0;

/// Frequency of Euler and Bernoulli's cantilever, cos β cosh β = −1.
fn slender(mode: usize) -> f64 {
    let beta = [1.875_104_07, 4.694_091_13, 7.854_757_44][mode];
    beta * beta / (2.0 * PI * L * L) * (E * W * W / (12.0 * RHO)).sqrt()
}

/// The determinant that is zero at the frequencies of Timoshenko's cantilever (Huang 1961), b² = ω²L⁴ρA/EI.
fn huang(b: f64) -> f64 {
    // r² = I/(AL²), s² = EI/(κGAL²); κ of Cowper (1966) for a rectangle
    let kappa = 10.0 * (1.0 + NU) / (12.0 + 11.0 * NU);
    let r2 = W * W / (12.0 * L * L);
    let s2 = r2 * 2.0 * (1.0 + NU) / kappa;
    let root = ((r2 - s2).powi(2) + 4.0 / (b * b)).sqrt();
    let alpha = ((-(r2 + s2) + root) / 2.0).sqrt();
    let beta = ((r2 + s2 + root) / 2.0).sqrt();
    let [p, q] = [b * alpha, b * beta];
    let last = b * (r2 + s2) / (1.0 - b * b * r2 * s2).sqrt();
    2.0 + (b * b * (r2 - s2).powi(2) + 2.0) * p.cosh() * q.cos() - last * p.sinh() * q.sin()
}

/// Frequency of Timoshenko's cantilever, below that of the slender one.
fn timoshenko(mode: usize) -> f64 {
    let scale = (E * W * W / (12.0 * RHO)).sqrt() / (2.0 * PI * L * L);
    let (mut high, mut low) = (slender(mode) / scale, 0.7 * slender(mode) / scale);
    let sign = huang(low).signum();
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if huang(middle).signum() == sign {
            low = middle;
        } else {
            high = middle;
        }
    }
    low * scale
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let spacings: &[&str] = if context.small {
        &["1 mm"]
    } else {
        &["1 mm", "0.5 mm", "0.25 mm"]
    };
    let mut modes = vec![];
    for (k, h) in spacings.iter().enumerate() {
        context.say(&format!("spacing {h}"));
        let mut bench = Bench::finished(DECK, &[("constants.h", h)])?;
        let four = bench.sim.modes(4);
        let four = four.map_err(|e| Failure::new(e.to_string()))?;
        // the third that bends and the first that stretches lie side by side
        let place = bench.places();
        let bends = |m: &&peridyne::run::ModeShape| {
            let [x, y] = [0, 1].map(|a| m.shape.iter().map(|u| u[a] * u[a]).sum::<f64>());
            y > x
        };
        let f: Vec<f64> = four.iter().filter(bends).map(|m| m.frequency).collect();
        let stretches = four.iter().find(|m| !bends(m));
        let stretches = stretches.map_or(f64::NAN, |m| m.frequency);
        if f.len() < 3 {
            return Err(Failure::new(format!("{} modes bend", f.len())));
        }
        for n in 0..3 {
            let key = format!("bending mode {} over Timoshenko's, h = {h}", n + 1);
            found.measured(&key, f[n] / timoshenko(n), "");
        }
        if k + 1 == spacings.len() {
            let mut plot = Plot::new("The first three modes that bend")
                .x("x", "m")
                .y("deflection", "of the largest");
            let mut table = Table::new();
            let axis: Vec<usize> = (0..place.len())
                .filter(|p| (place[*p][1] - 0.5 * W).abs() < 1e-9)
                .collect();
            let x: Vec<f64> = axis.iter().map(|p| place[*p][0]).collect();
            table = table.column("x", "m", x.clone());
            for (n, m) in four.iter().filter(bends).enumerate() {
                let y: Vec<f64> = axis.iter().map(|p| m.shape[*p][1]).collect();
                let top = y
                    .iter()
                    .fold(0.0, |t: f64, y| if y.abs() > t.abs() { *y } else { t });
                let y: Vec<f64> = y.iter().map(|y| y / top).collect();
                plot = plot.line(&format!("{:.0} Hz", m.frequency), &x, &y);
                table = table.column(&format!("mode {}", n + 1), "", y);
            }
            found.picture(plot.save(&context.out, "modes")?);
            let path = context.out.join("modes.csv");
            table.save(&path)?;
            found.file(path);
        }
        modes.push((f, stretches));
    }
    let (f, stretches) = &modes[modes.len() - 1];
    for (n, key) in ["first", "second", "third"].into_iter().enumerate() {
        found.number(key, f[n] / timoshenko(n));
        let key = format!("Timoshenko's mode {} over Euler and Bernoulli's", n + 1);
        found.measured(&key, timoshenko(n) / slender(n), "");
    }
    found.number("stretching", stretches / ((E / RHO).sqrt() / (4.0 * L)));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slender_beam_is_that_of_euler_and_bernoulli() {
        // Timoshenko lowers the first three by about 0.6, 4.5 and 11 % at a height of a tenth
        let ratio: Vec<f64> = (0..3).map(|n| timoshenko(n) / slender(n)).collect();
        assert!(ratio[0] > 0.99 && ratio[0] < 0.997, "{ratio:?}");
        assert!(
            ratio.windows(2).all(|r| r[1] < r[0]) && ratio[2] > 0.85,
            "{ratio:?}"
        );
    }
}
