//! How one increment finds its equilibrium: linear about the reference, or by Newton's method.

use super::problem::Problem;
use super::state::StaticState;
use super::tried::{Inertia, Tried};
use super::whole::unknowns;
use crate::boundary_condition::rigid::Wrench;
use crate::error::SolveError;
use crate::interaction::BondStatus;
use crate::spec::Statics;
use crate::statics::{self, Assembled, Direct, Goal, Imbalance, Solved, Support, Swept};

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

impl<const D: usize> Problem<'_, D> {
    pub(super) fn goal(&self, options: Statics) -> Goal {
        Goal {
            tolerance: options.tolerance,
            most_iterations: options.most_iterations,
            stop: self.system.stop,
        }
    }

    /// `A u = F` about the reference, with A's factors or by conjugate gradients.
    pub(super) fn solve_linear(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let mut load = self.system.external();
        if !self.system.at_peace() {
            let reference = self.system.stressed().forces.clone();
            for (f, &s) in reference.iter().zip(self.system.body.slots()) {
                for a in 0..D {
                    load[a][s as usize] += f[a];
                }
            }
        }
        let b = self.system.body.per_point(&load);
        let mut x = self.system.body.values(&self.system.u);
        let solved = self.solve_about_reference(state, support, &b, &mut x)?;
        self.system.set_values(&x);
        let stretch = self.largest_stretch();
        if stretch > SMALL_STRETCH
            && !self
                .system
                .info
                .warnings
                .iter()
                .any(|w| w.contains("linear solution"))
        {
            self.system.info.warnings.push(format!(
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
        // all that is left rests
        if unknowns(&self.system.body, support) == 0 {
            return Ok(Solved::default());
        }
        if self.system.factored(state.options, support) {
            let kept = state.factors.take();
            // the first rank has what there is
            let body = match self.sums.any(kept.is_some()) {
                true => None,
                false => self.reference_body(),
            };
            return self.solve_whole((support, b), x, |support, b, x| {
                let kept = kept.map(|(body, factors)| (body, Some(factors)));
                let (body, factors) = { kept.or(body.map(|body| (body, None))) }
                    .expect("the first rank has the matrix");
                let resisted = &support.resisted(&body);
                support.rests(resisted, b)?;
                if resisted.unknowns() == 0 {
                    return Ok(Solved::default());
                }
                let support = resisted;
                let factors = match factors {
                    Some(kept) => kept,
                    None => Direct::new(&body, support, 0.0)?,
                };
                let solved = factors.solve_held(&mut Assembled(&body), support, b, x);
                // LU of a singular matrix says nothing; what is not a number is no solution
                if !(solved.residual <= SOLVED) {
                    return Err(SolveError::Singular);
                }
                state.factors = Some((body, factors));
                Ok(solved)
            });
        }
        let goal = self.goal(state.options);
        if self.system.at_peace() {
            let interaction = self.system.interaction.as_mut();
            let mut operator = Swept::new(&self.system.body, interaction, &self.sums);
            let asymmetry = *state
                .asymmetry
                .get_or_insert_with(|| statics::operator::asymmetry(&mut operator, support));
            if asymmetry > statics::SYMMETRIC {
                return Err(SolveError::NotSymmetric { asymmetry });
            }
            statics::cg::solve(&mut operator, support, b, x, goal)
        } else {
            let body = self.reference_body();
            self.solve_whole((support, b), x, |support, b, x| {
                let body = body.expect("the first rank has the matrix");
                statics::cg::solve_assembled(&body, &[], support, b, x, goal)
            })
        }
    }

    /// Equilibrium by Newton's method, from the displacements of now.
    pub(in crate::run) fn solve_newton(
        &mut self,
        state: &mut StaticState<D>,
        support: &Support<D>,
    ) -> Result<Solved, SolveError> {
        let start = Tried::at_rest(self.system.body.values(&self.system.u));
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
        let mut missing = self.missing(&now, inertia, &mut r, support);
        let mut scale = libm::hypot(missing.scale, reference);
        let mut iterations = 0;
        for _ in 0..NEWTON {
            goal.go_on(0, &self.sums)?;
            let size = missing.size;
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
            let equations = self.equations(state, support, inertia)?;
            let (unstable, old) = (equations.unstable, equations.old);
            let rough = Goal {
                tolerance: ROUGH,
                ..goal
            };
            let (step, took) = self.step_of(&equations, support, &r, &missing.bodies, rough)?;
            iterations += took;
            if inertia.is_some() && equations.factored {
                state.step = Some(equations);
            }
            let far = self.sums.largest(&step.x).max(step.far);
            let least = match inertia {
                None => LEAST_STEP * self.system.body.spacing(),
                // points may have gone far from where they were
                Some(_) => (LEAST_STEP * self.system.body.spacing())
                    .max(4.0 * f64::EPSILON * self.sums.largest(&now.x)),
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
                true => (LONGEST_STEP * self.system.body.spacing() / far).min(1.0),
                false => 1.0,
            };
            for halving in 0..=HALVINGS {
                let tried = now.along(&step, part, inertia);
                missing = self.missing(&tried, inertia, &mut r, support);
                let left = missing.size;
                if old && !(left < SERVES * size) {
                    state.step = None;
                }
                if left < size || unstable || halving == HALVINGS {
                    (now, scale) = (tried, libm::hypot(missing.scale, reference));
                    break;
                }
                if old {
                    // with factors of here
                    missing = self.missing(&now, inertia, &mut r, support);
                    scale = libm::hypot(missing.scale, reference);
                    break;
                }
                part *= 0.5;
            }
        }
        Err(goal.missed(iterations, missing.size / scale))
    }

    /// Forces that are missing on the free components and on bodies, less what inertia takes.
    fn missing(
        &mut self,
        tried: &Tried<D>,
        inertia: Option<&Inertia<D>>,
        r: &mut [[f64; D]],
        support: &Support<D>,
    ) -> Missing {
        let Some(inertia) = inertia else {
            let Imbalance { size, scale } = self.imbalance(&tried.x, r, support);
            return Missing {
                size,
                scale,
                bodies: vec![],
            };
        };
        self.set_velocities_of(tried);
        self.place_bodies(tried, inertia);
        let scale = self.imbalance(&tried.x, r, support).scale;
        let (bodies, [left, acting]) = self.missing_of_bodies(tried, inertia);
        let found = inertia.take(&self.system.body, tried, (r, &self.sums), support);
        Missing {
            scale: libm::hypot(libm::hypot(scale, found.scale), acting),
            size: libm::hypot(found.size, left),
            bodies,
        }
    }

    /// What atoms at their sites pull at each other without any load; 0 of other laws.
    pub(super) fn residual_of_reference(&mut self, support: &Support<D>) -> f64 {
        if self.system.at_peace() {
            return 0.0;
        }
        let before = self.system.body.values(&self.system.u);
        let mut r = vec![[0.0; D]; before.len()];
        let found = self.imbalance(&vec![[0.0; D]; before.len()], &mut r, support);
        self.system.set_values(&before);
        found.size
    }

    /// Forces on the free components at displacements `x`.
    pub(super) fn imbalance(
        &mut self,
        x: &[[f64; D]],
        r: &mut [[f64; D]],
        support: &Support<D>,
    ) -> Imbalance {
        self.system.set_values(x);
        self.system.forces_held(self.system.clock.trial());
        let all = self.system.body.per_point(&self.system.f);
        let loads = self.system.external();
        let loads = self.system.body.per_point(&loads);
        r.copy_from_slice(&all);
        support.mask(r);
        let squares = self.sums.each(r.len(), |i| {
            let outside = |a: usize| match support.free[i][a] {
                true => loads[i][a],
                false => all[i][a],
            };
            let square = |of: &dyn Fn(usize) -> f64| (0..D).map(|a| of(a) * of(a)).sum::<f64>();
            [square(&|a| r[i][a]), square(&outside)]
        });
        let [size, scale] = squares.map(f64::sqrt);
        Imbalance { size, scale }
    }

    fn largest_stretch(&self) -> f64 {
        let mut worst = 0.0f64;
        let (body, u) = (&self.system.body, &self.system.u);
        let interaction = self.system.interaction.as_ref();
        // atoms may be near to some that have no copy here
        let mut far = false;
        interaction.each_bond(body, &mut |_, j, _, _| far |= j >= body.len());
        let known = match self.sums.any(far) {
            true => u.each_ref().map(|u| body.everywhere(body.by_id(|s| u[s]))),
            false => crate::array::from_fn(|_| vec![]),
        };
        let at = |a: usize, n: usize| match n.checked_sub(body.len()) {
            None => u[a][n],
            Some(id) => known[a][id],
        };
        interaction.each_bond(body, &mut |i, j, xi, state| {
            if state == BondStatus::Absent {
                return;
            }
            let square: f64 = xi.iter().map(|c| c * c).sum();
            let longer: f64 = (0..D).map(|a| (at(a, j) - at(a, i)) * xi[a]).sum();
            worst = worst.max((longer / square).abs());
        });
        self.sums.most(worst)
    }
}

/// What a trial leaves, and what that is compared with (force).
struct Missing {
    size: f64,
    scale: f64,
    /// Of rigid bodies with mass.
    bodies: Vec<Wrench>,
}
