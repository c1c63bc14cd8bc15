//! What came into a body, and what it holds.

use crate::state::words;

/// Amounts since the start (energy, or amount of a species). What the bonds carry cancels, so
/// `content − initial = supplied + exchanged + held` up to round-off of explicit steps, and to the tolerance of implicit ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TransferAccount {
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

words!([] TransferAccount {
    content: f64,
    initial: f64,
    supplied: f64,
    exchanged: f64,
    held: f64,
    made: f64,
    through_contact: Option<f64>,
});

impl TransferAccount {
    /// What the balance misses.
    pub fn residual(&self) -> f64 {
        self.content - self.initial - self.supplied - self.exchanged - self.held - self.made
    }
}
