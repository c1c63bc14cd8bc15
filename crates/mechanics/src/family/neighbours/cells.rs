//! Linked cells on a folded space: on every axis, space is wound up on a ring of whole cells.
//!
//! A periodic axis is wound up on its period. An open axis is wound up on the extent of the reference body, so that
//! the number of cells is fixed however far debris flies; far points share cells with near ones, and the true
//! distance tells them apart. A coordinate on a ring is a fraction of its length, of 32 bits while points are sorted, so
//! that the difference of two wraps around to the shorter way by itself. What is kept are its last 8 bits in units of
//! about 1/64 of a cell: enough to tell two points of adjacent cells apart, and it wraps around in the same way.

use crate::body::{Body, FieldView, Layout};

const FULL: f64 = (1u64 << 32) as f64;

/// Pairs that are tested at a time.
const LANES: usize = 8;

#[derive(Debug, Clone)]
pub(super) struct Cells<const D: usize> {
    reach: f64,
    /// Cells per axis.
    count: [usize; D],
    /// Length of the rings.
    length: [f64; D],
    /// `[cells + 1]` first point of every cell.
    start: Vec<u32>,
    /// Slots, and their coordinates on the rings (with room to read whole lanes at the end), in order of cells.
    order: Vec<u32>,
    place: [Vec<u8>; D],
}

impl<const D: usize> Cells<D> {
    /// Cells for pairs closer than `reach`.
    pub fn new(body: &Body<D>, reach: f64) -> Self {
        let mut low = [f64::INFINITY; D];
        let mut high = [f64::NEG_INFINITY; D];
        each_point(body, |_, x| {
            for a in 0..D {
                low[a] = low[a].min(x[a]);
                high[a] = high[a].max(x[a]);
            }
        });
        // a little wider than the reach, for the round-off of points far out; nothing is gained by cells without points
        let edge = reach.max(body.spacing) * (1.0 + 1e-6);
        let mut count: [usize; D] = crate::array::from_fn(|a| match body.period[a] {
            Some(p) => ((p / edge) as usize).max(1),
            None => ((high[a] - low[a]) / edge).min(1e9) as usize + 3,
        });
        // mostly empty space gets wound up tighter
        let limit = (body.points() / 2).max(27);
        while count.iter().fold(1usize, |n, c| n.saturating_mul(*c)) > limit {
            let Some(widest) = (0..D).filter(|a| count[*a] > 3).max_by_key(|a| count[*a]) else {
                break;
            };
            count[widest] = (count[widest] / 2).max(3);
        }
        Cells {
            reach,
            count,
            length: crate::array::from_fn(|a| body.period[a].unwrap_or(count[a] as f64 * edge)),
            start: vec![0; count.iter().product::<usize>() + 1],
            order: vec![0; body.points()],
            place: crate::array::from_fn(|_| vec![0; body.points() + LANES]),
        }
    }

