//! Fig. 4.6: a square pulse; the Gibbs oscillations of the classical continuum, of atoms and of peridynamics.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::SHARED;
use super::chain::Chain;
use super::motion::{Motion, Wanted, run};
use crate::{Context, Experiment, Failure, Findings};

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
/// The frames whose times are printed.
const FRAMES: [u64; 2] = [24, 93];
const SAFETY: f64 = 0.85;
/// Distance of the points that all runs share.
const SHARED_SPACING: f64 = 0.5;
/// The jumps stay where they were, and the points beside them swing: as far from there nothing is compared.
const AROUND: f64 = 1.0;

pub struct Figure46;

impl Experiment for Figure46 {
    fn key(&self) -> &'static str {
        "seleson2009"
    }

    fn figure(&self) -> &'static str {
        "figure-4-6"
    }

    fn title(&self) -> &'static str {
        "Gibbs oscillations of a square pulse"
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
                |_, _| Wanted {
                    profiles: vec![0, FRAMES[0], FRAMES[1]],
                    energies: 31,
                    ..Wanted::default()
                },
            )?;
            runs.push(motion);
        }
        let mut found = Findings::new();
        // the step is the same number in the small variant
        let dt = runs[MD].time_step;
        found.number("time-step", Chain::thousand(100_001, 20).time_step(SAFETY));
        found.number("time-early", FRAMES[0] as f64 * dt);
        found.number("time-late", FRAMES[1] as f64 * dt);
        let height = (runs[COARSE].profile(0)?.u.iter().sum::<f64>()) * SHARED_SPACING;
        found.number("closed-interval", height);

        let mut seen = [vec![], vec![]];
        let (mut agree, mut gibbs) = (true, true);
        let mut table = Table::new();
        let x: Vec<f64> = (0..=2000).map(|j| f64::from(j) * SHARED_SPACING).collect();
        table = table.column("x", "", x.clone());
        for (frame, when) in FRAMES.into_iter().zip(["early", "late"]) {
            let mut u = vec![];
            for m in &runs {
                u.push(&m.profile(frame)?.u);
            }
            let shared: Vec<Vec<f64>> = (0..4)
                .map(|k| {
                    let every = (SHARED_SPACING / runs[k].spacing).round() as usize;
                    u[k].iter().step_by(every).copied().collect()
                })
                .collect();
            let apart = |k: usize| {
                let d = (0..x.len())
                    .filter(|j| (x[*j] - 490.0).abs() > AROUND && (x[*j] - 510.0).abs() > AROUND)
                    .map(|j| (shared[k][j] - shared[FINE][j]).powi(2));
                (d.sum::<f64>() * SHARED_SPACING).sqrt()
            };
            seen[0].push(format!(
                "t = {:.2}: MD {:.3}, coarse PD {:.3}, CCM {:.3}",
                frame as f64 * dt,
                apart(MD),
                apart(COARSE),
                apart(CCM)
            ));
            agree &= apart(MD) < 0.2 * apart(CCM) && apart(COARSE) < 0.2 * apart(CCM);
            // up and down beyond the two steps of the pulse
            let over = [MD, FINE, COARSE, CCM].map(|k| oscillation(u[k]));
            seen[1].push(format!(
                "t = {:.2}: MD {:.2}, fine PD {:.2}, coarse PD {:.2}, CCM {:.2}",
                frame as f64 * dt,
                over[0],
                over[1],
                over[2],
                over[3]
            ));
            gibbs &= over[..3].iter().all(|o| over[3] > 2.0 * o);

            let plot = |title: String| {
                let plot = Plot::new(title)
                    .x("x (reference)", "")
                    .y("displacement", "");
                plot.x_range(475.0, 525.0).y_range(-0.35, 1.35)
            };
            let at = |k: usize| runs[k].x();
            let a = plot(format!(
                "MD, fine and coarse PD at t = {:.2}",
                frame as f64 * dt
            ))
            .line("fine PD", &at(FINE), u[FINE])
            .series("MD", &at(MD), u[MD], Stroke::Dashed, Mark::Square)
            .series(
                "coarse PD",
                &at(COARSE),
                u[COARSE],
                Stroke::Dotted,
                Mark::Triangle,
            );
            found.picture(a.save(&context.out, &format!("nonlocal-{when}"))?);
            let b = plot(format!("CCM at t = {:.2}", frame as f64 * dt)).line("", &at(CCM), u[CCM]);
            found.picture(b.save(&context.out, &format!("ccm-{when}"))?);
            for (k, (_, label)) in RUNS.iter().enumerate() {
                let name = format!("{label} at {:.4}", frame as f64 * dt);
                table = table.column(&name, "", shared[k].clone());
            }
        }
        found.holds("md-and-pd-agree", seen[0].join("; "), agree);
        found.holds("gibbs", seen[1].join("; "), gibbs);
        let mut closed = 0.0f64;
        for m in &runs {
            for frame in FRAMES {
                closed = closed.max(m.off_closed_form(frame)?);
            }
        }
        found.number("closed-form", closed);
        let drift = runs.iter().map(|m| m.drift(|e| e.invariant()));
        found.number("invariant", drift.fold(0.0, f64::max));
        let path = context.out.join("displacements.csv");
        table.save(&path)?;
        found.file(path);
        Ok(found)
    }
}

/// Ups and downs of a profile beyond those of one pulse of height 1: Σ|u_{j+1} − u_j| − 2.
fn oscillation(u: &[f64]) -> f64 {
    let path: f64 = u.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    // round-off of a single pulse
    (path - 2.0).max(0.0)
}

/// Fewer points for the two runs of 100,001, with the step of the full runs.
fn smaller(context: &Context, name: &str) -> Vec<(&'static str, String)> {
    let chain = match name {
        "ccm" if context.small => Chain::thousand(20_001, 4),
        "pd-fine" if context.small => Chain::thousand(20_001, 100),
        _ => return vec![],
    };
    let mut changes = chain.changes(SAFETY, 0.0);
    changes.retain(|(key, _)| key.starts_with("constants.") && *key != "constants.dt");
    changes
}
