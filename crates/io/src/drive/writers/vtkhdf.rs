//! Frames in one VTKHDF file.

use std::path::PathBuf;

use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::plan::DriveError;
use crate::write::vtkhdf::VtkHdf;

/// Frames of a run.
#[derive(Default)]
pub struct VtkHdfFrames {
    asked: Option<PathBuf>,
    open: Option<VtkHdf>,
}

impl VtkHdfFrames {
    fn push(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let Some(path) = &self.asked else {
            return Ok(());
        };
        let snapshot = now.snapshot();
        let file = match &mut self.open {
            Some(file) => file,
            none => none.insert(VtkHdf::create(path, &snapshot)?),
        };
        Ok(file.push(&snapshot)?)
    }
}

impl Owner for VtkHdfFrames {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.given("file", &mut self.open, |file, a| file.archive(a));
    }
}

impl Writer for VtkHdfFrames {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        let Some(name) = &now.plan.output.vtkhdf else {
            return Ok(());
        };
        let path = now.plan.dir.join(name);
        if goes_on {
            // the first frame is that of the start
            self.open = Some(VtkHdf::reopen(&path, &now.snapshot())?);
        }
        self.asked = Some(path);
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(self.open.as_mut().map_or(Ok(()), VtkHdf::rewind)?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        match now.due.frame && !now.due.last {
            true => self.push(now),
            false => Ok(()),
        }
    }

    fn end(mut self: Box<Self>, now: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        self.push(now)?;
        Ok(self.open.map_or(Ok(()), VtkHdf::finish)?)
    }
}
