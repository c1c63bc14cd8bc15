//! A bimetal strip bends when it is heated: its curvature beside Timoshenko's.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit};
use crate::{Context, Failure, Findings};

experiment!(
    Bimetal,
    "bimetal",
    "A bimetal strip (Timoshenko)",
    ["../bench.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// Of the deck: how much more the lower strip expands (1/K), how much warmer it becomes (K), height of both (m).
const EXPANSION: f64 = 12e-6;
const WARMER: f64 = 50.0;
const HEIGHT: f64 = 2e-3;

/// Timoshenko's curvature (1925, equation 4) of strips whose thicknesses are in the ratio m, their moduli in the ratio n.
fn curvature(m: f64, n: f64) -> f64 {
    let strains = 6.0 * EXPANSION * WARMER * (1.0 + m) * (1.0 + m);
    strains / (HEIGHT * (3.0 * (1.0 + m) * (1.0 + m) + (1.0 + m * n) * (m * m + 1.0 / (m * n))))
}

/// Twice the coefficient of x² in the least squares' parabola through points of the middle, even about x = 0.
fn fitted(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = |of: fn(&[f64; 2]) -> f64| points.iter().map(of).sum::<f64>() / n;
    let [mx, my] = [mean(|p| p[0] * p[0]), mean(|p| p[1])];
    let both = points.iter().map(|p| (p[0] * p[0] - mx) * (p[1] - my));
    let square = points.iter().map(|p| (p[0] * p[0] - mx).powi(2));
    2.0 * both.sum::<f64>() / square.sum::<f64>()
}

/// Curvature of the middle (1/m) with so many points across a strip, and its points (m).
fn bent(
    n: usize,
    drawn: Option<(&Context, &mut Findings)>,
) -> Result<(f64, Vec<[f64; 2]>), Failure> {
    let mut bench = Bench::finished(DECK, &[("constants.n", &n.to_string())])?;
    if let Some((context, found)) = drawn {
        bench.drawn(
            context,
            "stress",
            ["stress", "xx"],
            About::Equilibrium,
            found,
        )?;
    }
    let (x, u) = (bench.places(), bench.values("displacement", 1)?);
    let h = bench.sim.info().spacing;
    // a strip's height from the ends they feel no end
    let middle = x
        .iter()
        .zip(&u)
        .filter(|(x, _)| x[0].abs() < 6e-3 && x[1].abs() < h);
    let points: Vec<[f64; 2]> = middle.map(|(x, u)| [x[0], *u]).collect();
    Ok((fitted(&points), points))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [few, many] = if context.small { [4, 8] } else { [8, 16] };
    let (coarse, _) = bent(few, None)?;
    let (fine, points) = bent(many, Some((context, &mut found)))?;
    let exact = curvature(1.0, 1.0);
    found.measured(
        &format!("with {few} points across a strip"),
        coarse / exact,
        "",
    );
    found.measured(&format!("with {many}"), fine / exact, "");
    found.number("curvature", limit(coarse, fine) / exact);
    let milli: Vec<f64> = points.iter().map(|p| 1e3 * p[0]).collect();
    let micro: Vec<f64> = points.iter().map(|p| 1e6 * p[1]).collect();
    let first = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let parabola = points
        .iter()
        .map(|p| 1e6 * (first + 0.5 * exact * p[0] * p[0]));
    let parabola: Vec<f64> = parabola.collect();
    let plot = Plot::new("The middle of a bimetal strip")
        .x("x", "mm")
        .y("deflection", "µm")
        .line("Timoshenko", &milli, &parabola)
        .points("peridyne", &milli, &micro);
    found.picture(plot.save(&context.out, "deflection")?);
    let path = context.out.join("deflection.csv");
    Table::new()
        .column("x", "mm", milli)
        .column("deflection", "um", micro)
        .column("Timoshenko", "um", parabola)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_alike_bend_as_everybody_knows_and_a_film_as_stoney_says() {
        let known = 1.5 * EXPANSION * WARMER / HEIGHT;
        assert!((curvature(1.0, 1.0) / known - 1.0).abs() < 1e-12);
        // a film m times as thick: 6 m n ε/h
        let m = 1e-4;
        let stoney = 6.0 * EXPANSION * WARMER * m / HEIGHT;
        assert!((curvature(m, 1.0) / stoney - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_parabola_is_fitted() {
        let points = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|x| [x, 3.0 + 0.35 * x * x]);
        assert!((fitted(&points) - 0.7).abs() < 1e-12);
    }
}
