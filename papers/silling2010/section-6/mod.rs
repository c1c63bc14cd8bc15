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
            solving[level][s] = begin.elapsed().as_secs_f64();
            nodes[level][s] = body.points() as f64;
        }
    }
    let last = sizes.len() - 1;
    found.number("elimination", exponent(&nodes[0], &products[0]));
    found.number("making", exponent(&nodes[0], &effort[0]));
    found.number("making-2", exponent(&nodes[1], &effort[1]));
    if !context.small {
        found.number("gain", products[0][last] / products[2][last]);
    }
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
