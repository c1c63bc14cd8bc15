//! The state of a system: what every step writes and the next one reads.

use super::System;
use crate::state::{Archive, Owner};

impl<const D: usize> Owner for System<D> {
    /// With velocities of the whole step.
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.part("clock", &mut self.clock);
        archive.one("parts", &mut self.info.parts);
        let body = &self.body;
        body.archive_field(archive, "displacement", &mut self.u);
        body.archive_field(archive, "velocity", &mut self.v);
        body.archive_field(archive, "force_density", &mut self.f);
        archive.given("inertia", &mut self.inertia, |inertia, archive| {
            body.archive_field(archive, "push", &mut inertia.push);
            for taken in &mut inertia.taken {
                body.archive_field(archive, "taken", taken);
            }
        });
        archive.within("bonds", |archive| self.interaction.archive(body, archive));
        archive.given("toughness", &mut self.toughness, |t, a| {
            t.archive(body, a);
        });
        archive.given("contact", &mut self.contact, |c, a| {
            c.archive(&self.body, a)
        });
        self.applied.archive(body, archive);
        self.prescribed.archive(body, archive);
        archive.part("accounts", &mut self.accounts);
        archive.one("cut", &mut self.info.cut);
        archive.within("transfers", |archive| {
            self.diffusions.archive(body, archive)
        });
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
        self.refresh_images();
        self.invalidate_neighbours();
        if let Some(contact) = &mut self.contact {
            contact.find(&self.body, &self.u, self.interaction.as_ref());
        }
        for rigid_body in &mut self.applied.rigid {
            rigid_body.look_around(&self.body, &self.u);
        }
        self.break_diffusions();
    }
}
