//! A level of a coarsened body, and what acts on it.

use super::way::Way;
use peridyne::spec::LinearBody;
use peridyne_io::deck::upscaled::Rewritten;
use peridyne_theory::coarsen::Report;
use peridyne_theory::coarsen::waves::Frequencies;

/// What the conditions of a deck do, point by point.
pub(super) struct Acting {
    /// `[N]`
    pub(super) loaded: Vec<bool>,
    pub(super) held: Vec<bool>,
    pub(super) spacing: f64,
    pub(super) way: Way,
}

/// A level that was made.
pub(super) struct Level<const D: usize> {
    pub(super) name: String,
    pub(super) body: LinearBody<D>,
    pub(super) report: Report,
    pub(super) frequencies: Frequencies,
    /// Longest stable steps of level 0 and of this one (time).
    pub(super) steps: [Option<f64>; 2],
    pub(super) text: Rewritten,
    pub(super) seconds: f64,
    /// Points that are retained only because they are held.
    pub(super) supports: usize,
}
