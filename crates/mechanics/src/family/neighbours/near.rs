//! The full list of near atoms: every atom with all others closer than a cut-off, found anew when somebody has moved far
//! enough. What molecular dynamics sweeps over.
//!
//! Atoms are kept in order of small cells, in tiles of eight, so that neighbours lie close in memory; periodic images within
//! reach of the box are atoms of their own (ghosts) with copied positions. A tile's lists are stored line by line: line n
//! holds the n-th neighbour of each of its eight atoms, or an atom infinitely far away.
//!
//! Of several kinds there are two ways ([`Lines`]). By kind, the atoms of a tile are all of one, and so are the neighbours of a line, so
//! that a pair of kinds is known before its numbers are read; lines of a tile come in order of the neighbours' kinds, and each kind fills
//! up its own last lines. Mixed, atoms stand and are listed as if they were of one kind, and their fourth number says which.
//!
//! Families of the reference are the same list, made once and held.
//!
//! # The order of sums
//!
//! An atom's neighbours are added in the order of its lines. That is a function of where atoms were when the list was made, and of ids alone, not of threads,
//! lists before it, or how atoms lie in memory: neighbours come by cells (x first, then y, then z), in a cell the atoms of the box by id, then images by cell and
//! id of what they copy; kind by kind where lines are. Tiles stand in the same order.
//!
//! It is not the order of the cells of *now*. While the list holds, atoms pass from cell to cell; to sort every line again in every step would cost what the list
//! saves. Nor would an order by ids alone free sums from the last list: which image of an atom stands in the box (`base`), and so how distances are
//! rounded, is of then, too. So displacements of then are state: a checkpoint has them in place of the list, which is made of them again. Of a
//! list that is held the bonds that are left are state.
//!
//! # Ranks
//!
//! Atoms on many ranks have the same order, since
//! - all make their lists in the same step: the farthest of all atoms decides, not that of a rank;
//! - cells are those of the whole body: the extent along free axes, and the number of atoms, are of all;
//! - atoms that come from other ranks ([`foreign`]) stand among the own ones, by cell and id, before images: what is an image says the box, not who keeps the atom;
//! - fourth numbers are copied where [`NearList::copy_fourth`] is called, between the passes of a potential, from those who computed them;
//! - totals are sums without rounding of what each atom says, whatever tiles and blocks it stands in.
//!
//! Where an atom feels what its neighbours feel of each other, the lists of these neighbours are made, too ([`NearList::wide`]), so that nothing is sent back.
//! Atoms of other ranks that are near in the reference are called by the slots of their copies where families are held; else by their ids after all slots
//! ([`Body::id_of`]).

mod build;
mod cells;
mod foreign;
mod images;
#[cfg(test)]
mod tests;

use crate::body::{Body, FieldView, view};
use crate::execute::blocks::{PerBlock, Shared};
use crate::execute::lane::{Lane, TILE};
use crate::execute::simd::{Kernel, Simd};
use crate::state::Archive;
use build::Block;
use cells::NOBODY;
use foreign::Foreign;
use images::Image;

/// Tiles per block of work.
const BLOCK: usize = 32;

/// How far the pairs of kinds of atoms see each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaches {
    kinds: usize,
    /// `[i][j]`: length; 0: not at all.
    of: Vec<f64>,
}

impl Reaches {
    /// Of kinds 0 to `kinds` − 1; who sees is seen.
    pub fn new(kinds: usize, of: impl Fn(usize, usize) -> f64) -> Reaches {
        let of = |n| of(n / kinds, n % kinds).max(of(n % kinds, n / kinds));
        Reaches {
            kinds,
            of: (0..kinds * kinds).map(of).collect(),
        }
    }

    /// The greatest of them.
    pub fn longest(&self) -> f64 {
        self.of.iter().copied().fold(0.0, f64::max)
    }

    fn are_equal(&self) -> bool {
        self.of.iter().all(|r| *r == self.of[0])
    }

    fn between(&self, i: u8, j: u8) -> f64 {
        self.of[usize::from(i) * self.kinds + usize::from(j)]
    }
}

/// Who stands in a tile and in a line of atoms of several kinds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lines {
    /// Atoms of one kind.
    ByKind,
    /// Atoms of any; the list writes kinds into their fourth numbers.
    Mixed,
}

