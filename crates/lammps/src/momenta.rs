//! Momentum, torque and inertia of a group, for what a group does as if it were rigid.

use crate::atoms::Members;
use crate::error::Result;
use crate::host::Quantity;
use crate::rigid::Rigid;
use crate::session::Session;
use crate::vector::cross;

impl Session<'_> {
    /// Sums over the members.
    ///
    /// # Errors
    /// A quantity does not exist (yet).
    pub fn rigid(&self, members: &Members) -> Result<Rigid> {
        let n = self.population.count();
        let mass = self.population.raw(Quantity::Density)?;
        let x = self.population.unwrapped()?;
        let three = |q: fn(usize) -> Quantity| -> Result<[Vec<f64>; 3]> {
            Ok([
                self.population.raw(q(0))?,
                self.population.raw(q(1))?,
                self.population.raw(q(2))?,
            ])
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
        let x = self.population.unwrapped()?;
        let omega = if angular { whole.rotation() } else { [0.0; 3] };
        for a in 0..3 {
            let mut v = self.population.raw(Quantity::Velocity(a))?;
            for i in (0..v.len()).filter(|i| members.contains(*i)) {
                let d = [0, 1, 2].map(|b| x[i][b] - whole.center[b]);
                if linear[a] {
                    v[i] -= whole.velocity[a];
                }
                if angular {
                    v[i] -= cross(omega, d)[a];
                }
            }
            self.population
                .store
                .particles_mut()
                .write(Quantity::Velocity(a), 0, &v)?;
        }
        Ok(())
    }
}
