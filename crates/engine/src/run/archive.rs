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
        archive.one("stale", &mut self.stale);
        archive.option(
            "solved_before",
            &mut self.stages.before,
            Solved::default,
            |s, a| {
                a.one("solved", s);
            },
        );
        let (stepper, body) = (&mut self.stages.now, &self.system.body);
        archive.within("stepper", |archive| stepper.archive(body, archive));
        archive.part("system", &mut self.system);
    }
}

impl<const D: usize> Model<D> {
    /// The stage of now: those before it are left behind.
    fn stage(&mut self, archive: &mut Archive<'_>) {
        let mut coming = self.stages.coming.len() as u64;
        archive.one("stages_to_come", &mut coming);
        if !archive.loads() {
            return;
        }
        while self.stages.coming.len() as u64 > coming
            && let Some(next) = self.stages.coming.pop_front()
        {
            self.stages.take_over(&mut self.system, next);
        }
        if self.stages.coming.len() as u64 != coming {
            archive.refuse("stages_to_come");
        }
    }
}
