//! Motion: forces of everything that acts, steps, and the way back from a step that failed.

use super::Simulation;
use super::constitutive::{ConstitutiveModel, Laws};
use super::model::{Model, StepPart};
use crate::condition::driven::Driven;
use crate::condition::indenter::Indenter;
use crate::error::RunError;
use crate::interaction::Sweep;

/// Part of the stable step of now that is not passed, where none was asked for.
const HELD: f64 = 0.9;
/// Most parts of a step: a bond that is shorter still is no bond of a solid any more.
const PARTS: f64 = 1000.0;

impl<const D: usize> Model<D> {
    /// All forces at the current displacements, no bond breaking.
    pub(super) fn forces_held(&mut self) {
        self.refresh_images();
        let (body, u) = (&self.body, &self.u);
        self.interaction
            .forces(body, u, &mut self.f, Sweep::Hold, None);
        self.other_forces(0.0);
    }

    /// All forces at the current displacements; `dt` is 0 at the start of a run.
    pub(super) fn forces(&mut self, bonds: bool, dt: f64) {
        self.forces_of_steps(bonds, dt, [dt, self.dt]);
    }

    /// All forces at the end of an implicit step, in which no bond goes on pulling beyond what it is.
    pub(super) fn evolve(&mut self) {
        self.forces_of_steps(true, 0.0, [0.0; 2]);
    }

    /// `steps` that end and begin here, for what breaking costs.
    fn forces_of_steps(&mut self, bonds: bool, dt: f64, steps: [f64; 2]) {
        self.refresh_images();
        let mut watched = self.watched.take();
        watched = std::mem::take(&mut self.watch).then(|| watched.unwrap_or_default());
        self.virial = std::mem::take(&mut self.watch_virial).then(|| match bonds {
            true => self.virial_of_bonds(),
            false => [0.0; 6],
        });
        self.virials = std::mem::take(&mut self.watch_virials).then(|| match bonds {
            true => self.virials_of_bonds(),
            false => vec![[0.0; 6]; self.body.len],
        });
        if bonds {
            for c in &mut self.v {
                self.body.fill_images(c);
            }
            self.tell_toughness();
            let tally = self.interaction.forces(
                &self.body,
                &self.u,
                &mut self.f,
                Sweep::Evolve {
                    v: &self.v,
                    steps,
                    release: self.release,
                },
                watched.as_mut(),
            );
            self.fault = tally.fault;
            self.broken += tally.broken;
            self.released += tally.released;
            self.past_work[0] += tally.dissipated;
            self.take_heat_of_flow();
        } else {
            self.f.iter_mut().for_each(|c| c.fill(0.0));
            if let Some(w) = &mut watched {
                w.zeros(self.body.len);
            }
        }
        self.watched = watched;
        self.other_forces(dt);
        if let Some(mut virial) = self.virial {
            self.add_virial_of_contact(&mut virial);
            self.virial = Some(virial);
        }
        if let Some(mut points) = self.virials.take() {
            self.add_virials_of_contact(&mut points);
            self.virials = Some(points);
        }
    }

    /// Forces of contact, indenters and loads, on top of those of bonds.
    pub(super) fn other_forces(&mut self, dt: f64) {
        let t = self.time();
        if let Some(contact) = &mut self.contact {
            let (body, interaction) = (&self.body, &self.interaction);
            contact.add_forces(body, &self.u, &mut self.f, &|i, j| {
                interaction.in_family(body, i, j)
            });
            if let Some(watched) = &mut self.watched {
                contact.add_energy_density(body, &self.u, &mut watched.repulsion);
            }
            if let Some(friction) = &mut self.friction {
                let state = [&self.u, &self.v];
                friction.add(
                    contact,
                    self.interaction.as_ref(),
                    body,
                    state,
                    &mut self.f,
                    [t, dt],
                );
            }
        }
        for indenter in &mut self.indenters {
            let state = [&self.u, &self.v];
            indenter.add(&self.body, state, &mut self.f, t, [dt, self.dt]);
        }
        for load in &mut self.loads {
            let push = self.inertia.as_ref().map(|i| &i.push);
            load.add(&self.body, [&self.u, &self.v], &mut self.f, t, dt, push);
        }
        for d in &mut self.driven {
            d.add(&self.body, &self.u, &self.v, &mut self.f, t, dt);
        }
        self.accelerate();
    }

