//! Statics of a model: every step is an increment of load, and ends in equilibrium.

use super::accounts::ledger_base;
use super::model::Model;
use super::recipe::Laws;
use crate::body::{Field, zeros};
use crate::condition::load::LoadKind;
use crate::dynamics::stable_step::largest_ratio;
use crate::error::{BuildError, RunError};
use crate::fracture::fragments::Fragments;
use crate::interaction::Sweep;
use crate::run::Simulation;
use crate::space::Point;
use crate::spec::{Method, Solver, Statics};
use crate::statics::cg::{self, Goal};
use crate::statics::modes::{self, Mode};
use crate::statics::relaxation::relax;
use crate::statics::{
    self, Assembled, Direct, LinearBody, LinearOperator, SolveError, Solved, Support, Swept,
};

/// Unknowns up to which the equations are factored, per dimension.
const DIRECT: [usize; 3] = [usize::MAX, 60_000, 12_000];
/// Newton's iterations at most.
const NEWTON: usize = 50;
/// A Newton step of so many spacings is round-off: forces of a crystal in equilibrium are never exactly 0.
const LEAST_STEP: f64 = 1e-14;
/// Longest step (spacings) from a state that is no minimum of the energy.
const LONGEST_STEP: f64 = 0.1;
/// How often a Newton step is halved.
const HALVINGS: usize = 12;
/// Rounds of breaking and new equilibrium within one increment.
const ROUNDS: usize = 10_000;
/// Largest stretch up to which a linear solution is taken without a warning.
const SMALL_STRETCH: f64 = 0.01;

/// What statics keeps between increments.
pub(super) struct StaticState<const D: usize> {
    pub options: Statics,
    /// Factors about the reference, as long as no bond broke.
    factors: Option<Direct<D>>,
    /// Of the last increment.
    pub solved: Solved,
}

impl<const D: usize> StaticState<D> {
    pub fn new(options: Statics) -> Self {
        StaticState {
            options,
            factors: None,
            solved: Solved::default(),
        }
    }
}

impl<const D: usize> Model<D> {
    /// Which components the conditions leave free.
    pub(super) fn support(&self) -> Support<D> {
        let mut id = vec![0u32; self.body.len];
        for (n, &s) in self.body.slots.iter().enumerate() {
            id[s as usize] = n as u32;
        }
        let mut support = Support::none(self.body.points());
        for c in &self.constraints {
            for (slot, held) in c.holds() {
                for a in (0..D).filter(|a| held[*a]) {
                    support.free[id[slot] as usize][a] = false;
                }
            }
        }
        support
    }

    /// The linear body about the displacements of now.
    pub(super) fn linear_now(&mut self) -> LinearBody<D> {
        self.refresh_images();
        statics::linear_body(&self.body, self.interaction.as_mut(), &self.u)
    }

    /// The linear body about the reference.
    fn reference_body(&mut self) -> LinearBody<D> {
        statics::linear_body(&self.body, self.interaction.as_mut(), &self.body.at_rest())
    }

    /// Can this be brought into equilibrium at all?
    pub(super) fn check_statics(&self, options: Statics) -> Result<(), BuildError> {
        let support = self.support();
        if support.unknowns() == 0 {
            return Err(BuildError::new(
                "conditions",
                SolveError::NothingFree.to_string(),
            ));
        }
        let position: Vec<[f64; D]> = self.by_id(|i| {
            let x = self.body.position(i);
            std::array::from_fn(|a| x[a])
        });
        let parts = Fragments::of(&self.body, self.interaction.as_ref()).label;
        if let Some(loose) = support.loose(&position, &parts, &self.body.period).first() {
            let x = position[loose.point];
            return Err(BuildError::new(
                "conditions",
                format!(
                    "the body is not held: {} of the part of {} points around {x:?} meets no resistance",
                    loose.motion, loose.points
                ),
            )
            .help("prescribe displacements that hold every connected part: D translations and its rotations"));
        }
        let moving = self.constraints.iter().any(|c| c.is_velocity());
        let replaced = self
            .loads
            .iter()
            .any(|l| matches!(l.kind, LoadKind::Replace(_)));
        let wrong = match (moving, replaced) {
            (true, _) => Some("a prescribed velocity has no meaning in statics"),
            (_, true) => {
                Some("a force that replaces all others keeps its points out of equilibrium")
            }
            _ => None,
        };
        if let Some(wrong) = wrong {
            return Err(BuildError::new("conditions", wrong)
                .help("prescribe a displacement, as a function of t from 0 to 1"));
        }
        if options.method != Method::Relaxation
            && (self.contact.is_some() || !self.indenters.is_empty())
        {
            return Err(BuildError::new(
                "statics.method",
                "contact and indenters have no tangent here",
            )
            .help("write method = \"relaxation\", or contact = false"));
        }
        Ok(())
    }

