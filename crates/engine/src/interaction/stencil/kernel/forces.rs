//! The force pass: what every bond pulls, which bonds break, and the new critical stretch.

use super::{Bond, Deformed, MOST, Offsets, View};
use crate::body::Field;
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{self, LIMIT, Series};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::{Tally, Toughness, history};
use crate::law::Law;
use std::mem::MaybeUninit;

/// Bonds that a hot loop left for later.
type Waiting = [MaybeUninit<u16>; MOST];

/// Force pass; `FULL` with breaking and repulsion.
pub struct Forces<'a, const D: usize, W, const FULL: bool> {
    pub view: View<'a, D, W>,
    pub f: [Shared; D],
    pub critical: &'a [f64],
    pub next: Shared,
    pub toughness: &'a [Toughness],
    /// Between these values of `e` the series is exact, no whole bond is too close and none breaks.
    pub lower: f64,
    pub upper: f64,
    /// Velocity of the step's middle, and the step; none if bonds must not break.
    pub motion: Option<(&'a Field<D>, f64)>,
}

impl<const D: usize, W: Law, const FULL: bool> Kernel for Forces<'_, D, W, FULL> {
    type Out = Tally;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        let mut offsets = Offsets::new();
        let mut rare: Waiting = [const { MaybeUninit::uninit() }; MOST];
        for n in v.block(block) {
            offsets.of(v.reach(n));
            for part in 0..TILE / L::N {
                // SAFETY: tiles lie inside the arrays, offsets inside the guards; each tile is written by one block
                unsafe {
                    if v.is_intact(n) {
                        self.points::<L, false>(n, part, &offsets, &mut rare, &mut tally);
                    } else {
                        self.points::<L, true>(n, part, &offsets, &mut rare, &mut tally);
                    }
                }
            }
        }
        tally
    }
}

/// `N` points of a tile.
struct Points<L, const D: usize> {
    /// Active tile, its part, and the first slot.
    tile: usize,
    part: usize,
    i: usize,
    u: [L; D],
    own: [L; 2],
    critical: L,
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// All bonds of `N` points.
    ///
    /// Where all `e` of a chunk lie between bounds that hold for the whole body, the series is exact and nothing can
    /// happen. Else lanes are looked at one by one: those that break or are too close wait and are added last, and the
    /// others take the root where they need it. None of this depends on a lane's neighbours in the register, so the
    /// order of every point's sum is its own.
    #[inline(always)]
    unsafe fn points<L: Lane, const MASKED: bool>(
        &self,
        tile: usize,
        part: usize,
        offsets: &Offsets,
        rare: &mut Waiting,
        tally: &mut Tally,
    ) {
        let v = &self.view;
        let i = v.slot(tile) + part * L::N;
        let bonds = v.stencil(tile);
        let series = Series::extension_over_length();
        // SAFETY: slots and their neighbours lie inside the arrays; at most MOST bonds, checked when the stencil was
        // made
        unsafe {
            let zero = L::splat(0.0);
            let at = Points {
                tile,
                part,
                i,
                u: v.displacement::<L>(i),
                own: v.fields::<L>(i),
                critical: if FULL {
                    L::load(self.critical.as_ptr().add(i))
                } else {
                    zero
                },
            };
            let (lower, upper) = (L::splat(self.lower), L::splat(self.upper));
            let limit = L::splat(LIMIT);
            let mut lowest = L::splat(f64::INFINITY);
            let mut acc = [zero; D];
            let mut waiting = 0;
            let mut deformed = Deformed::<L, D>::new();
            for chunk in offsets.chunks() {
                let mut close = zero.lt(zero);
                let (mut low, mut high) = (L::splat(f64::INFINITY), zero);
                for (c, n) in chunk.iter().enumerate() {
                    let n = n.assume_init() as usize;
                    let b = bonds.get_unchecked(n);
                    let (y, raw) = v.deform(b, i, &at.u);
                    let mut e = raw;
                    if MASKED {
                        e = raw.nan_if(L::dead(*v.row(tile).add(n), part));
                        if FULL {
                            // a bond that is broken or absent may still be too close
                            close = L::or(close, raw.lt(L::splat(b.contact_e)));
                        }
                    }
                    low = e.min(low);
                    high = e.max(high);
                    deformed.put(c, e, y);
                }
                if FULL {
                    lowest = low.min(lowest);
                }
                let outside = L::or(low.lt(lower), upper.lt(high));
                if !L::any(L::or(close, outside)) {
                    self.answer::<L, MASKED, false>(&at, chunk, &deformed, series, &mut acc);
                    continue;
                }
                if FULL {
                    let close = L::any(close);
                    let mut wait = 0u64;
                    for (c, n) in chunk.iter().enumerate() {
                        let b = bonds.get_unchecked(n.assume_init() as usize);
                        let e = deformed.e(c);
                        let raw = if close { v.deform(b, i, &at.u).1 } else { e };
                        let aside = self.aside(&at, b, e, raw);
                        deformed.leave_out(c, aside);
                        wait |= (L::any(aside) as u64) << c;
                    }
                    while wait != 0 {
                        let c = wait.trailing_zeros() as usize;
                        rare.get_unchecked_mut(waiting)
                            .write(chunk[c].assume_init());
                        waiting += 1;
                        wait &= wait - 1;
                    }
                }
                if L::any(L::or(low.lt(zero - limit), limit.lt(high))) {
                    self.answer::<L, true, true>(&at, chunk, &deformed, series, &mut acc);
                } else {
                    self.answer::<L, true, false>(&at, chunk, &deformed, series, &mut acc);
                }
            }
            if FULL && waiting > 0 {
                self.rare::<L>(&at, &rare[..waiting], &mut acc, tally);
            }
            for a in 0..D {
                // what was summed points from j to i
                (zero - acc[a]).store(self.f[a].at(i));
            }
            if FULL {
                let material = |l: usize| v.body.material_of(i + l);
                let next = history::next_critical(self.toughness, material, lowest);
                next.store(self.next.at(i));
                for x in &next.to_array()[..L::N] {
                    tally.least_critical = tally.least_critical.min(*x);
                }
            }
        }
    }

