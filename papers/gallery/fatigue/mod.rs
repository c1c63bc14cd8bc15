//! A crack grows in cycles of load: the exponent of Paris's law beside that with which bonds wear.

use std::f64::consts::PI;

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, CRACKED, slope};
use crate::{Context, Failure, Findings};

experiment!(
    Fatigue,
    "fatigue",
    "A crack grows in cycles of load (Paris)",
    ["../bench.rs", "deck.toml"],
    Minutes
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: width (m), greatest stress of a cycle (Pa); it is let go to nothing.
const W: f64 = 0.064;
const STRESS: f64 = 20e6;
/// Crack length over the width up to which it is looked at.
const END: f64 = 0.6;

/// K/(σ√(πa)) of a crack of length a in the edge of a plate (Tada, Paris and Irwin, *The stress analysis of cracks handbook*, 2.11).
fn shape(ratio: f64) -> f64 {
    let half = 0.5 * PI * ratio;
    let bent = 0.752 + 2.02 * ratio + 0.37 * (1.0 - half.sin()).powi(3);
    (half.tan() / half).sqrt() * bent / half.cos()
}

/// Range of K in a cycle (Pa √m).
fn range(a: f64) -> f64 {
    STRESS * (PI * a).sqrt() * shape(a / W)
}

/// A crack that grew: lengths (m) and the cycles after which it had them; the spacing (m).
struct Grown {
    length: Vec<f64>,
    cycles: Vec<f64>,
    spacing: f64,
}

impl Grown {
    /// ΔK (Pa √m) and da/dN (m) by secants over a horizon and more to either side, after the first two horizons.
    fn rates(&self) -> (Vec<f64>, Vec<f64>) {
        let begun = self.length.first().map_or(0.0, |a| a + 6.0 * self.spacing);
        let n = self.length.len();
        let pairs = (0..n).flat_map(|k| {
            let last =
                (k + 1..n).find(|l| self.length[*l] - self.length[k] > 3.5 * self.spacing)?;
            let a = 0.5 * (self.length[k] + self.length[last]);
            let da = self.length[last] - self.length[k];
            (self.length[k] > begun).then(|| (range(a), da / (self.cycles[last] - self.cycles[k])))
        });
        pairs.unzip()
    }

    /// Exponent m of da/dN = C ΔK^m by least squares.
    fn exponent(&self) -> f64 {
        let (k, rate) = self.rates();
        let log = |v: &[f64]| v.iter().map(|v| v.ln()).collect::<Vec<f64>>();
        slope(&log(&k), &log(&rate))
    }
}

/// A growth law `A ε^m` of so many points across the plate.
fn grown(
    points: usize,
    law: &str,
    drawn: Option<(&Context, &mut Findings)>,
) -> Result<Grown, Failure> {
    let set = [
        ("constants.n", points.to_string()),
        ("material.fracture.fatigue.growth", law.to_string()),
    ];
    let set: Vec<(&str, &str)> = set.iter().map(|(k, v)| (*k, v.as_str())).collect();
    let mut bench = Bench::new(DECK, &set)?;
    let spacing = bench.sim.info().spacing;
    let places = bench.places();
    // the row above the crack
    let row: Vec<usize> = (0..places.len())
        .filter(|n| places[*n][1] > 0.0 && places[*n][1] < spacing)
        .collect();
    let mut grown = Grown {
        length: vec![],
        cycles: vec![],
        spacing,
    };
    for _ in 0..bench.steps() {
        bench.step()?;
        let damage = bench.values("damage", 0)?;
        let cracked = row.iter().filter(|n| damage[**n] > CRACKED);
        let tip = cracked.fold(0.0, |tip, n| f64::max(tip, places[*n][0] + 0.5 * spacing));
        if grown.length.last().is_none_or(|last| tip > *last) {
            grown.length.push(tip);
            grown.cycles.push(bench.sim.cycles().unwrap_or(f64::NAN));
        }
        if tip > END * W {
            break;
        }
    }
    if let Some((context, found)) = drawn {
        bench.damage(context, "damage", found)?;
    }
    Ok(grown)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let points = if context.small { 32 } else { 64 };
    // factors so that both take about as many cycles
    let four = grown(points, "[1e10, 4]", Some((context, &mut found)))?;
    let two = grown(points, "[1e4, 2]", None)?;
    let mut plot = Plot::new("Growth of a crack over the range of its stress intensity")
        .x("ΔK", "MPa √m")
        .y("da/dN", "µm")
        .log_x()
        .log_y();
    for (key, exponent, grown) in [("four", 4.0, &four), ("two", 2.0, &two)] {
        let found_exponent = grown.exponent();
        match context.small {
            true => found.measured(&format!("exponent, for {exponent}"), found_exponent, ""),
            false => found.number(key, found_exponent),
        }
        let (k, rate) = grown.rates();
        let n = rate.len() as f64;
        // the line of this exponent through the middle
        let middle = k.iter().zip(&rate).map(|(k, r)| r.ln() - exponent * k.ln());
        let middle = (middle.sum::<f64>() / n).exp();
        let mega: Vec<f64> = k.iter().map(|k| 1e-6 * k).collect();
        let micro: Vec<f64> = rate.iter().map(|r| 1e6 * r).collect();
        let line: Vec<f64> = k.iter().map(|k| 1e6 * middle * k.powf(exponent)).collect();
        plot = plot
            .points(&format!("bonds wear with ε^{exponent}"), &mega, &micro)
            .line(&format!("ΔK^{exponent}"), &mega, &line);
        let path = context.out.join(format!("growth-{key}.csv"));
        Table::new()
            .column("range of K", "MPa m^0.5", mega)
            .column("da/dN", "um", micro)
            .save(&path)?;
        found.file(path);
        let path = context.out.join(format!("length-{key}.csv"));
        Table::new()
            .column("cycles", "", grown.cycles.clone())
            .column("length", "m", grown.length.clone())
            .save(&path)?;
        found.file(path);
    }
    let [a, b] = [four.exponent(), two.exponent()];
    found.holds(
        "faster",
        format!("exponents {a:.2} and {b:.2}"),
        a > b + 1.0,
    );
    found.picture(plot.save(&context.out, "growth")?);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_handbooks_crack_and_a_line_of_its_exponent() {
        // a short crack; Tada's table at one half
        assert!((shape(1e-6) - 1.122).abs() < 1e-3, "{}", shape(1e-6));
        assert!((shape(0.5) - 2.827).abs() < 1e-3, "{}", shape(0.5));
        // a crack that grows by the law: dN = da/ΔK³
        let spacing = 1e-4;
        let length: Vec<f64> = (0..200).map(|k| 0.0128 + f64::from(k) * spacing).collect();
        let mut cycles = vec![0.0];
        for a in &length[1..] {
            let last = cycles[cycles.len() - 1];
            cycles.push(last + spacing / range(a - 0.5 * spacing).powi(3));
        }
        let grown = Grown {
            length,
            cycles,
            spacing,
        };
        assert!(
            (grown.exponent() - 3.0).abs() < 1e-3,
            "{}",
            grown.exponent()
        );
    }
}
