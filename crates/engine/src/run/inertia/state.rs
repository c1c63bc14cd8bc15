//! What moves a body whose masses couple points.

use crate::body::{Body, Field, zeros};
use crate::dynamics::stable_step::Coupled;
use crate::error::{BuildError, SolveError};
use crate::interaction::Interaction;
use crate::spec::Spec;
use crate::statics::{Direct, Masses, SYMMETRIC, Support};
use std::sync::Arc;

/// Masses, their factors, and what was found with them.
pub(in crate::run) struct Inertia<const D: usize> {
    pub masses: Arc<Masses<D>>,
    /// Components that forces move, and the factors of their masses; none where nothing is free.
    pub support: Support<D>,
    factors: Option<Direct<D>>,
    /// `ρ a` (force density); 0 where motion is prescribed.
    pub push: Field<D>,
    /// `M a` over volumes at the last evaluation of forces and at the one before (force density).
    pub taken: [Field<D>; 2],
}

fn factors<const D: usize>(
    masses: &Masses<D>,
    support: &Support<D>,
) -> Result<Option<Direct<D>>, SolveError> {
    match masses.factors(support) {
        Err(SolveError::NothingFree) => Ok(None),
        made => made.map(Some),
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
        let factors = factors(&masses, &support).map_err(|e| {
            BuildError::invalid(
                "materials[0].law",
                format!("the masses of the linear body have no inverse: {e}"),
            )
            .help("a mass matrix is symmetric and positive definite; without one every point has its own mass")
        })?;
        Ok(Some(Inertia {
            masses: Arc::new(masses),
            support,
            factors,
            push: zeros(body.len()),
            taken: [zeros(body.len()), zeros(body.len())],
        }))
    }

    /// Accelerations where `a` holds those that are prescribed; not a number if there was no room for factors.
    pub fn accelerate(&mut self, support: &Support<D>, force: &[[f64; D]], a: &mut [[f64; D]]) {
        if self.support != *support {
            match factors(&self.masses, support) {
                Ok(made) => self.factors = made,
                Err(_) => return a.fill([f64::NAN; D]),
            }
            self.support = support.clone();
        }
        if let Some(factors) = &self.factors {
            self.masses.accelerate(factors, support, force, a);
        }
    }

    /// The largest eigenvalue of `M⁻¹K` (1 / time²), of a body without symmetry a bound on all.
    pub fn largest_eigenvalue(&self, body: &Body<D>, interaction: &mut dyn Interaction<D>) -> f64 {
        let solve = |force: &[[f64; D]]| {
            let mut a = vec![[0.0; D]; force.len()];
            if let Some(factors) = &self.factors {
                self.masses
                    .accelerate(factors, &self.support, force, &mut a);
            }
            a
        };
        let coupled = Coupled {
            times: &|x| self.masses.times(x),
            solve: &solve,
        };
        match interaction.asymmetry() > SYMMETRIC {
            true => coupled.bound(body, interaction),
            false => coupled.largest_eigenvalue(body, interaction),
        }
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
