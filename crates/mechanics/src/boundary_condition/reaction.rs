//! What a condition gives back.

use crate::body::Body;
use crate::execute::exact::Exact;
use crate::state::Archive;

/// What a condition had at the last force evaluation, in sums over points of *densities* (as LAMMPS prints them).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reaction {
    /// `Σ K (R − r)³ / 3` of an rigid_body.
    pub energy: f64,
    /// Of an rigid_body minus the sum of the force densities on the points; of a load the sum of the force densities on
    /// its points before it acted, without points that its list leaves alone.
    pub force: [f64; 3],
}

/// A reaction as it is added up over the points that are here.
#[derive(Debug, Clone, Default)]
pub struct ReactionSums {
    energy: Exact,
    force: [Exact; 3],
}

impl ReactionSums {
    pub fn add_energy(&mut self, energy: f64) {
        self.energy.add(energy);
    }

    pub fn add_force<const D: usize>(&mut self, force: [f64; D]) {
        { self.force.iter_mut().zip(force) }.for_each(|(sum, f)| sum.add(f));
    }

    /// Of the points of all ranks; all ask at once.
    pub fn value<const D: usize>(&self, body: &Body<D>) -> Reaction {
        let [x, y, z] = self.force.clone();
        let [energy, x, y, z] = body.sums([self.energy.clone(), x, y, z]);
        Reaction {
            energy,
            force: [x, y, z],
        }
    }

    pub fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.sum("energy", &mut self.energy);
        for force in &mut self.force {
            archive.sum("force", force);
        }
    }
}
