//! Factors of sparse and banded matrices and eigenvalues of small ones: faer behind a small face. A crate of its own, because faer is
//! generic and slow to compile: here it is compiled once. The same bits for any number of threads.

// the same bits on every machine: libm, not that of C (clippy.toml)
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod banded;
mod plan;

use faer::linalg::cholesky::llt::factor::LltError as Pivot;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::solvers::{Llt, Lu};
use faer::sparse::linalg::{LltError, LuError};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

/// Why there are no factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FactorError {
    #[error("the pivot of row {row} is not positive")]
    NotPositive { row: usize },
    #[error("the matrix is singular")]
    Singular,
    #[error("the matrix does not fit into memory")]
    TooLarge,
}

/// A factored sparse matrix.
pub enum Factors {
    Symmetric(Box<Llt<usize, f64>>),
    General(Box<Lu<usize, f64>>),
}

fn matrix(
    n: usize,
    entries: &[(usize, usize, f64)],
) -> Result<SparseColMat<usize, f64>, FactorError> {
    let triplets: Vec<_> = entries
        .iter()
        .map(|(row, column, value)| Triplet::new(*row, *column, *value))
        .collect();
    SparseColMat::try_new_from_triplets(n, n, &triplets).map_err(|_| FactorError::TooLarge)
}

/// The order of the rows of a factor and where its numbers are, by the places of the matrix's entries alone.
fn symbolic(lower: &SparseColMat<usize, f64>) -> Result<SymbolicCholesky<usize>, FactorError> {
    let (order, how) = (SymmetricOrdering::Amd, CholeskySymbolicParams::default());
    factorize_symbolic_cholesky(lower.symbolic(), Side::Lower, order, how)
        .map_err(|_| FactorError::TooLarge)
}

/// The row of the matrix that pivot `index` of its factor belongs to: faer counts pivots in its own order, from 1 where it goes row by row.
fn row_of(lower: &SparseColMat<usize, f64>, index: usize) -> Option<usize> {
    let symbolic = symbolic(lower).ok()?;
    let pivot = match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(_) => index.checked_sub(1)?,
        SymbolicCholeskyRaw::Supernodal(_) => index,
    };
    match symbolic.perm() {
        Some(order) => order.arrays().0.get(pivot).copied(),
        None => Some(pivot),
    }
}

impl Factors {
    /// LLᵀ of a symmetric matrix of n rows; `entries` are (row, column, value) of the lower triangle, equal places add up.
    /// `room` is asked before: is there memory for so many bytes?
    ///
    /// # Errors
    /// A pivot that is not positive, by its row; no memory.
    pub fn symmetric(
        n: usize,
        entries: &[(usize, usize, f64)],
        room: impl Fn(f64) -> bool,
    ) -> Result<Factors, FactorError> {
        plan::fix();
        let matrix = matrix(n, entries)?;
        // where a full triangle would fit nothing needs to be counted
        if !room(4.0 * n as f64 * n as f64) && !room(8.0 * symbolic(&matrix)?.len_val() as f64) {
            return Err(FactorError::TooLarge);
        }
        let factors = matrix.sp_cholesky(Side::Lower);
        factors
            .map(|f| Factors::Symmetric(Box::new(f)))
            .map_err(|e| match e {
                LltError::Numeric(Pivot::NonPositivePivot { index }) => row_of(&matrix, index)
                    .map_or(FactorError::Singular, |row| FactorError::NotPositive {
                        row,
                    }),
                LltError::Generic(_) => FactorError::TooLarge,
            })
    }

    /// LU of any matrix.
    ///
    /// # Errors
    /// It is singular by where its entries are; no memory. One that is singular by their values gives solutions that are no numbers.
    pub fn general(n: usize, entries: &[(usize, usize, f64)]) -> Result<Factors, FactorError> {
        plan::fix();
        let factors = matrix(n, entries)?.sp_lu();
        factors
            .map(|f| Factors::General(Box::new(f)))
            .map_err(|e| match e {
                LuError::SymbolicSingular { .. } => FactorError::Singular,
                LuError::Generic(_) => FactorError::TooLarge,
            })
    }

