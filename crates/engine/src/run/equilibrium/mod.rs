//! Statics of a model: every step is an increment of load, and ends in equilibrium.

mod bordered;
mod equations;
mod held;
mod linear;
mod path;
mod relaxed;
mod sequence;
mod solve;
pub(super) mod state;
mod system;
pub(super) mod tried;

use self::state::StaticState;
use super::clock::Clock;
use super::model::Model;
use crate::body::{Field, zeros};
use crate::condition::load::{Load, LoadKind};
use crate::error::{BuildError, RunError, SolveError};
use crate::execute::memory;
use crate::interaction::Sweep;
use crate::interaction::friction::Pressed;
use crate::law::descriptor::Memory;
use crate::message;
use crate::quantity::{Dimension, rounded};
use crate::run::constitutive::{ConstitutiveModel, Laws};
use crate::space::Point;
use crate::spec::{Cycles, LinearBody, Method, Solver, Statics};
use crate::statics::modes::{self, Mode};
use crate::statics::{self, Solved, Support};

/// Rounds of breaking and new equilibrium within one increment.
const ROUNDS: usize = 10_000;

/// What linear increments leave out where bonds break.
const ONE_LOOK: &str = "linear increments look once which bonds break: those that the solution stretches too far are gone from the next increment on, and what their loss breaks is found there; write method = \"newton\" for an equilibrium after every break, or control = \"breaking\" for one bond after the other";

/// What an increment does.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    /// Of loads and reactions (energy).
    work: f64,
    /// What states that were released set free on their way to equilibrium.
    lost: f64,
    /// So much of it from where the increment began.
    relaxed: f64,
}

impl<const D: usize> Model<D> {
    /// The linear body about the displacements of now.
    pub(super) fn linear_now(&mut self) -> LinearBody<D> {
        self.refresh_images();
        LinearBody {
            mass: self.inertia.as_ref().map(|i| i.masses.matrix().clone()),
            ..statics::linear_body(&self.body, self.interaction.as_mut(), &self.u)
        }
    }

    /// The linear body about the reference.
    fn reference_body(&mut self) -> LinearBody<D> {
        statics::linear_body(&self.body, self.interaction.as_mut(), &self.body.at_rest())
    }

