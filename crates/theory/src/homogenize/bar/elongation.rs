//! f(N), the elongation of a bar over that of a classical one, as a fraction.
//!
//! The equations of [`super::strain`] are a recurrence: row a of G gives the strain of interspace a+m−1 from those before, so
//! that the first m−1 strains say all others, and the last m−1 rows say what they are. In whole numbers this needs
//! products of a long number with a short one only, N m² of them, and one small system of long numbers at the end.

use super::stiffness_matrix::{StiffnessMatrix, common_denominator};
use super::{Bar, Ends};
use crate::exact::{Field, Q};
use num_bigint::BigInt;
use num_traits::{One, Zero};
use std::collections::VecDeque;

/// A strain as a whole-number combination of the first m−1 strains and the force, over a common scale.
type Combination = Vec<BigInt>;

/// Sums of strains in unit force m²/2, over a common denominator.
struct Sums {
    all: BigInt,
    /// Of the first m.
    first: BigInt,
    denominator: BigInt,
}

impl Bar {
    /// f(N): the elongation over `(N−1)Δ σ/E`, for any m and N.
    pub fn f(&self) -> Q {
        let Sums {
            all,
            first,
            denominator,
        } = self.sums();
        let length = BigInt::from(self.points - 1);
        match self.ends {
            Ends::Full => Q::new(all, denominator * length),
            Ends::Half => {
                // the end row is 2F − (1/2m) Σ of the first m strains, and must be m²: see `limit`
                let cube = BigInt::from(2 * self.m) * BigInt::from(self.m * self.m);
                let end = &cube * denominator - first;
                Q::new(all * cube, end * length)
            }
        }
    }

    /// The rows of G that are not those of an endless bar, of one end, and one that is.
    fn distinct_rows(&self, s: &StiffnessMatrix<Q>) -> Vec<Vec<Q>> {
        let m = self.m;
        let row = |a: usize| (0..a + m).map(|b| s.cut(a, b)).collect();
        (0..m).map(row).collect()
    }

    fn sums(&self) -> Sums {
        let m = self.m;
        let rows = self.distinct_rows(&self.stiffness());
        let force: Q = self.unit_force();
        let uniform = |row: &Vec<Q>| row.iter().fold(Q::zero(), |t, c| t + c) == force;
        if rows.iter().all(uniform) {
            return Sums {
                all: BigInt::from(self.points - 1),
                first: BigInt::from(m),
                denominator: BigInt::one(),
            };
        }
        // 2m G in whole numbers; the coefficient of the newest strain is that of the longest bond, 1/2m, and becomes q
        let twice = Q::whole(2 * m as i64);
        let scaled = |row: &Vec<Q>| row.iter().map(|c| c * &twice).collect::<Vec<Q>>();
        let rows: Vec<Vec<Q>> = rows.iter().map(scaled).collect();
        let q = common_denominator(rows.iter().flatten());
        let whole = |row: &Vec<Q>| -> Vec<BigInt> {
            row.iter()
                .map(|c| (c * Q::from_integer(q.clone())).to_integer())
                .collect()
        };
        let rows: Vec<Vec<BigInt>> = rows.iter().map(whole).collect();
        let force = &q * BigInt::from(m) * BigInt::from(m * m);
        self.shoot(&rows, &q, &force)
    }

    /// `rows` of one end and force, times 2mq.
    fn shoot(&self, rows: &[Vec<BigInt>], q: &BigInt, force: &BigInt) -> Sums {
        let m = self.m;
        let zero = || vec![BigInt::zero(); m];
        let mut scale = BigInt::one();
        let mut sum = zero();
        // strains of interspaces a−m+1 … a+m−2
        let mut window: VecDeque<Combination> = vec![zero(); m - 1].into();
        for k in 0..m - 1 {
            let mut one = zero();
            one[k] = BigInt::one();
            sum[k] = BigInt::one();
            window.push_back(one);
        }
        for a in 0..self.points - m {
            let row = &rows[a.min(m - 1)];
            // a short row begins at interspace 0
            let before = &row[..row.len() - 1];
            let skip = window.len() - before.len();
            let mut next = zero();
            for (c, e) in before.iter().zip(window.range(skip..)) {
                for (n, x) in next.iter_mut().zip(e) {
                    *n -= c * x;
                }
            }
            next[m - 1] += force * &scale;
            for x in window.iter_mut().chain([&mut sum]).flatten() {
                *x *= q;
            }
            scale *= q;
            for (s, n) in sum.iter_mut().zip(&next) {
                *s += n;
            }
            window.push_back(next);
            window.pop_front();
        }
        // the other end's rows, from the last one, mirrored
        let mut system: Vec<Combination> = vec![];
        for row in rows[..m - 1].iter().rev() {
            let mut equation = zero();
            for (c, e) in row.iter().zip(window.iter().rev()) {
                for (n, x) in equation.iter_mut().zip(e) {
                    *n += c * x;
                }
            }
            equation[m - 1] = force * &scale - &equation[m - 1];
            system.push(equation);
        }
        let (first, determinant) = solve(system);
        let mut all = &sum[m - 1] * &determinant;
        for (s, x) in sum.iter().zip(&first) {
            all += s * x;
        }
        // strain m of row 1, times q
        let mut last = force * &determinant;
        for (c, x) in rows[0].iter().zip(&first) {
            last -= c * x;
        }
        let firsts = first.iter().fold(BigInt::zero(), |s, x| s + x);
        Sums {
            all: all * q,
            first: (firsts * q + last) * &scale,
            denominator: determinant * scale * q,
        }
    }
}

