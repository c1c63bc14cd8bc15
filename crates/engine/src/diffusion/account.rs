//! What came into a body, and what it holds.

use crate::execute::exact::Exact;
use crate::state::{Archive, Owner};

/// Amounts since the start (energy, or amount of a species). What the bonds carry cancels, so
/// `content − initial = supplied + exchanged + held` up to round-off of explicit steps, and to the tolerance of implicit ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DiffusionAccount {
    /// `Σ C_i T_i` now.
    pub content: f64,
    /// At the start.
    pub initial: f64,
    /// By fluxes and sources.
    pub supplied: f64,
    /// Through surfaces, by convection and radiation.
    pub exchanged: f64,
    /// At points whose value is held.
    pub held: f64,
    /// By deformation and flow.
    pub made: f64,
    /// From the warmer to the colder point of every pair that touches: no part of the balance, since it stays in the bodies. `None`: contact
    /// conducts nothing.
    pub through_contact: Option<f64>,
}

impl DiffusionAccount {
    /// What the balance misses.
    pub fn residual(&self) -> f64 {
        self.content - self.initial - self.supplied - self.exchanged - self.held - self.made
    }
}

/// The same of the points of one rank, as sums without rounding.
#[derive(Debug, Clone, Default)]
pub(super) struct Gained {
    pub initial: Exact,
    pub supplied: Exact,
    pub exchanged: Exact,
    pub held: Exact,
    pub made: Exact,
    pub through_contact: Exact,
}

impl Owner for Gained {
    fn archive(&mut self, archive: &mut Archive<'_>) {
        for (name, x) in [
            ("initial", &mut self.initial),
            ("supplied", &mut self.supplied),
            ("exchanged", &mut self.exchanged),
            ("held", &mut self.held),
            ("made", &mut self.made),
            ("through_contact", &mut self.through_contact),
        ] {
            archive.part(name, x);
        }
    }
}
