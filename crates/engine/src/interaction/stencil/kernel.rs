//! The sweeps over a lattice stencil: points of a tile in lanes, offsets in a fixed order.
//!
//! No closure touches a lane here: a closure is compiled without the instruction set of its caller unless it happens
//! to be inlined, and then every operation becomes a call.

use crate::body::{Body, Field, Grid};
use crate::execute::blocks::Shared;
use crate::execute::lane::series::{self, Series};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::Kernel;
use crate::interaction::bond::deform;
use crate::interaction::{Repulsion, Tally, Toughness, history};
use crate::law::Law;
use std::mem::MaybeUninit;

/// Tiles per block of work.
pub const BLOCK: usize = 32;
/// Longest stencil that a sweep can keep account of.
pub const MOST: usize = 32768;

/// Bonds that a hot loop left for later.
type Waiting = [MaybeUninit<u16>; MOST];

/// A bond of the stencil with its constants.
#[derive(Debug, Clone, Copy)]
#[repr(C)] // what the hot loop reads comes first
pub struct Bond<const D: usize> {
    /// Slots from i to j.
    pub shift: isize,
    /// `−ξ`: from j back to i.
    pub back: [f64; D],
    pub inv_r0_squared: f64,
    pub k: f64,
    /// Repulsion acts where `e` is below this; −1 without repulsion.
    pub contact_e: f64,
    pub r0_squared: f64,
    pub contact_distance: f64,
    pub cell: [i32; D],
    pub to: usize,
}

/// What all kernels read.
pub struct View<'a, const D: usize, W> {
    pub law: W,
    pub grid: &'a Grid<D>,
    pub body: &'a Body<D>,
    pub bonds: &'a [Vec<Bond<D>>],
    pub width: usize,
    pub tiles: &'a [u32],
    pub alive: &'a [u8],
    /// `[tiles][words]`: a bit per offset that any point of the tile ever had a partner at.
    pub reach: &'a [u64],
    pub u: [&'a [f64]; D],
    pub fields: [&'a [f64]; 2],
    /// Pressure factors per slot where materials differ; else empty: the law's own.
    pub pressure: &'a [f64],
    pub volume: f64,
    pub repulsion: Option<Repulsion>,
}

impl<const D: usize, W: Law> View<'_, D, W> {
    #[inline(always)]
    unsafe fn displacement<L: Lane>(&self, slot: usize) -> [L; D] {
        let mut u = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: slots and their neighbours lie between the guards
            u[a] = unsafe { L::load(self.u[a].as_ptr().add(slot)) };
        }
        u
    }

    #[inline(always)]
    unsafe fn fields<L: Lane>(&self, slot: usize) -> [L; 2] {
        let mut fields = [L::splat(0.0); 2];
        for a in 0..W::FIELDS {
            // SAFETY: as above
            fields[a] = unsafe { L::load(self.fields[a].as_ptr().add(slot)) };
        }
        fields
    }

    /// `−(ξ+η)` and `e` of bond `b` for the points at `i`.
    #[inline(always)]
    unsafe fn deform<L: Lane>(&self, b: &Bond<D>, i: usize, ui: &[L; D]) -> ([L; D], L) {
        // SAFETY: offsets stay inside the guards
        let uj = unsafe { self.displacement::<L>(i.wrapping_add_signed(b.shift)) };
        let (mut eta, mut back) = (uj, uj);
        for a in 0..D {
            eta[a] = ui[a] - uj[a];
            back[a] = L::splat(b.back[a]);
        }
        deform(eta, back, L::splat(b.inv_r0_squared))
    }

    fn block(&self, block: usize) -> std::ops::Range<usize> {
        block * BLOCK..((block + 1) * BLOCK).min(self.tiles.len())
    }

    /// Bits of the offsets that lead anywhere from the `n`-th active tile.
    #[inline(always)]
    fn reach(&self, n: usize) -> &[u64] {
        let words = self.width.div_ceil(64);
        &self.reach[n * words..(n + 1) * words]
    }

    /// Stencil of a tile.
    #[inline(always)]
    fn stencil(&self, tile: usize) -> &[Bond<D>] {
        &self.bonds[self.grid.tile_sublattice(tile)]
    }

    /// `P / Σ k r0² s` of the points at slot `i`.
    #[inline(always)]
    unsafe fn pressure_factor<L: Lane>(&self, i: usize) -> L {
        // SAFETY: slots lie inside the arrays
        unsafe {
            if self.pressure.is_empty() {
                self.law
                    .pressure_factor(L::load(self.fields[1].as_ptr().add(i)))
            } else {
                L::load(self.pressure.as_ptr().add(i))
            }
        }
    }

    /// Coefficient of `ξ+η` from repulsion in the lanes that are closer than allowed and really there, and their
    /// energy density.
    #[inline(always)]
    fn repel<L: Lane>(&self, b: &Bond<D>, i: usize, e: L, close: L::Mask) -> (L, L) {
        let Some(c) = self.repulsion else {
            return (L::splat(0.0), L::splat(0.0));
        };
        let mut there = 0u8;
        for l in 0..L::N {
            if L::bits(close) >> l & 1 == 1
                && self.grid.is_owned(i + l)
                && self.grid.neighbour(i + l, b.cell, b.to).is_some()
            {
                there |= 1 << l;
            }
        }
        let absent = L::dead(there, 0);
        let r = (L::splat(b.r0_squared) * (L::splat(1.0) + e)).sqrt();
        let d = L::splat(b.contact_distance);
        let pull = (L::splat(c.stiffness * self.volume) * (r - d)).div(r);
        let energy = L::splat(0.25 * c.stiffness * self.volume) * (r - d) * (r - d);
        (pull.zero_if(absent), energy.zero_if(absent))
    }
}

