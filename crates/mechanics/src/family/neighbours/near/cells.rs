//! Small cells over the box and its margin, or over the extent of free atoms.

use crate::body::Body;
use crate::execute::blocks::for_each_piece;

/// In place of an atom where a tile has none.
pub(super) const NOBODY: u32 = u32::MAX;
/// Where atoms that are not there are (in reaches), so that no pair with them counts.
pub(super) const NOWHERE: f64 = 1e30;
/// Cells per reach and axis.
const PER: usize = 2;

/// The least box that holds some atoms.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent<const D: usize> {
    pub low: [f64; D],
    pub high: [f64; D],
    /// All coordinates are numbers.
    pub finite: bool,
}

impl<const D: usize> Extent<D> {
    /// Of no atoms.
    pub const EMPTY: Self = Extent {
        low: [f64::INFINITY; D],
        high: [f64::NEG_INFINITY; D],
        finite: true,
    };

    /// With one more atom.
    #[inline(always)]
    pub fn with(mut self, y: &[f64; 4]) -> Self {
        for a in 0..D {
            self.low[a] = self.low[a].min(y[a]);
            self.high[a] = self.high[a].max(y[a]);
            self.finite &= y[a].is_finite();
        }
        self
    }

    /// That of the atoms of all ranks that have some.
    pub fn of_all(mut self, body: &Body<D>) -> Self {
        for a in 0..D {
            self.low[a] = body.least(self.low[a]);
            self.high[a] = body.most(self.high[a]);
        }
        self.finite = body.count(u64::from(!self.finite)) == 0;
        self
    }

    /// And what another holds.
    pub fn add(&mut self, o: Self) {
        for a in 0..D {
            self.low[a] = self.low[a].min(o.low[a]);
            self.high[a] = self.high[a].max(o.high[a]);
        }
        self.finite &= o.finite;
    }
}

pub(super) struct Cells<const D: usize> {
    low: [f64; D],
    inverse: [f64; D],
    count: [usize; D],
}

/// Items in order of kinds, those of a kind in order of cells, those of a cell in order of their numbers.
pub(super) struct Sorted {
    /// `[kinds × cells + 1]`: the first of every cell.
    start: Vec<u32>,
    pub item: Vec<u32>,
}

impl Sorted {
    /// Where the cells of a kind begin.
    #[inline(always)]
    pub fn starts(&self, kind: usize, kinds: usize) -> &[u32] {
        &self.start[kind * ((self.start.len() - 1) / kinds)..]
    }
}

/// Some of the cells, a bit each.
pub(super) struct Marked(Vec<u64>);

impl Marked {
    pub fn none<const D: usize>(cells: &Cells<D>) -> Marked {
        Marked(vec![0; cells.count.iter().product::<usize>().div_ceil(64)])
    }

    /// The cell of `y` is one.
    pub fn mark<const D: usize>(&mut self, cells: &Cells<D>, y: &[f64; 4]) {
        let cell = cells.of(y);
        self.0[cell / 64] |= 1 << (cell % 64);
    }

    /// Is any within so many reaches of `y`?
    pub fn is_near<const D: usize>(&self, cells: &Cells<D>, y: &[f64; 4], reaches: usize) -> bool {
        let (low, high) = cells.within(y, reaches);
        let has = |cell: usize| self.0[cell / 64] >> (cell % 64) & 1 == 1;
        (0..Cells::rows(&low, &high)).any(|n| {
            let row = cells.row(n, &low, &high);
            (row + low[0]..=row + high[0]).any(has)
        })
    }
}

impl<const D: usize> Cells<D> {
    /// For so many atoms within `extent`.
    pub fn new(atoms: usize, extent: &Extent<D>, reach: f64, period: &[Option<f64>; D]) -> Self {
        let mut cells = Cells {
            low: [0.0; D],
            inverse: [1.0; D],
            count: [1; D],
        };
        let mut lengths = [0.0; D];
        for a in 0..D {
            let (mut low, mut high) = match period[a] {
                Some(p) => (-reach, p + reach),
                None => (extent.low[a], extent.high[a]),
            };
            if !(low.is_finite() && high.is_finite()) {
                (low, high) = (0.0, reach);
            }
            cells.low[a] = low;
            lengths[a] = (high - low).max(reach);
            let count = (lengths[a] / reach * PER as f64).floor();
            cells.count[a] = count.clamp(1.0, 1e9) as usize;
        }
        // at most four cells per atom: atoms that flew away must not cost memory, and a wire needs cells along its axis
        let most = 4 * atoms + 1000;
        while cells.count.iter().fold(1usize, |n, c| n.saturating_mul(*c)) > most {
            let widest = cells.count.iter_mut().max();
            widest.into_iter().for_each(|c| *c = c.div_ceil(2));
        }
        cells.inverse = crate::array::from_fn(|a| cells.count[a] as f64 / lengths[a]);
        cells
    }

