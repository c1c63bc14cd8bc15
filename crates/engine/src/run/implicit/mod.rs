//! Motion in time by Newmark's method (N. M. Newmark 1959, A method of computation for structural dynamics, J. Eng. Mech. Div.
//! ASCE 85 (3), 67–94):
//!
//! `u₁ = u₀ + Δt v₀ + Δt² ((½ − β) a₀ + β a₁)`, `v₁ = v₀ + Δt ((1 − γ) a₀ + γ a₁)`, `ρ a₁ = f(u₁, v₁, t₁)`
//!
//! in displacements, velocities and force densities, as velocity Verlet has them: `a = f/ρ`. The equations are solved by the
//! Newton's method of statics, with `m/(βΔt²)` added to its tangents. `2β ≥ γ ≥ ½` is stable at any step for linear bodies; with
//! β = ¼, γ = ½ those keep their energy to round-off, because `Δ(½ v·m v) = Δu·½(F₀ + F₁)` then.

pub(super) mod state;

use self::state::Implicit;
use super::Simulation;
use super::equilibrium::tried::{Inertia, Tried};
use super::model::Model;
use crate::condition::driven::Driven;
use crate::condition::load::{Load, LoadKind};
use crate::error::{BuildError, RunError, SolveError};
use crate::quantity::rounded;
use crate::spec::{Newmark, Solver, Spec};
use crate::statics::{self, Support};

/// Loads of the spec and those from outside.
fn loads<'a, const D: usize>(
    own: &'a [Load<D>],
    driven: &'a [Driven<D>],
) -> impl Iterator<Item = &'a Load<D>> {
    let driven = driven.iter().filter_map(|d| match d {
        Driven::Load(l) => Some(l),
        Driven::Indenter(_) => None,
    });
    own.iter().chain(driven)
}

