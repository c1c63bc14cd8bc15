//! What is kept of an evaluation of forces for those who asked before it.

use crate::interaction::PointEnergies;
use crate::run::Watched;

/// What shall be kept of the next evaluation, and what the last one left that was watched.
#[derive(Debug, Default)]
pub(in crate::run) struct Watch {
    asked: [bool; 3],
    pub energies: Option<PointEnergies>,
    /// Σ over pairs, xx yy zz xy xz yz (energy).
    pub virial: Option<[f64; 6]>,
    /// The same of each slot.
    pub virials: Option<Vec<[f64; 6]>>,
}

impl Watch {
    /// Of the next evaluation.
    pub fn ask(&mut self, what: Watched) {
        self.asked[what as usize] = true;
    }

    /// Is it asked for in the evaluation of now? Nobody asks twice.
    pub fn take(&mut self, what: Watched) -> bool {
        std::mem::take(&mut self.asked[what as usize])
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
