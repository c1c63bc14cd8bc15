//! Fig. 3: the micromodulus of level 0.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::bar::{Nodes, REACH, V, modulus, tent};
use crate::{Context, Failure, Findings};

experiment!(
    Figure3,
    "figure-3",
    "Tent-shaped micromodulus",
    ["../bar.rs"]
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (xi, c): (Vec<f64>, Vec<f64>) = (-12i64..=12)
        .map(|n| {
            let c = if n == 0 || n.abs() > REACH {
                0.0
            } else {
                tent(0, n)
            };
            (n as f64 * V, c)
        })
        .unzip();
    let r0 = 10.0 * V;
    let plot = Plot::new("micromodulus of level 0")
        .x("q − x", "")
        .y("C0", "")
        .dashed(
            "C0(x, q)",
            &[-1.2 * r0, -r0, 0.0, r0, 1.2 * r0],
            &[0.0, 0.0, 1.0, 0.0, 0.0],
        )
        .points("nodes", &xi, &c);
    found.picture(plot.save(&context.out, "c0")?);
    let path = context.out.join("c0.csv");
    Table::new()
        .column("q-x", "", xi)
        .column("C0", "", c)
        .save(&path)?;
    found.file(path);
    let bar = Nodes::Centred.bar(tent);
    found.number("bonds", bar.row(100).0.len() as f64);
    // ∫₀^r0 (1 − ξ/r0) ξ² dξ = r0³/12, by the nodes
    found.number("modulus", modulus(&bar, 1.0) / (r0.powi(3) / 12.0));
    Ok(found)
}
