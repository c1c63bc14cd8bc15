//! Chains of springs in closed form: the sum over the plane waves of a ring, with the time stepper's own frequencies.
//!
//! Velocity Verlet from rest gives every wave `uⁿ = cos(nθ) u⁰` with `cos θ = 1 − ½ (ωΔt)²`, and
//! `ω² = 4K1/(ρ M(M+1)Δx²) Σ_j (1 − cos jkΔx)/j`. A ring of as many points is the chain while nothing has reached its ends.

use std::f64::consts::TAU;

use super::chain::Chain;
use crate::measure::largest;

/// Displacements of `at` after `steps` steps of `dt`, of the chain that starts at rest with `u0`; NaN if a wave is unstable.
pub fn displacements(chain: &Chain, dt: f64, steps: u64, u0: &[f64], at: &[usize]) -> Vec<f64> {
    let n = u0.len();
    let wave: Vec<[f64; 2]> = (0..n)
        .map(|m| {
            let (sin, cos) = (TAU * m as f64 / n as f64).sin_cos();
            [cos, sin]
        })
        .collect();
    // 1 − cos a = 2 sin² a/2, without cancellation
    let versine = |m: usize| {
        let m = m.min(n - m);
        2.0 * (0.5 * TAU * m as f64 / n as f64).sin().powi(2)
    };
    let versines: Vec<f64> = (0..n).map(versine).collect();
    let moved: Vec<usize> = (0..n).filter(|j| u0[*j] != 0.0).collect();
    let neighbours = f64::from(chain.neighbours);
    let factor = 4.0 * chain.k1
        / (chain.density * neighbours * (neighbours + 1.0) * chain.spacing * chain.spacing);
    let mut u = vec![0.0; at.len()];
    for k in 0..=n / 2 {
        let mut sum = [0.0; 2];
        for &j in &moved {
            let w = wave[k * j % n];
            sum[0] += u0[j] * w[0];
            sum[1] += u0[j] * w[1];
        }
        let squared = factor
            * (1..=chain.neighbours as usize)
                .map(|j| versines[k * j % n] / j as f64)
                .sum::<f64>();
        let theta = 2.0 * (0.5 * dt * squared.sqrt()).asin();
        // waves k and n − k are each other's conjugate
        let both = if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
        let c = both * (steps as f64 * theta).cos() / n as f64;
        for (u, &j) in u.iter_mut().zip(at) {
            let w = wave[k * j % n];
            *u += c * (sum[0] * w[0] + sum[1] * w[1]);
        }
    }
    u
}

/// Largest difference between a run and its closed form, at points spread over the chain.
pub fn difference(chain: &Chain, dt: f64, steps: u64, u0: &[f64], run: &[f64]) -> f64 {
    let n = u0.len();
    let at: Vec<usize> = (0..97)
        .map(|i| (n / 5 + i * (3 * n / 5) / 97).min(n - 1))
        .collect();
    let exact = displacements(chain, dt, steps, u0, &at);
    largest(exact.iter().zip(&at).map(|(e, j)| (e - run[*j]).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the recurrence (4.10) itself, on a ring.
    #[test]
    fn the_sum_is_what_the_recurrence_gives() {
        let chain = Chain {
            points: 60,
            neighbours: 3,
            spacing: 0.5,
            density: 2.0,
            k1: 3.0,
        };
        let (n, dt) = (60usize, chain.time_step(0.85));
        let u0: Vec<f64> = (0..n)
            .map(|j| if (20..29).contains(&j) { 1.0 } else { 0.0 })
            .collect();
        let force = |u: &[f64], i: usize| -> f64 {
            (1..=3)
                .map(|j| {
                    let k = chain.stiffness() / (j as f64 * chain.spacing * chain.spacing);
                    k * (u[(i + j) % n] + u[(i + n - j) % n] - 2.0 * u[i])
                })
                .sum()
        };
        let accelerated = |u: &[f64], i: usize| dt * dt / chain.density * force(u, i);
        let mut before = u0.clone();
        let mut now: Vec<f64> = (0..n).map(|i| u0[i] + 0.5 * accelerated(&u0, i)).collect();
        for _ in 1..40 {
            let next = (0..n)
                .map(|i| 2.0 * now[i] - before[i] + accelerated(&now, i))
                .collect();
            before = std::mem::replace(&mut now, next);
        }
        let at: Vec<usize> = (0..n).collect();
        let exact = displacements(&chain, dt, 40, &u0, &at);
        for (a, b) in exact.iter().zip(&now) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
        assert!(displacements(&chain, 3.0 * dt, 1, &u0, &at)[0].is_nan());
    }
}