    /// Can this be brought into equilibrium at all?
    pub(super) fn check_statics(&self, options: Statics) -> Result<(), BuildError> {
        self.knows_its_time("statics", options.timed)?;
        let named = self.constitutive.all().filter_map(|m| m.named.as_ref());
        for (memory, name) in named.map(|n| n.memory()) {
            if memory != Memory::Nothing && options.method == Method::Linear {
                return Err(BuildError::unsupported(
                    "statics.method",
                    format!("the law {name} is linear about the reference only, and remembers"),
                )
                .help("write method = \"newton\" or \"relaxation\""));
            }
        }
        let support = self.held();
        if support.unknowns() == 0 {
            return Err(BuildError::ill_posed(
                "conditions",
                SolveError::NothingFree.to_string(),
            ));
        }
        if let Some(loose) = self.loose_parts(&support).first() {
            let x = self.body.position(self.body.slots[loose.point] as usize);
            let x = &x[..D];
            return Err(BuildError::ill_posed(
                "conditions",
                format!(
                    "the body is not held: {} of the part of {} points around {x:?} meets no resistance",
                    loose.motion, loose.points
                ),
            )
            .help("prescribe displacements that hold every connected part: D translations and its rotations"));
        }
        let mut constraints = self.prescribed.constraints.iter();
        let moving = constraints.any(|c| c.is_velocity());
        let replaced = self
            .applied
            .loads
            .iter()
            .any(|l| matches!(l.kind, LoadKind::Replace(_)));
        let own = |l: &Load<D>| matches!(l.kind, LoadKind::Own(_));
        if self.applied.loads.iter().any(own) {
            return Err(BuildError::unsupported(
                "conditions",
                "a force of the program has no tangent, which equilibrium needs",
            )
            .help("take velocity Verlet, or write the force as expressions of x, y, z and t"));
        }
        let wrong = match (moving, replaced) {
            (true, _) => Some("a prescribed velocity has no meaning in statics"),
            (_, true) => {
                Some("a force that replaces all others keeps its points out of equilibrium")
            }
            _ => None,
        };
        if self.applied.free().next().is_some() {
            return Err(BuildError::unsupported(
                "indenter",
                "an indenter with a mass moves in time, and statics has none",
            )
            .help("leave mass and velocity out, and write center as a function of t from 0 to 1"));
        }
        if let Some(wrong) = wrong {
            return Err(BuildError::unsupported("conditions", wrong)
                .help("prescribe a displacement, as a function of t from 0 to 1"));
        }
        let atoms = |r: &ConstitutiveModel| matches!(r.laws, Laws::Atoms(_));
        if options.method != Method::Relaxation
            && (self.factored(options, &support) || self.constitutive.all().any(atoms))
        {
            self.enough_memory_for_rows()?;
        }
        if options.method != Method::Relaxation
            && (self.contact.is_some() || !self.applied.rigid.is_empty())
        {
            return Err(BuildError::unsupported(
                "statics.method",
                "contact and indenters have no tangent here",
            )
            .help("write method = \"relaxation\", or contact = false"));
        }
        let asymmetry = self.interaction.asymmetry();
        if asymmetry > statics::SYMMETRIC {
            let wrong = match (options.solver, options.method) {
                (Solver::ConjugateGradients, _) => Some((
                    "statics.solver",
                    "conjugate gradients need a symmetric body",
                    "write solver = \"direct\"",
                )),
                (_, Method::Relaxation) => Some((
                    "statics.method",
                    "relaxation seeks the least energy",
                    "write method = \"linear\"",
                )),
                (Solver::Auto | Solver::Direct, Method::Linear | Method::Newton) => None,
            };
            if let Some((path, wrong, help)) = wrong {
                return Err(BuildError::unsupported(
                    path,
                    format!(
                        "{wrong}, and action is not reaction in this one (asymmetry {})",
                        rounded(asymmetry, 2)
                    ),
                )
                .help(help));
            }
        }
        Ok(())
    }

    /// Is what laws ask of the time of an increment or an implicit step there?
    pub(super) fn knows_its_time(&self, path: &str, timed: bool) -> Result<(), BuildError> {
        let named = self.constitutive.all().filter_map(|m| m.named.as_ref());
        for (memory, name) in named.map(|n| n.memory()) {
            match memory {
                Memory::Time if !timed => {
                    return Err(BuildError::unsupported(
                        path,
                        format!("the law {name} answers to how fast it is deformed, and t of these increments is the factor of the load, no time"),
                    )
                    .help("write duration, the time in which the load is applied; its increments are steps in time then"));
                }
                Memory::Shock => {
                    return Err(BuildError::unsupported(
                        path,
                        format!("the law {name} answers to how fast it is deformed and bears no shear at rest: it moves in time, by explicit steps"),
                    )
                    .help("write [run] with a duration, without integrator"));
                }
                Memory::Nothing | Memory::Path | Memory::Time => {}
            }
        }
        Ok(())
    }

    /// Do the rows of the equations fit into memory? Laws with a point scalar reach two families. What the factors fill in
    /// comes on top.
    pub(super) fn enough_memory_for_rows(&self) -> Result<(), BuildError> {
        let points = self.body.points() as f64;
        let families = self.constitutive.all().map(|r| match &r.laws {
            Laws::Solid(_) | Laws::Atoms(_) => 2f64.powi(D as i32),
            Laws::Bond(_) | Laws::Springs(_) | Laws::Micromoduli(_) => 1.0,
        });
        let families = families.fold(1.0, f64::max);
        let row = (families * self.info.family.1).min(points) + 1.0;
        memory::afford(
            "statics.solver",
            &format!("the equations of {} points", rounded(points, 3)),
            points * row * (8 * D * D + 4) as f64,
            "leave solver out, or write solver = \"cg\", which needs no matrix; a shorter horizon makes shorter rows",
        )
    }

