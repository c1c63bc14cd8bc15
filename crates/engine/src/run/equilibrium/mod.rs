//! Statics of a model: every step is an increment of load, and ends in equilibrium.

mod bordered;
mod equations;
mod free;
mod held;
mod linear;
mod path;
pub(super) mod problem;
mod relaxed;
mod sequence;
mod solve;
pub(super) mod state;
mod system;
pub(super) mod tried;
pub(super) mod whole;

use self::problem::Problem;
use self::state::StaticState;
use self::whole::unknowns;
use super::system::System;
use crate::body::{Field, view, view_mut, zeros};
use crate::constitutive::{ConstitutiveModel, Laws};
use crate::error::{BuildError, RunError, SolveError};
use crate::execute::memory;
use crate::interaction::Sweep;
use crate::quantity::rounded;
use crate::run::agreed::agreed;
use crate::run::traits;
use crate::space::Point;
use crate::spec::{LinearBody, Method, Statics};
use crate::statics::{self, Solved, Support};

/// Rounds of breaking and new equilibrium within one increment.
const ROUNDS: usize = 10_000;

/// What linear increments leave out where bonds break.
const ONE_LOOK: &str = "linear increments look once which bonds break: those that the solution stretches too far are gone from the next increment on, and what their loss breaks is found there; write method = \"newton\" for an equilibrium after every break, or control = \"sequentially_linear\" for one bond after the other";

/// What an increment does.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Way {
    /// Of loads and reactions (energy).
    pub work: f64,
    /// What states that were released set free on their way to equilibrium.
    pub lost: f64,
    /// So much of it from where the increment began.
    pub relaxed: f64,
}

impl<const D: usize> System<D> {
    /// Can this be brought into equilibrium at all?
    pub(super) fn check_statics(&self, options: Statics) -> Result<(), BuildError> {
        traits::of_statics(self, options)?;
        let support = self.held();
        if unknowns(&self.body, &support) == 0 {
            return Err(BuildError::ill_posed(
                "conditions",
                SolveError::NothingFree.to_string(),
            ));
        }
        // forces between points move no part as a whole, and nothing is solved for
        let left_alone = options.method.minimizes()
            && self.applied.loads.is_empty()
            && self.applied.rigid.is_empty();
        let loose = match left_alone {
            true => None,
            false => self.loose_part(&support),
        };
        let held = loose.map_or(Ok(()), |(loose, x)| {
            Err(BuildError::ill_posed(
                "conditions",
                format!(
                    "the body is not held: {} of the part of {} points around {x:?} meets no resistance",
                    loose.motion, loose.points
                ),
            )
            .help("prescribe displacements that hold every connected part: D translations and its rotations"))
        });
        agreed(&self.body, held)?;
        let atoms = |r: &ConstitutiveModel| matches!(r.laws, Laws::Atoms(_));
        if !options.method.minimizes()
            && (self.factored(options, &support) || self.constitutive.all().any(atoms))
        {
            self.enough_memory_for_rows()?;
        }
        Ok(())
    }

    /// Do the rows of the equations fit into memory? Laws with a point scalar reach two families. What the factors fill in
    /// comes on top.
    pub(super) fn enough_memory_for_rows(&self) -> Result<(), BuildError> {
        let points = self.body.all_points() as f64;
        let families = self.constitutive.all().map(|r| match &r.laws {
            Laws::Solid(_) | Laws::Atoms(_) => 2f64.powi(D as i32),
            Laws::Bond(_) | Laws::Springs(_) | Laws::Micromoduli(_) => 1.0,
        });
        let families = families.fold(1.0, f64::max);
        let row = (families * self.info.family.1).min(points) + 1.0;
        let fits = memory::afford(
            "statics.solver",
            &format!("the equations of {} points", rounded(points, 3)),
            points * row * (8 * D * D + 4) as f64,
            "leave solver out, or write solver = \"cg\", which needs no matrix; a shorter horizon makes shorter rows",
        );
        // those of all ranks are on the first
        let fits = if self.body.is_first() { fits } else { Ok(()) };
        agreed(&self.body, fits)
    }

    /// Points know what they bear once they were asked: a first time without load, or the bonds of the first increment would never break.
    pub(super) fn learn_strength(&mut self) {
        // asking is a step of no length, which laws remember
        let none = self.criticals().is_empty() && self.interaction.criticals_between().is_empty();
        if !self.body.exchange().any(!none) {
            return;
        }
        let rest = match self.is_linear() {
            true => self.body.at_rest(),
            false => self.u.clone(),
        };
        let still = zeros(self.body.len());
        let mut f = zeros(self.body.len());
        let sweep = Sweep::Evolve {
            v: view(&still),
            steps: [0.0; 2],
            breakage: self.breakage,
        };
        let mut tally =
            self.interaction
                .forces(&self.body, view(&rest), view_mut(&mut f), sweep, None);
        tally.fault = None;
        self.accounts.swept += tally;
        self.take_heat_of_flow();
    }

