//! Section 6: what elimination costs at each level, and what it costs to make the levels.

use std::time::Instant;

use peridyne::spec::LinearBody;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::lattice::LatticeBlock;
use peridyne_theory::coarsen::{Scheme, Selection, coarsen};

use super::bar::{ENERGY_RADII, REACH, V, options};
use super::compare::failed;
use crate::{Context, Failure, Findings};

experiment!(
    Section6,
    "section-6",
    "Computational cost of coarsening",
    ["../bar.rs", "../compare.rs"]
);

/// A bar of `nodes` no two places of which are alike: every ball is one of its own.
fn unlike(nodes: usize) -> LinearBody<1> {
    let stiff = |i: i64| 1.0 + (i as f64 * 0.618_033_988_749_894_9).fract();
    let block = LatticeBlock::new([nodes], V, REACH as f64);
    block.body(|_| true, |[i], [n]| V * stiff(i) * stiff(i + n))
}

/// Solves for u = x at the three leftmost and rightmost nodes by Gaussian elimination of the full matrix: the multiplications.
fn eliminate(body: &LinearBody<1>) -> u64 {
    let free = 3..body.points() - 3;
    let n = free.len();
    let line = n + 1;
    let mut a = vec![0.0; n * line];
    for i in free.clone() {
        let (partners, blocks) = body.row(i);
        let row = &mut a[(i - 3) * line..][..line];
        for (&j, c) in partners.iter().zip(blocks) {
            let j = j as usize;
            row[i - 3] += c[0][0];
            if free.contains(&j) {
                row[j - 3] -= c[0][0];
            } else {
                row[n] += c[0][0] * body.position[j][0];
            }
        }
    }
    let mut products = 0;
    for k in 0..n {
        let (above, below) = a.split_at_mut((k + 1) * line);
        let pivot = &above[k * line + k..];
        for row in below.chunks_mut(line) {
            let factor = row[k] / pivot[0];
            for (x, p) in row[k..].iter_mut().zip(pivot) {
                *x -= factor * p;
            }
            products += pivot.len() as u64;
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k * line + j] * a[j * line + n]).sum();
        a[k * line + n] = (a[k * line + n] - known) / a[k * line + k];
        products += (n - k) as u64;
    }
    std::hint::black_box(&a);
    products
}

/// Multiplications of [`eliminate`] for so many free nodes: n³/3 + n² and lower.
fn multiplications(free: u64) -> u64 {
    let n = u128::from(free);
    let above = n * (n + 1) * (2 * n + 1) / 6 - n;
    (above + n * (n + 1) / 2) as u64
}

/// What a level of every third point per axis is of a cube's elimination, by the points that are counted on a lattice and many levels
/// below it.
fn cube() -> Result<f64, Failure> {
    let body: LinearBody<3> = LatticeBlock::new([9; 3], 1.0, 1.0).body(|_| true, |_, _| 1.0);
    let keep = Selection::every(3).choose(&body).map_err(failed)?;
    let per_point = (body.points() / keep.len()) as u64;
    let coarse = per_point.pow(3);
    Ok(multiplications(coarse * per_point) as f64 / multiplications(coarse) as f64)
}

