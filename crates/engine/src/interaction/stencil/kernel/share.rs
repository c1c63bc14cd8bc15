//! The share pass: the point scalar of laws that have one.

use super::{CHUNK, Offsets, View};
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{self, LIMIT, Series};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::law::Law;
use std::mem::MaybeUninit;

/// Share pass: `P = q Σ k r0² s` into field 0.
pub struct Share<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub out: Shared,
}

impl<const D: usize, W: Law> Kernel for Share<'_, D, W> {
    type Out = ();

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        let mut offsets = Offsets::new();
        for n in v.block(block) {
            offsets.of(v.reach(n));
            for part in 0..TILE / L::N {
                let i = v.slot(n) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let sum = if v.is_intact(n) {
                        self.sum::<L, false>(n, i, part, &offsets)
                    } else {
                        self.sum::<L, true>(n, i, part, &offsets)
                    };
                    (v.pressure_factor::<L>(i) * sum).store(self.out.at(i));
                }
            }
        }
    }
}

impl<const D: usize, W: Law> Share<'_, D, W> {
    /// `Σ k r0² s` of `N` points, in two halves like the force pass.
    #[inline(always)]
    unsafe fn sum<L: Lane, const MASKED: bool>(
        &self,
        tile: usize,
        i: usize,
        part: usize,
        offsets: &Offsets,
    ) -> L {
        let v = &self.view;
        let bonds = v.stencil(tile);
        let series = Series::stretch();
        // SAFETY: as in the force pass
        unsafe {
            let row = v.row(tile);
            let ui = v.displacement::<L>(i);
            let zero = L::splat(0.0);
            let limit = L::splat(LIMIT);
            let mut sum = zero;
            let mut stretched = [MaybeUninit::<L>::uninit(); CHUNK];
            for chunk in offsets.chunks() {
                let (mut low, mut high) = (zero, zero);
                for (c, n) in chunk.iter().enumerate() {
                    let n = n.assume_init() as usize;
                    let (_, mut e) = v.deform(bonds.get_unchecked(n), i, &ui);
                    if MASKED {
                        // a bond that is not there is not stretched
                        e = e.zero_if(L::dead(*row.add(n), part));
                    }
                    low = e.min(low);
                    high = e.max(high);
                    stretched.get_unchecked_mut(c).write(e);
                }
                let far = L::any(L::or(limit.lt(high), low.lt(zero - limit)));
                for (c, n) in chunk.iter().enumerate() {
                    let b = bonds.get_unchecked(n.assume_init() as usize);
                    // the loop above wrote these
                    let e = stretched.get_unchecked(c).assume_init();
                    let s = if far {
                        series::stretch(e)
                    } else {
                        series.at(e)
                    };
                    sum = L::splat(b.share).fma(s, sum);
                }
            }
            sum
        }
    }
}
