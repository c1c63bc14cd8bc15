//! The regularized equation (2.0.14): travelling waves against ε/δ, the threshold of monotone tails, fans and expansion shocks, entropy.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_transport::exact::{ColeHopf, riemann};
use peridyne_transport::{Bump, Flux, Kernel, Parity, Profile, measure, wave};

use super::laws::{digits, failed, law, places, run_to};
use crate::{Context, Failure, Findings};

experiment!(
    Shocks,
    "shocks",
    "Travelling waves, fans and expansion shocks",
    ["../laws.rs", "deck.toml"]
);

const DECK: &str = include_str!("deck.toml");
/// δ of the deck.
const DELTA: f64 = 0.05;

/// A profile when it has settled.
struct Wave {
    x: Vec<f64>,
    u: Vec<f64>,
    front: measure::Front,
}

fn settled(ratio: f64, time: f64) -> Result<Wave, Failure> {
    let mut e = law(DECK, &[("constants.epsilon", (ratio * DELTA).to_string())])?;
    run_to(&mut e, time)?;
    let x = places(&e);
    let front = measure::front(&x, &e.u, 1.0, 0.0);
    let front = front.ok_or_else(|| Failure::new("there is no front any more"))?;
    Ok(Wave { x, u: e.u, front })
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    speed(&mut found)?;
    threshold(&mut found)?;
    waves(context, &mut found)?;
    rise(context, &mut found)?;
    Ok(found)
}

/// The speed over a whole number of cells, so that the front stands the same on the grid.
fn speed(found: &mut Findings) -> Result<(), Failure> {
    let mut e = law(
        DECK,
        &[
            ("constants.delta", "0.02".into()),
            ("constants.epsilon", "0.016".into()),
            ("points", "1200".into()),
        ],
    )?;
    run_to(&mut e, 2.0)?;
    let x = places(&e);
    let place = |u: &[f64]| {
        let front = measure::front(&x, u, 1.0, 0.0);
        front
            .map(|f| f.position)
            .ok_or_else(|| Failure::new("no front"))
    };
    let (first, begin) = (place(&e.u)?, e.time);
    let spacing = x[1] - x[0];
    run_to(&mut e, begin + 2.0 * 100.0 * spacing)?;
    found.number("speed", (place(&e.u)? - first) / (e.time - begin));
    Ok(())
}

/// Below the threshold by d the exponent of the tail is μ ± iν with ν ∝ √d, and the tail comes back smaller by e^{−φμ/ν}: overshoots
/// are e^{−a − b/√d − c√d} to the next order. The threshold that four of them have, and nothing else.
fn from_overshoots(ratios: [f64; 4], overshoots: [f64; 4]) -> Option<f64> {
    let levels = overshoots.map(|o| -o.ln());
    // no a, b, c at all: the determinant of the differences vanishes
    let miss = |threshold: f64| {
        let roots = ratios.map(|r| (threshold - r).sqrt());
        let row = |k: usize| {
            [
                1.0 / roots[k + 1] - 1.0 / roots[k],
                roots[k + 1] - roots[k],
                levels[k + 1] - levels[k],
            ]
        };
        let [x, y, z] = [row(0), row(1), row(2)];
        x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0])
    };
    let place = |k: u32| ratios[3] + 1e-4 * f64::from(k);
    let turns = (1..500).find(|k| miss(place(*k)) * miss(place(k + 1)) <= 0.0)?;
    let (mut low, mut high) = (place(turns), place(turns + 1));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        match miss(low) * miss(middle) <= 0.0 {
            true => high = middle,
            false => low = middle,
        }
    }
    Some(0.5 * (low + high))
}

/// ε/δ from which on the settled wave does not overshoot, from runs below it, beside what the exponents of the tail give.
fn threshold(found: &mut Findings) -> Result<(), Failure> {
    let kernel =
        |parity, profile| Kernel::new(parity, profile, DELTA, 1, false, "kernel").map_err(failed);
    let bump = Bump::Polynomial(2);
    let odd = kernel(Parity::Odd, Profile::Slope(bump))?;
    let even = kernel(Parity::Even, Profile::Value(bump))?;
    let (least, exponent) = wave::monotone_threshold(&Flux::burgers(), 1.0, 0.0, &odd, &even);
    let expected = least / DELTA;
    found.measured(
        "threshold of ε/δ by the exponents of the tail",
        expected,
        "",
    );
    found.measured("its exponent times δ", exponent * DELTA, "");
    let ratios = [0.30, 0.31, 0.32, 0.328];
    let mut seen = vec![];
    for points in [960, 1920] {
        let mut overshoots = [0.0; 4];
        for (o, ratio) in overshoots.iter_mut().zip(ratios) {
            let changes = [
                ("constants.epsilon", (ratio * DELTA).to_string()),
                ("domain.x", "[-3, 3]".into()),
                ("points", points.to_string()),
                ("run.duration", "5".into()),
            ];
            let mut e = law(DECK, &changes)?;
            run_to(&mut e, 5.0)?;
            let front = measure::front(&places(&e), &e.u, 1.0, 0.0);
            *o = front.map_or(f64::NAN, |f| f.overshoot);
        }
        let key = format!("overshoots at ε/δ = {ratios:?}, {points} points");
        found.measured(&key, digits(&overshoots), "");
        seen.push(from_overshoots(ratios, overshoots).unwrap_or(f64::NAN));
    }
    // errors of the grid are of second order
    let runs = (4.0 * seen[1] - seen[0]) / 3.0;
    found.number("threshold", runs - expected);
    found.measured("threshold of ε/δ by runs", runs, "");
    Ok(())
}