/// Eight atoms, by kind all of one, with who is near to them.
#[derive(Debug, Clone, Copy)]
pub struct Tile<'a> {
    pub number: usize,
    /// Of its own atoms, by kind.
    pub kind: usize,
    lines: &'a [[u32; TILE]],
    /// `[groups]`: where the lines of each kind of neighbours end, counted as the block does.
    ends: &'a [u32],
    /// Where the first begins.
    start: usize,
}

impl<'a> Tile<'a> {
    /// Lines of neighbours of all kinds.
    #[inline(always)]
    pub fn lines(&self) -> &'a [[u32; TILE]] {
        self.lines
    }

    /// Those of one kind.
    #[inline(always)]
    pub fn of_kind(&self, kind: usize) -> &'a [[u32; TILE]] {
        let end = self.ends[kind] as usize - self.start;
        let first = match kind {
            0 => 0,
            _ => self.ends[kind - 1] as usize - self.start,
        };
        &self.lines[first..end]
    }
}

/// The full list.
#[derive(Debug)]
pub struct NearList<const D: usize> {
    /// The greatest of all, with the margin.
    reach: f64,
    reaches: Reaches,
    lines: Lines,
    skin: f64,
    period: [Option<f64>; D],
    /// Slot of every atom, in order of kinds (unless these are mixed) and cells; [`NOBODY`] where the last tile of a kind ends.
    order: Vec<u32>,
    /// Kinds of all that have positions; empty where there is one.
    kind: Vec<u8>,
    /// `[own][4]`: what to add to the displacement to be inside the box.
    base: Vec<[f64; 4]>,
    /// `[own][4]`: positions when the list was made.
    then: Vec<[f64; 4]>,
    /// `[D][slots]`: displacements then, unless it is held.
    made_at: [Vec<f64>; D],
    foreign: Foreign<D>,
    images: Vec<Image<D>>,
    /// `[own in whole tiles, those of other ranks, images, nowhere][4]`: positions; the fourth number is the user's, or the kind where lines are mixed.
    position: Vec<[f64; 4]>,
    blocks: Vec<Block>,
    moved: PerBlock<f64>,
    valid: bool,
    /// Once made it stays, wherever atoms go.
    held: bool,
    /// Of other ranks' atoms that are near the lists are made, too.
    wide: bool,
    /// Slots of the body.
    slots: usize,
    builds: u64,
}

impl<const D: usize> NearList<D> {
    /// For pairs closer than `cutoff`, with a margin `skin` (lengths). Periods must be at least twice the cut-off; the
    /// margin is made smaller where they leave less.
    pub fn new(body: &Body<D>, cutoff: f64, skin: f64) -> Self {
        Self::of_kinds(body, Reaches::new(1, |_, _| cutoff), skin, Lines::ByKind)
    }

    /// The same for pairs closer than what their kinds reach: materials of the body, or all are of one kind.
    pub fn of_kinds(body: &Body<D>, reaches: Reaches, skin: f64, lines: Lines) -> Self {
        let cutoff = reaches.longest();
        let shortest = body
            .period
            .iter()
            .flatten()
            .copied()
            .fold(f64::INFINITY, f64::min);
        let skin = skin.min(shortest - cutoff).max(0.0);
        let mut of_kind = vec![0usize; reaches.kinds];
        match (reaches.kinds, lines) {
            (1, _) | (_, Lines::Mixed) => of_kind[0] = body.points(),
            _ => { body.slots.iter() }.for_each(|s| of_kind[body.material_of(*s as usize)] += 1),
        }
        let tiles: usize = of_kind.iter().map(|n| n.div_ceil(TILE)).sum();
        let blocks = tiles.div_ceil(BLOCK);
        NearList {
            reach: cutoff + skin,
            reaches,
            lines,
            skin,
            period: body.period,
            order: vec![],
            kind: vec![],
            base: vec![],
            then: vec![],
            made_at: crate::array::from_fn(|_| vec![]),
            foreign: Foreign::default(),
            images: vec![],
            position: vec![],
            blocks: vec![Block::default(); blocks],
            moved: PerBlock::new(blocks, 0.0),
            valid: false,
            held: false,
            wide: false,
            slots: body.len,
            builds: 0,
        }
    }

    /// The families of the reference: who is within `reaches` at the first [update](Self::update) is listed for ever, and nobody else.
    pub fn of_reference(body: &Body<D>, reaches: Reaches, lines: Lines) -> Self {
        NearList {
            held: true,
            ..Self::of_kinds(body, reaches, 0.0, lines)
        }
    }

