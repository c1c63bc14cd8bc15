//! Motion in time by Newmark's method (N. M. Newmark 1959, A method of computation for structural dynamics, J. Eng. Mech. Div.
//! ASCE 85 (3), 67–94):
//!
//! `u₁ = u₀ + Δt v₀ + Δt² ((½ − β) a₀ + β a₁)`, `v₁ = v₀ + Δt ((1 − γ) a₀ + γ a₁)`, `ρ a₁ = f(u₁, v₁, t₁)`
//!
//! in displacements, velocities and force densities, as velocity Verlet has them: `a = f/ρ`. The equations are solved by the
//! Newton's method of statics, with `m/(βΔt²)` added to its tangents. `2β ≥ γ ≥ ½` is stable at any step for linear bodies; with
//! β = ¼, γ = ½ those keep their energy to round-off, because `Δ(½ v·m v) = Δu·½(F₀ + F₁)` then. The method of Hilber, Hughes and
//! Taylor ([`Newmark::hht`]) has `ρ a₁ = (1 + α) f₁ − α f₀` in place of the last equation.
//!
//! What a method takes, `Δu·½(F₀ + F₁) − Δ(½ v·m v)` on the points that forces move, is an account of its own: what the balance misses
//! then is the error of the trapezoidal rule along the path of nonlinear forces, as in statics.
//!
//! Bonds break at the end of a step, at its displacements: they are whole within it, and what they hold there is released. Forces jump
//! then, and accelerations with them. So a crack grows by no more than the reach of a bond in a step.

use super::{SplitStep, Stepper};
use crate::body::{Body, Field};
use crate::boundary_condition::rigid::Wrench;
use crate::error::{BuildError, RunError, SolveError};
use crate::interaction::friction::Pressed;
use crate::law::descriptor::Memory;
use crate::message;
use crate::quantity::Dimension;
use crate::run::equilibrium::problem::Problem;
use crate::run::equilibrium::state::StaticState;
use crate::run::equilibrium::tried::{Inertia, Tried};
use crate::run::equilibrium::whole::unknowns;
use crate::run::implicit;
use crate::run::system::{Regime, System};
use crate::run::time_step::Limits;
use crate::spec::{Newmark, Spec};
use crate::state::Archive;
use crate::statics::{Solved, Support};

/// Factors that may serve again, and for whom.
pub(super) struct NewmarkStepper<const D: usize> {
    options: Newmark,
    equations: StaticState<D>,
    /// What was held when the factors were made.
    held: Support<D>,
    /// `[N]` accelerations at the end of the last step; empty: those of the forces.
    acceleration: Vec<[f64; D]>,
    /// `(m a, dL/dt)` of rigid bodies with mass at the end of the last step; empty: what acts on them.
    bodies: Vec<Wrench>,
    /// Can bonds break or heal?
    breaks: bool,
}

impl<const D: usize> Stepper<D> for NewmarkStepper<D> {
    fn archive(&mut self, body: &Body<D>, archive: &mut Archive<'_>) {
        body.archive_if_any(archive, "acceleration", &mut self.acceleration, [0.0; D]);
        archive.list("rigid_bodies", &mut self.bodies);
        body.archive_if_any(archive, "free", &mut self.held.free, [true; D]);
        self.equations.archive_kept(body, &self.held, archive);
    }

    fn regime(&self) -> Regime {
        Regime {
            implicit: true,
            ..Regime::default()
        }
    }

    fn start(&mut self, system: &mut System<D>, bonds: bool) {
        self.acceleration.clear();
        system.begin(bonds);
    }

    fn step(&mut self, system: &mut System<D>) -> Result<(), RunError> {
        let (t, dt) = (system.clock.time(), system.clock.dt());
        system.update_toughness(t + dt)?;
        system.spread(t, dt)?;
        system.account_work(0.5, 0.0);
        let pressed = system.pressed();
        let (u, v, f) = (system.u.clone(), system.v.clone(), system.f.clone());
        let (accelerations, bodies) = (self.acceleration.clone(), self.bodies.clone());
        system.acting_depart(Pressed::Now);
        system.interaction.last(dt);
        let moved = self.advance(system);
        let error = match (moved, system.fault) {
            (Err(error), _) => Some(not_solved(system, error)),
            (Ok(()), Some(fault)) => Some(fault.explained(system.clock.step())),
            (Ok(()), None) => None,
        };
        if let Some(error) = error {
            system.interaction.last(0.0);
            (system.u, system.v) = (u, v);
            (self.acceleration, self.bodies) = (accelerations, bodies);
            self.equations.forget();
            system.retreat_diffusions();
            system.clock.back();
            system.acting_retreat();
            // and the forces of before are found from there
            system.acting_depart(Pressed::Now);
            system.invalidate_neighbours();
            system.forces_held(system.clock.trial());
            return Err(error);
        }
        system.acting_arrive(&u);
        system.heat_by_deformation(pressed);
        let end = system.clock.time();
        let change = system.coupled_change(&v);
        system.account_constraints(end, dt, change.as_ref());
        system.accounts.numerical += self.taken(system, [&u, &v, &f], change.as_ref());
        if self.breaks {
            self.break_bonds(system);
        }
        system.account_work(0.5, 0.0);
        Ok(())
    }

