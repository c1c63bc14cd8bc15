//! A force that a program brings along: any function of a point's place, motion and the time.

use crate::space::Point;
use std::fmt;
use std::sync::Arc;

/// What such a force sees of a point. Components of axes beyond the dimension are 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Reference position (length).
    pub reference: Point,
    /// (length)
    pub displacement: Point,
    /// As it is when forces are evaluated, in the middle of a step (length / time).
    pub velocity: Point,
    pub time: f64,
    /// Mass density (mass / length³).
    pub density: f64,
}

/// Force density (force / volume) of a point. It must be a function of what it sees alone: the same at every call.
#[derive(Clone)]
pub struct OwnForce(Arc<dyn Fn(&Seen) -> Point + Send + Sync>);

impl OwnForce {
    pub fn new(force: impl Fn(&Seen) -> Point + Send + Sync + 'static) -> OwnForce {
        OwnForce(Arc::new(force))
    }

    pub fn at(&self, point: &Seen) -> Point {
        (self.0)(point)
    }
}

impl fmt::Debug for OwnForce {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("OwnForce")
    }
}
