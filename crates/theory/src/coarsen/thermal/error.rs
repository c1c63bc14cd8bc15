//! Why frames give no linear body, and what to do about it.

use super::constants::CONSTANTS_LIMIT;
use peridyne::message;
use peridyne::quantity::{Dimension, Message, Quantity};

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ThermalError {
    #[error("every frame must have a finite displacement and force, and every atom a kind")]
    Frames,
    #[error("{}", not_positive(*.0))]
    Radius(f64),
    #[error("{}", too_long(*.radius, *.period))]
    Box { radius: f64, period: f64 },
    #[error("{}", alone(*.radius))]
    Alone { radius: f64 },
    #[error(
        "{frames} of the frames are taken, too few: the fit needs at least {needed}, and more for small errors; give more frames, a larger crystal, or a shorter radius of bonds"
    )]
    Few { frames: usize, needed: usize },
    #[error(
        "the fit would have {constants} constants of {classes} kinds of surroundings, more than {CONSTANTS_LIMIT}: give a shorter radius of bonds, or a crystal with fewer different atoms (periodic, without defects)"
    )]
    Many { constants: usize, classes: usize },
    #[error(
        "the frames do not determine all constants: give more frames, further apart in time, or a shorter radius of bonds"
    )]
    Singular,
}

impl ThermalError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            ThermalError::Radius(radius) => not_positive(*radius),
            ThermalError::Box { radius, period } => too_long(*radius, *period),
            ThermalError::Alone { radius } => alone(*radius),
            other => other.to_string().into(),
        }
    }
}

fn length(x: f64) -> Quantity {
    Dimension::LENGTH.of(x)
}

fn not_positive(radius: f64) -> Message {
    message![
        "the radius of bonds must be a positive number, not ",
        length(radius)
    ]
}

fn too_long(radius: f64, period: f64) -> Message {
    message![
        "bonds up to ",
        length(radius),
        " do not fit into a period of ",
        length(period),
        ": two images of an atom would be one bond; give frames of a box of more than ",
        length(2.0 * radius),
        ", or a shorter radius of bonds"
    ]
}

fn alone(radius: f64) -> Message {
    message![
        "no two atoms are within ",
        length(radius),
        ": give a longer radius of bonds"
    ]
}