    fn changed(&mut self, system: &mut System<D>) {
        self.acceleration.clear();
        self.equations.forget();
        system.forces_held(system.given());
    }

    /// They are those of whole steps.
    fn finish(&mut self, _: &mut System<D>) {}

    fn solved(&self) -> Option<Solved> {
        Some(self.equations.solved)
    }

    fn accepts(&self, system: &mut System<D>) -> Result<(), BuildError> {
        system.check_implicit(self.options)
    }

    fn split(&mut self) -> Option<&mut dyn SplitStep<D>> {
        None
    }
}

impl<const D: usize> NewmarkStepper<D> {
    /// Of a system whose steps are `dt` long (time).
    ///
    /// # Errors
    /// Something that acts has no tangent, or the method is not stable.
    pub fn of(
        options: Newmark,
        spec: &Spec,
        system: &mut System<D>,
        limits: &Limits,
        dt: f64,
    ) -> Result<Self, BuildError> {
        system.check_implicit(options)?;
        let breaks = implicit::breaks(spec) || spec.damage.healing.is_some();
        let reach = system.info.horizon / system.info.spacing;
        if breaks && dt > reach * limits.bond {
            system.info.warnings.push(message![
                "bonds break at the end of a step: a crack grows by no more than a horizon in each, and a wave goes further than that in ",
                Dimension::TIME.of(dt),
                "; where cracks run, steps of ",
                Dimension::TIME.of(reach * limits.bond),
                " follow them",
            ]);
        }
        let named = system.constitutive.named();
        let mut memories = named.map(|law| law.memory().0);
        if dt > reach * limits.bond && memories.any(|m| m == Memory::Shock) {
            system.info.warnings.push(message![
                "viscosity spreads a shock over a horizon, and it goes further than that in ",
                Dimension::TIME.of(dt),
                "; where shocks run, steps of ",
                Dimension::TIME.of(reach * limits.bond),
                " follow them",
            ]);
        }
        Ok(NewmarkStepper {
            options,
            equations: StaticState::new(implicit::equations(options)),
            held: Support::none(0),
            acceleration: vec![],
            bodies: vec![],
            breaks,
        })
    }

    /// `Δu·½(F₀ + F₁) − Δ(½ v·m v)` on free components (energy).
    fn taken(
        &self,
        system: &System<D>,
        [u, v, f]: [&Field<D>; 3],
        change: Option<&Field<D>>,
    ) -> f64 {
        let held = self.held.free.iter().zip(system.body.slots());
        system.body.sum(held.map(|(free, &s)| {
            let i = s as usize;
            let rho = system.body.density().at(i);
            let mut each = 0.0;
            for a in (0..D).filter(|a| free[*a]) {
                let work = 0.5 * (f[a][i] + system.f[a][i]) * (system.u[a][i] - u[a][i]);
                let [before, now] = [v[a][i], system.v[a][i]];
                let momentum = match change {
                    None => rho * (now - before),
                    Some(change) => change[a][i],
                };
                each += work - 0.5 * momentum * (now + before);
            }
            each * system.body.volume().at(i)
        }))
    }

    /// Heals bonds that the end of a step brought back, breaks those that it stretched too far, and lets forces and accelerations jump.
    fn break_bonds(&mut self, system: &mut System<D>) {
        let before = system.accounts.swept.broken;
        let whole = system.f.clone();
        let healed = system.heal(system.clock.time());
        system.evolve();
        let broke = system.accounts.swept.broken != before;
        if !system.body.exchange().any(healed || broke) {
            return;
        }
        self.equations.forget();
        system.forces_held(system.clock.trial());
        for (a, &s) in self.acceleration.iter_mut().zip(system.body.slots()) {
            let i = s as usize;
            let rho = system.body.density().at(i);
            for axis in 0..D {
                a[axis] += (system.f[axis][i] - whole[axis][i]) / rho;
            }
        }
    }

