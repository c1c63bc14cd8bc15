//! Conjugate gradients with blocks of the diagonal as preconditioner; every sum has a fixed order.

use super::direct::SYMMETRIC;
use super::goal::Goal;
use super::operator::{Assembled, LinearOperator, Shifted};
use super::solved::Solved;
use super::support::Support;
use super::vectors::{Block, Sums, add, add_to_multiple};
use crate::error::SolveError;
use crate::spec::LinearBody;

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
    let sums = operator.sums().clone();
    let preconditioner = Blocks::new(operator, support)?;
    let mut r = vec![[0.0; D]; n];
    operator.apply(x, &mut r);
    for (r, b) in r.iter_mut().zip(b) {
        *r = crate::array::from_fn(|a| b[a] - r[a]);
    }
    support.mask(&mut r);
    let start = sums.dot(&r, &r).sqrt();
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
    let mut rz = sums.dot(&r, &z);
    for iteration in 1..=goal.most_iterations {
        goal.go_on(iteration, &sums)?;
        operator.apply(&p, &mut q);
        support.mask(&mut q);
        let curvature = sums.dot(&p, &q);
        if !(curvature > 0.0) {
            return Err(if curvature.is_nan() {
                SolveError::NotFinite
            } else {
                SolveError::Indefinite {
                    point: most_moved(&p, &sums),
                }
            });
        }
        let step = rz / curvature;
        add(x, step, &p);
        add(&mut r, -step, &q);
        let residual = sums.dot(&r, &r).sqrt() / start;
        if residual <= goal.tolerance {
            return Ok(Solved {
                iterations: iteration,
                residual,
            });
        }
        preconditioner.apply(&r, &mut z);
        let next = sums.dot(&r, &z);
        add_to_multiple(&mut p, next / rz, &z);
        rz = next;
    }
    let left = sums.dot(&r, &r).sqrt();
    Err(goal.missed(goal.most_iterations, left / start))
}

/// As [`solve`] of a linear body with more on its diagonal (`[N]`, force / length; empty: nothing).
///
/// # Errors
/// Those of [`solve`]; the body is not symmetric.
pub fn solve_assembled<const D: usize>(
    body: &LinearBody<D>,
    added: &[Block<D>],
    support: &Support<D>,
    b: &[[f64; D]],
    x: &mut [[f64; D]],
    goal: Goal,
) -> Result<Solved, SolveError> {
    let asymmetry = body.soundness().asymmetry;
    if asymmetry > SYMMETRIC {
        return Err(SolveError::NotSymmetric { asymmetry });
    }
    let operator = &mut Assembled(body);
    solve(&mut Shifted { operator, added }, support, b, x, goal)
}

/// Inverses of the diagonal's blocks on the free components.
struct Blocks<const D: usize>(Vec<[[f64; D]; D]>);

impl<const D: usize> Blocks<D> {
    fn new(operator: &mut dyn LinearOperator<D>, support: &Support<D>) -> Result<Self, SolveError> {
        let diagonal = operator.diagonal();
        let of = |(block, free): (&[[f64; D]; D], &[bool; D])| {
            let mut block = *block;
            for a in (0..D).filter(|a| !free[*a]) {
                for b in 0..D {
                    block[a][b] = 0.0;
                    block[b][a] = 0.0;
                }
                block[a][a] = 1.0;
            }
            inverse(block)
        };
        let blocks = diagonal.iter().zip(&support.free).map(of);
        let blocks: Vec<_> = blocks.collect();
        match operator
            .sums()
            .first(blocks.iter().position(Option::is_none))
        {
            Some(point) => Err(SolveError::Indefinite { point }),
            None => Ok(Blocks(blocks.into_iter().flatten().collect())),
        }
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

/// The id where a motion is largest, the first one where many are.
fn most_moved<const D: usize>(p: &[[f64; D]], sums: &Sums) -> usize {
    let square = |p: &[f64; D]| p.iter().map(|c| c * c).sum::<f64>();
    let own = p.iter().map(square).fold(0.0, f64::max);
    let most = sums.most(own);
    sums.first(p.iter().position(|p| square(p) == most))
        .unwrap_or(0)
}
