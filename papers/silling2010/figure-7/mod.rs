//! Fig. 7 (example 3): a homogeneous bar with a weak place, at three levels.

use peridyne_io::write::plot::Plot;
use peridyne_io::write::table::Table;

use super::bar::{LENGTH, Level, Nodes, Way, levels, tent};
use super::compare::{equilibrium, failed, off_deck};
use crate::{Context, Failure, Findings};

experiment!(
    Figure7,
    "figure-7",
    "Bar with a defect",
    [
        "../bar.rs",
        "../compare.rs",
        "../../gallery/bench.rs",
        "deck.toml"
    ]
);

const DECK: &str = include_str!("deck.toml");

/// 0.1 of the tent for bonds that cross or touch the middle.
fn weak(nodes: Nodes, i: i64, j: i64) -> f64 {
    let (low, high) = (nodes.twice(i.min(j)), nodes.twice(i.max(j)));
    let crosses = low <= LENGTH && LENGTH <= high;
    tent(i, j) * if crosses { 0.1 } else { 1.0 }
}

/// u = x at the three leftmost and rightmost nodes of level 2.
fn stretched(level: &Level, ends: &Level) -> Result<Vec<f64>, Failure> {
    let n = ends.node.len();
    let held = (0..3).chain(n - 3..n).map(|k| {
        let found = level.node.iter().position(|node| *node == ends.node[k]);
        let i = found.ok_or_else(|| failed("a node of level 2 is in every level"))?;
        Ok((i, level.body.position[i]))
    });
    let u = equilibrium(
        &level.body,
        &held.collect::<Result<Vec<_>, Failure>>()?,
        &[],
    )?;
    Ok(u.into_iter().map(|u| u[0]).collect())
}

/// Largest difference from level 0 at the nodes of a level.
fn off(level: &Level, u: &[f64], fine: &[f64]) -> f64 {
    let each = level.node.iter().zip(u).map(|(k, u)| (u - fine[*k]).abs());
    each.fold(0.0, f64::max)
}

fn run(context: &Context) -> Result<Findings, Failure> {
    let mut found = Findings::new();
    let mut worst = vec![];
    for nodes in Nodes::ALL {
        let bar = || nodes.bar(|i, j| weak(nodes, i, j));
        let made = levels(bar(), [3, 3], Way::Published)?;
        if nodes == Nodes::Centred {
            let u = stretched(&made[0], &made[2])?;
            off_deck(DECK, &made[0].body, &u, &mut found)?;
        }
        let (mut plot, mut us) = (
            Plot::new(format!("u near the defect, nodes {}", nodes.name()))
                .x("x", "")
                .y("u", "")
                .x_range(0.35, 0.65)
                .y_range(0.1, 0.9),
            vec![],
        );
        for (m, level) in made.iter().enumerate() {
            let u = stretched(level, &made[2])?;
            let x = level.x();
            let path = context.out.join(format!("{}-u{m}.csv", nodes.name()));
            Table::new()
                .column("x", "", x.clone())
                .column("u", "", u.clone())
                .save(&path)?;
            found.file(path);
            plot = match m {
                0 => plot.line("level 0", &x, &u),
                1 => plot.dashed("level 1", &x, &u),
                _ => plot.points("level 2", &x, &u),
            };
            us.push(u);
        }
        found.picture(plot.save(&context.out, &format!("{}-u", nodes.name()))?);
        worst.push([off(&made[1], &us[1], &us[0]), off(&made[2], &us[2], &us[0])]);
        if nodes == Nodes::Centred {
            // across the widest step of each level
            let jumps: Vec<f64> = us
                .iter()
                .map(|u| u.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max))
                .collect();
            found.holds(
                "jump",
                format!(
                    "largest difference of neighbours: {:.3}, {:.3}, {:.3}",
                    jumps[0], jumps[1], jumps[2]
                ),
                jumps[0] < jumps[1] && jumps[1] < jumps[2],
            );
            let exact = levels(bar(), [3, 3], Way::Exact)?;
            let u = stretched(&exact[2], &exact[2])?;
            found.number("exact", off(&exact[2], &u, &us[0]));
            let energy = levels(bar(), [3, 3], Way::Energy)?;
            let u = stretched(&energy[2], &energy[2])?;
            found.number("energy", off(&energy[2], &u, &us[0]));
        }
    }
    let limit = 0.01;
    found.holds(
        "identical",
        format!(
            "largest difference from level 0, of u from 0 to 1: centred {:.1e}, {:.1e}; on borders {:.1e}, {:.1e}",
            worst[0][0], worst[0][1], worst[1][0], worst[1][1]
        ),
        worst.iter().flatten().all(|x| *x < limit),
    );
    Ok(found)
}
