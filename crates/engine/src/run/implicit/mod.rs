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

pub(super) mod state;

use self::state::Implicit;
use super::equilibrium::tried::{Inertia, Tried};
use super::model::Model;
use crate::body::Field;
use crate::condition::rigid::Wrench;
use crate::error::{BuildError, RunError, SolveError};
use crate::interaction::friction::Pressed;
use crate::quantity::rounded;
use crate::spec::{Newmark, Release, Solver, Spec};
use crate::statics::{self, Support};

/// Can bonds break?
pub(super) fn breaks(spec: &Spec) -> bool {
    spec.materials.iter().any(|m| m.fracture.is_some())
        || spec.interfaces.iter().any(|i| i.fracture.is_some())
}

impl<const D: usize> Model<D> {
    /// Has all that acts a tangent, and is the method stable?
    pub(super) fn check_implicit(&self, options: Newmark, spec: &Spec) -> Result<(), BuildError> {
        let Newmark {
            beta, gamma, alpha, ..
        } = options;
        let hht = Newmark::hht(alpha);
        if !(-1.0 / 3.0..=0.0).contains(&alpha) {
            return Err(BuildError::invalid(
                "schedule.alpha",
                format!("alpha is {alpha}, expected a number from -1/3 to 0"),
            )
            .help("write alpha = -0.1, or leave it out"));
        }
        if alpha != 0.0 && (beta - hht.beta).hypot(gamma - hht.gamma) > 1e-12 {
            return Err(BuildError::conflict(
                "schedule.alpha",
                format!("beta = {beta} and gamma = {gamma} do not go with alpha = {alpha}, which takes (1 - alpha)²/4 and 1/2 - alpha"),
            )
            .help("leave beta and gamma out"));
        }
        if !(gamma >= 0.5 && 2.0 * beta >= gamma && beta.is_finite()) {
            let path = match gamma >= 0.5 {
                true => "schedule.beta",
                false => "schedule.gamma",
            };
            return Err(BuildError::invalid(
                path,
                format!("beta = {beta} and gamma = {gamma} are not stable at any step, which takes 2 beta ≥ gamma ≥ 0.5"),
            )
            .help("leave both out: 0.25 and 0.5 are of second order and lose no energy"));
        }
        let explicit = "integrator = \"verlet\" knows it; or leave it out";
        self.knows_its_time("schedule.integrator", true)?;
        if breaks(spec) && spec.release == Release::AfterForce {
            return Err(BuildError::unsupported(
                "materials[0].fracture",
                "bonds that pull once more after they broke have no place in an implicit step",
            )
            .help("leave release out, or take integrator = \"verlet\""));
        }
        if self.applied.free().next().is_some() && self.held().unknowns() == 0 {
            return Err(BuildError::unsupported(
                "indenters",
                "an indenter with a mass moves implicitly beside points that are free, and all are held",
            )
            .help("take integrator = \"verlet\""));
        }
        if let Some(what) = self.applied.without_tangent() {
            return Err(BuildError::unsupported(
                "conditions",
                format!("{what} has no tangent, which an implicit step needs"),
            )
            .help(explicit));
        }
        let equations = Implicit::<D>::new(options).equations.options;
        if self.factored(equations, &self.held()) {
            self.enough_memory_for_rows()?;
        }
        let asymmetry = self.interaction.asymmetry();
        if asymmetry > statics::SYMMETRIC && options.solver == Solver::ConjugateGradients {
            return Err(BuildError::unsupported(
                "schedule.solver",
                format!("conjugate gradients need a symmetric body, and action is not reaction in this one (asymmetry {})", rounded(asymmetry, 2)),
            )
            .help("write solver = \"direct\""));
        }
        Ok(())
    }

