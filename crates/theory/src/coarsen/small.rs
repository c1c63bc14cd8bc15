//! Symmetric systems of a few unknowns that may be singular.

/// Cholesky's factor of a positive semidefinite matrix; rows whose pivot vanishes are left out.
pub(super) struct Semidefinite {
    /// Row by row, below the diagonal.
    l: Vec<f64>,
    held: Vec<bool>,
}

impl Semidefinite {
    /// Of an n×n matrix, row by row.
    pub fn new(mut g: Vec<f64>, n: usize) -> Semidefinite {
        let trace: f64 = (0..n).map(|k| g[k * n + k]).sum();
        let mut held = vec![false; n];
        for i in 0..n {
            // what lies above row i is finished
            let (above, row) = g.split_at_mut(i * n);
            for k in 0..i {
                let other = &above[k * n..k * n + k];
                let sum = (row[..k].iter().zip(other)).fold(row[k], |s, (x, y)| s - x * y);
                row[k] = if held[k] { sum / above[k * n + k] } else { 0.0 };
            }
            let pivot = row[..i].iter().fold(row[i], |d, x| d - x * x);
            held[i] = pivot > 1e-10 * trace;
            row[i] = if held[i] { pivot.sqrt() } else { 0.0 };
        }
        Semidefinite { l: g, held }
    }

    /// Are all rows held?
    pub fn definite(&self) -> bool {
        self.held.iter().all(|held| *held)
    }

    /// Solves `g x = b`; what the matrix does not hold is 0.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let (n, l) = (b.len(), &self.l);
        let mut x = b.to_vec();
        for k in 0..n {
            let sum = (0..k).fold(x[k], |s, m| s - l[k * n + m] * x[m]);
            x[k] = if self.held[k] {
                sum / l[k * n + k]
            } else {
                0.0
            };
        }
        for k in (0..n).rev() {
            let sum = (k + 1..n).fold(x[k], |s, m| s - l[m * n + k] * x[m]);
            x[k] = if self.held[k] {
                sum / l[k * n + k]
            } else {
                0.0
            };
        }
        x
    }
}

/// Solves `g x = b` for a positive semidefinite `g` (row by row); what the matrix does not hold is 0.
pub(super) fn solve_semidefinite(g: Vec<f64>, b: &[f64]) -> Vec<f64> {
    Semidefinite::new(g, b.len()).solve(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_systems_are_solved_where_they_can_be() {
        let x = solve_semidefinite(vec![4.0, 2.0, 2.0, 3.0], &[2.0, 5.0]);
        assert!(
            (x[0] + 0.5).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15,
            "{x:?}"
        );
        // (1, 1) ⊗ (1, 1)
        let x = solve_semidefinite(vec![1.0, 1.0, 1.0, 1.0], &[3.0, 3.0]);
        assert_eq!(x, [3.0, 0.0]);
    }
}
