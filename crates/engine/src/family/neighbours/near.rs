//! The full list of near atoms: every atom with all others closer than a cut-off, found anew when somebody has moved far
//! enough. What molecular dynamics sweeps over.
//!
//! Atoms are kept in order of small cells, in tiles of eight, so that neighbours lie close in memory; periodic images within
//! reach of the box are atoms of their own (ghosts) with copied positions. A tile's lists are stored line by line: line n
//! holds the n-th neighbour of each of its eight atoms, or an atom infinitely far away.

use crate::body::{Body, Field};
use crate::execute::blocks::{Shared, for_each_block};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};

/// Tiles per block of work.
const BLOCK: usize = 32;
/// Cells per reach and axis.
const PER: usize = 2;
/// Where atoms that are not there are (in cut-offs), so that no pair with them counts.
const NOWHERE: f64 = 1e30;

/// Lists of a block of tiles.
#[derive(Debug, Clone, Default)]
struct Block {
    /// `[lines]` neighbours.
    lines: Vec<[u32; TILE]>,
    /// Where each tile's lines end.
    ends: Vec<u32>,
}

/// The full list.
#[derive(Debug, Clone)]
pub struct NearList<const D: usize> {
    reach: f64,
    skin: f64,
    period: [Option<f64>; D],
    /// Slot of every atom, in order of cells.
    order: Vec<u32>,
    /// `[own][4]`: what to add to the displacement to be inside the box.
    base: Vec<[f64; 4]>,
    /// `[own][4]`: positions when the list was made.
    then: Vec<[f64; 4]>,
    /// Ghosts: atom they copy (earlier in order), and by how much they are shifted.
    ghosts: Vec<(u32, [f64; D])>,
    /// `[own in whole tiles, ghosts, nowhere][4]`: positions; the fourth number is the user's.
    position: Vec<[f64; 4]>,
    blocks: Vec<Block>,
    moved: Vec<f64>,
    valid: bool,
    builds: u64,
}

impl<const D: usize> NearList<D> {
    /// For pairs closer than `cutoff`, with a margin `skin` (lengths). Periods must be at least twice the cut-off; the
    /// margin is made smaller where they leave less.
    pub fn new(body: &Body<D>, cutoff: f64, skin: f64) -> Self {
        let shortest = body
            .period
            .iter()
            .flatten()
            .copied()
            .fold(f64::INFINITY, f64::min);
        let skin = skin.min(shortest - cutoff).max(0.0);
        let own = body.points();
        NearList {
            reach: cutoff + skin,
            skin,
            period: body.period,
            order: vec![],
            base: vec![],
            then: vec![],
            ghosts: vec![],
            position: vec![],
            blocks: vec![Block::default(); own.div_ceil(TILE).div_ceil(BLOCK)],
            moved: vec![0.0; own.div_ceil(TILE).div_ceil(BLOCK)],
            valid: false,
            builds: 0,
        }
    }

    /// Atoms may be anywhere now.
    pub fn look_again(&mut self) {
        self.valid = false;
    }

    /// Positions at displacement `u`, and a list that holds for them. Returns whether it was made anew.
    pub fn update(&mut self, body: &Body<D>, u: &Field<D>, simd: Simd) -> bool {
        if self.valid {
            let far = self.place(u, simd);
            if far <= 0.25 * self.skin * self.skin {
                return false;
            }
        }
        self.build(body, u, simd);
        true
    }

    /// Write positions; how far the farthest atom is from where it was, squared (∞ if one is nowhere).
    fn place(&mut self, u: &Field<D>, simd: Simd) -> f64 {
        let kernel = Place {
            order: &self.order,
            base: &self.base,
            then: &self.then,
            u,
            position: Shared(self.position.as_mut_ptr()),
        };
        for_each_block(simd, &kernel, &mut self.moved);
        self.copy_positions();
        self.moved.iter().copied().fold(0.0, f64::max)
    }

    fn copy_positions(&mut self) {
        let first = self.first_ghost();
        let (atoms, ghosts) = self.position.split_at_mut(first);
        for (n, (source, shift)) in self.ghosts.iter().enumerate() {
            let source = *source as usize;
            let mut p = match source.checked_sub(first) {
                None => atoms[source],
                Some(earlier) => ghosts[earlier],
            };
            for a in 0..D {
                p[a] += shift[a];
            }
            ghosts[n] = p;
        }
    }

    /// Copy the fourth number of every atom to its ghosts.
    pub fn copy_to_ghosts(&mut self) {
        let first = self.first_ghost();
        for n in 0..self.ghosts.len() {
            let source = self.ghosts[n].0 as usize;
            self.position[first + n][3] = self.position[source][3];
        }
    }

    fn first_ghost(&self) -> usize {
        self.order.len().div_ceil(TILE) * TILE
    }

