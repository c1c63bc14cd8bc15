//! Symmetric band matrices and their factors LDLᵀ, over fractions or floating-point numbers.

use num_traits::Num;

/// Diagonal and `width` diagonals above it, row by row.
#[derive(Debug, Clone)]
pub struct Banded<F> {
    width: usize,
    entries: Vec<F>,
}

impl<F: Num + Clone> Banded<F> {
    /// All entries 0.
    pub fn zeros(size: usize, width: usize) -> Self {
        Banded {
            width,
            entries: vec![F::zero(); size * (width + 1)],
        }
    }

    /// From the entries `(i, i), (i, i+1), …, (i, i+width)`; those beyond the last column are not asked for.
    pub fn from_rows(size: usize, width: usize, entry: impl Fn(usize, usize) -> F) -> Self {
        let mut made = Self::zeros(size, width);
        for i in 0..size {
            for j in i..size.min(i + width + 1) {
                made.entries[i * (width + 1) + j - i] = entry(i, j);
            }
        }
        made
    }

    /// Adds to the entry `(i, j)`, `i ≤ j ≤ i + width`.
    pub fn add(&mut self, i: usize, j: usize, value: F) {
        let e = &mut self.entries[i * (self.width + 1) + j - i];
        *e = e.clone() + value;
    }

    /// L and D without exchange of rows; `None` if a pivot is 0. Needs `size · width²` operations.
    pub fn factor(self) -> Option<Factored<F>> {
        self.factor_if(|pivot, _| !pivot.is_zero()).ok()
    }

    /// The same where every pivot passes, beside the diagonal entry that it began as.
    ///
    /// # Errors
    /// The row of the first pivot that does not.
    pub fn factor_if(mut self, pass: impl Fn(&F, &F) -> bool) -> Result<Factored<F>, usize> {
        let line = self.width + 1;
        let size = self.entries.len() / line;
        let diagonal: Vec<F> = self.entries.iter().step_by(line).cloned().collect();
        for i in 0..size {
            let (done, below) = self.entries.split_at_mut((i + 1) * line);
            let row = &mut done[i * line..];
            if !pass(&row[0], &diagonal[i]) {
                return Err(i);
            }
            for k in 1..line.min(size - i) {
                let l = row[k].clone() / row[0].clone();
                let next = &mut below[(k - 1) * line..][..line - k];
                for (e, r) in next.iter_mut().zip(&row[k..]) {
                    *e = e.clone() - l.clone() * r.clone();
                }
            }
            for k in 1..line {
                row[k] = row[k].clone() / row[0].clone();
            }
        }
        Ok(Factored(self))
    }
}

/// `A = L D Lᵀ`.
#[derive(Debug, Clone)]
pub struct Factored<F>(Banded<F>);

impl<F: Num + Clone> Factored<F> {
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
    use num_rational::Ratio;

    type Q = Ratio<i128>;

    /// `A x` of a matrix with two diagonals beside its own.
    fn times<F: Num + Clone>(entry: impl Fn(usize, usize) -> F, x: &[F]) -> Vec<F> {
        let n = x.len();
        let product = |i: usize| {
            let near = (i.saturating_sub(2)..n.min(i + 3))
                .map(|j| entry(i.min(j), i.max(j)) * x[j].clone());
            near.fold(F::zero(), |s, t| s + t)
        };
        (0..n).map(product).collect()
    }

    #[test]
    fn fractions_are_exact_and_floats_close() {
        let entry = |i: usize, j: usize| {
            let top = if i == j { 9 + (i % 3) as i128 } else { -2 };
            Q::new(top, 1 + (j - i) as i128)
        };
        let x: Vec<Q> = (0..9).map(|k| Q::new(k * k - 5, k + 1)).collect();
        let factored = Banded::from_rows(9, 2, entry).factor().unwrap();
        let mut b = times(entry, &x);
        factored.solve(&mut b);
        assert_eq!(b, x);
        let value = |q: &Q| *q.numer() as f64 / *q.denom() as f64;
        let close = |i, j| value(&entry(i, j));
        let y: Vec<f64> = x.iter().map(value).collect();
        let mut b = times(close, &y);
        let factored = Banded::from_rows(9, 2, close).factor().unwrap();
        factored.solve(&mut b);
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
        assert!(Banded::<f64>::zeros(2, 0).factor().is_none());
    }

    #[test]
    fn a_free_chain_is_refused_at_its_end() {
        let mut chain = Banded::zeros(5, 1);
        for i in 0..4 {
            chain.add(i, i, 1.0);
            chain.add(i + 1, i + 1, 1.0);
            chain.add(i, i + 1, -1.0);
        }
        let refused = chain.factor_if(|pivot, diagonal| *pivot > 1e-14 * diagonal);
        assert_eq!(refused.err(), Some(4));
    }
}
