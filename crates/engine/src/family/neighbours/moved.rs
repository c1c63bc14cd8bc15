//! How far points have moved since a moment.

use crate::body::{Body, Field};
use rayon::prelude::*;

/// Slots per piece of work, and per run of vector arithmetic.
const PIECE: usize = 1 << 14;
const RUN: usize = 64;

/// Displacements at the last build in single precision; the rest of them is kept only where a point is so far out
/// that single precision cannot resolve the skin.
#[derive(Debug, Clone)]
pub(super) struct Moved<const D: usize> {
    skin: f64,
    /// Not a number where there is no point, so that nothing there ever exceeds.
    high: [Vec<f32>; D],
    low: [Vec<f32>; D],
}

impl<const D: usize> Moved<D> {
    pub fn new(skin: f64) -> Self {
        Moved {
            skin,
            high: std::array::from_fn(|_| vec![]),
            low: std::array::from_fn(|_| vec![]),
        }
    }

    pub fn record(&mut self, body: &Body<D>, u: &Field<D>) {
        // rounding errs by up to 2⁻²⁴ |u|; a thousandth of the skin is put aside for it
        let limit = 1e-3 * self.skin * (1u32 << 24) as f64;
        let far = u
            .iter()
            .any(|c| body.slots.iter().any(|&s| c[s as usize].abs() > limit));
        for a in 0..D {
            self.high[a].clear();
            self.high[a].resize(body.len, f32::NAN);
            self.low[a].clear();
            if far {
                self.low[a].resize(body.len, 0.0);
            }
            for &s in &body.slots {
                let s = s as usize;
                self.high[a][s] = u[a][s] as f32;
                if far {
                    self.low[a][s] = (u[a][s] - self.high[a][s] as f64) as f32;
                }
            }
        }
    }

    /// Has a point moved so far that a listed pair could be missing? Yes before the first record.
    pub fn exceeds(&self, u: &Field<D>) -> bool {
        let slots = self.high[0].len();
        if slots == 0 {
            return true;
        }
        let pieces = slots.div_ceil(PIECE);
        let piece = |p: usize| self.most(u, p * PIECE..((p + 1) * PIECE).min(slots));
        let most = if rayon::current_num_threads() == 1 {
            (0..pieces).map(piece).fold(0.0, f64::max)
        } else {
            (0..pieces)
                .into_par_iter()
                .map(piece)
                .reduce(|| 0.0, f64::max)
        };
        // per axis one thousandth is rounding
        most.sqrt() > (0.5 - 2e-3) * self.skin
    }

    /// Greatest square of a displacement since the record. Lanes keep maxima of their own, so that it vectorises.
    fn most(&self, u: &Field<D>, slots: std::ops::Range<usize>) -> f64 {
        let mut most = [0.0f64; RUN];
        for start in slots.clone().step_by(RUN) {
            let run = start..(start + RUN).min(slots.end);
            let mut square = [0.0f64; RUN];
            for a in 0..D {
                let now = &u[a][run.clone()];
                let then = &self.high[a][run.clone()];
                if self.low[a].is_empty() {
                    for ((s, x), h) in square.iter_mut().zip(now).zip(then) {
                        let d = x - *h as f64;
                        *s += d * d;
                    }
                } else {
                    let rest = &self.low[a][run.clone()];
                    for (((s, x), h), l) in square.iter_mut().zip(now).zip(then).zip(rest) {
                        let d = x - *h as f64 - *l as f64;
                        *s += d * d;
                    }
                }
            }
            for (m, s) in most.iter_mut().zip(&square) {
                // false for what is not a number
                *m = if *s > *m { *s } else { *m };
            }
        }
        most.into_iter().fold(0.0, f64::max)
    }

    pub fn bytes(&self) -> usize {
        self.high
            .iter()
            .chain(&self.low)
            .map(|c| 4 * c.capacity())
            .sum()
    }
}
