//! Fig. 4.6: a square pulse; the Gibbs oscillations of the classical continuum, of atoms and of peridynamics.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::chain::Chain;
use super::motion::Wanted;
use super::runs::{
    self, CCM, COARSE, FINE, MD, MODELS, SAFETY, SHARED_SPACING, distance, fewer, shared, shared_x,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings};

experiment!(
    Figure46,
    "figure-4-6",
    "Gibbs oscillations of a square pulse",
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
/// The frames whose times are printed.
const FRAMES: [u64; 2] = [24, 93];
/// The jumps stay where they were, and the points beside them swing: as far from there nothing is compared.
const AROUND: f64 = 1.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let runs = runs::all(context, DECK, &MODELS, smaller, |_, _| Wanted {
        profiles: vec![0, FRAMES[0], FRAMES[1]],
        energies: 31,
        ..Wanted::default()
    })?;
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
    let x = shared_x();
    table = table.column("x", "", x.clone());
    for (frame, when) in FRAMES.into_iter().zip(["early", "late"]) {
        let mut u = vec![];
        for m in &runs {
            u.push(&m.profile(frame)?.u);
        }
        let shared: Vec<Vec<f64>> = runs.iter().zip(&u).map(|(m, u)| shared(m, u)).collect();
        let far = |x: f64| (x - 490.0).abs() > AROUND && (x - 510.0).abs() > AROUND;
        let apart = |k: usize| {
            let both = shared[k].iter().zip(&shared[FINE]);
            distance(both.zip(&x).filter(|(_, x)| far(**x)).map(|(pair, _)| pair))
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
        for (k, (_, label)) in MODELS.iter().enumerate() {
            let name = format!("{label} at {:.4}", frame as f64 * dt);
            table = table.column(&name, "", shared[k].clone());
        }
    }
    found.holds("md-and-pd-agree", seen[0].join("; "), agree);
    found.holds("gibbs", seen[1].join("; "), gibbs);
    runs::closed_form(&runs, |_| FRAMES.to_vec(), &mut found)?;
    runs::invariant(&runs, &mut found);
    let path = context.out.join("displacements.csv");
    table.save(&path)?;
    found.file(path);
    Ok(found)
}

/// Ups and downs of a profile beyond those of one pulse of height 1: Σ|u_{j+1} − u_j| − 2.
fn oscillation(u: &[f64]) -> f64 {
    let path: f64 = u.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    // round-off of a single pulse
    largest([path - 2.0])
}

/// Fewer points for the two runs of 100,001, with the step of the full runs.
fn smaller(name: &str) -> Vec<(&'static str, String)> {
    let [ccm, fine] = [4, 100].map(|n| Chain::thousand(20_001, n));
    let mut changes = fewer(name, ccm, fine).map_or(vec![], |c| c.changes(SAFETY, 0.0));
    changes.retain(|(key, _)| key.starts_with("constants.") && *key != "constants.dt");
    changes
}
