//! Fig. 6 with the paper's 10,000 steps, in parts of 500 that are kept.

use crate::seleson2014::cube::Cube;
use crate::{Context, Failure, Findings};

experiment!(
    Figure6PaperStep,
    "figure-6-paper-step",
    "The cube of Fig. 6 with the paper's time step",
    ["../cube.rs", "../figure-6/cube.toml", "../../checkpoint.rs"],
    Hours
);

fn run(context: &Context) -> Result<Findings, Failure> {
    // of the small variant, steps are longer: 20 points across leave little between the wave and the grid
    let (points, steps, longer, part) = match context.small {
        true => (20, 300, 3, 100),
        false => (200, 10_000, 100, 500),
    };
    let wave = Cube {
        points,
        steps,
        part,
    };
    let wave = wave.run(context)?;
    let near = Cube {
        points,
        steps: steps / longer,
        part: 0,
    };
    let near = near.run(context)?;
    let mut found = Findings::new();
    wave.pictures(&context.out, &mut found)?;
    wave.judge(&mut found);
    let d = near.difference(&wave);
    found.holds(
        "step",
        format!(
            "{} and {} steps: displacements differ by {:.3} %",
            wave.steps,
            near.steps,
            100.0 * d
        ),
        d < 0.03,
    );
    Ok(found)
}