/// Slope of log y over log x from the first to the last.
fn exponent(x: &[f64], y: &[f64]) -> f64 {
    let (a, b) = (0, x.len() - 1);
    (y[b] / y[a]).ln() / (x[b] / x[a]).ln()
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let sizes: [usize; 3] = match context.small {
        true => [162, 324, 648],
        false => [648, 1296, 2592],
    };
    // per size: nodes, multiplications and seconds of elimination per level; operations and seconds of making levels 1 and 2
    let mut miscounted = 0.0f64;
    let (mut nodes, mut products, mut solving) = ([[0.0; 3]; 3], [[0.0; 3]; 3], [[0.0; 3]; 3]);
    let (mut effort, mut making) = ([[0.0; 3]; 2], [[0.0; 3]; 2]);
    for (s, &size) in sizes.iter().enumerate() {
        let mut body = unlike(size);
        for level in 0..3 {
            if level > 0 {
                let begin = Instant::now();
                let keep = Selection::every(3).choose(&body).map_err(failed)?;
                let way = options(Scheme::Energy, ENERGY_RADII[level - 1]);
                let (coarse, report) = coarsen(&body, &keep, &way).map_err(failed)?;
                effort[level - 1][s] = report.work.flops;
                making[level - 1][s] = begin.elapsed().as_secs_f64();
                body = coarse;
            }
            let begin = Instant::now();
            products[level][s] = eliminate(&body) as f64;
            let counted = multiplications(body.points() as u64 - 6) as f64;
            miscounted = miscounted.max((products[level][s] - counted).abs());
            solving[level][s] = begin.elapsed().as_secs_f64();
            nodes[level][s] = body.points() as f64;
        }
    }
    let last = sizes.len() - 1;
    found.number("count", miscounted);
    // three nodes are held at each end of every level
    let free = nodes.map(|of| of.map(|n| n - 6.0));
    found.number("elimination", exponent(&free[0], &products[0]));
    for (level, key) in ["making", "making-2"].into_iter().enumerate() {
        // balls reach 16 of the nodes that they are made of; one that is cut off costs something, and not more than a whole one
        let reach = 16.0;
        let whole = nodes[level].map(|n| n - 2.0 * reach);
        let most = (whole[last] / whole[0]).ln() / (nodes[level][last] / nodes[level][0]).ln();
        let found_here = exponent(&nodes[level], &effort[level]);
        found.holds(
            key,
            format!("exponent {found_here:.3}; 1 without ends, at most {most:.3} with them"),
            (1.0..most).contains(&found_here),
        );
    }
    if !context.small {
        let gain = products[0][last] / products[2][last];
        let ends = (free[0][last] / free[2][last]) / (nodes[0][last] / nodes[2][last]);
        found.number("gain", gain / ends.powi(3));
    }
    let cube = cube()?;
    found.number("cube", cube);
    let [first, second] = effort.map(|of| of[last]);
    let l = nodes[0][last] / nodes[1][last];
    found.holds(
        "price",
        format!(
            "making levels 1 and 2 takes {:.4} b K0, the limit for any M is L/(L − 1) = {:.4}",
            1.0 + second / first,
            l / (l - 1.0)
        ),
        first + second < first * l / (l - 1.0),
    );
    let (zero, two) = (solving[0][last], solving[2][last]);
    let made = making[0][last] + making[1][last];
    found.measured(
        "exponent of the time of elimination",
        exponent(&nodes[0], &solving[0]),
        "",
    );
    found.measured(
        "exponent of the time of making level 1",
        exponent(&nodes[0], &making[0]),
        "",
    );
    found.measured("gain of time of elimination at level 2", zero / two, "");
    found.measured(
        "gain with making the levels counted",
        zero / (two + made),
        "",
    );
    let path = context.out.join("cost.csv");
    let flat = |x: &[[f64; 3]]| x.concat();
    let level: Vec<f64> = (0..3).flat_map(|m| [f64::from(m); 3]).collect();
    let zeros = vec![0.0; 3];
    Table::new()
        .column("level", "", level)
        .column("nodes", "", flat(&nodes))
        .column("multiplications of elimination", "", flat(&products))
        .column("time of elimination", "s", flat(&solving))
        .column(
            "operations of making it",
            "",
            [zeros.clone(), flat(&effort)].concat(),
        )
        .column("time of making it", "s", [zeros, flat(&making)].concat())
        .save(&path)?;
    found.file(path);
    let plot = Plot::new("time of elimination, and of making the levels")
        .x("nodes at level 0", "")
        .y("time", "s")
        .log_x()
        .log_y()
        // room for the legend
        .y_range(1e-6, 1e5)
        .line("elimination, level 0", &nodes[0], &solving[0])
        .line("elimination, level 1", &nodes[0], &solving[1])
        .line("elimination, level 2", &nodes[0], &solving[2])
        .dashed("making level 1", &nodes[0], &making[0])
        .dashed("making level 2", &nodes[0], &making[1]);
    found.picture(plot.save(&context.out, "cost")?);
    Ok(found)
}
