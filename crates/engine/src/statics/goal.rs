//! When an iteration ends.

use super::vectors::Sums;
use crate::error::SolveError;

/// Loads and reactions of this part of the greatest residual are none.
const UNLOADED: f64 = 1e-6;

/// When to stop.
#[derive(Debug, Clone, Copy)]
pub struct Goal {
    /// Residual over the residual of the start.
    pub tolerance: f64,
    pub most_iterations: usize,
    /// Asked in every iteration: has somebody had enough?
    pub stop: fn() -> bool,
}

/// Iterations between questions of ranks whether somebody has had enough.
const ASKED: usize = 16;

/// Forces on free components, and the loads and reactions that they are compared with: sizes of all (force).
#[derive(Debug, Clone, Copy)]
pub struct Imbalance {
    pub size: f64,
    pub scale: f64,
}

/// What is left of the forces on points that seek their equilibrium.
#[derive(Debug, Clone, Copy)]
pub(super) struct Left {
    /// Its size now, and the greatest so far (force).
    pub size: f64,
    pub most: f64,
    /// Over what it is compared with.
    pub residual: f64,
}

impl Left {
    /// Before any force is known.
    pub fn unknown() -> Left {
        Left {
            size: f64::INFINITY,
            most: 0.0,
            residual: f64::INFINITY,
        }
    }
}

impl Goal {
    /// # Errors
    /// Somebody has had enough, on any rank; ranks ask each other now and then.
    pub fn go_on(&self, iteration: usize, sums: &Sums) -> Result<(), SolveError> {
        if sums.are_shared() && !iteration.is_multiple_of(ASKED) {
            return Ok(());
        }
        match sums.any((self.stop)()) {
            true => Err(SolveError::Stopped),
            false => Ok(()),
        }
    }

    /// Is little enough left in forces on the free components? Where nothing bears a load in the end, what is left is compared with what moved the points.
    ///
    /// # Errors
    /// A force is not a number.
    pub(super) fn is_reached(&self, left: &mut Left, found: Imbalance) -> Result<bool, SolveError> {
        let Imbalance { size, scale } = found;
        left.size = size;
        if !left.size.is_finite() {
            return Err(SolveError::NotFinite);
        }
        left.most = left.most.max(left.size);
        let scale = scale.max(UNLOADED * left.most);
        left.residual = match scale > 0.0 {
            true => left.size / scale,
            false => left.size,
        };
        Ok(left.residual <= self.tolerance || left.size == 0.0)
    }

    /// What so many iterations have missed it by.
    pub fn missed(&self, iterations: usize, residual: f64) -> SolveError {
        SolveError::NotConverged {
            iterations,
            residual,
            tolerance: self.tolerance,
        }
    }
}