/// Walks the offsets of a tile in order: all of them, or (`SOME`) those whose bit is set.
struct Walk<'a, const SOME: bool> {
    words: &'a [u64],
    bits: u64,
    /// Next offset, or first offset of the current word.
    at: usize,
    len: usize,
}

impl<'a, const SOME: bool> Walk<'a, SOME> {
    #[inline(always)]
    fn new(words: &'a [u64], len: usize) -> Self {
        Walk {
            words,
            bits: words[0],
            at: 0,
            len,
        }
    }
}

impl<const SOME: bool> Iterator for Walk<'_, SOME> {
    type Item = usize;

    #[inline(always)]
    fn next(&mut self) -> Option<usize> {
        if !SOME {
            let n = self.at;
            self.at += 1;
            return (n < self.len).then_some(n);
        }
        while self.bits == 0 {
            self.at += 64;
            self.bits = *self.words.get(self.at / 64)?;
        }
        let n = self.at + self.bits.trailing_zeros() as usize;
        self.bits &= self.bits - 1;
        Some(n)
    }
}

/// Force pass; `FULL` with breaking and repulsion.
pub struct Forces<'a, const D: usize, W, const FULL: bool> {
    pub view: View<'a, D, W>,
    pub f: [Shared; D],
    pub critical: &'a [f64],
    pub next: Shared,
    pub memory: Shared<u8>,
    pub toughness: &'a [Toughness],
    /// Velocity of the step's middle, and the step; none if bonds must not break.
    pub motion: Option<(&'a Field<D>, f64)>,
}

impl<const D: usize, W: Law, const FULL: bool> Kernel for Forces<'_, D, W, FULL> {
    type Out = Tally;

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Tally {
        let v = &self.view;
        let mut tally = Tally::default();
        let mut rare: Waiting = [const { MaybeUninit::uninit() }; MOST];
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.stencil(tile);
            // SAFETY: tiles lie inside the arrays, offsets inside the guards; each tile is written by one block
            unsafe {
                let row = std::slice::from_raw_parts_mut(self.memory.at(n * v.width), bonds.len());
                let whole = row.iter().all(|b| *b == 0xff);
                for part in 0..TILE / L::N {
                    let i = v.grid.tile_slot(tile) + part * L::N;
                    if whole {
                        self.points::<L, false>(n, row, i, part, &mut rare, &mut tally);
                    } else {
                        self.points::<L, true>(n, row, i, part, &mut rare, &mut tally);
                    }
                }
            }
        }
        tally
    }
}