    /// Points may be anywhere now: whoever keeps track of what is near forgets it.
    pub(super) fn look_again(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.look_again();
        }
        self.indenters.iter_mut().for_each(Indenter::look_again);
        for d in &mut self.driven {
            if let Driven::Indenter(i) = d {
                i.look_again();
            }
        }
    }

    /// Bring velocities to the whole step.
    pub(super) fn finish(&mut self) {
        if self.pending {
            let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
            self.verlet.kick(&self.body, &mut self.v, f, self.dt);
            let (t, dt) = (self.time(), self.dt);
            for c in &self.constraints {
                c.settle(&mut self.v, t, dt);
            }
            self.still.settle(&mut self.v);
            self.carried.settle(&mut self.v);
            self.pending = false;
        }
    }

    /// First forces and accounts of a run; without bonds: for a body whose bonds are still to be cut.
    pub(super) fn begin(&mut self, bonds: bool) {
        self.finish();
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.start(&mut self.u, &mut self.v, t, dt);
        }
        self.start_transfers();
        self.look_again();
        if let Some(implicit) = &mut self.implicit {
            implicit.acceleration.clear();
        }
        self.forces(bonds, 0.0);
        self.stale = false;
        // energy that came in from outside counts as initial
        let now = self.energy_now();
        self.initial_energy = Some(now.base());
    }

    /// Forces of what columns say that were written since: the next step begins with them.
    pub(super) fn refresh(&mut self) {
        if !std::mem::take(&mut self.stale) || self.stands {
            return;
        }
        self.finish();
        if let Some(implicit) = &mut self.implicit {
            implicit.acceleration.clear();
        }
        let implicit = self.implicit.as_mut().map(|i| &mut i.equations);
        if let Some(state) = self.statics.as_mut().or(implicit) {
            state.forget();
        }
        match self.statics.is_some() {
            true => self.forces_of_statics(),
            false => self.forces_held(),
        }
    }

    /// A step in which points stand where they are.
    pub(super) fn stand(&mut self) -> Result<(), RunError> {
        self.spread(self.time(), self.dt)?;
        self.step += 1;
        Ok(())
    }

    /// One step; in parts where bonds have become shorter and so stiffer than the step is made for.
    pub(super) fn advance(&mut self) -> Result<(), RunError> {
        let parts = self.parts_now();
        if parts == 1 {
            self.depart()?;
            return self.arrive();
        }
        self.finish();
        self.info.parts = self.info.parts.max(parts);
        let (begin, whole) = (self.time(), self.dt);
        self.dt = whole / f64::from(parts);
        self.part = Some(StepPart {
            begin,
            length: self.dt,
            done: 0,
        });
        let all = (0..parts).try_for_each(|_| {
            self.depart()?;
            self.arrive()
        });
        // with the length of a part, and at its time
        self.finish();
        let now = self.time();
        self.part = None;
        match all {
            Ok(()) => self.step += 1,
            // time is that of the last part that went well
            Err(_) => self.origin = (self.step, now),
        }
        self.dt = whole;
        all
    }

    /// In how many parts the next step is done: the stable step of bonds whose stiffness is that of a material goes with their length (that of
    /// waves through the shortest one, Courant, Friedrichs & Lewy 1928).
    fn parts_now(&mut self) -> u32 {
        let Some(fraction) = self.fraction else {
            return 1;
        };
        self.refresh_images();
        let shortest = self.interaction.shortest(&self.body, &self.u);
        let most = fraction.max(HELD);
        let parts = (fraction / (most * shortest)).ceil().clamp(1.0, PARTS) as u32;
        parts.max(self.parts_of_indenters(fraction))
    }

    /// In how many parts what touches rigid bodies asks for: the deeper a point is below a surface, the stiffer it is held.
    fn parts_of_indenters(&self, fraction: f64) -> u32 {
        let bonds = (2.0 * fraction / self.dt).powi(2);
        let stiffest = self.indenters.iter().map(|i| i.stiffened(bonds));
        let lambda = stiffest.fold(0.0, f64::max);
        (0.5 * self.dt * lambda.sqrt() / HELD)
            .ceil()
            .clamp(1.0, PARTS) as u32
    }

    /// One more step, or part of one.
    fn count(&mut self, forward: bool) {
        match (&mut self.part, forward) {
            (Some(part), true) => part.done += 1,
            (Some(part), false) => part.done -= 1,
            (None, true) => self.step += 1,
            (None, false) => self.step -= 1,
        }
    }

    /// The first half of a step: displacements of its end, velocities of its middle.
    pub(super) fn depart(&mut self) -> Result<(), RunError> {
        let (t, dt) = (self.time(), self.dt);
        self.update_toughness(t + dt)?;
        let pressed = self.pressed();
        if self.holds_others() {
            self.accelerate();
        }
        for c in &mut self.constraints {
            c.begin(&self.u, &mut self.v, &mut self.f, t, dt);
        }
        self.still.begin(&mut self.v, &mut self.f, !self.pending);
        self.carried.begin(&self.u, &mut self.v, &mut self.f, dt);
        // linear springs may go through each other: they know no distance that is too far for a step
        let linear = |m: &ConstitutiveModel| match m.laws {
            Laws::Springs(_) | Laws::Micromoduli(_) => true,
            Laws::Bond(_) | Laws::Solid(_) | Laws::Atoms(_) => false,
        };
        let limit = match self.constitutive.all().all(linear) {
            true => f64::INFINITY,
            false => self.body.spacing,
        };
        let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
        let fastest = self.verlet.advance(
            &self.body,
            &mut self.u,
            &mut self.v,
            f,
            dt,
            self.pending,
            limit,
        );
        if !(fastest < limit * limit) {
            let error = self.refused(limit);
            let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
            self.verlet
                .retreat(&self.body, &mut self.u, &mut self.v, f, dt, limit);
            self.pending = false;
            self.still.settle(&mut self.v);
            return Err(error);
        }
        self.count(true);
        if let Some(contact) = &mut self.contact {
            contact.moved(fastest.sqrt());
        }
        let t = self.time();
        for c in &self.constraints {
            c.drift(&mut self.u, t, dt);
        }
        self.carried.drift(&mut self.u);
        self.fastest = fastest.sqrt();
        // whoever asks for velocities now gets those of the middle
        self.pending = false;
        if let Err(error) = self.spread_after(t - dt, dt, pressed) {
            self.step_back();
            return Err(error);
        }
        self.pay(1.0, 0.5 * dt);
        Ok(())
    }

    /// Back to the step before: where it was, and with the forces that were.
    fn step_back(&mut self) {
        for &s in &self.body.slots {
            for a in 0..D {
                self.u[a][s as usize] -= self.dt * self.v[a][s as usize];
            }
        }
        self.count(false);
        if let Some(contact) = &mut self.contact {
            contact.moved(self.fastest);
        }
        self.forces(true, 0.0);
        let dt = self.dt;
        let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
        self.verlet
            .retreat(&self.body, &mut self.u, &mut self.v, f, dt, 0.0);
        self.pending = false;
    }

    /// The second half of a step: forces at its end.
    pub(super) fn arrive(&mut self) -> Result<(), RunError> {
        let (t, dt, path) = (self.time(), self.dt, self.fastest);
        for load in &mut self.loads {
            load.begin(&self.body, &self.v, dt);
        }
        if let Some(friction) = &mut self.friction {
            friction.begin(&self.body, &self.v, dt);
        }
        for indenter in &mut self.indenters {
            indenter.begin(&self.body, &self.v, t, dt, path);
        }
        for d in &mut self.driven {
            d.begin(&self.body, &self.v, t, dt, path);
        }
        self.heal(t);
        self.forces(true, dt);
        if let Some(fault) = self.fault {
            let error = self.explained(fault);
            self.retreat_transfers();
            self.indenters.iter_mut().for_each(Indenter::retreat);
            if let Some(friction) = &mut self.friction {
                friction.retreat();
            }
            self.step_back();
            return Err(error);
        }
        let change = self.inertia.as_ref().map(|i| i.change(dt));
        self.account_constraints(t, dt, change.as_ref());
        self.pending = true;
        Ok(())
    }
}
