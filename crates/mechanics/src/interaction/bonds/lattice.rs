//! The stencil of a lattice body: groups are tiles of eight consecutive slots, and partners lie a fixed number of slots away.

use super::family::{Family, Moved, Reference, Slots};
use super::store::{Layout, Rows};
use crate::body::{Body, Exchange, Grid};
use crate::execute::blocks::Seen;
use crate::execute::lane::{Lane, TILE, prefetch};
use crate::family::links::Links;
use crate::family::offsets::OffsetSet;
use crate::family::stencil::Stencil;
use crate::law::material::{Numbers, Source};

/// Consecutive slots.
#[derive(Clone, Copy)]
pub struct Run(usize);

impl Slots for Run {
    #[inline(always)]
    fn slot(self, l: usize) -> usize {
        self.0 + l
    }
    #[inline(always)]
    fn from(self, l: usize) -> Self {
        Run(self.0 + l)
    }
    #[inline(always)]
    unsafe fn one<L: Lane>(self, column: *const f64) -> L {
        // SAFETY: the caller's promise
        unsafe { L::load(column.add(self.0)) }
    }
    #[inline(always)]
    unsafe fn load<L: Lane, N: Numbers<L>>(self, rows: Rows) -> N {
        N::read(&RunOf(rows, self.0), 0)
    }
}

/// The numbers of a run, made where they are there.
struct RunOf(Rows, usize);

impl<L: Lane> Source<L> for RunOf {
    #[inline(always)]
    fn number(&self, n: usize) -> L {
        // SAFETY: the promise of `load`
        unsafe { L::load(self.0.data.at(n * self.0.layout.stride + self.1)) }
    }
}

/// A bond of the stencil.
#[derive(Debug, Clone, Copy)]
struct Offset<const D: usize> {
    shift: isize,
    /// The bond that leads back, among those of the sublattice where it ends.
    back: usize,
    xi: [f64; D],
    length: f64,
    inv_length: f64,
    two_by_square: f64,
    omega: f64,
    omega_back: f64,
    weight: f64,
}

/// Where a group is.
#[derive(Debug, Clone, Copy)]
struct GroupOf {
    /// Its first slot.
    first: usize,
    /// Its first offset, and how many there are.
    offset: u32,
    bonds: u16,
    sublattice: u16,
}

/// All bonds of a lattice body.
#[derive(Debug, Clone)]
pub struct LatticeFamily<const D: usize> {
    links: Links<D>,
    /// Which cells have bonds, for [`Family::joins`].
    pairs: OffsetSet<D>,
    /// Those of one sublattice after those of another.
    offsets: Vec<Offset<D>>,
    groups: Vec<GroupOf>,
    grid: Grid<D>,
    /// Bytes per group.
    pub width: usize,
    slots: usize,
    /// What slots lack so that tiles begin at whole eights.
    phase: usize,
}

impl<const D: usize> LatticeFamily<D> {
    /// `weight` gives ω of both ends and ν of a bond ξ of a length.
    pub fn new(
        body: &Body<D>,
        grid: &Grid<D>,
        stencil: &Stencil,
        weight: &dyn Fn(&[f64; D], f64) -> [f64; 3],
    ) -> Self {
        let links = Links::new(body, grid, stencil);
        let volume = body.volume.uniform().unwrap_or(1.0);
        let h = grid.lattice.spacing;
        let mut offsets = vec![];
        let mut starts = vec![];
        for (from, (list, links)) in stencil.offsets.iter().zip(&links.links).enumerate() {
            starts.push(offsets.len() as u32);
            for (o, link) in list.iter().zip(links) {
                let square = h * h * (o.squared as f64 / 16.0);
                let length = square.sqrt();
                let [omega, omega_back, fraction] = weight(&link.xi, length);
                let there = |b: &crate::family::stencil::Offset| {
                    b.to == from && (0..3).all(|a| b.cell[a] == -o.cell[a])
                };
                let back = stencil.offsets[o.to].iter().position(there);
                offsets.push(Offset {
                    shift: link.shift,
                    back: back.expect("every bond of a stencil leads back"),
                    xi: link.xi,
                    length,
                    inv_length: 1.0 / length,
                    two_by_square: 2.0 / square,
                    omega,
                    omega_back,
                    weight: fraction * volume,
                });
            }
        }
        let group = |tile: &u32| {
            let sublattice = grid.tile_sublattice(*tile as usize);
            GroupOf {
                first: grid.tile_slot(*tile as usize),
                offset: starts[sublattice],
                bonds: stencil.offsets[sublattice].len() as u16,
                sublattice: sublattice as u16,
            }
        };
        LatticeFamily {
            groups: links.tiles.iter().map(group).collect(),
            width: stencil.offsets.iter().map(Vec::len).max().unwrap_or(0),
            offsets,
            pairs: OffsetSet::new(grid, &links.links, |l| (l.cell, l.to)),
            links,
            grid: grid.clone(),
            slots: body.len,
            phase: TILE - grid.tile_slot(0) % TILE,
        }
    }

    /// Tiles of the grid that are groups, in order.
    pub fn tiles(&self) -> &[u32] {
        &self.links.tiles
    }

    /// Sublattice of a group.
    pub fn sublattice(&self, group: usize) -> usize {
        usize::from(self.groups[group].sublattice)
    }

    #[inline(always)]
    fn first(&self, group: usize) -> usize {
        self.groups[group].first
    }

