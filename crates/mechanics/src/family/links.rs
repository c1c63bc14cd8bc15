//! The bonds of a lattice body, for laws that remember nothing of them: offsets, and who is there.

use super::stencil::Stencil;
use crate::body::{Body, FieldView, Grid, Identity, Layout};
use crate::execute::lane::{Lane, TILE};
use std::collections::HashMap;
use std::ops::Range;

/// One bond of a stencil.
#[derive(Debug, Clone, Copy)]
pub struct Link<const D: usize> {
    /// Slots from here to there.
    pub shift: isize,
    /// Reference vector to the partner (length).
    pub xi: [f64; D],
    /// Cells to the partner.
    pub cell: [i32; D],
    /// Sublattice of the partner.
    pub to: usize,
}

impl<const D: usize> Link<D> {
    /// The partner of a slot's point along this bond (it may be an image).
    pub fn partner(&self, grid: &Grid<D>, slot: usize) -> Option<usize> {
        grid.neighbour(slot, self.cell, self.to)
    }
}

/// All bonds of a lattice body.
#[derive(Debug, Clone)]
pub struct Links<const D: usize> {
    /// The body whose bonds these are.
    pub body: Identity,
    /// Per sublattice.
    pub links: Vec<Vec<Link<D>>>,
    /// Tiles that have points.
    pub tiles: Vec<u32>,
    /// Where each block of work begins in `tiles`, and where the last ends.
    starts: Vec<u32>,
    /// Per tile of `tiles`: where its bits, which others may have, too, begin in `bits`; [`WHOLE`] if all its eight points have all their partners.
    begin: Vec<u32>,
    /// Per bond of tiles that are not whole: which of the eight points have it.
    bits: Vec<u8>,
    directed: u64,
}

const WHOLE: u32 = u32::MAX;

impl<const D: usize> Links<D> {
    /// All bonds of `stencil` between points of `body`, which lies on a grid.
    pub fn new(body: &Body<D>, grid: &Grid<D>, stencil: &Stencil) -> Links<D> {
        let (h, edges) = (grid.lattice.spacing, grid.lattice.kind.edges());
        let links: Vec<Vec<Link<D>>> = stencil
            .offsets
            .iter()
            .enumerate()
            .map(|(from, list)| {
                list.iter()
                    .map(|o| {
                        let cell: [i32; D] = crate::array::from_fn(|a| o.cell[a]);
                        Link {
                            shift: grid.shift(cell.map(i64::from), o.to as i64 - from as i64)
                                as isize,
                            xi: crate::array::from_fn(|a| {
                                h * edges[a] * (o.quarter[a] as f64 / 4.0)
                            }),
                            cell,
                            to: o.to,
                        }
                    })
                    .collect()
            })
            .collect();
        let tiles: Vec<u32> = (0..grid.tiles())
            .filter(|t| grid.owned[*t] != 0)
            .map(|t| t as u32)
            .collect();
        let mut cells = links.iter().flatten().map(|l| l.cell);
        assert!(
            cells.all(|c| grid.holds(c)),
            "the body was made for shorter bonds"
        );
        let mut made = Links {
            body: body.identity,
            links,
            starts: grid.blocks_of(&tiles),
            begin: Vec::with_capacity(tiles.len()),
            bits: vec![],
            tiles,
            directed: 0,
        };
        let mut row = vec![];
        // tiles along a surface have the same bonds
        let mut known: HashMap<Vec<u8>, u32> = HashMap::new();
        for &t in &made.tiles {
            let first = grid.tile_slot(t as usize);
            let links = &made.links[grid.tile_sublattice(t as usize)];
            row.clear();
            row.resize(links.len(), 0u8);
            for l in (0..TILE).filter(|l| grid.is_owned(first + l)) {
                for (bits, link) in row.iter_mut().zip(links) {
                    *bits |= u8::from(link.partner(grid, first + l).is_some()) << l;
                }
            }
            made.directed += row.iter().map(|b| u64::from(b.count_ones())).sum::<u64>();
            let begin = match known.get(&row) {
                _ if row.iter().all(|b| *b == 0xff) => WHOLE,
                Some(begin) => *begin,
                None => {
                    let begin = made.bits.len() as u32;
                    made.bits.extend_from_slice(&row);
                    known.insert(row.clone(), begin);
                    begin
                }
            };
            made.begin.push(begin);
        }
        debug_assert!(body.volume.uniform().is_some());
        made
    }

    #[inline(always)]
    fn bits(&self, n: usize, sublattice: usize) -> Option<&[u8]> {
        let begin = self.begin[n];
        (begin != WHOLE).then(|| &self.bits[begin as usize..][..self.links[sublattice].len()])
    }

    /// Has point `l` of tile `n` (of `tiles`) bond `k` of its sublattice?
    pub fn has(&self, n: usize, sublattice: usize, k: usize, l: usize) -> bool {
        self.bits(n, sublattice)
            .is_none_or(|bits| bits[k] >> l & 1 == 1)
    }

    /// Blocks of work that the tiles make.
    pub fn blocks(&self) -> usize {
        self.starts.len() - 1
    }

