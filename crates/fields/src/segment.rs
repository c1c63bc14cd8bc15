//! A bond beside the points of a brick.
//!
//! Lengths are in units of the radius R of φ. A bond begins at e and has the direction u and the length L. At the point d its foot is at
//! `s = (d − e)·u` along it, and its line passes at the squared distance `p² = |d − e|² − s²`. What lies in the ball of φ goes from
//! `τ₀ = max(−s, −h)` to `τ₁ = min(L − s, h)`, `h² = 1 − p²`, counted from the foot.

use crate::patch::{EIGHT, Lanes};

/// A bond as the points of a brick see it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Segment {
    /// u, L.
    pub along: [f64; 3],
    pub length: f64,
    /// e, e·u and |e|².
    pub begin: [f64; 3],
    pub start: f64,
    square: f64,
}

/// Points, as segments see them: their columns, and `1 − |d|²`.
pub(crate) struct View {
    pub d: [Lanes; 3],
    pub rest: Lanes,
}

impl View {
    /// Of points, from a place whose image is moved, with 1 over the unit of length.
    #[inline(always)]
    pub fn new(x: &[Lanes; 3], from: [f64; 3], over: f64) -> View {
        let mut d = [Lanes::ZERO; 3];
        let mut rest = Lanes::ZERO;
        for a in 0..3 {
            for k in 0..EIGHT {
                d[a][k] = (x[a][k] - from[a]) * over;
            }
        }
        for k in 0..EIGHT {
            let [x, y, z] = [d[0][k], d[1][k], d[2][k]];
            rest[k] = (-x).mul_add(x, (-y).mul_add(y, (-z).mul_add(z, 1.0)));
        }
        View { d, rest }
    }
}

impl Segment {
    /// From the end k, as seen from a place, to the end j; all 0 along axes that are averaged over.
    pub fn new(from: [f64; 3], bond: [f64; 3], over: f64) -> Segment {
        let mut bond = bond;
        let mut begin = from;
        let mut to = [0.0; 3];
        for a in 0..3 {
            bond[a] *= over;
            begin[a] *= over;
            to[a] = begin[a] + bond[a];
        }
        let [here, there] = [begin, to].map(|x| x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        // a bond is the same from both ends, and often the place is one
        let near = 1e-30;
        if there < here {
            begin = to;
            bond = bond.map(|c| -c);
        }
        if here.min(there) < near {
            begin = [0.0; 3];
        }
        let length = (bond[0] * bond[0] + bond[1] * bond[1] + bond[2] * bond[2]).sqrt();
        let along = bond.map(|c| if length > 0.0 { c / length } else { 0.0 });
        Segment {
            along,
            length,
            begin,
            start: begin[0] * along[0] + begin[1] * along[1] + begin[2] * along[2],
            square: begin[0] * begin[0] + begin[1] * begin[1] + begin[2] * begin[2],
        }
    }

    /// Does it begin at the place, so that `1 − |d − e|²` is that of the view?
    #[inline(always)]
    pub fn is_here(&self) -> bool {
        self.square == 0.0
    }

    /// Foot and `1 − p²` of a point.
    pub fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        let rest = (-x).mul_add(x, (-y).mul_add(y, (-z).mul_add(z, 1.0)));
        match self.is_here() {
            true => self.feet::<true>([x, y, z], rest),
            false => self.feet::<false>([x, y, z], rest),
        }
    }

    /// The same of point k of a view.
    #[inline(always)]
    pub fn foot<const HERE: bool>(&self, view: &View, k: usize) -> [f64; 2] {
        let d = [view.d[0][k], view.d[1][k], view.d[2][k]];
        self.feet::<HERE>(d, view.rest[k])
    }

    #[inline(always)]
    fn feet<const HERE: bool>(&self, [x, y, z]: [f64; 3], rest: f64) -> [f64; 2] {
        let [u, v, w] = self.along;
        let foot = x.mul_add(u, y.mul_add(v, z.mul_add(w, -self.start)));
        let mut rest = rest;
        if !HERE {
            let [a, b, c] = self.begin;
            rest += 2.0 * x.mul_add(a, y.mul_add(b, z.mul_add(c, -0.5 * self.square)));
        }
        [foot, foot.mul_add(foot, rest)]
    }
}