    /// Displacements, velocities and forces of the step's end, before bonds break; told points go where they are told.
    fn advance(&mut self, system: &mut System<D>) -> Result<(), SolveError> {
        let (t, dt) = (system.clock.time(), system.clock.dt());
        let alpha = self.options.alpha;
        let f = system.f.clone();
        let coupled = match system.inertia.take() {
            None => None,
            Some(mut inertia) => {
                let a = system.accelerations(&mut inertia);
                system.inertia = Some(inertia);
                Some(a)
            }
        };
        let (u, v, force) = (&system.u, &mut system.v, &mut system.f);
        let all = system.prescribed.all_mut();
        all.for_each(|p| p.before_drift(u, v, force, [t, dt], true));
        system.clock.forward();
        system.fault = None;
        if let Some(what) = system.applied.without_tangent() {
            return Err(SolveError::NoTangent { what });
        }
        let t = system.clock.time();
        let support = system.held();
        if system.body.exchange().any(self.held != support) {
            self.equations.forget();
            self.held = support.clone();
        }
        // as if accelerations stayed what they are
        let mut a = vec![[0.0; D]; system.body.points()];
        for (n, &s) in system.body.slots().iter().enumerate() {
            let i = s as usize;
            for axis in (0..D).filter(|axis| support.free[n][*axis]) {
                let rate = match self.acceleration.get(n) {
                    Some(known) => known[axis],
                    None if let Some(coupled) = &coupled => coupled[n][axis],
                    None => system.f[axis][i] / system.body.density().at(i),
                };
                system.u[axis][i] += dt * (system.v[axis][i] + 0.5 * dt * rate);
                system.v[axis][i] += dt * rate;
                a[n][axis] = rate;
            }
        }
        if coupled.is_some() {
            system.prescribed_accelerations(&mut a);
        }
        for p in system.prescribed.all() {
            p.after_drift(&mut system.u, [t, dt]);
            p.whole_velocity(&mut system.v, [t, dt]);
        }
        system.applied.rigid.iter_mut().for_each(|i| i.place(t));
        system.invalidate_neighbours();
        let start = Tried {
            x: system.body.values(&system.u),
            v: system.body.values(&system.v),
            a,
            bodies: self.bodies_before(system),
        };
        if unknowns(&system.body, &support) > 0 {
            let inertia = self.inertia(system, t, &f);
            let mut problem = Problem::of(system);
            let (solved, found) =
                problem.solve_from(&mut self.equations, &support, start, Some(&inertia))?;
            self.equations.solved = solved;
            // trials may have gone further than what was taken
            problem.go_to(&found, &inertia);
            if alpha != 0.0 {
                self.acceleration = found.a;
                self.bodies = found.bodies;
            }
        }
        match self.breaks {
            true => system.forces_held(system.clock.trial()),
            // with whole velocities: nothing is added to them
            false => system.forces(true, system.clock.trial()),
        }
        Ok(())
    }

    /// `(m a, dL/dt)` of rigid bodies with mass where the step began.
    fn bodies_before(&self, system: &System<D>) -> Vec<Wrench> {
        let known = |n: usize| self.bodies.get(n).copied();
        let each = system.applied.free().enumerate();
        each.map(|(n, i)| known(n).unwrap_or_else(|| i.departed_under()))
            .collect()
    }

    /// `f` are the force densities at the start of the step.
    fn inertia(&self, system: &System<D>, t: f64, f: &Field<D>) -> Inertia<D> {
        let options = self.options;
        let velocity = options.gamma / (options.beta * system.clock.dt());
        let acceleration = 1.0 / (options.beta * system.clock.dt() * system.clock.dt());
        let viscosity = system.applied.viscosity(&system.body, t);
        let volume = |i: usize| system.body.volume().at(i);
        let weight = 1.0 / (1.0 + options.alpha);
        let mass = system
            .body
            .by_id(|i| weight * system.body.density().at(i) * volume(i));
        let drag = system.body.by_id(|i| viscosity[i] * volume(i));
        let both = mass.iter().zip(&drag);
        let past = match options.alpha != 0.0 {
            true => system
                .body
                .by_id(|i| crate::array::from_fn(|a| options.alpha * weight * volume(i) * f[a][i])),
            false => vec![],
        };
        let free = system.applied.free();
        let part = options.alpha * weight;
        let bodies_before = free.map(|i| i.departed_under().map(|f| part * f)).collect();
        let coupled = system.inertia.as_ref().map(|i| i.masses.clone());
        let own = if coupled.is_some() { 0.0 } else { acceleration };
        Inertia {
            added: both.map(|(m, c)| own * m + velocity * c).collect(),
            mass,
            coupled,
            past,
            weight,
            velocity,
            acceleration,
            step: system.clock.dt(),
            bodies: self.bodies_before(system),
            bodies_before,
        }
    }
}

fn not_solved<const D: usize>(system: &System<D>, error: SolveError) -> RunError {
    RunError::Implicit {
        step: system.clock.step(),
        position: system.place_of(&error),
        error,
    }
}