    #[inline(always)]
    fn along(&self, y: &[f64; 4], a: usize) -> usize {
        let c = ((y[a] - self.low[a]) * self.inverse[a]).floor();
        c.clamp(0.0, self.count[a] as f64 - 1.0) as usize
    }

    pub fn of(&self, y: &[f64; 4]) -> usize {
        (0..D)
            .rev()
            .fold(0, |c, a| c * self.count[a] + self.along(y, a))
    }

    /// Sort items of which is known where and of what kind they are.
    pub fn sort(
        &self,
        items: usize,
        kinds: usize,
        kind: impl Fn(usize) -> usize + Sync,
        at: impl Fn(usize) -> [f64; 4] + Sync,
    ) -> Sorted {
        let cells = self.count.iter().product::<usize>();
        let mut cell = vec![0u32; items];
        for_each_piece(&mut cell, |first, piece| {
            for (n, cell) in piece.iter_mut().enumerate() {
                *cell = (kind(first + n) * cells + self.of(&at(first + n))) as u32;
            }
        });
        // where the next item of every cell goes, one cell late: in the end, where every cell begins
        let mut start = vec![0u32; kinds * cells + 2];
        for &c in &cell {
            start[c as usize + 2] += 1;
        }
        for c in 2..start.len() {
            start[c] += start[c - 1];
        }
        let mut item = vec![0u32; items];
        for (n, &c) in cell.iter().enumerate() {
            let next = &mut start[c as usize + 1];
            item[*next as usize] = n as u32;
            *next += 1;
        }
        start.pop();
        Sorted { start, item }
    }

    /// The lowest and highest cells that are within reach of `y`.
    #[inline(always)]
    pub fn around(&self, y: &[f64; 4]) -> ([usize; D], [usize; D]) {
        self.within(y, 1)
    }

    /// Within so many reaches.
    #[inline(always)]
    fn within(&self, y: &[f64; 4], reaches: usize) -> ([usize; D], [usize; D]) {
        let (mut low, mut high) = ([0; D], [0; D]);
        for a in 0..D {
            let (c, by) = (self.along(y, a), reaches * PER);
            (low[a], high[a]) = (c.saturating_sub(by), (c + by).min(self.count[a] - 1));
        }
        (low, high)
    }

    /// Rows of cells along x in a box of cells.
    #[inline(always)]
    pub fn rows(low: &[usize; D], high: &[usize; D]) -> usize {
        let mut rows = 1;
        for a in 1..D {
            rows *= high[a] - low[a] + 1;
        }
        rows
    }

    /// The cell before the first of row `n` of a box of cells, by `low[0]`.
    #[inline(always)]
    fn row(&self, n: usize, low: &[usize; D], high: &[usize; D]) -> usize {
        let (mut rest, mut row) = (n, 0);
        let mut at = [0; D];
        for a in 1..D {
            let width = high[a] - low[a] + 1;
            at[a] = low[a] + rest % width;
            rest /= width;
        }
        for a in (1..D).rev() {
            row = (row + at[a]) * self.count[a - 1];
        }
        row
    }

    /// Items of row `n` of a box of cells.
    #[inline(always)]
    pub fn run(
        &self,
        n: usize,
        low: &[usize; D],
        high: &[usize; D],
        start: &[u32],
    ) -> (usize, usize) {
        let row = self.row(n, low, high);
        (
            start[row + low[0]] as usize,
            start[row + high[0] + 1] as usize,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wire_has_cells_along_its_axis() {
        let of = |length: f64| {
            let extent = Extent {
                low: [0.0; 3],
                high: [length, 2.0, 2.0],
                finite: true,
            };
            Cells::<3>::new(8000, &extent, 1.0, &[None; 3]).count
        };
        // 4000 × 4 × 4 are too many for so few atoms, half of them are not
        assert_eq!(of(2000.0), [2000, 4, 4]);
        assert_eq!(of(500.0), [1000, 4, 4]);
        // one atom that flew away
        let far: usize = of(1e12).iter().product();
        assert!((1000..=33_000).contains(&far), "{far}");
    }
}
