//! The sweeps over a lattice stencil: points of a tile in lanes, offsets in a fixed order.
//!
//! No closure touches a lane here: a closure is compiled without the instruction set of its caller unless it happens
//! to be inlined, and then every operation becomes a call.

mod energies;
mod forces;
mod share;

use crate::body::{Body, Grid};
use crate::execute::blocks::Shared;
use crate::execute::lane::Lane;
use crate::interaction::Repulsion;
use crate::interaction::bond::deform;
use crate::law::Law;
pub use energies::Energies;
pub use forces::Forces;
pub use share::Share;
use std::mem::MaybeUninit;

/// Tiles per block of work.
pub const BLOCK: usize = 32;
/// Longest stencil that a sweep can keep account of.
pub const MOST: usize = 32768;

/// Offsets that a hot loop takes in one go: first their deformation, then what they answer. Two short loops keep more
/// bonds in flight than one long one, whose chain of dependent operations fills the processor's window; and nothing
/// that depends on a bond decides where something is stored (docs/decisions/0001-hot-loop.md).
const CHUNK: usize = 32;

/// A bond of the stencil with the constants that hot loops read: one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Bond<const D: usize> {
    /// Slots from i to j.
    pub shift: isize,
    /// `−ξ`: from j back to i.
    pub back: [f64; D],
    pub two_by_r0_squared: f64,
    pub k: f64,
    /// Repulsion acts where `e` is below this; −1 without repulsion.
    pub contact_e: f64,
    /// `k r0²`
    pub share: f64,
}

/// Where a bond of the stencil leads, and how near is too near.
#[derive(Debug, Clone, Copy)]
pub struct Partner<const D: usize> {
    pub cell: [i32; D],
    pub to: usize,
    pub r0_squared: f64,
    pub contact_distance: f64,
}