impl<const D: usize, W: Law, const FULL: bool> Forces<'_, D, W, FULL> {
    /// All bonds of the `N` points at slot `i`.
    ///
    /// The hot loop takes the lanes where the series is exact and nothing happens; it notes the bonds with any other
    /// lane, and those lanes are added afterwards. Which lanes wait does not depend on their neighbours in the
    /// register, so the order of every point's sum is its own.
    #[inline(always)]
    unsafe fn points<L: Lane, const MASKED: bool>(
        &self,
        tile: usize,
        row: &mut [u8],
        i: usize,
        part: usize,
        rare: &mut Waiting,
        tally: &mut Tally,
    ) {
        let v = &self.view;
        let bonds = v.stencil(v.tiles[tile] as usize);
        let series = Series::extension_over_length();
        // SAFETY: slots and their neighbours lie inside the arrays
        unsafe {
            let zero = L::splat(0.0);
            let ui = v.displacement::<L>(i);
            let own = v.fields::<L>(i);
            let critical_i = if FULL {
                L::load(self.critical.as_ptr().add(i))
            } else {
                zero
            };
            let mut lowest = L::splat(f64::INFINITY);
            let mut acc = [zero; D];
            let mut waiting = 0;
            for n in Walk::<MASKED>::new(v.reach(tile), bonds.len()) {
                let (b, bits) = (bonds.get_unchecked(n), row.get_unchecked(n));
                let j = i.wrapping_add_signed(b.shift);
                let (y, raw) = v.deform(b, i, &ui);
                let dead = L::dead(*bits, part);
                let e = if MASKED { raw.nan_if(dead) } else { raw };
                let mut aside = series.beyond(e);
                if FULL {
                    let limit = L::load(self.critical.as_ptr().add(j)).min(critical_i);
                    aside = L::or(aside, limit.lt(e));
                    lowest = e.min(lowest);
                    if MASKED {
                        // a bond that is broken or absent may still be too close
                        aside = L::or(aside, raw.lt(L::splat(b.contact_e)));
                    }
                }
                // SAFETY (index): at most MOST bonds, checked when the stencil was made
                rare.get_unchecked_mut(waiting).write(n as u16);
                waiting += L::any(aside) as usize;
                let pull = v
                    .law
                    .pull(L::splat(b.k), series.at(e), own, v.fields::<L>(j));
                let pull = pull.zero_if(if MASKED { L::or(dead, aside) } else { aside });
                for a in 0..D {
                    acc[a] = pull.fma(y[a], acc[a]);
                }
            }
            if waiting > 0 {
                let work = Rare {
                    bonds,
                    i,
                    part,
                    ui,
                    own,
                    critical_i,
                };
                self.rare::<L>(&work, row, &rare[..waiting], &mut acc, tally);
            }
            for a in 0..D {
                // what was summed points from j to i
                (zero - acc[a]).store(self.f[a].at(i));
            }
            if FULL {
                let material = |l: usize| v.body.material_of(i + l);
                let next = history::next_critical(self.toughness, material, lowest);
                next.store(self.next.at(i));
            }
        }
    }

    /// The lanes that the hot loop left out: large stretch, repulsion, breaking.
    #[inline(always)]
    unsafe fn rare<L: Lane>(
        &self,
        at: &Rare<L, D>,
        row: &mut [u8],
        rare: &[MaybeUninit<u16>],
        acc: &mut [L; D],
        tally: &mut Tally,
    ) {
        let v = &self.view;
        let &Rare {
            bonds,
            i,
            part,
            ui,
            own,
            critical_i,
        } = at;
        let zero = L::splat(0.0);
        let series = Series::extension_over_length();
        // broken bonds: Σ x and Σ k r0² s
        let mut lost: Option<[L; 2]> = None;
        // SAFETY: as in the hot loop
        unsafe {
            for n in rare {
                // the hot loop wrote these
                let n = n.assume_init() as usize;
                let (b, bits) = (&bonds[n], &mut row[n]);
                let j = i.wrapping_add_signed(b.shift);
                let (y, raw) = v.deform(b, i, &ui);
                let dead = L::dead(*bits, part);
                let e = raw.nan_if(dead);
                let other = v.fields::<L>(j);
                let k = L::splat(b.k);
                let mut aside = series.beyond(e);
                let mut limit = zero;
                let mut close = raw.lt(L::splat(-1.0));
                if FULL {
                    limit = L::load(self.critical.as_ptr().add(j)).min(critical_i);
                    close = raw.lt(L::splat(b.contact_e));
                    aside = L::or(aside, limit.lt(e));
                    aside = L::or(aside, close);
                }
                let g = series::extension_over_length(e);
                let own_pull = v.law.pull(k, g, own, other).zero_if(dead);
                let mut pull = L::select(aside, own_pull, zero);
                if FULL && L::any(close) {
                    pull = pull + v.repel(b, i, raw, close).0;
                }
                if FULL && self.motion.is_some() {
                    let breaks = limit.lt(e);
                    let which = L::bits(breaks);
                    if which != 0 {
                        *bits &= !((which as u8) << (part * L::N));
                        tally.broken += which.count_ones() as u64;
                        let s = series::stretch(e);
                        let share = k * L::splat(b.r0_squared) * s;
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

/// Where a hot loop stopped.
struct Rare<'a, L, const D: usize> {
    bonds: &'a [Bond<D>],
    i: usize,
    part: usize,
    ui: [L; D],
    own: [L; 2],
    critical_i: L,
}

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
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.stencil(tile);
            let row = &v.alive[n * v.width..n * v.width + bonds.len()];
            let whole = row.iter().all(|b| *b == 0xff);
            for part in 0..TILE / L::N {
                let i = v.grid.tile_slot(tile) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let sum = if whole {
                        self.sum::<L, false>(n, row, i, part)
                    } else {
                        self.sum::<L, true>(n, row, i, part)
                    };
                    (v.pressure_factor::<L>(i) * sum).store(self.out.at(i));
                }
            }
        }
    }
}

