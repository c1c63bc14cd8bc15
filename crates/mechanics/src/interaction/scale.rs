//! Factors of bonds of a stencil, kept for tiles that have any other than 1.

use crate::execute::lane::{Lane, TILE};
use crate::law::BondFactors;
use std::collections::HashMap;

/// Factors per bond and point of a tile; equal tiles share them.
#[derive(Debug, Clone, Default)]
pub struct Scale {
    width: usize,
    /// Numbers per bond: 1, those of `pair`, or the 3 of [`BondFactors`].
    numbers: usize,
    /// Per active tile: which of the tables below, from 1; 0: all its factors are 1. Empty: nothing is scaled.
    of_tile: Vec<u32>,
    /// `[tables][width][numbers][8]`
    factors: Vec<f64>,
}

/// Factors of a scaled tile, `[width][numbers][8]`.
#[derive(Debug, Clone, Copy)]
pub struct TileFactors<'a> {
    factors: &'a [f64],
    numbers: usize,
}

impl TileFactors<'_> {
    /// Of a tile without factors; nothing may be read.
    pub const NONE: TileFactors<'static> = TileFactors {
        factors: &[],
        numbers: 0,
    };

    /// One of the numbers of bond `k` of the eight points.
    #[inline(always)]
    unsafe fn number<L: Lane>(self, k: usize, number: usize) -> L {
        let at = (k * self.numbers + number) * TILE;
        // SAFETY: the caller's promise, that k is a bond of a scaled tile with that many numbers
        unsafe { L::load(self.factors.as_ptr().add(at)) }
    }

    /// # Safety
    /// `k` is a bond of the stencil, and the tile is scaled.
    #[inline(always)]
    pub unsafe fn pair<L: Lane>(self, k: usize) -> L {
        // SAFETY: the caller's promise
        unsafe { self.number(k, 0) }
    }

    /// # Safety
    /// As [`TileFactors::pair`], of a law with a point scalar.
    #[inline(always)]
    pub unsafe fn own<L: Lane>(self, k: usize) -> L {
        // SAFETY: the caller's promise
        unsafe { self.number(k, 1) }
    }

    /// # Safety
    /// As [`TileFactors::own`].
    #[inline(always)]
    pub unsafe fn all<L: Lane>(self, k: usize) -> BondFactors<L> {
        // SAFETY: the caller's promise
        unsafe {
            BondFactors {
                pair: self.number(k, 0),
                own: self.number(k, 1),
                other: self.number(k, 2),
            }
        }
    }
}

impl Scale {
    /// `factors` of tile, bond and point of the tile; of laws without a point `scalar` only `pair` is kept.
    pub fn new(
        tiles: usize,
        width: usize,
        scalar: bool,
        factors: impl Fn(usize, usize, usize) -> BondFactors<f64>,
    ) -> Scale {
        let mut made = Scale {
            width,
            numbers: if scalar { 3 } else { 1 },
            of_tile: vec![0; tiles],
            factors: vec![],
        };
        let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
        let numbers = made.numbers;
        let mut table = vec![0u64; width * numbers * TILE];
        for (n, which) in made.of_tile.iter_mut().enumerate() {
            let mut plain = true;
            for (k, bond) in table.chunks_mut(numbers * TILE).enumerate() {
                for l in 0..TILE {
                    let f = factors(n, k, l);
                    for (number, x) in [f.pair, f.own, f.other][..numbers].iter().enumerate() {
                        plain &= *x == 1.0;
                        bond[number * TILE + l] = x.to_bits();
                    }
                }
            }
            if plain {
                continue;
            }
            let new = known.len() as u32 + 1;
            *which = match known.get(&table) {
                Some(old) => *old,
                None => {
                    known.insert(table.clone(), new);
                    made.factors
                        .extend(table.iter().map(|x| f64::from_bits(*x)));
                    new
                }
            };
        }
        if made.factors.is_empty() {
            made.of_tile = vec![];
        }
        made
    }

    /// Has the `n`-th active tile factors other than 1?
    #[inline(always)]
    pub fn is_scaled(&self, n: usize) -> bool {
        self.of_tile.get(n).is_some_and(|t| *t != 0)
    }

    /// Is any bond scaled?
    pub fn is_empty(&self) -> bool {
        self.of_tile.is_empty()
    }

    /// Factors of a scaled tile.
    #[inline(always)]
    pub fn tile(&self, n: usize) -> TileFactors<'_> {
        let size = self.width * self.numbers * TILE;
        let first = (self.of_tile[n] as usize - 1) * size;
        TileFactors {
            factors: &self.factors[first..first + size],
            numbers: self.numbers,
        }
    }

    /// Factors of bond `k` of point `l` of the `n`-th active tile.
    pub fn of(&self, n: usize, k: usize, l: usize) -> BondFactors<f64> {
        if !self.is_scaled(n) {
            return BondFactors::ONE;
        }
        let at = |number: usize| match number < self.numbers {
            true => self.tile(n).factors[(k * self.numbers + number) * TILE + l],
            false => 1.0,
        };
        BondFactors {
            pair: at(0),
            own: at(1),
            other: at(2),
        }
    }

    pub fn bytes(&self) -> usize {
        4 * self.of_tile.len() + 8 * self.factors.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_tiles_share_a_table() {
        let factor = |n: usize, k: usize, l: usize| {
            let pair = match (n % 3, k, l) {
                (1, 2, 5) => 0.5,
                (2, 0, 7) => 2.0,
                _ => 1.0,
            };
            BondFactors {
                pair,
                own: pair * pair,
                ..BondFactors::ONE
            }
        };
        for (scalar, numbers) in [(true, 3), (false, 1)] {
            let scale = Scale::new(9, 4, scalar, factor);
            assert_eq!(scale.factors.len(), 2 * 4 * numbers * TILE);
            for n in 0..9 {
                assert_eq!(scale.is_scaled(n), n % 3 != 0);
                for (k, l) in [(2, 5), (0, 7), (1, 1)] {
                    let (found, given) = (scale.of(n, k, l), factor(n, k, l));
                    assert_eq!(found.pair, given.pair);
                    assert_eq!(found.own, if scalar { given.own } else { 1.0 });
                }
            }
        }
        assert!(Scale::new(9, 4, true, |_, _, _| BondFactors::ONE).is_empty());
    }
}