    /// The state before any load: displacements as they are, forces of bonds alone.
    pub(super) fn unloaded(&mut self) {
        self.start_transfers();
        self.v.iter_mut().for_each(|c| c.fill(0.0));
        self.forces_of_statics();
        self.stale = false;
        self.learn_strength();
        // energy that came in from outside counts as initial
        self.accounts.initial = Some(self.energy_now().base());
    }

    /// Forces from which the next increment sets out; before the first one nothing acts but bonds.
    pub(super) fn forces_of_statics(&mut self) {
        self.refresh_images();
        if self.is_linear() {
            self.linear_forces();
        } else {
            let (body, u) = (&self.body, &self.u);
            self.interaction
                .forces(body, u, &mut self.f, Sweep::Hold, None);
        }
        if self.clock.has_gone_on() {
            self.other_forces(self.clock.trial());
        }
    }

    /// Points know what they bear once they were asked: a first time without load, or the bonds of the first increment would never break.
    pub(super) fn learn_strength(&mut self) {
        // asking is a step of no length, which laws remember
        if self.criticals().is_empty() && self.interaction.criticals_between().is_empty() {
            return;
        }
        let rest = match self.is_linear() {
            true => self.body.at_rest(),
            false => self.u.clone(),
        };
        let still = zeros(self.body.len);
        let mut f = zeros(self.body.len);
        let sweep = Sweep::Evolve {
            v: &still,
            steps: [0.0; 2],
            release: self.release,
        };
        let tally = self
            .interaction
            .forces(&self.body, &rest, &mut f, sweep, None);
        self.accounts.book(&tally);
        self.take_heat_of_flow();
    }

    /// One increment of load: equilibrium at the next time. On an error the state is that of the increment before.
    pub(super) fn increment(&mut self) -> Result<(), RunError> {
        let (t, dt) = (self.clock.time(), self.clock.dt());
        self.update_toughness(t + dt)?;
        self.spread(t, dt)?;
        self.pay(0.5, 0.0);
        let Some(mut state) = self.statics.take() else {
            return Ok(());
        };
        self.wear(state.options.cycles);
        let (u, f) = (self.u.clone(), self.f.clone());
        // nothing acts before the first increment
        let first = !self.clock.has_gone_on() && !Self::follows_a_path(state.options);
        let external = match first {
            true => zeros(self.body.len),
            false => self.external(),
        };
        self.acting_depart(Pressed::Held);
        let clock = self.clock;
        self.clock.forward();
        if Self::breaks_in_turn(state.options) {
            return self.break_next(state, clock, u, f);
        }
        if state.options.timed {
            self.interaction.last(self.clock.dt());
        }
        let result = match Self::follows_a_path(state.options) {
            true => self.settle_path(&mut state, [&u, &f, &external]),
            false => self.settle_increment(&mut state, [&u, &f, &external]),
        };
        self.interaction.last(0.0);
        if let Err(error) = result {
            self.clock = clock;
            self.retreat_transfers();
            (self.u, self.f) = (u, f);
            self.acting_retreat();
            self.refresh_images();
            self.statics = Some(state);
            return Err(self.unsolved(error));
        }
        let (solved, way) = result.unwrap_or_default();
        if first && way.relaxed != 0.0 {
            self.warn_of_start(way.relaxed);
        }
        state.solved = solved;
        self.accounts.past.dissipated += way.lost;
        self.accounts.past.conditions += way.work;
        self.statics = Some(state);
        self.acting_arrive(&u);
        self.pay(0.5, 0.0);
        Ok(())
    }

    /// All that acts remembers where an increment or a step began.
    pub(super) fn acting_depart(&mut self, pressed: Pressed) {
        self.applied.all().for_each(|x| x.depart(&self.u, pressed));
        if let Some(contact) = &mut self.contact {
            contact.depart(&self.u, pressed);
        }
    }

