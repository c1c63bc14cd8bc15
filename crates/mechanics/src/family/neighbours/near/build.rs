//! Making the list anew: atoms wrapped into the box, in order of cells, with their ghosts, and who is near to whom.

use super::cells::{Cells, Extent, NOBODY, NOWHERE, Sorted};
use super::foreign::Sort;
use super::{BLOCK, Lines, NearList, Tile, atoms_of, images, position};
use crate::body::{Body, FieldView};
use crate::execute::blocks::{PerBlock, Shared, for_each_piece, run_blocks};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};

/// Lists of a block of tiles.
#[derive(Debug, Clone, Default)]
pub(super) struct Block {
    /// `[lines]` neighbours.
    lines: Vec<[u32; TILE]>,
    /// `[tile][group]`: where its lines of neighbours of each kind, or of all, end.
    ends: Vec<u32>,
}

impl Block {
    /// Its tiles, the first of which has this number; `kind` are those of all atoms, if there are several. Neighbours are in so many groups.
    #[inline(always)]
    pub fn tiles<'a>(
        &'a self,
        groups: usize,
        first: usize,
        kind: &'a [u8],
    ) -> impl Iterator<Item = Tile<'a>> {
        let mut start = 0;
        let each = self.ends.chunks_exact(groups).enumerate();
        each.map(move |(n, ends)| {
            let begin = start;
            start = ends[groups - 1] as usize;
            Tile {
                number: first + n,
                kind: kind.get((first + n) * TILE).map_or(0, |k| usize::from(*k)),
                lines: &self.lines[begin..start],
                ends,
                start: begin,
            }
        })
    }

    /// The lines of one of them.
    #[inline(always)]
    pub fn tile(&self, n: usize, groups: usize) -> &[[u32; TILE]] {
        &self.lines[self.range(n, groups)]
    }

    pub fn tile_mut(&mut self, n: usize, groups: usize) -> &mut [[u32; TILE]] {
        let range = self.range(n, groups);
        &mut self.lines[range]
    }

    #[inline(always)]
    fn range(&self, n: usize, groups: usize) -> std::ops::Range<usize> {
        let first = match n {
            0 => 0,
            n => self.ends[n * groups - 1] as usize,
        };
        first..self.ends[(n + 1) * groups - 1] as usize
    }

    pub fn bytes(&self) -> usize {
        4 * TILE * self.lines.capacity() + 4 * self.ends.capacity()
    }
}

