//! Fig. 4.3: densities of atoms, of the classical continuum, and of fine and coarse peridynamics over space and time.

use peridyne_io::write::table::Table;

use super::SHARED;
use super::chain::Chain;
use super::motion::{Motion, RightPulse, Wanted, run};
use crate::{Context, Experiment, Failure, Findings, profile};

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [(&str, &str); 4] = [
    ("md", "MD"),
    ("ccm", "CCM"),
    ("pd-fine", "fine PD"),
    ("pd-coarse", "coarse PD"),
];
const CCM: usize = 1;
/// Safety factor of (4.13), and the end of the runs.
const SAFETY: f64 = 0.85;
const END: f64 = 300.0;
/// When the two pulses have separated.
const APART: f64 = 50.0;
/// Colours run from 1 − this to 1 + this.
const CONTRAST: f64 = 0.25;

pub struct Figure43;

impl Experiment for Figure43 {
    fn key(&self) -> &'static str {
        "seleson2009"
    }

    fn figure(&self) -> &'static str {
        "figure-4-3"
    }

    fn title(&self) -> &'static str {
        "Densities of MD, CCM, fine and coarse PD over space and time"
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
        let mut runs: Vec<Motion> = vec![];
        for (name, _) in RUNS {
            let motion = run(
                context,
                DECK,
                name,
                name,
                &smaller(context, name),
                |steps, dt| Wanted {
                    columns: 1000,
                    rows: 400,
                    profiles: vec![0, (APART / dt).round() as u64, steps],
                    energies: 40,
                },
            )?;
            runs.push(motion);
        }
        let mut found = Findings::new();
        let mut pulses = vec![];
        for (motion, (name, label)) in runs.iter().zip(RUNS) {
            let title = format!(
                "{label}: {} points, N = {}",
                motion.points, motion.neighbours
            );
            let map = motion.image.map(&title, CONTRAST);
            found.picture(map.save(&context.out, &format!("density-{name}"))?);
            let pulse = |step| -> Result<RightPulse, Failure> {
                Ok(RightPulse::of(&motion.profile(step)?.u, motion.spacing))
            };
            pulses.push([pulse(motion.nearest(APART))?, pulse(motion.steps)?]);
        }

        for (key, k) in [("steps-md", 0), ("steps-pd-coarse", 3)] {
            found.number(key, runs[k].steps as f64);
        }
        let steps: Vec<String> = runs.iter().map(|m| m.time_step.to_string()).collect();
        let rule = |m: &Motion| m.chain().time_step(SAFETY) / m.time_step - 1.0;
        found.holds(
            "time-steps",
            steps.join(", "),
            runs.iter().all(|m| rule(m).abs() < 1e-12),
        );
        let horizons: Vec<f64> = runs.iter().map(Motion::horizon).collect();
        let constant = [0, 2, 3].iter().all(|k| (horizons[*k] - 5.0).abs() < 1e-12);
        found.holds(
            "horizons",
            format!("{horizons:?} for {:?}", RUNS.map(|r| r.1)),
            constant && horizons[CCM] < 1.0,
        );

        // d'Alembert: half of the pulse each way
        let ccm = runs[CCM].profile(runs[CCM].steps)?;
        let off = (0..runs[CCM].points).map(|j| {
            let x = j as f64 * runs[CCM].spacing;
            let halves = profile::seleson2009(x - ccm.time) + profile::seleson2009(x + ccm.time);
            (ccm.u[j] - 0.5 * halves).abs()
        });
        let off = off.fold(0.0, f64::max);
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
                format!("{}: height × {height:.3}, width × {width:.3}", RUNS[k].1)
            })
            .collect();
        let disperses = |k: usize| spread(k)[0] < 0.9 && spread(k)[1] > 1.1;
        found.holds(
            "nonlocal-disperses",
            seen.join("; "),
            [0, 2, 3].into_iter().all(disperses) && !disperses(CCM),
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
                        RUNS[k].1,
                        lag(k)
                    )
                })
                .collect::<Vec<_>>()
                .join("; "),
            alike(0) && alike(3),
        );
        let mut closed = 0.0f64;
        for motion in &runs {
            closed = closed.max(motion.off_closed_form(motion.steps)?);
        }
        found.number("closed-form", closed);
        let drift = runs.iter().map(|m| m.drift(|e| e.invariant()));
        found.number("invariant", drift.fold(0.0, f64::max));
        let wobble = runs
            .iter()
            .map(|m| m.drift(|e| e.total()))
            .fold(0.0, f64::max);
        found.holds(
            "energy-wobbles",
            format!("KE + PE changes by up to {:.1} %", 100.0 * wobble),
            (0.005..0.2).contains(&wobble),
        );

        let path = context.out.join("runs.csv");
        let column = |f: &dyn Fn(usize) -> f64| (0..4).map(f).collect::<Vec<_>>();
        Table::new()
            .text("model", RUNS.map(|r| r.1))
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
}

/// Fewer points for the two runs of 100,001.
fn smaller(context: &Context, name: &str) -> Vec<(&'static str, String)> {
    match name {
        "ccm" if context.small => Chain::thousand(40_001, 8).changes(SAFETY, END),
        "pd-fine" if context.small => Chain::thousand(8001, 40).changes(SAFETY, END),
        _ => vec![],
    }
}
