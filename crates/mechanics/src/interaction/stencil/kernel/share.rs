//! The share pass: the point scalar of laws that have one.

use super::chunk::{CHUNK, Chunk};
use super::offsets::Offsets;
use super::{Bond, View};
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::execute::lane::series::{Series, Sink, Stretch};
use crate::execute::simd::Kernel;
use crate::interaction::scale::TileFactors;
use crate::law::Law;

/// Share pass: `P = q Σ k r0² s` into field 0.
pub struct Share<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub out: Shared,
}

impl<const D: usize, W: Law> Kernel for Share<'_, D, W> {
    type Out = ();
    type Home = W;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) {
        let v = &self.view;
        let mut offsets = Offsets::new();
        for n in v.block(block) {
            let i = v.slot(n);
            // SAFETY: as in the force pass
            unsafe {
                let sum = match (v.is_intact(n), v.is_scaled(n)) {
                    (true, false) => self.sum::<L, false, false>(n, i, &mut offsets),
                    (false, false) => self.sum::<L, true, false>(n, i, &mut offsets),
                    (_, true) => self.sum::<L, true, true>(n, i, &mut offsets),
                };
                (v.pressure_factor::<L>(i) * sum).store(self.out.at(i));
            }
        }
    }
}

/// `Σ k r0² s` of whole bonds.
struct Weighted<'a, L, const D: usize, const MASKED: bool, const SCALED: bool> {
    bonds: &'a [Bond<D>],
    scale: TileFactors<'a>,
    sum: L,
}

impl<L: Lane, const D: usize, const MASKED: bool, const SCALED: bool> Sink<L>
    for Weighted<'_, L, D, MASKED, SCALED>
{
    #[inline(always)]
    fn put(&mut self, k: usize, mut s: L) {
        if MASKED {
            s = s.zero_if(s.is_nan());
        }
        // SAFETY: one value per bond
        let b = unsafe { self.bonds.get_unchecked(k) };
        let mut share = L::splat(b.share);
        if SCALED {
            // SAFETY: a bond of the stencil, of a tile with factors
            share = share * unsafe { self.scale.own(b.number as usize) };
        }
        self.sum = share.fma(s, self.sum);
    }
}

impl<const D: usize, W: Law> Share<'_, D, W> {
    /// `Σ k r0² s` of the points of a tile.
    #[inline(always)]
    unsafe fn sum<L: Lane, const MASKED: bool, const SCALED: bool>(
        &self,
        tile: usize,
        i: usize,
        offsets: &mut Offsets<D>,
    ) -> L {
        let v = &self.view;
        let series = Series::<Stretch>::new();
        let mut chunk = Chunk::<L>::new();
        let mut sum = L::splat(0.0);
        let scale = if SCALED {
            v.scale.tile(tile)
        } else {
            TileFactors::NONE
        };
        // SAFETY: as in the force pass
        unsafe {
            let ui = v.displacement::<L>(i);
            let mut word = 0;
            while word < v.reach(tile).len() {
                let (bonds, next) = offsets.stretch(v.stencil(tile), v.reach(tile), word);
                word = next;
                for bonds in bonds.chunks(CHUNK) {
                    let x = chunk.deform::<D, W, MASKED, false>(v, bonds, v.row(tile), i, &ui);
                    let mut weighted = Weighted::<L, D, MASKED, SCALED> { bonds, scale, sum };
                    chunk.each_to(bonds.len(), series, &x, &mut weighted);
                    sum = weighted.sum;
                }
            }
        }
        sum
    }
}
