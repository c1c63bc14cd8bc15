//! Fig. 4.4: displacements at t = 150.05 of atoms, fine and coarse peridynamics, and of the classical continuum.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::SHARED;
use super::chain::Chain;
use super::modes::displacements;
use super::motion::{Motion, Profile, Wanted, run};
use crate::{Context, Experiment, Failure, Findings, profile};

const DECK: &str = include_str!("deck.toml");
/// Names of the runs in the deck, and what they are called.
const RUNS: [(&str, &str); 4] = [
    ("md", "MD"),
    ("ccm", "CCM"),
    ("pd-fine", "fine PD"),
    ("pd-coarse", "coarse PD"),
];
const MD: usize = 0;
const CCM: usize = 1;
const FINE: usize = 2;
const COARSE: usize = 3;
const SAFETY: f64 = 0.85;
/// The printed time, and its frame of the fine run.
const TIME: f64 = 150.05;
const FRAME: f64 = 130.0;
/// Distance of the points that all runs share.
const SHARED_SPACING: f64 = 0.5;

pub struct Figure44;

impl Experiment for Figure44 {
    fn key(&self) -> &'static str {
        "seleson2009"
    }

    fn figure(&self) -> &'static str {
        "figure-4-4"
    }

    fn title(&self) -> &'static str {
        "Displacements of MD, PD and CCM at t = 150.05"
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
        let (mut landed, mut nearest): (Vec<Motion>, Vec<Motion>) = (vec![], vec![]);
        for (name, _) in RUNS {
            let whole = |steps, _| Wanted {
                profiles: vec![0, steps],
                ..Wanted::default()
            };
            let motion = run(context, DECK, name, name, &smaller(context, name), whole)?;
            // the step as (4.13) has it, and the frame nearest to the time
            let dt = motion.chain().time_step(SAFETY);
            let mut changes = smaller(context, name);
            changes.push(("constants.dt", format!("{dt:?}")));
            changes.push(("run.steps", (TIME / dt).round().to_string()));
            let part = format!("{name}-frame");
            nearest.push(run(context, DECK, name, &part, &changes, whole)?);
            landed.push(motion);
        }
        let mut found = Findings::new();
        let last = |m: &'_ Motion| m.profile(m.steps).cloned();
        let ends: Vec<Profile> = landed.iter().map(last).collect::<Result<_, _>>()?;
        let frames: Vec<Profile> = nearest.iter().map(last).collect::<Result<_, _>>()?;
        let x: Vec<f64> = (0..=2000).map(|j| f64::from(j) * SHARED_SPACING).collect();
        let shared = |k: usize, of: &[Profile]| -> Vec<f64> {
            let every = (SHARED_SPACING / landed[k].spacing).round() as usize;
            of[k].u.iter().step_by(every).copied().collect()
        };
        let at_time: Vec<Vec<f64>> = (0..4).map(|k| shared(k, &ends)).collect();
        let at_frame: Vec<Vec<f64>> = (0..4).map(|k| shared(k, &frames)).collect();
        let exact: Vec<f64> = x
            .iter()
            .map(|x| 0.5 * (profile::seleson2009(x - TIME) + profile::seleson2009(x + TIME)))
            .collect();

        let dt = Chain::thousand(100_001, 500).time_step(SAFETY);
        found.number("time", FRAME * dt);
        let late = ends
            .iter()
            .map(|p| (p.time - TIME).abs())
            .fold(0.0, f64::max);
        found.number("landed", late);
        let apart = |a: &[f64], b: &[f64]| {
            let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            (squares * SHARED_SPACING).sqrt()
        };
        let from_fine = [MD, COARSE, CCM].map(|k| apart(&at_time[k], &at_time[FINE]));
        found.holds(
            "md-and-pd-agree",
            format!(
                "distance from fine PD: MD {:.4}, coarse PD {:.4}, CCM {:.4}",
                from_fine[0], from_fine[1], from_fine[2]
            ),
            from_fine[0] < 0.2 * from_fine[2] && from_fine[1] < 0.2 * from_fine[2],
        );
        // the same without the time stepper's error: closed forms with a step 64 times smaller
        let window: Vec<f64> = x
            .iter()
            .copied()
            .filter(|x| (550.0..700.0).contains(x))
            .collect();
        let mut steady: Vec<Vec<f64>> = vec![];
        for k in [MD, COARSE, FINE] {
            let m = &landed[k];
            let at: Vec<usize> = window
                .iter()
                .map(|x| (x / m.spacing).round() as usize)
                .collect();
            let (dt, steps) = (m.time_step / 64.0, 64 * m.steps);
            steady.push(displacements(&m.chain(), dt, steps, &m.profile(0)?.u, &at));
        }
        // the other half is its mirror image
        let both = std::f64::consts::SQRT_2;
        let model = [0, 1].map(|k| both * apart(&steady[k], &steady[2]));
        found.holds(
            "without-the-time-step",
            format!(
                "distance from fine PD at Δt/64: MD {:.4}, coarse PD {:.4}",
                model[0], model[1]
            ),
            model[0] < model[1] && model[1] < 0.25 * from_fine[2],
        );
        let heights: Vec<f64> = at_time
            .iter()
            .map(|u| u.iter().copied().fold(0.0, f64::max))
            .collect();
        found.holds(
            "nonlocal-is-lower",
            format!(
                "heights: MD {:.3}, fine PD {:.3}, coarse PD {:.3}, CCM {:.3}",
                heights[MD], heights[FINE], heights[COARSE], heights[CCM]
            ),
            [MD, FINE, COARSE]
                .iter()
                .all(|k| heights[*k] < 0.9 * heights[CCM]),
        );
        let lowest = |k: usize| at_time[k].iter().copied().fold(0.0, f64::min);
        found.holds(
            "waves-behind",
            format!(
                "lowest displacement: MD {:.3}, fine PD {:.3}, coarse PD {:.3}, CCM {:.3}",
                lowest(MD),
                lowest(FINE),
                lowest(COARSE),
                lowest(CCM)
            ),
            [MD, FINE, COARSE].iter().all(|k| lowest(*k) < -0.05) && lowest(CCM) > -0.05,
        );
        let off = apart(&at_time[CCM], &exact) / apart(&exact, &vec![0.0; exact.len()]);
        found.holds(
            "ccm-keeps-its-shape",
            format!("relative distance from d'Alembert's solution: {off:.2e}"),
            off < 0.05,
        );
        let mut closed = 0.0f64;
        for m in landed.iter().chain(&nearest) {
            closed = closed.max(m.off_closed_form(m.steps)?);
        }
        found.number("closed-form", closed);

        let plot = |title: &str| {
            let plot = Plot::new(title)
                .x("x (reference)", "")
                .y("displacement", "");
            plot.x_range(300.0, 700.0).y_range(-0.3, 0.6)
        };
        let nonlocal = |title: &str, u: &[Vec<f64>]| {
            plot(title)
                .line("fine PD", &x, &u[FINE])
                .series("MD", &x, &u[MD], Stroke::Dashed, Mark::None)
                .series("coarse PD", &x, &u[COARSE], Stroke::Dotted, Mark::None)
        };
        let a = nonlocal("MD, fine and coarse PD at t = 150.05", &at_time);
        found.picture(a.save(&context.out, "nonlocal")?);
        let close = a.x_range(610.0, 670.0);
        found.picture(close.save(&context.out, "nonlocal-close")?);
        let frames_plot = nonlocal(
            "MD, fine and coarse PD, frames nearest to 150.05",
            &at_frame,
        );
        found.picture(frames_plot.save(&context.out, "nonlocal-frames")?);
        let b = plot("CCM at t = 150.05")
            .line("CCM", &x, &at_time[CCM])
            .dashed("d'Alembert", &x, &exact);
        found.picture(b.save(&context.out, "ccm")?);

        let path = context.out.join("displacements.csv");
        let mut table = Table::new().column("x", "", x.clone());
        for (k, (_, label)) in RUNS.iter().enumerate() {
            table = table.column(&format!("{label} at 150.05"), "", at_time[k].clone());
        }
        for (k, (_, label)) in RUNS.iter().enumerate() {
            let name = format!("{label} at {:.3}", frames[k].time);
            table = table.column(&name, "", at_frame[k].clone());
        }
        table
            .column("d'Alembert at 150.05", "", exact)
            .save(&path)?;
        found.file(path);
        Ok(found)
    }
}

/// Fewer points for the two runs of 100,001, with a step that lands on the time.
fn smaller(context: &Context, name: &str) -> Vec<(&'static str, String)> {
    let chain = match name {
        "ccm" if context.small => Chain::thousand(40_001, 8),
        "pd-fine" if context.small => Chain::thousand(8001, 40),
        _ => return vec![],
    };
    let steps = (TIME / chain.time_step(SAFETY)).ceil();
    let mut changes = chain.changes(SAFETY, TIME);
    changes.push(("constants.dt", format!("{:?}", TIME / steps)));
    changes.push(("run.steps", steps.to_string()));
    changes
}
