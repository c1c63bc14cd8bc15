//! Nonlinear bodies, coarsened in increments of load with the linear body taken anew (silling2010, section 7: "the linearized material
//! properties C0 are re-evaluated as the problem evolves").
//!
//! About the displacements u of all points, with r(u) = f_ext − f_int the force that is missing (force per point), K = −∂f/∂u the
//! tangent and S the shapes of its coarse body ([`Options`], level by level, S the product of all levels):
//!
//! ```text
//! (Sᵀ K S) δq = Sᵀ r(u),   δq = what is prescribed, where it is;   u ← u + S δq
//! ```
//!
//! with the loads and supports of the increment's end. r has the whole force that is missing, so that what one increment leaves the next one
//! takes up: errors do not add up. Repeated at the same load ([`Plan::corrections`]) this is Newton's method for `Sᵀ r = 0`.
//!
//! What removed points do between increments is a choice ([`Removed`]). Carried by the shapes of every increment they follow
//! `du_e = S(u) dq` by Euler's method: of first order in the increment. That the retained points feel little, because the work of `Sᵀ K`
//! on a displacement of removed points alone is 0 but for what balls cut off. Relaxed, they come to rest between retained points after
//! every solution, and with corrections the answer is that of Newton's method on all points.

mod model;
mod nonlinear;

use super::block::Block;
use super::error::CoarsenError;
use super::shapes::Shapes;
use super::{Mass, Options, Radius, Report, shaped};
pub use model::{Linear, Model, Support as Prescribed, alone};
pub use nonlinear::{Load, Nonlinear};
use peridyne::error::SolveError;
use peridyne::spec::LinearBody;
use peridyne::statics::{Assembled, Direct, Goal, Support, cg, norm};

/// What removed points do.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Removed {
    /// They move with the shapes, and never else.
    #[default]
    KinematicPoints,
    /// They come to rest between retained points after every solution, by conjugate gradients.
    Relaxed,
}

/// How increments are solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Retained points of every level, ascending, by their numbers in the body below; and how that is coarsened. A radius that is chosen is
    /// chosen once, and then grows as the longest bond does.
    pub levels: Vec<(Vec<u32>, Options)>,
    /// Solutions in an increment after the first, at most.
    pub corrections: usize,
    /// Force left over that of loads and supports at which no more is corrected.
    pub tolerance: f64,
    pub removed: Removed,
}

impl Plan {
    /// Numbers of the points of the last level in a body of so many.
    pub fn retained(&self, points: usize) -> Vec<u32> {
        let mut retained: Vec<u32> = (0..points as u32).collect();
        for (kept, _) in &self.levels {
            retained = kept.iter().map(|k| retained[*k as usize]).collect();
        }
        retained
    }
}

/// What an increment did.
#[derive(Debug, Clone, PartialEq)]
pub struct Increment<const D: usize> {
    pub corrections: usize,
    /// How often the linear body was taken and coarsened.
    pub tangents: usize,
    /// `|Sᵀ r|` on what is free, over the size of loads and reactions.
    pub unbalanced: f64,
    /// `|r|` on removed points, over the same.
    pub removed: f64,
    /// Of loads and supports, by the trapezoidal rule (energy).
    pub work: f64,
    /// Bonds that broke, each end counted.
    pub broken: u64,
    /// `[retained]` forces that supports exert (force); 0 where points are free.
    pub reaction: Vec<[f64; D]>,
}

/// Why an increment has no end. Points of levels are those of the body below, others those of the body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum IncrementError {
    #[error("level {level}: {error}")]
    Coarsen { level: usize, error: CoarsenError },
    #[error("{}", unsolved(.0))]
    Solve(SolveError),
    #[error(
        "removed points do not come to rest between retained ones ({0}): their own equilibrium is unstable in this state; retain more points, or let them move with the shapes"
    )]
    Removed(SolveError),
    #[error(
        "displacements or forces are no numbers any more: this much load at once turns the body over; take more increments"
    )]
    NotFinite,
    #[error(
        "bonds still break after {0} equilibria at the same load: the body falls apart under it, and has no equilibrium"
    )]
    StillBreaking(usize),
}

fn unsolved(error: &SolveError) -> String {
    match error {
        SolveError::Indefinite { .. } => format!(
            "the coarse body has no stable equilibrium at this load, it buckles or breaks before ({error}); end at a lower load"
        ),
        error => error.to_string(),
    }
}

/// A correction that leaves more than this part is followed by a new tangent.
const SERVES: f64 = 0.1;
/// Equilibria at one load, bonds breaking after each.
const ROUNDS: usize = 1_000;
/// Of removed points: residual over that of the start, and iterations.
const RELAXED: f64 = 1e-10;
const ITERATIONS: usize = 20_000;

