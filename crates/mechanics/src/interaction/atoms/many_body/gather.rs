//! What the many-body energies of neighbours say of an atom.

use super::back::{Back, FAR, NONE};
use crate::body::Values;
use crate::execute::blocks::Shared;
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::family::neighbours::near::NearList;

/// Adds to forces that hold those of the atoms' own many-body energies.
pub(super) struct Gather<'a> {
    pub list: &'a NearList<3>,
    pub back: &'a Back,
    pub f: [Shared; 3],
    pub volume: &'a Values,
}

impl Kernel for Gather<'_> {
    type Out = ();
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let (before, force) = (self.back.before(), self.back.forces());
        for (t, lines) in self.list.tiles(block) {
            if self.list.slots(t).is_empty() {
                continue;
            }
            let mut sum = [L::splat(0.0); 3];
            let first = self.back.place(t);
            for n in 0..lines.len() {
                let own = first + n * TILE;
                let back = self.back.back(own);
                let mut from = [0u32; TILE];
                let mut any = 0;
                for l in 0..TILE {
                    if before[own + l] == FAR || back[l] == NONE {
                        continue;
                    }
                    let skipped = before[back[l] as usize];
                    if skipped != FAR {
                        from[l] = back[l] - TILE as u32 * u32::from(skipped);
                        any |= from[l];
                    }
                }
                if any == 0 {
                    continue;
                }
                // SAFETY: places of bonds, or the first, where nothing pulls
                let g = unsafe { L::gather4(force.as_ptr().cast(), from.as_ptr()) };
                for a in 0..3 {
                    sum[a] = sum[a] + g[a];
                }
            }
            for a in 0..3 {
                let sum = sum[a].to_array();
                for (sum, &slot) in sum.iter().zip(self.list.slots(t)) {
                    let slot = slot as usize;
                    let scale = 1.0 / self.volume.at(slot);
                    // SAFETY: every slot belongs to one atom
                    unsafe { *self.f[a].at(slot) += scale * sum };
                }
            }
        }
    }
}
