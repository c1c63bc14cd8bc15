//! What a run has done, which no state of now says any more.

use crate::execute::exact::Exact;
use crate::interaction::{Released, Tally};
use crate::observe::Ledger;
use crate::state::{Archive, Owner, words};

/// Work whose doer is gone, or keeps no account (energy).
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::run) struct Past {
    pub dissipated: f64,
    pub conditions: f64,
    pub rigid_bodies: f64,
}

words!([] Past { dissipated: f64, conditions: f64, rigid_bodies: f64 });

#[derive(Debug, Clone, Default)]
pub(in crate::run) struct Accounts {
    /// What sweeps of this rank's points did.
    pub swept: Tally,
    /// Beside that, what all points did together.
    pub released: Released,
    /// Cycles of load, where increments are these.
    pub cycles: f64,
    pub past: Past,
    /// Taken by the implicit method (energy).
    pub numerical: f64,
    /// Energy at the start; `None`: there was none yet.
    pub initial: Option<f64>,
}

impl Owner for Accounts {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.count("broken", &mut self.swept.broken);
        archive.part("lost", &mut self.swept.lost);
        archive.part("made", &mut self.swept.made);
        archive.part("dissipated", &mut self.swept.dissipated);
        archive.one("released", &mut self.released);
        archive.one("cycles", &mut self.cycles);
        archive.one("past_work", &mut self.past);
        archive.one("numerical", &mut self.numerical);
        archive.one("initial_energy", &mut self.initial);
    }
}

impl Accounts {
    /// Whoever did the work of now gives way to others, whose accounts begin at 0.
    pub fn pass(&mut self, now: &Ledger) {
        self.swept.dissipated = Exact::ZERO;
        self.past = Past {
            dissipated: now.dissipated,
            conditions: now.work_boundary_conditions,
            rigid_bodies: now.work_rigid_bodies,
        };
    }

    /// What the ledger of any state has of them, but for what was swept.
    pub fn ledger(&self) -> Ledger {
        Ledger {
            released: self.released.lost,
            made: self.released.made,
            dissipated: self.past.dissipated,
            numerical: self.numerical,
            work_boundary_conditions: self.past.conditions,
            work_rigid_bodies: self.past.rigid_bodies,
            initial: self.initial.unwrap_or(0.0),
            ..Ledger::default()
        }
    }
}
