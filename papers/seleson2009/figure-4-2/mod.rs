//! Fig. 4.2: the stable time step over the distance of points: the bound (4.12), the sharp limit, and what runs show.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use peridyne_theory::gradient::linear::LinearChain;
use peridyne_theory::stability::{observed, springs_bound};

use super::chain::Chain;
use super::deck;
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Figure42,
    "figure-4-2",
    "Stable time step over the distance of points",
    ["../chain.rs", "../deck.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// δ of the figure.
const HORIZON: f64 = 5.0;
/// Neighbours of the curves: Δx = 5/N.
const CURVE: [usize; 13] = [1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 100, 200, 500];
/// Neighbours of the runs of the deck, and how many of them the small variant does.
const RUNS: [usize; 7] = [1, 2, 5, 10, 20, 50, 100];
const SMALL: usize = 4;
/// Bisection stops at this relative distance of a steady and an unsteady step.
const CLOSE: f64 = 5e-4;
/// Euler–Mascheroni constant γ.
const EULER: f64 = 0.577_215_664_901_532_9;
/// The pulse has height 1: waves that stay bounded stay below this.
const BOUNDED: f64 = 100.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let runs = if context.small {
        &RUNS[..SMALL]
    } else {
        &RUNS[..]
    };
    let bound = |n: usize| springs_bound(1.0, 1.0, HORIZON, n);
    let sharp = |n: usize| {
        LinearChain::springs(1.0, HORIZON / n as f64, n)
            .largest(1.0)
            .time_step()
    };
    let mut seen = vec![];
    for &n in runs {
        let limit = context.part(&format!("observed-n={n}"), || border(n, bound(n)))?;
        context.say(&format!("N = {n}: {limit:.5}, bound {:.5}", bound(n)));
        seen.push(limit);
    }
    let mut found = Findings::new();
    let formula = CURVE.map(|n| {
        let chain = Chain::thousand(200 * n as u32 + 1, n as u32);
        (chain.time_step(1.0) / bound(n) - 1.0).abs()
    });
    found.number("bound-formula", largest(formula));
    found.number("bound-local", bound(1));
    scaling(bound, &mut found);
    let weaker: Vec<f64> = CURVE.map(|n| bound(n) / (HORIZON / n as f64)).to_vec();
    found.holds(
        "weaker-than-cfl",
        format!(
            "(4.12) over the straight line: {:.3} at N = 2, {:.1} at N = 500",
            weaker[1], weaker[12]
        ),
        weaker[1..].iter().all(|r| *r > 1.0) && weaker.is_sorted(),
    );
    let ratio: Vec<f64> = runs.iter().zip(&seen).map(|(n, l)| l / bound(*n)).collect();
    let texts: Vec<String> = runs
        .iter()
        .zip(&ratio)
        .map(|(n, r)| format!("N = {n}: {:.1} %", 100.0 * (r - 1.0)))
        .collect();
    found.holds(
        "observed-20-to-30-percent",
        texts.join(", "),
        runs.iter()
            .zip(&ratio)
            .filter(|(n, _)| (5..=20).contains(*n))
            .all(|(_, r)| (1.2..1.3).contains(r)),
    );
    if !context.small {
        found.holds(
            "finer-is-beyond",
            format!(
                "sharp limit over bound: {:.3} at N = 200, {:.3} at N = 500",
                sharp(200) / bound(200),
                sharp(500) / bound(500)
            ),
            ratio[5..]
                .iter()
                .all(|r| (1.3..std::f64::consts::SQRT_2).contains(r)),
        );
    }
    found.holds(
        "margin-grows",
        format!("from {:.4} to {:.4}", ratio[0], ratio[ratio.len() - 1]),
        ratio.is_sorted() && ratio.iter().all(|r| *r < std::f64::consts::SQRT_2),
    );
    let off = runs
        .iter()
        .zip(&seen)
        .map(|(n, l)| (l / sharp(*n) - 1.0).abs());
    found.number("observed-is-sharp", largest(off));
    found.number("sharp-local", sharp(1) / bound(1));

    let spacing: Vec<f64> = CURVE.iter().map(|n| HORIZON / *n as f64).collect();
    let at: Vec<f64> = runs.iter().map(|n| HORIZON / *n as f64).collect();
    let plot = Plot::new("Stable step, δ = 5")
        .x("Δx", "")
        .y("Δt", "")
        .series(
            "(4.12)",
            &spacing,
            &CURVE.map(bound),
            Stroke::Solid,
            Mark::Disc,
        )
        .dashed("linear, Δt = Δx", &spacing, &spacing)
        .series("observed", &at, &seen, Stroke::Dashed, Mark::Diamond)
        .series(
            "sharp: 2/max ω",
            &spacing,
            &CURVE.map(sharp),
            Stroke::Dotted,
            Mark::None,
        );
    let linear = plot.clone().x_range(0.0, HORIZON).y_range(0.0, 7.5);
    found.picture(linear.save(&context.out, "stable-step")?);
    let log = plot.log_x().log_y();
    found.picture(log.save(&context.out, "stable-step-log")?);
    let path = context.out.join("stable-step.csv");
    Table::new()
        .column("N", "", CURVE.map(|n| n as f64))
        .column("spacing", "", spacing)
        .column("bound (4.12)", "", CURVE.map(bound))
        .column("sharp limit", "", CURVE.map(sharp))
        .column(
            "observed",
            "",
            CURVE.map(|n| {
                let run = runs.iter().position(|m| *m == n);
                run.map_or(f64::NAN, |k| seen[k])
            }),
        )
        .save(&path)?;
    found.file(path);
    Ok(found)
}