/// What all kernels read.
pub struct View<'a, const D: usize, W> {
    pub law: W,
    pub grid: &'a Grid<D>,
    pub body: &'a Body<D>,
    pub bonds: &'a [Vec<Bond<D>>],
    pub partners: &'a [Vec<Partner<D>>],
    pub width: usize,
    pub tiles: &'a [u32],
    /// `[tiles][width]`
    pub alive: Shared<u8>,
    /// `[tiles]`: 1 where every bond of `reach` is whole for all eight points.
    pub intact: Shared<u8>,
    /// `[tiles][words]`: a bit per offset that any point of the tile ever had a partner at.
    pub reach: &'a [u64],
    pub u: [&'a [f64]; D],
    pub fields: [&'a [f64]; 2],
    /// Pressure factors per slot where materials differ; else empty: the law's own.
    pub pressure: &'a [f64],
    pub volume: f64,
    pub repulsion: Option<Repulsion>,
    /// The highest `e` at which any bond repels.
    pub most_contact: f64,
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
        deform(eta, back, L::splat(b.two_by_r0_squared))
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

    /// Sublattice of the `n`-th active tile.
    #[inline(always)]
    fn sublattice(&self, n: usize) -> usize {
        self.grid.tile_sublattice(self.tiles[n] as usize)
    }

    /// Stencil of the `n`-th active tile.
    #[inline(always)]
    fn stencil(&self, n: usize) -> &[Bond<D>] {
        &self.bonds[self.sublattice(n)]
    }

    /// First slot of the `n`-th active tile.
    #[inline(always)]
    fn slot(&self, n: usize) -> usize {
        self.grid.tile_slot(self.tiles[n] as usize)
    }

    /// Are all bonds that lead anywhere from the `n`-th active tile whole?
    #[inline(always)]
    unsafe fn is_intact(&self, n: usize) -> bool {
        // SAFETY: one byte per active tile
        unsafe { *self.intact.at(n) != 0 }
    }

    /// Bond bits of the `n`-th active tile.
    #[inline(always)]
    unsafe fn row(&self, n: usize) -> *mut u8 {
        // SAFETY: `width` bytes per active tile
        unsafe { self.alive.at(n * self.width) }
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
    fn repel<L: Lane>(&self, to: &Partner<D>, i: usize, e: L, close: L::Mask) -> (L, L) {
        let Some(c) = self.repulsion else {
            return (L::splat(0.0), L::splat(0.0));
        };
        let mut there = 0u8;
        for l in 0..L::N {
            if L::bits(close) >> l & 1 == 1
                && self.grid.is_owned(i + l)
                && self.grid.neighbour(i + l, to.cell, to.to).is_some()
            {
                there |= 1 << l;
            }
        }
        let absent = L::dead(there, 0);
        let r = (L::splat(to.r0_squared) * (L::splat(1.0) + e)).sqrt();
        let d = L::splat(to.contact_distance);
        let pull = (L::splat(c.stiffness * self.volume) * (r - d)).div(r);
        let energy = L::splat(0.25 * c.stiffness * self.volume) * (r - d) * (r - d);
        (pull.zero_if(absent), energy.zero_if(absent))
    }
}

/// The offsets that lead anywhere from a tile, in order. Neighbouring tiles mostly share them.
struct Offsets {
    /// The bits they were made from.
    reach: [u64; MOST / 64],
    list: [MaybeUninit<u16>; MOST],
    len: usize,
}

impl Offsets {
    #[inline(always)]
    fn new() -> Self {
        Offsets {
            reach: [0; MOST / 64],
            list: [const { MaybeUninit::uninit() }; MOST],
            len: 0,
        }
    }

    /// Become the offsets of these bits.
    #[inline(always)]
    fn of(&mut self, reach: &[u64]) {
        if self.reach[..reach.len()] == *reach {
            return;
        }
        self.len = 0;
        for (w, &word) in reach.iter().enumerate() {
            self.reach[w] = word;
            let mut bits = word;
            while bits != 0 {
                self.list[self.len].write((64 * w) as u16 + bits.trailing_zeros() as u16);
                self.len += 1;
                bits &= bits - 1;
            }
        }
    }

    /// All of them were written.
    #[inline(always)]
    fn chunks(&self) -> std::slice::Chunks<'_, MaybeUninit<u16>> {
        self.list[..self.len].chunks(CHUNK)
    }
}

/// The first half of a hot loop's work for the second, bond by bond.
struct Deformed<L, const D: usize> {
    /// Not a number in lanes that the second half leaves out.
    e: [MaybeUninit<L>; CHUNK],
    /// `−(ξ+η)`
    y: [[MaybeUninit<L>; D]; CHUNK],
}

impl<L: Lane, const D: usize> Deformed<L, D> {
    #[inline(always)]
    fn new() -> Self {
        Deformed {
            e: [MaybeUninit::uninit(); CHUNK],
            y: [[MaybeUninit::uninit(); D]; CHUNK],
        }
    }

    /// # Safety
    /// `c` is less than [`CHUNK`].
    #[inline(always)]
    unsafe fn put(&mut self, c: usize, e: L, y: [L; D]) {
        // SAFETY: the caller's promise
        unsafe {
            self.e.get_unchecked_mut(c).write(e);
            for a in 0..D {
                self.y.get_unchecked_mut(c)[a].write(y[a]);
            }
        }
    }

    /// # Safety
    /// Number `c` was put.
    #[inline(always)]
    unsafe fn leave_out(&mut self, c: usize, lanes: L::Mask) {
        // SAFETY: the caller's promise
        unsafe {
            let e = self.e(c).nan_if(lanes);
            self.e.get_unchecked_mut(c).write(e);
        }
    }

    /// # Safety
    /// Number `c` was put.
    #[inline(always)]
    unsafe fn e(&self, c: usize) -> L {
        // SAFETY: the caller's promise
        unsafe { self.e.get_unchecked(c).assume_init() }
    }

    /// # Safety
    /// Number `c` was put.
    #[inline(always)]
    unsafe fn y(&self, c: usize, a: usize) -> L {
        // SAFETY: the caller's promise
        unsafe { self.y.get_unchecked(c)[a].assume_init() }
    }
}
