//! The equilibrium of a pulled bar by adaptive dynamic relaxation: motion with fictitious masses and a damping that follows
//! the slowest mode still moving (Underwood 1983; Kilic and Madenci 2010). Only where it ends means anything.

use super::{Bar, BarError};

/// Where the relaxation came to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Relaxed {
    /// Over Δσ/E, 0 in the middle.
    pub displacements: Vec<f64>,
    pub steps: usize,
    /// Largest residual of a point over the load of an end.
    pub residual: f64,
}

impl Bar {
    /// Relaxes from rest until no point's residual is more than `tolerance` of the load.
    ///
    /// # Errors
    /// Not at rest after `most` steps.
    pub fn relax(&self, tolerance: f64, most: usize) -> Result<Relaxed, BarError> {
        let (u, steps, residual) = self.relaxed(tolerance, most);
        if residual > tolerance {
            return Err(BarError::NotAtRest { steps, residual });
        }
        Ok(Relaxed {
            displacements: u,
            steps,
            residual,
        })
    }

    /// Displacements after exactly so many steps, converged or not, 0 in the middle.
    pub fn relaxing(&self, steps: usize) -> Vec<f64> {
        self.relaxed(0.0, steps).0
    }

    fn relaxed(&self, tolerance: f64, most: usize) -> (Vec<f64>, usize, f64) {
        let s = self.stiffness::<f64>();
        let n = self.points;
        let load: f64 = self.load();
        // Δt = 1 and masses of ¼ Σ_j |S_ij|, and some more, keep it stable
        let mass: Vec<f64> = (0..n).map(|i| -0.55 * s.entry(i, i)).collect();
        let mut u = vec![0.0; n];
        let mut v = vec![0.0; n];
        let mut force = vec![0.0; n];
        let mut before = vec![0.0; n];
        let mut step = 0;
        loop {
            s.apply(&u, &mut force);
            force[0] -= load;
            force[n - 1] += load;
            let residual = force.iter().fold(0.0f64, |r, f| r.max(f.abs())) / load;
            if residual <= tolerance || step >= most {
                let middle = 0.5 * (u[0] + u[n - 1]);
                u.iter_mut().for_each(|x| *x -= middle);
                return (u, step, residual);
            }
            let damping = if step == 0 {
                0.0
            } else {
                // Rayleigh's quotient with the tangent of each point along its last step
                let (mut up, mut down) = (0.0, 0.0);
                for i in 0..n {
                    if v[i] != 0.0 {
                        let tangent = (before[i] - force[i]) / (mass[i] * v[i]);
                        up += u[i] * u[i] * tangent;
                    }
                    down += u[i] * u[i];
                }
                let quotient: f64 = up / down;
                if quotient > 0.0 {
                    2.0 * quotient.sqrt().min(0.95)
                } else {
                    0.0
                }
            };
            for i in 0..n {
                let a = force[i] / mass[i];
                v[i] = if step == 0 {
                    0.5 * a
                } else {
                    ((2.0 - damping) * v[i] + 2.0 * a) / (2.0 + damping)
                };
                u[i] += v[i];
            }
            std::mem::swap(&mut before, &mut force);
            step += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Ends;
    use super::*;

    #[test]
    fn it_comes_to_rest_at_the_static_solution() {
        for (m, points) in [(1, 20), (3, 7), (2, 41), (4, 60)] {
            for ends in [Ends::Full, Ends::Half] {
                for homogenized in [false, true] {
                    let bar = Bar::new(m, points, ends, homogenized).unwrap();
                    let relaxed = bar.relax(1e-11, 100_000).unwrap();
                    let exact = bar.displacements::<f64>();
                    let pairs = relaxed.displacements.iter().zip(&exact);
                    let off = pairs.fold(0.0f64, |w, (a, b)| w.max((a - b).abs()));
                    assert!(off < 1e-8 * points as f64, "{bar:?}: {off}");
                }
            }
        }
    }

    /// What the paper's Fig. 3b shows for homogenized bars is this, and no property of the bar.
    #[test]
    fn states_on_the_way_depend_on_the_number_of_points() {
        let off = |points: usize| {
            let bar = Bar::new(3, points, Ends::Full, true).unwrap();
            let u = bar.relaxing(500);
            (u[points - 1] / (0.5 * (points - 1) as f64) - 1.0).abs()
        };
        assert!(off(20) < 1e-9 && off(1000) > 0.1);
    }

    #[test]
    fn too_few_steps_are_told() {
        let bar = Bar::new(2, 200, Ends::Full, false).unwrap();
        let told = bar.relax(1e-10, 20).unwrap_err();
        assert!(told.to_string().contains("not at rest after 20 steps"));
    }
}
