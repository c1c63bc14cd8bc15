//! What is the same up to a translation: points with the same rows, balls with the same points.
//!
//! Numbers are compared after rounding (offsets to 1e-8 of the longest bond, micromoduli to 1e-12 of the largest), so that the
//! round-off of positions does not tell lattice points apart.

use super::ball::Walk;
use super::block::largest;
use super::select::mixed;
use peridyne::spec::LinearBody;
use rayon::prelude::*;

/// 128 bits that stand for a sequence of whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Signature(u64, u64);

impl Signature {
    pub fn new() -> Signature {
        Signature(1, 2)
    }

    pub fn take(&mut self, x: u64) {
        self.0 = mixed(self.0 ^ x);
        self.1 = mixed(self.1.rotate_left(29) ^ mixed(x));
    }

    fn number(&mut self, x: f64, unit: f64) {
        self.take((x / unit).round() as i64 as u64);
    }
}

/// How points of a body look, one signature each.
pub(super) struct Looks {
    of: Vec<Signature>,
}

impl Looks {
    pub fn new<const D: usize>(body: &LinearBody<D>, retained: &[bool], range: f64) -> Looks {
        let length = grain(range);
        let most = body.block.iter().map(largest).fold(0.0, f64::max);
        let volume = body.volume.iter().fold(0.0, |m: f64, v| m.max(*v));
        let of = (0..body.points())
            .into_par_iter()
            .map(|i| {
                let mut s = Signature::new();
                s.take(u64::from(retained[i]));
                s.number(body.volume[i], volume * 1e-12);
                let (partners, blocks) = body.row(i);
                let at = |j: u32| body.xi(i, j as usize).map(|x| (x / length).round() as i64);
                let mut row: Vec<_> = partners.iter().map(|j| at(*j)).zip(blocks).collect();
                row.sort_unstable_by_key(|r| r.0);
                for (at, c) in row {
                    at.iter().for_each(|x| s.take(*x as u64));
                    for c in c.as_flattened() {
                        s.number(*c, most * 1e-12);
                    }
                }
                s
            })
            .collect();
        Looks { of }
    }

    /// All points of a ball.
    pub fn of<const D: usize>(&self, walk: &Walk<D>) -> Signature {
        let mut s = Signature::new();
        let removed = walk.removed.iter().zip(&walk.removed_at);
        for (p, at) in removed.chain(walk.rim.iter().zip(&walk.rim_at)) {
            let Signature(a, b) = self.of[*p as usize];
            s.take(a);
            s.take(b);
            for x in at {
                s.take(*x as u64);
            }
        }
        s
    }
}

/// What places are rounded to (length).
pub(super) fn grain(range: f64) -> f64 {
    if range > 0.0 { range * 1e-8 } else { 1.0 }
}
