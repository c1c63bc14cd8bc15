//! Making the list anew: atoms wrapped into the box, in order of cells, with their ghosts, and who is near to whom.

use super::cells::{Cells, Extent, Sorted};
use super::{BLOCK, NearList, atoms_of, ghosts, position};
use crate::body::{Body, Field};
use crate::execute::blocks::{PerBlock, Shared, for_each_piece, run_blocks};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};

/// Where atoms that are not there are (in reaches), so that no pair with them counts.
const NOWHERE: f64 = 1e30;

/// Lists of a block of tiles.
#[derive(Debug, Clone, Default)]
pub(super) struct Block {
    /// `[lines]` neighbours.
    lines: Vec<[u32; TILE]>,
    /// Where each tile's lines end.
    ends: Vec<u32>,
}

impl Block {
    /// The lines of its tiles.
    #[inline(always)]
    pub fn tiles(&self) -> impl Iterator<Item = &[[u32; TILE]]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let lines = &self.lines[start..end as usize];
            start = end as usize;
            lines
        })
    }

    /// The lines of one of them.
    #[inline(always)]
    pub fn tile(&self, n: usize) -> &[[u32; TILE]] {
        let first = match n {
            0 => 0,
            n => self.ends[n - 1] as usize,
        };
        &self.lines[first..self.ends[n] as usize]
    }

    pub fn bytes(&self) -> usize {
        4 * TILE * self.lines.capacity() + 4 * self.ends.capacity()
    }
}

impl<const D: usize> NearList<D> {
    pub(super) fn build(&mut self, body: &Body<D>, u: &Field<D>, simd: Simd) {
        let mut base = vec![[0.0; 4]; body.points()];
        let wrap = Wrap {
            body,
            u,
            period: &self.period,
            base: Shared(base.as_mut_ptr()),
        };
        let extent = PerBlock::new(self.blocks.len(), Extent::EMPTY);
        let extent = extent.fold(simd, &wrap, Extent::add);
        let cells = Cells::new(base.len(), &extent, self.reach, &self.period);
        self.arrange(&cells, &base, &body.slots, u);

        // ghosts, and what is nowhere
        let own = self.order.len();
        self.position.clear();
        self.position.extend_from_slice(&self.then);
        self.position
            .resize(self.first_ghost(), [NOWHERE * self.reach; 4]);
        self.ghosts = ghosts::find(&self.then, &self.period, self.reach);
        let all = self.first_ghost() + self.ghosts.len();
        self.position.resize(all + 1, [NOWHERE * self.reach; 4]);
        ghosts::refresh(&self.ghosts, self.first_ghost(), &mut self.position);

        let gap = self.first_ghost() - own;
        let atom = |n: usize| if n < own { n } else { n + gap };
        let mut sorted = cells.sort(own + self.ghosts.len(), |n| self.position[atom(n)]);
        for_each_piece(&mut sorted.item, |_, piece| {
            piece.iter_mut().for_each(|n| *n = atom(*n as usize) as u32);
        });
        let at = std::array::from_fn(|a| {
            let mut column = vec![0.0; sorted.item.len() + TILE];
            for_each_piece(&mut column[..sorted.item.len()], |first, piece| {
                for (x, n) in piece.iter_mut().zip(&sorted.item[first..]) {
                    *x = self.position[*n as usize][a];
                }
            });
            column
        });
        let mut blocks = std::mem::take(&mut self.blocks);
        let kernel = Find {
            cells: &cells,
            sorted: &sorted,
            at: &at,
            position: &self.position,
            own,
            square: self.reach * self.reach,
            blocks: Shared(blocks.as_mut_ptr()),
        };
        run_blocks(simd, &kernel, blocks.len());
        self.blocks = blocks;
        // where one is nowhere nothing can be said; the next list may know more
        self.valid = extent.finite;
        self.builds += 1;
    }

