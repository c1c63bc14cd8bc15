//! A block of a fibre composite in three dimensions, coarsened 3 and 9 times.

use peridyne::spec::LinearBody;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::lattice::LatticeBlock;
use peridyne_theory::coarsen::{Options, Radius, Scheme};

use crate::silling2010::compare::{Levels, costs};
use crate::{Context, Failure, Findings};

experiment!(
    BeyondBlock,
    "beyond-block",
    "A fibre composite in three dimensions",
    ["../compare.rs"]
);

/// Fibres along z of radius 2, 6 apart, ten times as stiff; bonds up to √3 spacings.
fn fibres(side: usize) -> LinearBody<3> {
    let in_fibre = |[x, y, _]: [i64; 3]| {
        let off = |x: i64| (x - 3).rem_euclid(6).min((3 - x).rem_euclid(6));
        off(x).pow(2) + off(y).pow(2) <= 4
    };
    LatticeBlock::new([side + 1; 3], 1.0, 1.75).body(
        |_| true,
        |i, n| {
            let j = [i[0] + n[0], i[1] + n[1], i[2] + n[2]];
            let stiff = if in_fibre(i) && in_fibre(j) {
                10.0
            } else {
                1.0
            };
            stiff / (n.iter().map(|n| n * n).sum::<i64>() as f64).sqrt()
        },
    )
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let (side, times) = if context.small { (9, 1) } else { (18, 2) };
    let options = Options {
        scheme: Scheme::Energy,
        radius: Radius::Tolerance(if context.small { 0.1 } else { 0.01 }),
        ..Options::default()
    };
    let levels = Levels::thirds(fibres(side), times, &options)?;
    let pulled = levels.pulled(0.01)?;
    let mut table: [Vec<f64>; 4] = Default::default();
    let mut said = vec![];
    let mut close = true;
    for m in 1..=times {
        let (error, report) = (levels.error(&pulled, m), &levels.report[m - 1]);
        said.push(format!(
            "coarsened {}: {:.2} %, r = {:.1}, {} balls",
            3i32.pow(m as u32),
            100.0 * error,
            report.radius,
            report.work.solved
        ));
        close &= error < 0.02 && report.soundness.rotation < 1e-10 && report.definite;
        let row = [
            m as f64,
            levels.body[m].points() as f64,
            report.radius,
            error,
        ];
        table
            .iter_mut()
            .zip(row)
            .for_each(|(column, x)| column.push(x));
    }
    found.holds("displacement", said.join("; "), close);
    found.measured(
        "solution at each level (section 6 prints 81^M for dense elimination; (3³)³ is 19683 per level)",
        costs(&levels, &pulled),
        "",
    );
    let path = context.out.join("block.csv");
    let mut csv = Table::new();
    for (name, column) in ["level", "points", "r", "error"].into_iter().zip(table) {
        csv = csv.column(name, "", column);
    }
    csv.save(&path)?;
    found.file(path);
    Ok(found)
}