fn waves(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let ratios = [0.1, 0.2, 0.4, 0.8];
    let mut plot = Plot::new("travelling waves")
        .x("(x − x_s)/δ", "")
        .y("u", "")
        .x_range(-12.0, 6.0);
    let mut rows: Vec<[f64; 4]> = vec![];
    for ratio in ratios {
        let w = settled(ratio, 2.0)?;
        let x: Vec<f64> = w.x.iter().map(|x| (x - w.front.position) / DELTA).collect();
        plot = plot.line(&format!("ε/δ = {ratio}"), &x, &w.u);
        rows.push([
            ratio,
            w.front.width / DELTA,
            w.front.overshoot,
            w.front.undershoot,
        ]);
    }
    let falls = rows.windows(2).all(|w| w[1][2] <= w[0][2]);
    found.holds(
        "overshoot-falls",
        format!("{:.3?}", rows.iter().map(|r| r[2]).collect::<Vec<_>>()),
        falls && rows[0][2] > 0.05,
    );
    // only ε/δ matters: half the horizon, half the lengths and times
    let half = law(
        DECK,
        &[
            ("constants.delta", (0.5 * DELTA).to_string()),
            ("constants.epsilon", (0.1 * DELTA).to_string()),
            ("domain.x", "[-0.75, 0.75]".into()),
            ("run.duration", "1".into()),
            ("initial", "0.5*(1 - tanh((x + 0.375)/(4*epsilon)))".into()),
        ],
    );
    let mut half = half?;
    run_to(&mut half, 1.0)?;
    found.number("scaling", measure::distance(&half.u, &settled(0.2, 2.0)?.u));
    found.picture(plot.save(&context.out, "waves")?);
    let path = context.out.join("waves.csv");
    let column = |k: usize| rows.iter().map(|r| r[k]).collect::<Vec<f64>>();
    Table::new()
        .column("epsilon/delta", "", column(0))
        .column("width/delta", "", column(1))
        .column("overshoot", "", column(2))
        .column("undershoot", "", column(3))
        .save(&path)?;
    found.file(path);
    Ok(())
}

/// Mean distance of Cole and Hopf's solution from −1 up to 1 from the fan, over the deck's domain.
fn fan(epsilon: f64, time: f64) -> Result<f64, Failure> {
    let local = ColeHopf::new(f64::abs, 1.0, epsilon).map_err(failed)?;
    let n = 480;
    let cell = 3.0 / f64::from(n);
    let off = (0..n).map(|k| {
        let x = -1.5 + cell * (f64::from(k) + 0.5);
        (local.value(x, time) - riemann(&Flux::burgers(), -1.0, 1.0, x / time)).abs()
    });
    Ok(cell * off.sum::<f64>())
}

/// From −1 up to 1, with viscosity and without: does the nonlocal flux hold the jump that the local one could?
fn rise(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let changed = |epsilon: f64, points: usize| {
        law(
            DECK,
            &[
                ("constants.epsilon", epsilon.to_string()),
                ("boundary", "{ left = -1, right = 1 }".into()),
                ("initial", "x < 0 ? -1 : 1".into()),
                ("points", points.to_string()),
            ],
        )
    };
    let time = 0.8;
    let mut plot = Plot::new("from −1 up to 1").x("x", "").y("u", "");
    let mut jump = 0.0;
    let mut produced = 0.0;
    let viscous = [0.04, 0.02, 0.01];
    let mut distances = vec![];
    for epsilon in [0.0].into_iter().chain(viscous) {
        let mut e = changed(epsilon, 480)?;
        let start = e.u.clone();
        let mut rate = vec![0.0; start.len()];
        e.operator.rate(&start, 0.0, &mut rate);
        run_to(&mut e, time)?;
        let x = places(&e);
        let exact: Vec<f64> = x
            .iter()
            .map(|x| riemann(&Flux::burgers(), -1.0, 1.0, x / time))
            .collect();
        let cell = e.operator.law().grid.cell();
        let off = measure::mean_distance(&e.u, &exact, cell);
        found.measured(
            &format!("mean distance from the fan at t = {time}, ε = {epsilon}"),
            off,
            "",
        );
        plot = plot.line(&format!("ε = {epsilon}"), &x, &e.u);
        if epsilon == 0.0 {
            jump = e.u.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
            // η = u²/2, q = u³/3
            produced = measure::entropy_production(
                |u| u,
                |u| u * u * u / 3.0,
                &start,
                &rate,
                cell,
                [-1.0, 1.0],
            );
        } else {
            distances.push(off);
            if epsilon == viscous[1] {
                plot = plot.dashed("entropy solution", &x, &exact);
            }
        }
    }
    found.holds(
        "expansion-shock",
        format!("largest step between neighbours {jump:.3} at t = {time}, of 2 at the start"),
        jump < 1.9,
    );
    found.number("fan", distances[1] / fan(viscous[1], time)?);
    found.number("production", produced);
    found.picture(plot.save(&context.out, "fan")?);
    Ok(())
}
