//! Fig. 4.3: densities of atoms, of the classical continuum, and of fine and coarse peridynamics over space and time.

use peridyne_io::write::table::Table;

use super::motion::{Motion, RightPulse, Wanted};
use super::runs::{self, APART, CCM, COARSE, FINE, MD, MODELS, SAFETY, fewer_points};
use crate::measure::largest;
use crate::{Context, Failure, Findings, profile};

experiment!(
    Figure43,
    "figure-4-3",
    "Densities of MD, CCM, fine and coarse PD over space and time",
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
/// End of the runs.
const END: f64 = 300.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let smaller = |name: &str| fewer_points(name).map_or(vec![], |c| c.changes(SAFETY, END));
    let runs = runs::all(context, DECK, &MODELS, smaller, |steps, dt| Wanted {
        images: true,
        profiles: vec![0, (APART / dt).round() as u64, steps],
        energies: 40,
    })?;
    let mut found = Findings::new();
    runs::densities(context, &runs, &MODELS, &mut found)?;
    let mut pulses = vec![];
    for motion in &runs {
        let pulse = |step| -> Result<RightPulse, Failure> {
            Ok(RightPulse::of(&motion.profile(step)?.u, motion.spacing))
        };
        pulses.push([pulse(motion.nearest(APART))?, pulse(motion.steps)?]);
    }

    for (key, k) in [("steps-md", 0), ("steps-pd-coarse", 3)] {
        found.number(key, runs[k].steps as f64);
    }
    let steps: Vec<String> = runs.iter().map(|m| m.time_step.to_string()).collect();
    found.holds(
        "time-steps",
        steps.join(", "),
        runs::off_the_rule(&runs) < 1e-12,
    );
    let horizons: Vec<f64> = runs.iter().map(Motion::horizon).collect();
    let constant = [MD, FINE, COARSE]
        .iter()
        .all(|k| (horizons[*k] - 5.0).abs() < 1e-12);
    found.holds(
        "horizons",
        format!("{horizons:?} for {:?}", MODELS.map(|r| r.1)),
        constant && horizons[CCM] < 1.0,
    );

    // d'Alembert: half of the pulse each way
    let ccm = runs[CCM].profile(runs[CCM].steps)?;
    let off = (0..runs[CCM].points).map(|j| {
        let x = j as f64 * runs[CCM].spacing;
        let halves = profile::seleson2009(x - ccm.time) + profile::seleson2009(x + ccm.time);
        (ccm.u[j] - 0.5 * halves).abs()
    });
    let off = largest(off);
    found.holds(
        "ccm-does-not-disperse",
        format!(
            "largest distance from d'Alembert's solution at t = {:.2}: {off:.2e}",
            ccm.time
        ),
        off < 0.05,
    );
    let spread = |k: usize| {
        let [before, after] = &pulses[k];
        [after.height / before.height, after.width / before.width]
    };
    let seen: Vec<String> = (0..4)
        .map(|k| {
            let [height, width] = spread(k);
            format!("{}: height × {height:.3}, width × {width:.3}", MODELS[k].1)
        })
        .collect();
    let disperses = |k: usize| spread(k)[0] < 0.9 && spread(k)[1] > 1.1;
    found.holds(
        "nonlocal-disperses",
        seen.join("; "),
        [MD, FINE, COARSE].into_iter().all(disperses) && !disperses(CCM),
    );
    // crests of all models at the end, against the classical one
    let lag = |k: usize| runs[k].steps as f64 * runs[k].time_step + 500.0 - pulses[k][1].crest;
    let alike = |k: usize| {
        (pulses[k][1].height - pulses[2][1].height).abs()
            < 0.2 * (pulses[CCM][1].height - pulses[2][1].height)
            && (lag(k) - lag(2)).abs() < 0.2 * (lag(CCM) - lag(2)).abs()
    };
    found.holds(
        "md-is-like-pd",
        (0..4)
            .map(|k| {
                let height = pulses[k][1].height;
                format!(
                    "{}: crest {height:.3}, behind t by {:.2}",
                    MODELS[k].1,
                    lag(k)
                )
            })
            .collect::<Vec<_>>()
            .join("; "),
        alike(0) && alike(3),
    );
    runs::closed_form(&runs, |m| vec![m.steps], &mut found)?;
    runs::invariant(&runs, &mut found);
    let wobble = largest(runs.iter().map(|m| m.drift(|e| e.total())));
    found.holds(
        "energy-wobbles",
        format!("KE + PE changes by up to {:.1} %", 100.0 * wobble),
        (0.005..0.2).contains(&wobble),
    );

    let path = context.out.join("runs.csv");
    let column = |f: &dyn Fn(usize) -> f64| (0..4).map(f).collect::<Vec<_>>();
    Table::new()
        .text("model", MODELS.map(|r| r.1))
        .column("Nx", "", column(&|k| runs[k].points as f64))
        .column("N", "", column(&|k| f64::from(runs[k].neighbours)))
        .column("time step", "", column(&|k| runs[k].time_step))
        .column("steps", "", column(&|k| runs[k].steps as f64))
        .column("height at t = 50", "", column(&|k| pulses[k][0].height))
        .column("height at the end", "", column(&|k| pulses[k][1].height))
        .column("width at t = 50", "", column(&|k| pulses[k][0].width))
        .column("width at the end", "", column(&|k| pulses[k][1].width))
        .column("crest at the end", "", column(&|k| pulses[k][1].crest))
        .column(
            "change of KE + PE",
            "",
            column(&|k| runs[k].drift(|e| e.total())),
        )
        .column(
            "change of the invariant",
            "",
            column(&|k| runs[k].drift(|e| e.invariant())),
        )
        .save(&path)?;
    found.file(path);
    Ok(found)
}
