//! Forces of everything that acts.

use super::System;
use crate::body::{Field, view, view_mut};
use crate::constitutive::{ConstitutiveModel, Laws};
use crate::interaction::friction::Pressed;
use crate::interaction::{Evaluation, Sweep};
use crate::run::Watched;
use crate::run::fault::KnownFault;

impl<const D: usize> System<D> {
    /// All forces at the current displacements, no bond breaking.
    pub fn forces_held(&mut self, at: Evaluation) {
        self.refresh_images();
        let (body, u) = (&self.body, &self.u);
        self.interaction
            .forces(body, view(u), view_mut(&mut self.f), Sweep::Hold, None);
        self.other_forces(at);
    }

    /// All forces at the current displacements, and what breaks by them.
    pub fn forces(&mut self, bonds: bool, at: Evaluation) {
        self.forces_of_steps(bonds, at, [at.ended(), self.clock.dt()]);
    }

    /// All forces at the end of an implicit step, in which no bond goes on pulling beyond what it is.
    pub fn evolve(&mut self) {
        self.forces_of_steps(true, self.clock.trial(), [0.0; 2]);
    }

    /// `steps` that end and begin here, for what breaking costs.
    fn forces_of_steps(&mut self, bonds: bool, at: Evaluation, steps: [f64; 2]) {
        let asked = [Watched::Energies, Watched::Virial, Watched::Virials];
        let [energies, virial, virials] = asked.map(|what| self.watch.take(what));
        match bonds {
            // whoever watches looks at the bonds of before
            true => refresh_motion(self, steps, !(energies || virial || virials)),
            false => self.refresh_images(),
        }
        let last = self.watch.energies.take();
        let mut watched = energies.then(|| last.unwrap_or_default());
        self.watch.virial = virial.then(|| match bonds {
            true => self.virial_of_bonds(),
            false => [0.0; 6],
        });
        self.watch.virials = virials.then(|| match bonds {
            true => self.virials_of_bonds(),
            false => vec![[0.0; 6]; self.body.len()],
        });
        if bonds {
            let room = self.body.len();
            let mut seen = watched.as_mut().map(|w| w.for_slots(room));
            let mut tally = self.interaction.forces(
                &self.body,
                view(&self.u),
                view_mut(&mut self.f),
                Sweep::Evolve {
                    v: view(&self.v),
                    steps,
                    breakage: self.breakage,
                },
                seen.as_mut(),
            );
            let own = tally.fault.take();
            let own = own.map(|fault| KnownFault::of(fault, &self.body, &self.u));
            // no other law has such states
            let atoms = |m: &ConstitutiveModel| matches!(m.laws, Laws::Atoms(_));
            self.fault = match self.constitutive.all().any(atoms) {
                true => KnownFault::of_all(own, &self.body),
                false => own,
            };
            self.accounts.swept += tally;
            self.take_heat_of_flow();
        } else {
            self.f.iter_mut().for_each(|c| c.fill(0.0));
            if let Some(w) = &mut watched {
                w.for_slots(self.body.len()).zeros(self.body.len());
            }
        }
        self.watch.energies = watched;
        self.other_forces(at);
        if let Some(mut virial) = self.watch.virial {
            self.add_virial_of_contact(&mut virial);
            self.watch.virial = Some(virial);
        }
        if let Some(mut points) = self.watch.virials.take() {
            self.add_virials_of_contact(&mut points);
            self.watch.virials = Some(points);
        }
    }

    /// Forces of contact, rigid_bodies and loads, on top of those of bonds.
    pub fn other_forces(&mut self, at: Evaluation) {
        let t = self.clock.time();
        if let Some(contact) = &mut self.contact {
            if contact.friction.is_some() {
                self.body.exchange().fill_field(&mut self.v);
            }
            let (bonds, seen) = (self.interaction.as_ref(), self.watch.energies.as_mut());
            let state = [&self.u, &self.v];
            contact.add(bonds, &self.body, state, &mut self.f, seen, (t, at));
        }
        let (state, push) = ([&self.u, &self.v], self.inertia.as_ref().map(|i| &i.push));
        let f = &mut self.f;
        let all = self.applied.all();
        all.for_each(|x| x.add(&self.body, state, f, t, at, push));
        self.accelerate();
    }

    /// Force densities of the loads at this time.
    pub fn external(&mut self) -> Field<D> {
        let (t, at) = (self.clock.time(), self.clock.trial());
        self.applied.external(&self.body, &self.u, t, at)
    }

    /// First forces and accounts of a motion; without bonds: for a body whose bonds are still to be cut.
    pub fn begin(&mut self, bonds: bool) {
        let step = [self.clock.time(), self.clock.dt()];
        self.prescribed.start(&mut self.u, &mut self.v, step);
        self.start_diffusions();
        self.invalidate_neighbours();
        self.forces(bonds, self.given());
        // energy that came in from outside counts as initial
        self.accounts.initial = Some(self.energy_now().base());
    }

    /// What forces are found for in a state that motion begins from, or goes on from after somebody changed it.
    pub fn given(&self) -> Evaluation {
        match self.regime.implicit {
            true => self.clock.trial(),
            false => self.clock.start(),
        }
    }

    /// All that acts remembers where an increment or a step began.
    pub fn acting_depart(&mut self, pressed: Pressed) {
        self.applied.all().for_each(|x| x.depart(&self.u, pressed));
        if let Some(contact) = &mut self.contact {
            contact.depart(&self.body, &self.u, pressed);
        }
    }

    /// It has ended, from these displacements on.
    pub fn acting_arrive(&mut self, then: &Field<D>) {
        let between = [then, &self.u];
        let all = self.applied.all();
        all.for_each(|x| x.arrive(&self.body, between));
        if let Some(contact) = &mut self.contact {
            contact.arrive(&self.body, &self.u);
        }
    }

    /// It goes back there.
    pub fn acting_retreat(&mut self) {
        self.applied.all().for_each(|x| x.retreat());
        if let Some(contact) = &mut self.contact {
            contact.retreat();
        }
    }
}

/// Copies of displacements and velocities before bonds are tested, and, if asked to, the forces that need no others while they come.
fn refresh_motion<const D: usize>(system: &mut System<D>, steps: [f64; 2], begin: bool) {
    system.tell_toughness();
    let System {
        body,
        breakage,
        u,
        v,
        f,
        interaction,
        ..
    } = system;
    let (body, breakage) = (&*body, *breakage);
    let mut moved = (u, v, f, interaction);
    body.exchange().fill_during(
        &mut moved,
        |(u, v, ..), fill| u.iter_mut().chain(v.iter_mut()).for_each(|c| fill(c)),
        |(u, v, f, interaction)| {
            if begin {
                let v = view(v);
                let sweep = Sweep::Evolve { v, steps, breakage };
                interaction.begin_forces(body, view(u), view_mut(f), sweep);
            }
        },
    );
}
