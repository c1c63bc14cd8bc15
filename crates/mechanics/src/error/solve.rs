//! Why no equilibrium or mode was found.

use super::size::size;

/// A motion of a connected part that nothing resists.
#[derive(Debug, Clone, PartialEq)]
pub struct Loose {
    /// Points of the part, and one of them.
    pub points: usize,
    pub point: usize,
    /// `translation along x`, `rotation about z`
    pub motion: &'static str,
}

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    #[error("every component of every point is prescribed: nothing is left to solve for")]
    NothingFree,
    #[error("nothing holds the body: {} of the part of {} points around point {} is free", .0.motion, .0.points, .0.point)]
    Loose(Loose),
    #[error(
        "nothing holds {}, and a load acts on it: the bonds that held it are gone; take it out of the load, prescribe its displacement, or let it fly in motion ([run])",
        part(*.points, *.point)
    )]
    Unheld { points: usize, point: usize },
    /// A motion around this point that gives energy back.
    #[error(
        "the operator is not positive definite: some motion around point {point} meets no resistance"
    )]
    Indefinite { point: usize },
    #[error(
        "the equations are singular: some part of the body moves without resistance, as where bonds that are left span no space; hold it, or let it move in time ([run])"
    )]
    Singular,
    #[error(
        "the matrix or its factors do not fit into memory: write solver = \"cg\", take fewer points, or a shorter horizon"
    )]
    TooLarge,
    #[error("{count} modes would take about {}, {} are left: ask for fewer", size(*.bytes), size(*.left))]
    TooManyModes { count: usize, bytes: f64, left: f64 },
    #[error(
        "the stiffness is not symmetric (asymmetry {asymmetry:.1e}): forces are slopes of no energy, as under laws in rate form under stress, with friction, and where action is not reaction; conjugate gradients and modes of vibration need a symmetric one: write solver = \"direct\", and leave modes out or take them of the body at rest"
    )]
    NotSymmetric { asymmetry: f64 },
    #[error(
        "after {iterations} iterations the residual is {residual:.1e} of the forces that act, not {tolerance:.1e}"
    )]
    NotConverged {
        iterations: usize,
        residual: f64,
        tolerance: f64,
    },
    #[error("bonds still break after {rounds} rounds of one increment: the body falls apart")]
    StillBreaking { rounds: usize },
    #[error("contact has no tangent here: leave it out of a body that relaxes by itself")]
    Contact,
    #[error("{what} has no tangent here: the explicit integrator knows it")]
    NoTangent { what: &'static str },
    #[error(
        "a force on points changes with their displacements, and modes are those of bonds alone: leave it out"
    )]
    PointStiffness,
    #[error("under this load no bond comes near to its critical stretch: nothing is left to break")]
    NothingBreaks,
    #[error(
        "no bond opens under this load: nothing measures the path; write control = \"arc_length\""
    )]
    NothingOpens,
    #[error("a force or displacement is not a number")]
    NotFinite,
    #[error("it was asked to end before it was found")]
    Stopped,
    #[error("the first rank says why")]
    Elsewhere,
}

fn part(points: usize, point: usize) -> String {
    match points {
        1 => format!("point {point}"),
        _ => format!("the part of {points} points around point {point}"),
    }
}
