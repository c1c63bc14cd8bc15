//! Linear bodies about references in which bonds pull.

use crate::body::Body;
use crate::spec::LinearBody;
use crate::statics::Sums;

/// A linear body whose bonds pull in the reference.
pub struct Stressed<const D: usize> {
    /// E₀: of bonds, and of repulsion inside families.
    pub energy: [f64; 2],
    /// `[N]` f₀ (force density).
    pub forces: Vec<[f64; D]>,
    /// On the first rank.
    pub tangent: Option<LinearBody<D>>,
}

impl<const D: usize> Stressed<D> {
    /// `[N]` `f₀ − K u` (force density). All ranks ask at once.
    pub fn forces_at(&self, body: &Body<D>, u: &[[f64; D]]) -> Vec<[f64; D]> {
        let whole = body.whole(D, u.as_flattened().to_vec());
        let pulled = self.tangent.as_ref().zip(whole).map(|(tangent, u)| {
            let u = u.as_chunks().0;
            (0..u.len()).flat_map(|i| tangent.force(u, i)).collect()
        });
        let pulled = body.part_of(D, pulled);
        let both = self.forces.iter().zip(pulled.as_chunks::<D>().0);
        both.map(|(f, pulled)| crate::array::from_fn(|a| f[a] + pulled[a]))
            .collect()
    }

    pub fn energy_at(&self, body: &Body<D>, u: &[[f64; D]]) -> [f64; 2] {
        let forces = self.forces_at(body, u);
        let volume = body.by_id(|slot| body.volume().at(slot));
        // the mean of the forces here and there does the work of the way
        let [work] = Sums::of(body, body.slots()).each(u.len(), |i| {
            let each = (0..D).map(|a| 0.5 * (self.forces[i][a] + forces[i][a]) * u[i][a]);
            [volume[i] * each.sum::<f64>()]
        });
        let [bonds, repulsion] = self.energy;
        [bonds - work, repulsion]
    }
}
