//! The bonds of a lattice body, for laws that remember nothing of them: offsets, and who is there.

use super::stencil::Stencil;
use crate::body::{Body, Grid, Layout};
use crate::execute::lane::TILE;
use std::collections::HashMap;

/// One bond of a stencil.
#[derive(Debug, Clone, Copy)]
pub struct Link<const D: usize> {
    /// Slots from here to there.
    pub shift: isize,
    /// Reference vector to the partner (length).
    pub xi: [f64; D],
    cell: [i32; D],
    to: usize,
}

impl<const D: usize> Link<D> {
    /// The partner of a slot's point along this bond (it may be an image).
    pub fn partner(&self, grid: &Grid<D>, slot: usize) -> Option<usize> {
        grid.neighbour(slot, self.cell, self.to)
    }
}

/// The other end of a bond.
#[derive(Debug, Clone, Copy)]
pub struct Partner {
    /// Where its numbers are: perhaps an image.
    pub slot: usize,
    /// The point.
    pub original: usize,
}

/// All bonds of a lattice body.
#[derive(Debug, Clone)]
pub struct Links<const D: usize> {
    /// Per sublattice.
    pub links: Vec<Vec<Link<D>>>,
    /// Tiles that have points.
    pub tiles: Vec<u32>,
    /// Per tile of `tiles`: where its bits begin in `bits`; [`WHOLE`] if all its eight points have all their partners.
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
                        let cell: [i32; D] = std::array::from_fn(|a| o.cell[a]);
                        Link {
                            shift: grid.shift(cell.map(i64::from), o.to as i64 - from as i64)
                                as isize,
                            xi: std::array::from_fn(|a| h * edges[a] * (o.quarter[a] as f64 / 4.0)),
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
        let mut made = Links {
            links,
            begin: Vec::with_capacity(tiles.len()),
            bits: vec![],
            tiles,
            directed: 0,
        };
        let mut row = vec![];
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
            if row.iter().all(|b| *b == 0xff) {
                made.begin.push(WHOLE);
            } else {
                made.begin.push(made.bits.len() as u32);
                made.bits.extend_from_slice(&row);
            }
        }
        debug_assert!(body.volume.uniform().is_some());
        made
    }

    /// Bits of the bonds of tile `n` (of `tiles`); `None` if all its points have all their partners.
    #[inline(always)]
    pub fn bits(&self, n: usize, sublattice: usize) -> Option<&[u8]> {
        let begin = self.begin[n];
        (begin != WHOLE).then(|| &self.bits[begin as usize..][..self.links[sublattice].len()])
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
            Layout::Cloud(_) => 0,
        }
    }

    /// Every directed bond: slot i, the other end, number of the bond in its stencil, sublattice.
    pub fn each_directed(
        &self,
        body: &Body<D>,
        visit: &mut dyn FnMut(usize, Partner, usize, usize),
    ) {
        let Layout::Grid(grid) = &body.layout else {
            return;
        };
        let original: HashMap<u32, u32> = body.images.iter().copied().collect();
        for &t in &self.tiles {
            let first = grid.tile_slot(t as usize);
            let sub = grid.tile_sublattice(t as usize);
            for i in (first..first + TILE).filter(|s| grid.is_owned(*s)) {
                for (k, link) in self.links[sub].iter().enumerate() {
                    if let Some(slot) = link.partner(grid, i) {
                        let original = original.get(&(slot as u32)).map_or(slot, |o| *o as usize);
                        visit(i, Partner { slot, original }, k, sub);
                    }
                }
            }
        }
    }

    /// Every undirected bond once: slots i < j (images resolved), ξ from i to j.
    pub fn each(&self, body: &Body<D>, visit: &mut dyn FnMut(usize, usize, [f64; D])) {
        let Layout::Grid(grid) = &body.layout else {
            return;
        };
        let original: HashMap<u32, u32> = body.images.iter().copied().collect();
        for &t in &self.tiles {
            let first = grid.tile_slot(t as usize);
            let sub = grid.tile_sublattice(t as usize);
            for i in (first..first + TILE).filter(|s| grid.is_owned(*s)) {
                for link in &self.links[sub] {
                    let Some(j) = link.partner(grid, i) else {
                        continue;
                    };
                    let j = original.get(&(j as u32)).map_or(j, |o| *o as usize);
                    // a bond between a point and its own image counts from one side only
                    if i < j || (i == j && link.shift > 0) {
                        visit(i, j, link.xi);
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