    /// It has ended, from these displacements on.
    pub(super) fn acting_arrive(&mut self, then: &Field<D>) {
        let between = [then, &self.u];
        let all = self.applied.all();
        all.for_each(|x| x.arrive(&self.body, between));
        if let Some(contact) = &mut self.contact {
            contact.arrive(&self.body, &self.u);
        }
    }

    /// It goes back there.
    pub(super) fn acting_retreat(&mut self) {
        self.applied.all().for_each(|x| x.retreat());
        if let Some(contact) = &mut self.contact {
            contact.retreat();
        }
    }

    /// An increment that ends where the next bonds break.
    fn break_next(
        &mut self,
        mut state: StaticState<D>,
        clock: Clock,
        u: Field<D>,
        f: Field<D>,
    ) -> Result<(), RunError> {
        match self.settle_sequence(&mut state) {
            Ok(solved) => {
                state.solved = solved;
                self.statics = Some(state);
                Ok(())
            }
            Err(error) => {
                (self.clock, self.u, self.f) = (clock, u, f);
                self.refresh_images();
                self.statics = Some(state);
                Err(self.unsolved(error))
            }
        }
    }

    pub(super) fn unsolved(&self, error: SolveError) -> RunError {
        RunError::Equilibrium {
            step: self.clock.step() + 1,
            position: self.place_of(&error),
            error,
        }
    }

    /// The reference position that an error is about, if it is about one.
    pub(super) fn place_of(&self, error: &SolveError) -> Option<Point> {
        let place = match error {
            SolveError::Indefinite { point } => Some(*point),
            SolveError::Loose(loose) => Some(loose.point),
            SolveError::Unheld { point, .. } => Some(*point),
            _ => None,
        };
        place.map(|n| self.body.position(self.body.slots[n] as usize))
    }

    /// Cycles of the load that holds the body where it is; bonds that are worn out break at the first look for the next equilibrium.
    fn wear(&mut self, cycles: Option<Cycles>) {
        let Some(cycles) = cycles.filter(|_| self.clock.has_gone_on()) else {
            return;
        };
        self.refresh_images();
        let left = (cycles.most - self.accounts.cycles).max(0.0);
        let passed = self.interaction.wear(&self.body, &self.u, &cycles, left);
        self.accounts.cycles += passed.unwrap_or(0.0);
    }

    /// Equilibrium, and again after bonds broke, until none breaks; what it did is counted from the displacements, forces and loads before.
    fn settle_increment(
        &mut self,
        state: &mut StaticState<D>,
        [u, f, external]: [&Field<D>; 3],
    ) -> Result<(Solved, Way), SolveError> {
        let mut support = self.support_now(state.options)?.support;
        let method = state.options.method;
        let linear = method == Method::Linear && self.at_peace();
        // a start that is no equilibrium goes to one, whatever acts
        let mut released = self.is_unbalanced(&support, f, state.options.tolerance);
        let mut total = Solved::default();
        let mut way = Way::default();
        let mut from = [u.clone(), f.clone(), external.clone()];
        for round in 0..ROUNDS {
            let t = self.clock.time();
            self.prescribed.place(&mut self.u, t);
            self.applied.rigid.iter_mut().for_each(|i| i.place(t));
            self.look_again();
            let before = self.accounts.broken;
            let solved = match method {
                Method::Linear => self.solve_linear(state, &support)?,
                Method::Newton => self.solve_newton(state, &support)?,
                Method::Relaxation => self.relax(state, &support)?,
            };
            total.iterations += solved.iterations;
            total.residual = solved.residual;
            // what bonds pull that are about to break, whatever they break by, counts up to here
            self.hold(linear);
            self.follow(&support, &from, released, &mut way);
            if round == 0 {
                way.relaxed = way.lost;
            }
            match linear {
                true => self.tear_linear(),
                false => self.forces(true, self.clock.trial()),
            }
            if self.accounts.broken == before {
                return Ok((total, way));
            }
            // the next solution is that of another body
            state.forget();
            if method == Method::Linear {
                self.warn_of_one_look();
                return Ok((total, way));
            }
            // without what let go, whatever it did in the evaluation that found it
            self.hold(linear);
            from = [self.u.clone(), self.f.clone(), self.external()];
            released = true;
            support = self.support_now(state.options)?.support;
        }
        Err(SolveError::StillBreaking { rounds: ROUNDS })
    }

