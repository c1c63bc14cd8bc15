//! Motion in time by velocity Verlet, and the way back from a step that failed.

use super::{SplitStep, Stepper};
use crate::body::{Body, view};
use crate::constitutive::{ConstitutiveModel, Laws};
use crate::dynamics::verlet::Verlet;
use crate::error::{BuildError, RunError};
use crate::execute::simd::Simd;
use crate::interaction::PointEnergies;
use crate::run::system::{Regime, System};
use crate::run::time_step::Limits;
use crate::spec::{Spec, TimeStep};
use crate::state::Archive;
use crate::statics::Solved;

/// Part of the stable step of now that is not passed, where none was asked for.
const HELD: f64 = 0.9;
/// Most parts of a step: a bond that is shorter still is no bond of a solid any more.
const PARTS: f64 = 1000.0;

pub(super) struct VelocityVerlet {
    verlet: Verlet,
    /// Bound on the path of any point in the last drift (length).
    path: f64,
    /// Does `v` wait for the last half kick?
    pending: bool,
    /// Part of its stable step at which a body runs whose bonds become stiffer as they become shorter; `None`: its step stays as it is.
    fraction: Option<f64>,
}

impl<const D: usize> Stepper<D> for VelocityVerlet {
    /// Nothing: velocities are those of whole steps, and the next drift says its path.
    fn archive(&mut self, _: &Body<D>, _: &mut Archive<'_>) {}

    fn regime(&self) -> Regime {
        Regime::default()
    }

    fn start(&mut self, system: &mut System<D>, bonds: bool) {
        self.finish(system);
        system.begin(bonds);
    }

    /// In parts where bonds have become shorter and so stiffer than the step is made for.
    fn step(&mut self, system: &mut System<D>) -> Result<(), RunError> {
        let parts = self.parts_now(system);
        if parts == 1 {
            self.depart(system)?;
            return self.arrive(system);
        }
        self.finish(system);
        system.info.parts = system.info.parts.max(parts);
        system.clock.divide(parts);
        let all = (0..parts).try_for_each(|_| {
            self.depart(system)?;
            self.arrive(system)
        });
        // with the length of a part, and at its time
        self.finish(system);
        system.clock.join(all.is_ok());
        all
    }

    fn changed(&mut self, system: &mut System<D>) {
        self.finish(system);
        system.forces_held(system.given());
    }

    fn finish(&mut self, system: &mut System<D>) {
        if self.pending {
            let (t, dt) = (system.clock.time(), system.clock.dt());
            let f = system.inertia.as_ref().map_or(&system.f, |i| &i.push);
            self.verlet.kick(&system.body, &mut system.v, f, dt);
            let all = system.prescribed.all();
            all.for_each(|p| p.whole_velocity(&mut system.v, [t, dt]));
            self.pending = false;
        }
    }

    fn solved(&self) -> Option<Solved> {
        None
    }

    fn accepts(&self, _: &mut System<D>) -> Result<(), BuildError> {
        Ok(())
    }

    fn split(&mut self) -> Option<&mut dyn SplitStep<D>> {
        Some(self)
    }
}

impl<const D: usize> SplitStep<D> for VelocityVerlet {
    fn depart(&mut self, system: &mut System<D>) -> Result<f64, RunError> {
        let (t, dt) = (system.clock.time(), system.clock.dt());
        system.update_toughness(t + dt)?;
        let pressed = system.pressed();
        if system.holds_others() {
            system.accelerate();
        }
        let (u, v, f) = (&system.u, &mut system.v, &mut system.f);
        let whole = !self.pending;
        let all = system.prescribed.all_mut();
        all.for_each(|p| p.before_drift(u, v, f, [t, dt], whole));
        // linear springs may go through each other: they know no distance that is too far for a step
        let linear = |m: &ConstitutiveModel| match m.laws {
            Laws::Springs(_) | Laws::Micromoduli(_) => true,
            Laws::Bond(_) | Laws::Solid(_) | Laws::Atoms(_) => false,
        };
        let limit = match system.constitutive.all().all(linear) {
            true => f64::INFINITY,
            false => system.body.spacing(),
        };
        let f = system.inertia.as_ref().map_or(&system.f, |i| &i.push);
        let fastest = system.body.most(self.verlet.advance(
            &system.body,
            &mut system.u,
            &mut system.v,
            f,
            dt,
            self.pending,
            limit,
        ));
        if !(fastest < limit * limit) {
            let error = refused(system, limit);
            self.retreat(system, limit);
            system.prescribed.refused(&mut system.v, [t, dt]);
            return Err(error);
        }
        system.clock.forward();
        if let Some(contact) = &mut system.contact {
            contact.central.moved(fastest.sqrt());
        }
        let t = system.clock.time();
        let all = system.prescribed.all();
        all.for_each(|p| p.after_drift(&mut system.u, [t, dt]));
        self.path = fastest.sqrt();
        // whoever asks for velocities now gets those of the middle
        self.pending = false;
        if let Err(error) = system.spread_after(t - dt, dt, pressed) {
            self.step_back(system);
            return Err(error);
        }
        system.account_work(1.0, 0.5 * dt);
        Ok(self.path)
    }