    /// The state before any load: displacements as they are, forces of bonds alone.
    pub(super) fn unloaded(&mut self) {
        self.v.iter_mut().for_each(|c| c.fill(0.0));
        self.refresh_images();
        let (body, u) = (&self.body, &self.u);
        self.interaction
            .forces(body, u, &mut self.f, Sweep::Hold, None);
        // energy that came in from outside counts as initial
        let now = self.energy_now();
        self.initial_energy = Some(ledger_base(&now));
    }

    /// One increment of load: equilibrium at the next time. On an error the state is that of the increment before.
    pub(super) fn increment(&mut self) -> Result<(), RunError> {
        let Some(mut state) = self.statics.take() else {
            return Ok(());
        };
        let (u, f) = (self.u.clone(), self.f.clone());
        // nothing acts before the first increment
        let external = match self.step == self.origin.0 {
            true => zeros(self.body.len),
            false => self.external(),
        };
        self.step += 1;
        let result = self.settle_increment(&mut state);
        if let Err(error) = result {
            self.step -= 1;
            (self.u, self.f) = (u, f);
            self.refresh_images();
            self.statics = Some(state);
            return Err(self.unsolved(error));
        }
        state.solved = result.unwrap_or_default();
        self.statics = Some(state);
        self.account(&u, &f, &external);
        Ok(())
    }

    pub(super) fn unsolved(&self, error: SolveError) -> RunError {
        let place = match &error {
            SolveError::Indefinite { point } => Some(*point),
            SolveError::Loose(loose) => Some(loose.point),
            _ => None,
        };
        RunError::Equilibrium {
            step: self.step + 1,
            position: place.map(|n| self.body.position(self.body.slots[n] as usize)),
            error,
        }
    }

    /// Equilibrium, and again after bonds broke, until none breaks.
    fn settle_increment(&mut self, state: &mut StaticState<D>) -> Result<Solved, SolveError> {
        let support = self.support();
        let mut total = Solved::default();
        for _ in 0..ROUNDS {
            let t = self.time();
            for c in &self.constraints {
                c.place(&mut self.u, t);
            }
            let solved = match state.options.method {
                Method::Linear => self.solve_linear(state, &support)?,
                Method::Newton => self.solve_newton(state, &support)?,
                Method::Relaxation => self.relax(state, &support)?,
            };
            total.iterations += solved.iterations;
            total.residual = solved.residual;
            let before = self.broken;
            self.forces(true, 0.0);
            if self.broken == before {
                return Ok(total);
            }
            state.factors = None;
        }
        Err(SolveError::StillBreaking { rounds: ROUNDS })
    }

    /// Force densities of the loads at this time.
    fn external(&mut self) -> Field<D> {
        let mut f = zeros(self.body.len);
        let (v, t) = (zeros(self.body.len), self.time());
        for load in &mut self.loads {
            load.add(&self.body, &v, &mut f, t, 0.0);
        }
        f
    }

