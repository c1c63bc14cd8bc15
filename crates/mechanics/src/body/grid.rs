//! The integer grid of a lattice body: one box of cells per basis site, cut into tiles of eight slots.

use crate::error::BuildError;
use crate::execute::lane::TILE;
use crate::space::lattice::Lattice;
use crate::space::{AXES, Point};

/// Tiles of a block of work. Where blocks begin belongs to the grid, so that sums are made of the same ones whoever has them.
pub const BLOCK: usize = 32;

#[derive(Debug, Clone)]
pub struct Grid<const D: usize> {
    pub(crate) lattice: Lattice,
    /// Cells along each axis, image cells of periodic axes included.
    pub(crate) cells: [usize; D],
    /// Lattice coordinates of the box's first cell.
    pub(crate) low: [i32; D],
    /// Image cells on each side of periodic axes.
    pub(crate) halo: [usize; D],
    /// The first cell that has a slot, in their order: 0, but in a part of a body.
    pub(crate) first: usize,
    /// Slots of one sublattice: the cells, rounded up to whole tiles; in a part of a body those of a run of them.
    pub(crate) stride: usize,
    /// Slots before the first and after the last, so that every offset stays inside the arrays.
    pub(crate) guard: usize,
    /// One bit per slot (guards excluded): a point or an image of one is there. One byte per tile.
    pub(crate) present: Vec<u8>,
    /// Like `present`, images excluded.
    pub(crate) owned: Vec<u8>,
}

/// The lowest and the highest cell along each axis of some sites.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ends<const D: usize> {
    pub low: [i32; D],
    pub high: [i32; D],
}

impl<const D: usize> Ends<D> {
    /// Of no sites.
    pub fn none() -> Ends<D> {
        Ends {
            low: [i32::MAX; D],
            high: [i32::MIN; D],
        }
    }

    /// This site (in quarters), too.
    pub fn reach(&mut self, site: [i32; 3]) {
        for a in 0..D {
            self.low[a] = self.low[a].min(site[a].div_euclid(4));
            self.high[a] = self.high[a].max(site[a].div_euclid(4));
        }
    }
}

impl<const D: usize> Grid<D> {
    /// Of all cells between such ends, with images along periodic axes as far as bonds span, so many cells; without sites.
    pub(super) fn around(
        lattice: Lattice,
        ends: &Ends<D>,
        reach: usize,
        periodic: [bool; D],
    ) -> Result<Grid<D>, BuildError> {
        let halo: [usize; D] = crate::array::from_fn(|a| if periodic[a] { reach } else { 0 });
        let extent: [usize; D] =
            crate::array::from_fn(|a| (ends.high[a] - ends.low[a] + 1) as usize);
        for a in 0..D {
            if periodic[a] && extent[a] < reach {
                return Err(BuildError::conflict(
                    "periodic",
                    format!(
                        "the period along {} is {} cells, shorter than the horizon of {reach}",
                        AXES[a], extent[a]
                    ),
                )
                .help("make the body longer along this axis, or the horizon shorter"));
            }
        }
        let cells: [usize; D] = crate::array::from_fn(|a| extent[a] + 2 * halo[a]);
        let count: usize = cells.iter().product();
        let mut grid = Grid {
            lattice,
            cells,
            low: crate::array::from_fn(|a| ends.low[a] - halo[a] as i32),
            halo,
            first: 0,
            stride: count.div_ceil(TILE) * TILE,
            guard: 0,
            present: vec![],
            owned: vec![],
        };
        let span = grid.shift([reach as i64; D], 0).unsigned_abs() as usize;
        grid.guard = span.div_ceil(TILE) * TILE + TILE;
        Ok(grid)
    }

    /// What it repeats after (length) along these axes.
    pub(super) fn period(&self, periodic: [bool; D]) -> [Option<f64>; D] {
        let (edges, extent) = (self.lattice.kind.edges(), self.extent());
        crate::array::from_fn(|a| {
            periodic[a].then(|| extent[a] as f64 * edges[a] * self.lattice.spacing)
        })
    }

    /// Cells along each axis, without images.
    pub(super) fn extent(&self) -> [usize; D] {
        crate::array::from_fn(|a| self.cells[a] - 2 * self.halo[a])
    }

    /// What its cells are of.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Cells along each axis, image cells of periodic axes included.
    pub fn cells(&self) -> [usize; D] {
        self.cells
    }

    /// Image cells on each side of periodic axes.
    pub fn halo(&self) -> [usize; D] {
        self.halo
    }

    /// Number of sites in a cell.
    pub fn basis(&self) -> usize {
        self.lattice.kind.basis().len()
    }

