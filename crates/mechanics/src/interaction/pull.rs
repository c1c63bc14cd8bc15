//! A central force of two points, and its tangents.

use super::{BondTangent, EachTangent};
use crate::body::Body;

/// A central force of a pair.
#[derive(Debug, Clone, Copy)]
pub struct Pull<const D: usize> {
    pub i: usize,
    pub j: usize,
    /// From i to j now, and its length.
    pub y: [f64; D],
    pub r: f64,
    /// Force density on i over the volume of j and over r, along y.
    pub pull: f64,
    /// What the force density over the volume grows with r by.
    pub slope: f64,
    /// Energy / volume².
    pub energy: f64,
}

impl<const D: usize> Pull<D> {
    /// `V_j (slope n⊗n + pull (1 − n⊗n))` of both ends; none of two points on one spot.
    pub fn tangents(&self, body: &Body<D>, visit: &mut EachTangent<D>) {
        let &Pull {
            i, j, y, r, pull, ..
        } = self;
        if r == 0.0 {
            return;
        }
        let n = y.map(|c| c / r);
        for (i, j, way) in [(i, j, 1.0), (j, i, -1.0)] {
            let volume = body.volume.at(j);
            let block = crate::array::from_fn(|a| {
                crate::array::from_fn(|b| {
                    let along = (self.slope - pull) * n[a] * n[b];
                    volume * (along + if a == b { pull } else { 0.0 })
                })
            });
            visit(BondTangent::direct(i, j, y.map(|c| way * c), block));
        }
    }
}
