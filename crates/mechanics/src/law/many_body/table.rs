//! Constants of every triple of kinds.

use crate::execute::lane::{Lane, TILE};
use crate::law::number::Over;

/// A row of constants for each i, j, k.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    kinds: usize,
    width: usize,
    rows: Vec<f64>,
}

impl Table {
    /// `row` of i, j, k; all of one width.
    pub fn new(kinds: usize, row: impl Fn(usize, usize, usize) -> Vec<f64>) -> Table {
        let all = 0..kinds * kinds * kinds;
        let rows: Vec<Vec<f64>> = all
            .map(|n| row(n / (kinds * kinds), n / kinds % kinds, n % kinds))
            .collect();
        Table {
            kinds,
            width: rows.first().map_or(0, Vec::len),
            rows: rows.concat(),
        }
    }

    /// How many kinds it knows.
    pub fn kinds(&self) -> usize {
        self.kinds
    }

    fn first(&self, [i, j, k]: [usize; 3]) -> usize {
        self.width * ((i * self.kinds + j) * self.kinds + k)
    }

    /// Of single numbers.
    ///
    /// # Panics
    /// If there is no such kind.
    pub fn at(&self, kinds: [usize; 3]) -> Same<'_> {
        let first = self.first(kinds);
        Same(&self.rows[first..first + self.width])
    }

    /// Of lanes of one kind.
    #[inline(always)]
    pub fn same(&self) -> Same<'_> {
        Same(&self.rows[..self.width])
    }

    /// Of lanes of any kind.
    ///
    /// # Panics
    /// If there is no such kind.
    #[inline(always)]
    pub fn each(&self, i: &[u8; TILE], j: &[u8; TILE], k: &[u8; TILE]) -> Each<'_> {
        let mut first = [0; TILE];
        for l in 0..TILE {
            first[l] = self.first([i[l], j[l], k[l]].map(usize::from));
        }
        Each {
            rows: &self.rows,
            first,
        }
    }

    /// All constants of number `n`.
    pub fn column(&self, n: usize) -> impl Iterator<Item = f64> {
        self.rows.iter().skip(n).step_by(self.width).copied()
    }
}

/// Constants of the triple that is in every lane.
pub trait Row: Copy {
    /// Constant number `n`.
    fn get<L: Lane, N: Over<L>>(self, n: usize) -> N;
}

/// The same in all lanes.
#[derive(Clone, Copy)]
pub struct Same<'a>(&'a [f64]);

impl Row for Same<'_> {
    #[inline(always)]
    fn get<L: Lane, N: Over<L>>(self, n: usize) -> N {
        N::constant(self.0[n])
    }
}

/// Each lane has its own.
#[derive(Clone, Copy)]
pub struct Each<'a> {
    rows: &'a [f64],
    first: [usize; TILE],
}

impl Row for Each<'_> {
    #[inline(always)]
    fn get<L: Lane, N: Over<L>>(self, n: usize) -> N {
        let mut all = [0.0; TILE];
        for (x, first) in all.iter_mut().zip(self.first) {
            *x = self.rows[first + n];
        }
        // SAFETY: a lane holds at most a tile
        N::lane(unsafe { L::load(all.as_ptr()) })
    }
}
