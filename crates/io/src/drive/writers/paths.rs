//! Paths of rigid bodies, which the report tells of.

use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::frame_time;
use crate::drive::plan::DriveError;
use crate::write::run_json::RigidNote;

#[derive(Debug, Default)]
pub struct Paths {
    statics: Vec<RigidNote>,
    motion: Vec<RigidNote>,
}

impl Paths {
    /// Where bodies are at a time of the records, which only grows.
    fn push(&mut self, now: &mut Now<'_>) {
        let time = frame_time(now.sim);
        let placed = now.placed();
        let notes = match now.plan.begun(now.sim) {
            true => &mut self.motion,
            false => &mut self.statics,
        };
        for (n, body) in placed.iter().enumerate() {
            if notes.len() <= n {
                notes.push(RigidNote::of(&body.form));
            }
            notes[n].push(time, body);
        }
    }
}

impl Owner for Paths {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        for (name, notes) in [("statics", &mut self.statics), ("motion", &mut self.motion)] {
            archive.items(name, notes, RigidNote::default, |note, a| note.archive(a));
        }
    }
}

impl Writer for Paths {
    fn open(&mut self, _: &mut Now<'_>, _: bool) -> Result<(), DriveError> {
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(())
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        if now.due.row || now.due.frame || now.due.last {
            self.push(now);
        }
        Ok(())
    }

    fn end(mut self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError> {
        self.push(now);
        made.paths = self.statics.into_iter().chain(self.motion).collect();
        Ok(())
    }
}
