//! A model that a script leads step by step.

use super::conditions::named;
use super::model::Model;
use super::system::System;
use super::{CoSimulation, Given, Prescription, Seen, Wall, Watched};
use crate::boundary_condition::Program;
use crate::boundary_condition::applied::AppliedForces;
use crate::boundary_condition::constraint::{Constraint, Kind};
use crate::boundary_condition::driven::{Drive, Driven};
use crate::boundary_condition::external::ExternalValues;
use crate::boundary_condition::kinematic::{KinematicPoints, Motion};
use crate::boundary_condition::load::Load;
use crate::boundary_condition::point_force::PointForce;
use crate::boundary_condition::prescribed_motion::PrescribedMotion;
use crate::boundary_condition::reaction::Reaction;
use crate::boundary_condition::still::Still;
use crate::error::{BuildError, RunError, SolveError};
use crate::message;
use crate::quantity::place;
use crate::spec::{ConditionSpec, RigidBodySpec};
use std::collections::HashSet;
use std::sync::Arc;

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

/// Adds to what acts on the stage that is to stay, that of the motion after statics, and takes it away again where its stepper cannot take it.
fn add<const D: usize, T>(
    model: &mut Model<D>,
    add: impl FnOnce(&mut AppliedForces<D>, &mut PrescribedMotion<D>) -> T,
    take: impl FnOnce(&mut AppliedForces<D>, &mut PrescribedMotion<D>, T),
) -> Result<(), BuildError> {
    let Model { system, stages, .. } = model;
    let Some(motion) = stages.coming.back_mut() else {
        let before = add(&mut system.applied, &mut system.prescribed);
        let accepted = stages.now.accepts(system);
        if accepted.is_err() {
            take(&mut system.applied, &mut system.prescribed, before);
        }
        return accepted;
    };
    let before = add(&mut motion.applied, &mut motion.prescribed);
    // as if it were the stage of now
    let mut swap = |system: &mut System<D>| {
        std::mem::swap(&mut system.applied, &mut motion.applied);
        std::mem::swap(&mut system.prescribed, &mut motion.prescribed);
    };
    swap(system);
    let accepted = motion.stepper.accepts(system);
    swap(system);
    if accepted.is_err() {
        take(&mut motion.applied, &mut motion.prescribed, before);
    }
    accepted
}

/// One more condition on motion.
fn hold<const D: usize>(
    model: &mut Model<D>,
    ids: &[u32],
    (kind, axes): (Kind, [bool; 3]),
    source: &Arc<dyn ExternalValues>,
) -> Result<(), BuildError> {
    let body = &model.system.body;
    let slot = |id: &u32| body.slots()[*id as usize];
    let slots: Vec<u32> = ids.iter().map(slot).collect();
    let points = slots.iter().map(|s| body.position(*s as usize)).collect();
    let program = Program::external(source, axes, slots.len());
    let told = Constraint::new(kind, program, slots, points);
    let of = |c: &Constraint<D>| -> Vec<_> { c.each().map(|(_, slot, a)| (slot, a)).collect() };
    let own: HashSet<(usize, usize)> = of(&told).into_iter().collect();
    let acting = match model.stages.coming.back() {
        Some(motion) => &motion.prescribed,
        None => &model.system.prescribed,
    };
    let mut others = acting.constraints.iter().flat_map(of);
    if let Some((slot, a)) = others.find(|held| own.contains(held)) {
        let message = message![
            "the point at ",
            place(&body.position(slot)[..D]),
            format!(" is held along {} already", ["x", "y", "z"][a]),
        ];
        return Err(BuildError::conflict("", message).help(
            "take a set that is disjoint from those of other boundary conditions on motion, or another axis",
        ));
    }
    add(
        model,
        |_, prescribed| prescribed.constraints.push(told),
        |_, prescribed, ()| drop(prescribed.constraints.pop()),
    )
}

/// One more force.
fn push<const D: usize>(
    model: &mut Model<D>,
    ids: &[u32],
    force: Arc<dyn PointForce>,
) -> Result<(), BuildError> {
    let body = &model.system.body;
    let slots: Vec<u32> = ids.iter().map(|id| body.slots()[*id as usize]).collect();
    let points: Vec<_> = slots.iter().map(|s| body.position(*s as usize)).collect();
    let which: Vec<u32> = (0..slots.len() as u32).collect();
    let new = named(body, force, &which).into_iter();
    let new: Vec<_> = new
        .map(|kind| Load::new(kind, slots.clone(), points.clone()))
        .collect();
    add(
        model,
        |applied, _| {
            let before = applied.loads.clone();
            applied.loads.extend(new);
            applied.loads.sort_by_key(Load::rank);
            before
        },
        |applied, _, before| applied.loads = before,
    )
}

impl<const D: usize> CoSimulation for Model<D> {
    fn begin_motion(&mut self) -> Result<bool, RunError> {
        let waiting = self.stages.coming.len();
        self.next_stage()?;
        let begins = self.stages.coming.len() < waiting;
        // with what is set from now on
        self.stale |= begins;
        Ok(begins)
    }

    fn depart(&mut self, kinematic: &[Motion]) -> Result<f64, RunError> {
        if std::mem::take(&mut self.stale) {
            self.stages.now.changed(&mut self.system);
        }
        self.system.prescribed.kinematic.tell(kinematic);
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

    fn turn_back(&mut self) {
        if let Some(halves) = self.stages.now.split() {
            halves.turn_back(&mut self.system);
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
            Prescription::KinematicPoints => prescribed.kinematic = KinematicPoints::new(slots),
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
        rigid_bodies: &[RigidBodySpec],
    ) -> Result<(), BuildError> {
        let body = &self.system.body;
        let (forces, constraints) = self.names.acting(body, conditions, rigid_bodies, sets)?;
        self.finish();
        self.system.set_acting(forces, constraints);
        Ok(())
    }

    fn give(&mut self, ids: &[u32], what: Given) -> Result<(), BuildError> {
        self.finish();
        match what {
            Given::Motion(kind, axes, source) => hold(self, ids, (kind, axes), &source),
            Given::Force(force) => push(self, ids, force),
        }
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
        let acting = match self.stages.coming.back_mut() {
            Some(motion) => &mut motion.applied,
            None => &mut self.system.applied,
        };
        let old = std::mem::replace(&mut acting.driven, new);
        let (body, past) = (&self.system.body, &mut self.system.accounts.past);
        let works = body.sums_of(old.iter().map(|of| of.work().clone()).collect());
        for (of, work) in old.iter().zip(works) {
            match of {
                Driven::Load(_) => past.conditions += work,
                Driven::RigidBody(_) => past.rigid_bodies += work,
            }
        }
    }

    fn drive(&mut self, index: usize, value: &Drive) -> bool {
        let acting = match self.stages.coming.back_mut() {
            Some(motion) => &mut motion.applied,
            None => &mut self.system.applied,
        };
        let driven = acting.driven.get_mut(index);
        driven.is_some_and(|driven| driven.set(value))
    }

    fn reaction(&mut self, index: usize) -> Option<Reaction> {
        let driven = self.system.applied.driven.get(index)?;
        Some(driven.reaction(&self.system.body))
    }
}