    /// The tiles of block `b`.
    pub fn block(&self, b: usize) -> Range<usize> {
        self.starts[b] as usize..self.starts[b + 1] as usize
    }

    /// Tile `n` (of `tiles`).
    #[inline(always)]
    pub fn tile(&self, grid: &Grid<D>, n: usize) -> Tile<'_, D> {
        let t = self.tiles[n] as usize;
        let sublattice = grid.tile_sublattice(t);
        Tile {
            first: grid.tile_slot(t),
            number: n,
            sublattice,
            owned: grid.owned[t],
            links: &self.links[sublattice],
            bits: self.bits(n, sublattice),
        }
    }

    fn family(&self, grid: &Grid<D>, slot: usize) -> usize {
        let (_, sub) = grid.cell(slot);
        self.links[sub]
            .iter()
            .filter(|l| l.partner(grid, slot).is_some())
            .count()
    }

    pub fn directed(&self) -> u64 {
        self.directed
    }

    /// Number of partners of a slot.
    pub fn family_size(&self, body: &Body<D>, slot: usize) -> usize {
        match &body.layout {
            Layout::Grid(grid) => self.family(grid, slot),
            Layout::Cloud(_) | Layout::Several(_) => 0,
        }
    }

    /// Every undirected bond once: slots i < j (images resolved), ξ from i to j.
    pub fn each(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let grid = body.grid();
        // of two ranks one counts a bond across their border
        let of_all = body.subdomain().map(|of| of.of_slots());
        self.each_directed(grid, |i, j, sub, k| {
            let link = &self.links[sub][k];
            let j = body.exchange.original(j);
            let before = match of_all {
                Some(ids) if i != j => ids[i] < ids[j],
                _ => i < j,
            };
            // a bond between a point and its own image counts from one side only
            if before || (i == j && link.shift > 0) {
                visit(i, j, link.xi);
            }
        });
    }

    /// Every directed bond: slots from and to (it may be an image), sublattice, and number among that one's links.
    pub fn each_directed(&self, grid: &Grid<D>, mut visit: impl FnMut(usize, usize, usize, usize)) {
        for n in 0..self.tiles.len() {
            let tile = self.tile(grid, n);
            for l in (0..TILE).filter(|l| tile.owned >> l & 1 == 1) {
                let i = tile.first + l;
                for (k, link) in tile.links.iter().enumerate() {
                    if tile.bits.is_none_or(|bits| bits[k] >> l & 1 == 1) {
                        visit(i, i.wrapping_add_signed(link.shift), tile.sublattice, k);
                    }
                }
            }
        }
    }

    pub fn bytes(&self) -> usize {
        self.links
            .iter()
            .map(|l| size_of::<Link<D>>() * l.len())
            .sum::<usize>()
            + 4 * self.tiles.len()
            + 4 * self.begin.len()
            + self.bits.len()
    }
}

/// Eight points and their bonds.
#[derive(Clone, Copy)]
pub struct Tile<'a, const D: usize> {
    /// Its first slot.
    pub first: usize,
    /// Its place among the tiles that have points.
    pub number: usize,
    pub sublattice: usize,
    /// A bit per slot that holds a point.
    pub owned: u8,
    pub links: &'a [Link<D>],
    /// Per bond, which of the points have it; `None` if all have all.
    pub bits: Option<&'a [u8]>,
}

/// Displacements of a lattice body, tile by tile.
pub struct Tiles<'a, const D: usize> {
    pub links: &'a Links<D>,
    grid: &'a Grid<D>,
    u: [&'a [f64]; D],
}

impl<'a, const D: usize> Tiles<'a, D> {
    /// `body` is the one that the links were made of.
    pub fn new(links: &'a Links<D>, body: &'a Body<D>, u: FieldView<'a, D>) -> Self {
        let Layout::Grid(grid) = &body.layout else {
            unreachable!("links are of lattice bodies")
        };
        Tiles { links, grid, u }
    }

    /// The tiles of block `b`.
    #[inline(always)]
    pub fn block(&self, b: usize) -> impl Iterator<Item = Tile<'a, D>> {
        self.links.block(b).map(|n| self.links.tile(self.grid, n))
    }

    /// Displacements of a tile's points.
    #[inline(always)]
    pub fn own<L: Lane>(&self, tile: &Tile<D>) -> [L; D] {
        self.at(tile, 0)
    }

    /// Displacements of the partners along a bond; far away where there is none.
    #[inline(always)]
    pub fn partners<L: Lane>(&self, tile: &Tile<D>, link: &Link<D>) -> [L; D] {
        self.at(tile, link.shift)
    }

    #[inline(always)]
    fn at<L: Lane>(&self, tile: &Tile<D>, shift: isize) -> [L; D] {
        let mut u = [L::splat(0.0); D];
        for a in 0..D {
            // SAFETY: tiles lie inside the arrays, and the guards keep their partners there
            u[a] = unsafe { L::load(self.u[a].as_ptr().add(tile.first).offset(shift)) };
        }
        u
    }
}