/// The linear body about a state and its levels.
pub struct Reduced<const D: usize> {
    /// Of all points.
    pub tangent: LinearBody<D>,
    /// Level 1 first.
    pub levels: Vec<(LinearBody<D>, Report)>,
    shapes: Vec<Shapes<D>>,
}

impl<const D: usize> Reduced<D> {
    /// `Sᵀ f`
    fn restricted(&self, force: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut force = force.to_vec();
        for (shapes, (body, _)) in self.shapes.iter().zip(&self.levels) {
            let mut coarse = vec![[0.0; D]; body.points()];
            for (row, f) in shapes.rows.iter().zip(&force) {
                for (q, s) in row {
                    add_transposed(&mut coarse[*q as usize], s, f);
                }
            }
            force = coarse;
        }
        force
    }

    /// `S x`
    fn carried(&self, x: &[[f64; D]]) -> Vec<[f64; D]> {
        let mut x = x.to_vec();
        for shapes in self.shapes.iter().rev() {
            x = (shapes.rows.iter())
                .map(|row| {
                    let mut u = [0.0; D];
                    for (q, s) in row {
                        for a in 0..D {
                            for b in 0..D {
                                u[a] += s[a][b] * x[*q as usize][b];
                            }
                        }
                    }
                    u
                })
                .collect();
        }
        x
    }

    /// The coarsest body.
    fn last(&self) -> &LinearBody<D> {
        self.levels.last().map_or(&self.tangent, |(body, _)| body)
    }
}

fn add_transposed<const D: usize>(sum: &mut [f64; D], s: &Block<D>, f: &[f64; D]) {
    for a in 0..D {
        for b in 0..D {
            sum[b] += s[a][b] * f[a];
        }
    }
}

/// A body on its way under growing loads.
pub struct Increments<const D: usize> {
    plan: Plan,
    /// Of each level that was chosen: radius, and the longest bond below (length).
    radii: Vec<(f64, f64)>,
    /// Numbers of the points that all levels retain.
    retained: Vec<u32>,
    u: Vec<[f64; D]>,
    /// `[N]` loads at u, and `[retained]` what is missing there (force).
    acting: [Vec<[f64; D]>; 2],
}

/// What is missing at a state.
struct Missing<const D: usize> {
    /// On retained points, supports and all.
    coarse: Vec<[f64; D]>,
    /// On free components of retained points, and on removed ones.
    size: f64,
    removed: f64,
    /// Loads on what is free, and reactions.
    scale: f64,
}

impl<const D: usize> Missing<D> {
    fn part(&self, size: f64) -> f64 {
        match self.scale > 0.0 {
            true => size / self.scale,
            false => 0.0,
        }
    }
}

/// The coarse equations of a state.
struct Equations<const D: usize> {
    reduced: Reduced<D>,
    support: Support<D>,
    factors: Option<Direct<D>>,
}

impl<const D: usize> Increments<D> {
    /// From displacements at which laws are what they are now.
    pub fn new(body: &mut dyn Nonlinear<D>, plan: Plan, u: Vec<[f64; D]>) -> Self {
        let nothing = vec![[0.0; D]; u.len()];
        let forces = body.forces(&u);
        let retained = plan.retained(u.len());
        let forces = retained.iter().map(|q| forces[*q as usize]).collect();
        Increments {
            retained,
            plan,
            radii: vec![],
            u,
            acting: [nothing, forces],
        }
    }

    /// Displacements of all points.
    pub fn displacements(&self) -> &[[f64; D]] {
        &self.u
    }

    /// Numbers of retained points in the body, in the order of reactions.
    pub fn retained(&self) -> &[u32] {
        &self.retained
    }

    /// Levels about the state of now, with masses of their own.
    ///
    /// # Errors
    /// A level is not sound.
    pub fn reduced(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        mass: Mass,
    ) -> Result<Reduced<D>, IncrementError> {
        let tangent = body.tangent(&self.u);
        let mut reduced = Reduced {
            tangent,
            levels: vec![],
            shapes: vec![],
        };
        for (n, (kept, options)) in self.plan.levels.iter().enumerate() {
            let below = reduced.last();
            let mut options = Options { mass, ..*options };
            let known = self.radii.get(n);
            let range = below.range();
            if let Some((radius, first)) = known {
                options.radius = Radius::Fixed(radius * range / first);
            }
            let made = shaped(below, kept, &options);
            let (body, report, shapes) = made.map_err(|error| IncrementError::Coarsen {
                level: n + 1,
                error,
            })?;
            if known.is_none() && report.radius.is_finite() {
                self.radii.push((report.radius, range));
            }
            reduced.levels.push((body, report));
            reduced.shapes.push(shapes);
        }
        Ok(reduced)
    }

