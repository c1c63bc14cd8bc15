//! The motion of a group as a whole: mass, centre, momentum, angular momentum, inertia. Masses are densities, as
//! everywhere in `peri` scripts.

/// Sums over a group of atoms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid {
    pub mass: f64,
    /// Centre of mass, of positions that are not wrapped.
    pub center: [f64; 3],
    /// Its velocity.
    pub velocity: [f64; 3],
    pub force: [f64; 3],
    /// About the centre.
    pub momentum: [f64; 3],
    pub torque: [f64; 3],
    /// About the centre, symmetric.
    pub inertia: [[f64; 3]; 3],
    /// Radius of gyration.
    pub gyration: f64,
    /// Σ mass v².
    pub square: f64,
}

impl Rigid {
    /// Angular velocity ω of `L = I ω`, of least length where the inertia has no inverse (atoms on a line).
    pub fn rotation(&self) -> [f64; 3] {
        let (values, axes) = principal(self.inertia);
        let largest = values.iter().copied().fold(0.0, f64::max);
        let mut omega = [0.0; 3];
        for (value, axis) in values.iter().zip(&axes) {
            if *value > 1e-14 * largest {
                let part: f64 = (0..3).map(|a| axis[a] * self.momentum[a]).sum();
                (0..3).for_each(|a| omega[a] += part / value * axis[a]);
            }
        }
        omega
    }
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, by Jacobi's rotations.
fn principal(mut m: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..50 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + libm::hypot(theta, 1.0));
            let c = libm::hypot(t, 1.0).recip();
            let s = t * c;
            for row in &mut m {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (m[p][k], m[q][k]) = (c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]);
                (axes[p][k], axes[q][k]) = (
                    c * axes[p][k] - s * axes[q][k],
                    s * axes[p][k] + c * axes[q][k],
                );
            }
            (m[p][q], m[q][p]) = (0.0, 0.0);
        }
    }
    ([m[0][0], m[1][1], m[2][2]], axes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_make_the_matrix_again() {
        let m = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 6.0]];
        let (values, axes) = principal(m);
        for a in 0..3 {
            for b in 0..3 {
                let again: f64 = (0..3).map(|k| values[k] * axes[k][a] * axes[k][b]).sum();
                assert!((again - m[a][b]).abs() < 1e-13, "{again} {}", m[a][b]);
            }
        }
    }
}