    /// Units on each ring: whole turns of 8 bits, of at most four cells each.
    fn units(&self) -> [u64; D] {
        self.count.map(|n| 256 * (n as u64 / 4).max(1))
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// Slots of the points in a cell.
    pub fn slots(&self, cell: usize) -> &[u32] {
        &self.order[self.start[cell] as usize..self.start[cell + 1] as usize]
    }

    /// Put all points into their cells at displacement `u`.
    pub fn sort(&mut self, body: &Body<D>, u: FieldView<D>) {
        let inverse = self.length.map(|l| FULL / l);
        let place = |slot: usize, x: [f64; D]| -> [u32; D] {
            crate::array::from_fn(|a| wind((x[a] + u[a][slot]) * inverse[a]))
        };
        let (count, units) = (self.count, self.units());
        let cell = |p: &[u32; D]| {
            let mut c = 0;
            for a in (0..D).rev() {
                c = c * count[a] + ((p[a] as u64 * count[a] as u64) >> 32) as usize;
            }
            c
        };
        self.start.fill(0);
        each_point(body, |slot, x| self.start[cell(&place(slot, x))] += 1);
        let mut sum = 0;
        for s in &mut self.start {
            sum += std::mem::replace(s, sum);
        }
        each_point(body, |slot, x| {
            let p = place(slot, x);
            let next = &mut self.start[cell(&p)];
            self.order[*next as usize] = slot as u32;
            for a in 0..D {
                self.place[a][*next as usize] = ((p[a] as u64 * units[a]) >> 32) as u8;
            }
            *next += 1;
        });
        // every start has become the next one
        let cells = self.len();
        self.start.copy_within(0..cells, 1);
        self.start[0] = 0;
    }

    /// Every pair of points that are closer than the reach on the rings, once, except between cells that `skip`.
    pub fn each_near(&self, skip: impl Fn(usize, usize) -> bool, mut visit: impl FnMut(u32, u32)) {
        let units = self.units();
        let unit: [f64; D] = crate::array::from_fn(|a| self.length[a] / units[a] as f64);
        // each coordinate is cut off to its unit, so that differences are less than one unit off; squares are relative to
        // the reach, in single precision
        let off = unit.iter().map(|u| u * u).sum::<f64>().sqrt();
        let limit = 1.0 + off / self.reach;
        let limit = (limit * limit * (1.0 + 1e-6)) as f32;
        let unit = unit.map(|l| (l / self.reach) as f32);
        let mut at = [0usize; D];
        for cell in 0..self.len() {
            let own = self.start[cell] as usize..self.start[cell + 1] as usize;
            if !own.is_empty() {
                self.each_adjacent(cell, at, |other| {
                    let theirs = self.start[other] as usize..self.start[other + 1] as usize;
                    if theirs.is_empty() || skip(cell, other) {
                        return;
                    }
                    for p in own.clone() {
                        let x: [u8; D] = crate::array::from_fn(|a| self.place[a][p]);
                        let from = if other == cell { p + 1 } else { theirs.start };
                        for q in (from..theirs.end).step_by(LANES) {
                            let mut near = self.near(x, q, unit, limit);
                            if theirs.end - q < LANES {
                                near &= (1 << (theirs.end - q)) - 1;
                            }
                            while near != 0 {
                                visit(
                                    self.order[p],
                                    self.order[q + near.trailing_zeros() as usize],
                                );
                                near &= near - 1;
                            }
                        }
                    }
                });
            }
            for a in 0..D {
                at[a] += 1;
                if at[a] < self.count[a] {
                    break;
                }
                at[a] = 0;
            }
        }
    }

    /// Which of the points from the `q`th on are near to a place: one bit each.
    #[inline(always)]
    fn near(&self, x: [u8; D], q: usize, unit: [f32; D], limit: f32) -> u32 {
        let mut square = [0f32; LANES];
        for a in 0..D {
            for (s, y) in square.iter_mut().zip(&self.place[a][q..q + LANES]) {
                let d = y.wrapping_sub(x[a]) as i8 as f32 * unit[a];
                *s += d * d;
            }
        }
        let mut near = 0;
        for (l, s) in square.iter().enumerate() {
            near |= ((*s <= limit) as u32) << l;
        }
        near
    }

    /// The distinct cells around a cell, itself included, that do not come before it.
    fn each_adjacent(&self, cell: usize, at: [usize; D], mut visit: impl FnMut(usize)) {
        // 3^D of them, built up axis by axis
        let mut around = [0usize; 27];
        let (mut len, mut stride) = (1, 1);
        for a in 0..D {
            let n = self.count[a];
            let up = if at[a] + 1 == n { 0 } else { at[a] + 1 };
            let down = if at[a] == 0 { n - 1 } else { at[a] - 1 };
            let ring = [at[a], up, down];
            let distinct = n.min(3);
            for k in (0..len).rev() {
                for (r, c) in ring[..distinct].iter().enumerate().rev() {
                    around[r * len + k] = around[k] + c * stride;
                }
            }
            len *= distinct;
            stride *= n;
        }
        around[..len]
            .iter()
            .filter(|c| **c >= cell)
            .for_each(|c| visit(*c));
    }

    pub fn bytes(&self) -> usize {
        4 * (self.start.len() + self.order.len()) + D * self.place[0].len()
    }
}

/// The fraction of `t / 2³²` above a whole number, in units of 2⁻³²: the low half of the integer.
fn wind(t: f64) -> u32 {
    t as i64 as u32
}

/// Slot and reference position of every point. On a grid, walked row by row: finding the coordinates of a single slot
/// takes divisions.
fn each_point<const D: usize>(body: &Body<D>, mut visit: impl FnMut(usize, [f64; D])) {
    each_of(body, 0, &mut visit);
}

/// The same of a body whose slots begin at `start`.
fn each_of<const D: usize>(body: &Body<D>, start: usize, visit: &mut impl FnMut(usize, [f64; D])) {
    let grid = match &body.layout {
        Layout::Cloud(x) => {
            for &slot in &body.slots {
                visit(
                    start + slot as usize,
                    crate::array::from_fn(|a| x[a][slot as usize]),
                );
            }
            return;
        }
        Layout::Several(pieces) => {
            for p in pieces {
                each_of(&p.body, p.first, visit);
            }
            return;
        }
        Layout::Grid(grid) => grid,
    };
    let lattice = &grid.lattice;
    let edges = lattice.kind.edges();
    let rows: usize = grid.cells[1..].iter().product();
    for (b, site) in lattice.kind.basis().iter().enumerate() {
        let coordinate = |a: usize, c: usize| {
            let quarter = 4 * (c as i32 + grid.low[a]) + site[a];
            lattice.origin[a] + lattice.spacing * edges[a] * (quarter as f64 / 4.0)
        };
        for row in 0..rows {
            let mut x = [0.0; D];
            let mut rest = row;
            for a in 1..D {
                x[a] = coordinate(a, rest % grid.cells[a]);
                rest /= grid.cells[a];
            }
            let first = grid.guard + b * grid.stride + row * grid.cells[0];
            for c in 0..grid.cells[0] {
                if grid.is_owned(first + c) {
                    x[0] = coordinate(0, c);
                    visit(start + first + c, x);
                }
            }
        }
    }
}
