//! When an iteration ends.

use super::vectors::norm;
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
    /// Somebody has had enough.
    pub fn go_on(&self) -> Result<(), SolveError> {
        if (self.stop)() {
            Err(SolveError::Stopped)
        } else {
            Ok(())
        }
    }

    /// Is little enough left in forces `f` on the free components beside loads and reactions of this size (force)? Where nothing bears a load in the
    /// end, what is left is compared with what moved the points.
    ///
    /// # Errors
    /// A force is not a number.
    pub(super) fn is_reached<const D: usize>(
        &self,
        left: &mut Left,
        f: &[[f64; D]],
        scale: f64,
    ) -> Result<bool, SolveError> {
        left.size = norm(f);
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
