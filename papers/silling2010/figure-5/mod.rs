//! Fig. 5 (example 2): a bar of hard and soft stripes under end load, at three levels.

use peridyne::spec::LinearBody;
use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;
use peridyne_theory::coarsen::lattice::LatticeBlock;

use super::bar::{Level, Nodes, REACH, STRIPE, V, Way, levels, striped};
use super::compare::{equilibrium, failed, off_deck};
use crate::{Context, Failure, Findings};

experiment!(
    Figure5,
    "figure-5",
    "Bar with periodic microstructure",
    [
        "../bar.rs",
        "../compare.rs",
        "../../gallery/bench.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");

const B: f64 = 0.001;

/// The three leftmost nodes of level 2 held, b on the three rightmost, the same nodes at every level.
fn pulled(level: &Level, ends: &Level) -> Result<Vec<f64>, Failure> {
    let n = ends.node.len();
    let at = |k: usize| {
        let found = level.node.iter().position(|node| *node == ends.node[k]);
        found.ok_or_else(|| failed("a node of level 2 is in every level"))
    };
    let held = (0..3)
        .map(|k| Ok((at(k)?, [0.0])))
        .collect::<Result<Vec<_>, Failure>>()?;
    let load = (n - 3..n)
        .map(|k| Ok((at(k)?, [B])))
        .collect::<Result<Vec<_>, Failure>>()?;
    let u = equilibrium(&level.body, &held, &load)?;
    Ok(u.into_iter().map(|u| u[0]).collect())
}

/// Displacements at the nodes of level 2.
fn common(level: &Level, ends: &Level, u: &[f64]) -> Vec<f64> {
    let at = |node: &usize| level.node.iter().position(|k| k == node);
    ends.node
        .iter()
        .filter_map(|node| Some(u[at(node)?]))
        .collect()
}

/// Stress 3 b v over the strain between two nodes of level 2 that are four stripes apart, in the middle of the bar.
fn measured(ends: &Level, u: &[f64]) -> f64 {
    let first = ends.node.iter().position(|k| *k >= 72).unwrap_or(0);
    let strain = (u[first + 5] - u[first]) / (40.0 * V);
    3.0 * B * V / strain
}

/// The effective modulus of the infinite bar: the energy of one period under unit mean strain, least over the displacements within
/// (erratum 7).
fn period() -> Result<f64, Failure> {
    let cells = LatticeBlock::new([4 * STRIPE as usize], V, REACH as f64).periodic();
    let wrapped = |i: i64| i.rem_euclid(2 * STRIPE);
    let c = |i: i64, n: i64| V * striped(wrapped(i), wrapped(i + n));
    let cell: LinearBody<1> = cells.body(|_| true, |[i], [n]| c(i, n));
    let row = |i: i64| {
        (-REACH..=REACH)
            .filter(|n| *n != 0)
            .map(move |n| (n, c(i, n)))
    };
    let size = 4 * STRIPE;
    // forces of unit strain, and half their work
    let mut load = vec![];
    let mut energy = 0.0;
    for i in 0..size {
        let xi = |n: i64| n as f64 * V;
        load.push((i as usize, [row(i).map(|(n, c)| c * xi(n)).sum::<f64>()]));
        energy += row(i).map(|(n, c)| 0.25 * c * xi(n).powi(2)).sum::<f64>();
    }
    let u = equilibrium(&cell, &[(0, [0.0])], &load)?;
    let relaxed: f64 = u.iter().zip(&load).map(|(u, f)| 0.5 * u[0] * f.1[0]).sum();
    Ok(2.0 * (energy - relaxed) / size as f64)
}

/// Mean compliance of the two stripes' own moduli: what a local bar would have.
fn series() -> f64 {
    let sum: f64 = (1..=REACH).map(|n| (n as f64 * V).powi(2)).sum();
    let (hard, soft) = (10.0 * V * sum, V * sum);
    2.0 / (1.0 / hard + 1.0 / soft)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let exact = period()?;
    let mut said = vec![];
    let mut same = true;
    let mut moduli = vec![];
    for nodes in Nodes::ALL {
        let made = levels(nodes.bar(striped), [4, 2], Way::Published)?;
        let (mut plot, mut compared) = (
            Plot::new(format!("u, nodes {}", nodes.name()))
                .x("x", "")
                .y("u", ""),
            vec![],
        );
        for (m, level) in made.iter().enumerate() {
            let u = pulled(level, &made[2])?;
            let path = context.out.join(format!("{}-u{m}.csv", nodes.name()));
            Table::new()
                .column("x", "", level.x())
                .column("u", "", u.clone())
                .save(&path)?;
            found.file(path);
            plot = match m {
                0 => plot.line("level 0", &level.x(), &u),
                1 => plot.dashed("level 1", &level.x(), &u),
                _ => plot.points("level 2", &level.x(), &u),
            };
            compared.push(common(level, &made[2], &u));
        }
        found.picture(plot.save(&context.out, &format!("{}-u", nodes.name()))?);
        // stretch: the last node of level 2
        let stretch: Vec<f64> = compared.iter().filter_map(|u| u.last().copied()).collect();
        let off: Vec<f64> = stretch.iter().map(|s| s / stretch[0] - 1.0).collect();
        same &= off.iter().all(|x| x.abs() < 0.03);
        said.push(format!(
            "{}: u of the last node {:.4e}, {:+.2} % at level 1, {:+.2} % at level 2",
            nodes.name(),
            stretch[0],
            100.0 * off[1],
            100.0 * off[2]
        ));
        if nodes == Nodes::Centred {
            let u = pulled(&made[0], &made[2])?;
            off_deck(DECK, &made[0].body, &u, &mut found)?;
            moduli = compared.iter().map(|u| measured(&made[2], u)).collect();
            let slopes = |m: usize| {
                let (x, u) = (made[m].x(), pulled(&made[m], &made[2])?);
                let step = |k: usize| (u[k + 1] - u[k]) / (x[k + 1] - x[k]);
                let middle = (0..x.len() - 1)
                    .filter(|k| (0.3..0.7).contains(&x[*k]))
                    .map(step);
                let (low, high) =
                    middle.fold((f64::MAX, f64::MIN), |(a, b), s| (a.min(s), b.max(s)));
                Ok::<f64, Failure>(high / low)
            };
            let ratio = [slopes(0)?, slopes(1)?, slopes(2)?];
            found.holds(
                "detail",
                format!("largest over smallest slope in the middle: {:.2}, {:.2}, {:.2} at levels 0, 1, 2", ratio[0], ratio[1], ratio[2]),
                ratio[0] > ratio[1] && ratio[1] > ratio[2],
            );
            // from the energy, and exactly
            for (key, way) in [
                ("modulus-energy", Way::Energy),
                ("modulus-exact", Way::Exact),
            ] {
                let made = levels(nodes.bar(striped), [4, 2], way)?;
                let u = pulled(&made[2], &made[2])?;
                let of = match way {
                    Way::Exact => moduli[0],
                    Way::Energy | Way::Published => exact,
                };
                found.number(key, measured(&made[2], &u) / of);
            }
        }
    }
    found.holds("stretch", said.join("; "), same);
    for (m, key) in ["modulus-0", "modulus-1", "modulus-2"].iter().enumerate() {
        found.number(key, moduli[m] / exact);
    }
    found.number("series", series() / exact);
    Ok(found)
}