    fn arrive(&mut self, system: &mut System<D>) -> Result<(), RunError> {
        let (t, dt, path) = (system.clock.time(), system.clock.dt(), self.path);
        if let Some(contact) = &mut system.contact {
            contact.begin_step(&system.body, &system.v, dt);
        }
        let all = system.applied.all();
        all.for_each(|x| x.begin_step(&system.body, &system.v, [t, dt], path));
        system.heal(t);
        system.forces(true, system.clock.step_end());
        if let Some(fault) = system.fault {
            let error = fault.explained(system.clock.step());
            system.retreat_diffusions();
            system.acting_retreat();
            self.step_back(system);
            return Err(error);
        }
        let change = system.inertia.as_ref().map(|i| i.change(dt));
        system.account_constraints(t, dt, change.as_ref());
        self.pending = true;
        Ok(())
    }

    fn turn_back(&mut self, system: &mut System<D>) {
        system.retreat_diffusions();
        self.step_back(system);
    }
}

impl VelocityVerlet {
    /// Of a system whose steps are `dt` long (time).
    pub fn new<const D: usize>(
        spec: &Spec,
        simd: Simd,
        system: &System<D>,
        limits: &Limits,
        dt: f64,
    ) -> Self {
        VelocityVerlet {
            verlet: Verlet::new(simd, &system.body),
            path: 0.0,
            pending: false,
            fraction: match spec.run.schedule.time_step {
                TimeStep::Fixed(_) => None,
                TimeStep::Fraction(_) | TimeStep::Auto => {
                    Some(dt / limits.bond).filter(|x| *x > 0.0)
                }
            },
        }
    }

    /// In how many parts the next step is done: the stable step of bonds whose stiffness is that of a material goes with their length (that of
    /// waves through the shortest one, Courant, Friedrichs & Lewy 1928).
    fn parts_now<const D: usize>(&self, system: &mut System<D>) -> u32 {
        let Some(fraction) = self.fraction else {
            return 1;
        };
        system.refresh_images();
        let shortest = system.interaction.shortest(&system.body, view(&system.u));
        let most = fraction.max(HELD);
        let parts = (fraction / (most * shortest)).ceil().clamp(1.0, PARTS) as u32;
        let parts = parts.max(parts_of_rigid_bodies(system, fraction));
        system.body.most(f64::from(parts)) as u32
    }

    /// Velocities and displacements of before a drift that went no further than `limit` (length), or of the last kick alone.
    fn retreat<const D: usize>(&mut self, system: &mut System<D>, limit: f64) {
        let dt = system.clock.dt();
        let f = system.inertia.as_ref().map_or(&system.f, |i| &i.push);
        let (body, u, v) = (&system.body, &mut system.u, &mut system.v);
        self.verlet.retreat(body, u, v, f, dt, limit);
        self.pending = false;
    }

