//! What statics keeps between increments.

use super::system::Equations;
use crate::body::Field;
use crate::spec::{LinearBody, Statics};
use crate::statics::{Direct, Solved};

pub(in crate::run) struct StaticState<const D: usize> {
    pub options: Statics,
    /// The linear body about the reference and its factors, as long as no bond broke.
    pub(super) factors: Option<(LinearBody<D>, Direct<D>)>,
    /// Factored equations of a step in time, which may serve the next.
    pub(super) step: Option<Equations<D>>,
    /// Where bonds break in turn: which are next.
    pub(super) sequence: Option<Sequence<D>>,
    /// Where a path is followed: the last increment.
    pub(super) followed: Option<Followed<D>>,
    /// Of the operator about the reference, once looked at.
    pub(super) asymmetry: Option<f64>,
    /// The largest masses of points that relaxation had, of laws that remember; else empty.
    pub(super) masses: Vec<f64>,
    /// Of the last increment.
    pub solved: Solved,
}

impl<const D: usize> StaticState<D> {
    pub fn new(options: Statics) -> Self {
        StaticState {
            options,
            factors: None,
            step: None,
            sequence: None,
            followed: None,
            asymmetry: None,
            masses: vec![],
            solved: Solved::default(),
        }
    }

    /// Factors belong to other equations.
    pub fn forget(&mut self) {
        self.factors = None;
        self.step = None;
        self.asymmetry = None;
    }
}

/// A bond at its critical stretch.
#[derive(Debug, Clone, Copy)]
pub(in crate::run) struct Critical<const D: usize> {
    pub i: usize,
    pub j: usize,
    pub xi: [f64; D],
    pub stretch: f64,
}

/// What the last equilibrium left to be done.
pub(in crate::run) struct Sequence<const D: usize> {
    /// Bonds that break next.
    pub next: Vec<Critical<D>>,
    /// Forces of bonds at that equilibrium (force density).
    pub f: Field<D>,
    /// Its factor.
    pub factor: f64,
}

/// The last increment along a path.
pub(in crate::run) struct Followed<const D: usize> {
    /// `[N]` displacements that it added.
    pub way: Vec<[f64; D]>,
    /// What it added to the factor of the load.
    pub factor: f64,
    /// Its length over what is asked for.
    pub part: f64,
    /// The largest loads and reactions up to here (force).
    pub most: f64,
}
