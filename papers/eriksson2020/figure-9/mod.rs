//! Fig. 9: strain energy density of each point of homogenized bars.

use peridyne_io::write::plot::{Mark, Plot, Stroke};
use peridyne_io::write::table::Table;
use peridyne_theory::exact::{Field, Q, q};
use peridyne_theory::homogenize::bar::Ends;

use super::bar;
use crate::{Context, Failure, Findings};

experiment!(
    Figure9,
    "figure-9",
    "Strain energy density of the points of homogenized bars",
    []
);

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut plot = Plot::new("Homogenized, full-weight ends, N = 2m + 1")
        .x("point", "")
        .y("Σ cξV", "")
        .x_range(0.5, 9.5)
        .y_range(0.0, 24.0);
    let mut table = Table::new().column("point", "", (1..=9).map(f64::from));
    let mut whole = true;
    for (m, mark) in [(2, Mark::Disc), (3, Mark::Square), (4, Mark::Triangle)] {
        let points = 2 * m + 1;
        let bar = bar(m, points, Ends::Full, true)?;
        let energies = bar.energy(&bar.strains::<Q>());
        let half: Vec<String> = energies[..=m].iter().map(Q::to_string).collect();
        found.text(&format!("energies-{m}"), half.join(" "));
        let sum = energies.iter().fold(q(0, 1), |s, w| s + w);
        whole &= sum == q((m * m * (points - 1)) as i64, 1);
        let x: Vec<f64> = (1..=points).map(|i| i as f64).collect();
        let y: Vec<f64> = energies.iter().map(Field::value).collect();
        plot = plot.series(&format!("δ = {m}Δ"), &x, &y, Stroke::Dashed, mark);
        table = table.column(
            &format!("δ = {m}Δ"),
            "",
            [y, vec![f64::NAN; 9 - points]].concat(),
        );
    }
    found.picture(plot.save(&context.out, "energy")?);
    let path = context.out.join("energy.csv");
    table.save(&path)?;
    found.file(path);
    found.holds(
        "whole",
        "the sum over all points is m²(N−1) in fractions: the work of the loads",
        whole,
    );
    Ok(found)
}
