//! A model that a script leads step by step.

use super::model::Model;
use super::{Prescription, Steered, Wall, Watched};
use crate::condition::carried::{Carried, Motion};
use crate::condition::driven::{Drive, Driven};
use crate::condition::reaction::Reaction;
use crate::condition::still::Still;
use crate::error::{BuildError, RunError, SolveError};
use crate::observe::Observed;
use crate::spec::{ConditionSpec, IndenterSpec};

impl<const D: usize> Model<D> {
    /// Nobody leads this stepper through its steps.
    fn has_no_halves(&self) -> RunError {
        RunError::Implicit {
            step: self.system.clock.step() + 1,
            position: None,
            error: SolveError::NoTangent {
                what: "what acts between the halves of a step",
            },
        }
    }
}

impl<const D: usize> Steered for Model<D> {
    fn depart(&mut self) -> Result<f64, RunError> {
        match self.stages.now.split() {
            Some(halves) => halves.depart(&mut self.system),
            None => Err(self.has_no_halves()),
        }
    }

    fn arrive(&mut self) -> Result<(), RunError> {
        match self.stages.now.split() {
            Some(halves) => halves.arrive(&mut self.system),
            None => Err(self.has_no_halves()),
        }
    }

    fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        self.system.bounce(wall, ids);
    }

    fn prescribe(&mut self, way: Prescription, ids: &[u32]) {
        self.finish();
        let slots = ids.iter().map(|id| self.system.body.slots[*id as usize]);
        let (slots, prescribed) = (slots.collect(), &mut self.system.prescribed);
        match way {
            Prescription::Still => prescribed.still = Still::new(slots),
            Prescription::Carried => prescribed.carried = Carried::new(slots),
        }
    }

    fn carry(&mut self, next: &[Motion]) {
        self.system.prescribed.carried.tell(next);
    }

    fn remove(&mut self, ids: &[u32]) {
        if ids.is_empty() {
            return;
        }
        self.finish();
        let moved = self.system.take_away(ids);
        self.names.renumber(&moved);
    }

    fn set_time(&mut self, step: u64, time: f64) {
        self.system.clock.set_step(step);
        self.system.clock.set(time);
    }

    fn set_time_step(&mut self, dt: f64) {
        self.finish();
        self.system.clock.set_time_step(dt);
        self.system.info.time_step = dt;
    }

    fn set_conditions(
        &mut self,
        conditions: &[ConditionSpec],
        sets: &[(String, Vec<u32>)],
        indenters: &[IndenterSpec],
    ) -> Result<(), BuildError> {
        let body = &self.system.body;
        let (forces, constraints) = self.names.acting(body, conditions, indenters, sets)?;
        self.finish();
        self.system.set_acting(forces, constraints);
        Ok(())
    }

    fn watch(&mut self, what: Watched) {
        self.system.watch.ask(what);
    }

    fn watched(&self) -> Option<Observed> {
        let seen = self.system.watch.energies.as_ref();
        seen.map(|seen| self.system.observed_of(seen))
    }

    fn virials(&mut self) -> Vec<[f64; 6]> {
        let points = match &self.system.watch.virials {
            Some(points) => points.clone(),
            None => self.system.virials_now(),
        };
        self.system.body.by_id(|i| points[i])
    }

    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        self.finish();
        let slot = |id: &u32| self.system.body.slots[*id as usize];
        let new = driven.iter().map(|(drive, ids)| {
            let slots = match ids {
                None => self.system.body.slots.clone(),
                Some(ids) => ids.iter().map(slot).collect(),
            };
            let at = |s: &u32| self.system.body.position(*s as usize);
            let points = slots.iter().map(at).collect();
            Driven::new(drive, slots, points)
        });
        let new: Vec<_> = new.collect();
        for old in std::mem::replace(&mut self.system.applied.driven, new) {
            match old {
                Driven::Load(l) => self.system.accounts.past.conditions += l.work,
                Driven::Indenter(i) => self.system.accounts.past.indenters += i.work,
            }
        }
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        self.system
            .applied
            .driven
            .get_mut(index)
            .is_some_and(|d| d.set(value))
    }

    fn reaction(&self, index: usize) -> Reaction {
        self.system
            .applied
            .driven
            .get(index)
            .map_or_else(Reaction::default, Driven::reaction)
    }
}
