//! The adjoint system `Mᵀ x = c` of a ball: conjugate gradients where M is symmetric, sparse LU of Mᵀ else.
//!
//! M is not symmetric where action is not reaction, and where a free ball cuts a state-based body: the blocks of M on the
//! diagonal are sums of the `C_zp` within the ball, which are symmetric for whole families only.
//! Removed points are held by retained ones nearby, so the condition number is that of one coarse cell, whatever the ball:
//! a few dozen products replace a factorisation, which in three dimensions fills in.

use super::ball::Ball;
use super::block::{Block, add, add_product, largest, scaled, zero};
use super::error::CoarsenError;
use peridyne_algebra::{FactorError, Factors};

/// Asymmetry of a ball's matrix up to which conjugate gradients solve it: round-off.
pub(super) const SYMMETRIC: f64 = 1e-13;

/// Of the largest component of the load, preconditioned.
const RESIDUAL: f64 = 1e-14;

/// Relative residual of a direct solution above which the matrix is singular to round-off.
const SOLVED: f64 = 1e-9;

/// What a solution took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Effort {
    pub iterations: usize,
    pub flops: f64,
    /// By LU?
    pub direct: bool,
}

/// Solves `Mᵀ x = (V_i C_ie)ᵀ`, `asymmetry` that of the body: one adjoint system of D right-hand sides (`x[e][a][c]`: side a, component c) stands for the whole
/// resolvent, of which only the product with the centre's row is wanted.
///
/// # Errors
/// No stable equilibrium (symmetric), a singular matrix (else), or no convergence.
pub(super) fn adjoint<const D: usize>(
    ball: &Ball<D>,
    asymmetry: f64,
) -> Result<(Vec<Block<D>>, Effort), CoarsenError> {
    let load = ball.load();
    match asymmetry.max(ball.asymmetry()) < SYMMETRIC {
        true => conjugate_gradients(ball, &load),
        false => direct(ball, &load),
    }
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

/// `y = M x` for all sides at once; M is symmetric.
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

fn conjugate_gradients<const D: usize>(
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

/// `y = Mᵀ x` for all sides at once.
fn apply_transposed<const D: usize>(ball: &Ball<D>, x: &[Block<D>], y: &mut [Block<D>]) {
    let n = ball.removed();
    y.fill(zero());
    for (e, x) in x.iter().enumerate() {
        add_product(&mut y[e], x, &ball.diagonal[e]);
        let (partners, blocks) = ball.row(e);
        for (&p, k) in partners.iter().zip(blocks) {
            if (p as usize) < n {
                add_product(&mut y[p as usize], &scaled(-1.0, x), k);
            }
        }
    }
}

/// Sparse LU of `Mᵀ`, refined once.
fn direct<const D: usize>(
    ball: &Ball<D>,
    load: &[Block<D>],
) -> Result<(Vec<Block<D>>, Effort), CoarsenError> {
    let n = ball.removed();
    let effort = Effort {
        direct: true,
        ..Effort::default()
    };
    if n == 0 {
        return Ok((vec![], effort));
    }
    let mut entries = vec![];
    for e in 0..n {
        let (partners, blocks) = ball.row(e);
        for a in 0..D {
            for b in 0..D {
                entries.push((D * e + b, D * e + a, ball.diagonal[e][a][b]));
                for (&p, k) in partners.iter().zip(blocks) {
                    if (p as usize) < n {
                        let row = D * p as usize + b;
                        entries.push((row, D * e + a, -k[a][b]));
                    }
                }
            }
        }
    }
    let singular = || CoarsenError::Singular {
        point: ball.walk.rim[0] as usize,
        radius: ball.radius,
    };
    let factors = Factors::general(D * n, &entries).map_err(|e| match e {
        FactorError::Singular | FactorError::NotPositive { .. } => singular(),
        FactorError::TooLarge => CoarsenError::BallTooLarge {
            point: ball.walk.rim[0] as usize,
            unknowns: D * n,
        },
    })?;
    let solve = |load: &[Block<D>]| {
        let mut x = vec![zero::<D>(); n];
        for a in 0..D {
            let mut side: Vec<f64> = (0..D * n).map(|k| load[k / D][a][k % D]).collect();
            factors.solve(&mut side);
            for (k, value) in side.iter().enumerate() {
                x[k / D][a][k % D] = *value;
            }
        }
        x
    };
    let mut product = vec![zero(); n];
    let mut left = |x: &[Block<D>]| -> Vec<Block<D>> {
        apply_transposed(ball, x, &mut product);
        let mut r = load.to_vec();
        for (r, p) in r.iter_mut().zip(&product) {
            add(r, &scaled(-1.0, p));
        }
        r
    };
    let size = |x: &[Block<D>]| x.iter().map(largest).fold(0.0, f64::max);
    let mut x = solve(load);
    let correction = solve(&left(&x));
    for (x, c) in x.iter_mut().zip(&correction) {
        add(x, c);
    }
    // not a number is no solution
    if size(load) > 0.0 && !(size(&left(&x)) <= SOLVED * size(load)) || !size(&x).is_finite() {
        return Err(singular());
    }
    Ok((x, effort))
}
