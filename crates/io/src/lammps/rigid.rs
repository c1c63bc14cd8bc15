//! The motion of a group as a whole: mass, centre, momentum, angular momentum, inertia. Masses are densities, as
//! everywhere in `peri` scripts.

use super::atoms::Members;
use super::error::Result;
use super::fix::cross;
use super::host::Quantity;
use super::session::Session;

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
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = t.hypot(1.0).recip();
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

impl Session<'_> {
    /// Sums over the members.
    ///
    /// # Errors
    /// A quantity does not exist (yet).
    pub fn rigid(&self, members: &Members) -> Result<Rigid> {
        let n = self.count();
        let mass = self.raw(Quantity::Density)?;
        let x = self.unwrapped()?;
        let three = |q: fn(usize) -> Quantity| -> Result<[Vec<f64>; 3]> {
            Ok([self.raw(q(0))?, self.raw(q(1))?, self.raw(q(2))?])
        };
        let v = three(Quantity::Velocity)?;
        let f = three(Quantity::Force)?;
        let ids: Vec<usize> = (0..n).filter(|i| members.contains(*i)).collect();
        let mut sum = Rigid {
            mass: 0.0,
            center: [0.0; 3],
            velocity: [0.0; 3],
            force: [0.0; 3],
            momentum: [0.0; 3],
            torque: [0.0; 3],
            inertia: [[0.0; 3]; 3],
            gyration: 0.0,
            square: 0.0,
        };
        for &i in &ids {
            sum.mass += mass[i];
            for a in 0..3 {
                sum.center[a] += mass[i] * x[i][a];
                sum.velocity[a] += mass[i] * v[a][i];
                sum.force[a] += f[a][i];
                sum.square += mass[i] * v[a][i] * v[a][i];
            }
        }
        if sum.mass > 0.0 {
            sum.center = sum.center.map(|c| c / sum.mass);
            sum.velocity = sum.velocity.map(|c| c / sum.mass);
        }
        let mut square = 0.0;
        for &i in &ids {
            let d = [0, 1, 2].map(|a| x[i][a] - sum.center[a]);
            let l = cross(d, [0, 1, 2].map(|a| v[a][i]));
            let t = cross(d, [0, 1, 2].map(|a| f[a][i]));
            let dd: f64 = d.iter().map(|c| c * c).sum();
            square += mass[i] * dd;
            for a in 0..3 {
                sum.momentum[a] += mass[i] * l[a];
                sum.torque[a] += t[a];
                for b in 0..3 {
                    sum.inertia[a][b] -= mass[i] * d[a] * d[b];
                }
                sum.inertia[a][a] += mass[i] * dd;
            }
        }
        if sum.mass > 0.0 {
            sum.gyration = (square / sum.mass).sqrt();
        }
        Ok(sum)
    }

    /// Takes the motion of the members as a whole away: components of the velocity of their centre, and their rotation.
    ///
    /// # Errors
    /// Velocities cannot be set.
    pub fn take_motion(
        &mut self,
        members: &Members,
        linear: [bool; 3],
        angular: bool,
    ) -> Result<()> {
        let whole = self.rigid(members)?;
        let x = self.unwrapped()?;
        let omega = if angular { whole.rotation() } else { [0.0; 3] };
        for a in 0..3 {
            let mut v = self.raw(Quantity::Velocity(a))?;
            for i in (0..v.len()).filter(|i| members.contains(*i)) {
                let d = [0, 1, 2].map(|b| x[i][b] - whole.center[b]);
                if linear[a] {
                    v[i] -= whole.velocity[a];
                }
                if angular {
                    v[i] -= cross(omega, d)[a];
                }
            }
            self.store
                .particles_mut()
                .write(Quantity::Velocity(a), 0, &v)?;
        }
        Ok(())
    }
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
