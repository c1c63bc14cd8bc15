//! Linked cells on a folded space: on every axis, space is wound up on a ring of whole cells.
//!
//! A periodic axis is wound up on its period. An open axis is wound up on the extent of the reference body, so that
//! the number of cells is fixed however far debris flies; far points share cells with near ones, and the true
//! distance tells them apart. A coordinate on a ring is a fraction of its length, of 32 bits while points are sorted, so
//! that the difference of two wraps around to the shorter way by itself. What is kept are its last 8 bits in units of
//! about 1/64 of a cell: enough to tell two points of adjacent cells apart, and it wraps around in the same way.

use super::ghosts::Ghost;
use super::rings::{FULL, cell_at, each_around, each_point, number, wind};
use crate::body::{Body, FieldView};

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
    /// Of the body, when it had all of its own.
    points: usize,
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
            points: body.points(),
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

    /// Put all points into their cells at displacement `u`, and ghosts that follow the slots.
    pub fn sort(&mut self, body: &Body<D>, ghosts: &[Ghost], u: FieldView<D>) {
        let all = self.points + ghosts.len();
        self.order.resize(all, 0);
        self.place.iter_mut().for_each(|p| p.resize(all + LANES, 0));
        let inverse = self.length.map(|l| FULL / l);
        let place = |slot: usize, x: [f64; D]| -> [u32; D] {
            crate::array::from_fn(|a| wind((x[a] + u[a][slot]) * inverse[a]))
        };
        let (count, units) = (self.count, self.units());
        let cell = |p: &[u32; D]| number(count, cell_at(count, p));
        self.start.fill(0);
        each_of_all(body, ghosts, |slot, x| {
            self.start[cell(&place(slot, x))] += 1
        });
        let mut sum = 0;
        for s in &mut self.start {
            sum += std::mem::replace(s, sum);
        }
        each_of_all(body, ghosts, |slot, x| {
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
                each_around(self.count, at, |other| {
                    if other < cell {
                        return;
                    }
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

    pub fn bytes(&self) -> usize {
        4 * (self.start.len() + self.order.len()) + D * self.place[0].len()
    }
}

/// Slot and reference position of every point, and of ghosts that follow the slots.
fn each_of_all<const D: usize>(
    body: &Body<D>,
    ghosts: &[Ghost],
    mut visit: impl FnMut(usize, [f64; D]),
) {
    each_point(body, &mut visit);
    for (slot, ghost) in (body.len..).zip(ghosts) {
        visit(slot, crate::array::from_fn(|a| ghost.position[a]));
    }
}
