//! The factors that make a bar homogeneous, found by solving for them.

use super::Ends;
use super::stiffness_matrix::StiffnessMatrix;
use crate::exact::Field;

/// α_1 … α_{m−1}: factors of the bonds between an end point and its neighbours at distance 1, …, m−1.
///
/// Unknown are these factors, given are the equations of points 2…m in uniform strain, `u_j = j`, without load. They are
/// linear in the factors, and that of point d+1 contains α_d alone, so that the residuals with all factors 0 and 1 say
/// everything: `r(α) = r(0) + α (r(1) − r(0)) = 0`. All other rows are then at rest as well, and the end row of a full
/// bar carries its load `m²/2`: see the tests. Found: (58) `α_d = m − d + ½` for full ends, and `2(m − d) + 1` for half
/// ones, which (59) misprints as `2(m − 1) + 1`.
pub fn parameters<F: Field>(m: usize, ends: Ends) -> Vec<F> {
    let points = 2 * m + 1;
    let with = |factor: i64| StiffnessMatrix::new(m, points, ends, &vec![F::whole(factor); m - 1]);
    let (none, one) = (with(0), with(1));
    let uniform: Vec<F> = (0..points as i64).map(F::whole).collect();
    (1..m)
        .map(|d| {
            let (r0, r1) = (none.pull(d, &uniform), one.pull(d, &uniform));
            r0.clone() / (r0 - r1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::Bar;
    use super::*;
    use crate::exact::{Q, q};

    #[test]
    fn they_are_58_and_the_corrected_59() {
        for m in 1..=30i64 {
            let full: Vec<Q> = (1..m).map(|i| q(2 * (m - i) + 1, 2)).collect();
            assert_eq!(parameters::<Q>(m as usize, Ends::Full), full);
            let half: Vec<Q> = (1..m).map(|i| q(2 * (m - i) + 1, 1)).collect();
            assert_eq!(parameters::<Q>(m as usize, Ends::Half), half);
            // as printed, (59) does not depend on i: it agrees up to m = 2
            let printed = vec![q(2 * (m - 1) + 1, 1); m as usize - 1];
            assert_eq!(half == printed, m <= 2);
        }
        let floats = parameters::<f64>(9, Ends::Full);
        let exact = |(k, a): (usize, &f64)| (a - (8.5 - k as f64)).abs() < 1e-12;
        assert!(floats.iter().enumerate().all(exact));
    }

    /// Fig. 2 says α = 3/2 and β = 5/2 for m = 3: α belongs to the nearest point, and is 5/2.
    #[test]
    fn the_caption_of_figure_2_swaps_them() {
        assert_eq!(parameters::<Q>(3, Ends::Full), [q(5, 2), q(3, 2)]);
        let swapped = StiffnessMatrix::new(3, 9, Ends::Full, &[q(3, 2), q(5, 2)]);
        let uniform: Vec<Q> = (0..9).map(|k| q(k, 1)).collect();
        assert_ne!(swapped.pull(1, &uniform), q(0, 1));
    }

    /// Every row in uniform strain, by any number of points.
    #[test]
    fn uniform_strain_is_equilibrium() {
        for m in 1..=9usize {
            for points in [2 * m + 1, 2 * m + 2, 4 * m + 7] {
                for ends in [Ends::Full, Ends::Half] {
                    let bar = Bar::new(m, points, ends, true).unwrap();
                    let s = bar.stiffness::<Q>();
                    let uniform: Vec<Q> = (0..points as i64).map(|k| q(k, 1)).collect();
                    assert!((1..points - 1).all(|i| s.pull(i, &uniform) == q(0, 1)));
                    // the load is m²/2 of full and m² of half ends; these take ½ less
                    let square = q((m * m) as i64, 1);
                    let end = match ends {
                        Ends::Full => square / q(2, 1),
                        Ends::Half => square - q(1, 2),
                    };
                    assert_eq!(s.pull(0, &uniform), end);
                    assert_eq!(s.pull(points - 1, &uniform), -end);
                }
            }
        }
    }
}
