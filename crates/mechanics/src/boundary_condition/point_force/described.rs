//! What a force on the points of a set is, and what it says of itself.

use crate::law::descriptor::{Descriptor, Wrong};
use crate::space::Point;
use crate::spec::Parameters;
use std::fmt::Debug;

/// What a force sees of a point. Components of axes beyond the dimension are 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Reference position (length).
    pub reference: Point,
    /// (length)
    pub displacement: Point,
    /// As it is when forces are evaluated: of explicit steps that of their middle (length / time).
    pub velocity: Point,
    pub time: f64,
    /// Since the step began whose end this is (time); 0 where none led here.
    pub step: f64,
    /// Mass density (mass / length³).
    pub density: f64,
}

/// How a force changes with the displacement of its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stiffness {
    /// It does not.
    None,
    /// As it says with each force.
    Known,
    /// In a way that it does not tell: no increment of statics and no implicit step can take it.
    Unknown,
}

/// What a force does to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalForce {
    /// Force density (force / volume).
    pub force: Point,
    /// `−∂f/∂u` (force / volume / length), by rows of f; read where it is [known](Stiffness::Known), its
    /// symmetric part.
    pub stiffness: [Point; 3],
}

/// A force on the points of a set. The engine keeps what it remembers, its work and its place among the others: `f − c v`, with the
/// velocity v at the end of the step.
///
/// Unstable: what a force sees and answers may change with any version.
pub trait PointForce: Debug + Send + Sync + 'static {
    /// How many numbers it remembers of each point; they begin at 0.
    fn memory(&self) -> usize;
    /// Force at point `k` of the set, a function of what it sees and of what it remembered where the step began: the same at every call. It
    /// leaves in `memory` what it will remember if the step ends here.
    fn force(&self, k: usize, at: &Seen, memory: &mut [f64]) -> LocalForce;
    /// All its points that are left, in their order, before it is asked for the force at each: where one question for all costs less than one for each, it is
    /// asked here.
    fn look(&self, all: &[Seen]) {
        let _ = all;
    }
    /// Does it [look](PointForce::look)?
    fn looks(&self) -> bool {
        false
    }
    fn stiffness(&self) -> Stiffness;
    /// Viscosity c at point `k`, 0 or more (mass / volume / time).
    fn viscosity(&self, k: usize) -> f64;
}

/// The set that a force is made for.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    pub dimension: usize,
    /// Reference positions (length).
    pub points: &'a [Point],
    /// Mass density of each (mass / length³).
    pub density: &'a [f64],
    /// Distance between points that are next to each other (length).
    pub spacing: f64,
}

/// A force that a spec, a deck and a list can name.
pub trait Described: PointForce + Sized {
    const NAME: &'static str;
    fn descriptor() -> Descriptor;
    /// # Errors
    /// The key that does not fit, empty if it is not one alone, and why.
    fn new(parameters: &Parameters, on: &Placed) -> Result<Self, Wrong>;
}

/// Who is told of all forces.
pub trait Kinds {
    fn force<F: Described>(&mut self);
}
