//! The state of a system: what every step writes and the next one reads.

use super::System;
use crate::state::{Archive, Owner};

impl<const D: usize> Owner for System<D> {
    /// With velocities of the whole step.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("clock", &mut self.clock);
        archive.one("parts", &mut self.info.parts);
        archive.columns("displacement", &mut self.u);
        archive.columns("velocity", &mut self.v);
        archive.columns("force_density", &mut self.f);
        archive.given("inertia", &mut self.inertia, |inertia, archive| {
            archive.columns("push", &mut inertia.push);
            for taken in &mut inertia.taken {
                archive.columns("taken", taken);
            }
        });
        let body = &self.body;
        archive.within("bonds", |archive| self.interaction.archive(body, archive));
        archive.given("toughness", &mut self.toughness, |t, a| t.archive(a));
        archive.given("contact", &mut self.contact, |c, a| c.archive(a));
        self.applied.archive(archive);
        self.prescribed.archive(archive);
        archive.part("accounts", &mut self.accounts);
        archive.one("cut", &mut self.info.cut);
        archive.part("transfers", &mut self.transfers);
        if archive.loads() {
            self.restored();
        }
    }
}

impl<const D: usize> System<D> {
    /// What follows from a state that was read.
    fn restored(&mut self) {
        self.info.time_step = self.clock.dt_of_motion();
        self.stressed = None;
        self.look_again();
        if let Some(contact) = &mut self.contact {
            contact.find(&self.body, &self.u, self.interaction.as_ref());
        }
        for indenter in &mut self.applied.rigid {
            indenter.look_around(&self.body, &self.u);
        }
        self.break_transfers();
    }
}
