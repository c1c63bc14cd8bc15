//! Constants of a pair energy: the same in all lanes, or of each lane those of its pair of kinds.

use crate::execute::lane::Lane;
use crate::law::number::{Dual, Number};

/// Most that a pair energy has.
pub const MOST: usize = 8;

/// Where a pair energy finds its constants, by their numbers.
pub trait Constants<N>: Copy {
    /// `x` times constant number `n`.
    fn times(self, x: N, n: usize) -> N;
    /// `x` plus constant number `n`.
    fn plus(self, x: N, n: usize) -> N;
}

/// The same in all lanes.
#[derive(Clone, Copy)]
pub struct Same<'a>(pub &'a [f64; MOST]);

impl<N: Number> Constants<N> for Same<'_> {
    #[inline(always)]
    fn times(self, x: N, n: usize) -> N {
        x.times(self.0[n])
    }
    #[inline(always)]
    fn plus(self, x: N, n: usize) -> N {
        x.plus(self.0[n])
    }
}

/// Numbers of which each lane has those of its own kind with K others.
#[derive(Clone, Copy)]
pub struct Rows<L, const K: usize>(pub [[L; MOST + 1]; K]);

impl<L: Lane, const K: usize> Rows<L, K> {
    /// For others of these kinds.
    #[inline(always)]
    pub fn with(&self, kind: L) -> Chosen<'_, L, K> {
        let mut up_to = [kind.lt(L::splat(0.5)); K];
        for (k, up_to) in up_to.iter_mut().enumerate() {
            *up_to = kind.lt(L::splat(k as f64 + 0.5));
        }
        Chosen { rows: self, up_to }
    }
}

/// Of each lane those of its pair of kinds.
#[derive(Clone, Copy)]
pub struct Chosen<'a, L: Lane, const K: usize> {
    rows: &'a Rows<L, K>,
    /// Is the other of this kind, or of one before?
    up_to: [L::Mask; K],
}

impl<L: Lane, const K: usize> Chosen<'_, L, K> {
    /// Number `n`.
    #[inline(always)]
    pub fn get(self, n: usize) -> L {
        let rows = &self.rows.0;
        let mut found = rows[K - 1][n];
        for k in (0..K - 1).rev() {
            found = L::select(self.up_to[k], rows[k][n], found);
        }
        found
    }
}

impl<L: Lane, const K: usize> Constants<Dual<L>> for Chosen<'_, L, K> {
    #[inline(always)]
    fn times(self, x: Dual<L>, n: usize) -> Dual<L> {
        let c = self.get(n);
        Dual {
            value: x.value * c,
            slope: x.slope * c,
        }
    }
    #[inline(always)]
    fn plus(self, x: Dual<L>, n: usize) -> Dual<L> {
        Dual {
            value: x.value + self.get(n),
            slope: x.slope,
        }
    }
}
