//! Dihedrals by distances: energies that do not know left from right are functions of the cosine.

use crate::law::number::Number;

/// Of the angle between the planes 1 2 3 and 2 3 4, 0 where 1 and 4 are on the same side (lehoucq2010 (4.0.148), (4.0.149), with their
/// errata): `N/√(D₁ D₂)`, `D₁ = 4 ξ₁₂ ξ₁₃ − (ξ₁₂ + ξ₁₃ − ξ₂₃)²`, `D₂` alike.
#[inline(always)]
pub(super) fn cosine<N: Number>(xi: &[N]) -> N {
    let [x12, x13, x23, x14, x24, x34] = [xi[0], xi[1], xi[2], xi[3], xi[4], xi[5]];
    let numerator = x12 * (x34 - x24 + x23) + x13 * (x24 - x34 + x23) + x23 * (x24 + x34 - x23)
        - (x14 * x23).times(2.0);
    let area = |a: N, b: N, c: N| {
        let along = a + b - c;
        (a * b).times(4.0) - along * along
    };
    let both = area(x12, x13, x23) * area(x24, x34, x23);
    numerator.div(both.sqrt())
}

/// `Σ_n C_n cⁿ`.
#[inline(always)]
pub(super) fn polynomial<N: Number>(powers: &[f64], c: N) -> N {
    let mut sum = N::constant(0.0);
    for p in powers.iter().rev() {
        sum = (sum * c).plus(*p);
    }
    sum
}

/// `K [1 + s cos nφ]`, s = ±1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wave {
    pub strength: f64,
    pub times: u32,
    /// Is the phase π, so that s = −1?
    pub opposite: bool,
}

/// A sum of waves as powers of cos φ, by Chebyshev's `cos nφ = T_n(cos φ)`.
pub fn cosine_powers(waves: &[Wave]) -> Vec<f64> {
    let most = waves.iter().map(|w| w.times).max().unwrap_or(0) as usize;
    let mut sum = vec![0.0; most + 1];
    for wave in waves {
        sum[0] += wave.strength;
        let sign = if wave.opposite { -1.0 } else { 1.0 };
        for (sum, t) in sum.iter_mut().zip(chebyshev(wave.times)) {
            *sum += sign * wave.strength * t;
        }
    }
    sum
}

/// Coefficients of T_n.
fn chebyshev(n: u32) -> Vec<f64> {
    let (mut before, mut now) = (vec![1.0], vec![0.0, 1.0]);
    if n == 0 {
        return before;
    }
    for _ in 1..n {
        let mut next = vec![0.0; now.len() + 1];
        for (k, c) in now.iter().enumerate() {
            next[k + 1] += 2.0 * c;
        }
        for (k, c) in before.iter().enumerate() {
            next[k] -= c;
        }
        (before, now) = (now, next);
    }
    now
}
