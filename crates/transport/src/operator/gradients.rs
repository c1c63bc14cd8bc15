//! Conjugate gradients.

use crate::stop::Stop;

/// Conjugate gradients for a symmetric positive operator; `u` is the right side and becomes the solution.
pub(super) fn conjugate_gradients(
    u: &mut [f64],
    stop: &Stop,
    mut apply: impl FnMut(&[f64], &mut [f64]),
) -> Result<(), f64> {
    const CLOSE: f64 = 1e-14;
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let right = dot(u, u);
    let mut a = vec![0.0; u.len()];
    // the right side is a good first guess
    apply(u, &mut a);
    let mut residual: Vec<f64> = u.iter().zip(&a).map(|(u, a)| u - a).collect();
    let mut p = residual.clone();
    let mut square = dot(&residual, &residual);
    for _ in 0..10 * u.len() + 100 {
        if stop.asked() {
            return Ok(());
        }
        if square <= CLOSE * CLOSE * right {
            return Ok(());
        }
        apply(&p, &mut a);
        let step = square / dot(&p, &a);
        u.iter_mut().zip(&p).for_each(|(u, p)| *u += step * p);
        residual
            .iter_mut()
            .zip(&a)
            .for_each(|(r, a)| *r -= step * a);
        let next = dot(&residual, &residual);
        if !(next.is_finite() && step > 0.0) {
            break;
        }
        p.iter_mut()
            .zip(&residual)
            .for_each(|(p, r)| *p = r + next / square * *p);
        square = next;
    }
    let left = (square / right).sqrt();
    // round-off of long sums
    if left <= 10.0 * CLOSE {
        Ok(())
    } else {
        Err(left)
    }
}