    /// Goes to the next load. On an error displacements are those of before.
    ///
    /// # Errors
    /// No coarse body, or no equilibrium of it.
    pub fn step(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        load: &Load<D>,
    ) -> Result<Increment<D>, IncrementError> {
        let before = self.u.clone();
        let done = self.stepped(body, load, &before);
        if done.is_err() {
            self.u = before;
        }
        done
    }

    fn stepped(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        load: &Load<D>,
        before: &[[f64; D]],
    ) -> Result<Increment<D>, IncrementError> {
        let mut done = Increment {
            corrections: 0,
            tangents: 0,
            unbalanced: 0.0,
            removed: 0.0,
            work: 0.0,
            broken: 0,
            reaction: vec![],
        };
        for round in 0.. {
            if round == ROUNDS {
                return Err(IncrementError::StillBreaking(ROUNDS));
            }
            let mut equations = self.equations(body, load)?;
            done.tangents += 1;
            let mut missing = self.missing(body, &equations, load);
            self.solved(body, &equations, load, &missing)?;
            missing = self.missing(body, &equations, load);
            let mut corrections = 0;
            while corrections < self.plan.corrections && self.goes_on(&missing) {
                corrections += 1;
                let size = libm::hypot(missing.size, self.counted(&missing));
                self.solved(body, &equations, load, &missing)?;
                missing = self.missing(body, &equations, load);
                let slow = libm::hypot(missing.size, self.counted(&missing)) > SERVES * size;
                if slow && corrections < self.plan.corrections && self.goes_on(&missing) {
                    equations = self.equations(body, load)?;
                    done.tangents += 1;
                    missing = self.missing(body, &equations, load);
                }
            }
            done.corrections += corrections;
            if !(missing.size.is_finite() && missing.removed.is_finite()) {
                return Err(IncrementError::NotFinite);
            }
            done.unbalanced = missing.part(missing.size);
            done.removed = missing.part(missing.removed);
            if round == 0 {
                done.work = self.work(before, load, &missing.coarse);
            }
            let support = &equations.support;
            done.reaction = (missing.coarse.iter().zip(&support.free))
                .map(|(r, free)| std::array::from_fn(|a| if free[a] { 0.0 } else { -r[a] }))
                .collect();
            self.acting = [load.force.clone(), missing.coarse];
            let broken = body.arrive(&self.u);
            done.broken += broken;
            if broken == 0 {
                break;
            }
            // what bonds let go is missing now, at the same load
            let left = self.left(body, load);
            self.acting[1] = equations.reduced.restricted(&left);
        }
        Ok(done)
    }

    /// What is missing on all points.
    fn left(&self, body: &mut dyn Nonlinear<D>, load: &Load<D>) -> Vec<[f64; D]> {
        let forces = body.forces(&self.u);
        let both = forces.iter().zip(&load.force);
        both.map(|(f, l)| std::array::from_fn(|a| f[a] + l[a]))
            .collect()
    }

    /// Does what removed points miss count?
    fn counted(&self, missing: &Missing<D>) -> f64 {
        match self.plan.removed {
            Removed::KinematicPoints => 0.0,
            Removed::Relaxed => missing.removed,
        }
    }

    fn goes_on(&self, missing: &Missing<D>) -> bool {
        libm::hypot(missing.size, self.counted(missing)) > self.plan.tolerance * missing.scale
    }

    fn missing(
        &self,
        body: &mut dyn Nonlinear<D>,
        equations: &Equations<D>,
        load: &Load<D>,
    ) -> Missing<D> {
        let all = self.left(body, load);
        let coarse = equations.reduced.restricted(&all);
        let loads = equations.reduced.restricted(&load.force);
        let (mut size, mut scale) = (0.0, 0.0);
        for ((r, l), free) in coarse.iter().zip(&loads).zip(&equations.support.free) {
            for a in 0..D {
                match free[a] {
                    true => (size, scale) = (size + r[a] * r[a], scale + l[a] * l[a]),
                    false => scale += r[a] * r[a],
                }
            }
        }
        let mut removed = all;
        self.between(load).mask(&mut removed);
        Missing {
            coarse,
            size: f64::sqrt(size),
            removed: norm(&removed),
            scale: f64::sqrt(scale),
        }
    }

    /// Components of removed points that nothing prescribes.
    fn between(&self, load: &Load<D>) -> Support<D> {
        let mut support = Support::none(self.u.len());
        for (free, held) in support.free.iter_mut().zip(&load.held) {
            *free = held.map(|h| h.is_none());
        }
        for q in &self.retained {
            support.free[*q as usize] = [false; D];
        }
        support
    }