    fn build(&mut self, body: &Body<D>, u: &Field<D>, simd: Simd) {
        // positions, wrapped into the box
        let own = body.points();
        let mut atoms: Vec<(u32, [f64; 4], [f64; 4])> = Vec::with_capacity(own);
        for &slot in &body.slots {
            let s = slot as usize;
            let x = body.position(s);
            let (mut base, mut y) = ([0.0; 4], [0.0; 4]);
            for a in 0..D {
                base[a] = x[a];
                if let Some(p) = self.period[a] {
                    base[a] -= p * ((x[a] + u[a][s]) / p).floor();
                }
                y[a] = base[a] + u[a][s];
            }
            atoms.push((slot, base, y));
        }
        let nan = atoms
            .iter()
            .any(|(_, _, y)| y.iter().any(|c| !c.is_finite()));
        let cells = Cells::<D>::new(&atoms, self.reach, &self.period);
        let mut keys: Vec<(u32, u32)> = atoms
            .iter()
            .enumerate()
            .map(|(n, (_, _, y))| (cells.of(y) as u32, n as u32))
            .collect();
        keys.sort_unstable();
        self.order.clear();
        self.base.clear();
        self.then.clear();
        for &(_, n) in &keys {
            let (slot, base, y) = atoms[n as usize];
            self.order.push(slot);
            self.base.push(base);
            self.then.push(y);
        }
        self.position.clear();
        self.position.extend_from_slice(&self.then);
        let nowhere = [NOWHERE * self.reach; 4];
        self.position.resize(self.first_ghost(), nowhere);
        self.find_ghosts();
        self.position.push(nowhere);
        if nan {
            // nothing can be said; the forces will not be numbers either
            self.blocks.iter_mut().for_each(|b| *b = Block::default());
        }
        let sorted = cells.sort(&self.position, self.order.len(), self.first_ghost());
        let mut blocks = std::mem::take(&mut self.blocks);
        let kernel = Find {
            cells: &cells,
            sorted: &sorted,
            position: &self.position,
            own: self.order.len(),
            square: self.reach * self.reach,
            blocks: Shared(blocks.as_mut_ptr()),
        };
        for_each_block(simd, &kernel, &mut vec![(); blocks.len()]);
        self.blocks = blocks;
        self.valid = !nan;
        self.builds += 1;
    }

    /// Images of the atoms within reach of the box, axis by axis, images of images included.
    fn find_ghosts(&mut self) {
        self.ghosts.clear();
        let first = self.first_ghost();
        for a in 0..D {
            let Some(p) = self.period[a] else { continue };
            for n in 0..first + self.ghosts.len() {
                if n >= self.order.len() && n < first {
                    continue;
                }
                let x = self.position[n];
                for shift in [p, -p] {
                    let image = x[a] + shift;
                    if image >= -self.reach && image < p + self.reach {
                        let mut y = x;
                        y[a] = image;
                        self.position.push(y);
                        self.ghosts.push((
                            n as u32,
                            std::array::from_fn(|b| if b == a { shift } else { 0.0 }),
                        ));
                    }
                }
            }
        }
    }

    /// Blocks of work: how many, and the tiles of one with their lines.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Tiles of block `b`: number of the tile, its lines.
    #[inline(always)]
    pub fn tiles(&self, b: usize) -> impl Iterator<Item = (usize, &[[u32; TILE]])> {
        let block = &self.blocks[b];
        let mut start = 0;
        block.ends.iter().enumerate().map(move |(n, &end)| {
            let lines = &block.lines[start..end as usize];
            start = end as usize;
            (b * BLOCK + n, lines)
        })
    }

    /// Slots of a tile's atoms.
    #[inline(always)]
    pub fn slots(&self, tile: usize) -> &[u32] {
        &self.order[tile * TILE..((tile + 1) * TILE).min(self.order.len())]
    }

    /// Positions of all atoms, ghosts and nowhere.
    #[inline(always)]
    pub fn positions(&self) -> &[[f64; 4]] {
        &self.position
    }

    /// The same, to write the fourth number of own atoms.
    pub fn positions_mut(&mut self) -> &mut [[f64; 4]] {
        &mut self.position
    }

    /// The atom that a listed one is or copies.
    pub fn original(&self, mut atom: usize) -> Option<usize> {
        let first = self.first_ghost();
        while atom >= first {
            atom = self.ghosts.get(atom - first)?.0 as usize;
        }
        self.order.get(atom).map(|s| *s as usize)
    }

    /// How often the list was made.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    pub fn bytes(&self) -> usize {
        self.blocks
            .iter()
            .map(|b| 4 * TILE * b.lines.capacity() + 4 * b.ends.capacity())
            .sum::<usize>()
            + 32 * (self.base.capacity() + self.then.capacity() + self.position.capacity())
            + 4 * self.order.capacity()
            + size_of::<(u32, [f64; D])>() * self.ghosts.capacity()
    }
}

