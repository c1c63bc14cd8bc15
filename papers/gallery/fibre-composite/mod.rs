//! Fibres in a matrix: the stiffness across them between Hashin's and Hill's bounds, and where Hill's is exact.

use peridyne_io::write::picture::shown::About;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use crate::gallery::bench::{Bench, limit};
use crate::{Context, Failure, Findings};

experiment!(
    FibreComposite,
    "fibre-composite",
    "Stiff fibres in a matrix (Hashin, Hill)",
    ["../bench.rs", "deck.toml", "exact.toml"]
);

const DECK: &str = include_str!("deck.toml");
const EXACT: &str = include_str!("exact.toml");
/// Length of a cell (m), whole cells.
const CELL: f64 = 36e-6;
const CELLS: usize = 6;
const THICKNESS: f64 = 1e-3;

/// Plane bulk and shear moduli (Pa) of a phase.
type Phase = [f64; 2];
/// λ = μ in plane strain: μ = E/2.5, k = 2μ.
const MATRIX: Phase = [3.2e9, 1.6e9];
const FIBRE: Phase = [32e9, 16e9];

/// k + μ of fibres of this part of the volume with the other phase around them: Hill (1964) for k, Hashin (1965) for μ; the lower
/// bounds where the soft phase is around, the upper where the stiff one is.
fn bound(part: f64, [k, m]: Phase, [ki, mi]: Phase) -> f64 {
    let bulk = k + part / (1.0 / (ki - k) + (1.0 - part) / (k + m));
    let shear = 1.0 / (mi - m) + (1.0 - part) * (k + 2.0 * m) / (2.0 * m * (k + m));
    bulk + m + part / shear
}

/// Stress over strain of the cells in the middle (Pa), and the part of the fibres in the cells.
fn across(
    deck: &str,
    n: usize,
    drawn: Option<(&Context, &mut Findings)>,
) -> Result<[f64; 2], Failure> {
    let mut bench = Bench::finished(deck, &[("constants.n", &n.to_string())])?;
    if let Some((context, found)) = drawn {
        bench.drawn(
            context,
            "stress",
            ["stress", "xx"],
            About::Equilibrium,
            found,
        )?;
    }
    let (x, u) = (bench.places(), bench.values("displacement", 0)?);
    let height = (3f64.sqrt() * n as f64 + 0.5).floor() * CELL / n as f64;
    let mut mean = [0.0; CELLS];
    let mut count = [0.0; CELLS];
    for (x, u) in x.iter().zip(&u) {
        let cell = (x[0] / CELL).floor();
        if (0.0..CELLS as f64).contains(&cell) {
            mean[cell as usize] += u;
            count[cell as usize] += 1.0;
        }
    }
    let fibres = bench.sim.members("fibre").map_or(0, |f| f.len());
    let part = fibres as f64 / count.iter().sum::<f64>();
    let mean: Vec<f64> = mean.iter().zip(count).map(|(m, n)| m / n).collect();
    let strain = (mean[4] - mean[1]) / (3.0 * CELL);
    let stress = bench.probe("pull_x")? / (height * THICKNESS);
    Ok([stress / strain, part])
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let cells: &[usize] = if context.small {
        &[18, 36]
    } else {
        &[18, 36, 72]
    };
    let (mut bonds, mut states) = (vec![], vec![]);
    for n in cells {
        context.say(&format!("{n} spacings in a cell"));
        let last = n == &cells[cells.len() - 1];
        let drawn = last.then_some((context, &mut found));
        let [stiff, part] = across(DECK, *n, drawn)?;
        // over the lower bound of the fibres that the lattice has
        bonds.push([stiff, stiff / bound(part, MATRIX, FIBRE), part]);
        let [stiff, part] = across(EXACT, *n, None)?;
        let mu = MATRIX[1];
        let series = part / (FIBRE[0] + mu) + (1.0 - part) / (MATRIX[0] + mu);
        states.push(stiff * series);
    }
    let steps: Vec<f64> = cells.iter().map(|n| 1.0 / *n as f64).collect();
    for (k, n) in cells.iter().enumerate() {
        let [stiff, over, part] = bonds[k];
        let what = format!("{n} spacings in a cell");
        found.measured(&format!("C11, {what}"), 1e-9 * stiff, "GPa");
        found.measured(&format!("over the lower bound, {what}"), over, "");
        found.measured(&format!("part of the fibres, {what}"), part, "");
        found.measured(
            &format!("of one shear modulus, over Hill's, {what}"),
            states[k],
            "",
        );
    }
    let end = cells.len() - 1;
    let [stiff, over, part] = bonds[end];
    let upper = bound(1.0 - part, FIBRE, MATRIX);
    found.holds(
        "bounds",
        format!(
            "{:.3} GPa between {:.3} and {:.3} GPa",
            1e-9 * stiff,
            1e-9 * stiff / over,
            1e-9 * upper
        ),
        over > 1.0 && stiff < upper,
    );
    found.number("lower", over);
    found.number("hill", limit(states[end - 1], states[end]));
    let ratios: Vec<f64> = bonds.iter().map(|b| b[1]).collect();
    let plot = Plot::new("Stiffness across the fibres")
        .x("spacing/length of a cell", "")
        .y("over the closed form", "")
        .x_range(0.0, 0.06)
        .points("bond-based, over the lower bound", &steps, &ratios)
        .points("one shear modulus (LPS), over Hill's", &steps, &states)
        .dashed("closed forms", &[0.0, 0.06], &[1.0, 1.0]);
    found.picture(plot.save(&context.out, "stiffness")?);
    let path = context.out.join("stiffness.csv");
    Table::new()
        .column("spacing/cell", "", steps)
        .column("bond-based over the lower bound", "", ratios)
        .column("one shear modulus over Hill's", "", states)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_meet_where_phases_are_alike_and_lie_within_the_mixture() {
        assert!((bound(0.4, MATRIX, [3.2000001e9, 1.6000001e9]) / 4.8e9 - 1.0).abs() < 1e-7);
        let [low, high] = [bound(0.4, MATRIX, FIBRE), bound(0.6, FIBRE, MATRIX)];
        let mixture = 0.4 * 48e9 + 0.6 * 4.8e9;
        let series = 1.0 / (0.4 / 48e9 + 0.6 / 4.8e9);
        assert!(series < low && low < high && high < mixture, "{low} {high}");
    }
}
