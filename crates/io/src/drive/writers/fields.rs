//! Continuum fields of the running model.

use std::time::Instant;

use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::continuum::run::RunningFields;
use crate::drive::plan::DriveError;

#[derive(Default)]
pub struct LiveFields {
    running: Option<RunningFields>,
}

impl Owner for LiveFields {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.given("running", &mut self.running, |fields, a| fields.archive(a));
    }
}

impl Writer for LiveFields {
    fn open(&mut self, now: &mut Now<'_>, _: bool) -> Result<(), DriveError> {
        if let Some(asked) = &now.plan.continuum {
            self.running = Some(RunningFields::new(now.sim, asked, &now.plan.dir)?);
        }
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(self
            .running
            .as_mut()
            .map_or(Ok(()), RunningFields::rewind)?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let Some(running) = &mut self.running else {
            return Ok(());
        };
        let begun = Instant::now();
        let said = match now.due.last {
            true => running.look_last(now.sim)?,
            false => running.look(now.sim, now.due.step)?,
        };
        said.into_iter().for_each(|text| now.warn(text));
        now.spent.fields += begun.elapsed().as_secs_f64();
        Ok(())
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, made: &mut Made) -> Result<(), DriveError> {
        if let Some(running) = self.running {
            let begun = Instant::now();
            now.progress.phase("fields");
            made.slices = running.finish(now.hurried)?;
            now.spent.fields += begun.elapsed().as_secs_f64();
        }
        Ok(())
    }
}
