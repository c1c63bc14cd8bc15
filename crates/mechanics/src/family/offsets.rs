//! Sets of lattice offsets with a quick test of membership.

use crate::body::Grid;

/// Which (cell offset, sublattice from, sublattice to) occur in a stencil: one bit each.
#[derive(Debug, Clone)]
pub struct OffsetSet<const D: usize> {
    reach: i64,
    /// Cells of the period, on periodic axes.
    period: [Option<i64>; D],
    basis: usize,
    bits: Vec<u64>,
}

impl<const D: usize> OffsetSet<D> {
    /// From `(cell offset, to)` of every bond of each sublattice.
    pub fn new<'a, B: 'a>(
        grid: &Grid<D>,
        bonds: &'a [Vec<B>],
        offset: impl Fn(&'a B) -> ([i32; D], usize),
    ) -> Self {
        let longest = |b: &'a B| offset(b).0.map(i32::unsigned_abs).into_iter().max();
        let reach = bonds.iter().flatten().filter_map(longest).max();
        let mut set = OffsetSet {
            reach: reach.unwrap_or(0) as i64,
            period: crate::array::from_fn(|a| {
                (grid.halo[a] > 0).then(|| (grid.cells[a] - 2 * grid.halo[a]) as i64)
            }),
            basis: grid.basis(),
            bits: vec![],
        };
        let width = 2 * set.reach as usize + 1;
        let bits = width.pow(D as u32) * set.basis * set.basis;
        set.bits = vec![0; bits.div_ceil(64)];
        for (from, list) in bonds.iter().enumerate() {
            for b in list {
                let (cell, to) = offset(b);
                if let Some(k) = set.index(cell.map(i64::from), from, to) {
                    set.bits[k / 64] |= 1 << (k % 64);
                }
            }
        }
        set
    }

    /// Place of an offset's bit; `None` outside the box of all offsets. Offsets a period apart share one.
    fn index(&self, cell: [i64; D], from: usize, to: usize) -> Option<usize> {
        let width = 2 * self.reach + 1;
        let mut k = (from * self.basis + to) as i64;
        for a in 0..D {
            let mut c = cell[a] + self.reach;
            if let Some(n) = self.period[a] {
                c = c.rem_euclid(n);
            }
            if !(0..width).contains(&c) {
                return None;
            }
            k = k * width + c;
        }
        Some(k as usize)
    }

    pub fn contains(&self, cell: [i64; D], from: usize, to: usize) -> bool {
        self.index(cell, from, to)
            .is_some_and(|k| self.bits[k / 64] >> (k % 64) & 1 == 1)
    }

    pub fn bytes(&self) -> usize {
        8 * self.bits.len()
    }
}
