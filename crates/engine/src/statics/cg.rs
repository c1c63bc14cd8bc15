//! Conjugate gradients with blocks of the diagonal as preconditioner; every sum has a fixed order.

use super::goal::Goal;
use super::operator::LinearOperator;
use super::solved::Solved;
use super::support::Support;
use super::vectors::{add, add_to_multiple, dot, norm};
use crate::error::SolveError;

/// Solves `A x = b` (force) on the free components; held ones keep their `x`.
///
/// # Errors
/// A is not positive definite on the free components; the goal is not reached.
pub fn solve<const D: usize>(
    operator: &mut dyn LinearOperator<D>,
    support: &Support<D>,
    b: &[[f64; D]],
    x: &mut [[f64; D]],
    goal: Goal,
) -> Result<Solved, SolveError> {
    let n = operator.points();
    let preconditioner = Blocks::new(&operator.diagonal(), support)?;
    let mut r = vec![[0.0; D]; n];
    operator.apply(x, &mut r);
    for (r, b) in r.iter_mut().zip(b) {
        *r = crate::array::from_fn(|a| b[a] - r[a]);
    }
    support.mask(&mut r);
    let start = norm(&r);
    if start == 0.0 {
        return Ok(Solved::default());
    }
    if !start.is_finite() {
        return Err(SolveError::NotFinite);
    }
    let mut z = vec![[0.0; D]; n];
    preconditioner.apply(&r, &mut z);
    let mut p = z.clone();
    let mut q = vec![[0.0; D]; n];
    let mut rz = dot(&r, &z);
    for iteration in 1..=goal.most_iterations {
        goal.go_on()?;
        operator.apply(&p, &mut q);
        support.mask(&mut q);
        let curvature = dot(&p, &q);
        if !(curvature > 0.0) {
            return Err(if curvature.is_nan() {
                SolveError::NotFinite
            } else {
                indefinite(&p)
            });
        }
        let step = rz / curvature;
        add(x, step, &p);
        add(&mut r, -step, &q);
        let residual = norm(&r) / start;
        if residual <= goal.tolerance {
            return Ok(Solved {
                iterations: iteration,
                residual,
            });
        }
        preconditioner.apply(&r, &mut z);
        let next = dot(&r, &z);
        add_to_multiple(&mut p, next / rz, &z);
        rz = next;
    }
    Err(goal.missed(goal.most_iterations, norm(&r) / start))
}

/// Inverses of the diagonal's blocks on the free components.
struct Blocks<const D: usize>(Vec<[[f64; D]; D]>);

impl<const D: usize> Blocks<D> {
    fn new(diagonal: &[[[f64; D]; D]], support: &Support<D>) -> Result<Self, SolveError> {
        let of = |(i, (block, free)): (usize, (&[[f64; D]; D], &[bool; D]))| {
            let mut block = *block;
            for a in (0..D).filter(|a| !free[*a]) {
                for b in 0..D {
                    block[a][b] = 0.0;
                    block[b][a] = 0.0;
                }
                block[a][a] = 1.0;
            }
            inverse(block).ok_or(SolveError::Indefinite { point: i })
        };
        let blocks = diagonal.iter().zip(&support.free).enumerate().map(of);
        Ok(Blocks(blocks.collect::<Result<_, _>>()?))
    }

    fn apply(&self, r: &[[f64; D]], z: &mut [[f64; D]]) {
        for ((z, r), block) in z.iter_mut().zip(r).zip(&self.0) {
            *z = crate::array::from_fn(|a| (0..D).map(|b| block[a][b] * r[b]).sum());
        }
    }
}

/// Of a positive definite block, by Gauss and Jordan.
fn inverse<const D: usize>(mut a: [[f64; D]; D]) -> Option<[[f64; D]; D]> {
    let largest = a.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let mut inverse: [[f64; D]; D] =
        crate::array::from_fn(|i| crate::array::from_fn(|j| f64::from(i == j)));
    for k in 0..D {
        let pivot = a[k][k];
        if !(pivot > 1e-14 * largest) {
            return None;
        }
        for j in 0..D {
            a[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for i in (0..D).filter(|i| *i != k) {
            let factor = a[i][k];
            for j in 0..D {
                a[i][j] -= factor * a[k][j];
                inverse[i][j] -= factor * inverse[k][j];
            }
        }
    }
    Some(inverse)
}

/// Where a motion that gives energy back is largest.
fn indefinite<const D: usize>(p: &[[f64; D]]) -> SolveError {
    let square = |p: &[f64; D]| p.iter().map(|c| c * c).sum::<f64>();
    let largest = (0..p.len()).max_by(|i, j| square(&p[*i]).total_cmp(&square(&p[*j])));
    SolveError::Indefinite {
        point: largest.unwrap_or(0),
    }
}