/// The observed border of steady runs, by bisection from the bound (4.12) to √2 of it.
fn border(n: usize, bound: f64) -> Result<f64, Failure> {
    let deck = deck::deck(DECK, &format!("n={n}"), &[])?;
    let mut sim = deck::model(&deck)?;
    let start = sim.displacements();
    let rest = vec![[0.0; 3]; start.len()];
    let steps = deck.spec.run.schedule.steps;
    let steady = |dt: f64| {
        sim.set_displacements(&start);
        sim.set_velocities(&rest);
        sim.set_time_step(dt);
        sim.set_time(0, 0.0);
        sim.start(true);
        let runs = (0..steps).all(|_| sim.step().is_ok());
        runs && largest(sim.displacements().iter().map(|u| u[0].abs())) < BOUNDED
    };
    let interval = [0.99 * bound, 1.45 * bound];
    observed(steady, interval, CLOSE)
        .ok_or_else(|| Failure::new(format!("N = {n}: {interval:?} do not enclose the border")))
}

/// Section 4.3: `Δt < δ √(ρ/2K1) √((1 + 1/N)/H_N)`, with `H_N ≈ ln N + γ` and then `1/√ln(1/Δx)`.
fn scaling(bound: impl Fn(usize) -> f64, found: &mut Findings) {
    const N: usize = 1_000_000;
    let n = N as f64;
    let scale = HORIZON / 2f64.sqrt();
    // the bound gives back its harmonic number
    let harmonic = (1.0 + 1.0 / n) * (scale / bound(N)).powi(2);
    // Euler & Maclaurin: H_N = ln N + γ + 1/2N − …
    found.number("harmonic", harmonic - n.ln() - 0.5 / n);
    let root = |x: f64| scale / x.sqrt();
    found.number("logarithm", bound(N) / root(n.ln() + EULER));
    // N = 5/Δx up to 10^300: sums of so many terms are what Euler and Maclaurin say
    let leading = |digits: f64| {
        let ln = digits * std::f64::consts::LN_10;
        root(ln + EULER) / root(ln - HORIZON.ln())
    };
    let ratios = [6.0, 20.0, 100.0, 300.0].map(leading);
    found.holds(
        "leading",
        format!(
            "(4.12) over δ √(ρ/2K1)/√ln(1/Δx): {:.3} at N = 10⁶, {:.4} at 10¹⁰⁰, {:.4} at 10³⁰⁰",
            ratios[0], ratios[2], ratios[3]
        ),
        ratios.is_sorted() && ratios[3] < 1.0 && 1.0 - ratios[3] < 0.4 * (1.0 - ratios[2]),
    );
    let twice = springs_bound(1.0, 1.0, 2.0 * HORIZON, 20) / springs_bound(1.0, 1.0, HORIZON, 20);
    found.number("horizon", twice);
}
