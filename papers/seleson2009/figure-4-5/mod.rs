//! Fig. 4.5: a chain of springs between nearest neighbours, and one of the same stiffness with five.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::SHARED;
use super::motion::{Motion, RightPulse, Wanted, run};
use crate::{Context, Experiment, Failure, Findings};

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [(&str, &str); 2] = [("local", "N = 1"), ("nonlocal", "N = 5")];
const SAFETY: f64 = 0.85;
/// The printed time.
const TIME: f64 = 150.45;
/// When the two pulses have separated.
const APART: f64 = 50.0;
/// Colours run from 1 − this to 1 + this.
const CONTRAST: f64 = 0.25;

pub struct Figure45;

impl Experiment for Figure45 {
    fn key(&self) -> &'static str {
        "seleson2009"
    }

    fn figure(&self) -> &'static str {
        "figure-4-5"
    }

    fn title(&self) -> &'static str {
        "Local and nonlocal springs: densities and displacements"
    }

    fn claims(&self) -> &'static str {
        include_str!("claims.toml")
    }

    fn readme(&self) -> &'static str {
        include_str!("README.md")
    }

    fn sources(&self) -> &'static [&'static str] {
        &[include_str!("mod.rs"), DECK, SHARED]
    }

    fn run(&self, context: &Context) -> Result<Findings, Failure> {
        let mut found = Findings::new();
        let mut runs: Vec<Motion> = vec![];
        for (name, label) in RUNS {
            let motion = run(context, DECK, name, name, &[], |steps, dt| Wanted {
                columns: 999,
                rows: 400,
                profiles: [0.0, APART, TIME]
                    .map(|t| (t / dt).round() as u64)
                    .into_iter()
                    .chain([steps])
                    .collect(),
                energies: 60,
            })?;
            let map = motion
                .image
                .map(&format!("MD: 1001 points, {label}"), CONTRAST);
            found.picture(map.save(&context.out, &format!("density-{name}"))?);
            let profile = motion.profile(motion.nearest(TIME))?;
            let title = format!("MD: 1001 points, {label}, t = {:.2}", profile.time);
            let plot = Plot::new(title)
                .x("x (reference)", "")
                .y("displacement", "")
                .x_range(300.0, 700.0)
                .y_range(-0.3, 0.6)
                .line("", &motion.x(), &profile.u);
            found.picture(plot.save(&context.out, &format!("displacement-{name}"))?);
            runs.push(motion);
        }
        let [local, nonlocal] = [&runs[0], &runs[1]];
        let frame = local.nearest(TIME);
        found.number("time", frame as f64 * local.time_step);
        found.number("frame", frame as f64);
        let rule = runs
            .iter()
            .map(|m| (m.chain().time_step(SAFETY) / m.time_step - 1.0).abs());
        found.number("time-steps", rule.fold(0.0, f64::max));
        // the same energy under the same strain is the same long-wave speed
        let stiffness = |m: &Motion| {
            let c = m.chain();
            let j = f64::from(m.neighbours);
            c.stiffness() * j * (j + 1.0) / 2.0
        };
        found.number("same-energy", stiffness(nonlocal) / stiffness(local));
        let pulse = |m: &Motion, time: f64| -> Result<RightPulse, Failure> {
            Ok(RightPulse::of(&m.profile(m.nearest(time))?.u, m.spacing))
        };
        let mut seen = vec![];
        let mut growth = vec![];
        for (m, (_, label)) in runs.iter().zip(RUNS) {
            let [before, after] = [pulse(m, APART)?, pulse(m, TIME)?];
            let [height, width] = [after.height / before.height, after.width / before.width];
            growth.push([after.height, after.width]);
            seen.push(format!(
                "{label}: height {:.3} (× {height:.3} since t = 50), width {:.2} (× {width:.3})",
                after.height, after.width
            ));
        }
        found.holds(
            "nonlocal-is-more-dispersive",
            seen.join("; "),
            growth[1][0] < 0.9 * growth[0][0] && growth[1][1] > 1.1 * growth[0][1],
        );
        let low = runs
            .iter()
            .map(|m| {
                Ok(m.profile(m.nearest(TIME))?
                    .u
                    .iter()
                    .copied()
                    .fold(0.0, f64::min))
            })
            .collect::<Result<Vec<f64>, Failure>>()?;
        found.holds(
            "waves-behind",
            format!(
                "lowest displacement: N = 1 {:.3}, N = 5 {:.3}",
                low[0], low[1]
            ),
            low[1] < 2.0 * low[0] && low[0] < -0.01,
        );
        let mut closed = 0.0f64;
        for m in &runs {
            closed = closed.max(m.off_closed_form(m.steps)?);
        }
        found.number("closed-form", closed);
        let drift = runs.iter().map(|m| m.drift(|e| e.invariant()));
        found.number("invariant", drift.fold(0.0, f64::max));

        let path = context.out.join("displacements.csv");
        let mut table = Table::new().column("x", "", local.x());
        for (m, (_, label)) in runs.iter().zip(RUNS) {
            let p = m.profile(m.nearest(TIME))?;
            table = table.column(&format!("{label} at {:.4}", p.time), "", p.u.clone());
        }
        table.save(&path)?;
        found.file(path);
        Ok(found)
    }
}
