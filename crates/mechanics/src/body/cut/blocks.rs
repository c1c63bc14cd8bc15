//! The blocks of bodies, and which of them a rank has.

use crate::body::grid::BLOCK;
use crate::body::{Body, Layout};
use crate::execute::lane::TILE;
use std::ops::Range;

/// Cells of a block of a lattice, points of one of a cloud.
pub(in crate::body) const CELLS: usize = BLOCK * TILE;

impl<const D: usize> Body<D> {
    /// How many points each block has.
    pub(super) fn points_of_blocks(&self) -> Vec<usize> {
        match &self.layout {
            Layout::Grid(grid) => {
                let tiles = grid.stride / TILE;
                let mut points = vec![0; grid.stride.div_ceil(CELLS)];
                for (tile, owned) in grid.owned.iter().enumerate() {
                    points[tile % tiles * TILE / CELLS] += owned.count_ones() as usize;
                }
                points
            }
            Layout::Cloud(_) => of_points(self.points()),
            Layout::Several(pieces) => {
                let all = pieces.iter().flat_map(|p| p.body.points_of_blocks());
                all.collect()
            }
        }
    }
}

/// How many points each block of a cloud has.
pub(super) fn of_points(points: usize) -> Vec<usize> {
    let of = |block: usize| (points - block * CELLS).min(CELLS);
    (0..points.div_ceil(CELLS)).map(of).collect()
}

/// Blocks of all ranks, in their order, with as many points each as whole blocks allow. Ranks beyond the number of blocks have none.
pub(super) fn by_ranks(points: &[usize], ranks: usize) -> Vec<Range<usize>> {
    let mut left = points.iter().filter(|n| **n > 0).count();
    let working = left.min(ranks);
    let all: usize = points.iter().sum();
    let (mut blocks, mut begin, mut passed) = (vec![], 0, 0);
    for rank in 0..working {
        let (mut end, mut here) = (begin, 0);
        // those after it have one each
        let after = working - rank - 1;
        while here == 0 || left > after && passed < all * (rank + 1) / working {
            passed += points[end];
            here += points[end];
            left -= usize::from(points[end] > 0);
            end += 1;
        }
        let end = if after == 0 { points.len() } else { end };
        blocks.push(begin..end);
        begin = end;
    }
    blocks.resize(ranks, points.len()..points.len());
    blocks
}
