//! Adaptive dynamic relaxation: a damped motion with made-up masses that ends in equilibrium, whatever the law (Underwood 1983;
//! for peridynamics Kilic & Madenci 2010).

use super::goal::{Goal, Imbalance, Left};
use super::solved::Solved;
use super::vectors::{Sums, add};
use crate::error::SolveError;

/// Stiffness over mass (of a step of 1) above which a step leads away: what is stable to 4 has met more than its masses bear.
const BEARS: f64 = 3.6;
/// What masses are made for.
const MEANT: f64 = 2.0;

/// Moves `x` until `force(x)` (force on every component, 0 on held ones) vanishes. `mass` per point makes a step of 1 stable:
/// at least a quarter of the largest eigenvalue of stiffness over mass. `force` raises it where it meets more stiffness, and returns how much is left and what
/// that is compared with, or `None`: it put `x` back to where it was before it met that. Where the stiffness depends on the way (`path`: what flows
/// is softer than what unloads), masses of points that meet more than theirs bear are doubled, and all goes on from rest where the least was left
/// (Underwood's error of the apparent frequency).
///
/// # Errors
/// The goal is not reached, or somebody has had enough; something is not a number.
pub fn relax<const D: usize>(
    x: &mut [[f64; D]],
    mut mass: Vec<f64>,
    (goal, sums): (Goal, &Sums),
    path: bool,
    mut force: impl FnMut(&mut [[f64; D]], &mut [[f64; D]], &mut [f64]) -> Option<Imbalance>,
) -> Result<Solved, SolveError> {
    let n = x.len();
    let mut f = vec![[0.0; D]; n];
    let mut before = f.clone();
    let mut v = f.clone();
    let mut moved = f.clone();
    let mut left = Left::unknown();
    // where the least was left
    let mut least = (f64::INFINITY, if path { x.to_vec() } else { vec![] });
    for iteration in 0..=goal.most_iterations {
        goal.go_on(iteration, sums)?;
        let Some(found) = force(x, &mut f, &mut mass) else {
            for all in [&mut v, &mut moved] {
                all.iter_mut().for_each(|x| *x = [0.0; D]);
            }
            continue;
        };
        if goal.is_reached(&mut left, found)? {
            return Ok(Solved {
                iterations: iteration,
                residual: left.residual,
            });
        }
        if path && grow((&mut mass, sums), [&before, &f], &v) {
            for all in [&mut v, &mut moved] {
                all.iter_mut().for_each(|x| *x = [0.0; D]);
            }
            // what has led away counts for nothing
            x.copy_from_slice(&least.1);
            left.most = 0.0;
            continue;
        }
        if path && left.size < least.0 {
            least.0 = left.size;
            least.1.copy_from_slice(x);
        }
        // Rayleigh's quotient of what has moved, with the stiffness that the last step met
        let [stiffness, weight] = sums.each(n, |i| {
            let [mut stiffness, mut square] = [0.0; 2];
            for a in 0..D {
                let way = moved[i][a] * moved[i][a];
                square += way;
                if v[i][a] != 0.0 {
                    stiffness += way * ((before[i][a] - f[i][a]) / v[i][a]);
                }
            }
            [stiffness, mass[i] * square]
        });
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
        if sums.dot(&v, &f) < 0.0 {
            v.iter_mut().for_each(|v| *v = [0.0; D]);
            for i in 0..n {
                v[i] = f[i].map(|f| 0.5 * f / mass[i]);
            }
        }
        add(x, 1.0, &v);
        add(&mut moved, 1.0, &v);
        std::mem::swap(&mut before, &mut f);
    }
    Err(goal.missed(goal.most_iterations, left.residual))
}

/// Doubles masses of points that have met more stiffness in the step `v` than theirs bear, if the whole step has: from forces `before` to `after`.
fn grow<const D: usize>(
    (mass, sums): (&mut [f64], &Sums),
    [before, after]: [&[[f64; D]]; 2],
    v: &[[f64; D]],
) -> bool {
    let of = |i: usize| {
        let [mut met, mut square] = [0.0; 2];
        for a in 0..D {
            met += v[i][a] * (before[i][a] - after[i][a]);
            square += v[i][a] * v[i][a];
        }
        [met, square]
    };
    let [met, borne] = sums.each(mass.len(), |i| {
        let [met, square] = of(i);
        [met, mass[i] * square]
    });
    if !(met > BEARS * borne) {
        return false;
    }
    for (i, m) in mass.iter_mut().enumerate() {
        let [met, square] = of(i);
        if met > MEANT * *m * square {
            *m *= 2.0;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::vectors::ALONE;

    fn goal() -> Goal {
        Goal {
            tolerance: 1e-10,
            most_iterations: 2000,
            stop: || false,
        }
    }

    /// Two springs in a row, a thousand times as stiff where they are pushed back as the masses are made for.
    #[test]
    fn masses_grow_where_what_has_flowed_unloads() {
        let pull = |e: f64| {
            if e > 0.01 {
                0.01 + 1e-3 * (e - 0.01)
            } else {
                e
            }
        };
        let relaxed = |path: bool| {
            let mut x = vec![[0.0]; 3];
            x[2][0] = 0.012;
            let solved = relax(&mut x, vec![2e-3; 3], (goal(), &ALONE), path, |x, f, _| {
                let [low, high] = [x[1][0] - x[0][0], x[2][0] - x[1][0]].map(pull);
                f[1][0] = high - low;
                Some(Imbalance {
                    size: ALONE.norm(f),
                    scale: 0.006,
                })
            });
            (solved, x[1][0])
        };
        let (solved, x) = relaxed(true);
        assert!(solved.is_ok(), "{solved:?}");
        assert!((x - 0.006).abs() < 1e-11, "{x}");
        assert!(relaxed(false).0.is_err());
    }
}
