//! Constants of bonds of pairs of materials, where they do not follow from the two materials.

use super::Toughness;
use crate::execute::lane::Lane;

/// What points of one material have in their bonds with points of another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondConstants {
    /// Bonds are no longer than this (length); 0: none.
    pub horizon: f64,
    /// c (force / volume²), or β of the point's own material.
    pub stiffness: f64,
    /// κ of the point's own material; 0 of bond-based ones.
    pub volume: f64,
    pub toughness: Toughness,
}

impl BondConstants {
    /// κ/β
    pub fn ratio(&self) -> f64 {
        if self.stiffness == 0.0 {
            0.0
        } else {
            self.volume / self.stiffness
        }
    }
}

/// One record of a pair as lanes gather it.
#[derive(Debug, Clone, Copy)]
pub struct BondLanes<L> {
    /// Of the bond: c or β.
    pub stiffness: L,
    /// κ/β
    pub ratio: L,
    /// `½ + δ/h`: where the partner's volume begins to fade.
    pub cut: L,
    pub volume: L,
}

/// Constants of all pairs of materials.
#[derive(Debug, Clone, Default)]
pub struct BondTable {
    materials: usize,
    pairs: Vec<BondConstants>,
    /// [`BondLanes`], and s00 and α, of each pair.
    law: Vec<[f64; 4]>,
    memory: Vec<[f64; 2]>,
}

impl BondTable {
    /// From `[of][with]`; volumes fade over `scaling` at the horizon, where they do.
    pub fn new(materials: usize, pairs: Vec<BondConstants>, scaling: Option<f64>) -> BondTable {
        assert_eq!(pairs.len(), materials * materials, "one record per pair");
        let law = |p: &BondConstants| {
            [
                p.stiffness,
                p.ratio(),
                scaling.map_or(1.0, |h| 0.5 + p.horizon / h),
                p.volume,
            ]
        };
        let memory = |p: &BondConstants| [p.toughness.s00, p.toughness.alpha];
        BondTable {
            materials,
            law: pairs.iter().map(law).collect(),
            memory: pairs.iter().map(memory).collect(),
            pairs,
        }
    }

    pub fn materials(&self) -> usize {
        self.materials
    }

    pub fn get(&self, of: usize, with: usize) -> &BondConstants {
        &self.pairs[of * self.materials + with]
    }

    /// The shortest horizon of any pair.
    pub fn shortest(&self) -> f64 {
        self.pairs
            .iter()
            .fold(f64::INFINITY, |d, p| d.min(p.horizon))
    }

    /// Numbers of the pairs that eight slots and their partners are.
    #[inline(always)]
    pub(super) unsafe fn numbers<L: Lane>(
        &self,
        material: &[u8],
        rows: *const u32,
        partners: *const u32,
    ) -> [u32; crate::execute::lane::TILE] {
        let mut numbers = [0; crate::execute::lane::TILE];
        for (l, number) in numbers.iter_mut().enumerate().take(L::N) {
            // SAFETY: the caller's promise, that there are slots for every lane; each has a material
            unsafe {
                let of = *material.get_unchecked(*rows.add(l) as usize) as usize;
                let with = *material.get_unchecked(*partners.add(l) as usize) as usize;
                *number = (of * self.materials + with) as u32;
            }
        }
        numbers
    }

    /// # Safety
    /// `numbers` are of pairs of this table.
    #[inline(always)]
    pub(super) unsafe fn law<L: Lane>(&self, numbers: &[u32]) -> BondLanes<L> {
        // SAFETY: the caller's promise
        let [stiffness, ratio, cut, volume] =
            unsafe { L::gather4(self.law.as_ptr().cast(), numbers.as_ptr()) };
        BondLanes {
            stiffness,
            ratio,
            cut,
            volume,
        }
    }

    /// δ of pairs of this table (length).
    #[inline(always)]
    pub(super) fn horizon<L: Lane>(&self, numbers: &[u32; crate::execute::lane::TILE]) -> L {
        let all = numbers.map(|n| self.pairs[n as usize].horizon);
        // SAFETY: a number per lane
        unsafe { L::load(all.as_ptr()) }
    }

    /// s00 and α.
    ///
    /// # Safety
    /// `numbers` are of pairs of this table.
    #[inline(always)]
    pub(super) unsafe fn memory<L: Lane>(&self, numbers: &[u32]) -> [L; 2] {
        // SAFETY: the caller's promise
        unsafe { L::gather2(self.memory.as_ptr().cast(), numbers.as_ptr()) }
    }

    pub fn bytes(&self) -> usize {
        self.pairs.len() * (size_of::<BondConstants>() + 48)
    }
}