    /// Of other ranks' atoms that are near own ones the lists are made, too: [`lines`](Self::lines) of tiles without [`slots`](Self::slots).
    pub fn wide(self) -> Self {
        NearList { wide: true, ..self }
    }

    /// Positions at displacement `u`, and a list that holds for them. Returns whether it was made anew.
    pub fn update(&mut self, body: &Body<D>, u: FieldView<D>, simd: Simd) -> bool {
        let mut position = std::mem::take(&mut self.position);
        let holds = self.valid && self.place(u, simd, &mut position);
        self.position = position;
        if !holds {
            self.build(body, u, simd);
        }
        !holds
    }

    /// The [positions](Self::positions) at displacement `u`, if the list holds for them.
    pub fn positions_at(&self, u: FieldView<D>, simd: Simd) -> Option<Vec<[f64; 4]>> {
        let mut position = self.position.clone();
        (self.valid && self.place(u, simd, &mut position)).then_some(position)
    }

    /// Where atoms were when the list was made, of which it is made again, the same to the last bit, and where they are.
    pub fn archive(&mut self, body: &Body<D>, simd: Simd, archive: &mut Archive<'_>) {
        if !self.held {
            for column in &mut self.made_at {
                body.archive_points(archive, "made_at", (column, 1), |slot, _| slot);
            }
            if archive.loads() {
                let then = self.made_at.clone();
                self.build(body, view(&then), simd);
            }
        }
        let own = self.by_slot();
        let at = |slot: usize, n: usize| 4 * own[slot] as usize + n;
        let position = self.position.as_flattened_mut();
        body.archive_points(archive, "positions", (position, 4), at);
        if archive.loads() {
            let mut position = std::mem::take(&mut self.position);
            self.fill(&mut position);
            self.position = position;
        }
    }

    /// By slot of the body: the listed atom.
    pub fn by_slot(&self) -> Vec<u32> {
        let mut own = vec![NOBODY; self.slots];
        for (n, slot) in self.order.iter().enumerate().filter(|(_, s)| **s != NOBODY) {
            own[*slot as usize] = n as u32;
        }
        own
    }

    /// Write positions; does the list hold for them?
    fn place(&self, u: FieldView<D>, simd: Simd, position: &mut [[f64; 4]]) -> bool {
        let kernel = Place {
            order: &self.order,
            base: &self.base,
            then: &self.then,
            u,
            position: Shared(position.as_mut_ptr()),
        };
        let far = self.moved.fold(simd, &kernel, |far, d| *far = far.max(d));
        self.foreign.follow(position);
        images::refresh(&self.images, self.first_image(), position);
        // what is not a number is far
        let is_far = !(far <= 0.25 * self.skin * self.skin);
        self.held || !self.foreign.ghosts().any(is_far)
    }

    /// Records of own atoms into those of all that copy them, moved as these are. All ranks come here at once.
    pub fn fill(&self, all: &mut [[f64; 4]]) {
        self.foreign.follow(all);
        self.foreign.copy_fourth(all);
        images::refresh(&self.images, self.first_image(), all);
    }

    /// Copy the fourth number of every atom to those that are copies of it. All ranks come here at once.
    pub fn copy_fourth(&mut self) {
        let mut position = std::mem::take(&mut self.position);
        self.fill_fourth(&mut position);
        self.position = position;
    }

    /// The same in other records of all that are listed.
    pub fn fill_fourth(&self, all: &mut [[f64; 4]]) {
        self.foreign.copy_fourth(all);
        let (atoms, copies) = all.split_at_mut(self.first_image());
        for (copy, image) in copies.iter_mut().zip(&self.images) {
            copy[3] = atoms[image.of as usize][3];
        }
    }

    fn first_foreign(&self) -> usize {
        self.order.len().next_multiple_of(TILE)
    }

    fn first_image(&self) -> usize {
        self.first_foreign() + self.foreign.len()
    }

    /// Blocks of work: how many, and the tiles of one with their lines.
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Tiles of block `b`: number of the tile, its lines.
    #[inline(always)]
    pub fn tiles(&self, b: usize) -> impl Iterator<Item = (usize, &[[u32; TILE]])> {
        self.tiles_of_kinds(b)
            .map(|tile| (tile.number, tile.lines()))
    }