    /// Put own atoms in order of cells.
    fn arrange(&mut self, cells: &Cells<D>, base: &[[f64; 4]], slots: &[u32], u: &Field<D>) {
        let order = cells
            .sort(base.len(), |n| position(&base[n], u, slots[n]))
            .item;
        self.base.resize(order.len(), [0.0; 4]);
        for_each_piece(&mut self.base, |first, piece| {
            for (b, n) in piece.iter_mut().zip(&order[first..]) {
                *b = base[*n as usize];
            }
        });
        self.order = order;
        for_each_piece(&mut self.order, |_, piece| {
            piece.iter_mut().for_each(|n| *n = slots[*n as usize]);
        });
        self.then.resize(self.order.len(), [0.0; 4]);
        for_each_piece(&mut self.then, |first, piece| {
            let atoms = self.base[first..].iter().zip(&self.order[first..]);
            for (y, (base, slot)) in piece.iter_mut().zip(atoms) {
                *y = position(base, u, *slot);
            }
        });
    }
}

/// What to add to displacements so that atoms are inside the box, by id, and how far they reach.
struct Wrap<'a, const D: usize> {
    body: &'a Body<D>,
    u: &'a Field<D>,
    period: &'a [Option<f64>; D],
    base: Shared<[f64; 4]>,
}

impl<const D: usize> Kernel for Wrap<'_, D> {
    type Out = Extent<D>;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> Extent<D> {
        let mut extent = Extent::EMPTY;
        for n in atoms_of(block, self.body.points()) {
            let slot = self.body.slots[n];
            let x = self.body.position(slot as usize);
            let mut base = [0.0; 4];
            for a in 0..D {
                base[a] = x[a];
                if let Some(p) = self.period[a] {
                    base[a] -= p * ((x[a] + self.u[a][slot as usize]) / p).floor();
                }
            }
            extent = extent.with(&position(&base, self.u, slot));
            // SAFETY: blocks are disjoint
            unsafe { *self.base.at(n) = base };
        }
        extent
    }
}

/// Makes the lists of a block of tiles.
struct Find<'a, const D: usize> {
    cells: &'a Cells<D>,
    sorted: &'a Sorted,
    /// `[D][sorted]`, with room to read a whole tile at the end.
    at: &'a [Vec<f64>; D],
    position: &'a [[f64; 4]],
    own: usize,
    square: f64,
    blocks: Shared<Block>,
}

impl<const D: usize> Find<'_, D> {
    /// The atoms within reach of atom `i`, itself left out.
    #[inline(always)]
    fn row<L: Lane>(&self, i: usize, row: &mut Vec<u32>) {
        row.clear();
        let x = &self.position[i];
        let mut center = [L::splat(0.0); D];
        for a in 0..D {
            center[a] = L::splat(x[a]);
        }
        let (low, high) = self.cells.around(x);
        for n in 0..Cells::rows(&low, &high) {
            let (first, last) = self.cells.run(n, &low, &high, &self.sorted.start);
            row.reserve(last - first);
            let mut k = first;
            while k < last {
                let mut q = L::splat(0.0);
                for a in 0..D {
                    // SAFETY: there is room for a tile after the last atom
                    let d = unsafe { L::load(self.at[a].as_ptr().add(k)) } - center[a];
                    q = d.fma(d, q);
                }
                let mut near = L::bits(q.lt(L::splat(self.square)));
                if last - k < TILE {
                    near &= (1 << (last - k)) - 1;
                }
                while near != 0 {
                    let j = self.sorted.item[k + near.trailing_zeros() as usize];
                    if j as usize != i {
                        row.push(j);
                    }
                    near &= near - 1;
                }
                k += TILE;
            }
        }
    }
}

impl<const D: usize> Kernel for Find<'_, D> {
    type Out = ();
    #[inline(always)]
    fn block<L: Lane>(&self, b: usize) {
        // SAFETY: blocks are disjoint
        let block = unsafe { &mut *self.blocks.at(b) };
        block.lines.clear();
        block.ends.clear();
        let nowhere = (self.position.len() - 1) as u32;
        let mut rows: [Vec<u32>; TILE] = Default::default();
        for t in b * BLOCK..((b + 1) * BLOCK).min(self.own.div_ceil(TILE)) {
            let mut longest = 0;
            for l in 0..TILE {
                let i = t * TILE + l;
                rows[l].clear();
                if i < self.own {
                    self.row::<L>(i, &mut rows[l]);
                }
                longest = longest.max(rows[l].len());
            }
            let first = block.lines.len();
            block.lines.resize(first + longest, [nowhere; TILE]);
            for (l, row) in rows.iter().enumerate() {
                for (line, j) in block.lines[first..].iter_mut().zip(row) {
                    line[l] = *j;
                }
            }
            block.ends.push(block.lines.len() as u32);
        }
    }
}