    /// The solution takes the place of the right-hand side.
    pub fn solve(&self, rhs: &mut [f64]) {
        plan::fix();
        let column = Mat::from_fn(rhs.len(), 1, |i, _| rhs[i]);
        let x = match self {
            Factors::Symmetric(f) => f.solve(&column),
            Factors::General(f) => f.solve(&column),
        };
        for (i, r) in rhs.iter_mut().enumerate() {
            *r = x[(i, 0)];
        }
    }
}

/// Eigenvalues, ascending, and eigenvectors (one after the other) of a dense symmetric matrix, of which the lower triangle is
/// read; `None` if they are not found.
pub fn symmetric_eigen(
    n: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    plan::fix();
    let dense = Mat::from_fn(n, n, |i, j| if i >= j { entry(i, j) } else { 0.0 });
    let eigen = dense.self_adjoint_eigen(Side::Lower).ok()?;
    let values = (0..n).map(|k| eigen.S()[k]).collect();
    let vector = |k: usize| (0..n).map(|i| eigen.U()[(i, k)]).collect();
    Some((values, (0..n).map(vector).collect()))
}

/// Eigenvalues (real and imaginary parts) of a dense matrix of any kind, in no order; `None` if they are not found.
pub fn eigenvalues(n: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Vec<[f64; 2]>> {
    let dense = Mat::from_fn(n, n, entry);
    let values = dense.eigenvalues().ok()?;
    Some(values.iter().map(|z| [z.re, z.im]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOWER: [(usize, usize, f64); 5] = [
        (0, 0, 4.0),
        (1, 0, 1.0),
        (1, 1, 3.0),
        (2, 1, -1.0),
        (2, 2, 2.0),
    ];

    #[test]
    fn factors_solve() {
        let upper = LOWER.iter().filter(|e| e.0 != e.1).map(|e| (e.1, e.0, e.2));
        let all: Vec<_> = LOWER.iter().copied().chain(upper).collect();
        for factors in [
            Factors::symmetric(3, &LOWER, |_| true).unwrap(),
            Factors::general(3, &all).unwrap(),
        ] {
            // of (1, 2, 3)
            let mut x = vec![6.0, 4.0, 4.0];
            factors.solve(&mut x);
            for (x, exact) in x.iter().zip([1.0, 2.0, 3.0]) {
                assert!((x - exact).abs() < 1e-14);
            }
        }
        let refused = Factors::symmetric(2, &[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)], |_| true);
        assert!(matches!(refused, Err(FactorError::NotPositive { row: 1 })));
    }

    /// Second differences in a square of `n` by `n`, so stiff from place to place that every sum rounds; unsymmetric with `skew`.
    fn sheet(n: usize, skew: f64) -> Vec<(usize, usize, f64)> {
        let mut entries = vec![];
        let stiff = |i: usize| 1.0 + 0.3 * (i as f64 * 0.618).sin();
        for i in 0..n * n {
            entries.push((i, i, 12.0 * stiff(i)));
            for j in [i + 1, i + 2, i + n, i + n + 1] {
                if j < n * n {
                    entries.push((j, i, -0.7 * stiff(i)));
                    entries.push((i, j, (skew - 0.7) * stiff(i)));
                }
            }
        }
        entries
    }

    #[test]
    fn the_same_bits_on_any_number_of_threads() {
        let n = 70;
        let rhs: Vec<f64> = (0..n * n).map(|i| (i as f64).cos()).collect();
        let all = sheet(n, 0.2);
        let lower: Vec<_> = sheet(n, 0.0).into_iter().filter(|e| e.1 <= e.0).collect();
        let entry = |i: usize, j: usize| ((i * 31 + j * 17) as f64).sin();
        let bits = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let (mut x, mut y) = (rhs.clone(), rhs.clone());
                let symmetric = Factors::symmetric(n * n, &lower, |_| true);
                symmetric.unwrap().solve(&mut x);
                Factors::general(n * n, &all).unwrap().solve(&mut y);
                let (values, vectors) = symmetric_eigen(300, entry).unwrap();
                let numbers = x.iter().chain(&y).chain(&values);
                let numbers = numbers.chain(vectors.iter().flatten());
                numbers.map(|x| x.to_bits()).collect::<Vec<_>>()
            })
        };
        let one = bits(1);
        for threads in [2, 3, 4, 7] {
            assert!(bits(threads) == one, "{threads} threads");
        }
    }

    /// A bordered diagonal fills nothing in, a full matrix everything.
    #[test]
    fn factors_are_counted_before_they_are_made() {
        let n = 200;
        let arrow: Vec<_> = (0..n)
            .map(|i| (i, i, 4.0))
            .chain((1..n).map(|i| (i, 0, 0.1)))
            .collect();
        let full: Vec<_> = (0..n)
            .flat_map(|i| (0..=i).map(move |j| (i, j, if i == j { 400.0 } else { 1.0 })))
            .collect();
        for (entries, least, most) in [(arrow, 2 * n - 1, 16 * n), (full, n * (n + 1) / 2, n * n)] {
            let requests = std::cell::RefCell::new(vec![]);
            let none = Factors::symmetric(n, &entries, |bytes| {
                requests.borrow_mut().push(bytes);
                false
            });
            assert!(matches!(none, Err(FactorError::TooLarge)));
            let requests = requests.into_inner();
            assert_eq!(requests.len(), 2);
            let numbers = requests[1] / 8.0;
            assert!((least as f64..=most as f64).contains(&numbers), "{numbers}");
            assert!(Factors::symmetric(n, &entries, |bytes| bytes <= requests[1]).is_ok());
        }
    }

    #[test]
    fn eigenvalues_are_those_of_a_chain() {
        let n = 9;
        let entry = |i: usize, j: usize| match i - j {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        let (values, vectors) = symmetric_eigen(n, entry).unwrap();
        for (k, value) in values.iter().enumerate() {
            let angle = (k + 1) as f64 * std::f64::consts::PI / (n + 1) as f64;
            assert!((value - 2.0 + 2.0 * angle.cos()).abs() < 1e-13);
            assert!((vectors[k].iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn eigenvalues_of_a_circulant_are_roots_of_unity() {
        let n = 7;
        let values = eigenvalues(n, |i, j| f64::from((i + 1) % n == j)).unwrap();
        for k in 0..n {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / n as f64;
            let apart = |z: &[f64; 2]| (z[0] - angle.cos()).hypot(z[1] - angle.sin());
            assert!(values.iter().any(|z| apart(z) < 1e-13), "{values:?}");
        }
    }

    /// Chains, which are factored row by row, and full matrices, in blocks; with their rows in any order.
    #[test]
    fn the_row_of_a_pivot_that_is_not_positive_is_named() {
        for (n, near) in [(300, 1), (300, 299)] {
            let mixed = |i: usize| 7 * i % n;
            for bad in [0, 1, 150, 299] {
                let mut entries = vec![];
                for i in 0..n {
                    let own = if mixed(i) == bad { -1.0 } else { 1e3 };
                    entries.push((mixed(i), mixed(i), own));
                    for j in i.saturating_sub(near)..i {
                        let (r, c) = (mixed(i).max(mixed(j)), mixed(i).min(mixed(j)));
                        entries.push((r, c, 1e-3));
                    }
                }
                match Factors::symmetric(n, &entries, |_| true) {
                    Err(e) => assert_eq!(e, FactorError::NotPositive { row: bad }, "{near}"),
                    Ok(_) => panic!("{near}: row {bad} has a factor"),
                }
            }
        }
    }
}
