//! Why a model has no upscaling.

use crate::crystal::CrystalError;
use peridyne::message;
use peridyne::quantity::{Dimension, Message};

/// Why a model has no upscaling.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UpscaleError {
    #[error("the factor is {0}: expected a whole number of 2 or more")]
    Factor(u32),
    #[error(
        "only a lattice body can be upscaled: its coarse points are lattice points, too (a crystal of any calculator of ASE: peridyne.ase.upscale)"
    )]
    NoLattice,
    #[error(
        "a body with several materials is not upscaled, unless they are atoms whose kinds repeat from cell to cell: one law has one \
         upscaling"
    )]
    SeveralMaterials,
    #[error(
        "the materials do not lie on the coarse lattice as they lie on this one: name sublattices by the sites of the cell, \
         `sets.NAME = {{ basis = [2] }}`, which grow with it"
    )]
    OtherArrangement,
    #[error("{what} {number} is not divisible by the factor {factor}: choose one of {choices}")]
    NotDivisible {
        what: &'static str,
        number: u32,
        factor: u32,
        choices: String,
    },
    #[error(
        "{}", beyond(*.spacing, *.horizon, *.most)
    )]
    BeyondHorizon {
        spacing: f64,
        horizon: f64,
        most: u32,
    },
    #[error("nonlinear gradient equations are those of a chain of atoms")]
    NoChain,
    #[error(
        "only springs, solids, and Lennard-Jones on fixed neighbours without a cut-off keep their reach: a potential with \
         lengths of its own has one spacing, and keeps its shells"
    )]
    NoReach,
    #[error(
        "a micromodulus belongs to its horizon, which grows with the spacing where shells are kept: give the law `young` or \
         `bulk` instead"
    )]
    Micromodulus,
    #[error(
        "a potential has no influence function: kernels are those of springs and peridynamic solids"
    )]
    NoKernels,
    #[error(
        "a micromodulus belongs to its influence function: give the law `young` or `bulk` instead, which every kernel fits"
    )]
    OneKernel,
    #[error(transparent)]
    Crystal(#[from] CrystalError),
    #[error(transparent)]
    Surface(#[from] crate::homogenize::surface::SurfaceError),
}

pub(super) fn beyond(spacing: f64, horizon: f64, most: u32) -> Message {
    message![
        "the coarse spacing ",
        Dimension::LENGTH.of(spacing),
        " is beyond the horizon ",
        Dimension::LENGTH.of(horizon),
        format!(": points would be alone; the largest factor is {most}"),
    ]
}

impl UpscaleError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            UpscaleError::BeyondHorizon {
                spacing,
                horizon,
                most,
            } => beyond(*spacing, *horizon, *most),
            UpscaleError::Crystal(e) => e.message(),
            UpscaleError::Surface(e) => e.message(),
            other => other.to_string().into(),
        }
    }
}
