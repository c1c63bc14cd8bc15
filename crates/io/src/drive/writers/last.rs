//! The last state as files of its own: atoms, fragments, the linear body.

use peridyne::spec::AnyLinearBody;
use peridyne::state::{Archive, Owner};

use super::writer::{Made, Now, Writer};

use super::inside;
use crate::drive::plan::DriveError;
use crate::write::data::write_data;
use crate::write::fragments;
use crate::write::linear::write_linear;

pub struct LastState;

impl Owner for LastState {
    fn archive(&mut self, _: &mut Archive<'_>) {}
}

impl Writer for LastState {
    fn open(&mut self, _: &mut Now<'_>, _: bool) -> Result<(), DriveError> {
        Ok(())
    }

    fn rewind(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(())
    }

    fn look(&mut self, _: &mut Now<'_>) -> Result<(), DriveError> {
        Ok(())
    }

    fn end(self: Box<Self>, now: &mut Now<'_>, _: &mut Made) -> Result<(), DriveError> {
        if let Some(atoms) = &now.plan.atoms
            && let Some(name) = &atoms.data
        {
            write_data(&now.plan.dir.join(name), &atoms.last(now.sim))?;
        }
        if now.plan.output.fragments {
            let state = now.sim.snapshot(&fragments::COLUMNS, false);
            fragments::write(&inside(now.plan, "fragments.csv"), &state, now.plan.units)?;
        }
        if now.plan.output.linear_body {
            let path = inside(now.plan, "linear_body.npz");
            match now.sim.linear_body() {
                AnyLinearBody::One(body) => write_linear(&path, &body)?,
                AnyLinearBody::Two(body) => write_linear(&path, &body)?,
                AnyLinearBody::Three(body) => write_linear(&path, &body)?,
            }
        }
        Ok(())
    }
}
