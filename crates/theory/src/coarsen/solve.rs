//! The adjoint system of a ball: conjugate gradients where action is reaction, sparse LU else.
//!
//! Removed points are held by retained ones nearby, so the condition number is that of one coarse cell, whatever the ball:
//! a few dozen products replace a factorisation, which in three dimensions fills in.

use super::ball::Ball;
use super::block::{Block, zero};
use super::error::CoarsenError;
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};

/// Of the largest component of the load, preconditioned.
const RESIDUAL: f64 = 1e-14;

/// What a solution took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Effort {
    pub iterations: usize,
    pub flops: f64,
}

/// `(Σ_e x_a·y_a)` per side a.
fn dots<const D: usize>(x: &[Block<D>], y: &[Block<D>]) -> [f64; D] {
    let mut sum = [0.0; D];
    for (x, y) in x.iter().zip(y) {
        for a in 0..D {
            for c in 0..D {
                sum[a] += x[a][c] * y[a][c];
            }
        }
    }
    sum
}

/// `y = M x` for all sides at once.
fn apply<const D: usize>(ball: &Ball<D>, x: &[Block<D>], y: &mut [Block<D>]) {
    let n = ball.removed() as u32;
    for (e, y) in y.iter_mut().enumerate() {
        *y = zero();
        let mut take = |k: &Block<D>, x: &Block<D>, sign: f64| {
            for a in 0..D {
                for c in 0..D {
                    for b in 0..D {
                        y[a][c] += sign * k[c][b] * x[a][b];
                    }
                }
            }
        };
        take(&ball.diagonal[e], &x[e], 1.0);
        let (partners, blocks) = ball.row(e);
        for (&p, k) in partners.iter().zip(blocks) {
            if p < n {
                take(k, &x[p as usize], -1.0);
            }
        }
    }
}

pub(super) fn conjugate_gradients<const D: usize>(
    ball: &Ball<D>,
    load: &[Block<D>],
) -> Result<(Vec<Block<D>>, Effort), CoarsenError> {
    let n = ball.removed();
    let indefinite = || CoarsenError::Indefinite {
        point: ball.walk.rim[0] as usize,
        radius: ball.radius,
    };
    // a component without stiffness has no load either
    let inverse = |e: usize, c: usize| {
        let d = ball.diagonal[e][c][c];
        if d > 0.0 { 1.0 / d } else { 0.0 }
    };
    if (0..n).any(|e| (0..D).any(|c| ball.diagonal[e][c][c] < 0.0)) {
        return Err(indefinite());
    }
    let precondition = |r: &[Block<D>], z: &mut [Block<D>]| {
        for (e, (r, z)) in r.iter().zip(z).enumerate() {
            for c in 0..D {
                let inverse = inverse(e, c);
                for a in 0..D {
                    z[a][c] = inverse * r[a][c];
                }
            }
        }
    };
    let mut x = vec![zero(); n];
    let mut r = load.to_vec();
    let mut z = vec![zero(); n];
    precondition(&r, &mut z);
    let mut p = z.clone();
    let mut q = vec![zero(); n];
    let mut rz = dots(&r, &z);
    let first = rz;
    let limit = 200 + 20 * D * n;
    let products = ball.partner.iter().filter(|p| (**p as usize) < n).count() + n;
    let mut effort = Effort::default();
    let open = |rz: &[f64; D]| -> [bool; D] {
        std::array::from_fn(|a| rz[a] > RESIDUAL * RESIDUAL * first[a])
    };
    while open(&rz).contains(&true) {
        if effort.iterations == limit {
            let residual = (0..D).map(|a| rz[a] / first[a].max(f64::MIN_POSITIVE));
            return Err(CoarsenError::Unsolved {
                point: ball.walk.rim[0] as usize,
                iterations: limit,
                residual: residual.fold(0.0, f64::max).sqrt(),
            });
        }
        effort.iterations += 1;
        effort.flops += (2 * D * D * D * products + 12 * D * D * n) as f64;
        apply(ball, &p, &mut q);
        let pq = dots(&p, &q);
        let open = open(&rz);
        let mut alpha = [0.0; D];
        for a in (0..D).filter(|a| open[*a]) {
            if pq[a].is_nan() || pq[a] <= 0.0 {
                return Err(indefinite());
            }
            alpha[a] = rz[a] / pq[a];
        }
        for e in 0..n {
            for a in 0..D {
                for c in 0..D {
                    x[e][a][c] += alpha[a] * p[e][a][c];
                    r[e][a][c] -= alpha[a] * q[e][a][c];
                }
            }
        }
        precondition(&r, &mut z);
        let next = dots(&r, &z);
        let beta: [f64; D] = std::array::from_fn(|a| if open[a] { next[a] / rz[a] } else { 0.0 });
        for e in 0..n {
            for a in 0..D {
                for c in 0..D {
                    p[e][a][c] = z[e][a][c] + beta[a] * p[e][a][c];
                }
            }
        }
        rz = next;
    }
    Ok((x, effort))
}

/// Sparse LU of `Mᵀ`.
pub(super) fn direct<const D: usize>(
    ball: &Ball<D>,
    load: &[Block<D>],
) -> Result<(Vec<Block<D>>, Effort), CoarsenError> {
    let n = ball.removed();
    let indefinite = CoarsenError::Indefinite {
        point: ball.walk.rim[0] as usize,
        radius: ball.radius,
    };
    if n == 0 {
        return Ok((vec![], Effort::default()));
    }
    let mut entries = vec![];
    for e in 0..n {
        let (partners, blocks) = ball.row(e);
        for a in 0..D {
            for b in 0..D {
                entries.push(Triplet::new(D * e + b, D * e + a, ball.diagonal[e][a][b]));
                for (&p, k) in partners.iter().zip(blocks) {
                    if (p as usize) < n {
                        let row = D * p as usize + b;
                        entries.push(Triplet::new(row, D * e + a, -k[a][b]));
                    }
                }
            }
        }
    }
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(D * n, D * n, &entries);
    let Some(lu) = matrix.ok().and_then(|m| m.sp_lu().ok()) else {
        return Err(indefinite);
    };
    let sides = faer::Mat::from_fn(D * n, D, |k, a| load[k / D][a][k % D]);
    let solved = lu.solve(&sides);
    let x: Vec<Block<D>> = (0..n)
        .map(|e| std::array::from_fn(|a| std::array::from_fn(|c| solved[(D * e + c, a)])))
        .collect();
    if !x
        .as_flattened()
        .as_flattened()
        .iter()
        .all(|x| x.is_finite())
    {
        return Err(indefinite);
    }
    Ok((x, Effort::default()))
}
