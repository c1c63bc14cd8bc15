//! What is left of functions beyond their first terms, to the last digits however small the argument.

use crate::law::number::Number;

/// `ln(1 + x) − x`, without cancellation: with z = x/(2 + x), `ln(1 + x) = 2 artanh z`.
#[inline(always)]
pub fn ln_rest<N: Number>(x: N) -> N {
    let z = x.div(x + N::constant(2.0));
    let square = z * z;
    let mut sum = N::constant(1.0 / 19.0);
    for n in [17.0, 15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0] {
        sum = sum.fma(square, N::constant(1.0 / n));
    }
    let near = (z + z) * square * sum - x * z;
    (x * x).choose(N::constant(NEAR * NEAR), near, x.ln_1p() - x)
}

/// `eˣ − 1 − x`, without cancellation.
#[inline(always)]
pub fn exp_rest<N: Number>(x: N) -> N {
    let mut sum = N::constant(1.0);
    for n in [13.0, 12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0] {
        sum = (x * N::constant(1.0 / n)).fma(sum, N::constant(1.0));
    }
    let near = N::constant(0.5) * x * x * sum;
    (x * x).choose(N::constant(NEAR * NEAR), near, x.exp_m1() - x)
}

/// Up to here series are exact to round-off; beyond, differences lose less than two digits.
const NEAR: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_logarithm_and_exponential() {
        for x in [1e-12f64, -1e-9, 1e-4, -0.03, 0.19, -0.19, 0.21, -0.21, 0.9] {
            // Σ (−1)^(n+1) xⁿ/n and Σ xⁿ/n!, n ≥ 2, far enough
            let (mut power, mut log, mut term, mut exp) = (x, 0.0, x, 0.0);
            for n in 2..3000 {
                power *= x;
                log -= power * if n % 2 == 0 { 1.0 } else { -1.0 } / f64::from(n);
                term *= x / f64::from(n);
                exp += term;
            }
            assert!((ln_rest(x) - log).abs() <= 1e-14 * log.abs(), "{x}: {log}");
            assert!((exp_rest(x) - exp).abs() <= 1e-14 * exp.abs(), "{x}: {exp}");
        }
    }
}