impl<const D: usize> NearList<D> {
    pub(super) fn build(&mut self, body: &Body<D>, u: FieldView<D>, simd: Simd) {
        let mut base = vec![[0.0; 4]; body.points()];
        let wrap = Wrap {
            body,
            u,
            period: &self.period,
            base: Shared(base.as_mut_ptr()),
        };
        let extent = PerBlock::new(self.blocks.len(), Extent::EMPTY);
        let extent = extent.fold(simd, &wrap, Extent::add).of_all(body);
        let cells = Cells::new(body.all_points(), &extent, self.reach, &self.period);
        self.arrange(&cells, &base, body, u);

        // atoms of other ranks, images, and what is nowhere
        let nowhere = [NOWHERE * self.reach; 4];
        self.position.clear();
        self.position.extend_from_slice(&self.then);
        self.position.resize(self.first_foreign(), nowhere);
        if self.reaches.kinds > 1 {
            self.kind.resize(self.first_foreign(), 0);
        }
        let sort = Sort {
            cells: &cells,
            period: &self.period,
            reach: self.reach,
            groups: self.groups(),
            wide: self.wide,
        };
        let met = (&mut self.position, &mut self.kind);
        let boxed = self.foreign.meet(body, u, &sort, &self.order, met);
        if self.lines == Lines::Mixed {
            for (x, kind) in self.position.iter_mut().zip(&self.kind) {
                x[3] = f64::from(*kind);
            }
        }
        let own = boxed.as_ref().map_or(self.order.len(), Vec::len);
        let listed = |n: usize| boxed.as_ref().map_or(n as u32, |boxed| boxed[n]);
        let at = |n: usize| (listed(n), self.position[listed(n) as usize]);
        self.images = images::find(own, at, &self.period, self.reach);
        let first = self.first_image();
        self.position.resize(first + self.images.len() + 1, nowhere);
        images::refresh(&self.images, first, &mut self.position);
        if self.reaches.kinds > 1 {
            // images are of the kind of what they copy, what is nowhere of any
            let images = self.images.iter().map(|g| self.kind[g.of as usize]);
            let images: Vec<u8> = images.collect();
            self.kind.extend(images);
            self.kind.push(0);
        }
        let atom = |n: usize| match n.checked_sub(own) {
            None => listed(n) as usize,
            Some(image) => first + image,
        };
        let at = |n: usize| self.position[atom(n)];
        let group = |n: usize| match self.lines {
            Lines::ByKind => self.kind(atom(n)),
            Lines::Mixed => 0,
        };
        let mut sorted = cells.sort(own + self.images.len(), self.groups(), group, at);
        for_each_piece(&mut sorted.item, |_, piece| {
            piece.iter_mut().for_each(|n| *n = atom(*n as usize) as u32);
        });
        let at = crate::array::from_fn(|a| {
            let mut column = vec![0.0; sorted.item.len() + TILE];
            for_each_piece(&mut column[..sorted.item.len()], |first, piece| {
                for (x, n) in piece.iter_mut().zip(&sorted.item[first..]) {
                    *x = self.position[*n as usize][a];
                }
            });
            column
        });
        let mut of = vec![];
        if self.lines == Lines::Mixed && !self.reaches.are_equal() {
            of.resize(sorted.item.len() + TILE, 0.0);
            for_each_piece(&mut of[..sorted.item.len()], |first, piece| {
                for (kind, n) in piece.iter_mut().zip(&sorted.item[first..]) {
                    *kind = f64::from(self.kind[*n as usize]);
                }
            });
        }
        let mut blocks = std::mem::take(&mut self.blocks);
        let tiles = (self.first_foreign() + self.foreign.centres()) / TILE;
        blocks.resize(tiles.div_ceil(BLOCK), Block::default());
        let kernel = Find {
            list: self,
            tiles,
            groups: self.groups(),
            of: &of,
            cells: &cells,
            sorted: &sorted,
            at: &at,
            blocks: Shared(blocks.as_mut_ptr()),
        };
        run_blocks(simd, &kernel, blocks.len());
        self.blocks = blocks;
        // where one is nowhere nothing can be said; the next list may know more
        self.valid = extent.finite;
        self.builds += 1;
        if !self.held {
            for (then, u) in self.made_at.iter_mut().zip(u) {
                then.clear();
                then.extend_from_slice(u);
            }
        }
    }

    /// Put own atoms in order of kinds, and those of a kind in order of cells; where kinds are mixed in order of cells alone.
    fn arrange(&mut self, cells: &Cells<D>, base: &[[f64; 4]], body: &Body<D>, u: FieldView<D>) {
        let slots = &body.slots;
        let groups = self.groups();
        let kind = |n: usize| body.material_of(slots[n] as usize);
        let group = |n: usize| match groups {
            1 => 0,
            _ => kind(n),
        };
        let at = |n: usize| position(&base[n], u, slots[n]);
        let mut order = cells.sort(base.len(), groups, group, at).item;
        if groups > 1 {
            (order, self.kind) = in_tiles_of_a_kind(&order, groups, |n| kind(n as usize) as u8);
        } else if self.reaches.kinds > 1 {
            self.kind = order.iter().map(|n| kind(*n as usize) as u8).collect();
        }
        let nowhere = NOWHERE * self.reach;
        self.base.resize(order.len(), [0.0; 4]);
        for_each_piece(&mut self.base, |first, piece| {
            for (b, n) in piece.iter_mut().zip(&order[first..]) {
                *b = base.get(*n as usize).copied().unwrap_or([nowhere; 4]);
            }
        });
        self.order = order;
        for_each_piece(&mut self.order, |_, piece| {
            for n in piece {
                *n = slots.get(*n as usize).copied().unwrap_or(NOBODY);
            }
        });
        self.then.resize(self.order.len(), [0.0; 4]);
        for_each_piece(&mut self.then, |first, piece| {
            let atoms = self.base[first..].iter().zip(&self.order[first..]);
            for (y, (base, slot)) in piece.iter_mut().zip(atoms) {
                *y = match *slot {
                    NOBODY => *base,
                    slot => position(base, u, slot),
                };
            }
        });
    }
}