    /// Tiles of the whole grid.
    pub fn tiles(&self) -> usize {
        self.basis() * self.stride / TILE
    }

    /// Slots, guards included.
    pub fn slots(&self) -> usize {
        2 * self.guard + self.basis() * self.stride
    }

    /// First slot of a tile.
    #[inline(always)]
    pub fn tile_slot(&self, tile: usize) -> usize {
        self.guard + tile * TILE
    }

    /// Sublattice of a tile.
    #[inline(always)]
    pub fn tile_sublattice(&self, tile: usize) -> usize {
        tile * TILE / self.stride
    }

    /// Where blocks begin among these tiles, which are in order, and where the last ends: a block lies in one sublattice, and has the tiles of
    /// [`BLOCK`] in a row that are there.
    pub(crate) fn blocks_of(&self, tiles: &[u32]) -> Vec<u32> {
        let of = |tile: u32| {
            let (tile, stride) = (tile as usize, self.stride / TILE);
            (tile / stride, (self.first / TILE + tile % stride) / BLOCK)
        };
        let begins = |n: &usize| *n == 0 || of(tiles[*n]) != of(tiles[n - 1]);
        let starts = (0..tiles.len()).filter(begins).chain([tiles.len()]);
        starts.map(|n| n as u32).collect()
    }

    /// Slot of site `b` of the cell at box coordinates `c`, if inside the box, and in this part of it.
    pub fn slot(&self, c: [i64; D], b: usize) -> Option<usize> {
        let mut i = 0usize;
        for a in (0..D).rev() {
            if c[a] < 0 || c[a] >= self.cells[a] as i64 {
                return None;
            }
            i = i * self.cells[a] + c[a] as usize;
        }
        let i = i.checked_sub(self.first).filter(|i| *i < self.stride)?;
        Some(self.guard + b * self.stride + i)
    }

    /// Slot of a site of a cell that is here, by its place in the order of cells.
    pub(super) fn slot_of(&self, b: usize, cell: usize) -> usize {
        self.guard + b * self.stride + cell - self.first
    }

    /// Sublattice of a slot inside the grid, and its cell in their order.
    #[inline]
    pub(super) fn place(&self, slot: usize) -> (usize, usize) {
        let i = slot - self.guard;
        (i / self.stride, self.first + i % self.stride)
    }

    /// Box coordinates and sublattice of a slot inside the grid.
    pub fn cell(&self, slot: usize) -> ([i64; D], usize) {
        let (b, i) = self.place(slot);
        (self.coordinates_of(i), b)
    }

    /// Box coordinates of a cell by its place in their order.
    fn coordinates_of(&self, mut cell: usize) -> [i64; D] {
        crate::array::from_fn(|a| {
            let n = self.cells[a];
            let c = if a + 1 < D { cell % n } else { cell };
            cell /= n;
            c as i64
        })
    }

    /// The cell that these are, or are the image of.
    fn home_of(&self, c: [i64; D]) -> [i64; D] {
        let extent = self.extent();
        crate::array::from_fn(|a| {
            let halo = self.halo[a] as i64;
            halo + (c[a] - halo).rem_euclid(extent[a] as i64)
        })
    }

    /// The cell that one is the image of, or itself, by their places in the order of cells.
    pub(super) fn original(&self, cell: usize) -> usize {
        if self.halo == [0; D] {
            return cell;
        }
        let home = self.home_of(self.coordinates_of(cell));
        (0..D)
            .rev()
            .fold(0, |i, a| i * self.cells[a] + home[a] as usize)
    }

    /// Quarters of the cell's edges from the lattice origin to a site of a cell, by its place in the order of cells.
    pub(super) fn site(&self, b: usize, cell: usize) -> [i32; 3] {
        self.quarter_of((self.coordinates_of(cell), b))
    }

    /// The sublattice and the cell, by its place in their order, of a site (quarters) between the ends of the grid.
    pub(super) fn find(&self, site: [i32; 3]) -> Option<(usize, usize)> {
        let rest: [i32; 3] =
            crate::array::from_fn(|a| if a < D { site[a].rem_euclid(4) } else { 0 });
        let b = { self.lattice.kind.basis().iter() }.position(|s| *s == rest)?;
        let cell = |a: usize| (site[a].div_euclid(4) - self.low[a]) as usize;
        Some((b, (0..D).rev().fold(0, |i, a| i * self.cells[a] + cell(a))))
    }

    /// Number of slots from a cell to the cell `d` cells away and `db` sublattices on.
    pub fn shift(&self, d: [i64; D], db: i64) -> i64 {
        let mut s = 0;
        for a in (0..D).rev() {
            s = s * self.cells[a] as i64 + d[a];
        }
        s + db * self.stride as i64
    }

