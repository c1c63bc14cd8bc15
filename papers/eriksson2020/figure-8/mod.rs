//! Fig. 8: the bar of Fig. 7c in full.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::rod::{Length, Motion, sizes};
use crate::{Context, Failure, Findings};

experiment!(
    Figure8,
    "figure-8",
    "Longitudinally vibrating bar, δ = 3Δ, in full",
    ["../rod.rs"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let [points, steps] = sizes(context);
    let motion = Motion::new(3, [points, steps], Length::Counted)?;
    let step: Vec<f64> = (0..=steps).map(|n| n as f64).collect();
    let milli = |u: &[f64]| u.iter().map(|u| u * 1e3).collect::<Vec<f64>>();
    let plot = Plot::new(format!("u of the middle, δ = 3Δ, N = {points}"))
        .x("step", "")
        .y("u", "mm")
        .y_range(-0.7, 1.2)
        .line("classical (73)", &step, &milli(&motion.classical))
        .line("not homogenized", &step, &milli(&motion.u[0]))
        .dashed("homogenized", &step, &milli(&motion.u[1]));
    found.picture(plot.save(&context.out, "middle")?);
    let off = |k: usize| {
        let pairs = motion.u[k].iter().zip(&motion.classical);
        pairs
            .map(|(a, b)| (a - b).abs() * 1e3)
            .collect::<Vec<f64>>()
    };
    let plot = Plot::new("Difference from the classical bar")
        .x("step", "")
        .y("|u − u0|", "mm")
        .line("not homogenized", &step, &off(0))
        .line("homogenized", &step, &off(1));
    found.picture(plot.save(&context.out, "difference")?);
    let path = context.out.join("errors.csv");
    let [plain, homogenized] = [0, 1].map(|k| motion.error(k));
    Table::new()
        .text("bar", ["not homogenized", "homogenized"])
        .column(
            "root mean square error over that of u0",
            "",
            [plain, homogenized],
        )
        .save(&path)?;
    found.file(path);
    found.holds(
        "resembles",
        format!(
            "root mean square error over that of (73): {plain:.4}, homogenized {homogenized:.4}"
        ),
        homogenized < plain && homogenized < if context.small { 0.2 } else { 0.03 },
    );
    Ok(found)
}