    fn equations(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        load: &Load<D>,
    ) -> Result<Equations<D>, IncrementError> {
        // masses play no part in equilibrium
        let reduced = self.reduced(body, Mass::Lumped)?;
        let held = self.retained.iter().map(|q| &load.held[*q as usize]);
        let support = Support {
            free: held.map(|held| held.map(|h| h.is_none())).collect(),
        };
        // points whose bonds are gone rest where they are
        let resisted = support.resisted(reduced.last());
        let factors = match Direct::new(reduced.last(), &resisted, 0.0) {
            Ok(factors) => Some(factors),
            Err(SolveError::NothingFree) => None,
            Err(error) => return Err(self.of_body(error)),
        };
        Ok(Equations {
            reduced,
            support,
            factors,
        })
    }

    /// Points of errors by their numbers in the body.
    fn of_body(&self, error: SolveError) -> IncrementError {
        let number = |point: usize| self.retained[point] as usize;
        IncrementError::Solve(match error {
            SolveError::Indefinite { point } => SolveError::Indefinite {
                point: number(point),
            },
            SolveError::Unheld { points, point } => SolveError::Unheld {
                points,
                point: number(point),
            },
            error => error,
        })
    }

    /// One solution: displacements that leave nothing, as far as the equations know.
    fn solved(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        equations: &Equations<D>,
        load: &Load<D>,
        missing: &Missing<D>,
    ) -> Result<(), IncrementError> {
        let reduced = &equations.reduced;
        let mut x = vec![[0.0; D]; self.retained.len()];
        for (x, q) in x.iter_mut().zip(&self.retained) {
            let q = *q as usize;
            for a in 0..D {
                if let Some(held) = load.held[q][a] {
                    x[a] = held - self.u[q][a];
                }
            }
        }
        let resisted = equations.support.resisted(reduced.last());
        let rests = equations.support.rests(&resisted, &missing.coarse);
        rests.map_err(|error| self.of_body(error))?;
        if let Some(factors) = &equations.factors {
            let operator = &mut Assembled(reduced.last());
            factors.solve_held(operator, &resisted, &missing.coarse, &mut x);
        }
        for (u, way) in self.u.iter_mut().zip(reduced.carried(&x)) {
            for a in 0..D {
                u[a] += way[a];
            }
        }
        // as prescribed, to the last digit
        for q in &self.retained {
            let q = *q as usize;
            for a in 0..D {
                self.u[q][a] = load.held[q][a].unwrap_or(self.u[q][a]);
            }
        }
        if !self.u.as_flattened().iter().all(|u| u.is_finite()) {
            return Err(IncrementError::NotFinite);
        }
        match self.plan.removed {
            Removed::KinematicPoints => Ok(()),
            Removed::Relaxed => self.relaxed(body, &reduced.tangent, load),
        }
    }

    /// Removed points come to rest between retained ones, as far as the tangent knows.
    fn relaxed(
        &mut self,
        body: &mut dyn Nonlinear<D>,
        tangent: &LinearBody<D>,
        load: &Load<D>,
    ) -> Result<(), IncrementError> {
        let r = self.left(body, load);
        let support = self.between(load).resisted(tangent);
        if support.unknowns() == 0 {
            return Ok(());
        }
        let mut x = vec![[0.0; D]; self.u.len()];
        let goal = Goal {
            tolerance: RELAXED,
            most_iterations: ITERATIONS,
            stop: || false,
        };
        cg::solve(&mut Assembled(tangent), &support, &r, &mut x, goal)
            .map_err(IncrementError::Removed)?;
        for (u, x) in self.u.iter_mut().zip(&x) {
            for a in 0..D {
                u[a] += x[a];
            }
        }
        Ok(())
    }

    /// Of loads, and of supports, which bear what is missing on retained points.
    fn work(&self, before: &[[f64; D]], load: &Load<D>, missing: &[[f64; D]]) -> f64 {
        let moved = |i: usize, a: usize| 0.5 * (self.u[i][a] - before[i][a]);
        let mut work = 0.0;
        for i in 0..self.u.len() {
            for a in 0..D {
                work += moved(i, a) * (self.acting[0][i][a] + load.force[i][a]);
            }
        }
        for (k, i) in self.retained.iter().map(|q| *q as usize).enumerate() {
            for a in (0..D).filter(|a| load.held[i][*a].is_some()) {
                work -= moved(i, a) * (self.acting[1][k][a] + missing[k][a]);
            }
        }
        work
    }
}