    /// Does a bond that spans so many cells stay between the guards, wherever it begins?
    pub fn holds(&self, cell: [i32; D]) -> bool {
        self.shift(cell.map(i64::from), 0).unsigned_abs() <= self.guard as u64
    }

    fn bit(set: &[u8], i: usize) -> bool {
        set[i / TILE] >> (i % TILE) & 1 == 1
    }

    /// Is there a point (or an image of one) in this slot?
    pub fn is_present(&self, slot: usize) -> bool {
        Self::bit(&self.present, slot - self.guard)
    }

    /// Is there a point in this slot?
    pub fn is_owned(&self, slot: usize) -> bool {
        Self::bit(&self.owned, slot - self.guard)
    }

    /// The slot `d` cells and `to − from` sublattices from `slot`, if a point or image is there.
    pub fn neighbour(&self, slot: usize, d: [i32; D], to: usize) -> Option<usize> {
        let (c, _) = self.cell(slot);
        let j = self.slot(crate::array::from_fn(|a| c[a] + d[a] as i64), to)?;
        self.is_present(j).then_some(j)
    }

    /// Quarters of the cell's edges from the lattice origin to a slot.
    pub fn quarter(&self, slot: usize) -> [i32; 3] {
        self.quarter_of(self.cell(slot))
    }

    /// Reference position of the point that a slot is a copy of, if of any.
    pub(super) fn home(&self, slot: usize) -> Point {
        let (c, b) = self.cell(slot);
        self.lattice.position(self.quarter_of((self.home_of(c), b)))
    }

    fn quarter_of(&self, (c, b): ([i64; D], usize)) -> [i32; 3] {
        let q = self.lattice.kind.basis()[b];
        crate::array::from_fn(|a| {
            if a < D {
                4 * (c[a] as i32 + self.low[a]) + q[a]
            } else {
                0
            }
        })
    }

    /// Reference coordinate `a` of slots: [position](Self::position), looked up once per row of cells.
    pub fn coordinates(&self, slots: &[u32], a: usize, out: &mut [f64]) {
        let (mut row, mut first) = (0..0, [0; 3]);
        let mut x = 0.0;
        for (out, &slot) in out.iter_mut().zip(slots) {
            let slot = slot as usize;
            if !row.contains(&slot) {
                let (c, _) = self.cell(slot);
                row = slot..slot + self.cells[0] - c[0] as usize;
                first = self.quarter(slot);
                x = self.lattice.position(first)[a];
            }
            if a == 0 {
                let along = first[0] + 4 * (slot - row.start) as i32;
                x = self.lattice.position([along, first[1], first[2]])[0];
            }
            *out = x;
        }
    }

    /// Reference position of a slot.
    pub fn position(&self, slot: usize) -> Point {
        self.lattice.position(self.quarter(slot))
    }
}

#[cfg(test)]
mod tests {
    use crate::body::Body;
    use crate::space::lattice::{Lattice, LatticeKind};

    fn check<const D: usize>(kind: LatticeKind, sites: Vec<[i32; 3]>, periodic: [bool; D]) {
        let lattice = Lattice {
            kind,
            spacing: 0.3,
            origin: [0.1, -2.0, 7.0],
        };
        let body = Body::<D>::on_lattice(lattice, &sites, 2, periodic, 1.0).unwrap();
        for first in [0, 5] {
            for a in 0..3 {
                let mut x = vec![f64::NAN; body.points() - first];
                body.coordinates(first, a, &mut x);
                for (x, &s) in x.iter().zip(&body.slots[first..]) {
                    assert_eq!(*x, body.position(s as usize)[a], "{kind:?} {D}-D, axis {a}");
                }
            }
        }
    }

    #[test]
    fn coordinates_are_positions() {
        let ball = |n: i32, d: usize, step: i32| {
            let along = |a: usize| if a < d { -n..=n } else { 0..=0 };
            let mut sites = vec![];
            for z in along(2) {
                for y in along(1) {
                    for x in along(0) {
                        let even = (x + y) % 2 == 0 && (x + z) % 2 == 0;
                        if x * x + y * y + z * z <= n * n && (step == 4 || even) {
                            sites.push([x * step, y * step, z * step]);
                        }
                    }
                }
            }
            sites
        };
        check::<1>(LatticeKind::Chain, ball(9, 1, 4), [true]);
        check::<2>(LatticeKind::Square, ball(7, 2, 4), [false; 2]);
        check::<3>(LatticeKind::Cubic, ball(5, 3, 4), [false; 3]);
        check::<3>(LatticeKind::Bcc, ball(5, 3, 2), [false; 3]);
    }
}