    /// Add what the bonds of a chunk pull; with `MASKED`, not where `e` is not a number; with `FAR`, by the root where
    /// the series is not exact.
    #[inline(always)]
    unsafe fn answer<L: Lane, const MASKED: bool, const FAR: bool>(
        &self,
        at: &Points<L, D>,
        chunk: &[MaybeUninit<u16>],
        deformed: &Deformed<L, D>,
        series: Series,
        acc: &mut [L; D],
    ) {
        let v = &self.view;
        let bonds = v.stencil(at.tile);
        let mut sum = *acc;
        for (c, n) in chunk.iter().enumerate() {
            // SAFETY: as in the first loop, which put every bond of the chunk
            unsafe {
                let b = bonds.get_unchecked(n.assume_init() as usize);
                let e = deformed.e(c);
                let other = v.fields::<L>(at.i.wrapping_add_signed(b.shift));
                let g = if FAR {
                    series::extension_over_length(e)
                } else {
                    series.at(e)
                };
                let mut pull = v.law.pull(L::splat(b.k), g, at.own, other);
                if MASKED {
                    pull = pull.zero_if(e.is_nan());
                }
                for a in 0..D {
                    sum[a] = pull.fma(deformed.y(c, a), sum[a]);
                }
            }
        }
        *acc = sum;
    }

    /// Lanes whose bond breaks, or whose ends are too close, whole or not; `e` where the bond is whole, `raw` always.
    #[inline(always)]
    unsafe fn aside<L: Lane>(&self, at: &Points<L, D>, b: &Bond<D>, e: L, raw: L) -> L::Mask {
        // SAFETY: offsets stay inside the guards
        let other = unsafe {
            let j = at.i.wrapping_add_signed(b.shift);
            L::load(self.critical.as_ptr().add(j))
        };
        let breaks = other.min(at.critical).lt(e);
        L::or(breaks, raw.lt(L::splat(b.contact_e)))
    }

    /// The lanes that waited: repulsion, breaking.
    #[inline(always)]
    unsafe fn rare<L: Lane>(
        &self,
        at: &Points<L, D>,
        rare: &[MaybeUninit<u16>],
        acc: &mut [L; D],
        tally: &mut Tally,
    ) {
        let v = &self.view;
        let (i, part, own) = (at.i, at.part, at.own);
        let bonds = v.stencil(at.tile);
        let partners = &v.partners[v.sublattice(at.tile)];
        let zero = L::splat(0.0);
        // broken bonds: Σ x and Σ k r0² s
        let mut lost: Option<[L; 2]> = None;
        // SAFETY: as in the hot loop
        unsafe {
            for n in rare {
                // the hot loop wrote them
                let n = n.assume_init() as usize;
                let (b, bits) = (&bonds[n], v.row(at.tile).add(n));
                let j = i.wrapping_add_signed(b.shift);
                let (y, raw) = v.deform(b, i, &at.u);
                let dead = L::dead(*bits, part);
                let e = raw.nan_if(dead);
                let aside = self.aside(at, b, e, raw);
                let other = v.fields::<L>(j);
                let g = series::extension_over_length(e);
                let own_pull = v.law.pull(L::splat(b.k), g, own, other).zero_if(dead);
                let mut pull = L::select(aside, own_pull, zero);
                let close = raw.lt(L::splat(b.contact_e));
                if L::any(close) {
                    pull = pull + v.repel(&partners[n], i, raw, close).0;
                }
                if self.motion.is_some() {
                    let limit = L::load(self.critical.as_ptr().add(j)).min(at.critical);
                    let breaks = limit.lt(e);
                    let which = L::bits(breaks);
                    if which != 0 {
                        *bits &= !((which as u8) << (part * L::N));
                        *v.intact.at(at.tile) = 0;
                        tally.broken += which.count_ones() as u64;
                        let s = series::stretch(e);
                        let share = L::splat(b.share) * s;
                        let held = v.law.pair_energy(share * s, own, other)
                            + self.farewell(own_pull, y, i, j);
                        let sum = lost.unwrap_or([zero; 2]);
                        lost = Some([
                            sum[0] + L::select(breaks, held, zero),
                            sum[1] + L::select(breaks, share, zero),
                        ]);
                    }
                }
                for a in 0..D {
                    acc[a] = pull.fma(y[a], acc[a]);
                }
            }
            if let Some(lost) = lost {
                let energy = history::released::<L, W>(v.pressure_factor(i), own, lost);
                // one by one: the order of the sum must not depend on the width
                for x in &energy.to_array()[..L::N] {
                    tally.released += x * v.volume;
                }
            }
        }
    }

    /// Energy density that a breaking bond takes from the motion while it pulls once more, over half a step:
    /// half of `½Δt F·(v_j − v_i)`, the other half goes to the partner. `y` points from j to i.
    #[inline(always)]
    unsafe fn farewell<L: Lane>(&self, pull: L, y: [L; D], i: usize, j: usize) -> L {
        let Some((v, dt)) = self.motion else {
            return L::splat(0.0);
        };
        let mut rate = L::splat(0.0);
        for a in 0..D {
            // SAFETY: slots lie inside the arrays
            let relative = unsafe { L::load(v[a].as_ptr().add(i)) - L::load(v[a].as_ptr().add(j)) };
            rate = y[a].fma(relative, rate);
        }
        L::splat(0.25 * dt) * pull * rate
    }
}
