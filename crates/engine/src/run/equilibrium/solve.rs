//! How one increment finds its equilibrium: linear about the reference, or by Newton's method.

use super::state::StaticState;
use super::tried::{Inertia, Tried};
use crate::body::{Field, zeros};
use crate::error::SolveError;
use crate::interaction::Sweep;
use crate::run::Simulation;
use crate::run::constitutive::Laws;
use crate::run::model::Model;
use crate::spec::{LinearBody, Solver, Statics};
use crate::statics::cg::{self, Goal};
use crate::statics::{
    self, Assembled, Direct, LinearOperator, Shifted, Solved, Support, Swept, norm,
};

/// Unknowns up to which the equations are factored, per dimension.
const DIRECT: [usize; 3] = [usize::MAX, 60_000, 12_000];
/// Relative residual above which a direct solution is none: the matrix is singular to round-off.
const SOLVED: f64 = 1e-6;
/// Newton's iterations at most.
const NEWTON: usize = 50;
/// A Newton step of so many spacings is round-off: forces of a crystal in equilibrium are never exactly 0.
const LEAST_STEP: f64 = 1e-14;
/// Longest step (spacings) from a state that is no minimum of the energy.
const LONGEST_STEP: f64 = 0.1;
/// How often a Newton step is halved.
const HALVINGS: usize = 12;
/// Factors of an earlier state serve as long as a step with them leaves no more than this part of the residual.
const SERVES: f64 = 0.1;
/// Residual at which conjugate gradients end within a Newton step.
const ROUGH: f64 = 1e-4;
/// Largest stretch up to which a linear solution is taken without a warning.
const SMALL_STRETCH: f64 = 0.01;

impl<const D: usize> Model<D> {
    /// Force densities of the loads at this time.
    pub(super) fn external(&mut self) -> Field<D> {
        let mut f = zeros(self.body.len);
        let (v, t) = (zeros(self.body.len), self.time());
        for load in &mut self.loads {
            load.add(&self.body, [&self.u, &v], &mut f, t, 0.0);
        }
        f
    }

