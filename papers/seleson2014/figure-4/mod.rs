//! Fig. 4: the strain energy of the plate at the final time.

use crate::seleson2014::plate::{MESHES, Plate, Step, T, Wave, maps};
use crate::{Context, Failure, Findings};

experiment!(
    Figure4,
    "figure-4",
    "Energy of a wave on a plate",
    ["../plate.rs", "plate.toml"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut waves = vec![];
    for mesh in MESHES {
        context.say(&format!("plate with h = {mesh}a"));
        waves.push(Plate::new(context, mesh, Step::Hundred).run(context)?);
    }
    maps(&context.out, &waves, &mut found)?;
    let crests = [0, 1, 2].map(|k: usize| waves[k].crest());
    found.holds(
        "crest",
        format!(
            "largest radial displacement beyond r = 0.05 at r = {:.4}, {:.4}, {:.4}",
            crests[0][0], crests[1][0], crests[2][0]
        ),
        crests
            .iter()
            .all(|c| (c[0] - crests[0][0]).abs() <= 2.0 * waves[2].spacing),
    );
    for (key, wave) in ["preserved-2", "preserved-4"].iter().zip(&waves[1..]) {
        let d = wave.difference(&waves[0]);
        found.holds(
            key,
            format!(
                "displacements differ by {:.2} % (root of the squares)",
                100.0 * d
            ),
            d < if context.small { 0.25 } else { 0.1 },
        );
    }
    // the paper's step, where it is cheap
    let paper = Plate::new(context, 4, Step::Paper);
    let slow = Plate { ..paper }.run(context)?;
    let d = waves[2].difference(&slow);
    found.holds(
        "step",
        format!(
            "h = 4a: {} steps of {:.3e} s and {} of {:.3e} s: displacements differ by {:.3} %",
            waves[2].steps,
            waves[2].time_step,
            slow.steps,
            slow.time_step,
            100.0 * d
        ),
        d < 0.02,
    );
    if !context.small {
        let other = Plate {
            horizon: 12.0,
            ..Plate::new(context, 1, Step::Hundred)
        };
        let other = other.run(context)?;
        let d = other.difference(&waves[0]);
        found.holds(
            "horizon",
            format!(
                "12a against 12.1a at h = a: displacements differ by {:.2} %",
                100.0 * d
            ),
            // as much as the coarse meshes are allowed
            d < 0.1,
        );
        let limit = Plate::new(context, 1, Step::Limit).run(context)?;
        let d = limit.difference(&waves[0]);
        found.holds(
            "limit",
            format!(
                "h = a: {} steps of {:.3e} s and {} of {:.3e} s: displacements differ by {:.2} %",
                limit.steps,
                limit.time_step,
                waves[0].steps,
                waves[0].time_step,
                100.0 * d
            ),
            d < 0.1,
        );
        found.holds("cost", cost(&waves[0]), true);
    }
    Ok(found)
}

/// What the run takes, and what it would at the paper's step.
fn cost(fine: &Wave) -> String {
    let bond_steps = fine.bonds as f64 * T / 1.25e-9;
    format!(
        "{:.0} s for {} steps: {:.2} ns per directed bond and step; at the paper's step that is {:.2} h",
        fine.seconds,
        fine.steps,
        fine.ns(),
        fine.ns() * 1e-9 * bond_steps / 3600.0
    )
}