impl<const D: usize> Model<D> {
    /// Has all that acts a tangent, and is the method stable?
    pub(super) fn check_implicit(&self, options: Newmark, spec: &Spec) -> Result<(), BuildError> {
        let Newmark { beta, gamma, .. } = options;
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
        self.knows_no_time("schedule.integrator")?;
        if let Some(n) = spec.materials.iter().position(|m| m.fracture.is_some()) {
            return Err(BuildError::unsupported(
                format!("materials[{n}].fracture"),
                "bonds that break within an implicit step are not supported",
            )
            .help(explicit));
        }
        if let Some(n) = spec.interfaces.iter().position(|i| i.fracture.is_some()) {
            return Err(BuildError::unsupported(
                format!("interface[{n}].fracture"),
                "bonds that break within an implicit step are not supported",
            )
            .help(explicit));
        }
        if spec.contact.is_some() {
            return Err(BuildError::unsupported(
                "contact",
                "contact has no tangent, which an implicit step needs",
            )
            .help("write contact = false, or integrator = \"verlet\""));
        }
        if !self.indenters.is_empty() {
            return Err(BuildError::unsupported(
                "indenters",
                "an indenter has no tangent, which an implicit step needs",
            )
            .help(explicit));
        }
        if let Err(SolveError::NoTangent { what }) = self.all_have_tangents() {
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

    fn all_have_tangents(&self) -> Result<(), SolveError> {
        let replaces = |l: &Load<D>| matches!(l.kind, LoadKind::Replace(_));
        let driven = self.driven.iter().any(|d| match d {
            Driven::Indenter(_) => true,
            Driven::Load(l) => replaces(l),
        });
        let own = |l: &Load<D>| matches!(l.kind, LoadKind::Own(_));
        let what = match () {
            () if self.loads.iter().any(own) => "a force of the program",
            () if self.loads.iter().any(replaces) => "a force that replaces all others",
            () if !self.indenters.is_empty() || driven => "an indenter or a force from outside",
            () if self.contact.is_some() => "contact",
            () => return Ok(()),
        };
        Err(SolveError::NoTangent { what })
    }

    /// Which components the forces move.
    fn held(&self) -> Support<D> {
        let mut support = self.support();
        let still = self.still.slots().iter().map(|s| *s as usize);
        let still = still.flat_map(|s| (0..D).map(move |a| (s, a)));
        let carried = self.carried.holds().filter(|(_, a)| *a < D);
        let told: Vec<(usize, usize)> = still.chain(carried).collect();
        if !told.is_empty() {
            let mut id = vec![0u32; self.body.len];
            for (n, &s) in self.body.slots.iter().enumerate() {
                id[s as usize] = n as u32;
            }
            for (slot, a) in told {
                support.free[id[slot] as usize][a] = false;
            }
        }
        support
    }

    /// One step. On an error the state is that of the step before.
    pub(super) fn implicit_step(&mut self) -> Result<(), RunError> {
        self.spread(self.time(), self.dt)?;
        self.pay(0.5, 0.0);
        let Some(mut state) = self.implicit.take() else {
            return Ok(());
        };
        let (u, v) = (self.u.clone(), self.v.clone());
        let before: Vec<Vec<[f64; D]>> = loads(&self.loads, &self.driven)
            .map(|l| l.acting().to_vec())
            .collect();
        let moved = self.move_implicitly(&mut state);
        self.implicit = Some(state);
        let (t, dt) = (self.time(), self.dt);
        let error = match (moved, self.fault) {
            (Err(error), _) => Some(self.not_solved(error)),
            (Ok(()), Some(fault)) => Some(self.explained(fault)),
            (Ok(()), None) => None,
        };
        if let Some(error) = error {
            (self.u, self.v) = (u, v);
            self.retreat_transfers();
            self.step -= 1;
            self.forces_held();
            return Err(error);
        }
        let (body, now) = (&self.body, &self.u);
        let driven = self.driven.iter_mut().filter_map(|d| match d {
            Driven::Load(l) => Some(l),
            Driven::Indenter(_) => None,
        });
        for (load, before) in self.loads.iter_mut().chain(driven).zip(&before) {
            load.account(body, before, |i| {
                std::array::from_fn(|a| now[a][i] - u[a][i])
            });
        }
        for c in &mut self.constraints {
            c.end(&self.body, &self.u, &self.f, t, dt);
        }
        self.pay(0.5, 0.0);
        Ok(())
    }

    /// Displacements, velocities and forces of the step's end; told points go where they are told.
    fn move_implicitly(&mut self, state: &mut Implicit<D>) -> Result<(), SolveError> {
        let (t, dt) = (self.time(), self.dt);
        for c in &mut self.constraints {
            c.begin(&self.u, &mut self.v, &mut self.f, t, dt);
        }
        self.still.begin(&mut self.v, &mut self.f, true);
        self.carried.begin(&self.u, &mut self.v, &mut self.f, dt);
        self.step += 1;
        self.fault = None;
        self.all_have_tangents()?;
        let t = self.time();
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
                let rate = self.f[axis][i] / self.body.density.at(i);
                self.u[axis][i] += dt * (self.v[axis][i] + 0.5 * dt * rate);
                self.v[axis][i] += dt * rate;
                a[n][axis] = rate;
            }
        }
        for c in &self.constraints {
            c.drift(&mut self.u, t, dt);
            c.settle(&mut self.v, t, dt);
        }
        self.carried.drift(&mut self.u);
        self.still.settle(&mut self.v);
        self.carried.settle(&mut self.v);
        let start = Tried {
            x: self.values(&self.u),
            v: self.values(&self.v),
            a,
        };
        if support.unknowns() > 0 {
            let inertia = self.inertia(state.options, t);
            let (solved, found) =
                self.solve_from(&mut state.equations, &support, start, Some(&inertia))?;
            state.equations.solved = solved;
            // trials may have gone further than what was taken
            self.set_values(&found.x);
            self.set_velocities_of(&found);
        }
        // with whole velocities: nothing is added to them
        self.forces(true, 0.0);
        Ok(())
    }

    fn inertia(&self, options: Newmark, t: f64) -> Inertia<D> {
        let velocity = options.gamma / (options.beta * self.dt);
        let acceleration = 1.0 / (options.beta * self.dt * self.dt);
        let mut viscosity = vec![0.0; self.body.len];
        for load in loads(&self.loads, &self.driven) {
            load.each_viscosity(t, |slot, c| viscosity[slot] += c);
        }
        let volume = |i: usize| self.body.volume.at(i);
        let mass = self.by_id(|i| self.body.density.at(i) * volume(i));
        let drag = self.by_id(|i| viscosity[i] * volume(i));
        let both = mass.iter().zip(&drag);
        Inertia {
            added: both.map(|(m, c)| acceleration * m + velocity * c).collect(),
            mass,
            velocity,
            acceleration,
            step: self.dt,
        }
    }

    fn not_solved(&self, error: SolveError) -> RunError {
        RunError::Implicit {
            step: self.step,
            position: self.place_of(&error),
            error,
        }
    }
}