    pub(super) fn unsolved(&self, error: SolveError) -> RunError {
        RunError::Equilibrium {
            step: self.clock.step() + 1,
            position: self.place_of(&error),
            error,
        }
    }

    /// The reference position that an error is about, if it is about one. All ranks ask at once.
    pub(super) fn place_of(&self, error: &SolveError) -> Option<Point> {
        let id = match error {
            SolveError::Indefinite { point } => Some(*point),
            SolveError::Loose(loose) => Some(loose.point),
            SolveError::Unheld { point, .. } => Some(*point),
            _ => None,
        };
        const NONE: u64 = u64::MAX;
        let told = self
            .body
            .is_first()
            .then(|| id.map_or(NONE, |id| id as u64));
        match self.body.told(told) {
            NONE => None,
            id => Some(self.body.position_of(id as usize)),
        }
    }
}

impl<const D: usize> Problem<'_, D> {
    /// The linear body about the reference, on the first rank.
    fn reference_body(&mut self) -> Option<LinearBody<D>> {
        let system = &mut *self.system;
        if !system.at_peace() {
            return system.stressed().tangent.clone();
        }
        statics::linear_body(
            &system.body,
            system.interaction.as_mut(),
            &system.body.at_rest(),
        )
    }

    /// Equilibrium, and again after bonds broke, until none breaks; what it did is counted from the displacements, forces and loads before.
    pub(super) fn settle_increment(
        &mut self,
        state: &mut StaticState<D>,
        [u, f, external]: [&Field<D>; 3],
    ) -> Result<(Solved, Way), SolveError> {
        let mut support = self.support_now(state.options)?.support;
        let method = state.options.method;
        let linear = method == Method::Linear;
        // a start that is no equilibrium goes to one, whatever acts
        let mut released = self.is_unbalanced(&support, f, state.options.tolerance);
        let mut total = Solved::default();
        let mut way = Way::default();
        let mut from = [u.clone(), f.clone(), external.clone()];
        for round in 0..ROUNDS {
            let t = self.system.clock.time();
            self.system.prescribed.place(&mut self.system.u, t);
            self.system
                .applied
                .rigid
                .iter_mut()
                .for_each(|i| i.place(t));
            self.system.invalidate_neighbours();
            let before = self.system.accounts.swept.broken;
            let solved = match method {
                Method::Linear => self.solve_linear(state, &support)?,
                Method::Newton => self.solve_newton(state, &support)?,
                Method::Relaxation | Method::Fire => self.relax(state, &support)?,
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
                false => self.system.forces(true, self.system.clock.trial()),
            }
            let broke = self.system.accounts.swept.broken != before;
            if !self.sums.any(broke) {
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
            from = [
                self.system.u.clone(),
                self.system.f.clone(),
                self.system.external(),
            ];
            released = true;
            support = self.support_now(state.options)?.support;
        }
        Err(SolveError::StillBreaking { rounds: ROUNDS })
    }

    /// Forces of now, of which no bond lets go; of the linear body or of the law.
    fn hold(&mut self, linear: bool) {
        let system = &mut *self.system;
        system.refresh_images();
        match linear {
            true => system.linear_forces(),
            false => {
                system.interaction.forces(
                    &system.body,
                    view(&system.u),
                    view_mut(&mut system.f),
                    Sweep::Hold,
                    None,
                );
            }
        }
        system.other_forces(system.clock.trial());
    }

    /// Linear increments solve once, and look once which bonds break.
    fn warn_of_one_look(&mut self) {
        let system = &mut *self.system;
        if !system.info.warnings.iter().any(|w| w.contains(ONE_LOOK)) {
            system.info.warnings.push(ONE_LOOK.to_string());
        }
    }

    /// Are these forces (per volume) of points that were let go, more than a solver leaves beside those of points that are held?
    fn is_unbalanced(&self, support: &Support<D>, f: &Field<D>, tolerance: f64) -> bool {
        let forces = self.system.body.per_point(f);
        let [loose, held] = self.sums.each(forces.len(), |n| {
            let [mut loose, mut held] = [0.0; 2];
            for a in 0..D {
                match support.free[n][a] {
                    true => loose += forces[n][a] * forces[n][a],
                    false => held += forces[n][a] * forces[n][a],
                }
            }
            [loose, held]
        });
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
        let system = &mut *self.system;
        let now = system.external();
        let slots = system.body.slots();
        let [work, lost] = self.sums.each(slots.len(), |n| {
            let i = slots[n] as usize;
            let [mut work, mut lost] = [0.0; 2];
            for a in 0..D {
                let moved = 0.5 * system.body.volume().at(i) * (system.u[a][i] - u[a][i]);
                let all = f[a][i] + system.f[a][i];
                let loads = external[a][i] + now[a][i];
                if support.free[n][a] {
                    work += loads * moved;
                    if released {
                        lost += all * moved;
                    }
                } else {
                    // loads and reaction together hold what the bonds pull
                    work += (loads - all) * moved;
                }
            }
            [work, lost]
        });
        way.work += work;
        way.lost += lost;
    }
}
