//! FIRE, the fast inertial relaxation engine: points move by their forces, are turned toward these, and stop where they would go uphill
//! (E. Bitzek, P. Koskinen, F. Gähler, M. Moseler and P. Gumbsch 2006, Structural relaxation made simple, Phys. Rev. Lett. 97, 170201; steps,
//! delay and the half step back: J. Guénolé et al. 2020, Assessment and optimization of the fast inertial relaxation engine (FIRE) for energy
//! minimization in atomistic simulations and its implementation in LAMMPS, Comput. Mater. Sci. 175, 109584).

use super::Solved;
use super::goal::{Goal, Imbalance, Left};
use super::vectors::{Sums, add};
use crate::error::SolveError;

/// Numbers of Guénolé et al., Table 2: steps downhill before the step grows, by what it grows and shrinks, how much velocities are turned at
/// first, and how that fades.
const DELAY: usize = 20;
const GROWS: f64 = 1.1;
const SHRINKS: f64 = 0.5;
const TURNED: f64 = 0.25;
const FADES: f64 = 0.99;
/// Steps, of masses that make a step of 1 stable: the first, the longest, the shortest.
const FIRST: f64 = 0.25;
const LONGEST: f64 = 1.0;
const SHORTEST: f64 = 0.01;

/// Moves `x` until `force(x)` vanishes; masses, `force` and the errors are those of
/// [`relax`](super::relaxation::relax).
///
/// # Errors
/// The goal is not reached, or somebody has had enough; something is not a number.
pub fn minimize<const D: usize>(
    x: &mut [[f64; D]],
    mut mass: Vec<f64>,
    (goal, sums): (Goal, &Sums),
    mut force: impl FnMut(&mut [[f64; D]], &mut [[f64; D]], &mut [f64]) -> Option<Imbalance>,
) -> Result<Solved, SolveError> {
    let mut f = vec![[0.0; D]; x.len()];
    let mut v = f.clone();
    let (mut step, mut turned, mut downhill) = (FIRST, TURNED, 0);
    let mut left = Left::unknown();
    for iteration in 0..=goal.most_iterations {
        goal.go_on(iteration, sums)?;
        let Some(found) = force(x, &mut f, &mut mass) else {
            v.iter_mut().for_each(|v| *v = [0.0; D]);
            continue;
        };
        if goal.is_reached(&mut left, found)? {
            return Ok(Solved {
                iterations: iteration,
                residual: left.residual,
            });
        }
        if sums.dot(&f, &v) > 0.0 {
            downhill += 1;
            if downhill > DELAY {
                step = (step * GROWS).min(LONGEST);
                turned *= FADES;
            }
        } else {
            // half of the way that led uphill is taken back
            add(x, -0.5 * step, &v);
            v.iter_mut().for_each(|v| *v = [0.0; D]);
            if downhill > 0 || iteration > DELAY {
                step = (step * SHRINKS).max(SHORTEST);
            }
            (turned, downhill) = (TURNED, 0);
        }
        push(&mut v, (&f, sums), &mass, step, turned);
        add(x, step, &v);
    }
    Err(goal.missed(goal.most_iterations, left.residual))
}

/// Velocities after a step, turned toward the accelerations: `v ← (1 − α) v + α a |v|/|a|`, sizes by masses.
fn push<const D: usize>(
    v: &mut [[f64; D]],
    (f, sums): (&[[f64; D]], &Sums),
    mass: &[f64],
    step: f64,
    turned: f64,
) {
    for ((v, f), m) in v.iter_mut().zip(f).zip(mass) {
        for a in 0..D {
            v[a] += step * f[a] / m;
        }
    }
    let [fast, strong] = sums.each(v.len(), |i| {
        let square = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>();
        [mass[i] * square(&v[i]), square(&f[i]) / mass[i]]
    });
    let toward = turned * (fast / strong).sqrt();
    for ((v, f), m) in v.iter_mut().zip(f).zip(mass) {
        for a in 0..D {
            v[a] = (1.0 - turned) * v[a] + toward * f[a] / m;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::vectors::ALONE;

    fn goal(most_iterations: usize) -> Goal {
        Goal {
            tolerance: 1e-10,
            most_iterations,
            stop: || false,
        }
    }

    /// Ten springs in a row, of which every other is a hundred times as stiff, pulled at one end.
    fn pulled(most: usize) -> Result<(Solved, f64), SolveError> {
        let n = 11;
        let k = |i: usize| if i.is_multiple_of(2) { 1.0 } else { 100.0 };
        let mut x = vec![[0.0]; n];
        let mass = (0..n).map(|i| (k(i) + k(i.max(1) - 1)) * 2.0).collect();
        let solved = minimize(&mut x, mass, (goal(most), &ALONE), |x, f, _| {
            f.iter_mut().for_each(|f| *f = [0.0]);
            for i in 0..n - 1 {
                let pull = k(i) * (x[i + 1][0] - x[i][0]);
                f[i][0] += pull;
                f[i + 1][0] -= pull;
            }
            f[n - 1][0] += 0.3;
            f[0][0] = 0.0;
            Some(Imbalance {
                size: ALONE.norm(f),
                scale: 0.3,
            })
        });
        solved.map(|s| (s, x[n - 1][0]))
    }

    #[test]
    fn springs_in_a_row_are_as_long_as_their_load_says() {
        let (solved, end) = pulled(20_000).unwrap();
        // five of 1, five of 100
        assert!((end - 0.3 * (5.0 + 0.05)).abs() < 1e-8, "{end} {solved:?}");
        assert!(solved.residual <= 1e-10);
        assert!(matches!(
            pulled(10),
            Err(SolveError::NotConverged { iterations: 10, .. })
        ));
    }

    #[test]
    fn a_double_well_is_left_downhill() {
        // U = (x² − 1)², from just beside its top
        let mut x = vec![[0.01]];
        let goal = (goal(10_000), &ALONE);
        let solved = minimize(&mut x, vec![8.0], goal, |x, f, _| {
            f[0][0] = -4.0 * x[0][0] * (x[0][0] * x[0][0] - 1.0);
            Some(Imbalance {
                size: ALONE.norm(f),
                scale: 1.0,
            })
        });
        assert!(solved.is_ok() && (x[0][0] - 1.0).abs() < 1e-9, "{x:?}");
    }
}
