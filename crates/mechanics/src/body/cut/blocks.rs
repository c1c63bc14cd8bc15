//! The blocks of bodies, and which of them a rank has.

use crate::body::grid::BLOCK;
use crate::body::{Body, Layout};
use crate::error::BuildError;
use crate::execute::lane::TILE;
use std::ops::Range;

/// Cells of a block of a lattice, points of one of a cloud.
pub(super) const CELLS: usize = BLOCK * TILE;

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
            Layout::Cloud(_) => {
                let all = self.points();
                let of = |block: usize| (all - block * CELLS).min(CELLS);
                (0..all.div_ceil(CELLS)).map(of).collect()
            }
            Layout::Several(pieces) => {
                let all = pieces.iter().flat_map(|p| p.body.points_of_blocks());
                all.collect()
            }
        }
    }
}

/// Blocks of all ranks, in their order, with as many points each as whole blocks allow.
pub(super) fn by_ranks(points: &[usize], ranks: usize) -> Result<Vec<Range<usize>>, BuildError> {
    let filled = points.iter().filter(|n| **n > 0).count();
    if filled < ranks {
        let blocks = if filled == 1 { "block" } else { "blocks" };
        let message = format!("{ranks} ranks for a body of {filled} {blocks} of {CELLS} cells");
        let help = format!("a rank has one block at least: take {filled} ranks or fewer");
        return Err(BuildError::too_many("ranks", message).help(help));
    }
    let all: usize = points.iter().sum();
    let (mut blocks, mut begin, mut passed, mut left) = (vec![], 0, 0, filled);
    for rank in 0..ranks {
        let (mut end, mut here) = (begin, 0);
        // those after it have one each
        let after = ranks - rank - 1;
        while here == 0 || left > after && passed < all * (rank + 1) / ranks {
            passed += points[end];
            here += points[end];
            left -= usize::from(points[end] > 0);
            end += 1;
        }
        let end = if after == 0 { points.len() } else { end };
        blocks.push(begin..end);
        begin = end;
    }
    Ok(blocks)
}
