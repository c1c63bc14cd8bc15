//! Short-range repulsion: `K V_j (r − d)` along the current direction where `r < d = min(bonded r0, range)`
//! (Parks et al. 2008 (3.0.6); LAMMPS's observed behaviour). K and the range belong to a pair of materials.

use crate::execute::lane::{Lane, TILE};

/// A number for every pair of materials; a table of one serves all.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTable {
    materials: usize,
    /// `[materials][materials]`, symmetric.
    values: Vec<f64>,
}

impl PairTable {
    /// The same for all pairs.
    pub fn uniform(value: f64) -> PairTable {
        PairTable {
            materials: 1,
            values: vec![value],
        }
    }

    /// `of(a, b)` with `a ≤ b`; a table of one if all are the same.
    pub fn new(materials: usize, of: impl Fn(usize, usize) -> f64) -> PairTable {
        let pairs = (0..materials).flat_map(|a| (0..materials).map(move |b| (a.min(b), a.max(b))));
        let values: Vec<f64> = pairs.map(|(a, b)| of(a, b)).collect();
        match values.as_slice() {
            [first, rest @ ..] if rest.iter().all(|x| x == first) => PairTable::uniform(*first),
            _ => PairTable { materials, values },
        }
    }

    #[inline]
    pub fn at(&self, a: usize, b: usize) -> f64 {
        match self.values.as_slice() {
            [one] => *one,
            all => all[a * self.materials + b],
        }
    }

    /// The one number, if it is the same for all pairs.
    #[inline]
    pub fn one(&self) -> Option<f64> {
        match self.values.as_slice() {
            [one] => Some(*one),
            _ => None,
        }
    }

    /// The table of one material alone.
    pub fn only(&self, material: usize) -> PairTable {
        PairTable::uniform(self.at(material, material))
    }

    pub fn highest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }
}

/// Two stiffnesses in series, `2 K K′/(K + K′)`; alike ones exactly their own.
pub fn in_series(a: f64, b: f64) -> f64 {
    match a == b {
        true => a,
        false => 2.0 * a * b / (a + b),
    }
}

/// How points repel, by their materials.
#[derive(Debug, Clone, PartialEq)]
pub struct Repulsion {
    /// K (force / volume² / length).
    pub stiffness: PairTable,
    /// Fraction of the reference distance below which a pair repels.
    pub bonded: f64,
    /// Range of pairs that are far apart in the reference (length).
    pub range: PairTable,
    /// K of each slot, where points have horizons of their own and so bonds of another stiffness; empty: that of the materials.
    pub own: Vec<f64>,
}

impl Repulsion {
    /// All points alike.
    pub fn uniform(stiffness: f64, bonded: f64, range: f64) -> Repulsion {
        Repulsion {
            stiffness: PairTable::uniform(stiffness),
            bonded,
            range: PairTable::uniform(range),
            own: vec![],
        }
    }

    /// The distance d below which a pair of reference distance r0 repels.
    pub fn distance(&self, r0: f64, materials: [usize; 2]) -> f64 {
        let [a, b] = materials;
        (self.bonded * r0).min(self.range.at(a, b))
    }

    /// K of a pair.
    pub fn of(&self, materials: [usize; 2]) -> f64 {
        let [a, b] = materials;
        self.stiffness.at(a, b)
    }

    /// K of two points: that of their materials, or of each in series.
    pub fn between(&self, materials: [usize; 2], slots: [usize; 2]) -> f64 {
        self.of_both(materials, slots.map(|s| self.own_at(s)))
    }

    /// The same of what [each has itself](Self::own_at).
    pub fn of_both(&self, materials: [usize; 2], [a, b]: [f64; 2]) -> f64 {
        match self.own.is_empty() {
            true => self.of(materials),
            false => in_series(a, b),
        }
    }

    /// What a point has itself.
    pub fn own_at(&self, slot: usize) -> f64 {
        self.own.get(slot).copied().unwrap_or(0.0)
    }

    /// Coefficient of the way `y` from one point to another, away from each other: `K V (r − d)/r` below the distance d, else 0;
    /// `xi` is that way in the reference, `volume` that of the other.
    pub fn pull<const D: usize>(
        &self,
        xi: &[f64; D],
        y: &[f64; D],
        materials: [usize; 2],
        volume: f64,
    ) -> f64 {
        let length = |x: &[f64; D]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
        let (r, d) = (length(y), self.distance(length(xi), materials));
        match r < d && r > 0.0 {
            true => self.of(materials) * volume * (r - d) / r,
            false => 0.0,
        }
    }

    /// K of eight pairs, by the materials of their ends.
    #[inline(always)]
    pub fn lanes<L: Lane>(&self, a: [u8; TILE], b: [u8; TILE]) -> L {
        if let Some(one) = self.stiffness.one() {
            return L::splat(one);
        }
        let mut all = [0.0; TILE];
        for l in 0..TILE {
            all[l] = self.stiffness.at(a[l] as usize, b[l] as usize);
        }
        // SAFETY: a number per lane
        unsafe { L::load(all.as_ptr()) }
    }

    /// Of a body made of one of the materials.
    pub fn only(&self, material: usize) -> Repulsion {
        Repulsion {
            stiffness: self.stiffness.only(material),
            bonded: self.bonded,
            range: self.range.only(material),
            own: self.own.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_their_own_stiffness_are_in_series() {
        let mut all = Repulsion::uniform(5.0, 0.9, 1.0);
        assert_eq!(all.between([0, 0], [0, 1]), 5.0);
        all.own = vec![2.0, 6.0, 6.0];
        assert_eq!(all.between([0, 0], [0, 1]), 3.0);
        assert_eq!(all.between([0, 0], [2, 1]), 6.0);
    }

    #[test]
    fn a_table_is_symmetric_and_as_small_as_it_can_be() {
        let t = PairTable::new(3, |a, b| (10 * a + b) as f64);
        for (a, b, x) in [(0, 1, 1.0), (1, 0, 1.0), (2, 1, 12.0), (2, 2, 22.0)] {
            assert_eq!(t.at(a, b), x);
        }
        assert_eq!((t.one(), t.highest()), (None, 22.0));
        assert_eq!(t.only(1), PairTable::uniform(11.0));
        let same = PairTable::new(4, |_, _| 7.0);
        assert_eq!((same.one(), same.at(3, 1)), (Some(7.0), 7.0));
    }
}
