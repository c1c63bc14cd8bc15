//! What makes a lattice no crystal.

use peridyne::message;
use peridyne::quantity::{Dimension, Message, rounded};
use peridyne::space::lattice::LatticeKind;

/// Why there is no crystal.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrystalError {
    #[error("a {lattice} lattice has {expected} dimensions, not {found}")]
    Dimension {
        lattice: &'static str,
        expected: usize,
        found: usize,
    },
    #[error("{what} is {}, expected a positive number", rounded(*.value, 6))]
    NotPositive { what: &'static str, value: f64 },
    #[error("the potential has no cut-off: say up to which distance or shell neighbours count")]
    NoCutoff,
    #[error("{}", no_neighbours(*.reach, *.nearest))]
    NoNeighbours { reach: f64, nearest: f64 },
    #[error("at most {most} shells of neighbours are counted, {requested} were asked for")]
    TooManyShells { requested: u32, most: u32 },
    #[error("at most {most} gradient orders are derived, {requested} were asked for")]
    TooManyTerms { requested: usize, most: usize },
    #[error(
        "the embedding energy has no value at the reference density {}: the state is outside of what the \
         potential describes", rounded(*.density, 6)
    )]
    Density { density: f64 },
    #[error("atoms have a potential: take `Crystal::of_potential`")]
    NotASolid,
    #[error(
        "waves, stability and upscaling are not known of the law {0}: they take pmb, lps, springs and potentials"
    )]
    Registered(String),
    #[error(
        "waves and constants of lps are known where its influence function is the same from both ends of a bond, ω(ξ) = ω(−ξ)"
    )]
    Directed,
    /// Materials that lie anyhow.
    #[error(
        "the materials do not repeat within the body: plane waves are those of a periodic crystal. Name sublattices by the sites of the \
         cell, `sets.NAME = {{ basis = [2] }}`, or by an expression that repeats"
    )]
    NotPeriodic,
    #[error(
        "potentials of more than two atoms, and sums of several, have no fixed neighbours: they interact with those that are near now (leave \
         family out)"
    )]
    FixedNeighbours,
    /// A name that the engine does not have, or constants that do not fit it.
    #[error("{0}")]
    Potential(String),
    /// The horizon is in another unit, most likely.
    #[error("{0}")]
    TooManyBonds(String),
    #[error("{}", no_value(*.distance))]
    Distance { distance: f64 },
}

impl CrystalError {
    /// What it says, its numbers with what they measure.
    pub fn message(&self) -> Message {
        match self {
            CrystalError::NoNeighbours { reach, nearest } => no_neighbours(*reach, *nearest),
            CrystalError::Distance { distance } => no_value(*distance),
            other => other.to_string().into(),
        }
    }
}

pub(super) fn positive(what: &'static str, value: f64) -> Result<(), CrystalError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(CrystalError::NotPositive { what, value })
    }
}

pub(super) fn same_dimension<const D: usize>(kind: LatticeKind) -> Result<(), CrystalError> {
    if kind.dimension() == D {
        Ok(())
    } else {
        Err(CrystalError::Dimension {
            lattice: kind.name(),
            expected: kind.dimension(),
            found: D,
        })
    }
}

fn no_neighbours(reach: f64, nearest: f64) -> Message {
    message![
        "no neighbour within the reach of ",
        Dimension::LENGTH.of(reach),
        ": the nearest is at ",
        Dimension::LENGTH.of(nearest),
    ]
}

fn no_value(distance: f64) -> Message {
    message![
        "the potential has no value at the distance ",
        Dimension::LENGTH.of(distance),
        " of the reference",
    ]
}