/// Numerators and common denominator of the solution of n equations in whole numbers, right-hand side last: Bareiss's
/// elimination, in which all divisions leave no remainder.
fn solve(mut rows: Vec<Vec<BigInt>>) -> (Vec<BigInt>, BigInt) {
    let n = rows.len();
    let mut previous = BigInt::one();
    for k in 0..n {
        // some row has it: strains exist and are unique
        if let Some(other) = (k..n).find(|r| !rows[*r][k].is_zero()) {
            rows.swap(k, other);
        }
        let pivot = rows[k].clone();
        for r in (0..n).filter(|r| *r != k) {
            let factor = rows[r][k].clone();
            for c in 0..=n {
                rows[r][c] = (&rows[r][c] * &pivot[k] - &factor * &pivot[c]) / &previous;
            }
        }
        previous = pivot[k].clone();
    }
    (
        rows.into_iter().filter_map(|mut r| r.pop()).collect(),
        previous,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::q;

    fn bar(m: usize, points: usize, ends: Ends, homogenized: bool) -> Bar {
        Bar::new(m, points, ends, homogenized).unwrap()
    }

    #[test]
    fn table_1_at_finite_n() {
        let f = |m, n, ends| bar(m, n, ends, false).f();
        assert_eq!(f(2, 5, Ends::Half), q(2, 1));
        assert_eq!(f(3, 7, Ends::Half), q(126, 55));
        assert_eq!(f(2, 5, Ends::Full), q(20, 17));
        assert_eq!(f(3, 7, Ends::Full), q(981, 718));
        let four = [Ends::Half, Ends::Full].map(|ends| f(4, 9, ends));
        assert_eq!((four[0].value() * 1e3).round(), 2592.0);
        assert_eq!((four[1].value() * 1e4).round(), 15447.0);
        // the paper calls them ratios of ten-digit numbers
        assert!(
            four.iter()
                .all(|f| f.denom() < &BigInt::from(1_000_000_000)),
            "{four:?}"
        );
    }

    #[test]
    fn homogenized_bars_are_constant() {
        for m in 2..=12usize {
            let square = (m * m) as i64;
            for n in [2 * m + 1, 2 * m + 2, 50, 1_000_000] {
                assert_eq!(bar(m, n, Ends::Full, true).f(), q(1, 1));
                let half = q(2 * square, 2 * square - 1);
                assert_eq!(bar(m, n, Ends::Half, true).f(), half);
                if n <= 50 {
                    assert_eq!(bar(m, n, Ends::Half, true).f_by_strains::<Q>(), half);
                }
            }
        }
        // as printed: 8/7, 18/17, 1.0323
        assert_eq!(bar(2, 9, Ends::Half, true).f(), q(8, 7));
        assert_eq!(bar(3, 9, Ends::Half, true).f(), q(18, 17));
        assert_eq!(bar(4, 9, Ends::Half, true).f(), q(32, 31));
    }

    #[test]
    fn shooting_is_solving() {
        for m in 1..=6 {
            for n in [2 * m + 1, 2 * m + 2, 2 * m + 3, 4 * m + 1, 31] {
                for ends in [Ends::Full, Ends::Half] {
                    let bar = bar(m, n, ends, false);
                    assert_eq!(bar.f(), bar.f_by_strains::<Q>(), "{bar:?}");
                    let close = bar.f().value() - bar.f_by_strains::<f64>();
                    assert!(close.abs() < 1e-13, "{bar:?}: {close}");
                }
            }
        }
    }

    /// What f(N) is by eliminating two equations by hand: m = 1 is the classical bar, whose half-weight ends yield too much.
    #[test]
    fn nearest_neighbours_are_classical() {
        assert_eq!(bar(1, 3, Ends::Full, false).f(), q(1, 1));
        assert_eq!(bar(1, 40, Ends::Half, false).f(), q(2, 1));
    }
}
