//! What is kept of an evaluation of forces for those who asked before it.

use crate::interaction::PointEnergies;

/// What shall be kept of the next evaluation, and what the last one left that was watched.
#[derive(Debug, Default)]
pub(in crate::run) struct Watch {
    energies_next: bool,
    pub energies: Option<PointEnergies>,
    virial_next: bool,
    /// Σ over pairs, xx yy zz xy xz yz (energy).
    pub virial: Option<[f64; 6]>,
    virials_next: bool,
    /// The same of each slot.
    pub virials: Option<Vec<[f64; 6]>>,
}

impl Watch {
    pub fn energies_next(&mut self) {
        self.energies_next = true;
    }

    pub fn virial_next(&mut self) {
        self.virial_next = true;
    }

    pub fn virials_next(&mut self) {
        self.virials_next = true;
    }

    /// An evaluation begins: room for energies where these are asked for.
    pub fn room(&mut self) -> Option<PointEnergies> {
        let last = self.energies.take();
        std::mem::take(&mut self.energies_next).then(|| last.unwrap_or_default())
    }

    /// Is the virial of this evaluation asked for? Asked once.
    pub fn wants_virial(&mut self) -> bool {
        std::mem::take(&mut self.virial_next)
    }

    /// The same of the virials of points.
    pub fn wants_virials(&mut self) -> bool {
        std::mem::take(&mut self.virials_next)
    }

    /// Points are elsewhere now.
    pub fn forget_virials(&mut self) {
        self.virial = None;
        self.virials = None;
    }

    /// There are other points now.
    pub fn forget(&mut self) {
        self.energies = None;
        self.forget_virials();
    }
}
