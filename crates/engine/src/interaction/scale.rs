//! Factors of bonds of a stencil, kept for tiles that have any other than 1.

use crate::execute::lane::TILE;
use std::collections::HashMap;

/// Factors per bond and point of a tile; equal tiles share them.
#[derive(Debug, Clone, Default)]
pub struct Scale {
    width: usize,
    /// Per active tile: which of the tables below, from 1; 0: all its factors are 1. Empty: nothing is scaled.
    of_tile: Vec<u32>,
    /// `[tables][width][8]`
    factors: Vec<f64>,
}

impl Scale {
    /// `factor` of tile, bond and point of the tile.
    pub fn new(tiles: usize, width: usize, factor: impl Fn(usize, usize, usize) -> f64) -> Scale {
        let mut made = Scale {
            width,
            of_tile: vec![0; tiles],
            factors: vec![],
        };
        let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
        let mut table = vec![0u64; width * TILE];
        for (n, which) in made.of_tile.iter_mut().enumerate() {
            let mut plain = true;
            for (k, row) in table.chunks_mut(TILE).enumerate() {
                for (l, x) in row.iter_mut().enumerate() {
                    let f = factor(n, k, l);
                    plain &= f == 1.0;
                    *x = f.to_bits();
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

    /// Factors `[bond][8]` of a scaled tile.
    #[inline(always)]
    pub fn tile(&self, n: usize) -> &[f64] {
        let size = self.width * TILE;
        let first = (self.of_tile[n] as usize - 1) * size;
        &self.factors[first..first + size]
    }

    /// Factor of bond `k` of point `l` of the `n`-th active tile.
    pub fn of(&self, n: usize, k: usize, l: usize) -> f64 {
        if self.is_scaled(n) {
            self.tile(n)[k * TILE + l]
        } else {
            1.0
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
        let factor = |n: usize, k: usize, l: usize| match (n % 3, k, l) {
            (1, 2, 5) => 0.5,
            (2, 0, 7) => 2.0,
            _ => 1.0,
        };
        let scale = Scale::new(9, 4, factor);
        assert_eq!(scale.factors.len(), 2 * 4 * TILE);
        for n in 0..9 {
            assert_eq!(scale.is_scaled(n), n % 3 != 0);
            for (k, l) in [(2, 5), (0, 7), (1, 1)] {
                assert_eq!(scale.of(n, k, l), factor(n, k, l));
            }
        }
        assert!(Scale::new(9, 4, |_, _, _| 1.0).is_empty());
    }
}
