//! Fig. 4.5: a chain of springs between nearest neighbours, and one of the same stiffness with five.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::motion::{Motion, RightPulse, Wanted};
use super::runs::{self, APART, Name, lowest};
use crate::{Context, Failure, Findings};

experiment!(
    Figure45,
    "figure-4-5",
    "Local and nonlocal springs: densities and displacements",
    [
        "../chain.rs",
        "../deck.rs",
        "../modes.rs",
        "../motion.rs",
        "../runs.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [Name; 2] = [("local", "MD"), ("nonlocal", "MD")];
/// The printed time.
const TIME: f64 = 150.45;

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let wanted = |steps: u64, dt: f64| Wanted {
        images: true,
        profiles: [0.0, APART, TIME]
            .map(|t| (t / dt).round() as u64)
            .into_iter()
            .chain([steps])
            .collect(),
        energies: 60,
    };
    let runs = runs::all(context, DECK, &RUNS, |_| vec![], wanted)?;
    runs::densities(context, &runs, &RUNS, &mut found)?;
    for (motion, (name, label)) in runs.iter().zip(RUNS) {
        let profile = motion.profile(motion.nearest(TIME))?;
        let title = format!("{}, t = {:.2}", motion.titled(label), profile.time);
        let plot = Plot::new(title)
            .x("x (reference)", "")
            .y("displacement", "")
            .x_range(300.0, 700.0)
            .y_range(-0.3, 0.6)
            .line("", &motion.x(), &profile.u);
        found.picture(plot.save(&context.out, &format!("displacement-{name}"))?);
    }
    let [local, nonlocal] = [&runs[0], &runs[1]];
    let frame = local.nearest(TIME);
    found.number("time", frame as f64 * local.time_step);
    found.number("frame", frame as f64);
    found.number("time-steps", runs::off_the_rule(&runs));
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
    for m in &runs {
        let [before, after] = [pulse(m, APART)?, pulse(m, TIME)?];
        let [height, width] = [after.height / before.height, after.width / before.width];
        growth.push([after.height, after.width]);
        seen.push(format!(
            "N = {}: height {:.3} (× {height:.3} since t = 50), width {:.2} (× {width:.3})",
            m.neighbours, after.height, after.width
        ));
    }
    found.holds(
        "nonlocal-is-more-dispersive",
        seen.join("; "),
        growth[1][0] < 0.9 * growth[0][0] && growth[1][1] > 1.1 * growth[0][1],
    );
    let mut low = vec![];
    for m in &runs {
        low.push(lowest(&m.profile(m.nearest(TIME))?.u));
    }
    found.holds(
        "waves-behind",
        format!(
            "lowest displacement: N = 1 {:.3}, N = 5 {:.3}",
            low[0], low[1]
        ),
        low[1] < 2.0 * low[0] && low[0] < -0.01,
    );
    runs::closed_form(&runs, |m| vec![m.steps], &mut found)?;
    runs::invariant(&runs, &mut found);

    let path = context.out.join("displacements.csv");
    let mut table = Table::new().column("x", "", local.x());
    for m in &runs {
        let p = m.profile(m.nearest(TIME))?;
        table = table.column(
            &format!("N = {} at {:.4}", m.neighbours, p.time),
            "",
            p.u.clone(),
        );
    }
    table.save(&path)?;
    found.file(path);
    Ok(found)
}
