//! Example 1 (Fig. 4 and the coarse curves): the micromoduli of levels 1 and 2 of a homogeneous bar.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::exact::{Network, modulus as exact_modulus};
use peridyne_theory::coarsen::{Scheme, coarsen};
use peridyne_theory::exact::{Field, Q, q};

use super::bar::{LENGTH, Level, Nodes, RADII, V, Way, levels, modulus, options, tent};
use super::compare::{equilibrium, failed, off_deck};
use crate::{Context, Failure, Findings};

experiment!(
    Figure4,
    "figure-4",
    "Coarsened micromoduli of a homogeneous bar",
    [
        "../bar.rs",
        "../compare.rs",
        "../../gallery/bench.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");

/// Nodes of a level per node of the one before.
const EVERY: [u32; 2] = [4, 2];

/// `(q − x, C)` of the node nearest to the middle, C = C_ij/v, over all nodes of level 0 within `wide` v: 0 where none is retained.
fn curve(level: &Level, wide: i64) -> (Vec<f64>, Vec<f64>) {
    let i = level.body.points() / 2;
    let (partners, blocks) = level.body.row(i);
    let centre = level.node[i] as i64;
    (-wide..=wide)
        .map(|n| {
            let j = partners
                .iter()
                .position(|j| level.node[*j as usize] as i64 == centre + n);
            (n as f64 * V, j.map_or(0.0, |j| blocks[j][0][0] / V))
        })
        .unzip()
}

/// Nodes on lines, one per level.
fn scheme(context: &Context, levels: &[Level; 3], found: &mut Findings) -> Result<(), Failure> {
    let mut plot = Plot::new("nodes of levels 0, 1, 2 (first 49 of level 0)")
        .x("x/v", "")
        .y("level", "")
        .y_range(-0.5, 3.5);
    for (m, level) in levels.iter().enumerate() {
        let x: Vec<f64> = level
            .node
            .iter()
            .filter(|k| **k <= 48)
            .map(|k| *k as f64 + 0.5)
            .collect();
        plot = plot.points(&format!("level {m}"), &x, &vec![m as f64; x.len()]);
    }
    found.picture(plot.save(&context.out, "levels")?);
    Ok(())
}

/// How the modulus of level 1, and its largest C, come to rest as r1 grows; by rows and by energy.
fn convergence(context: &Context, found: &mut Findings) -> Result<(), Failure> {
    let fine = Nodes::Centred.bar(tent);
    let keep: Vec<u32> = (0..LENGTH as u32).step_by(EVERY[0] as usize).collect();
    let whole = modulus(&fine, 1.0);
    let radii: Vec<i64> = if context.small {
        vec![20, 40, 60]
    } else {
        (10..=90).step_by(2).collect()
    };
    let mut error = [vec![], vec![]];
    let mut peak = vec![];
    for &radius in &radii {
        for (scheme, error) in [Scheme::Rows, Scheme::Energy].into_iter().zip(&mut error) {
            let (body, _) = coarsen(&fine, &keep, &options(scheme, radius)).map_err(failed)?;
            error.push((modulus(&body, 4.0) / whole - 1.0).abs().max(1e-16));
            if scheme == Scheme::Rows {
                let i = body.points() / 2;
                peak.push(body.micromodulus(i, i + 1).map_or(0.0, |c| c[0][0] / V));
            }
        }
    }
    let r: Vec<f64> = radii.iter().map(|r| *r as f64).collect();
    let last = peak.last().copied().unwrap_or(0.0);
    let off: Vec<f64> = peak
        .iter()
        .map(|p| (p / last - 1.0).abs().max(1e-16))
        .collect();
    let cut = radii.len() - 1;
    let plot = Plot::new("level 1 as r1 grows")
        .x("r1/v", "")
        .y("relative error", "")
        .log_y()
        .line("modulus, rows as published", &r, &error[0])
        .line("modulus, from the energy", &r, &error[1])
        .dashed("largest C1, rows", &r[..cut], &off[..cut]);
    found.picture(plot.save(&context.out, "convergence")?);
    let path = context.out.join("convergence.csv");
    Table::new()
        .column("r1/v", "", r)
        .column("error of modulus, rows", "", error[0].clone())
        .column("error of modulus, energy", "", error[1].clone())
        .column("largest C1", "", peak.clone())
        .save(&path)?;
    found.file(path);
    let at = |r: i64| radii.iter().position(|x| *x == r).unwrap_or(0);
    let (rows, energy) = (&error[0], &error[1]);
    found.holds(
        "no-effect",
        format!(
            "from r1 = 40 v to 60 v the largest C1 changes by {:.1e}; the modulus by {:.1e}",
            (peak[at(60)] / peak[at(40)] - 1.0).abs(),
            rows[at(40)] - rows[at(60)]
        ),
        (peak[at(60)] / peak[at(40)] - 1.0).abs() < 2e-3,
    );
    found.holds(
        "energy",
        format!(
            "at r1 = 20 v the modulus is off by {:.1e} by rows, {:.1e} from the energy",
            rows[at(20)],
            energy[at(20)]
        ),
        energy[at(20)] < 0.01 * rows[at(20)],
    );
    Ok(())
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let made = levels(Nodes::Centred.bar(tent), EVERY, Way::Published)?;
    let last = made[0].body.points() - 1;
    let pulled = equilibrium(&made[0].body, &[(0, [0.0]), (last, [0.01])], &[])?;
    off_deck(DECK, &made[0].body, &pulled.concat(), &mut found)?;
    scheme(context, &made, &mut found)?;
    let mut plot = Plot::new("coarsened micromoduli").x("q − x", "").y("C", "");
    let mut table = Table::new();
    let curves = [
        curve(&made[0], 90),
        curve(&made[1], 90),
        curve(&made[2], 90),
    ];
    for (m, (x, c)) in curves.iter().enumerate() {
        plot = plot.line(&format!("C{m}"), x, c);
        if m == 0 {
            table = table.column("q-x", "", x.clone());
        }
        table = table.column(&format!("C{m}"), "", c.clone());
    }
    found.picture(plot.save(&context.out, "c1-c2")?);
    let path = context.out.join("c1-c2.csv");
    table.save(&path)?;
    found.file(path);

    let sharp = |curve: &(Vec<f64>, Vec<f64>), k: usize| {
        let zero = curve.1.len() / 2;
        (0..curve.1.len()).all(|n| n.abs_diff(zero).is_multiple_of(k) || curve.1[n] == 0.0)
    };
    found.holds(
        "peaks",
        format!(
            "largest values {:.4} at 4 v and {:.4} at 8 v, 0 between retained nodes",
            curves[1].1[94], curves[2].1[98]
        ),
        sharp(&curves[1], 4)
            && sharp(&curves[2], 8)
            && curves[1].1[94] > 0.0
            && curves[2].1[98] > 0.0,
    );
    // as fractions
    let springs: Vec<Q> = (1..10).map(|j| q(10 - j, 10)).collect();
    let network = Network::chain(2 * RADII[0] as usize + 1, &springs);
    let retained: Vec<usize> = (0..=2 * RADII[0] as usize).step_by(4).collect();
    let row = network
        .ball_row(RADII[0] as usize, RADII[0] as usize, &retained)
        .ok_or_else(|| Failure::new("a removed point of the chain is held by nothing"))?;
    let ratio = exact_modulus(RADII[0] as usize, &row) / q(4 * 165, 2);
    found.number("modulus-1", ratio.value());
    found.number(
        "modulus-1-f64",
        modulus(&made[1].body, 4.0) / modulus(&made[0].body, 1.0) / ratio.value(),
    );
    // the row of a bar without ends is the same everywhere: springs of level 1
    let middle = row.iter().position(|(q, _)| *q > RADII[0] as usize);
    let springs: Vec<Q> = (row[middle.unwrap_or(0)..].iter().map(|(_, c)| c.clone())).collect();
    let radius = RADII[1] as usize / EVERY[0] as usize;
    let network = Network::chain(2 * radius + 1, &springs);
    let retained: Vec<usize> = (0..=2 * radius).step_by(EVERY[1] as usize).collect();
    let row = network
        .ball_row(radius, radius, &retained)
        .ok_or_else(|| Failure::new("a removed point of level 1 is held by nothing"))?;
    // lengths in 4 v, and a node stands for eight
    let ratio = exact_modulus(radius, &row) * q(16, 1) / q(8 * 165, 2);
    found.number("modulus-2", ratio.value());
    found.measured(
        "modulus of level 2 in the middle of the bar of the figure, over level 0",
        modulus(&made[2].body, 8.0) / modulus(&made[0].body, 1.0),
        "",
    );
    let exact = levels(Nodes::Centred.bar(tent), EVERY, Way::Exact)?;
    let one = levels(Nodes::Centred.bar(tent), [8, 1], Way::Exact)?;
    let off = (exact[2].body.block.iter().zip(&one[1].body.block))
        .map(|(a, b)| (a[0][0] - b[0][0]).abs())
        .fold(0.0, f64::max);
    found.number("two-steps", off / one[1].body.block[0][0][0].abs());
    convergence(context, &mut found)?;
    Ok(found)
}
