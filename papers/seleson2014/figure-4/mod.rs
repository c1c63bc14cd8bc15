//! Fig. 4: the strain energy of the plate at the final time.

use crate::seleson2014::plate::{self, Plate, Step, T, Wave, maps};
use crate::{Context, Failure, Findings};

experiment!(
    Figure4,
    "figure-4",
    "Energy of a wave on a plate",
    ["../plate.rs", "plate.toml"],
    Minutes
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let waves = plate::waves(context)?;
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
    let [limit, half] =
        [Step::Limit, Step::HalfLimit].map(|step| Plate::new(context, 1, step).run(context));
    let (limit, half) = (limit?, half?);
    let d = [&limit, &half].map(|w| w.difference(&waves[0]));
    found.holds(
        "limit",
        format!(
            "h = a: {} steps of {:.3e} s, {} of {:.3e} s and {} of {:.3e} s: displacements of the first two differ from the last by {:.2} % and {:.2} %",
            limit.steps,
            limit.time_step,
            half.steps,
            half.time_step,
            waves[0].steps,
            waves[0].time_step,
            100.0 * d[0],
            100.0 * d[1]
        ),
        d[0] > 3.0 * d[1],
    );
    if !context.small {
        let other = Plate {
            horizon: 12.0,
            ..Plate::new(context, 1, Step::Hundred)
        };
        let other = other.run(context)?;
        found.measured(
            "displacements with ε = 12a against 12.1a, h = a: difference (root of the squares)",
            100.0 * other.difference(&waves[0]),
            "%",
        );
        cost(&waves[0], &mut found);
    }
    Ok(found)
}

/// What the run takes, and what it would at the paper's step.
fn cost(fine: &Wave, found: &mut Findings) {
    let (ns, steps) = (fine.record.ns(fine.bonds, fine.steps), T / 1.25e-9);
    found.measured("time of the plate with h = a", fine.record.seconds, "s");
    found.measured("steps in that time", fine.steps as f64, "");
    found.measured("time of a directed bond in a step", ns, "ns");
    found.measured(
        "time at the paper's step by this (14,564 s on 64 cores)",
        ns * 1e-9 * fine.bonds as f64 * steps,
        "s",
    );
}
