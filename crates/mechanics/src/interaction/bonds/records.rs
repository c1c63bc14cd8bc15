//! Displacements side by side, for families that gather them.

use super::view::BLOCK;
use crate::body::FieldView;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;

/// Fills the records of a step.
pub struct Pack<'a, const D: usize> {
    pub u: FieldView<'a, D>,
    /// How many records there are.
    pub slots: usize,
    /// Fourth numbers, per slot; empty: they stay what they are.
    pub fourth: &'a [f64],
    /// `[slots][4]`
    pub records: Shared,
}

impl<const D: usize> Kernel for Pack<'_, D> {
    type Out = ();
    type Home = Self;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let first = block * BLOCK * TILE;
        let slots = first..(first + BLOCK * TILE).min(self.slots);
        for s in slots.clone() {
            for a in 0..D {
                // SAFETY: there is a record per slot
                unsafe { *self.records.at(4 * s + a) = self.u[a][s] };
            }
        }
        // a loop of its own: asked slot by slot, it is masked loads from nowhere, of a hundred cycles each
        if !self.fourth.is_empty() {
            for s in slots {
                // SAFETY: as above
                unsafe { *self.records.at(4 * s + 3) = self.fourth[s] };
            }
        }
    }
}