    /// One step. On an error the state is that of the step before.
    pub(super) fn implicit_step(&mut self) -> Result<(), RunError> {
        let (t, dt) = (self.clock.time(), self.clock.dt());
        self.update_toughness(t + dt)?;
        self.spread(t, dt)?;
        self.pay(0.5, 0.0);
        let Some(mut state) = self.implicit.take() else {
            return Ok(());
        };
        let (u, v, f) = (self.u.clone(), self.v.clone(), self.f.clone());
        let (accelerations, bodies) = (state.acceleration.clone(), state.bodies.clone());
        self.acting_depart(Pressed::Now);
        self.interaction.last(dt);
        let moved = self.move_implicitly(&mut state);
        let error = match (moved, self.fault) {
            (Err(error), _) => Some(self.not_solved(error)),
            (Ok(()), Some(fault)) => Some(self.explained(fault)),
            (Ok(()), None) => None,
        };
        if let Some(error) = error {
            self.interaction.last(0.0);
            (self.u, self.v) = (u, v);
            (state.acceleration, state.bodies) = (accelerations, bodies);
            state.equations.forget();
            self.implicit = Some(state);
            self.retreat_transfers();
            self.clock.back();
            self.acting_retreat();
            // and the forces of before are found from there
            self.acting_depart(Pressed::Now);
            self.look_again();
            self.forces_held(self.clock.trial());
            return Err(error);
        }
        self.acting_arrive(&u);
        let end = self.clock.time();
        let change = self.coupled_change(&v);
        self.account_constraints(end, dt, change.as_ref());
        self.accounts.numerical += self.taken([&u, &v, &f], change.as_ref(), &state.held);
        if state.breaks {
            self.let_go(&mut state);
        }
        self.implicit = Some(state);
        self.pay(0.5, 0.0);
        Ok(())
    }

    /// `Δu·½(F₀ + F₁) − Δ(½ v·m v)` on free components (energy).
    fn taken(
        &self,
        [u, v, f]: [&Field<D>; 3],
        change: Option<&Field<D>>,
        support: &Support<D>,
    ) -> f64 {
        let mut taken = 0.0;
        for (free, &s) in support.free.iter().zip(&self.body.slots) {
            let i = s as usize;
            let rho = self.body.density.at(i);
            let mut each = 0.0;
            for a in (0..D).filter(|a| free[*a]) {
                let work = 0.5 * (f[a][i] + self.f[a][i]) * (self.u[a][i] - u[a][i]);
                let [before, now] = [v[a][i], self.v[a][i]];
                let momentum = match change {
                    None => rho * (now - before),
                    Some(change) => change[a][i],
                };
                each += work - 0.5 * momentum * (now + before);
            }
            taken += each * self.body.volume.at(i);
        }
        taken
    }

    /// Breaks the bonds that the end of a step stretched too far, and lets forces and accelerations jump.
    fn let_go(&mut self, state: &mut Implicit<D>) {
        let before = self.accounts.broken;
        let whole = self.f.clone();
        self.evolve();
        if self.accounts.broken == before {
            return;
        }
        state.equations.forget();
        self.forces_held(self.clock.trial());
        for (a, &s) in state.acceleration.iter_mut().zip(&self.body.slots) {
            let i = s as usize;
            let rho = self.body.density.at(i);
            for axis in 0..D {
                a[axis] += (self.f[axis][i] - whole[axis][i]) / rho;
            }
        }
    }

