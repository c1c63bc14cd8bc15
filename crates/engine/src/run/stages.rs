//! Stages of a run: each has a stepper and what acts while that moves the system, and the next takes over when its step has come.

use super::stepper::Stepper;
use super::system::System;
use crate::body::Field;
use crate::boundary_condition::applied::AppliedForces;
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::fracture::precrack::Crack;
use crate::interaction::ContactForces;
use crate::interaction::friction::Friction;
use crate::statics::Solved;
use std::collections::VecDeque;

/// A stage that waits for its steps.
pub(super) struct Stage<const D: usize> {
    pub stepper: Box<dyn Stepper<D>>,
    /// Steps before it.
    pub begin: u64,
    pub applied: AppliedForces<D>,
    pub prescribed: PrescribedMotion<D>,
    /// Where the stage before does not know it; else its friction, which has no place there.
    pub contact: Option<ContactForces<D>>,
    pub friction: Option<Friction<D>>,
    pub velocity: Field<D>,
    /// Cut when it begins.
    pub cuts: Vec<Crack<D>>,
}

/// That of now, and those to come.
pub(super) struct Stages<const D: usize> {
    pub now: Box<dyn Stepper<D>>,
    pub coming: VecDeque<Stage<D>>,
    /// Of the last step of the stage before this one.
    pub before: Option<Solved>,
}

impl<const D: usize> Stages<D> {
    /// One without another after it.
    pub fn one(now: Box<dyn Stepper<D>>) -> Self {
        Stages {
            now,
            coming: VecDeque::new(),
            before: None,
        }
    }

    /// The stage to which the step after this one belongs, if it is not that of now.
    pub fn due(&self, step: u64) -> Option<&Stage<D>> {
        self.coming.front().filter(|next| step >= next.begin)
    }

    /// What a solver did last.
    pub fn solved(&self) -> Option<Solved> {
        self.now.solved().or(self.before)
    }

    /// The next stage is that of now; the cracks that are to be cut.
    pub fn take_over(&mut self, system: &mut System<D>, stage: Stage<D>) -> Vec<Crack<D>> {
        system.applied = stage.applied;
        system.prescribed = stage.prescribed;
        match &mut system.contact {
            Some(contact) => contact.friction = stage.friction,
            None => system.contact = stage.contact,
        }
        system.clock.begin_motion();
        system.v = stage.velocity;
        system.regime = stage.stepper.regime();
        self.now = stage.stepper;
        stage.cuts
    }
}