/// Atoms, which are in order of their kinds, with each kind beginning a tile and [`NOBODY`] in between; and the kinds.
fn in_tiles_of_a_kind(
    order: &[u32],
    kinds: usize,
    kind_of: impl Fn(u32) -> u8,
) -> (Vec<u32>, Vec<u8>) {
    let (mut atoms, mut kind) = (Vec::with_capacity(order.len() + kinds * TILE), vec![]);
    for of_kind in order.chunk_by(|a, b| kind_of(*a) == kind_of(*b)) {
        let k = kind.last().copied().unwrap_or(0);
        atoms.resize(atoms.len().next_multiple_of(TILE), NOBODY);
        kind.resize(atoms.len(), k);
        atoms.extend(of_kind);
        kind.resize(atoms.len(), kind_of(of_kind[0]));
    }
    (atoms, kind)
}

/// What to add to displacements so that atoms are inside the box, by id, and how far they reach.
struct Wrap<'a, const D: usize> {
    body: &'a Body<D>,
    u: FieldView<'a, D>,
    period: &'a [Option<f64>; D],
    base: Shared<[f64; 4]>,
}

impl<const D: usize> Kernel for Wrap<'_, D> {
    type Out = Extent<D>;
    type Home = Self;
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
    list: &'a NearList<D>,
    /// How many have lists.
    tiles: usize,
    cells: &'a Cells<D>,
    sorted: &'a Sorted,
    /// `[D][sorted]`, with room to read a whole tile at the end.
    at: &'a [Vec<f64>; D],
    /// Groups in which neighbours are found.
    groups: usize,
    /// Kinds of the sorted, with room as above; empty where they are known, or do not matter.
    of: &'a [f64],
    blocks: Shared<Block>,
}

impl<const D: usize> Find<'_, D> {
    /// How far atom `i` is listed with atoms of a kind, squared; 0: not at all.
    #[inline(always)]
    fn square(&self, i: usize, kind: usize) -> f64 {
        let own = self.list.kind.get(i).copied().unwrap_or(0);
        match self.list.reaches.between(own, kind as u8) {
            0.0 => 0.0,
            reach => (reach + self.list.skin) * (reach + self.list.skin),
        }
    }

    /// How far it is listed with the sorted ones that begin at `k`.
    #[inline(always)]
    fn squares<L: Lane>(&self, i: usize, k: usize) -> L {
        // SAFETY: there is room for a tile after the last atom
        let of = unsafe { L::load(self.of.as_ptr().add(k)) };
        let last = self.list.reaches.kinds - 1;
        let mut found = L::splat(self.square(i, last));
        for kind in (0..last).rev() {
            let up_to = of.lt(L::splat(kind as f64 + 0.5));
            found = L::select(up_to, L::splat(self.square(i, kind)), found);
        }
        found
    }

    /// The atoms of a group within reach of atom `i`, itself left out.
    #[inline(always)]
    fn row<L: Lane>(&self, i: usize, group: usize, row: &mut Vec<u32>) {
        let each = !self.of.is_empty();
        let square = self.square(i, group);
        if square == 0.0 && !each {
            return;
        }
        let mut square = L::splat(square);
        let start = self.sorted.starts(group, self.groups);
        let x = &self.list.position[i];
        let mut center = [L::splat(0.0); D];
        for a in 0..D {
            center[a] = L::splat(x[a]);
        }
        let (low, high) = self.cells.around(x);
        for n in 0..Cells::rows(&low, &high) {
            let (first, last) = self.cells.run(n, &low, &high, start);
            row.reserve(last - first);
            let mut k = first;
            while k < last {
                let mut q = L::splat(0.0);
                for a in 0..D {
                    // SAFETY: there is room for a tile after the last atom
                    let d = unsafe { L::load(self.at[a].as_ptr().add(k)) } - center[a];
                    q = d.fma(d, q);
                }
                if each {
                    square = self.squares(i, k);
                }
                let mut near = L::bits(q.lt(square));
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
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, b: usize) {
        // SAFETY: blocks are disjoint
        let block = unsafe { &mut *self.blocks.at(b) };
        block.lines.clear();
        block.ends.clear();
        let nowhere = self.list.nowhere();
        let mut rows: [Vec<u32>; TILE] = Default::default();
        for t in b * BLOCK..((b + 1) * BLOCK).min(self.tiles) {
            for group in 0..self.groups {
                for (l, row) in rows.iter_mut().enumerate() {
                    row.clear();
                    let i = t * TILE + l;
                    if self.list.home(i) == Some(i) {
                        self.row::<L>(i, group, row);
                    }
                }
                let first = block.lines.len();
                let longest = rows.iter().map(Vec::len).max().unwrap_or(0);
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
}
