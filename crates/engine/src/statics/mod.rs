//! Equilibrium and vibration: linear bodies, solvers, modes.
//!
//! | question | module |
//! |---|---|
//! | which linear body is a law about a state? | [`assemble`], [`mod@linear_body`] |
//! | what does it do to a displacement, with or without a matrix? | [`operator`] |
//! | is it held? | [`support`] |
//! | where do loads of a finer body act? | [`carriers`] |
//! | where is it in equilibrium? | [`direct`] (banded in 1-D), [`cg`]; of any law [`relaxation`] |
//! | how does it vibrate? | [`modes`] |

pub mod assemble;
pub mod carriers;
pub mod cg;
pub mod direct;
pub mod linear_body;
pub mod modes;
pub mod operator;
pub mod relaxation;
pub mod support;
mod vectors;

use crate::execute::memory::size;
pub use assemble::linear_body;
pub use carriers::Carriers;
pub use direct::{Direct, SYMMETRIC};
pub use linear_body::{AnyLinearBody, LinearBody, Soundness};
pub use operator::{Assembled, LinearOperator, Swept};
pub use support::{Loose, Support};
pub use vectors::norm;

/// What a solver did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Solved {
    pub iterations: usize,
    /// Residual force over that of the start.
    pub residual: f64,
}

/// Why there is no solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SolveError {
    #[error("every component of every point is prescribed: nothing is left to solve for")]
    NothingFree,
    #[error("nothing holds the body: {} of the part of {} points around point {} is free", .0.motion, .0.points, .0.point)]
    Loose(Loose),
    /// A motion around this point that gives energy back.
    #[error(
        "the operator is not positive definite: some motion around point {point} meets no resistance"
    )]
    Indefinite { point: usize },
    #[error("the equations are singular")]
    Singular,
    #[error(
        "the matrix or its factors do not fit into memory: write solver = \"cg\", take fewer points, or a shorter horizon"
    )]
    TooLarge,
    #[error("{count} modes would take about {}, {} are left: ask for fewer", size(*.bytes), size(*.left))]
    TooManyModes { count: usize, bytes: f64, left: f64 },
    #[error(
        "action is not reaction in this body (asymmetry {asymmetry:.1e}): conjugate gradients and modes of vibration need a symmetric one; write solver = \"direct\", and leave modes out"
    )]
    NotSymmetric { asymmetry: f64 },
    #[error(
        "after {iterations} iterations the residual is {residual:.1e} of that of the start, not {tolerance:.1e}"
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
    #[error("a force or displacement is not a number")]
    NotFinite,
    #[error("it was asked to end before it was found")]
    Stopped,
}

impl SolveError {
    /// Where a motion that gives energy back is largest.
    fn indefinite<const D: usize>(p: &[[f64; D]]) -> SolveError {
        let square = |p: &[f64; D]| p.iter().map(|c| c * c).sum::<f64>();
        let largest = (0..p.len()).max_by(|i, j| square(&p[*i]).total_cmp(&square(&p[*j])));
        SolveError::Indefinite {
            point: largest.unwrap_or(0),
        }
    }
}
