//! Fig. 6: the bar that is let go, δ = 3Δ: its middle at three scales.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::rod::{Length, Motion, ROD, frequency_error, sizes, vibration};
use crate::gallery::bench::Bench;
use crate::measure::{apart, largest};
use crate::{Context, Failure, Findings};

experiment!(
    Figure6,
    "figure-6",
    "Longitudinally vibrating bar, δ = 3Δ",
    ["../rod.rs", "../../gallery/bench.rs", "deck.toml"]
);

const M: usize = 3;
/// The bar that is not homogenized, Δ = L/N.
const DECK: &str = include_str!("deck.toml");

/// The middle over the steps, by the engine from the deck.
fn middle([points, steps]: [usize; 2]) -> Result<Vec<f64>, Failure> {
    let set = [points, steps].map(|n| n.to_string());
    let set = [("constants.N", &*set[0]), ("run.steps", &*set[1])];
    let mut bench = Bench::new(DECK, &set)?;
    let mut u = vec![bench.probe("middle_x")?];
    for _ in 0..steps {
        bench.step()?;
        u.push(bench.probe("middle_x")?);
    }
    Ok(u)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [points, steps] = sizes(context);
    let motion = Motion::new(M, [points, steps], Length::Counted)?;
    let engine = middle([points, steps])?;
    let off = apart(&engine, &motion.u[0]);
    found.number("deck", off / largest(engine.iter().map(|u| u.abs())));
    let milli = |u: &[f64]| u.iter().map(|u| u * 1e3).collect::<Vec<f64>>();
    let micro: Vec<f64> = motion.times.iter().map(|t| t * 1e6).collect();
    let end = micro[steps];
    // from when the middle moves last down to when it is lowest
    let period = 4.0 * ROD.length / ROD.speed() * 1e6;
    let last = (end / period).floor() * period;
    let views = [
        ("a-all", 0.0, end),
        ("b-last-period", last - period, last),
        ("c-last-slope", last - 0.9 * period, last - 0.6 * period),
    ];
    for (name, from, to) in views {
        let plot = Plot::new(format!("u of the middle, δ = 3Δ, N = {points}"))
            .x("t", "µs")
            .y("u", "mm")
            .x_range(from, to)
            .y_range(-0.7, 1.2)
            .line("classical (73)", &micro, &milli(&motion.classical))
            .line("not homogenized", &micro, &milli(&motion.u[0]))
            .dashed("homogenized", &micro, &milli(&motion.u[1]));
        found.picture(plot.save(&context.out, name)?);
    }
    let path = context.out.join("middle.csv");
    let every = |v: &[f64]| v.iter().step_by(10).copied().collect::<Vec<f64>>();
    Table::new()
        .column("t", "s", every(&motion.times))
        .column("classical", "m", every(&motion.classical))
        .column("not homogenized", "m", every(&motion.u[0]))
        .column("homogenized", "m", every(&motion.u[1]))
        .save(&path)?;
    found.file(path);

    for (key, length) in [
        ("counted", Length::Counted),
        ("effective", Length::Effective),
    ] {
        let motion = Motion::new(M, [points, steps], length)?;
        let [plain, homogenized] = [0, 1].map(|k| motion.error(k));
        let errors = [false, true].map(|h| vibration(M, points, h, length));
        let [a, b] = errors.map(|v| v.map(|v| frequency_error(&v, 0)));
        let (a, b) = (a?, b?);
        found.holds(
            &format!("closer-{key}"),
            format!(
                "root mean square error of the middle {plain:.4} and homogenized {homogenized:.4}; first frequency off by {a:.2e} and {b:.2e}"
            ),
            homogenized < plain && b.abs() < a.abs(),
        );
        if length == Length::Effective {
            found.number("frequency", b);
        }
    }
    let bars = [
        vibration(M, points, false, Length::Counted)?,
        vibration(M, points, true, Length::Counted)?,
    ];
    let limits = bars.map(|b| b.stable_step());
    found.number("limit", limits[1] / limits[0]);
    found.holds(
        "stable",
        format!(
            "Δt = {:.4e} s, {steps} steps to {:.3e} s; stable below {:.4e} s, homogenized {:.4e} s",
            motion.time_step, motion.times[steps], limits[0], limits[1]
        ),
        motion.time_step < limits[1],
    );
    Ok(found)
}
