//! Symmetric band matrices and their factors LDLᵀ, over fractions or floating-point numbers.

use crate::exact::Field;

/// Diagonal and `width` diagonals above it, row by row.
#[derive(Debug, Clone)]
pub struct Banded<F> {
    width: usize,
    entries: Vec<F>,
}

impl<F: Field> Banded<F> {
    /// From the entries `(i, i), (i, i+1), …, (i, i+width)`; those beyond the last column are not asked for.
    pub fn from_rows(size: usize, width: usize, entry: impl Fn(usize, usize) -> F) -> Self {
        let mut entries = Vec::with_capacity(size * (width + 1));
        for i in 0..size {
            for j in i..=i + width {
                entries.push(if j < size { entry(i, j) } else { F::zero() });
            }
        }
        Banded { width, entries }
    }

    /// L and D without exchange of rows; `None` if a pivot is 0. Needs `size · width²` operations.
    pub fn factor(mut self) -> Option<Factored<F>> {
        let line = self.width + 1;
        let size = self.entries.len() / line;
        for i in 0..size {
            let (done, below) = self.entries.split_at_mut((i + 1) * line);
            let row = &mut done[i * line..];
            if row[0].is_zero() {
                return None;
            }
            for k in 1..line.min(size - i) {
                let l = row[k].clone() / row[0].clone();
                for j in k..line {
                    let e = &mut below[(k - 1) * line + j - k];
                    *e = e.clone() - l.clone() * row[j].clone();
                }
            }
            for k in 1..line {
                row[k] = row[k].clone() / row[0].clone();
            }
        }
        Some(Factored(self))
    }
}

/// `A = L D Lᵀ`.
#[derive(Debug, Clone)]
pub struct Factored<F>(Banded<F>);

impl<F: Field> Factored<F> {
    /// Turns b into the solution of `A x = b`.
    pub fn solve(&self, b: &mut [F]) {
        let line = self.0.width + 1;
        let row = |i: usize| &self.0.entries[i * line..(i + 1) * line];
        for i in 0..b.len() {
            for k in 1..line.min(b.len() - i) {
                b[i + k] = b[i + k].clone() - row(i)[k].clone() * b[i].clone();
            }
        }
        for i in (0..b.len()).rev() {
            let mut x = b[i].clone() / row(i)[0].clone();
            for k in 1..line.min(b.len() - i) {
                x = x - row(i)[k].clone() * b[i + k].clone();
            }
            b[i] = x;
        }
    }
}

impl Factored<f64> {
    /// Pivots below 0: as many as A has negative eigenvalues (Sylvester).
    pub fn negative(&self) -> usize {
        let pivots = self.0.entries.iter().step_by(self.0.width + 1);
        pivots.filter(|d| **d < 0.0).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    fn sample<F: Field>(i: usize, j: usize) -> F {
        F::ratio(if i == j { 9 + i as i64 } else { -2 }, 1 + (j - i) as i64)
    }

    /// A x.
    fn times<F: Field>(x: &[F]) -> Vec<F> {
        let n = x.len();
        let product = |i: usize| {
            let near = (i.saturating_sub(2)..n.min(i + 3))
                .map(|j| sample::<F>(i.min(j), i.max(j)) * x[j].clone());
            near.fold(F::zero(), |s, t| s + t)
        };
        (0..n).map(product).collect()
    }

    #[test]
    fn fractions_are_exact_and_floats_close() {
        let x: Vec<Q> = (0..9).map(|k| q(k * k - 5, k + 1)).collect();
        let factored = Banded::from_rows(9, 2, sample::<Q>).factor().unwrap();
        let mut b = times(&x);
        factored.solve(&mut b);
        assert_eq!(b, x);
        let y: Vec<f64> = x.iter().map(Field::value).collect();
        let mut b = times(&y);
        Banded::from_rows(9, 2, sample::<f64>)
            .factor()
            .unwrap()
            .solve(&mut b);
        assert!(b.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-14));
    }

    #[test]
    fn pivots_count_eigenvalues() {
        // second differences of five points: 2 − 2 cos(kπ/6)
        let below = |s: f64| {
            let entry = |i, j| if i == j { 2.0 - s } else { -1.0 };
            Banded::from_rows(5, 1, entry).factor().unwrap().negative()
        };
        assert_eq!(
            [0.2, 0.3, 1.1, 2.1, 3.1, 3.8].map(below),
            [0, 1, 2, 3, 4, 5]
        );
        assert!(Banded::from_rows(2, 0, |_, _| q(0, 1)).factor().is_none());
    }
}
