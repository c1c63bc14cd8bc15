//! Fig. 6: the strain energy of the cube at the final time, on an octant.

use crate::seleson2014::cube::{Cube, family};
use crate::{Context, Failure, Findings};

experiment!(
    Figure6,
    "figure-6",
    "Energy of a wave in a cube",
    ["../cube.rs", "cube.toml"]
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

    // the fine-scale simulation that was not run: a = h/4, ε = 12a, Δt/4
    found.number("fine-atoms", 64.0 * 200.0f64.powi(3));
    let ratio = 64.0 * family(12) as f64 / family(3) as f64 * 4.0;
    found.number("fine-cost", ratio);
    let bonds = 64.0 * 200.0f64.powi(3) * family(12) as f64;
    found.holds(
        "fine-memory",
        format!(
            "{bonds:.2e} directed bonds: 10 TB are {:.1} bytes for each; a stencil stores none",
            1e13 / bonds
        ),
        (1.0..10.0).contains(&(1e13 / bonds)),
    );
    if context.small {
        return Ok(found);
    }
    found.number("points", wave.points as f64);
    found.holds(
        "cost",
        format!(
            "{:.0} s for {} steps of {:.1e} s: {:.2} ns per directed bond and step ({} bonds); at the paper's step that is {:.1} h; the model holds {:.2} GB, the process had {:.2} GB",
            wave.seconds,
            wave.steps,
            wave.time_step,
            wave.ns(),
            wave.bonds,
            wave.ns() * 1e-9 * wave.bonds as f64 * 1e4 / 3600.0,
            wave.bytes as f64 / 1e9,
            wave.peak.unwrap_or(0) as f64 / 1e9
        ),
        wave.bytes < 2_000_000_000,
    );
    Ok(found)
}
