//! Travelling waves of the nonlocal viscous law from `left` down to `right`, and the shape of their tails.
//!
//! The speed is `(f(l) − f(r))/(l − r)`: Noll's flux of a constant is f. Behind the wave `u = left + p e^{μx}` with `(f′(l) α̂(μ) − s μ) = ε σ̂(μ)`, where
//! `α̂ = ∫₀ a sinh μz dz`, `σ̂ = 2 ∫₀ s (cosh μz − 1) dz`: the tail is monotone if there is a real μ > 0, and oscillates if there is none. With lengths in δ only `ε/δ` is left.

use crate::flux::Flux;
use crate::kernel::Kernel;

/// Speed of the wave (Rankine and Hugoniot); of states that differ by too little for their difference to have digits, `f′` between them.
pub fn speed(flux: &Flux, left: f64, right: f64) -> f64 {
    if (left - right).abs() <= 1e-8 * left.abs().max(right.abs()) {
        return flux.speed(0.5 * (left + right));
    }
    (flux.local(left) - flux.local(right)) / (left - right)
}

/// The least ε with a real exponent in the tail behind the wave: `min over μ of (f′(l) α̂(μ) − s μ)/σ̂(μ)`, μδ up to `LONGEST`; with the μ where it is.
pub fn monotone_threshold(
    flux: &Flux,
    left: f64,
    right: f64,
    odd: &Kernel,
    even: &Kernel,
) -> (f64, f64) {
    /// e^60 is far from what overflows, and the ratio has its limit
    const LONGEST: f64 = 60.0;
    let s = speed(flux, left, right);
    let own = flux.speed(left);
    let delta = odd.horizon().max(even.horizon());
    let ratio = |k: f64| (own * odd.growth(k / delta) - s * k / delta) / even.growth(k / delta);
    let place = |n: f64| 0.05 * libm::pow(LONGEST / 0.05f64, n / 400.0);
    let best = (0..=400)
        .map(f64::from)
        .min_by(|a, b| ratio(place(*a)).total_cmp(&ratio(place(*b))));
    let best = best.unwrap_or(0.0);
    let (mut a, mut b) = (place((best - 1.0).max(0.0)), place((best + 1.0).min(400.0)));
    for _ in 0..60 {
        let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        match ratio(p) <= ratio(q) {
            true => b = q,
            false => a = p,
        }
    }
    let k = 0.5 * (a + b);
    (ratio(k), k / delta)
}
