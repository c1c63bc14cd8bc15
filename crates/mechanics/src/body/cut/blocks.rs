//! The blocks of bodies, and which of them a rank has.

use crate::body::grid::BLOCK;
use crate::body::{Body, Layout};
use crate::execute::lane::TILE;
use peridyne_comm::{Comm, Work};
use std::ops::Range;

/// Cells of a block of a lattice, points of one of a cloud.
pub(in crate::body) const CELLS: usize = BLOCK * TILE;
/// Of one point: weights are whole numbers.
const FINE: f64 = 64.0;

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

/// Blocks of all ranks, in their order, of blocks with so many points: even in time where an earlier run says how long they take, else in points.
pub(super) fn shared_out(points: &[usize], comm: &Comm) -> Vec<Range<usize>> {
    by_ranks(&weights(points, comm.earlier()), comm.ranks())
}

/// Weights of blocks with so many points: how much of the time of ranks in an earlier run, which had points in the same order, was theirs, where it is known of
/// all; else their points.
pub(super) fn weights(points: &[usize], earlier: &[Work]) -> Vec<usize> {
    let all: usize = points.iter().sum();
    let seconds: f64 = earlier.iter().map(|w| w.seconds).sum();
    let known = earlier.iter().map(|w| w.points).sum::<usize>() == all;
    if !known || !seconds.is_finite() || seconds <= 0.0 {
        return points.to_vec();
    }
    // a share that nobody measured well is no reason for one with hardly any point
    let pace = |w: &Work| (w.seconds / seconds * all as f64 / w.points as f64).clamp(0.2, 5.0);
    let mut ranks = earlier.iter().filter(|w| w.points > 0);
    let (mut pace_here, mut left) = (1.0, 0);
    let weight = |points: &usize| {
        let (mut points, mut weight) = (*points, 0.0);
        while points > 0 {
            if left == 0
                && let Some(rank) = ranks.next()
            {
                (pace_here, left) = (pace(rank), rank.points);
            }
            let here = points.min(left.max(1));
            weight += pace_here * here as f64;
            points -= here;
            left = left.saturating_sub(here);
        }
        (FINE * weight).round() as usize
    };
    points.iter().map(weight).collect()
}

/// Blocks of all ranks, in their order, each with as much of all weights as whole blocks allow. Ranks beyond the number of blocks have none.
pub(super) fn by_ranks(weights: &[usize], ranks: usize) -> Vec<Range<usize>> {
    let mut left = weights.iter().filter(|n| **n > 0).count();
    let working = left.min(ranks);
    let all: usize = weights.iter().sum();
    let (mut blocks, mut begin, mut passed) = (vec![], 0, 0);
    for rank in 0..working {
        let (mut end, mut here) = (begin, 0);
        // those after it have one each
        let after = working - rank - 1;
        while here == 0 || left > after && passed < all * (rank + 1) / working {
            passed += weights[end];
            here += weights[end];
            left -= usize::from(weights[end] > 0);
            end += 1;
        }
        let end = if after == 0 { weights.len() } else { end };
        blocks.push(begin..end);
        begin = end;
    }
    blocks.resize(ranks, weights.len()..weights.len());
    blocks
}

#[cfg(test)]
mod tests {
    use super::{by_ranks, weights};
    use peridyne_comm::Work;

    fn work(points: usize, seconds: f64) -> Work {
        Work { points, seconds }
    }

    #[test]
    fn who_was_slow_has_fewer_points() {
        let points = [256; 100];
        // the second half took three times as long
        let earlier = [work(12_800, 1.0), work(12_800, 3.0)];
        let of = |earlier: &[Work], ranks| by_ranks(&weights(&points, earlier), ranks);
        assert_eq!(of(&[], 2), [0..50, 50..100]);
        assert_eq!(of(&earlier, 2), [0..67, 67..100]);
        // 100 halves of a unit of time each, but for whole blocks
        assert_eq!(of(&earlier, 4), [0..50, 50..67, 67..84, 84..100]);
        // even again: borders stay
        let even = [work(67 * 256, 2.0), work(33 * 256, 1.95)];
        let ends = of(&even, 2)[0].end;
        assert!((66..=68).contains(&ends), "{ends}");
        // ranks without points, borders within blocks, and times of another body
        let idle = [work(10_000, 1.0), work(0, 0.0), work(15_600, 1.56)];
        assert_eq!(of(&idle, 2), [0..50, 50..100]);
        for other in [work(100, 1.0), work(25_600, 0.0), work(25_600, f64::NAN)] {
            assert_eq!(weights(&points, &[other]), points);
        }
    }
}
