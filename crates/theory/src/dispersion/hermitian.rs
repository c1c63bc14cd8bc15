//! Small Hermitian matrices: eigenvalues and eigenvectors by Jacobi's rotations.

use num_complex::Complex64;

/// A square complex matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    n: usize,
    a: Vec<Complex64>,
}

impl Matrix {
    pub fn zero(n: usize) -> Self {
        Matrix {
            n,
            a: vec![Complex64::ZERO; n * n],
        }
    }

    pub fn size(&self) -> usize {
        self.n
    }

    pub fn get(&self, i: usize, j: usize) -> Complex64 {
        self.a[i * self.n + j]
    }

    pub fn add(&mut self, i: usize, j: usize, x: Complex64) {
        self.a[i * self.n + j] += x;
    }

    pub fn scale(&mut self, i: usize, j: usize, x: f64) {
        self.a[i * self.n + j] *= x;
    }

    /// `v† A w`
    pub fn between(&self, v: &[Complex64], w: &[Complex64]) -> Complex64 {
        let row = |i: usize| -> Complex64 { (0..self.n).map(|j| self.get(i, j) * w[j]).sum() };
        (0..self.n).map(|i| v[i].conj() * row(i)).sum()
    }

    /// `v† A v` of a Hermitian matrix.
    pub fn expectation(&self, v: &[Complex64]) -> f64 {
        self.between(v, v).re
    }
}

/// Eigenvalues, rising, and unit eigenvectors of a Hermitian matrix (its upper half is read).
pub fn eigen(matrix: &Matrix) -> (Vec<f64>, Vec<Vec<Complex64>>) {
    let n = matrix.n;
    let mut a = matrix.clone();
    let mut v = Matrix::zero(n);
    for i in 0..n {
        v.add(i, i, Complex64::ONE);
        for j in 0..i {
            a.a[i * n + j] = matrix.get(j, i).conj();
        }
        a.a[i * n + i].im = 0.0;
    }
    let size: f64 = a.a.iter().map(|x| x.norm_sqr()).sum();
    // quadratic convergence: 6 or 7 sweeps for any size met here
    for _ in 0..50 {
        let mut rest = 0.0;
        for p in 0..n {
            for q in p + 1..n {
                rest += a.get(p, q).norm_sqr();
                rotate(&mut a, &mut v, p, q);
            }
        }
        if rest <= 1e-32 * size {
            break;
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|i, j| a.get(*i, *i).re.total_cmp(&a.get(*j, *j).re));
    (
        order.iter().map(|i| a.get(*i, *i).re).collect(),
        order
            .iter()
            .map(|i| (0..n).map(|r| v.get(r, *i)).collect())
            .collect(),
    )
}

/// Make `a_pq` vanish: a phase that makes it real, then a plane rotation.
fn rotate(a: &mut Matrix, v: &mut Matrix, p: usize, q: usize) {
    let n = a.n;
    let c = a.get(p, q);
    let size = c.norm();
    if size == 0.0 {
        return;
    }
    let phase = c / size;
    let theta = (a.get(q, q).re - a.get(p, p).re) / (2.0 * size);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let cos = 1.0 / (t * t + 1.0).sqrt();
    let sin = t * cos;
    // columns p, q times [[cos, sin], [−sin·phase*, cos·phase*]]
    for m in [&mut *a, &mut *v] {
        for r in 0..n {
            let (x, y) = (m.get(r, p), m.get(r, q) * phase.conj());
            m.a[r * n + p] = x * cos - y * sin;
            m.a[r * n + q] = x * sin + y * cos;
        }
    }
    for r in 0..n {
        let (x, y) = (a.get(p, r), a.get(q, r) * phase);
        a.a[p * n + r] = x * cos - y * sin;
        a.a[q * n + r] = x * sin + y * cos;
    }
    a.a[p * n + q] = Complex64::ZERO;
    a.a[q * n + p] = Complex64::ZERO;
    a.a[p * n + p].im = 0.0;
    a.a[q * n + q].im = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(n: usize, seed: u64) -> Matrix {
        let mut s = seed;
        let mut next = || {
            s = s
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (s >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut m = Matrix::zero(n);
        for i in 0..n {
            m.add(i, i, next().into());
            for j in i + 1..n {
                let c = Complex64::new(next(), next());
                m.add(i, j, c);
                m.add(j, i, c.conj());
            }
        }
        m
    }

    #[test]
    fn a_matrix_is_its_spectrum() {
        for n in [1, 2, 3, 6, 12, 24] {
            let m = sample(n, n as u64);
            let (values, vectors) = eigen(&m);
            assert!(values.is_sorted());
            for i in 0..n {
                for j in 0..n {
                    let overlap: Complex64 =
                        (0..n).map(|r| vectors[i][r].conj() * vectors[j][r]).sum();
                    let image = m.between(&vectors[i], &vectors[j]);
                    let one = if i == j { 1.0 } else { 0.0 };
                    assert!((overlap - one).norm() < 1e-13, "{n}");
                    assert!((image - values[i] * one).norm() < 1e-13, "{n}");
                }
            }
        }
    }

    #[test]
    fn degenerate_values_keep_orthogonal_vectors() {
        let mut m = Matrix::zero(4);
        for i in 0..4 {
            for j in 0..4 {
                m.add(i, j, Complex64::ONE);
            }
        }
        let (values, vectors) = eigen(&m);
        assert!(values[2].abs() < 1e-15 && (values[3] - 4.0).abs() < 1e-14);
        let overlap: Complex64 = (0..4).map(|r| vectors[0][r].conj() * vectors[1][r]).sum();
        assert!(overlap.norm() < 1e-15);
    }
}
