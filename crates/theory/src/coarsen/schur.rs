//! The exact elimination of all removed points at once: the reference for every ball and every number of levels.

use super::balls::{Eliminated, Task, Work};
use super::block::{Block, add_product, scaled, transposed, unit, zero};
use super::coupling::Coupling;
use super::error::CoarsenError;
use super::shapes::Shapes;
use super::solve::SYMMETRIC;
use peridyne::error::SolveError;
use peridyne::statics::{Direct, Support};
use rayon::prelude::*;

/// Numbers that the exact elimination may hold: the coarse stiffness is full.
pub const SCHUR_LIMIT: usize = 60_000_000;

pub(super) fn schur<const D: usize>(task: &Task<D>) -> Result<Eliminated<D>, CoarsenError> {
    let (body, retained) = (task.body, task.retained);
    let (n, m) = sizes(task);
    fits(task)?;
    let support = Support {
        free: task.marked.iter().map(|held| [!held; D]).collect(),
    };
    let factors = match Direct::new(body, &support, 0.0) {
        Ok(factors) => Some(factors),
        Err(SolveError::NothingFree) => None,
        Err(SolveError::TooLarge) => {
            return Err(CoarsenError::TooLarge {
                removed: n,
                retained: m,
                limit: SCHUR_LIMIT,
            });
        }
        Err(_) => return Err(CoarsenError::IndefiniteBody),
    };
    // one column of the coarse stiffness after the other: the forces on retained points when one is displaced
    let column = |q: u32| -> Option<(Vec<Block<D>>, Vec<Block<D>>)> {
        let mut displaced = vec![zero::<D>(); body.points()];
        for b in 0..D {
            let mut u = match &factors {
                Some(factors) => factors.solve(&forces(task, q, b)),
                None => vec![[0.0; D]; body.points()],
            };
            u[q as usize][b] = 1.0;
            for (block, u) in displaced.iter_mut().zip(u) {
                for a in 0..D {
                    block[a][b] = u[a];
                }
            }
        }
        let blocks: Vec<Block<D>> = (retained.iter())
            .map(|i| {
                let (partners, blocks) = body.row(*i as usize);
                let mut sum = zero();
                for (j, c) in partners.iter().zip(blocks) {
                    add_product(&mut sum, c, &displaced[*j as usize]);
                }
                scaled(body.volume[*i as usize], &sum)
            })
            .collect();
        let finite = blocks
            .as_flattened()
            .as_flattened()
            .iter()
            .all(|x| x.is_finite());
        let shape = match task.shaped {
            true => displaced,
            false => vec![],
        };
        finite.then_some((blocks, shape))
    };
    let columns: Vec<Option<_>> = retained.par_iter().map(|q| column(*q)).collect();
    let mut rows = vec![Vec::with_capacity(retained.len() - 1); retained.len()];
    let mut shapes = vec![vec![]; body.points()];
    for (q, blocks) in columns.into_iter().enumerate() {
        let (blocks, shape) = blocks.ok_or(CoarsenError::IndefiniteBody)?;
        for (p, s) in shape
            .into_iter()
            .enumerate()
            .filter(|(p, _)| !task.marked[*p])
        {
            shapes[p].push((q as u32, s));
        }
        for (i, block) in blocks.into_iter().enumerate().filter(|(i, _)| *i != q) {
            rows[i].push((q as u32, block));
        }
    }
    let mut pass = task.kept();
    if let Some(factors) = &factors {
        let passed: Vec<Vec<(u32, Block<D>)>> = (0..body.points())
            .into_par_iter()
            .map(|e| match loaded(task, e) {
                true => reaching(task, factors, e),
                false => vec![],
            })
            .collect();
        for (row, passed) in pass.iter_mut().zip(passed) {
            row.extend(passed);
        }
    }
    let work = Work {
        solved: 1,
        direct: usize::from(task.asymmetry > SYMMETRIC),
        points: body.points(),
        ..Work::default()
    };
    for (k, &q) in (0..).zip(retained) {
        shapes[q as usize] = vec![(k, unit())];
    }
    Ok(Eliminated {
        coupling: Coupling { rows },
        work,
        pass,
        shapes: task.shaped.then_some(Shapes { rows: shapes }),
    })
}

/// Unknowns of the removed points and of the retained ones.
fn sizes<const D: usize>(task: &Task<D>) -> (usize, usize) {
    let retained = task.retained.len();
    (D * (task.body.points() - retained), D * retained)
}

/// Does a load act on point `e`, which is removed?
fn loaded<const D: usize>(task: &Task<D>, e: usize) -> bool {
    task.loaded[e] && !task.marked[e]
}

/// Is what will be full small enough to be held?
fn fits<const D: usize>(task: &Task<D>) -> Result<(), CoarsenError> {
    let (n, m) = sizes(task);
    if m * m > SCHUR_LIMIT {
        return Err(CoarsenError::TooLarge {
            removed: n,
            retained: m,
            limit: SCHUR_LIMIT,
        });
    }
    let loads = D * { 0..task.body.points() }
        .filter(|e| loaded(task, *e))
        .count();
    if loads * m > SCHUR_LIMIT {
        return Err(CoarsenError::LoadsTooLarge {
            loads,
            retained: m,
            limit: SCHUR_LIMIT,
        });
    }
    if task.shaped && n * m > SCHUR_LIMIT {
        return Err(CoarsenError::ShapesTooLarge {
            removed: n,
            retained: m,
            limit: SCHUR_LIMIT,
        });
    }
    Ok(())
}

/// Forces on retained points, which are held, when forces of 1 act on point e.
fn reaching<const D: usize>(task: &Task<D>, factors: &Direct<D>, e: usize) -> Vec<(u32, Block<D>)> {
    let body = task.body;
    let mut displaced = vec![zero::<D>(); body.points()];
    for b in 0..D {
        let mut force = vec![[0.0; D]; body.points()];
        force[e][b] = 1.0;
        for (block, u) in displaced.iter_mut().zip(factors.solve(&force)) {
            for a in 0..D {
                block[a][b] = u[a];
            }
        }
    }
    let passed = (0..).zip(task.retained).map(|(k, &i)| {
        let (partners, blocks) = body.row(i as usize);
        let mut sum = zero();
        for (j, c) in partners.iter().zip(blocks) {
            add_product(&mut sum, c, &displaced[*j as usize]);
        }
        (k, scaled(body.volume[i as usize], &sum))
    });
    passed.collect()
}

/// Forces on removed points when component b of point q is displaced by 1.
fn forces<const D: usize>(task: &Task<D>, q: u32, b: usize) -> Vec<[f64; D]> {
    let body = task.body;
    let mut force = vec![[0.0; D]; body.points()];
    let mut take = |e: usize, k: &Block<D>| {
        for a in 0..D {
            force[e][a] += k[a][b];
        }
    };
    if task.asymmetry < SYMMETRIC {
        let (partners, blocks) = body.row(q as usize);
        for (j, c) in partners.iter().zip(blocks) {
            take(
                *j as usize,
                &scaled(body.volume[q as usize], &transposed(c)),
            );
        }
    } else {
        for e in 0..body.points() {
            if let Some(c) = body.micromodulus(e, q as usize) {
                take(e, &scaled(body.volume[e], c));
            }
        }
    }
    force
}
