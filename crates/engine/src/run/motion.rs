//! Motion: forces of everything that acts, steps, and the way back from a step that failed.

use super::constitutive::{ConstitutiveModel, Laws};
use super::model::Model;
use crate::error::RunError;
use crate::interaction::{Evaluation, Sweep};

/// Part of the stable step of now that is not passed, where none was asked for.
const HELD: f64 = 0.9;
/// Most parts of a step: a bond that is shorter still is no bond of a solid any more.
const PARTS: f64 = 1000.0;

impl<const D: usize> Model<D> {
    /// All forces at the current displacements, no bond breaking.
    pub(super) fn forces_held(&mut self, at: Evaluation) {
        self.refresh_images();
        let (body, u) = (&self.body, &self.u);
        self.interaction
            .forces(body, u, &mut self.f, Sweep::Hold, None);
        self.other_forces(at);
    }

    /// All forces at the current displacements, and what breaks by them.
    pub(super) fn forces(&mut self, bonds: bool, at: Evaluation) {
        self.forces_of_steps(bonds, at, [at.ended(), self.clock.dt()]);
    }

    /// All forces at the end of an implicit step, in which no bond goes on pulling beyond what it is.
    pub(super) fn evolve(&mut self) {
        self.forces_of_steps(true, self.clock.trial(), [0.0; 2]);
    }

    /// `steps` that end and begin here, for what breaking costs.
    fn forces_of_steps(&mut self, bonds: bool, at: Evaluation, steps: [f64; 2]) {
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
            self.accounts.book(&tally);
            self.take_heat_of_flow();
        } else {
            self.f.iter_mut().for_each(|c| c.fill(0.0));
            if let Some(w) = &mut watched {
                w.zeros(self.body.len);
            }
        }
        self.watched = watched;
        self.other_forces(at);
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
    pub(super) fn other_forces(&mut self, at: Evaluation) {
        let t = self.clock.time();
        if let Some(contact) = &mut self.contact {
            let (bonds, seen) = (self.interaction.as_ref(), self.watched.as_mut());
            let state = [&self.u, &self.v];
            contact.add(bonds, &self.body, state, &mut self.f, seen, (t, at));
        }
        let (state, push) = ([&self.u, &self.v], self.inertia.as_ref().map(|i| &i.push));
        let f = &mut self.f;
        let all = self.applied.all();
        all.for_each(|x| x.add(&self.body, state, f, t, at, push));
        self.accelerate();
    }

    /// What forces are found for in a state that motion begins from, or goes on from after somebody changed it.
    pub(super) fn given(&self) -> Evaluation {
        match &self.implicit {
            Some(_) => self.clock.trial(),
            None => self.clock.start(),
        }
    }

    /// Points may be anywhere now: whoever keeps track of what is near forgets it.
    pub(super) fn look_again(&mut self) {
        if let Some(contact) = &mut self.contact {
            contact.central.look_again();
        }
        self.applied.all().for_each(|x| x.moved(f64::INFINITY));
    }

    /// Bring velocities to the whole step.
    pub(super) fn finish(&mut self) {
        if self.pending {
            let (t, dt) = (self.clock.time(), self.clock.dt());
            let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
            self.verlet.kick(&self.body, &mut self.v, f, dt);
            let all = self.prescribed.all();
            all.for_each(|p| p.whole_velocity(&mut self.v, [t, dt]));
            self.pending = false;
        }
    }

    /// First forces and accounts of a run; without bonds: for a body whose bonds are still to be cut.
    pub(super) fn begin(&mut self, bonds: bool) {
        self.finish();
        let step = [self.clock.time(), self.clock.dt()];
        self.prescribed.start(&mut self.u, &mut self.v, step);
        self.start_transfers();
        self.look_again();
        if let Some(implicit) = &mut self.implicit {
            implicit.acceleration.clear();
        }
        self.forces(bonds, self.given());
        self.stale = false;
        // energy that came in from outside counts as initial
        self.accounts.initial = Some(self.energy_now().base());
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
            false => self.forces_held(self.given()),
        }
    }

    /// A step in which points stand where they are.
    pub(super) fn stand(&mut self) -> Result<(), RunError> {
        self.spread(self.clock.time(), self.clock.dt())?;
        self.clock.forward();
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
        self.clock.divide(parts);
        let all = (0..parts).try_for_each(|_| {
            self.depart()?;
            self.arrive()
        });
        // with the length of a part, and at its time
        self.finish();
        self.clock.join(all.is_ok());
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
        let dt = self.clock.dt();
        let bonds = (2.0 * fraction / dt).powi(2);
        let stiffest = self.applied.rigid.iter().map(|i| i.stiffened(bonds));
        let lambda = stiffest.fold(0.0, f64::max);
        (0.5 * dt * lambda.sqrt() / HELD).ceil().clamp(1.0, PARTS) as u32
    }

    /// The first half of a step: displacements of its end, velocities of its middle.
    pub(super) fn depart(&mut self) -> Result<(), RunError> {
        let (t, dt) = (self.clock.time(), self.clock.dt());
        self.update_toughness(t + dt)?;
        let pressed = self.pressed();
        if self.holds_others() {
            self.accelerate();
        }
        let (u, v, f) = (&self.u, &mut self.v, &mut self.f);
        let whole = !self.pending;
        let all = self.prescribed.all_mut();
        all.for_each(|p| p.before_drift(u, v, f, [t, dt], whole));
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
            self.prescribed.refused(&mut self.v, [t, dt]);
            return Err(error);
        }
        self.clock.forward();
        if let Some(contact) = &mut self.contact {
            contact.central.moved(fastest.sqrt());
        }
        let t = self.clock.time();
        let all = self.prescribed.all();
        all.for_each(|p| p.after_drift(&mut self.u, [t, dt]));
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
        let dt = self.clock.dt();
        for &s in &self.body.slots {
            for a in 0..D {
                self.u[a][s as usize] -= dt * self.v[a][s as usize];
            }
        }
        self.clock.back();
        if let Some(contact) = &mut self.contact {
            contact.central.moved(self.fastest);
        }
        self.forces(true, self.clock.start());
        let f = self.inertia.as_ref().map_or(&self.f, |i| &i.push);
        self.verlet
            .retreat(&self.body, &mut self.u, &mut self.v, f, dt, 0.0);
        self.pending = false;
    }

    /// The second half of a step: forces at its end.
    pub(super) fn arrive(&mut self) -> Result<(), RunError> {
        let (t, dt, path) = (self.clock.time(), self.clock.dt(), self.fastest);
        if let Some(contact) = &mut self.contact {
            contact.begin_step(&self.body, &self.v, dt);
        }
        let all = self.applied.all();
        all.for_each(|x| x.begin_step(&self.body, &self.v, [t, dt], path));
        self.heal(t);
        self.forces(true, self.clock.step_end());
        if let Some(fault) = self.fault {
            let error = self.explained(fault);
            self.retreat_transfers();
            self.acting_retreat();
            self.step_back();
            return Err(error);
        }
        let change = self.inertia.as_ref().map(|i| i.change(dt));
        self.account_constraints(t, dt, change.as_ref());
        self.pending = true;
        Ok(())
    }
}