    /// Displacements, velocities and forces of the step's end, before bonds break; told points go where they are told.
    fn move_implicitly(&mut self, state: &mut Implicit<D>) -> Result<(), SolveError> {
        let (t, dt) = (self.clock.time(), self.clock.dt());
        let alpha = state.options.alpha;
        let f = self.f.clone();
        let coupled = match self.inertia.take() {
            None => None,
            Some(mut inertia) => {
                let a = self.accelerations(&mut inertia);
                self.inertia = Some(inertia);
                Some(a)
            }
        };
        let (u, v, force) = (&self.u, &mut self.v, &mut self.f);
        let all = self.prescribed.all_mut();
        all.for_each(|p| p.before_drift(u, v, force, [t, dt], true));
        self.clock.forward();
        self.fault = None;
        if let Some(what) = self.applied.without_tangent() {
            return Err(SolveError::NoTangent { what });
        }
        let t = self.clock.time();
        let support = self.held();
        if state.held != support {
            state.equations.forget();
            state.held = support.clone();
        }
        // as if accelerations stayed what they are
        let mut a = vec![[0.0; D]; self.body.points()];
        for (n, &s) in self.body.slots.iter().enumerate() {
            let i = s as usize;
            for axis in (0..D).filter(|axis| support.free[n][*axis]) {
                let rate = match state.acceleration.get(n) {
                    Some(known) => known[axis],
                    None if let Some(coupled) = &coupled => coupled[n][axis],
                    None => self.f[axis][i] / self.body.density.at(i),
                };
                self.u[axis][i] += dt * (self.v[axis][i] + 0.5 * dt * rate);
                self.v[axis][i] += dt * rate;
                a[n][axis] = rate;
            }
        }
        if coupled.is_some() {
            self.prescribed_accelerations(&mut a);
        }
        for p in self.prescribed.all() {
            p.after_drift(&mut self.u, [t, dt]);
            p.whole_velocity(&mut self.v, [t, dt]);
        }
        self.applied.rigid.iter_mut().for_each(|i| i.place(t));
        self.look_again();
        let start = Tried {
            x: self.values(&self.u),
            v: self.values(&self.v),
            a,
            bodies: self.bodies_before(state),
        };
        if support.unknowns() > 0 {
            let inertia = self.inertia(state, t, &f);
            let (solved, found) =
                self.solve_from(&mut state.equations, &support, start, Some(&inertia))?;
            state.equations.solved = solved;
            // trials may have gone further than what was taken
            self.set_values(&found.x);
            self.set_velocities_of(&found);
            self.place_bodies(&found, &inertia);
            if alpha != 0.0 {
                state.acceleration = found.a;
                state.bodies = found.bodies;
            }
        }
        match state.breaks {
            true => self.forces_held(self.clock.trial()),
            // with whole velocities: nothing is added to them
            false => self.forces(true, self.clock.trial()),
        }
        Ok(())
    }

    /// `(m a, dL/dt)` of rigid bodies with mass where the step began.
    fn bodies_before(&self, state: &Implicit<D>) -> Vec<Wrench> {
        let known = |n: usize| state.bodies.get(n).copied();
        let each = self.applied.free().enumerate();
        each.map(|(n, i)| known(n).unwrap_or_else(|| i.departed_under()))
            .collect()
    }

    /// `f` are the force densities at the start of the step.
    fn inertia(&mut self, state: &Implicit<D>, t: f64, f: &Field<D>) -> Inertia<D> {
        let options = state.options;
        let velocity = options.gamma / (options.beta * self.clock.dt());
        let acceleration = 1.0 / (options.beta * self.clock.dt() * self.clock.dt());
        let viscosity = self.applied.viscosity(&self.body, t);
        let volume = |i: usize| self.body.volume.at(i);
        let weight = 1.0 / (1.0 + options.alpha);
        let mass = self.by_id(|i| weight * self.body.density.at(i) * volume(i));
        let drag = self.by_id(|i| viscosity[i] * volume(i));
        let both = mass.iter().zip(&drag);
        let past = match options.alpha != 0.0 {
            true => self
                .by_id(|i| std::array::from_fn(|a| options.alpha * weight * volume(i) * f[a][i])),
            false => vec![],
        };
        let free = self.applied.free();
        let part = options.alpha * weight;
        let bodies_before = free.map(|i| i.departed_under().map(|f| part * f)).collect();
        let coupled = self.inertia.as_ref().map(|i| i.masses.clone());
        let own = if coupled.is_some() { 0.0 } else { acceleration };
        Inertia {
            added: both.map(|(m, c)| own * m + velocity * c).collect(),
            mass,
            coupled,
            past,
            weight,
            velocity,
            acceleration,
            step: self.clock.dt(),
            bodies: self.bodies_before(state),
            bodies_before,
        }
    }

    fn not_solved(&self, error: SolveError) -> RunError {
        RunError::Implicit {
            step: self.clock.step(),
            position: self.place_of(&error),
            error,
        }
    }
}
