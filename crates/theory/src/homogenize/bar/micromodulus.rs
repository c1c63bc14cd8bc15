//! The micromodulus of a family with few points.

use crate::exact::Field;

/// `Σ_i ξ_i V_i` over one side of a family as part of its continuum value Aδ²/2, (9): the point on the horizon weighs
/// `½ + α`, and the horizon is drawn at `δ = (m + β)Δ`.
///
/// It is 1 on the whole curve `α = β + β²/(2m)`, not only for α = β = 0 as the paper says.
pub fn moment<F: Field>(m: usize, alpha: F, beta: F) -> F {
    let m = F::whole(m as i64);
    let length = F::one() + beta / m.clone();
    (F::one() + F::whole(2) * alpha / m) / (length.clone() * length)
}

/// c(m)/c∞ for a horizon half-way between points that all have full weight, (12): 1/[`moment`] with α = β = ½.
pub fn half_way<F: Field>(m: usize) -> F {
    F::one() / moment(m, F::ratio(1, 2), F::ratio(1, 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    #[test]
    fn finite_families() {
        for m in 1..=20usize {
            let k = m as i64;
            assert_eq!(moment::<Q>(m, q(0, 1), q(0, 1)), q(1, 1));
            // (10), (12)
            let printed = q(2 * k + 1, 2 * k).pow(2) / q(k + 1, k);
            assert_eq!(half_way::<Q>(m), printed);
            // the sums themselves: Σ i over whole points, the last with ½ + α
            let (alpha, beta) = (q(1, 3), q(-2, 7));
            let sum = q(k * (k - 1), 2) + q(k, 1) * (q(1, 2) + alpha.clone());
            let length = q(k, 1) + beta.clone();
            let whole = length.clone() * length / q(2, 1);
            assert_eq!(moment(m, alpha, beta), sum / whole);
        }
        // as printed, to three decimals
        assert_eq!((half_way::<f64>(3) * 1e3).round(), 1021.0);
        assert_eq!((half_way::<f64>(5) * 1e3).round(), 1008.0);
    }

    #[test]
    fn it_is_one_on_a_curve() {
        for m in 1..=6 {
            for beta in [q(-1, 2), q(-1, 5), q(1, 3)] {
                let alpha = beta.clone() + beta.clone() * beta.clone() / q(2 * m as i64, 1);
                assert_eq!(moment(m, alpha, beta), q(1, 1));
            }
        }
    }
}
