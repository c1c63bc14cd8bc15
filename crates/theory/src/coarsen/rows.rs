//! Row by row, as published: each coarse row is that of the free ball about its point (silling2010, (3)–(11)).
//!
//! A load b on the removed points of a ball adds `xᵀ b` to its row, x the adjoint displacements: the condensed load. Balls that cut
//! bonds give back less than they get, so that each point's shares are scaled to carry all of its force.

use super::ball::Beyond;
use super::balls::{Eliminated, Task};
use super::block::{Block, add, inverse, product, transposed, unit, zero};
use super::coupling::Coupling;
use super::error::CoarsenError;
use super::shapes::Shapes;

pub(super) fn rows<const D: usize>(
    task: &Task<D>,
    radius: f64,
) -> Result<Eliminated<D>, CoarsenError> {
    let balls = task.balls(radius, Beyond::Free)?;
    let rows = task.each(|scratch, k| {
        let walk = task.walk(k, radius, scratch);
        let solved = &balls.solved[balls.class[k]];
        // the centre itself never acts
        let row: Vec<(u32, Block<D>)> = (walk.rim[1..].iter().copied())
            .zip(solved.row[1..].iter().copied())
            .collect();
        let loads: Vec<(u32, Block<D>)> = (walk.removed.iter().copied())
            .zip(solved.adjoint.iter().copied())
            .filter(|(e, _)| task.shaped || task.loaded[*e as usize])
            .collect();
        (row, loads)
    });
    let mut pass = task.kept();
    let mut coarse = vec![];
    for (k, (row, loads)) in (0..).zip(rows) {
        coarse.push(row);
        for (e, x) in loads {
            pass[e as usize].push((k, x));
        }
    }
    for (e, row) in pass.iter_mut().enumerate() {
        if !(task.shaped || task.loaded[e]) || task.marked[e] {
            continue;
        }
        let mut sum = zero();
        row.iter().for_each(|(_, x)| add(&mut sum, x));
        let all = inverse(&sum).ok_or(CoarsenError::Uncovered { point: e, radius })?;
        for (_, x) in row {
            *x = product(x, &all);
        }
    }
    // what carries the force of a point moves it
    let shapes = task.shaped.then(|| {
        let rows = pass.iter().map(|row| {
            row.iter()
                .map(|(k, x)| (*k, transposed(x)))
                .collect::<Vec<_>>()
        });
        let mut shapes = Shapes {
            rows: rows.collect(),
        };
        for (k, &q) in (0..).zip(task.retained) {
            shapes.rows[q as usize] = vec![(k, unit())];
        }
        shapes
    });
    for (e, row) in pass.iter_mut().enumerate() {
        if !task.loaded[e] {
            row.clear();
        }
    }
    Ok(Eliminated {
        coupling: Coupling::new(task.retained, coarse),
        work: balls.work,
        pass,
        shapes,
    })
}
