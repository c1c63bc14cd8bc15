//! (5.3) written down as it is printed, for comparison with the engine: its own sums, its own time stepper, one thread.

/// The Lennard-Jones chain of (5.3).
pub struct Paper {
    /// M
    pub neighbours: usize,
    /// Δx
    pub spacing: f64,
    /// ε̄
    pub epsilon: f64,
    /// σ̄⁶
    pub sigma6: f64,
}

impl Paper {
    /// Displacements after `steps` steps of velocity Verlet from rest, ρ = 1, ends free.
    pub fn displacements(&self, start: &[f64], dt: f64, steps: u64) -> Vec<f64> {
        let mut u = start.to_vec();
        let mut v = vec![0.0; u.len()];
        let mut f = self.forces(&u);
        for _ in 0..steps {
            for i in 0..u.len() {
                v[i] += 0.5 * dt * f[i];
                u[i] += dt * v[i];
            }
            f = self.forces(&u);
            for i in 0..u.len() {
                v[i] += 0.5 * dt * f[i];
            }
        }
        u
    }

    /// `−Σ_j 24ε̄ [2 (εσ̄)¹²/(j¹² Z_M(12) r¹³) − (εσ̄)⁶/(j⁶ Z_M(6) r⁷)]`, ε = jΔx, r = y(x + ε) − y(x).
    fn forces(&self, u: &[f64]) -> Vec<f64> {
        let z = |n: i32| -> f64 { (1..=self.neighbours).map(|j| (j as f64).powi(-n)).sum() };
        let (z12, z6) = (z(12), z(6));
        let m = self.neighbours as i64;
        (0..u.len() as i64)
            .map(|i| {
                let mut sum = 0.0;
                for j in (-m..=m).filter(|j| *j != 0) {
                    let Some(other) = usize::try_from(i + j).ok().and_then(|k| u.get(k)) else {
                        continue;
                    };
                    let e = j as f64 * self.spacing;
                    let r = e + other - u[i as usize];
                    let j = j as f64;
                    let s6 = e.powi(6) * self.sigma6;
                    sum -= 24.0
                        * self.epsilon
                        * (2.0 * s6 * s6 / (j.powi(12) * z12 * r.powi(13))
                            - s6 / (j.powi(6) * z6 * r.powi(7)));
                }
                sum
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_rest_nothing_moves_but_the_ends_and_waves_have_the_speed_one() {
        let chain = |neighbours, spacing| Paper {
            neighbours,
            spacing,
            epsilon: 1.0 / 72.0,
            sigma6: 0.5,
        };
        let f = chain(4, 1.0).forces(&[0.0; 30]);
        assert!(f[4..26].iter().all(|f| f.abs() < 1e-16));
        // the ends relax outwards: the nearest bond pushes more than the further ones pull
        assert!((f[0] + f[29]).abs() < 1e-15 && f[29] > 1e-3, "{}", f[29]);
        // u = ½ s x²: the force is ρc² s
        for (m, h) in [(4, 1.0), (2, 2.0), (1, 4.0)] {
            let u: Vec<f64> = (0..30)
                .map(|i| 0.5e-6 * (h * f64::from(i)).powi(2))
                .collect();
            let f = chain(m, h).forces(&u)[5];
            assert!((f / 1e-6 - 1.0).abs() < 2e-3, "{m}: {f}");
        }
    }
}
