//! Fig. 6: the strain energy of the cube at the final time, on an octant.

use peridyne_io::write::run_json::peak_memory_bytes;

use crate::seleson2014::cube::{self, Cube, Wave, family};
use crate::seleson2014::deck;
use crate::{Context, Failure, Findings};

experiment!(
    Figure6,
    "figure-6",
    "Energy of a wave in a cube",
    ["../cube.rs", "cube.toml"],
    Minutes
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let cube = match context.small {
        true => Cube {
            points: 40,
            steps: 20,
            part: 0,
        },
        false => Cube {
            points: 200,
            steps: 100,
            part: 0,
        },
    };
    let wave = cube.run(context)?;
    let mut found = Findings::new();
    wave.pictures(&context.out, &mut found)?;
    wave.judge(&mut found);
    let other = |steps| Cube { steps, ..cube }.run(context);
    let [long, short] = [cube.steps / 2, cube.steps * 2].map(other);
    limit([&long?, &wave, &short?], &mut found);

    // the fine-scale simulation that was not run: a = h/4, ε = 12a, Δt/4
    let deck = deck(cube::DECK, "cube.toml", &[])?;
    let h = deck.spec.body.spacing().unwrap_or(f64::NAN);
    let atoms = (4.0 / h).powi(3).round();
    found.number("fine-atoms", atoms);
    let ratio = 64.0 * family(12) as f64 / family(3) as f64 * 4.0;
    found.number("fine-cost", ratio);
    // hours of a year
    found.number("fine-years", ratio / (24.0 * 365.25));
    let directed = atoms * family(12) as f64;
    found.holds(
        "fine-memory",
        format!(
            "{:.2} bytes for a directed bond; indices of 4 bytes take {:.1} TB once for each bond, {:.1} TB from both ends",
            1e13 / directed,
            2e-12 * directed,
            4e-12 * directed
        ),
        (2e-12 * directed..4e-12 * directed).contains(&10.0),
    );
    if context.small {
        return Ok(found);
    }
    found.number("points", wave.points as f64);
    let ns = wave.record.ns(wave.bonds, wave.steps);
    found.measured("time of the cube", wave.record.seconds, "s");
    found.measured("steps in that time", wave.steps as f64, "");
    found.measured("directed bonds", wave.bonds as f64, "");
    found.measured("time of a directed bond in a step", ns, "ns");
    found.measured(
        "time at the paper's 10,000 steps by this",
        ns * 1e-9 * wave.bonds as f64 * 1e4,
        "s",
    );
    found.measured("memory that the model holds", wave.bytes as f64 / 1e9, "GB");
    // some systems do not tell
    let peak = peak_memory_bytes().unwrap_or(wave.bytes as u64);
    found.measured(
        "memory of the process at most (in one call with other figures the largest of all; paper: 4,096 cores)",
        peak as f64 / 1e9,
        "GB",
    );
    Ok(found)
}

/// The claim `limit`: the same with twice and half the step, in order of falling steps.
fn limit(waves: [&Wave; 3], found: &mut Findings) {
    let [long, middle, short] = waves;
    let [a, b] = [long, middle].map(|w| w.difference(short));
    found.holds(
        "limit",
        format!(
            "displacements of {} and {} steps differ from those of {} by {:.3} % and {:.3} %",
            long.steps,
            middle.steps,
            short.steps,
            100.0 * a,
            100.0 * b
        ),
        a > 3.0 * b,
    );
    // an error of C/n² with n steps: C (1/n² − 1/(2n)²) is b
    found.measured(
        "error of the time step by that, of the run that is shown",
        400.0 / 3.0 * b,
        "%",
    );
}
