//! The coarsened micromoduli as sums over nodes: two springs in series.

use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::lattice::LatticeBlock;
use peridyne_theory::coarsen::{Scheme, Selection, coarsen};

use super::bar::{V, options};
use super::compare::failed;
use crate::{Context, Failure, Findings};

experiment!(
    Equations,
    "equations",
    "Coarsened micromoduli of two springs in series",
    ["../bar.rs", "../compare.rs"]
);

/// Force per displacement of an end over that of one spring: nodes 0 and 2 of three are kept.
fn series(v: f64, stiffness: f64) -> Result<f64, Failure> {
    let block = LatticeBlock::<1>::new([3], v, 1.0);
    // C_ij already has the volume of the node that pulls
    let fine = block.body(|_| true, |_, _| v * stiffness);
    let keep = Selection::every(2).choose(&fine).map_err(failed)?;
    let radius = (2.0 * v / V).round() as i64;
    let (coarse, _) = coarsen(&fine, &keep, &options(Scheme::Rows, radius)).map_err(failed)?;
    let (_, blocks) = coarse.row(0);
    Ok(blocks[0][0][0] / (v * stiffness))
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let volumes = [V, 0.01, 0.5];
    let mut of_one = vec![];
    for v in volumes {
        of_one.push(series(v, 1.0 / v)?);
    }
    let worst = of_one.iter().map(|s| (s - 0.5).abs());
    found.number("series", crate::measure::largest(worst));
    let extra = volumes.iter().zip(&of_one).map(|(v, s)| v * s);
    found.holds(
        "volume",
        format!(
            "without another v {of_one:?} of a spring at v = {volumes:?}, with it {:?}",
            extra.collect::<Vec<_>>()
        ),
        of_one.iter().all(|s| (s - of_one[0]).abs() < 1e-14),
    );
    let path = context.out.join("series.csv");
    Table::new()
        .column("v", "", volumes)
        .column("stiffness over that of a spring", "", of_one)
        .save(&path)?;
    found.file(path);
    Ok(found)
}
