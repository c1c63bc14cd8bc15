//! Linear bodies about references in which bonds pull.

use crate::spec::LinearBody;

/// A linear body whose bonds pull in the reference.
pub struct Stressed<const D: usize> {
    /// E₀: of bonds, and of repulsion inside families.
    pub energy: [f64; 2],
    /// `[N]` f₀ (force density).
    pub forces: Vec<[f64; D]>,
    pub tangent: LinearBody<D>,
}

impl<const D: usize> Stressed<D> {
    /// `[N]` `f₀ − K u` (force density).
    pub fn forces_at(&self, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let at = |i: usize| {
            let pulled = self.tangent.force(u, i);
            crate::array::from_fn(|a| self.forces[i][a] + pulled[a])
        };
        (0..u.len()).map(at).collect()
    }

    pub fn energy_at(&self, u: &[[f64; D]]) -> [f64; 2] {
        let forces = self.forces_at(u);
        // the mean of the forces here and there does the work of the way
        let work = |i: usize| {
            let each = (0..D).map(|a| 0.5 * (self.forces[i][a] + forces[i][a]) * u[i][a]);
            self.tangent.volume[i] * each.sum::<f64>()
        };
        let [bonds, repulsion] = self.energy;
        [bonds - (0..u.len()).map(work).sum::<f64>(), repulsion]
    }
}
