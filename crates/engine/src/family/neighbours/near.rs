//! The full list of near atoms: every atom with all others closer than a cut-off, found anew when somebody has moved far
//! enough. What molecular dynamics sweeps over.
//!
//! Atoms are kept in order of small cells, in tiles of eight, so that neighbours lie close in memory; periodic images within
//! reach of the box are atoms of their own (ghosts) with copied positions. A tile's lists are stored line by line: line n
//! holds the n-th neighbour of each of its eight atoms, or an atom infinitely far away.

mod build;
mod cells;
mod ghosts;
#[cfg(test)]
mod tests;

use crate::body::{Body, Field};
use crate::execute::blocks::{PerBlock, Shared};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use build::Block;
use ghosts::Ghost;

/// Tiles per block of work.
const BLOCK: usize = 32;

/// The full list.
#[derive(Debug)]
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
    ghosts: Vec<Ghost<D>>,
    /// `[own in whole tiles, ghosts, nowhere][4]`: positions; the fourth number is the user's.
    position: Vec<[f64; 4]>,
    blocks: Vec<Block>,
    moved: PerBlock<f64>,
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
        let blocks = body.points().div_ceil(TILE).div_ceil(BLOCK);
        NearList {
            reach: cutoff + skin,
            skin,
            period: body.period,
            order: vec![],
            base: vec![],
            then: vec![],
            ghosts: vec![],
            position: vec![],
            blocks: vec![Block::default(); blocks],
            moved: PerBlock::new(blocks, 0.0),
            valid: false,
            builds: 0,
        }
    }

    /// Positions at displacement `u`, and a list that holds for them. Returns whether it was made anew.
    pub fn update(&mut self, body: &Body<D>, u: &Field<D>, simd: Simd) -> bool {
        let mut position = std::mem::take(&mut self.position);
        let holds = self.valid && self.place(u, simd, &mut position);
        self.position = position;
        if !holds {
            self.build(body, u, simd);
        }
        !holds
    }

    /// The [positions](Self::positions) at displacement `u`, if the list holds for them.
    pub fn positions_at(&self, u: &Field<D>, simd: Simd) -> Option<Vec<[f64; 4]>> {
        let mut position = self.position.clone();
        (self.valid && self.place(u, simd, &mut position)).then_some(position)
    }

    /// Write positions; does the list hold for them?
    fn place(&self, u: &Field<D>, simd: Simd, position: &mut [[f64; 4]]) -> bool {
        let kernel = Place {
            order: &self.order,
            base: &self.base,
            then: &self.then,
            u,
            position: Shared(position.as_mut_ptr()),
        };
        let far = self.moved.fold(simd, &kernel, |far, d| *far = far.max(d));
        ghosts::refresh(&self.ghosts, self.first_ghost(), position);
        far <= 0.25 * self.skin * self.skin
    }

    /// Copy the fourth number of every atom to its ghosts.
    pub fn copy_to_ghosts(&mut self) {
        let first = self.first_ghost();
        ghosts::refresh(&self.ghosts, first, &mut self.position);
    }

    fn first_ghost(&self) -> usize {
        self.order.len().div_ceil(TILE) * TILE
    }

    /// Blocks of work: how many, and the tiles of one with their lines.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Tiles of block `b`: number of the tile, its lines.
    #[inline(always)]
    pub fn tiles(&self, b: usize) -> impl Iterator<Item = (usize, &[[u32; TILE]])> {
        let tiles = self.blocks[b].tiles().enumerate();
        tiles.map(move |(n, lines)| (b * BLOCK + n, lines))
    }

    /// Lines of one tile.
    #[inline(always)]
    pub fn lines(&self, tile: usize) -> &[[u32; TILE]] {
        self.blocks[tile / BLOCK].tile(tile % BLOCK)
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

    /// The own atom that a listed one is or copies.
    #[inline(always)]
    pub fn home(&self, atom: usize) -> Option<usize> {
        let own = match atom.checked_sub(self.first_ghost()) {
            None => atom,
            Some(ghost) => self.ghosts.get(ghost)?.of as usize,
        };
        (own < self.order.len()).then_some(own)
    }

    /// Slot of the atom that a listed one is or copies.
    pub fn original(&self, atom: usize) -> Option<usize> {
        self.home(atom).map(|own| self.order[own] as usize)
    }

    /// How often the list was made.
    #[cfg(test)]
    pub fn builds(&self) -> u64 {
        self.builds
    }

    pub fn bytes(&self) -> usize {
        self.blocks.iter().map(Block::bytes).sum::<usize>()
            + 32 * (self.base.capacity() + self.then.capacity() + self.position.capacity())
            + 4 * self.order.capacity()
            + size_of::<Ghost<D>>() * self.ghosts.capacity()
    }
}

/// Where the atom of a slot is.
#[inline(always)]
fn position<const D: usize>(base: &[f64; 4], u: &Field<D>, slot: u32) -> [f64; 4] {
    let mut y = [0.0; 4];
    for a in 0..D {
        y[a] = base[a] + u[a][slot as usize];
    }
    y
}

/// Writes positions of own atoms; how far the farthest is from where it was, squared (∞ if one is nowhere).
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
        let mut far: f64 = 0.0;
        for i in atoms_of(block, self.order.len()) {
            let y = position(&self.base[i], self.u, self.order[i]);
            let mut square = 0.0;
            for a in 0..D {
                // SAFETY: blocks are disjoint, and own atoms come first
                unsafe { (*self.position.at(i))[a] = y[a] };
                let d = y[a] - self.then[i][a];
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

/// The atoms of a block, of `own` in all.
fn atoms_of(block: usize, own: usize) -> std::ops::Range<usize> {
    block * BLOCK * TILE..((block + 1) * BLOCK * TILE).min(own)
}
