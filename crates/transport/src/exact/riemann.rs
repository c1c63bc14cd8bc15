//! Riemann's problem of a local scalar law.

use crate::flux::Flux;

/// Values of u that a flux is first looked at.
const LOOKS: usize = 2001;

/// The entropy solution of `u_t + f(u)_x = 0` from `left` and `right` of 0 at `ξ = x/t`, for any flux (Osher 1984): where `left < right`, the u between them that makes
/// `f(u) − ξu` least, else the one that makes it largest. Shocks and fans follow from the hull of f.
pub fn riemann(flux: &Flux, left: f64, right: f64, xi: f64) -> f64 {
    let sign = if left < right { 1.0 } else { -1.0 };
    let height = |u: f64| sign * (flux.local(u) - xi * u);
    let place = |k: usize| left + (right - left) * k as f64 / (LOOKS - 1) as f64;
    let mut best = 0;
    for k in 1..LOOKS {
        if height(place(k)) < height(place(best)) {
            best = k;
        }
    }
    // between the neighbours of the best there is one least value
    let (mut a, mut b) = (
        place(best.saturating_sub(1)),
        place((best + 1).min(LOOKS - 1)),
    );
    for _ in 0..80 {
        let (p, q) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        match height(p) <= height(q) {
            true => b = q,
            false => a = p,
        }
    }
    let inner = 0.5 * (a + b);
    // an end of the interval is exact
    match height(inner) < height(place(best)) {
        true => inner,
        false => place(best),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shocks_fans_and_compound_waves() {
        let burgers = Flux::burgers();
        assert_eq!(riemann(&burgers, 1.0, 0.0, 0.49), 1.0);
        assert_eq!(riemann(&burgers, 1.0, 0.0, 0.51), 0.0);
        assert!((riemann(&burgers, -1.0, 1.0, 0.3) - 0.3).abs() < 1e-7);
        assert_eq!(riemann(&burgers, -1.0, 1.0, 1.2), 1.0);
        // f = u³ from 1 to −1: a shock to −1/2 at speed 3/4, then a fan
        let cubic = Flux::of_mean(&[0.0, 0.0, 0.0, 1.0]);
        assert_eq!(riemann(&cubic, 1.0, -1.0, 0.74), 1.0);
        assert!((riemann(&cubic, 1.0, -1.0, 0.76) + (0.76f64 / 3.0).sqrt()).abs() < 1e-6);
        assert_eq!(riemann(&cubic, 1.0, -1.0, 3.1), -1.0);
    }
}
