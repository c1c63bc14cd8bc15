//! A force that is a function of a point's place, motion and the time.

use super::{LocalForce, PointForce, Seen, Stiffness};
use crate::space::Point;
use std::fmt;

/// Force density (force / volume) of a point, a function of what it sees alone.
pub struct OfFunction<F>(pub F);

impl<F> fmt::Debug for OfFunction<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OfFunction")
    }
}

impl<F: Fn(&Seen) -> Point + Send + Sync + 'static> PointForce for OfFunction<F> {
    fn memory(&self) -> usize {
        0
    }
    fn force(&self, _: usize, at: &Seen, _: &mut [f64]) -> LocalForce {
        LocalForce {
            force: (self.0)(at),
            stiffness: [[0.0; 3]; 3],
        }
    }
    fn stiffness(&self) -> Stiffness {
        Stiffness::Unknown
    }
    fn viscosity(&self, _: usize) -> f64 {
        0.0
    }
}
