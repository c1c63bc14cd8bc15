//! LDLᵀ of a banded symmetric matrix: bars.

use super::SolveError;

/// The factors of a matrix of half-bandwidth w: `[n][w + 1]`, D in place 0, then L to the left.
#[derive(Debug, Clone)]
pub struct Banded {
    width: usize,
    rows: Vec<f64>,
}

impl Banded {
    /// `entry(i, j)` of `i − width ≤ j ≤ i`.
    ///
    /// # Errors
    /// A pivot that is not positive, with its row.
    pub fn factor(
        n: usize,
        width: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Result<Banded, SolveError> {
        let stride = width + 1;
        let mut rows = vec![0.0; n * stride];
        for i in 0..n {
            let low = i.saturating_sub(width);
            let original = entry(i, i);
            let mut pivot = original;
            for j in low..i {
                // L_ij d_j, then L_ij
                let mut sum = entry(i, j);
                for k in low.max(j.saturating_sub(width))..j {
                    sum -= rows[i * stride + i - k] * rows[j * stride + j - k] * rows[k * stride];
                }
                let l = sum / rows[j * stride];
                rows[i * stride + i - j] = l;
                pivot -= l * sum;
            }
            if !(pivot > 1e-14 * original) {
                return Err(SolveError::Indefinite { point: i });
            }
            rows[i * stride] = pivot;
        }
        Ok(Banded { width, rows })
    }

    pub fn solve(&self, x: &mut [f64]) {
        let (w, stride) = (self.width, self.width + 1);
        for i in 0..x.len() {
            for k in i.saturating_sub(w)..i {
                x[i] -= self.rows[i * stride + i - k] * x[k];
            }
        }
        for i in (0..x.len()).rev() {
            x[i] /= self.rows[i * stride];
            for k in i + 1..(i + w + 1).min(x.len()) {
                x[i] -= self.rows[k * stride + k - i] * x[k];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_of_springs_stretches_evenly() {
        // held at both sides by unit springs: −1 2 −1, and one of two apart
        let n = 50;
        let entry = |i: usize, j: usize| match i - j {
            0 => 4.0,
            1 => -1.0,
            2 => -0.5,
            _ => 0.0,
        };
        let a = |i: usize, j: usize| entry(i.max(j), i.min(j));
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut x: Vec<f64> = (0..n)
            .map(|i| (0..n).map(|j| a(i, j) * exact[j]).sum())
            .collect();
        Banded::factor(n, 2, entry).unwrap().solve(&mut x);
        assert!(x.iter().zip(&exact).all(|(x, e)| (x - e).abs() < 1e-14));
        let free = |i: usize, j: usize| match i - j {
            0 if i == 0 || i == 4 => 1.0,
            0 => 2.0,
            _ => -1.0,
        };
        let refused = Banded::factor(5, 1, free).unwrap_err();
        assert_eq!(refused, SolveError::Indefinite { point: 4 });
    }
}
