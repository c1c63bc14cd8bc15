//! What a run dies of.

use std::fmt;

use super::SolveError;
use crate::message;
use crate::quantity::{Dimension, Message, place};

/// A run that went bad. The simulation keeps its last good state.
#[derive(Debug, Clone, PartialEq)]
pub enum RunError {
    NotFinite {
        step: u64,
        id: u64,
        position: [f64; 3],
    },
    TooFast {
        step: u64,
        id: u64,
        position: [f64; 3],
        path: f64,
        spacing: f64,
        /// The stability limit of contact, if contact is what drives the point.
        contact: Option<f64>,
    },
    Density {
        step: u64,
        id: u64,
        position: [f64; 3],
        density: f64,
    },
    Equilibrium {
        step: u64,
        /// Where, if it is one place.
        position: Option<[f64; 3]>,
        error: SolveError,
    },
    Implicit {
        step: u64,
        /// Where, if it is one place.
        position: Option<[f64; 3]>,
        error: SolveError,
    },
    Jump {
        step: u64,
        /// In the reference.
        position: [f64; 3],
        axis: &'static str,
        asked: f64,
        found: f64,
    },
    Touching {
        step: u64,
        pairs: usize,
    },
    Toughness {
        step: u64,
        position: [f64; 3],
        value: f64,
    },
    Diffusion {
        step: u64,
        /// What spreads.
        quantity: &'static str,
        error: SolveError,
    },
    Crossing {
        step: u64,
        i: u64,
        j: u64,
    },
    /// Of an equilibrium, which knows no time step.
    Unbalanced {
        step: u64,
        before: f64,
        after: f64,
    },
    /// Breaking has made so much of the energy that the body was given.
    Made {
        step: u64,
        given: f64,
        made: f64,
    },
    Unstable {
        step: u64,
        before: f64,
        after: f64,
        time_step: f64,
        /// The stability limit of contact, if contact holds the energy.
        contact: Option<f64>,
    },
}

impl RunError {
    /// What happened, with numbers that know what they measure.
    pub fn message(&self) -> Message {
        let point = |step: &u64, id: &u64, x: &[f64; 3]| {
            message![format!("step {step}: point {id} at "), place(x)]
        };
        let somewhere =
            |x: &Option<[f64; 3]>| x.map_or(Message::default(), |x| message![" at ", place(&x)]);
        match self {
            RunError::NotFinite { step, id, position } => {
                message![point(step, id, position), " is not finite"]
            }
            RunError::TooFast {
                step,
                id,
                position,
                path,
                spacing,
                contact,
            } => too_fast(point(step, id, position), [*path, *spacing], *contact),
            RunError::Density {
                step,
                id,
                position,
                density,
            } => message![
                format!("step {step}: the electron density at atom {id} at "),
                place(position),
                format!(
                    " is {density:.4}: the embedding energy has no meaning there (its logarithm needs a positive density); atoms are too close or too far from each other for this potential, or its length scales do not fit the lattice"
                ),
            ],
            RunError::Equilibrium {
                step,
                position,
                error,
            } => {
                message![format!("increment {step}: {error}"), somewhere(position)]
            }
            RunError::Implicit {
                step,
                position,
                error,
            } => message![
                format!(
                    "step {step}: the equations of the implicit step have no solution: {error}"
                ),
                somewhere(position),
                shorter(error),
            ],
            RunError::Jump {
                step,
                position,
                axis,
                asked,
                found,
            } => jump(*step, position, axis, [*asked, *found]),
            RunError::Touching { step, pairs } => format!(
                "after {step} increments of statics, which knew no contact, {pairs} pairs of points touch or attract each other: write method = \"relaxation\" under [statics], or contact = false"
            )
            .into(),
            RunError::Toughness {
                step,
                position,
                value,
            } => message![
                format!("step {step}: the factor of the toughness is {value} at "),
                place(position),
                ", expected a positive number",
            ],
            RunError::Diffusion {
                step,
                quantity,
                error,
            } => {
                format!("step {step}: the equations of {quantity} have no solution: {error}").into()
            }
            RunError::Crossing { step, i, j } => format!(
                "step {step}: points {i} and {j} crossed: their bond turned over within one step"
            )
            .into(),
            RunError::Unbalanced {
                step,
                before,
                after,
            } => message![
                format!("increment {step}: forces balance, energy does not: "),
                Dimension::ENERGY.of(*before),
                " came in, and ",
                Dimension::ENERGY.of(*after),
                " are there; flow or breaking within this increment went further than the law follows: take more increments, or let it break in motion ([run])",
            ],
            RunError::Made { step, given, made } => energy_made(*step, *given, *made),
            RunError::Unstable {
                step,
                before,
                after,
                time_step,
                contact,
            } => grown(*step, [*before, *after], *time_step, *contact),
        }
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.message().fmt(f)
    }
}

