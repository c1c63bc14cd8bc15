//! A model that a script leads step by step.

use super::model::Model;
use super::{Steered, Wall};
use crate::condition::carried::{Carried, Motion};
use crate::condition::driven::{Drive, Driven};
use crate::condition::reaction::Reaction;
use crate::condition::still::Still;
use crate::error::{BuildError, RunError, SolveError};
use crate::observe::Observed;
use crate::spec::{ConditionSpec, IndenterSpec};

impl<const D: usize> Steered for Model<D> {
    fn depart(&mut self) -> Result<f64, RunError> {
        if self.implicit.is_some() {
            return Err(RunError::Implicit {
                step: self.clock.step() + 1,
                position: None,
                error: SolveError::NoTangent {
                    what: "what acts between the halves of a step",
                },
            });
        }
        Model::depart(self)?;
        Ok(self.fastest)
    }

    fn arrive(&mut self) -> Result<(), RunError> {
        Model::arrive(self)
    }

    fn reflect(&mut self, wall: &Wall, ids: Option<&[u32]>) {
        self.bounce(wall, ids);
    }

    fn set_carried(&mut self, ids: &[u32]) {
        self.finish();
        let slots = ids.iter().map(|id| self.body.slots[*id as usize]);
        self.prescribed.carried = Carried::new(slots.collect());
    }

    fn carry(&mut self, next: &[Motion]) {
        self.prescribed.carried.tell(next);
    }

    fn remove(&mut self, ids: &[u32]) {
        self.take_away(ids);
    }

    fn set_time(&mut self, step: u64, time: f64) {
        self.clock.set_step(step);
        self.clock.set(time);
    }

    fn set_time_step(&mut self, dt: f64) {
        self.finish();
        self.clock.set_time_step(dt);
        self.info.time_step = dt;
    }

    fn set_conditions(
        &mut self,
        conditions: &[ConditionSpec],
        sets: &[(String, Vec<u32>)],
        indenters: &[IndenterSpec],
    ) -> Result<(), BuildError> {
        let (forces, constraints) = self.acting(conditions, indenters, sets)?;
        self.finish();
        let now = self.energy_now();
        self.accounts.pass(&now);
        // it goes on; what it took is in the past now
        if let Some(friction) = self.contact.as_mut().and_then(|c| c.friction.as_mut()) {
            friction.work = -friction.energy;
        }
        self.applied = forces;
        self.prescribed.constraints = constraints;
        Ok(())
    }

    fn read(&mut self, name: &str, component: usize, first: usize, out: &mut [f64]) -> bool {
        let vector = match name {
            "reference" => {
                self.body.coordinates(first, component, out);
                return true;
            }
            "displacement" => &self.u,
            "velocity" => {
                self.finish();
                &self.v
            }
            "force_density" => &self.f,
            "volume" | "density" => {
                let (volume, density) = (&self.body.volume, &self.body.density);
                let values = if name == "volume" { volume } else { density };
                for (x, &s) in out.iter_mut().zip(&self.body.slots[first..]) {
                    *x = values.at(s as usize);
                }
                return true;
            }
            _ => return false,
        };
        match vector.get(component) {
            Some(values) => {
                for (x, &s) in out.iter_mut().zip(&self.body.slots[first..]) {
                    *x = values[s as usize];
                }
            }
            None => out.fill(0.0),
        }
        true
    }

    fn write(&mut self, name: &str, component: usize, first: usize, values: &[f64]) -> bool {
        self.finish();
        let vector = match name {
            "displacement" => {
                self.look_again();
                self.virial = None;
                self.virials = None;
                &mut self.u
            }
            "velocity" => &mut self.v,
            _ => return false,
        };
        if let Some(component) = vector.get_mut(component) {
            for (value, &s) in values.iter().zip(&self.body.slots[first..]) {
                component[s as usize] = *value;
            }
        }
        true
    }

    fn watch_next(&mut self) {
        self.watch = true;
    }

    fn watched(&self) -> Option<Observed> {
        self.watched.as_ref().map(|w| self.observed_of(w))
    }

    fn watch_virial_next(&mut self) {
        self.watch_virial = true;
    }

    fn watch_virials_next(&mut self) {
        self.watch_virials = true;
    }

    fn virials(&mut self) -> Vec<[f64; 6]> {
        let points = match &self.virials {
            Some(points) => points.clone(),
            None => {
                self.refresh_images();
                if let Some(pairs) = &mut self.contact {
                    pairs.find(&self.body, &self.u, self.interaction.as_ref());
                }
                let mut points = self.virials_of_bonds();
                self.add_virials_of_contact(&mut points);
                points
            }
        };
        self.by_id(|i| points[i])
    }

    fn set_driven(&mut self, driven: &[(Drive, Option<Vec<u32>>)]) {
        self.finish();
        let slot = |id: &u32| self.body.slots[*id as usize];
        let new = driven.iter().map(|(drive, ids)| {
            let slots = match ids {
                None => self.body.slots.clone(),
                Some(ids) => ids.iter().map(slot).collect(),
            };
            let at = |s: &u32| self.body.position(*s as usize);
            let points = slots.iter().map(at).collect();
            Driven::new(drive, slots, points)
        });
        let new: Vec<_> = new.collect();
        for old in std::mem::replace(&mut self.applied.driven, new) {
            match old {
                Driven::Load(l) => self.accounts.past.conditions += l.work,
                Driven::Indenter(i) => self.accounts.past.indenters += i.work,
            }
        }
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        self.applied
            .driven
            .get_mut(index)
            .is_some_and(|d| d.set(value))
    }

    fn reaction(&self, index: usize) -> Reaction {
        self.applied
            .driven
            .get(index)
            .map_or_else(Reaction::default, Driven::reaction)
    }

    fn set_still(&mut self, ids: &[u32]) {
        self.finish();
        let slots = ids.iter().map(|id| self.body.slots[*id as usize]);
        self.prescribed.still = Still::new(slots.collect());
    }
}
