//! Fig. 4.4: displacements at t = 150.05 of atoms, fine and coarse peridynamics, and of the classical continuum.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;

use super::chain::Chain;
use super::modes::displacements;
use super::motion::{self, Motion, Profile, Wanted};
use super::runs::{
    self, CCM, COARSE, FINE, MD, MODELS, SAFETY, distance, fewer_points, lowest, shared, shared_x,
};
use crate::measure::largest;
use crate::{Context, Failure, Findings, profile};

experiment!(
    Figure44,
    "figure-4-4",
    "Displacements of MD, PD and CCM at t = 150.05",
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
/// The printed time, and its frame of the fine run.
const TIME: f64 = 150.05;
const FRAME: f64 = 130.0;

fn run(context: &Context) -> Result<Findings, Failure> {
    let whole = |steps, _| Wanted {
        profiles: vec![0, steps],
        ..Wanted::default()
    };
    let landed = runs::all(context, DECK, &MODELS, smaller, whole)?;
    // the step as (4.13) has it, and the frame nearest to the time
    let mut nearest = vec![];
    for (motion, (name, _)) in landed.iter().zip(MODELS) {
        let dt = motion.chain().time_step(SAFETY);
        let mut changes = if context.small { smaller(name) } else { vec![] };
        changes.push(("constants.dt", format!("{dt:?}")));
        changes.push(("run.steps", (TIME / dt).round().to_string()));
        let part = format!("{name}-frame");
        nearest.push(motion::run(context, DECK, name, &part, &changes, whole)?);
    }
    let mut found = Findings::new();
    let last = |m: &'_ Motion| m.profile(m.steps).cloned();
    let ends: Vec<Profile> = landed.iter().map(last).collect::<Result<_, _>>()?;
    let frames: Vec<Profile> = nearest.iter().map(last).collect::<Result<_, _>>()?;
    let x = shared_x();
    let all_shared = |of: &[Profile]| -> Vec<Vec<f64>> {
        landed
            .iter()
            .zip(of)
            .map(|(m, p)| shared(m, &p.u))
            .collect()
    };
    let [at_time, at_frame] = [all_shared(&ends), all_shared(&frames)];
    let exact: Vec<f64> = x
        .iter()
        .map(|x| 0.5 * (profile::seleson2009(x - TIME) + profile::seleson2009(x + TIME)))
        .collect();

    let dt = Chain::thousand(100_001, 500).time_step(SAFETY);
    found.number("time", FRAME * dt);
    found.measured(
        "largest distance of the compared states from the printed time (steps are changed to land there)",
        largest(ends.iter().map(|p| (p.time - TIME).abs())),
        "",
    );
    let apart = |a: &[f64], b: &[f64]| distance(a.iter().zip(b));
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
    let heights: Vec<f64> = at_time.iter().map(|u| largest(u.iter().copied())).collect();
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
    let lowest = |k: usize| lowest(&at_time[k]);
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
    runs::closed_form(landed.iter().chain(&nearest), |m| vec![m.steps], &mut found)?;

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
    for (k, (_, label)) in MODELS.iter().enumerate() {
        table = table.column(&format!("{label} at 150.05"), "", at_time[k].clone());
    }
    for (k, (_, label)) in MODELS.iter().enumerate() {
        let name = format!("{label} at {:.3}", frames[k].time);
        table = table.column(&name, "", at_frame[k].clone());
    }
    table
        .column("d'Alembert at 150.05", "", exact)
        .save(&path)?;
    found.file(path);
    Ok(found)
}

/// Fewer points for the two runs of 100,001, with a step that lands on the time.
fn smaller(name: &str) -> Vec<(&'static str, String)> {
    let Some(chain) = fewer_points(name) else {
        return vec![];
    };
    let steps = (TIME / chain.time_step(SAFETY)).ceil();
    let mut changes = chain.changes(SAFETY, TIME);
    changes.push(("constants.dt", format!("{:?}", TIME / steps)));
    changes.push(("run.steps", steps.to_string()));
    changes
}
