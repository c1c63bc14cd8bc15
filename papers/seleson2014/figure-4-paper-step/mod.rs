//! Figs. 4 and 5 with the paper's time steps: 20,000 for h = a, in parts of 500 that are kept.

use crate::seleson2014::plate::{MESHES, Plate, Step, curves, maps};
use crate::seleson2014::{conserved, figure_5};
use crate::{Context, Failure, Findings};

experiment!(
    Figure4PaperStep,
    "figure-4-paper-step",
    "The plate of Figs. 4 and 5 with the paper's time steps",
    [
        "../plate.rs",
        "../figure-4/plate.toml",
        "../../checkpoint.rs"
    ],
    Hours
);

fn run(context: &Context) -> Result<Findings, Failure> {
    // the finer ones take minutes even in the small variant
    let meshes: &[u32] = if context.small { &[4] } else { &MESHES };
    let mut waves = vec![];
    let mut steps = vec![];
    let mut differences = vec![];
    for &mesh in meshes.iter().rev() {
        let wave = Plate::new(context, mesh, Step::Paper).run(context)?;
        let near = Plate::new(context, mesh, Step::Hundred).run(context)?;
        differences.push(near.difference(&wave));
        steps.push(format!(
            "h = {mesh}a: {} and {} steps differ by {:.3} %",
            wave.steps,
            near.steps,
            100.0 * near.difference(&wave)
        ));
        waves.push(wave);
    }
    waves.reverse();
    let mut found = Findings::new();
    maps(&context.out, &waves, &mut found)?;
    curves(&context.out, &waves, &mut found)?;
    conserved(waves.iter().map(|w| &w.record), &mut found);
    found.holds(
        "step",
        steps.join("; "),
        differences.iter().all(|d| *d < 0.02),
    );
    if !context.small {
        figure_5::compare(&waves, &mut found);
        let times = [
            "h = a (paper: 14,564.30 s on 64 cores)",
            "h = 2a (paper: 446.45 s)",
            "h = 4a (paper: 14.48 s)",
        ];
        for (what, wave) in times.into_iter().zip(&waves) {
            found.measured(what, wave.record.seconds, "s");
        }
    }
    Ok(found)
}