    /// Forces per point of force densities.
    pub(super) fn per_point(&self, f: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| {
            let volume = self.body.volume.at(i);
            std::array::from_fn(|a| volume * f[a][i])
        })
    }

    pub(in crate::run) fn values(&self, u: &Field<D>) -> Vec<[f64; D]> {
        self.by_id(|i| std::array::from_fn(|a| u[a][i]))
    }

    pub(in crate::run) fn set_values(&mut self, x: &[[f64; D]]) {
        let mut square = 0.0f64;
        for (x, &s) in x.iter().zip(&self.body.slots) {
            let mut path = 0.0;
            for a in 0..D {
                let u = &mut self.u[a][s as usize];
                path += (x[a] - *u) * (x[a] - *u);
                *u = x[a];
            }
            square = square.max(path);
        }
        self.refresh_images();
        // who keeps track of what is near is told of every trial
        let path = square.sqrt();
        if let Some(contact) = &mut self.contact {
            contact.moved(path);
        }
        self.indenters.iter_mut().for_each(|i| i.moved(path));
    }

    /// The linear body about the displacements of now, points that touch too.
    fn tangent_now(&mut self) -> LinearBody<D> {
        self.refresh_images();
        let contact = self.contact.as_ref();
        statics::linear_body_touching(&self.body, self.interaction.as_mut(), contact, &self.u)
    }

    /// What indenters resist with at points (force / length).
    fn pushed(&self) -> Vec<f64> {
        let mut sum = vec![0.0; self.body.len];
        for indenter in &self.indenters {
            indenter.add_stiffness(&self.body, &self.u, &mut sum);
        }
        self.by_id(|i| sum[i])
    }

    pub(in crate::run) fn factored(&self, options: Statics, support: &Support<D>) -> bool {
        if self.interaction.asymmetry() > statics::SYMMETRIC {
            return true;
        }
        match options.solver {
            Solver::Direct => true,
            Solver::ConjugateGradients => false,
            Solver::Auto => support.unknowns() <= DIRECT[D - 1],
        }
    }

    pub(super) fn goal(&self, options: Statics) -> Goal {
        Goal {
            tolerance: options.tolerance,
            most_iterations: options.most_iterations,
            stop: self.stop,
        }
    }

    /// Does the reference carry no force, so that sweeps at tiny displacements are its tangent?
    pub(super) fn at_peace(&self) -> bool {
        !matches!(self.constitutive.first().laws, Laws::Atoms(_)) && !self.expands()
    }

    /// `A u = F` about the reference, with A's factors or by conjugate gradients.
    pub(super) fn solve_linear(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let mut load = self.external();
        if !self.at_peace() {
            let mut reference = zeros(self.body.len);
            let u = self.body.at_rest();
            self.interaction
                .forces(&self.body, &u, &mut reference, Sweep::Hold, None);
            for a in 0..D {
                for (l, r) in load[a].iter_mut().zip(reference[a].iter()) {
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

    pub(super) fn solve_about_reference(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
        b: &[[f64; D]],
        x: &mut [[f64; D]],
    ) -> Result<Solved, SolveError> {
        if self.factored(state.options, support) {
            let (body, factors) = match state.factors.take() {
                Some(kept) => kept,
                None => {
                    let body = self.reference_body();
                    let factors = Direct::new(&body, support, 0.0)?;
                    (body, factors)
                }
            };
            let solved = factors.solve_held(&mut Assembled(&body), support, b, x);
            // LU of a singular matrix says nothing; what is not a number is no solution
            if !(solved.residual <= SOLVED) {
                return Err(SolveError::Singular);
            }
            state.factors = Some((body, factors));
            return Ok(solved);
        }
        let goal = self.goal(state.options);
        if self.at_peace() {
            let mut operator = Swept::new(&self.body, self.interaction.as_mut());
            let asymmetry = *state
                .asymmetry
                .get_or_insert_with(|| statics::operator::asymmetry(&mut operator, support));
            if asymmetry > statics::SYMMETRIC {
                return Err(SolveError::NotSymmetric { asymmetry });
            }
            cg::solve(&mut operator, support, b, x, goal)
        } else {
            let body = self.reference_body();
            solve_assembled(&body, &[], support, b, x, goal)
        }
    }

    /// Equilibrium by Newton's method, from the displacements of now.
    pub(in crate::run) fn solve_newton(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let start = Tried::at_rest(self.values(&self.u));
        let (solved, _) = self.solve_from(state, support, start, None)?;
        Ok(solved)
    }

    /// Newton's method with the tangent of every state; where that is too large, with the tangent of the reference. With
    /// inertia factors are kept as long as they serve. What was found is the state.
    pub(in crate::run) fn solve_from(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
        mut now: Tried<D>,
        inertia: Option<&Inertia<D>>,
    ) -> Result<(Solved, Tried<D>), SolveError> {
        let goal = self.goal(state.options);
        let mut r = vec![[0.0; D]; now.x.len()];
        let reference = self.residual_of_reference(support);
        let mut scale = self
            .missing(&now, inertia, &mut r, support)
            .hypot(reference);
        let mut iterations = 0;
        for _ in 0..NEWTON {
            goal.go_on()?;
            let size = norm(&r);
            if !size.is_finite() {
                return Err(SolveError::NotFinite);
            }
            let part_of = |scale: f64| if scale > 0.0 { size / scale } else { 0.0 };
            let solved = Solved {
                iterations,
                residual: part_of(scale),
            };
            if size <= goal.tolerance * scale {
                return Ok((solved, now));
            }
            let mut step = vec![[0.0; D]; now.x.len()];
            let rough = Goal {
                tolerance: ROUGH,
                ..goal
            };
            let (mut unstable, mut old) = (false, false);
            let linear = if self.factored(state.options, support) {
                let shift = inertia.map_or(0.0, Inertia::shift);
                let kept = state.factors.take();
                let kept = kept.filter(|(_, f)| inertia.is_some() && f.shift() == shift);
                old = kept.is_some();
                let (body, factors) = match kept {
                    Some(kept) => kept,
                    None => {
                        let mut body = self.tangent_now();
                        if let Some(inertia) = inertia {
                            inertia.load(&mut body, &self.pushed());
                        }
                        let factors = match Direct::new(&body, support, shift) {
                            Err(SolveError::Indefinite { .. })
                                if !self.at_peace() && inertia.is_none() =>
                            {
                                unstable = true;
                                downhill(&body, support)?
                            }
                            made => made?,
                        };
                        (body, factors)
                    }
                };
                let operator = &mut Assembled(&body);
                let added = inertia.map_or(vec![], |m| m.of_loaded(&body));
                let added = &added;
                let linear =
                    factors.solve_held(&mut Shifted { operator, added }, support, &r, &mut step);
                if inertia.is_some() {
                    state.factors = Some((body, factors));
                }
                linear
            } else if self.at_peace() && self.contact.is_none() {
                let added = &self.added(inertia);
                let operator = &mut Swept::new(&self.body, self.interaction.as_mut());
                let mut operator = Shifted { operator, added };
                cg::solve(&mut operator, support, &r, &mut step, rough)?
            } else {
                let added = self.added(inertia);
                let body = self.tangent_now();
                solve_assembled(&body, &added, support, &r, &mut step, rough)?
            };
            iterations += linear.iterations.max(1);
            let longest = |x: &[[f64; D]]| {
                let all = x.as_flattened().iter();
                all.fold(0.0f64, |m, s| m.max(s.abs()))
            };
            let far = longest(&step);
            let least = match inertia {
                None => LEAST_STEP * self.body.spacing,
                // points may have gone far from where they were
                Some(_) => {
                    (LEAST_STEP * self.body.spacing).max(4.0 * f64::EPSILON * longest(&now.x))
                }
            };
            if far < least {
                return Ok((
                    Solved {
                        iterations,
                        ..solved
                    },
                    now,
                ));
            }
            // a full step, or as much of it as lowers the residual; downhill that may grow
            let mut part = match unstable {
                true => (LONGEST_STEP * self.body.spacing / far).min(1.0),
                false => 1.0,
            };
            for halving in 0..=HALVINGS {
                let tried = now.along(&step, part, inertia);
                let new = self.missing(&tried, inertia, &mut r, support);
                let left = norm(&r);
                if old && !(left < SERVES * size) {
                    state.factors = None;
                }
                if left < size || unstable || halving == HALVINGS {
                    (now, scale) = (tried, new.hypot(reference));
                    break;
                }
                if old {
                    // with factors of here
                    scale = self
                        .missing(&now, inertia, &mut r, support)
                        .hypot(reference);
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

    /// What inertia and indenters add to the stiffness at points (force / length); empty: nothing.
    fn added(&self, inertia: Option<&Inertia<D>>) -> Vec<f64> {
        let Some(inertia) = inertia else {
            return vec![];
        };
        let both = inertia.added.iter().zip(self.pushed());
        both.map(|(a, b)| a + b).collect()
    }

    /// Forces that are missing on the free components, less what inertia takes, and what they are compared with.
    fn missing(
        &mut self,
        tried: &Tried<D>,
        inertia: Option<&Inertia<D>>,
        r: &mut [[f64; D]],
        support: &Support<D>,
    ) -> f64 {
        let Some(inertia) = inertia else {
            return self.imbalance(&tried.x, r, support);
        };
        self.set_velocities_of(tried);
        let scale = self.imbalance(&tried.x, r, support);
        scale.hypot(inertia.take(tried, r, support))
    }

    /// What atoms at their sites pull at each other without any load; 0 of other laws.
    pub(super) fn residual_of_reference(&mut self, support: &Support<D>) -> f64 {
        if self.at_peace() {
            return 0.0;
        }
        let before = self.values(&self.u);
        let mut r = vec![[0.0; D]; before.len()];
        self.imbalance(&vec![[0.0; D]; before.len()], &mut r, support);
        self.set_values(&before);
        norm(&r)
    }

    /// Forces on the free components at displacements `x`, and the size of the loads and reactions.
    pub(super) fn imbalance(
        &mut self,
        x: &[[f64; D]],
        r: &mut [[f64; D]],
        support: &Support<D>,
    ) -> f64 {
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

    fn largest_stretch(&self) -> f64 {
        let mut worst = 0.0f64;
        self.interaction.each_bond(&self.body, &mut |i, j, xi, _| {
            let square: f64 = xi.iter().map(|c| c * c).sum();
            let longer: f64 = (0..D).map(|a| (self.u[a][j] - self.u[a][i]) * xi[a]).sum();
            worst = worst.max((longer / square).abs());
        });
        worst
    }
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

fn solve_assembled<const D: usize>(
    body: &LinearBody<D>,
    added: &[f64],
    support: &Support<D>,
    b: &[[f64; D]],
    x: &mut [[f64; D]],
    goal: Goal,
) -> Result<Solved, SolveError> {
    let asymmetry = body.soundness().asymmetry;
    if asymmetry > statics::SYMMETRIC {
        return Err(SolveError::NotSymmetric { asymmetry });
    }
    let operator = &mut Assembled(body);
    cg::solve(&mut Shifted { operator, added }, support, b, x, goal)
}