    /// Forces per point of force densities.
    fn per_point(&self, f: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| {
            let volume = self.body.volume.at(i);
            std::array::from_fn(|a| volume * f[a][i])
        })
    }

    fn values(&self, u: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| std::array::from_fn(|a| u[a][i]))
    }

    fn set_values(&mut self, x: &[[f64; D]]) {
        for (x, &s) in x.iter().zip(&self.body.slots) {
            for a in 0..D {
                self.u[a][s as usize] = x[a];
            }
        }
        self.refresh_images();
    }

    fn factored(&self, options: Statics, support: &Support<D>) -> bool {
        match options.solver {
            Solver::Direct => true,
            Solver::ConjugateGradients => false,
            Solver::Auto => support.unknowns() <= DIRECT[D - 1],
        }
    }

    fn goal(options: Statics) -> Goal {
        Goal {
            tolerance: options.tolerance,
            most_iterations: options.most_iterations,
        }
    }

    /// Does the reference carry no force, so that sweeps at tiny displacements are its tangent?
    fn at_peace(&self) -> bool {
        !matches!(self.recipe.laws, Laws::Atoms(_))
    }

    /// `A u = F` about the reference, with A's factors or by conjugate gradients.
    fn solve_linear(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let mut load = self.external();
        if !self.at_peace() {
            let mut rest = zeros(self.body.len);
            let u = self.body.at_rest();
            self.interaction
                .forces(&self.body, &u, &mut rest, Sweep::Hold, None);
            for a in 0..D {
                for (l, r) in load[a].iter_mut().zip(rest[a].iter()) {
                    *l += r;
                }
            }
        }
        let b = self.per_point(&load);
        let mut x = self.values(&self.u);
        let solved = self.solve_about_reference(state, support, &b, &mut x)?;
        self.set_values(&x);
        let stretch = self.largest_stretch();
        if stretch > SMALL_STRETCH
            && !self
                .info
                .warnings
                .iter()
                .any(|w| w.contains("linear solution"))
        {
            self.info.warnings.push(format!(
                "the linear solution stretches bonds by {:.1} %: write method = \"newton\" for large deformation",
                100.0 * stretch
            ));
        }
        Ok(solved)
    }

    fn solve_about_reference(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
        b: &[[f64; D]],
        x: &mut [[f64; D]],
    ) -> Result<Solved, SolveError> {
        if self.factored(state.options, support) {
            let body = self.reference_body();
            if state.factors.is_none() {
                state.factors = Some(Direct::new(&body, support, 0.0)?);
            }
            let Some(factors) = &state.factors else {
                return Err(SolveError::Singular);
            };
            return Ok(direct(&body, factors, support, b, x));
        }
        let goal = Self::goal(state.options);
        if self.at_peace() {
            let mut operator = Swept::new(&self.body, self.interaction.as_mut());
            cg::solve(&mut operator, support, b, x, goal)
        } else {
            let body = self.reference_body();
            solve_assembled(&body, support, b, x, goal)
        }
    }

    /// Newton's method with the tangent of every state; where that is too large, with the tangent of the reference.
    pub(super) fn solve_newton(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let goal = Self::goal(state.options);
        let mut x = self.values(&self.u);
        let mut r = vec![[0.0; D]; x.len()];
        // atoms pull at each other without any load
        let rest = match self.at_peace() {
            true => 0.0,
            false => {
                let sites = vec![[0.0; D]; x.len()];
                self.imbalance(&sites, &mut r, support);
                norm(&r)
            }
        };
        let mut scale = self.imbalance(&x, &mut r, support).hypot(rest);
        let mut iterations = 0;
        for _ in 0..NEWTON {
            let size = norm(&r);
            if !size.is_finite() {
                return Err(SolveError::NotFinite);
            }
            if size <= goal.tolerance * scale {
                return Ok(Solved {
                    iterations,
                    residual: if scale > 0.0 { size / scale } else { 0.0 },
                });
            }
            let mut step = vec![[0.0; D]; x.len()];
            let full = self.factored(state.options, support);
            let mut unstable = false;
            let solved = if full || !self.at_peace() {
                let body = self.linear_now();
                if full {
                    let factors = match Direct::new(&body, support, 0.0) {
                        Err(SolveError::Indefinite { .. }) if !self.at_peace() => {
                            unstable = true;
                            downhill(&body, support)?
                        }
                        made => made?,
                    };
                    direct(&body, &factors, support, &r, &mut step)
                } else {
                    solve_assembled(
                        &body,
                        support,
                        &r,
                        &mut step,
                        Goal {
                            tolerance: 1e-4,
                            ..goal
                        },
                    )?
                }
            } else {
                let goal = Goal {
                    tolerance: 1e-4,
                    ..goal
                };
                let mut operator = Swept::new(&self.body, self.interaction.as_mut());
                cg::solve(&mut operator, support, &r, &mut step, goal)?
            };
            iterations += solved.iterations.max(1);
            let far = step
                .as_flattened()
                .iter()
                .fold(0.0f64, |m, s| m.max(s.abs()));
            if far < LEAST_STEP * self.body.spacing {
                return Ok(Solved {
                    iterations,
                    residual: size / scale,
                });
            }
            // a full step, or as much of it as lowers the residual; downhill that may grow
            let mut part = match unstable {
                true => (LONGEST_STEP * self.body.spacing / far).min(1.0),
                false => 1.0,
            };
            for halving in 0..=HALVINGS {
                let tried: Vec<[f64; D]> = x
                    .iter()
                    .zip(&step)
                    .map(|(x, s)| std::array::from_fn(|a| x[a] + part * s[a]))
                    .collect();
                let new = self.imbalance(&tried, &mut r, support);
                if norm(&r) < size || unstable || halving == HALVINGS {
                    (x, scale) = (tried, new.hypot(rest));
                    break;
                }
                part *= 0.5;
            }
        }
        Err(SolveError::NotConverged {
            iterations,
            residual: norm(&r) / scale,
            tolerance: goal.tolerance,
        })
    }

    /// Forces on the free components at displacements `x`, and the size of the loads and reactions.
    fn imbalance(&mut self, x: &[[f64; D]], r: &mut [[f64; D]], support: &Support<D>) -> f64 {
        self.set_values(x);
        self.forces_held();
        let all = self.per_point(&self.f);
        let loads = self.external();
        let loads = self.per_point(&loads);
        let mut scale = 0.0;
        for i in 0..r.len() {
            for a in 0..D {
                let free = support.free[i][a];
                r[i][a] = if free { all[i][a] } else { 0.0 };
                let outside = if free { loads[i][a] } else { all[i][a] };
                scale += outside * outside;
            }
        }
        scale.sqrt()
    }

    fn relax(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let goal = Self::goal(state.options);
        // direct stiffness of every point as its mass, scaled so that a step of 1 is well below the limit
        let mut sum = vec![0.0; self.body.len];
        let rest = self.body.at_rest();
        let body = &self.body;
        self.interaction.tangents(body, &rest, &mut |bond| {
            let trace: f64 = (0..D).map(|a| bond.stiffness[a][a].abs()).sum();
            sum[bond.i] += body.volume.at(bond.i) * trace;
        });
        let mut mass = self.by_id(|i| sum[i]);
        let least = mass.iter().copied().fold(0.0, f64::max) * 1e-3;
        mass.iter_mut().for_each(|m| *m = m.max(least));
        let top = largest_ratio(&self.body, self.interaction.as_mut(), &mass);
        // a step of 1 is stable to 4; half of that leaves room for stiffening and contact
        mass.iter_mut().for_each(|m| *m *= 0.5 * top);
        let mut x = self.values(&self.u);
        let mut r = vec![[0.0; D]; x.len()];
        relax(&mut x, &mass, support, goal, |x, f| {
            let scale = self.imbalance(x, &mut r, support);
            f.copy_from_slice(&r);
            scale
        })
    }

    fn largest_stretch(&self) -> f64 {
        let mut worst = 0.0f64;
        self.interaction.each_bond(&self.body, &mut |i, j, xi, _| {
            let square: f64 = xi.iter().map(|c| c * c).sum();
            let longer: f64 = (0..D).map(|a| (self.u[a][j] - self.u[a][i]) * xi[a]).sum();
            worst = worst.max((longer / square).abs());
        });
        worst
    }

    /// Work of loads and reactions over the increment, by the trapezoidal rule.
    fn account(&mut self, u: &Field<D>, f: &Field<D>, external: &Field<D>) {
        let support = self.support();
        let now = self.external();
        let mut work = 0.0;
        for (n, &s) in self.body.slots.iter().enumerate() {
            let i = s as usize;
            for a in 0..D {
                let force = if support.free[n][a] {
                    external[a][i] + now[a][i]
                } else {
                    // loads and reaction together hold what the bonds pull
                    external[a][i] + now[a][i] - f[a][i] - self.f[a][i]
                };
                work += 0.5 * self.body.volume.at(i) * force * (self.u[a][i] - u[a][i]);
            }
        }
        self.past_work[1] += work;
    }

    /// The lowest modes of vibration about the state of now.
    ///
    /// # Errors
    /// Those of the factorisation.
    pub(super) fn lowest_modes(&mut self, count: usize) -> Result<Vec<Mode<D>>, SolveError> {
        let support = self.support();
        let body = self.linear_now();
        modes::lowest(&body, &support, count)
    }

    pub(super) fn padded(x: &[[f64; D]]) -> Vec<Point> {
        x.iter()
            .map(|x| std::array::from_fn(|a| if a < D { x[a] } else { 0.0 }))
            .collect()
    }
}

