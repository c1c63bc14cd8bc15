//! Trajectories of atoms.

use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};
use crate::drive::plan::DriveError;
use crate::write::trajectory::Trajectory;

#[derive(Default)]
pub struct Trajectories {
    open: Vec<Trajectory>,
    /// The step of the last frame.
    framed: Option<u64>,
}

impl Owner for Trajectories {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        archive.parts("trajectories", &mut self.open);
        archive.one("step", &mut self.framed);
    }
}

impl Trajectories {
    fn push(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        let step = now.sim.step_number();
        if let Some(atoms) = now.plan.atoms.as_ref()
            && !self.open.is_empty()
            && self.framed != Some(step)
        {
            let frame = atoms.frame(now.sim);
            self.open.iter_mut().try_for_each(|t| t.push(&frame))?;
            self.framed = Some(step);
        }
        Ok(())
    }
}

impl Writer for Trajectories {
    fn open(&mut self, now: &mut Now<'_>, goes_on: bool) -> Result<(), DriveError> {
        let Some(atoms) = &now.plan.atoms else {
            return Ok(());
        };
        for (path, format) in &atoms.trajectories {
            let path = now.plan.dir.join(path);
            let trajectory = match goes_on {
                true => Trajectory::append(&path, *format)?,
                false => Trajectory::create(&path, *format)?,
            };
            self.open
                .push(trajectory.with_ase_velocity(atoms.ase_velocity));
        }
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(self.open.iter_mut().try_for_each(Trajectory::rewind)?)
    }

    fn look(&mut self, now: &mut Now<'_>) -> Result<(), DriveError> {
        match now.due.frame || now.due.last {
            true => self.push(now),
            false => Ok(()),
        }
    }

    fn end(mut self: Box<Self>, now: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        // of a run that stopped, the last good state
        self.push(now)?;
        Ok(self.open.into_iter().try_for_each(Trajectory::finish)?)
    }
}