    /// Forces of now, of which no bond lets go; of the linear body or of the law.
    fn hold(&mut self, linear: bool) {
        self.refresh_images();
        match linear {
            true => self.linear_forces(),
            false => {
                self.interaction
                    .forces(&self.body, &self.u, &mut self.f, Sweep::Hold, None);
            }
        }
        self.other_forces(self.clock.trial());
    }

    /// Linear increments solve once, and look once which bonds break.
    fn warn_of_one_look(&mut self) {
        if !self.info.warnings.iter().any(|w| w.contains(ONE_LOOK)) {
            self.info.warnings.push(ONE_LOOK.to_string());
        }
    }

    /// The start of the run was no equilibrium.
    fn warn_of_start(&mut self, lost: f64) {
        self.info.warnings.push(message![
            "the body is not in equilibrium at the start: on its way there it sets ",
            Dimension::ENERGY.of(lost),
            " free, which counts as dissipated; begin from where nothing pulls (values of heat and species at their reference), or let motion follow",
        ]);
    }

    /// Are these forces (per volume) of points that were let go, more than a solver leaves beside those of points that are held?
    fn is_unbalanced(&self, support: &Support<D>, f: &Field<D>, tolerance: f64) -> bool {
        let [mut loose, mut held] = [0.0; 2];
        for (n, force) in self.per_point(f).into_iter().enumerate() {
            for a in 0..D {
                match support.free[n][a] {
                    true => loose += force[a] * force[a],
                    false => held += force[a] * force[a],
                }
            }
        }
        loose.sqrt() > tolerance.sqrt() * held.sqrt()
    }

    /// The way from a state to that of now, by the trapezoidal rule: work of loads and reactions, and, of a state that was `released` (whose bonds
    /// have just let go, or which was out of equilibrium at the start), what it sets free on its way to equilibrium. In motion that would fly,
    /// here it is lost.
    fn follow(
        &mut self,
        support: &Support<D>,
        [u, f, external]: &[Field<D>; 3],
        released: bool,
        way: &mut Way,
    ) {
        let now = self.external();
        for (n, &s) in self.body.slots.iter().enumerate() {
            let i = s as usize;
            for a in 0..D {
                let moved = 0.5 * self.body.volume.at(i) * (self.u[a][i] - u[a][i]);
                let all = f[a][i] + self.f[a][i];
                let loads = external[a][i] + now[a][i];
                if support.free[n][a] {
                    way.work += loads * moved;
                    if released {
                        way.lost += all * moved;
                    }
                } else {
                    // loads and reaction together hold what the bonds pull
                    way.work += (loads - all) * moved;
                }
            }
        }
    }

    /// The lowest modes of vibration about the state of now; of a body that was loaded those of the motion that follows.
    ///
    /// # Errors
    /// Those of the factorisation.
    pub(super) fn lowest_modes(&mut self, count: usize) -> Result<Vec<Mode<D>>, SolveError> {
        let waits = self.preload.as_ref().filter(|_| self.clock.is_loaded());
        let support = self.held_by(waits.map_or(&self.prescribed, |waits| &waits.prescribed));
        let body = self.linear_now();
        modes::lowest(&body, &support, count)
    }

    pub(super) fn padded(x: &[[f64; D]]) -> Vec<Point> {
        x.iter()
            .map(|x| std::array::from_fn(|a| if a < D { x[a] } else { 0.0 }))
            .collect()
    }
}