/// Makes the lists of a block of tiles.
struct Find<'a, const D: usize> {
    cells: &'a Cells<D>,
    sorted: &'a Sorted<D>,
    position: &'a [[f64; 4]],
    own: usize,
    square: f64,
    blocks: Shared<Block>,
}

impl<const D: usize> Find<'_, D> {
    /// The atoms within reach of atom `i`, itself left out; returns how many.
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
            let (first, last) = self.cells.run(n, &low, &high, self.sorted);
            row.reserve(last - first);
            let mut k = first;
            while k < last {
                let mut q = L::splat(0.0);
                for a in 0..D {
                    // SAFETY: there is room for a tile after the last atom
                    let d = unsafe { L::load(self.sorted.position[a].as_ptr().add(k)) } - center[a];
                    q = d.fma(d, q);
                }
                let mut near = L::bits(q.lt(L::splat(self.square)));
                if last - k < TILE {
                    near &= (1 << (last - k)) - 1;
                }
                while near != 0 {
                    let j = self.sorted.atom[k + near.trailing_zeros() as usize];
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
        let dummy = (self.position.len() - 1) as u32;
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
            block.lines.resize(first + longest, [dummy; TILE]);
            for (l, row) in rows.iter().enumerate() {
                for (line, j) in block.lines[first..].iter_mut().zip(row) {
                    line[l] = *j;
                }
            }
            block.ends.push(block.lines.len() as u32);
        }
    }
}

/// Small cells over the box, its margin, or the extent of free atoms.
struct Cells<const D: usize> {
    low: [f64; D],
    inverse: [f64; D],
    count: [usize; D],
}

/// All atoms in order of cells.
struct Sorted<const D: usize> {
    start: Vec<u32>,
    atom: Vec<u32>,
    /// With room to read a whole tile at the end.
    position: [Vec<f64>; D],
}

impl<const D: usize> Cells<D> {
    fn new(atoms: &[(u32, [f64; 4], [f64; 4])], reach: f64, period: &[Option<f64>; D]) -> Self {
        let mut cells = Cells {
            low: [0.0; D],
            inverse: [1.0; D],
            count: [1; D],
        };
        // at most four cells per atom: atoms that flew away must not cost memory
        let most = ((4 * atoms.len() + 1000) as f64).powf(1.0 / D as f64);
        for a in 0..D {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            if let Some(p) = period[a] {
                (low, high) = (-reach, p + reach);
            } else {
                for (_, _, y) in atoms {
                    low = low.min(y[a]);
                    high = high.max(y[a]);
                }
            }
            if !(low.is_finite() && high.is_finite()) {
                (low, high) = (0.0, reach);
            }
            let length = (high - low).max(reach);
            let count = (length / reach * PER as f64)
                .floor()
                .clamp(1.0, most.max(1.0));
            cells.low[a] = low;
            cells.inverse[a] = count / length;
            cells.count[a] = count as usize;
        }
        cells
    }

    fn along(&self, y: &[f64; 4], a: usize) -> usize {
        let c = ((y[a] - self.low[a]) * self.inverse[a]).floor();
        c.clamp(0.0, self.count[a] as f64 - 1.0) as usize
    }

    fn of(&self, y: &[f64; 4]) -> usize {
        (0..D)
            .rev()
            .fold(0, |c, a| c * self.count[a] + self.along(y, a))
    }

    /// Of `own` atoms and of the ghosts from `ghosts` on; the last position is nowhere.
    fn sort(&self, position: &[[f64; 4]], own: usize, ghosts: usize) -> Sorted<D> {
        let there = || {
            let atoms = (0..own).chain(ghosts..position.len() - 1);
            atoms.map(|n| (n, &position[n]))
        };
        let mut start = vec![0u32; self.count.iter().product::<usize>() + 1];
        for (_, y) in there() {
            start[self.of(y) + 1] += 1;
        }
        for c in 1..start.len() {
            start[c] += start[c - 1];
        }
        let total = start.last().copied().unwrap_or(0) as usize;
        let mut next = start.clone();
        let mut atom = vec![0; total];
        let mut sorted: [Vec<f64>; D] = std::array::from_fn(|_| vec![0.0; total + TILE]);
        for (n, y) in there() {
            let k = &mut next[self.of(y)];
            atom[*k as usize] = n as u32;
            for a in 0..D {
                sorted[a][*k as usize] = y[a];
            }
            *k += 1;
        }
        Sorted {
            start,
            atom,
            position: sorted,
        }
    }

