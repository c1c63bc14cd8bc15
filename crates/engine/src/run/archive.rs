//! The state of a model as a whole: what every step writes and the next one reads.

use super::model::Model;
use crate::state::{Archive, Owner};
use crate::statics::Solved;

impl<const D: usize> Owner for Model<D> {
    /// Velocities are those of the whole step. A model of the same specification that read this goes on as the one that wrote it, bit for
    /// bit; it is not [started](super::Simulation::start).
    fn archive(&mut self, archive: &mut Archive<'_>) {
        self.finish();
        self.stage(archive);
        archive.part("clock", &mut self.clock);
        archive.one("parts", &mut self.info.parts);
        archive.one("path", &mut self.fastest);
        archive.one("stale", &mut self.stale);
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
        archive.option("loaded", &mut self.loaded, Solved::default, |s, a| {
            a.one("solved", s);
        });
        archive.part("transfers", &mut self.transfers);
        let (body, slots) = (&self.body, self.body.len);
        archive.given("statics", &mut self.statics, |s, a| s.archive(slots, a));
        archive.given("implicit", &mut self.implicit, |i, a| i.archive(body, a));
        if archive.loads() {
            self.restored();
        }
    }
}

impl<const D: usize> Model<D> {
    /// Statics before motion, or the motion itself.
    fn stage(&mut self, archive: &mut Archive<'_>) {
        let mut waits = self.preload.is_some();
        archive.one("motion_waits", &mut waits);
        if !archive.loads() {
            return;
        }
        match (waits, self.preload.take()) {
            (false, Some(preload)) => {
                self.statics = None;
                self.take_over(preload);
            }
            (true, None) => archive.refuse("motion_waits"),
            (_, preload) => self.preload = preload,
        }
    }

    /// What follows from a state that was read.
    fn restored(&mut self) {
        self.info.time_step = self.clock.dt_of_motion();
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