fn norm<const D: usize>(x: &[[f64; D]]) -> f64 {
    statics::norm(x)
}

/// Factors of a tangent that is not positive definite with enough of the masses added that steps lower the energy.
fn downhill<const D: usize>(
    body: &LinearBody<D>,
    support: &Support<D>,
) -> Result<Direct<D>, SolveError> {
    let stiff = Assembled(body).diagonal();
    let stiff: f64 = stiff
        .iter()
        .map(|k| (0..D).map(|a| k[a][a]).sum::<f64>())
        .sum();
    let mass: f64 = body
        .volume
        .iter()
        .zip(&body.density)
        .map(|(v, rho)| v * rho)
        .sum();
    let typical = stiff / (D as f64 * mass);
    let mut shift = 1e-2 * typical;
    loop {
        match Direct::new(body, support, shift) {
            Err(SolveError::Indefinite { .. }) if shift < 10.0 * typical => shift *= 4.0,
            made => return made,
        }
    }
}

/// Free components from the factors, with what the held ones pull.
fn direct<const D: usize>(
    body: &LinearBody<D>,
    factors: &Direct<D>,
    support: &Support<D>,
    b: &[[f64; D]],
    x: &mut [[f64; D]],
) -> Solved {
    let mut held = x.to_vec();
    for (h, free) in held.iter_mut().zip(&support.free) {
        for a in (0..D).filter(|a| free[*a]) {
            h[a] = 0.0;
        }
    }
    let mut r = vec![[0.0; D]; b.len()];
    let mut operator = Assembled(body);
    operator.apply(&held, &mut r);
    for (r, b) in r.iter_mut().zip(b) {
        *r = std::array::from_fn(|a| b[a] - r[a]);
    }
    support.mask(&mut r);
    let start = norm(&r);
    let mut solution = factors.solve(&r);
    // one step of refinement
    let mut left = vec![[0.0; D]; b.len()];
    operator.apply(&solution, &mut left);
    for (l, r) in left.iter_mut().zip(&r) {
        *l = std::array::from_fn(|a| r[a] - l[a]);
    }
    support.mask(&mut left);
    for (s, c) in solution.iter_mut().zip(factors.solve(&left)) {
        for a in 0..D {
            s[a] += c[a];
        }
    }
    for ((x, s), free) in x.iter_mut().zip(&solution).zip(&support.free) {
        for a in (0..D).filter(|a| free[*a]) {
            x[a] = s[a];
        }
    }
    operator.apply(&solution, &mut left);
    for (l, r) in left.iter_mut().zip(&r) {
        *l = std::array::from_fn(|a| r[a] - l[a]);
    }
    support.mask(&mut left);
    Solved {
        iterations: 1,
        residual: if start > 0.0 {
            norm(&left) / start
        } else {
            0.0
        },
    }
}

fn solve_assembled<const D: usize>(
    body: &LinearBody<D>,
    support: &Support<D>,
    b: &[[f64; D]],
    x: &mut [[f64; D]],
    goal: Goal,
) -> Result<Solved, SolveError> {
    let asymmetry = body.soundness().asymmetry;
    if asymmetry > statics::SYMMETRIC {
        return Err(SolveError::NotSymmetric { asymmetry });
    }
    cg::solve(&mut Assembled(body), support, b, x, goal)
}
