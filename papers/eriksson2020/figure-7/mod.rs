//! Fig. 7: the bar that is let go, δ = Δ to 5Δ.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::homogenize::bar::vibration::Vibration;

use super::rod::{Length, Motion, frequency_error, sizes, vibration};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Figure7,
    "figure-7",
    "Longitudinally vibrating bars, δ = Δ to 5Δ",
    ["../rod.rs"]
);

const HORIZONS: [usize; 5] = [1, 2, 3, 4, 5];
/// Modes whose frequencies are compared.
const MODES: usize = 5;

/// Both bars of every horizon.
fn bars(points: usize, length: Length) -> Result<Vec<[Vibration; 2]>, Failure> {
    let pair = |m: usize| {
        Ok([
            vibration(m, points, false, length)?,
            vibration(m, points, true, length)?,
        ])
    };
    HORIZONS.into_iter().map(pair).collect()
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [points, steps] = sizes(context);
    let milli = |u: &[f64]| u.iter().map(|u| u * 1e3).collect::<Vec<f64>>();
    let mut histories = vec![];
    for (m, name) in HORIZONS.into_iter().zip(["a", "b", "c", "d", "e"]) {
        let motion = Motion::new(m, [points, steps], Length::Counted)?;
        let step: Vec<f64> = (0..=steps).map(|n| n as f64).collect();
        let plot = Plot::new(format!(
            "u of the middle, δ = {m}Δ, N = {points}, last tenth of the steps"
        ))
        .x("step", "")
        .y("u", "mm")
        .x_range(0.9 * steps as f64, steps as f64)
        .y_range(-0.8, 0.8)
        .line("classical (73)", &step, &milli(&motion.classical))
        .line("not homogenized", &step, &milli(&motion.u[0]))
        .dashed("homogenized", &step, &milli(&motion.u[1]));
        found.picture(plot.save(&context.out, &format!("{name}-delta-{m}"))?);
        histories.push([motion.error(0), motion.error(1)]);
    }

    let mut table = Table::new().column("δ/Δ", "", HORIZONS.map(|m| m as f64));
    for k in 0..2 {
        let name = format!("error of the middle, {}", super::kind(k == 1));
        table = table.column(&name, "", histories.iter().map(|e| e[k]));
    }
    let mut first = vec![];
    for (length, name) in [
        (Length::Counted, "Δ = L/N"),
        (Length::Effective, "(N−½)Δ = L"),
    ] {
        let all = bars(points, length)?;
        for k in 0..2 {
            for mode in 0..MODES {
                let errors: Vec<f64> = all.iter().map(|b| frequency_error(&b[k], mode)).collect();
                let title = format!("ω{} off, {name}, {}", mode + 1, super::kind(k == 1));
                table = table.column(&title, "", errors.clone());
                if mode == 0 {
                    first.push(errors);
                }
            }
        }
    }
    // by convention of length and bar, from δ = Δ to 5Δ
    let [
        counted,
        counted_homogenized,
        effective,
        effective_homogenized,
    ] = &first[..]
    else {
        return Err(Failure::new("two conventions of two bars are compared"));
    };
    let all = bars(points, Length::Counted)?;
    let shrinks: Vec<f64> = all
        .iter()
        .map(|[a, b]| b.stable_step() / a.stable_step())
        .collect();
    let used: Vec<f64> = all
        .iter()
        .map(|[a, b]| a.paper_step() / b.stable_step())
        .collect();
    table = table
        .column("stable step, homogenized over not", "", shrinks.clone())
        .column("step over stable step, homogenized", "", used.clone());
    let path = context.out.join("errors.csv");
    table.save(&path)?;
    found.file(path);

    let x = HORIZONS.map(|m| m as f64);
    let thousandth = |e: &[f64]| e.iter().map(|e| 1e3 * e).collect::<Vec<f64>>();
    let plot = Plot::new(format!("First frequency, N = {points}"))
        .x("δ/Δ", "")
        .y("ω/ω0 − 1", "10⁻³")
        // room for the legend above
        .y_range(1.1e3 * effective[4], -0.8e3 * effective[4])
        .line("not homogenized, Δ = L/N", &x, &thousandth(counted))
        .line("homogenized, Δ = L/N", &x, &thousandth(counted_homogenized))
        .dashed("not homogenized, (N−½)Δ = L", &x, &thousandth(effective))
        .dashed(
            "homogenized, (N−½)Δ = L",
            &x,
            &thousandth(effective_homogenized),
        );
    found.picture(plot.save(&context.out, "f-frequencies")?);

    let spread = |e: &[f64]| {
        let low = e.iter().copied().fold(f64::INFINITY, f64::min);
        e.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    found.holds(
        "constant",
        format!(
            "first frequencies, Δ = L/N, spread over {:.2e} without and {:.2e} with homogenization",
            spread(counted),
            spread(counted_homogenized)
        ),
        spread(counted_homogenized) < 0.1 * spread(counted),
    );
    found.holds(
        "two-spacings",
        format!(
            "δ = 2Δ, Δ = L/N: middle off by {:.4} without and {:.4} with homogenization, first frequency by {:.2e} and {:.2e}",
            histories[1][0], histories[1][1], counted[1], counted_homogenized[1]
        ),
        histories[1][0] < histories[1][1] && counted[1].abs() < counted_homogenized[1].abs(),
    );
    found.holds(
        "true-length",
        format!(
            "δ = 2Δ to 5Δ, (N−½)Δ = L: homogenized at most {:.1e}, others at least {:.1e} off",
            effective_homogenized[1..]
                .iter()
                .fold(0.0f64, |w, e| w.max(e.abs())),
            effective[1..]
                .iter()
                .fold(f64::INFINITY, |w, e| w.min(e.abs()))
        ),
        (1..5).all(|k| effective_homogenized[k].abs() < effective[k].abs()),
    );
    let half = bars(points / 2, Length::Effective)?;
    for (k, key, fine, order) in [
        (0, "order", effective, 1.0),
        (1, "order-homogenized", effective_homogenized, 2.0),
    ] {
        let off = (1..5).map(|m| (frequency_error(&half[m][k], 0) / fine[m]).log2() - order);
        found.number(key, largest(off.map(f64::abs)));
    }
    found.holds(
        "step",
        format!(
            "homogenized bars need {:.3}, {:.3}, {:.3}, {:.3} of the others' step at δ = 2Δ to 5Δ; the example's is at most {:.2} of that",
            shrinks[1],
            shrinks[2],
            shrinks[3],
            shrinks[4],
            used.iter().copied().fold(0.0, f64::max)
        ),
        shrinks.windows(2).all(|w| w[1] < w[0]) && used.iter().all(|u| *u < 1.0),
    );
    Ok(found)
}
