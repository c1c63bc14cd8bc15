//! A model that a script leads step by step.

use super::model::Model;
use super::{Prescription, Seen, Steered, Wall, Watched};
use crate::condition::carried::{Carried, Motion};
use crate::condition::driven::{Drive, Driven};
use crate::condition::reaction::Reaction;
use crate::condition::still::Still;
use crate::error::{BuildError, RunError, SolveError};
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
    fn depart(&mut self, carried: &[Motion]) -> Result<f64, RunError> {
        self.system.prescribed.carried.tell(carried);
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
        let slots = ids.iter().map(|id| self.system.body.slots()[*id as usize]);
        let (slots, prescribed) = (slots.collect(), &mut self.system.prescribed);
        match way {
            Prescription::Still => prescribed.still = Still::new(slots),
            Prescription::Carried => prescribed.carried = Carried::new(slots),
        }
    }

    fn remove(&mut self, ids: &[u32]) {
        if ids.is_empty() {
            return;
        }
        self.finish();
        let moved = self.system.take_away(ids);
        self.names.renumber(&moved);
    }

    fn set_clock(&mut self, now: Option<(u64, f64)>, time_step: Option<f64>) {
        if let Some(dt) = time_step {
            self.finish();
            self.system.clock.set_time_step(dt);
            self.system.info.time_step = dt;
        }
        if let Some((step, time)) = now {
            self.system.clock.set_step(step);
            self.system.clock.set(time);
        }
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

    fn watched(&mut self, what: Watched) -> Option<Seen> {
        let system = &mut self.system;
        Some(match what {
            Watched::Energies => {
                let seen = system.watch.energies.as_ref()?;
                Seen::Energies(system.observed_of(seen))
            }
            Watched::Virial => Seen::Virial(match system.watch.virial {
                Some(virial) => virial,
                None => system.virial_now(),
            }),
            Watched::Virials => {
                let points = match &system.watch.virials {
                    Some(points) => points.clone(),
                    None => system.virials_now(),
                };
                Seen::Virials(system.body.by_id(|i| points[i]))
            }
        })
    }

    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        self.finish();
        let slot = |id: &u32| self.system.body.slots()[*id as usize];
        let new = driven.iter().map(|(drive, ids)| {
            let slots: Vec<u32> = match ids {
                None => self.system.body.slots().to_vec(),
                Some(ids) => ids.iter().map(slot).collect(),
            };
            let at = |s: &u32| self.system.body.position(*s as usize);
            let points = slots.iter().map(at).collect();
            Driven::new(drive, slots, points)
        });
        let new: Vec<_> = new.collect();
        // what those of before did on the points of all ranks
        let old = std::mem::replace(&mut self.system.applied.driven, new);
        let (body, past) = (&self.system.body, &mut self.system.accounts.past);
        let works = body.sums_of(old.iter().map(|of| of.work().clone()).collect());
        for (of, work) in old.iter().zip(works) {
            match of {
                Driven::Load(_) => past.conditions += work,
                Driven::Indenter(_) => past.indenters += work,
            }
        }
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        let driven = self.system.applied.driven.get_mut(index);
        driven.is_some_and(|driven| driven.set(value))
    }

    fn reaction(&mut self, index: usize) -> Option<Reaction> {
        let driven = self.system.applied.driven.get(index)?;
        Some(driven.reaction(&self.system.body))
    }
}
