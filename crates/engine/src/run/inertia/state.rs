//! What moves a body whose masses couple points.

use super::masses::CoupledMasses;
use crate::body::{Body, Field, zeros};
use crate::dynamics::stable_step::{Coupled, lumped_bound};
use crate::error::{BuildError, SolveError};
use crate::interaction::Interaction;
use crate::run::agreed::agreed;
use crate::run::equilibrium::whole::{part_of_vectors, whole_support, whole_vectors};
use crate::spec::Spec;
use crate::statics::{Direct, Masses, SYMMETRIC, Support, linear_body};
use std::sync::Arc;

/// Masses, their factors, and what was found with them.
pub(in crate::run) struct Inertia<const D: usize> {
    pub masses: Arc<CoupledMasses<D>>,
    /// Components of the points here that forces move.
    pub support: Support<D>,
    /// On the first rank.
    solver: Option<Solver<D>>,
    /// `ρ a` (force density); 0 where motion is prescribed.
    pub push: Field<D>,
    /// `M a` over volumes at the last evaluation of forces and at the one before (force density).
    pub taken: [Field<D>; 2],
}

/// Components of all points that forces move, and the factors of their masses; none where nothing is free.
struct Solver<const D: usize> {
    support: Support<D>,
    factors: Result<Option<Direct<D>>, SolveError>,
}

impl<const D: usize> Solver<D> {
    /// On the first rank.
    fn of(body: &Body<D>, masses: &CoupledMasses<D>, support: &Support<D>) -> Option<Self> {
        let (support, masses) = whole_support(body, support).zip(masses.whole())?;
        let factors = match masses.factors(&support) {
            Err(SolveError::NothingFree) => Ok(None),
            made => made.map(Some),
        };
        Some(Solver { support, factors })
    }
}

impl<const D: usize> Inertia<D> {
    /// `None`: every point has a mass of its own alone.
    ///
    /// # Errors
    /// The masses are not positive definite, or what asks for points of their own.
    pub fn of(spec: &Spec, body: &Body<D>) -> Result<Option<Inertia<D>>, BuildError> {
        let linear = spec.micromoduli().and_then(|l| (**l).clone().of::<D>());
        let Some(masses) = linear.as_ref().and_then(Masses::of) else {
            return Ok(None);
        };
        let support = Support::none(body.points());
        let masses = CoupledMasses::new(body, masses);
        let solver = Solver::of(body, &masses, &support);
        let failed = { solver.as_ref() }.and_then(|s| s.factors.as_ref().err());
        let sound = failed.map_or(Ok(()), |e| {
            Err(BuildError::invalid(
                "materials[0].law",
                format!("the masses of the linear body have no inverse: {e}"),
            )
            .help("a mass matrix is symmetric and positive definite; without one every point has its own mass"))
        });
        agreed(body, sound)?;
        Ok(Some(Inertia {
            masses: Arc::new(masses),
            support,
            solver,
            push: zeros(body.len()),
            taken: [zeros(body.len()), zeros(body.len())],
        }))
    }

    /// Accelerations where `a` holds those that are prescribed; not a number if there was no room for factors.
    pub fn accelerate(
        &mut self,
        body: &Body<D>,
        support: &Support<D>,
        force: &[[f64; D]],
        a: &mut [[f64; D]],
    ) {
        if body.exchange().any(self.support != *support) {
            self.solver = Solver::of(body, &self.masses, support);
            self.support = support.clone();
        }
        self.solve(body, force, a);
    }

    fn solve(&self, body: &Body<D>, force: &[[f64; D]], a: &mut [[f64; D]]) {
        let [all, force] = [&*a, force].map(|own| whole_vectors(body, own));
        let known = self.solver.as_ref().zip(self.masses.whole());
        let found = known.zip(all.zip(force));
        let found = found.map(|((solver, masses), (mut a, force))| {
            match &solver.factors {
                Err(_) => a.fill([f64::NAN; D]),
                Ok(None) => {}
                Ok(Some(factors)) => masses.accelerate(factors, &solver.support, &force, &mut a),
            }
            a
        });
        a.copy_from_slice(&part_of_vectors(body, found));
    }

    /// The largest eigenvalue of `M⁻¹K` (1 / time²), of a body without symmetry a bound on all.
    pub fn largest_eigenvalue(&self, body: &Body<D>, interaction: &mut dyn Interaction<D>) -> f64 {
        let solve = |force: &[[f64; D]]| {
            let mut a = vec![[0.0; D]; force.len()];
            self.solve(body, force, &mut a);
            a
        };
        let coupled = Coupled {
            dot: &|x, y| self.masses.dot(body, x, y),
            solve: &solve,
        };
        if body.most(interaction.asymmetry()) <= SYMMETRIC {
            return coupled.largest_eigenvalue(body, interaction);
        }
        let linear = linear_body(body, interaction, &body.at_rest());
        let lumped = body.told(linear.map(|linear| lumped_bound(&linear)));
        lumped * coupled.lightest(body)
    }

    /// `M (v₁ − v₀)` over volumes in an explicit step (momentum density).
    pub fn change(&self, dt: f64) -> Field<D> {
        let [now, before] = &self.taken;
        let mut change = now.clone();
        for (change, before) in change.iter_mut().zip(before) {
            for (c, before) in change.iter_mut().zip(before.iter()) {
                *c = 0.5 * dt * (*c + before);
            }
        }
        change
    }
}
