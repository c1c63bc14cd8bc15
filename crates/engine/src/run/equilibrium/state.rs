//! What statics keeps between increments.

use crate::body::Field;
use crate::spec::{LinearBody, Statics};
use crate::statics::{Direct, Solved};

pub(in crate::run) struct StaticState<const D: usize> {
    pub options: Statics,
    /// The linear body about the reference and its factors, as long as no bond broke.
    pub(super) factors: Option<(LinearBody<D>, Direct<D>)>,
    /// Where bonds break in turn: which are next.
    pub(super) sequence: Option<Sequence<D>>,
    /// Of the operator about the reference, once looked at.
    pub(super) asymmetry: Option<f64>,
    /// Of the last increment.
    pub solved: Solved,
}

impl<const D: usize> StaticState<D> {
    pub fn new(options: Statics) -> Self {
        StaticState {
            options,
            factors: None,
            sequence: None,
            asymmetry: None,
            solved: Solved::default(),
        }
    }

    /// Factors belong to other equations.
    pub fn forget(&mut self) {
        self.factors = None;
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