impl<const D: usize, W: Law> Share<'_, D, W> {
    #[inline(always)]
    unsafe fn sum<L: Lane, const MASKED: bool>(
        &self,
        tile: usize,
        row: &[u8],
        i: usize,
        part: usize,
    ) -> L {
        let v = &self.view;
        let bonds = v.stencil(v.tiles[tile] as usize);
        let series = Series::stretch();
        // SAFETY: as in the force pass
        unsafe {
            let ui = v.displacement::<L>(i);
            let mut sum = L::splat(0.0);
            for n in Walk::<MASKED>::new(v.reach(tile), bonds.len()) {
                let (b, bits) = (bonds.get_unchecked(n), row.get_unchecked(n));
                let (_, raw) = v.deform(b, i, &ui);
                let dead = L::dead(*bits, part);
                let e = if MASKED { raw.nan_if(dead) } else { raw };
                let mut s = series.at(e);
                let far = series.beyond(e);
                if L::any(far) {
                    s = series::stretch(e);
                }
                if MASKED {
                    s = s.zero_if(dead);
                }
                sum = L::splat(b.k * b.r0_squared).fma(s, sum);
            }
            sum
        }
    }
}

/// Energy pass: strain and repulsion energy density, `Σ k r0² s` and `Σ k r0²` over whole bonds. Sums are returned,
/// fields are written where wanted.
pub struct Energies<'a, const D: usize, W> {
    pub view: View<'a, D, W>,
    pub fields: Option<EnergyFields>,
}

#[derive(Clone, Copy)]
pub struct EnergyFields {
    pub strain: Shared,
    pub repulsion: Shared,
    pub share: Shared,
    pub weight: Shared,
}

impl<const D: usize, W: Law> Kernel for Energies<'_, D, W> {
    /// Strain and repulsion energy of the block (energy).
    type Out = [f64; 2];

    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> [f64; 2] {
        let v = &self.view;
        let mut sums = [0.0; 2];
        for n in v.block(block) {
            let tile = v.tiles[n] as usize;
            let bonds = v.stencil(tile);
            for part in 0..TILE / L::N {
                let i = v.grid.tile_slot(tile) + part * L::N;
                // SAFETY: as in the force pass
                unsafe {
                    let zero = L::splat(0.0);
                    let ui = v.displacement::<L>(i);
                    let own = v.fields::<L>(i);
                    let (mut strain, mut repulsion, mut share, mut weight) =
                        (zero, zero, zero, zero);
                    for (k, b) in bonds.iter().enumerate() {
                        let (_, e) = v.deform(b, i, &ui);
                        let dead = L::dead(v.alive[n * v.width + k], part);
                        let s = series::stretch(e.nan_if(dead)).zero_if(dead);
                        let kr = L::splat(b.k * b.r0_squared);
                        let other = v.fields::<L>(i.wrapping_add_signed(b.shift));
                        strain = strain + v.law.pair_energy(kr * s * s, own, other).zero_if(dead);
                        share = kr.fma(s, share);
                        weight = weight + kr.zero_if(dead);
                        if v.repulsion.is_some() {
                            let close = e.lt(L::splat(b.contact_e));
                            if L::any(close) {
                                repulsion = repulsion + v.repel(b, i, e, close).1;
                            }
                        }
                    }
                    if W::SHARES {
                        let q = v.pressure_factor(i);
                        strain = strain + L::splat(0.5) * q * share * share;
                    }
                    // lane by lane, so that the width does not show in the sum
                    for (sum, x) in sums.iter_mut().zip([strain, repulsion]) {
                        x.to_array()[..L::N]
                            .iter()
                            .for_each(|x| *sum += x * v.volume);
                    }
                    if let Some(out) = self.fields {
                        strain.store(out.strain.at(i));
                        repulsion.store(out.repulsion.at(i));
                        share.store(out.share.at(i));
                        weight.store(out.weight.at(i));
                    }
                }
            }
        }
        sums
    }
}
