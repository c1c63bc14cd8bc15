//! The exact elimination of all removed points at once: the reference for every ball and every number of levels.

use super::balls::{Task, Work};
use super::block::{Block, add, scaled, zero};
use super::coupling::Coupling;
use super::error::CoarsenError;
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use rayon::prelude::*;

/// Numbers that the exact elimination may hold: the coarse stiffness is full.
pub const SCHUR_LIMIT: usize = 60_000_000;
/// Columns that are solved at once.
const COLUMNS: usize = 32;

pub(super) fn schur<const D: usize>(task: &Task<D>) -> Result<(Coupling<D>, Work), CoarsenError> {
    let body = task.body;
    let removed: Vec<u32> = (0..body.points() as u32)
        .filter(|p| !task.marked[*p as usize])
        .collect();
    let (n, m) = (D * removed.len(), D * task.retained.len());
    if m * m + 2 * COLUMNS * n > SCHUR_LIMIT {
        return Err(CoarsenError::TooLarge {
            removed: n,
            retained: m,
            limit: SCHUR_LIMIT,
        });
    }
    let place = |p: u32| removed.partition_point(|r| *r < p);
    let stiff = |p: u32| {
        let (partners, blocks) = body.row(p as usize);
        let v = body.volume[p as usize];
        partners.iter().zip(blocks).map(move |(j, c)| (*j, scaled(v, c)))
    };
    let mut entries = vec![];
    for (e, &p) in removed.iter().enumerate() {
        let mut sum = zero::<D>();
        for (j, k) in stiff(p) {
            add(&mut sum, &k);
            if !task.marked[j as usize] {
                put(&mut entries, e, place(j), &scaled(-1.0, &k));
            }
        }
        put(&mut entries, e, e, &sum);
    }
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &entries)
        .map_err(|_| CoarsenError::IndefiniteBody)?;
    let factor: Box<dyn Solver> = match task.symmetric {
        true => Box::new(matrix.sp_cholesky(Side::Lower).map_err(|_| CoarsenError::IndefiniteBody)?),
        false => Box::new(matrix.sp_lu().map_err(|_| CoarsenError::IndefiniteBody)?),
    };
    // u_E per displacement of some retained points, then the forces on all retained points
    let chunks: Vec<Vec<u32>> = (0..task.retained.len() as u32)
        .collect::<Vec<_>>()
        .chunks(COLUMNS / D)
        .map(<[u32]>::to_vec)
        .collect();
    let columns: Vec<Option<Vec<Block<D>>>> = chunks
        .par_iter()
        .map(|chunk| {
            let mut sides = Mat::zeros(n, D * chunk.len());
            for (e, &p) in removed.iter().enumerate() {
                for (j, k) in stiff(p).filter(|(j, _)| task.marked[*j as usize]) {
                    let q = task.retained.partition_point(|r| *r < j) as u32;
                    if let Ok(at) = chunk.binary_search(&q) {
                        for a in 0..D {
                            for b in 0..D {
                                sides[(D * e + a, D * at + b)] = k[a][b];
                            }
                        }
                    }
                }
            }
            let u = factor.solve(sides);
            let mut blocks = vec![zero(); task.retained.len() * chunk.len()];
            for (i, &p) in task.retained.iter().enumerate() {
                for (at, q) in chunk.iter().enumerate() {
                    let block = &mut blocks[i * chunk.len() + at];
                    if let Some(c) = body.micromodulus(p as usize, task.retained[*q as usize] as usize) {
                        add(block, &scaled(body.volume[p as usize], c));
                    }
                    for (j, k) in stiff(p).filter(|(j, _)| !task.marked[*j as usize]) {
                        let e = place(j);
                        for a in 0..D {
                            for b in 0..D {
                                for c in 0..D {
                                    block[a][c] += k[a][b] * u[(D * e + b, D * at + c)];
                                }
                            }
                        }
                    }
                }
            }
            let finite = blocks.as_flattened().as_flattened().iter().all(|x| x.is_finite());
            finite.then_some(blocks)
        })
        .collect();
    let mut rows = vec![vec![]; task.retained.len()];
    for (chunk, blocks) in chunks.iter().zip(columns) {
        let blocks = blocks.ok_or(CoarsenError::IndefiniteBody)?;
        for (i, row) in rows.iter_mut().enumerate() {
            for (at, q) in chunk.iter().enumerate().filter(|(_, q)| **q as usize != i) {
                row.push((*q, blocks[i * chunk.len() + at]));
            }
        }
    }
    let work = Work {
        solved: 1,
        points: body.points(),
        ..Work::default()
    };
    Ok((Coupling { rows }, work))
}

fn put<const D: usize>(
    entries: &mut Vec<Triplet<usize, usize, f64>>,
    i: usize,
    j: usize,
    k: &Block<D>,
) {
    for a in 0..D {
        for b in 0..D {
            entries.push(Triplet::new(D * i + a, D * j + b, k[a][b]));
        }
    }
}

/// A factorised matrix.
trait Solver: Sync {
    fn solve(&self, sides: Mat<f64>) -> Mat<f64>;
}

impl<S: Solve<f64> + Sync> Solver for S {
    fn solve(&self, sides: Mat<f64>) -> Mat<f64> {
        Solve::solve(self, &sides)
    }
}
