//! A cell list over reference positions: who may be within reach of whom.

/// Points sorted into cells of at least half the search radius, x fastest.
pub struct Cells<'a, const D: usize> {
    position: [&'a [f64]; D],
    period: [f64; D],
    inv_period: [f64; D],
    low: [f64; D],
    inv_edge: [f64; D],
    count: [usize; D],
    /// Cells to look at on either side.
    reach: [usize; D],
    /// First member of every cell, and the end.
    start: Vec<u32>,
    /// Slots, and their positions, cell by cell.
    slot: Vec<u32>,
    x: [Vec<f64>; D],
}

impl<'a, const D: usize> Cells<'a, D> {
    /// Cells for these slots; a period must be longer than twice the radius.
    pub fn new(
        position: [&'a [f64]; D],
        slots: &[u32],
        period: [Option<f64>; D],
        radius: f64,
    ) -> Self {
        let mut low = [0.0; D];
        let mut extent = [0.0; D];
        for a in 0..D {
            let range = { slots.iter().map(|s| position[a][*s as usize]) }
                .fold([f64::INFINITY, f64::NEG_INFINITY], |r, x| {
                    [r[0].min(x), r[1].max(x)]
                });
            low[a] = range[0];
            extent[a] = period[a].unwrap_or(range[1] - range[0]);
        }
        let points = slots.len();
        // a little more than half the radius: round-off at a cell's border loses no partner
        let mut edge = 0.5 * (1.0 + 1e-6) * radius;
        let cells = |edge: f64| -> [f64; D] { extent.map(|e: f64| (e / edge).floor().max(1.0)) };
        while cells(edge).iter().product::<f64>() > 8.0 * points as f64 + 64.0 {
            edge *= 1.5;
        }
        let count = cells(edge).map(|c| c as usize);
        let width: [f64; D] = crate::array::from_fn(|a| (extent[a] / count[a] as f64).max(edge));
        let mut cells = Cells {
            position,
            period: period.map(|p| p.unwrap_or(0.0)),
            inv_period: period.map(|p| p.map_or(0.0, f64::recip)),
            low,
            inv_edge: width.map(f64::recip),
            count,
            reach: width.map(|w| ((1.0 + 1e-6) * radius / w).ceil() as usize),
            start: vec![0; count.iter().product::<usize>() + 1],
            slot: vec![0; points],
            x: crate::array::from_fn(|_| vec![0.0; points]),
        };
        let of: Vec<u32> = { slots.iter() }
            .map(|i| {
                let c = cells.cell(*i as usize);
                (0..D).rev().fold(0, |n, a| n * count[a] + c[a]) as u32
            })
            .collect();
        for &c in &of {
            cells.start[c as usize + 1] += 1;
        }
        for c in 1..cells.start.len() {
            cells.start[c] += cells.start[c - 1];
        }
        let mut next = cells.start.clone();
        for (&i, &c) in slots.iter().zip(&of) {
            let n = next[c as usize] as usize;
            next[c as usize] += 1;
            cells.slot[n] = i;
            for a in 0..D {
                cells.x[a][n] = position[a][i as usize];
            }
        }
        cells
    }

    fn cell(&self, i: usize) -> [usize; D] {
        crate::array::from_fn(|a| {
            let mut x = self.position[a][i] - self.low[a];
            if self.period[a] > 0.0 {
                x = x.rem_euclid(self.period[a]);
            }
            ((x * self.inv_edge[a]) as usize).min(self.count[a] - 1)
        })
    }

    /// Up to two ranges of cells along axis `a` within reach of cell `c`.
    fn ranges(&self, a: usize, c: usize) -> [std::ops::Range<usize>; 2] {
        let (n, r) = (self.count[a], self.reach[a]);
        if self.period[a] == 0.0 {
            [c.saturating_sub(r)..(c + r + 1).min(n), 0..0]
        } else if 2 * r + 1 >= n {
            [0..n, 0..0]
        } else if c < r {
            [0..c + r + 1, n + c - r..n]
        } else if c + r >= n {
            [c - r..n, 0..c + r + 1 - n]
        } else {
            [c - r..c + r + 1, 0..0]
        }
    }

    /// Call `visit(slot, r²)` for everything that may be within the radius of slot `i`, `i` included; r² of the
    /// nearest image.
    #[inline(always)]
    pub fn candidates(&self, i: usize, mut visit: impl FnMut(u32, f64)) {
        let c = self.cell(i);
        let one = [0..1, 0..0];
        let axis = |a: usize| {
            if a < D {
                self.ranges(a, c[a])
            } else {
                one.clone()
            }
        };
        let (xs, ys, zs) = (axis(0), axis(1), axis(2));
        let at: [f64; D] = crate::array::from_fn(|a| self.position[a][i]);
        let periodic = self.period.iter().any(|p| *p > 0.0);
        let stride = |a: usize| if a < D { self.count[a] } else { 1 };
        for z in zs.iter().cloned().flatten() {
            for y in ys.iter().cloned().flatten() {
                let row = (z * stride(1) + y) * stride(0);
                for run in &xs {
                    if run.is_empty() {
                        continue;
                    }
                    let members =
                        self.start[row + run.start] as usize..self.start[row + run.end] as usize;
                    for n in members {
                        let mut square = 0.0;
                        for a in 0..D {
                            let mut d = self.x[a][n] - at[a];
                            if periodic {
                                d -= (d * self.inv_period[a]).round_ties_even() * self.period[a];
                            }
                            square += d * d;
                        }
                        visit(self.slot[n], square);
                    }
                }
            }
        }
    }
}
