//! Adaptive dynamic relaxation: a damped motion with made-up masses that ends in equilibrium, whatever the law (Underwood 1983;
//! for peridynamics Kilic & Madenci 2010).

use super::Solved;
use super::cg::Goal;
use super::support::Support;
use super::vectors::{add, dot, norm};
use crate::error::SolveError;

/// Loads and reactions of this part of the greatest residual are none.
const UNLOADED: f64 = 1e-6;

/// Moves `x` until `force(x)` (force on every component) vanishes on the free ones. `mass` per point makes a step of 1 stable:
/// at least a quarter of the largest eigenvalue of stiffness over mass. `force` raises it where it meets more stiffness, and returns the force that
/// residuals are compared with, or `None`: it put `x` back to where it was before it met that.
///
/// # Errors
/// The goal is not reached, or somebody has had enough; something is not a number.
pub fn relax<const D: usize>(
    x: &mut [[f64; D]],
    mut mass: Vec<f64>,
    support: &Support<D>,
    goal: Goal,
    mut force: impl FnMut(&mut [[f64; D]], &mut [[f64; D]], &mut [f64]) -> Option<f64>,
) -> Result<Solved, SolveError> {
    let n = x.len();
    let mut f = vec![[0.0; D]; n];
    let mut before = f.clone();
    let mut v = f.clone();
    let mut moved = f.clone();
    let (mut residual, mut most) = (f64::INFINITY, 0.0f64);
    for iteration in 0..=goal.most_iterations {
        goal.go_on()?;
        let Some(scale) = force(x, &mut f, &mut mass) else {
            for all in [&mut v, &mut moved] {
                all.iter_mut().for_each(|x| *x = [0.0; D]);
            }
            continue;
        };
        support.mask(&mut f);
        let size = norm(&f);
        if !size.is_finite() {
            return Err(SolveError::NotFinite);
        }
        // where nothing bears a load in the end, what is left is compared with what moved the points
        most = most.max(size);
        let scale = scale.max(UNLOADED * most);
        residual = if scale > 0.0 { size / scale } else { size };
        if residual <= goal.tolerance || size == 0.0 {
            return Ok(Solved {
                iterations: iteration,
                residual,
            });
        }
        // Rayleigh's quotient of what has moved, with the stiffness that the last step met
        let mut stiffness = 0.0;
        for i in 0..n {
            for a in 0..D {
                if v[i][a] != 0.0 {
                    let k = (before[i][a] - f[i][a]) / v[i][a];
                    stiffness += moved[i][a] * moved[i][a] * k;
                }
            }
        }
        let weight: f64 = moved
            .iter()
            .zip(&mass)
            .map(|(u, m)| m * u.iter().map(|c| c * c).sum::<f64>())
            .sum();
        let quotient = if weight > 0.0 {
            stiffness / weight
        } else {
            0.0
        };
        let damping = 2.0 * quotient.clamp(0.0, 0.9).sqrt();
        for i in 0..n {
            for a in 0..D {
                v[i][a] = ((2.0 - damping) * v[i][a] + 2.0 * f[i][a] / mass[i]) / (2.0 + damping);
            }
        }
        // a step against the force has overshot
        if dot(&v, &f) < 0.0 {
            v.iter_mut().for_each(|v| *v = [0.0; D]);
            for i in 0..n {
                v[i] = f[i].map(|f| 0.5 * f / mass[i]);
            }
        }
        support.mask(&mut v);
        add(x, 1.0, &v);
        add(&mut moved, 1.0, &v);
        std::mem::swap(&mut before, &mut f);
    }
    Err(SolveError::NotConverged {
        iterations: goal.most_iterations,
        residual,
        tolerance: goal.tolerance,
    })
}