    /// The same with kinds.
    #[inline(always)]
    pub fn tiles_of_kinds(&self, b: usize) -> impl Iterator<Item = Tile<'_>> {
        self.blocks[b].tiles(self.groups(), b * BLOCK, &self.kind)
    }

    /// Groups in which neighbours are found and listed.
    fn groups(&self) -> usize {
        match self.lines {
            Lines::ByKind => self.reaches.kinds,
            Lines::Mixed => 1,
        }
    }

    /// Kind of a listed atom.
    pub fn kind(&self, atom: usize) -> usize {
        self.kind.get(atom).map_or(0, |k| usize::from(*k))
    }

    /// Lines of one tile.
    #[inline(always)]
    pub fn lines(&self, tile: usize) -> &[[u32; TILE]] {
        self.blocks[tile / BLOCK].tile(tile % BLOCK, self.groups())
    }

    /// The same, to take somebody out: in its place [`nowhere`](Self::nowhere). Lists that are not held name everybody again when they are
    /// made anew.
    pub fn lines_mut(&mut self, tile: usize) -> &mut [[u32; TILE]] {
        let groups = self.groups();
        self.blocks[tile / BLOCK].tile_mut(tile % BLOCK, groups)
    }

    /// The listed atom that is nobody.
    #[inline(always)]
    pub fn nowhere(&self) -> u32 {
        (self.position.len() - 1) as u32
    }

    /// Slots of a tile's own atoms.
    #[inline(always)]
    pub fn slots(&self, tile: usize) -> &[u32] {
        let own = self.order.len();
        let slots = &self.order[(tile * TILE).min(own)..((tile + 1) * TILE).min(own)];
        match slots.last() {
            Some(&NOBODY) => {
                let end = slots.iter().position(|s| *s == NOBODY);
                &slots[..end.unwrap_or(TILE)]
            }
            _ => slots,
        }
    }

    /// Positions of all atoms, images and nowhere.
    #[inline(always)]
    pub fn positions(&self) -> &[[f64; 4]] {
        &self.position
    }

    /// The same, to write the fourth number of own atoms.
    pub fn positions_mut(&mut self) -> &mut [[f64; 4]] {
        &mut self.position
    }

    /// The atom of the box that a listed one is or copies.
    #[inline(always)]
    pub fn home(&self, atom: usize) -> Option<usize> {
        let home = match atom.checked_sub(self.first_image()) {
            None => atom,
            Some(image) => self.images.get(image)?.of as usize,
        };
        let there = match home.checked_sub(self.first_foreign()) {
            None => self.order.get(home).is_some_and(|slot| *slot != NOBODY),
            Some(n) => self.foreign.ghost(n).is_some(),
        };
        there.then_some(home)
    }

    /// Has an atom of the box a list?
    #[inline(always)]
    pub fn has_list(&self, home: usize) -> bool {
        home < self.first_foreign() + self.foreign.centres()
    }

    /// Slot of the atom that a listed one is or copies; another rank's as [above](self).
    pub fn original(&self, atom: usize) -> Option<usize> {
        let home = self.home(atom)?;
        let Some(n) = home.checked_sub(self.first_foreign()) else {
            return Some(self.order[home] as usize);
        };
        let ghost = self.foreign.ghost(n)?;
        let ghosts = self.foreign.ghosts();
        let copy = if self.held { ghosts.copy(ghost) } else { None };
        Some(copy.unwrap_or_else(|| self.slots + ghosts.all()[ghost].id as usize))
    }

    /// Atoms of a tile.
    #[inline(always)]
    pub fn lanes(&self, tile: usize) -> usize {
        match tile * TILE < self.order.len() {
            true => self.slots(tile).len(),
            false => (0..TILE)
                .filter(|l| self.home(tile * TILE + l).is_some())
                .count(),
        }
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
            + 8 * self.made_at.iter().map(Vec::capacity).sum::<usize>()
            + self.kind.capacity()
            + size_of::<Image<D>>() * self.images.capacity()
            + self.foreign.bytes()
    }
}

/// Where the atom of a slot is.
#[inline(always)]
fn position<const D: usize>(base: &[f64; 4], u: FieldView<D>, slot: u32) -> [f64; 4] {
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
    u: FieldView<'a, D>,
    position: Shared<[f64; 4]>,
}

impl<const D: usize> Kernel for Place<'_, D> {
    type Out = f64;
    type Home = Self;
    #[inline(always)]
    fn block<L: Lane>(&self, block: usize) -> f64 {
        let mut far: f64 = 0.0;
        for i in atoms_of(block, self.order.len()) {
            if self.order[i] == NOBODY {
                continue;
            }
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
