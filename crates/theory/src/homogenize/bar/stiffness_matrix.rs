//! Coefficients of a bar's equations of equilibrium.

use super::Ends;
use crate::exact::{Field, Q};
use num_bigint::BigInt;
use num_traits::One;

/// The matrix S of `c A S u = −b`; it repeats itself between the ends, so that only distances are stored.
#[derive(Debug, Clone)]
pub struct StiffnessMatrix<F> {
    points: usize,
    /// Between points that are no ends, by distance from 1.
    pub(super) inner: Vec<F>,
    /// In the row of an end point.
    of_end: Vec<F>,
    /// In the rows of others, for an end point.
    pub(super) to_end: Vec<F>,
}

impl<F: Field> StiffnessMatrix<F> {
    /// With any m−1 factors; N ≥ 2m+1.
    pub(super) fn new(m: usize, points: usize, ends: Ends, factors: &[F]) -> Self {
        let half = F::ratio(1, 2);
        let inner: Vec<F> = (1..=m as i64)
            .map(|d| F::ratio(1, if d == m as i64 { 2 * d } else { d }))
            .collect();
        let factor = |k: usize| factors.get(k).cloned().unwrap_or_else(F::one);
        let of_end: Vec<F> = (inner.iter().enumerate())
            .map(|(k, s)| s.clone() * factor(k))
            .collect();
        let mut to_end = of_end.clone();
        if ends == Ends::Half {
            // an end point on the horizon weighs ½ as it is
            for s in &mut to_end[..m - 1] {
                *s = s.clone() * half.clone();
            }
        }
        StiffnessMatrix {
            points,
            inner,
            of_end,
            to_end,
        }
    }

    /// Spacings in the horizon.
    pub fn m(&self) -> usize {
        self.inner.len()
    }

    pub fn points(&self) -> usize {
        self.points
    }

    /// By distance from 1, between points that are no ends.
    pub fn inner(&self) -> &[F] {
        &self.inner
    }

    /// By distance from 1, in the row of an end point.
    pub fn of_end(&self) -> &[F] {
        &self.of_end
    }

    /// By distance from 1, in the row of another point for the end point.
    pub fn to_end(&self) -> &[F] {
        &self.to_end
    }

    /// s_ij of two points 0…N−1; 0 beyond the horizon and for i = j.
    pub fn bond(&self, i: usize, j: usize) -> F {
        let end = |k: usize| k == 0 || k + 1 == self.points;
        let by_distance = match () {
            () if end(i) => &self.of_end,
            () if end(j) => &self.to_end,
            () => &self.inner,
        };
        let d = i.abs_diff(j);
        let found = d.checked_sub(1).and_then(|k| by_distance.get(k));
        found.cloned().unwrap_or_else(F::zero)
    }

    /// Points within the horizon of a point, itself included.
    fn family(&self, i: usize) -> std::ops::Range<usize> {
        i.saturating_sub(self.m())..(i + self.m() + 1).min(self.points)
    }

    /// S_ij; the diagonal is minus the sum of the bonds of its row.
    pub fn entry(&self, i: usize, j: usize) -> F {
        if i != j {
            return self.bond(i, j);
        }
        -self
            .family(i)
            .fold(F::zero(), |sum, k| sum + self.bond(i, k))
    }

    /// `(S u)_i = Σ_j s_ij (u_j − u_i)`.
    pub fn pull(&self, i: usize, u: &[F]) -> F {
        self.family(i).fold(F::zero(), |sum, j| {
            sum + self.bond(i, j) * (u[j].clone() - u[i].clone())
        })
    }
}

impl StiffnessMatrix<f64> {
    /// `S u`, fast.
    pub fn apply(&self, u: &[f64], out: &mut [f64]) {
        let (m, n) = (self.m(), self.points);
        // from point m+1 on, rows are those of an endless bar
        for i in (0..m).chain(n - m..n) {
            out[i] = self.pull(i, u);
        }
        for i in m..n - m {
            let (left, right) = (&u[i - m..i], &u[i + 1..=i + m]);
            let pairs = left.iter().rev().zip(right).zip(&self.inner);
            out[i] = pairs.fold(0.0, |t, ((a, b), s)| t + s * ((a - u[i]) + (b - u[i])));
        }
    }
}

/// The least number that makes all fractions whole.
pub(super) fn common_denominator<'a>(fractions: impl Iterator<Item = &'a Q>) -> BigInt {
    fractions.fold(BigInt::one(), |l, x| {
        // l/d in lowest terms leaves what d has more than l
        let more = Q::new(l.clone(), x.denom().clone());
        l * more.denom()
    })
}