impl std::error::Error for RunError {}

/// A `path` of one step that is longer than the spacing.
fn too_fast(point: Message, [path, spacing]: [f64; 2], contact: Option<f64>) -> Message {
    message![
        point,
        " would move ",
        Dimension::LENGTH.of(path),
        " in one step, more than the spacing ",
        Dimension::LENGTH.of(spacing),
        ": ",
        blame(contact, "the run is unstable or the step too long".into()),
    ]
}

/// Motion that does not begin where statics ended.
fn jump(step: u64, position: &[f64; 3], axis: &str, [asked, found]: [f64; 2]) -> Message {
    message![
        format!("after {step} increments of statics: motion asks for a displacement of "),
        Dimension::LENGTH.of(asked),
        format!(" along {axis} at "),
        place(position),
        ", where statics left it at ",
        Dimension::LENGTH.of(found),
        ": prescribe a velocity of 0 to hold a point where it is",
    ]
}

fn energy_made(step: u64, given: f64, made: f64) -> Message {
    message![
        format!("step {step}: breaking has made "),
        Dimension::ENERGY.of(made),
        " of energy in a body that was given ",
        Dimension::ENERGY.of(given),
        ": its points hold more without the bonds that broke than with them, so what follows is no fracture; take a law whose points lose stiffness then (`correspondence`, `pals`), a smaller critical stretch, or less compression beside what breaks",
    ]
}

/// Energy that grew without work.
fn grown(step: u64, [before, after]: [f64; 2], time_step: f64, contact: Option<f64>) -> Message {
    message![
        format!("step {step}: total energy grew from "),
        Dimension::ENERGY.of(before),
        " to ",
        Dimension::ENERGY.of(after),
        " without work: ",
        blame(
            contact,
            message!["the step ", Dimension::TIME.of(time_step), " is unstable"]
        ),
    ]
}

/// Does a shorter implicit step help?
fn shorter(error: &SolveError) -> &'static str {
    match error {
        SolveError::Indefinite { .. } | SolveError::NotConverged { .. } => {
            "; a shorter time step makes them easier"
        }
        SolveError::NothingFree
        | SolveError::Loose(_)
        | SolveError::Unheld { .. }
        | SolveError::Singular
        | SolveError::TooLarge
        | SolveError::TooManyModes { .. }
        | SolveError::NotSymmetric { .. }
        | SolveError::StillBreaking { .. }
        | SolveError::Contact
        | SolveError::NoTangent { .. }
        | SolveError::PointStiffness
        | SolveError::NothingBreaks
        | SolveError::NotFinite
        | SolveError::NothingOpens
        | SolveError::Stopped
        | SolveError::Elsewhere => "",
    }
}

/// What a run dies of: `otherwise`, or contact, whose limit of the step is known.
fn blame(contact: Option<f64>, otherwise: Message) -> Message {
    let Some(limit) = contact else {
        return otherwise;
    };
    let limit = match limit.is_finite() {
        true => message![
            " (contact is stable below about ",
            Dimension::TIME.of(limit),
            ")"
        ],
        false => Message::default(),
    };
    message![
        "contact is the cause, points repel with more energy than their bonds hold: take a shorter step",
        limit,
        ", a lower contact stiffness, or slower points",
    ]
}
