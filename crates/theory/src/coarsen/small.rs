//! Symmetric systems of a few unknowns that may be singular.

/// Solves `g x = b` for a positive semidefinite `g` (row by row); what the matrix does not hold is 0.
pub(super) fn solve_semidefinite(mut g: Vec<f64>, b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let trace: f64 = (0..n).map(|k| g[k * n + k]).sum();
    let mut held = vec![false; n];
    // Cholesky in place, rows whose pivot vanishes left out
    for k in 0..n {
        let pivot = (0..k).fold(g[k * n + k], |d, m| d - g[k * n + m] * g[k * n + m]);
        held[k] = pivot > 1e-10 * trace;
        let root = if held[k] { pivot.sqrt() } else { 0.0 };
        g[k * n + k] = root;
        for i in k + 1..n {
            let sum = (0..k).fold(g[i * n + k], |s, m| s - g[i * n + m] * g[k * n + m]);
            g[i * n + k] = if held[k] { sum / root } else { 0.0 };
        }
    }
    let mut x = b.to_vec();
    for k in 0..n {
        let sum = (0..k).fold(x[k], |s, m| s - g[k * n + m] * x[m]);
        x[k] = if held[k] { sum / g[k * n + k] } else { 0.0 };
    }
    for k in (0..n).rev() {
        let sum = (k + 1..n).fold(x[k], |s, m| s - g[m * n + k] * x[m]);
        x[k] = if held[k] { sum / g[k * n + k] } else { 0.0 };
    }
    x
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
