//! A central force of two points, and its tangents.

use super::{BondTangent, EachTangent};

/// One of two points that act on each other along the line between them.
#[derive(Debug, Clone, Copy)]
pub struct End<const D: usize> {
    /// Its slot.
    pub at: usize,
    /// That of the other one; of another rank's point [what it is called](crate::body::Body::id_of).
    pub other: usize,
    /// Volume of the other.
    pub volume: f64,
    /// From it to the other now.
    pub y: [f64; D],
    /// Its force density over the volume of the other, along y.
    pub pull: f64,
    /// Energy of both / volume².
    pub energy: f64,
}

/// A central force of a pair.
#[derive(Debug, Clone, Copy)]
pub struct Pull<const D: usize> {
    /// Slots, or [what](crate::body::Body::id_of) points of other ranks are called.
    pub i: usize,
    pub j: usize,
    pub volumes: [f64; 2],
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
    /// With the ends called so.
    pub fn named(self, name: impl Fn(usize) -> usize) -> Self {
        Pull {
            i: name(self.i),
            j: name(self.j),
            ..self
        }
    }

    /// Its ends that are here, of a body of so many slots.
    pub fn ends(self, slots: usize) -> impl Iterator<Item = End<D>> {
        let [vi, vj] = self.volumes;
        let both = [
            (self.i, self.j, vj, self.y),
            (self.j, self.i, vi, self.y.map(|c| -c)),
        ];
        let here = both.into_iter().filter(move |(at, ..)| *at < slots);
        here.map(move |(at, other, volume, y)| End {
            at,
            other,
            volume,
            y,
            pull: self.pull,
            energy: self.energy,
        })
    }

    /// `V_j (slope n⊗n + pull (1 − n⊗n))` of both ends; none of two points on one spot.
    pub fn tangents(&self, visit: &mut EachTangent<D>) {
        let &Pull {
            i, j, y, r, pull, ..
        } = self;
        if r == 0.0 {
            return;
        }
        let n = y.map(|c| c / r);
        let [vi, vj] = self.volumes;
        for (i, j, volume, way) in [(i, j, vj, 1.0), (j, i, vi, -1.0)] {
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
