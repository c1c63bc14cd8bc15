//! Fig. 5: radial displacements along the x axis at the final time, and energies over time.

use crate::measure::largest;
use crate::seleson2014::conserved;
use crate::seleson2014::plate::{self, Wave, curves};
use crate::{Context, Failure, Findings};

experiment!(
    Figure5,
    "figure-5",
    "Radial displacements and energies of the plate",
    ["../plate.rs", "../figure-4/plate.toml"],
    Minutes
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let waves = plate::waves(context)?;
    let mut found = Findings::new();
    curves(&context.out, &waves, &mut found)?;
    conserved(waves.iter().map(|w| &w.record), &mut found);
    compare(&waves, &mut found);
    Ok(found)
}

/// The claims `radial` and `preserved`: all meshes against the finest.
pub fn compare(waves: &[Wave], found: &mut Findings) {
    let heights: Vec<f64> = waves.iter().map(|w| w.crest()[1]).collect();
    let worst = largest(heights.iter().map(|h| (h / heights[0] - 1.0).abs()));
    found.holds(
        "radial",
        format!(
            "the largest is {:.4e} m at h = a, others within {:.2} %",
            heights[0],
            100.0 * worst
        ),
        worst < 0.1,
    );
    let last = |w: &Wave| {
        w.record
            .rows
            .last()
            .map_or([f64::NAN; 2], |r| [r.kinetic, r.strain])
    };
    let reference = waves.first().map_or([f64::NAN; 2], last);
    let spread = |k: usize| {
        let all = waves
            .iter()
            .map(|w| (last(w)[k] / reference[k] - 1.0).abs());
        100.0 * largest(all)
    };
    let [kinetic, strain] = [spread(0), spread(1)];
    found.holds(
        "preserved",
        format!("at T: kinetic energy within {kinetic:.1} %, strain energy within {strain:.1} %"),
        kinetic < 10.0 && strain < 10.0,
    );
}
