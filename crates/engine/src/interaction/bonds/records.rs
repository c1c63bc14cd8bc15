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

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let slots = BLOCK * TILE;
        for s in block * slots..((block + 1) * slots).min(self.slots) {
            // SAFETY: there is a record per slot
            unsafe {
                for a in 0..D {
                    *self.records.at(4 * s + a) = self.u[a][s];
                }
                if let Some(x) = self.fourth.get(s) {
                    *self.records.at(4 * s + 3) = *x;
                }
            }
        }
    }
}