    /// Back to the step before: where it was, and with the forces that were.
    fn step_back<const D: usize>(&mut self, system: &mut System<D>) {
        let dt = system.clock.dt();
        for &s in system.body.slots() {
            for a in 0..D {
                system.u[a][s as usize] -= dt * system.v[a][s as usize];
            }
        }
        system.clock.back();
        if let Some(contact) = &mut system.contact {
            contact.central.moved(self.path);
        }
        system.forces(true, system.clock.start());
        self.retreat(system, 0.0);
    }
}

/// In how many parts what touches rigid bodies asks for: the deeper a point is below a surface, the stiffer it is held.
fn parts_of_rigid_bodies<const D: usize>(system: &System<D>, fraction: f64) -> u32 {
    let dt = system.clock.dt();
    let bonds = (2.0 * fraction / dt).powi(2);
    let stiffest = system.applied.rigid.iter().map(|i| i.stiffened(bonds));
    let lambda = stiffest.fold(0.0, f64::max);
    (0.5 * dt * lambda.sqrt() / HELD).ceil().clamp(1.0, PARTS) as u32
}

/// Which point the pass refused, and why: one that is nowhere, else the one that went furthest.
fn refused<const D: usize>(system: &System<D>, limit: f64) -> RunError {
    let step = system.clock.step() + 1;
    let path = |i: usize| {
        let square = (0..D).map(|a| (system.clock.dt() * system.v[a][i]).powi(2));
        square.sum::<f64>().sqrt()
    };
    // what is not a number is furthest
    let far = |i: usize| {
        if path(i).is_nan() {
            f64::INFINITY
        } else {
            path(i)
        }
    };
    let body = &system.body;
    let nowhere = |i: usize| (0..D).any(|a| !system.u[a][i].is_finite());
    let slots = || body.slots().iter().map(|s| *s as usize).enumerate();
    let number = |found: Option<(usize, usize)>| {
        let own = found.map_or(f64::INFINITY, |(id, _)| body.id_of_all(id) as f64);
        body.least(own)
    };
    // of all ranks the first that is nowhere, else the one that went furthest
    let mut id = number(slots().find(|(_, i)| nowhere(*i)));
    if id == f64::INFINITY {
        let furthest = body.most(slots().fold(0.0, |most, (_, i)| far(i).max(most)));
        id = number(slots().find(|(_, i)| far(*i) == furthest));
    }
    let own = slots()
        .find(|(n, _)| body.id_of_all(*n) as f64 == id)
        .map(|(_, i)| i);
    let of = |x: Option<f64>| body.sum(x.into_iter());
    let position = crate::array::from_fn(|a| {
        of(own
            .filter(|_| a < D)
            .map(|i| body.position(i)[a] + system.u[a][i]))
    });
    let path = of(own.map(path));
    let (id, nowhere) = (id as u64 + 1, own.is_some_and(nowhere));
    if body.exchange().any(nowhere) || !path.is_finite() {
        return RunError::NotFinite { step, id, position };
    }
    let pushed = is_pushed(system, own);
    RunError::TooFast {
        step,
        id,
        position,
        path,
        spacing: limit,
        contact: body
            .exchange()
            .any(pushed)
            .then_some(system.info.contact_step),
    }
}

/// Does a slot's repulsion hold more energy than its bonds? All ranks ask at once, the others of none.
fn is_pushed<const D: usize>(system: &System<D>, slot: Option<usize>) -> bool {
    let mut seen = PointEnergies::default();
    system.interaction.observe(
        &system.body,
        view(&system.u),
        &mut seen.for_slots(system.body.len()),
    );
    if let Some(contact) = &system.contact {
        let repulsion = &mut seen.repulsion;
        contact
            .central
            .add_energy_density(&system.body, &system.u, repulsion);
    }
    slot.is_some_and(|slot| seen.repulsion[slot] > seen.strain[slot])
}
