//! Can a body move by implicit steps?

use super::equilibrium::whole::unknowns;
use super::system::System;
use super::traits;
use crate::error::BuildError;
use crate::spec::{Control, Method, Newmark, Spec, Statics};

/// Can bonds break?
pub(super) fn breaks(spec: &Spec) -> bool {
    spec.materials.iter().any(|m| m.fracture.is_some())
        || spec
            .interactions
            .interfaces
            .iter()
            .any(|i| i.fracture.is_some())
}

/// What the equations of a step are solved by.
pub(super) fn equations(options: Newmark) -> Statics {
    Statics {
        method: Method::Newton,
        control: Control::Load,
        solver: options.solver,
        tolerance: options.tolerance,
        timed: true,
        cycles: None,
        most_iterations: options.most_iterations,
    }
}

impl<const D: usize> System<D> {
    /// Has all that acts a tangent, and is the method stable?
    pub(super) fn check_implicit(&self, options: Newmark) -> Result<(), BuildError> {
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
        if alpha != 0.0 && libm::hypot(beta - hht.beta, gamma - hht.gamma) > 1e-12 {
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
        traits::of_implicit_steps(self, options.solver)?;
        if self.applied.free().next().is_some() && unknowns(&self.body, &self.held()) == 0 {
            return Err(BuildError::unsupported(
                "rigid_bodies",
                "a rigid body with a mass moves implicitly beside points that are free, and all are held",
            )
            .help("take integrator = \"verlet\""));
        }
        let equations = equations(options);
        if self.factored(equations, &self.held()) {
            self.enough_memory_for_rows()?;
        }
        Ok(())
    }
}
