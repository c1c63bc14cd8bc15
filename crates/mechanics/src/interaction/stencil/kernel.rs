//! The sweeps over a lattice stencil: points of a tile in lanes, offsets in a fixed order.
//!
//! No closure touches a lane here: a closure is compiled without the instruction set of its caller unless it happens
//! to be inlined, and then every operation becomes a call.

mod chunk;
mod energies;
mod forces;
mod offsets;
mod share;

use crate::body::{Body, Grid};
use crate::execute::blocks::Seen;
use crate::execute::lane::{Lane, TILE};
use crate::interaction::Repulsion;
use crate::interaction::bond::relative_square_stretch;
use crate::interaction::bonds::LatticeFamily;
use crate::interaction::bonds::family::Family;
use crate::interaction::scale::Scale;
use crate::law::Law;
pub use energies::Energies;
pub use forces::{Forces, Remember};
pub use share::Share;

/// Longest stencil that a sweep can keep account of.
pub use crate::family::stencil::MOST;
/// State of a tile: every bond of `reach` is whole for all eight points.
pub const WHOLE: u8 = 1;
/// And field 1 is the same at all ends.
pub const ALIKE: u8 = 2;

/// A bond of the stencil with the constants that hot loops read: one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct Bond<const D: usize> {
    /// Slots from i to j.
    pub shift: i32,
    /// Its place in the stencil.
    pub number: u32,
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
    pub family: &'a LatticeFamily<D>,
    pub width: usize,
    pub tiles: &'a [u32],
    /// `[tiles][width]`
    pub alive: Seen<u8>,
    /// `[tiles]`: [`WHOLE`], perhaps with [`ALIKE`], or 0.
    pub state: Seen<u8>,
    /// `[tiles]`: which row of `reaches`.
    pub reach: &'a [u32],
    /// `[different][words]`: a bit per offset that any point of a tile ever had a partner at.
    pub reaches: &'a [u64],
    /// Factors of bonds, of tiles that have any.
    pub scale: &'a Scale,
    pub u: [&'a [f64]; D],
    pub fields: [&'a [f64]; 2],
    /// Pressure factors per slot where materials differ; else empty: the law's own.
    pub pressure: &'a [f64],
    pub repulsion: Option<&'a Repulsion>,
    /// The highest `e` at which any bond repels.
    pub most_contact: f64,
}

impl<const D: usize> Bond<D> {
    /// Slot of j for the point at slot i.
    #[inline(always)]
    pub fn to(&self, i: usize) -> usize {
        i.wrapping_add_signed(self.shift as isize)
    }
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

    /// `−η` and `−ξ` of bond `b` for the points at `i`.
    #[inline(always)]
    unsafe fn vectors<L: Lane>(&self, b: &Bond<D>, i: usize, ui: &[L; D]) -> ([L; D], [L; D]) {
        // SAFETY: offsets stay inside the guards
        let uj = unsafe { self.displacement::<L>(b.to(i)) };
        let (mut eta, mut back) = (uj, uj);
        for a in 0..D {
            eta[a] = ui[a] - uj[a];
            back[a] = L::splat(b.back[a]);
        }
        (eta, back)
    }

    /// `e` of bond `b` for the points at `i`.
    #[inline(always)]
    unsafe fn deform<L: Lane>(&self, b: &Bond<D>, i: usize, ui: &[L; D]) -> L {
        // SAFETY: offsets stay inside the guards
        let (eta, back) = unsafe { self.vectors(b, i, ui) };
        relative_square_stretch(eta, back, L::splat(b.two_by_r0_squared))
    }

    /// `−(ξ+η)` of bond `b` for the points at `i`.
    #[inline(always)]
    unsafe fn direction<L: Lane>(&self, b: &Bond<D>, i: usize, ui: &[L; D]) -> [L; D] {
        // SAFETY: offsets stay inside the guards
        let (eta, back) = unsafe { self.vectors(b, i, ui) };
        let mut y = eta;
        for a in 0..D {
            y[a] = eta[a] + back[a];
        }
        y
    }

    fn block(&self, block: usize) -> std::ops::Range<usize> {
        self.family.block(block)
    }

    /// Bits of the offsets that lead anywhere from the `n`-th active tile.
    #[inline(always)]
    fn reach(&self, n: usize) -> &[u64] {
        let words = self.width.div_ceil(64);
        let which = self.reach[n] as usize;
        &self.reaches[which * words..(which + 1) * words]
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
        unsafe { *self.state.at(n) != 0 }
    }

    /// Of an intact tile: is field 1 the same at all ends of its bonds?
    #[inline(always)]
    unsafe fn is_alike(&self, n: usize) -> bool {
        // SAFETY: one byte per active tile
        unsafe { *self.state.at(n) & ALIKE != 0 }
    }

    /// Has any bond of the `n`-th active tile a factor?
    #[inline(always)]
    fn is_scaled(&self, n: usize) -> bool {
        self.scale.is_scaled(n)
    }

    /// Bond bits of the `n`-th active tile.
    #[inline(always)]
    unsafe fn row(&self, n: usize) -> *const u8 {
        // SAFETY: `width` bytes per active tile
        unsafe { self.alive.at(n * self.width) }
    }

    /// `P / Σ k r0² s` of the points at slot `i`; 0 for laws that do not share.
    #[inline(always)]
    unsafe fn pressure_factor<L: Lane>(&self, i: usize) -> L {
        if !W::SHARES {
            return L::splat(0.0);
        }
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
        let mut volume = [0.0; TILE];
        let mut material = [[0u8; TILE]; 2];
        for l in 0..TILE {
            if L::bits(close) >> l & 1 == 1
                && self.grid.is_owned(i + l)
                && let Some(j) = self.grid.neighbour(i + l, to.cell, to.to)
            {
                there |= 1 << l;
                volume[l] = self.body.volume.at(j);
                material[0][l] = self.body.material_of(i + l) as u8;
                material[1][l] = self.body.material_of(j) as u8;
            }
        }
        let absent = L::dead(there);
        let r = (L::splat(to.r0_squared) * (L::splat(1.0) + e)).sqrt();
        let d = L::splat(to.contact_distance);
        // SAFETY: a number per lane
        let volume = unsafe { L::load(volume.as_ptr()) };
        let stiffness = c.lanes::<L>(material[0], material[1]) * volume;
        let pull = (stiffness * (r - d)).div(r);
        let energy = L::splat(0.25) * stiffness * (r - d) * (r - d);
        (pull.zero_if(absent), energy.zero_if(absent))
    }
}
