//! What a run dies of.

use super::SolveError;

/// A run that went bad. The simulation keeps its last good state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    #[error("step {step}: point {id} at ({:.6e}, {:.6e}, {:.6e}) is not finite", position[0], position[1], position[2])]
    NotFinite {
        step: u64,
        id: u64,
        position: [f64; 3],
    },
    #[error(
        "step {step}: point {id} at ({:.6e}, {:.6e}, {:.6e}) would move {path:.3e} in one step, more than the spacing {spacing:.3e}: {}",
        position[0], position[1], position[2], blame(*contact, "the run is unstable or the step too long")
    )]
    TooFast {
        step: u64,
        id: u64,
        position: [f64; 3],
        path: f64,
        spacing: f64,
        /// The stability limit of contact, if contact is what drives the point.
        contact: Option<f64>,
    },
    #[error(
        "step {step}: the electron density at atom {id} at ({:.6e}, {:.6e}, {:.6e}) is {density:.4e}: the embedding energy has no meaning there (its logarithm needs a positive density); atoms are too close or too far from each other for this potential, or its length scales do not fit the lattice",
        position[0], position[1], position[2]
    )]
    Density {
        step: u64,
        id: u64,
        position: [f64; 3],
        density: f64,
    },
    #[error("increment {step}: {error}{}", position.map_or(String::new(), |x| format!(" at ({:.6e}, {:.6e}, {:.6e})", x[0], x[1], x[2])))]
    Equilibrium {
        step: u64,
        /// Where, if it is one place.
        position: Option<[f64; 3]>,
        error: SolveError,
    },
    #[error("step {step}: the equations of the implicit step have no solution: {error}{}{}", position.map_or(String::new(), |x| format!(" at ({:.6e}, {:.6e}, {:.6e})", x[0], x[1], x[2])), shorter(error))]
    Implicit {
        step: u64,
        /// Where, if it is one place.
        position: Option<[f64; 3]>,
        error: SolveError,
    },
    #[error("after {step} increments of statics: motion asks for a displacement of {asked:.6e} along {axis} at ({:.6e}, {:.6e}, {:.6e}), where statics left it at {found:.6e}: prescribe a velocity of 0 to hold a point where it is", position[0], position[1], position[2])]
    Jump {
        step: u64,
        /// In the reference.
        position: [f64; 3],
        axis: &'static str,
        asked: f64,
        found: f64,
    },
    #[error(
        "after {step} increments of statics, which knew no contact, {pairs} pairs of points touch: write method = \"relaxation\" under [statics], or contact = false"
    )]
    Touching { step: u64, pairs: usize },
    #[error("step {step}: the factor of the toughness is {value} at ({:.6e}, {:.6e}, {:.6e}), expected a positive number", position[0], position[1], position[2])]
    Toughness {
        step: u64,
        position: [f64; 3],
        value: f64,
    },
    #[error("step {step}: the equations of {quantity} have no solution: {error}")]
    Transfer {
        step: u64,
        /// What spreads.
        quantity: &'static str,
        error: SolveError,
    },
    #[error("step {step}: points {i} and {j} crossed: their bond turned over within one step")]
    Crossing { step: u64, i: u64, j: u64 },
    #[error(
        "step {step}: total energy grew from {before:.6e} to {after:.6e} without work: {}", blame(*contact, &format!("the step {time_step:.3e} is unstable"))
    )]
    Unstable {
        step: u64,
        before: f64,
        after: f64,
        time_step: f64,
        /// The stability limit of contact, if contact holds the energy.
        contact: Option<f64>,
    },
}

/// Does a shorter implicit step help?
fn shorter(error: &SolveError) -> &'static str {
    match error {
        SolveError::Indefinite { .. } | SolveError::NotConverged { .. } => {
            "; a shorter time step makes them easier"
        }
        SolveError::NothingFree
        | SolveError::Loose(_)
        | SolveError::Singular
        | SolveError::TooLarge
        | SolveError::TooManyModes { .. }
        | SolveError::NotSymmetric { .. }
        | SolveError::StillBreaking { .. }
        | SolveError::Contact
        | SolveError::NoTangent { .. }
        | SolveError::NothingBreaks
        | SolveError::NotFinite
        | SolveError::Stopped => "",
    }
}

/// What a run dies of: `otherwise`, or contact, whose limit of the step is known.
fn blame(contact: Option<f64>, otherwise: &str) -> String {
    match contact {
        None => otherwise.to_string(),
        Some(limit) => {
            let limit = match limit.is_finite() {
                true => format!(" (contact is stable below about {limit:.3e})"),
                false => String::new(),
            };
            format!(
                "contact is the cause, points repel with more energy than their bonds hold: take a shorter step{limit}, a lower contact stiffness, or slower points"
            )
        }
    }
}
