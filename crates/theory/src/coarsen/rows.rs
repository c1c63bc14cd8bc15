//! Row by row, as published: each coarse row is that of the free ball about its point (silling2010, (3)–(11)).

use super::ball::Beyond;
use super::balls::{Task, Work};
use super::coupling::Coupling;
use super::error::CoarsenError;

pub(super) fn rows<const D: usize>(
    task: &Task<D>,
    radius: f64,
) -> Result<(Coupling<D>, Work), CoarsenError> {
    let balls = task.balls(radius, Beyond::Free)?;
    let rows = task.each(|scratch, k| {
        let walk = task.walk(k, radius, scratch);
        let row = &balls.solved[balls.class[k]].row;
        // the centre itself never acts
        walk.rim[1..]
            .iter()
            .copied()
            .zip(row[1..].iter().copied())
            .collect()
    });
    Ok((Coupling::new(task.retained, rows), balls.work))
}