    /// The lowest and highest cells that are within reach of `y`.
    #[inline(always)]
    fn around(&self, y: &[f64; 4]) -> ([usize; D], [usize; D]) {
        let (mut low, mut high) = ([0; D], [0; D]);
        for a in 0..D {
            let c = self.along(y, a);
            (low[a], high[a]) = (c.saturating_sub(PER), (c + PER).min(self.count[a] - 1));
        }
        (low, high)
    }

    /// Rows of cells along x in a box of cells.
    #[inline(always)]
    fn rows(low: &[usize; D], high: &[usize; D]) -> usize {
        let mut rows = 1;
        for a in 1..D {
            rows *= high[a] - low[a] + 1;
        }
        rows
    }

    /// Sorted atoms of row `n` of a box of cells.
    #[inline(always)]
    fn run(
        &self,
        n: usize,
        low: &[usize; D],
        high: &[usize; D],
        sorted: &Sorted<D>,
    ) -> (usize, usize) {
        let (mut rest, mut row) = (n, 0);
        let mut at = [0; D];
        for a in 1..D {
            let width = high[a] - low[a] + 1;
            at[a] = low[a] + rest % width;
            rest /= width;
        }
        for a in (1..D).rev() {
            row = (row + at[a]) * self.count[a - 1];
        }
        (
            sorted.start[row + low[0]] as usize,
            sorted.start[row + high[0] + 1] as usize,
        )
    }
}

struct Place<'a, const D: usize> {
    order: &'a [u32],
    base: &'a [[f64; 4]],
    then: &'a [[f64; 4]],
    u: &'a Field<D>,
    position: Shared<[f64; 4]>,
}

impl<const D: usize> Kernel for Place<'_, D> {
    type Out = f64;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> f64 {
        let atoms = block * BLOCK * TILE..((block + 1) * BLOCK * TILE).min(self.order.len());
        let mut far: f64 = 0.0;
        for i in atoms {
            let slot = self.order[i] as usize;
            let mut square = 0.0;
            for a in 0..D {
                let y = self.base[i][a] + self.u[a][slot];
                // SAFETY: blocks are disjoint, and own atoms come first
                unsafe { (*self.position.at(i))[a] = y };
                let d = y - self.then[i][a];
                square += d * d;
            }
            // what is not a number is far
            far = if square <= far {
                far
            } else if square.is_nan() {
                f64::INFINITY
            } else {
                square
            };
        }
        far
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<const D: usize>(n: usize, length: f64, periodic: bool) {
        let mut x = vec![];
        let mut seed = 1u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..n {
            x.push(std::array::from_fn(|a| {
                if a < D { length * random() } else { 0.0 }
            }));
        }
        let period = [periodic.then_some(length); D];
        let body = Body::<D>::from_cloud(&x, &vec![1.0; n], &[], 0.1 * length, period).unwrap();
        let mut u = body.at_rest();
        let (cutoff, skin) = (0.21 * length, 0.05 * length);
        let mut list = NearList::new(&body, cutoff, skin);
        for round in 0..4 {
            list.update(&body, &u, Simd::detect());
            let mut found = vec![];
            for b in 0..list.blocks() {
                for (t, lines) in list.tiles(b) {
                    for line in lines {
                        for (l, &slot) in list.slots(t).iter().enumerate() {
                            let (p, q) = (
                                list.positions()[t * TILE + l],
                                list.positions()[line[l] as usize],
                            );
                            let r2: f64 = (0..D).map(|a| (p[a] - q[a]).powi(2)).sum();
                            if r2 < cutoff * cutoff {
                                found.push((
                                    slot as usize,
                                    list.original(line[l] as usize).unwrap(),
                                ));
                            }
                        }
                    }
                }
            }
            found.sort_unstable();
            let mut exact = vec![];
            for i in &body.slots {
                for j in &body.slots {
                    let (i, j) = (*i as usize, *j as usize);
                    let (p, q) = (body.position(i), body.position(j));
                    let r2: f64 = (0..D)
                        .map(|a| {
                            let mut d = p[a] + u[a][i] - q[a] - u[a][j];
                            if periodic {
                                d -= length * (d / length).round();
                            }
                            d * d
                        })
                        .sum();
                    if i != j && r2 < cutoff * cutoff {
                        exact.push((i, j));
                    }
                }
            }
            exact.sort_unstable();
            assert!(
                found == exact,
                "{D}-D, periodic {periodic}, round {round}: {} pairs, not {}",
                found.len(),
                exact.len()
            );
            for c in &mut u {
                for &s in &body.slots {
                    c[s as usize] += (random() - 0.5) * 0.04 * length * round as f64;
                }
            }
        }
        assert!(list.builds() > 1);
    }

    #[test]
    fn the_list_is_that_of_all_pairs() {
        for periodic in [false, true] {
            check::<1>(40, 7.0, periodic);
            check::<2>(150, 3.0, periodic);
            check::<3>(300, 5.0, periodic);
        }
    }
}