    /// Of what the bond `k` of a slot remembers: the bonds of a tile lie together, each with its eight slots side by side.
    #[inline(always)]
    fn place_of(&self, slot: usize, k: usize, n: usize, count: usize) -> usize {
        let at = slot + self.phase;
        ((at / TILE * self.width + k) * count + n) * TILE + at % TILE
    }

    #[inline(always)]
    fn offset(&self, group: usize, k: usize) -> &Offset<D> {
        &self.offsets[self.groups[group].offset as usize + k]
    }
}

impl<const D: usize> Family<D> for LatticeFamily<D> {
    type Slots = Run;
    type Place<L: Lane> = ();

    fn groups(&self) -> usize {
        self.links.tiles.len()
    }
    #[inline(always)]
    fn rows(&self, group: usize) -> Run {
        Run(self.first(group))
    }
    #[inline(always)]
    fn bonds(&self, group: usize) -> usize {
        usize::from(self.groups[group].bonds)
    }
    #[inline(always)]
    fn ends(&self, group: usize, k: usize) -> Run {
        Run(self
            .first(group)
            .wrapping_add_signed(self.offset(group, k).shift))
    }
    #[inline(always)]
    fn byte(&self, group: usize, k: usize) -> usize {
        group * self.width + k
    }
    fn bytes_of_bits(&self) -> usize {
        self.links.tiles.len() * self.width
    }
    fn is_point(&self, group: usize, l: usize) -> bool {
        self.grid.is_owned(self.first(group) + l)
    }
    fn is_bond(&self, group: usize, k: usize, l: usize) -> bool {
        self.links.has(group, self.sublattice(group), k, l)
    }

    #[inline(always)]
    unsafe fn place<L: Lane>(&self, _: Run) {}
    #[inline(always)]
    unsafe fn reference<L: Lane>(
        &self,
        group: usize,
        k: usize,
        (): &(),
        _: Run,
        dead: L::Mask,
    ) -> Reference<L, D> {
        // SAFETY: a bond of the group
        let o = unsafe {
            let of = self.groups.get_unchecked(group);
            self.offsets.get_unchecked(of.offset as usize + k)
        };
        let mut xi = [L::splat(0.0); D];
        for a in 0..D {
            xi[a] = L::splat(o.xi[a]);
        }
        Reference {
            xi,
            length: L::splat(o.length),
            inv_length: L::splat(o.inv_length),
            two_by_square: L::splat(o.two_by_square),
            omega: L::splat(o.omega),
            omega_back: L::splat(o.omega_back),
            weight: L::splat(o.weight).zero_if(dead),
        }
    }
    #[inline(always)]
    unsafe fn displacement<L: Lane>(moved: &Moved<D>, slots: Run) -> [L; D] {
        let mut u = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: the caller's promise; guards surround the columns
            u[a] = unsafe { slots.one(moved.columns[a].as_ptr()) };
        }
        u
    }

    fn blocks(&self) -> usize {
        self.links.blocks()
    }
    #[inline(always)]
    fn block(&self, block: usize) -> std::ops::Range<usize> {
        self.links.block(block)
    }

    fn layout(&self, numbers: usize) -> Layout {
        Layout::columns(numbers, self.slots)
    }
    fn memory(&self) -> usize {
        // a load that begins inside a tile goes beyond it
        (self.slots / TILE + 3) * self.width * TILE
    }
    #[inline(always)]
    fn own(&self, group: usize, k: usize, n: usize, count: usize) -> usize {
        self.place_of(self.first(group), k, n, count)
    }
    #[inline(always)]
    unsafe fn back<L: Lane>(
        &self,
        memory: Seen,
        group: usize,
        k: usize,
        part: usize,
        n: usize,
        count: usize,
    ) -> L {
        // SAFETY: the caller's promise
        unsafe {
            let of = self.groups.get_unchecked(group);
            let offset = self.offsets.get_unchecked(of.offset as usize + k);
            let slot = of.first.wrapping_add_signed(offset.shift) + part;
            let inside = (slot + self.phase) % TILE;
            let place = self.place_of(slot, offset.back, n, count);
            let near = L::load(memory.at(place));
            if L::N == 1 || inside == 0 {
                return near;
            }
            // the last slots are those of the next tile
            let tile = self.width * count * TILE;
            let next = memory.at(place + tile - TILE);
            // a stride for each of a hundred bonds: more than a machine follows
            prefetch(next.wrapping_add(tile).wrapping_add(TILE - 1));
            L::select(L::dead(0xff >> inside), L::load(next), near)
        }
    }
    fn fill_memory(&self, exchange: &Exchange, memory: &mut [f64], count: usize) {
        // all numbers of a slot, as if they were of its first bond
        let at = |slot, n| self.place_of(slot, 0, n, count);
        exchange.fill_numbers(memory, self.width * count, at);
    }

    fn joins(&self, _: &Body<D>, i: usize, j: usize) -> bool {
        let ((ci, bi), (cj, bj)) = (self.grid.cell(i), self.grid.cell(j));
        let cell = crate::array::from_fn(|a| cj[a] - ci[a]);
        self.pairs.contains(cell, bi, bj)
    }

    fn find(&self, slot: usize) -> Option<(usize, usize)> {
        let at = slot.checked_sub(self.grid.guard)?;
        let group = self.links.tiles.binary_search(&((at / TILE) as u32)).ok()?;
        self.is_point(group, at % TILE)
            .then_some((group, at % TILE))
    }

    fn bytes(&self) -> usize {
        self.links.bytes()
            + self.pairs.bytes()
            + size_of_val(&*self.offsets)
            + size_of_val(&*self.groups)
    }
}
