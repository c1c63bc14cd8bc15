//! Coarsening in one dimension as fractions: networks of springs, points removed one after the other.

use crate::exact::Field;

/// `C_ij` between points of a chain, dense; the diagonal never acts and is 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Network<F> {
    pub stiffness: Vec<Vec<F>>,
}

impl<F: Field> Network<F> {
    /// So many points; `springs[j − 1]` between points j apart.
    pub fn chain(points: usize, springs: &[F]) -> Network<F> {
        let spring = |i: usize, j: usize| match i.abs_diff(j) {
            0 => F::zero(),
            d => springs.get(d - 1).cloned().unwrap_or_else(F::zero),
        };
        Network {
            stiffness: (0..points)
                .map(|i| (0..points).map(|j| spring(i, j)).collect())
                .collect(),
        }
    }

    /// The network of some of its points alone, bonds to others left out.
    pub fn part(&self, points: &[usize]) -> Network<F> {
        let row = |i: &usize| {
            points
                .iter()
                .map(|j| self.stiffness[*i][*j].clone())
                .collect()
        };
        Network {
            stiffness: points.iter().map(row).collect(),
        }
    }

    /// The retained points with all others in equilibrium: removing e adds `C_ie C_ej / Σ_q C_eq` between i and j. `None`: a removed
    /// point is held by nothing.
    pub fn eliminated(&self, retained: &[usize]) -> Option<Network<F>> {
        let mut c = self.stiffness.clone();
        let n = c.len();
        let mut here: Vec<usize> = (0..n).collect();
        for e in (0..n).filter(|e| !retained.contains(e)) {
            here.retain(|i| *i != e);
            let held = here.iter().fold(F::zero(), |s, q| s + c[e][*q].clone());
            if held.is_zero() {
                return None;
            }
            for &i in &here {
                let factor = c[i][e].clone() / held.clone();
                if factor.is_zero() {
                    continue;
                }
                for &j in here.iter().filter(|j| **j != i) {
                    let more = factor.clone() * c[e][j].clone();
                    c[i][j] = c[i][j].clone() + more;
                }
            }
        }
        Some(Network { stiffness: c }.part(retained))
    }

    /// The coarse micromoduli of a retained point by its ball of so many points on either side (silling2010, section 4, with v once):
    /// `[(q, C¹_iq)]`, itself left out. `None` as of [`Network::eliminated`].
    pub fn ball_row(
        &self,
        centre: usize,
        radius: usize,
        retained: &[usize],
    ) -> Option<Vec<(usize, F)>> {
        let low = centre.saturating_sub(radius);
        let high = (centre + radius).min(self.stiffness.len() - 1);
        let points: Vec<usize> = (low..=high).collect();
        let rim: Vec<usize> = points
            .iter()
            .copied()
            .filter(|p| retained.contains(p))
            .collect();
        let within: Vec<usize> = rim.iter().map(|p| p - low).collect();
        let coarse = self.part(&points).eliminated(&within)?;
        let row = &coarse.stiffness[rim.iter().position(|p| *p == centre)?];
        let all = rim.into_iter().zip(row.iter().cloned());
        Some(all.filter(|(q, _)| *q != centre).collect())
    }
}

/// `½ Σ_q C_q ξ_q²` of a row, ξ in points.
pub fn modulus<F: Field>(centre: usize, row: &[(usize, F)]) -> F {
    let sum = row.iter().fold(F::zero(), |s, (q, c)| {
        let xi = F::whole(*q as i64 - centre as i64);
        s + c.clone() * xi.clone() * xi
    });
    sum * F::ratio(1, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    fn every(n: usize, k: usize) -> Vec<usize> {
        (0..n).step_by(k).collect()
    }

    #[test]
    fn springs_in_series() {
        // erratum 1: two unit springs give one half, not v times that
        let coarse = Network::chain(3, &[q(1, 1)]).eliminated(&[0, 2]).unwrap();
        assert_eq!(coarse.stiffness, [[q(0, 1), q(1, 2)], [q(1, 2), q(0, 1)]]);
        for k in 2..9 {
            let coarse = Network::chain(4 * k + 1, &[q(3, 7)]).eliminated(&every(4 * k + 1, k));
            assert_eq!(
                coarse,
                Some(Network::chain(5, &[q(3, 7 * k as i64)])),
                "{k}"
            );
        }
        let unlike = Network {
            stiffness: vec![
                vec![q(0, 1), q(2, 1), q(0, 1)],
                vec![q(2, 1), q(0, 1), q(3, 1)],
                vec![q(0, 1), q(3, 1), q(0, 1)],
            ],
        };
        assert_eq!(unlike.eliminated(&[0, 2]).unwrap().stiffness[0][1], q(6, 5));
    }

    #[test]
    fn two_steps_are_one() {
        let chain = Network::chain(25, &[q(4, 1), q(1, 3), q(1, 5)]);
        let one = chain.eliminated(&every(25, 6)).unwrap();
        let two = chain
            .eliminated(&every(25, 2))
            .unwrap()
            .eliminated(&every(13, 3))
            .unwrap();
        assert_eq!(one, two);
        let loose = Network::chain(3, &[q(0, 1), q(1, 1)]);
        assert_eq!(loose.eliminated(&[0, 2]), None);
    }

    #[test]
    fn a_homogeneous_chain_has_a_rational_stencil() {
        // springs 1 and 1/4 to the first and second neighbours, every second point retained, balls of 2: with u±1 removed and u0, u2
        // given, (9/4) u1 = u0 + u2 + u−1/4 and (9/4) u−1 = u0 + u−2 + u1/4, so that u2 = 1 alone gives u1 = 9/20, u−1 = 1/20
        let chain = Network::chain(9, &[q(1, 1), q(1, 4)]);
        let row = chain.ball_row(4, 2, &every(9, 2)).unwrap();
        let c = q(1, 4) + q(9, 20) + q(1, 20);
        assert_eq!(row, [(2, c.clone()), (6, c)]);
        // the modulus 3 of a point that stands for two is three quarters of 2, that of the chain
        assert_eq!(modulus(4, &row) / q(2, 1), q(3, 2));
        let wide = chain.ball_row(4, 4, &every(9, 2)).unwrap();
        assert_eq!(wide.len(), 4);
        assert!(modulus(4, &wide) > modulus(4, &row));
    }

    #[test]
    fn the_published_stencil_as_fractions() {
        // example 1: C0 = 1 − j/10, every fourth point, r1 = 40 v: the modulus is 0.8 % below that of level 0
        let tent: Vec<Q> = (1..10).map(|j| q(10 - j, 10)).collect();
        let chain = Network::chain(81, &tent);
        let row = chain.ball_row(40, 40, &every(81, 4)).unwrap();
        assert_eq!(row.len(), 20);
        let stiff = tent
            .iter()
            .enumerate()
            .fold(q(0, 1), |s, (j, c)| s + c * q((j as i64 + 1).pow(2), 1));
        assert_eq!(stiff, q(165, 2));
        // a coarse point stands for four
        let ratio = modulus(40, &row) / (q(4, 1) * stiff);
        assert!(
            ratio < q(992, 1000) && ratio > q(991, 1000),
            "{}",
            ratio.value()
        );
        let symmetric = (0..10).all(|k| row[k].1 == row[19 - k].1);
        assert!(symmetric);
    }
}
