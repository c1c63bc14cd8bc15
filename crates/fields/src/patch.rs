//! The points near a block of particles, in bricks of eight that lie close together.

use crate::frame::Cell;
use crate::targets::Bins;
use std::ops::{Index, IndexMut};

/// Numbers that are taken at once.
pub(crate) const EIGHT: usize = 8;
/// Eight numbers, where a register can take them at once.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(crate) struct Lanes(pub [f64; EIGHT]);

impl Lanes {
    pub const ZERO: Lanes = Lanes([0.0; EIGHT]);
    pub const ONE: Lanes = Lanes([1.0; EIGHT]);
}

impl Index<usize> for Lanes {
    type Output = f64;
    #[inline(always)]
    fn index(&self, k: usize) -> &f64 {
        &self.0[k]
    }
}

impl IndexMut<usize> for Lanes {
    #[inline(always)]
    fn index_mut(&mut self, k: usize) -> &mut f64 {
        &mut self.0[k]
    }
}

/// No point: a brick has fewer.
pub(crate) const NONE: u32 = u32::MAX;

/// Balls, of bricks or of groups of bricks: columns of their centres and radii, [`EIGHT`] longer than there are.
#[derive(Default)]
struct Balls {
    centre: [Vec<f64>; 3],
    radius: Vec<f64>,
}

impl Balls {
    /// About the corners of a box.
    fn push(&mut self, [low, high]: [[f64; 3]; 2]) {
        let mut square = 0.0;
        for a in 0..3 {
            let half = 0.5 * (high[a] - low[a]);
            self.centre[a].push(low[a] + half);
            square += half * half;
        }
        self.radius.push(square.sqrt());
    }

    fn finish(&mut self) {
        let all = self.centre.iter_mut().chain([&mut self.radius]);
        for column in all {
            column.resize(column.len() + EIGHT, 0.0);
        }
    }

    /// Which of eight from one on reach into a ball about x: their squared distances less what would touch.
    #[inline(always)]
    fn beyond(&self, first: usize, x: [f64; 3], reach: f64) -> [f64; EIGHT] {
        let [a, b, c] = &self.centre;
        let (a, b, c) = (&a[first..], &b[first..], &c[first..]);
        let (a, b, c) = (&a[..EIGHT], &b[..EIGHT], &c[..EIGHT]);
        let radius = &self.radius[first..][..EIGHT];
        let mut out = [0.0; EIGHT];
        for k in 0..EIGHT {
            let d = [a[k] - x[0], b[k] - x[1], c[k] - x[2]];
            let far = reach + radius[k];
            out[k] = d[0].mul_add(d[0], d[1].mul_add(d[1], d[2] * d[2])) - far * far;
        }
        out
    }
}

/// A brick near a place, and the image of it: how far it is moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub brick: u32,
    pub shift: [f64; 3],
}

/// Points near a block of particles.
pub(crate) struct Patch<'a> {
    bins: &'a Bins<'a>,
    /// Axes of which all bins are there, once each: images of them are seen by moving them.
    whole: [bool; 3],
    /// Of all points, [`EIGHT`] for each brick; [`NONE`] where it has fewer.
    pub index: Vec<u32>,
    /// Coordinates of eight points each; 0 along axes that are averaged over. What is no point lies where one is.
    pub bricks: Vec<[Lanes; 3]>,
    balls: Balls,
    /// Half the extents of bricks along the axes.
    half: Vec<[f64; 3]>,
    /// Of eight bricks each, and where these begin.
    groups: Balls,
    first: Vec<u32>,
}

impl<'a> Patch<'a> {
    /// The points near a box of fractions.
    pub fn of(bins: &'a Bins<'a>, bounds: [[f64; 3]; 2]) -> Patch<'a> {
        let mut first = [0; 3];
        let mut size = [0; 3];
        for a in 0..3 {
            let [from, count] = bins.range(a, bounds[0][a], bounds[1][a], bins.radius);
            // all of an axis that repeats begin at 0
            [first[a], size[a]] = match bins.repeats[a] && count >= bins.bins[a] {
                true => [0, bins.bins[a]],
                false => [from, count],
            };
        }
        let mut patch = Patch {
            bins,
            whole: std::array::from_fn(|a| bins.repeats[a] && size[a] == bins.bins[a]),
            index: vec![],
            bricks: vec![],
            balls: Balls::default(),
            half: vec![],
            groups: Balls::default(),
            first: vec![],
        };
        match bins.spacing {
            Some(spacing) => patch.grid(first, size, spacing),
            None => patch.list(first, size),
        }
        patch.finish();
        patch
    }

    /// Has somebody had enough? What is made of the patch is then nothing.
    #[inline(always)]
    pub fn stopped(&self) -> bool {
        (self.bins.stop)()
    }

    /// No points?
    pub fn is_empty(&self) -> bool {
        self.bricks.is_empty()
    }

    /// Points of a bin, and where they are.
    fn members(&self, bin: [i32; 3], out: &mut Vec<(u32, [f64; 3])>) {
        let bins = self.bins;
        let mut place = bin;
        let mut image = [0; 3];
        for a in (0..3).filter(|a| bins.repeats[*a]) {
            place[a] = bin[a].rem_euclid(bins.bins[a]);
            image[a] = bin[a].div_euclid(bins.bins[a]);
        }
        let place = bins.index(place);
        let shift = bins.cell.shift(image);
        for &p in &bins.order[bins.start[place] as usize..bins.start[place + 1] as usize] {
            let x: [f64; 3] = std::array::from_fn(|a| bins.wrapped[p as usize][a] + shift[a]);
            out.push((p, self.project(x)));
        }
    }

    /// A grid has a point in each bin: bricks are blocks of bins, as round as can be.
    fn grid(&mut self, first: [i32; 3], size: [i32; 3], spacing: [f64; 3]) {
        if size.contains(&0) {
            return;
        }
        let brick = shape(size, spacing, self.bins.radius);
        let many: [i32; 3] = std::array::from_fn(|a| (size[a] + brick[a] - 1) / brick[a]);
        let group = shape(
            many,
            std::array::from_fn(|a| spacing[a] * f64::from(brick[a])),
            self.bins.radius,
        );
        let groups = std::array::from_fn(|a| (many[a] + group[a] - 1) / group[a]);
        let mut some = vec![];
        for g in places([0; 3], groups) {
            if self.stopped() {
                break;
            }
            self.first.push(self.bricks.len() as u32);
            let from: [i32; 3] = std::array::from_fn(|a| g[a] * group[a]);
            let to = std::array::from_fn(|a| (from[a] + group[a]).min(many[a]));
            for b in places(from, to) {
                let from: [i32; 3] = std::array::from_fn(|a| b[a] * brick[a]);
                let to = std::array::from_fn(|a| (from[a] + brick[a]).min(size[a]));
                some.clear();
                for n in places(from, to) {
                    self.members(std::array::from_fn(|a| first[a] + n[a]), &mut some);
                }
                self.add(&some);
            }
        }
    }

    /// Points in the order of a curve that stays near itself (Morton's).
    fn list(&mut self, first: [i32; 3], size: [i32; 3]) {
        let mut all = vec![];
        for n in places([0; 3], size) {
            self.members(std::array::from_fn(|a| first[a] + n[a]), &mut all);
        }
        let [low, high] = bounds(&all);
        let edge = (0..3).fold(0.0f64, |m, a| m.max(high[a] - low[a]));
        let over = if edge > 0.0 { 1023.0 / edge } else { 0.0 };
        all.sort_by_cached_key(|(p, x)| {
            let key: u32 = (0..3)
                .map(|a| spread(((x[a] - low[a]) * over) as u32) << a)
                .sum();
            (key, *p)
        });
        for some in all.chunks(EIGHT * EIGHT) {
            self.first.push(self.bricks.len() as u32);
            self.add(some);
        }
    }

    /// Bricks of these points.
    fn add(&mut self, all: &[(u32, [f64; 3])]) {
        for some in all.chunks(EIGHT) {
            let mut brick = [Lanes::ZERO; 3];
            for k in 0..EIGHT {
                let (p, x) = some[k.min(some.len() - 1)];
                self.index.push(if k < some.len() { p } else { NONE });
                (0..3).for_each(|a| brick[a][k] = x[a]);
            }
            self.bricks.push(brick);
            let [low, high] = bounds(some);
            self.half
                .push(std::array::from_fn(|a| 0.5 * (high[a] - low[a])));
            self.balls.push([low, high]);
        }
    }

    fn finish(&mut self) {
        for (n, from) in self.first.iter().enumerate() {
            let to = self
                .first
                .get(n + 1)
                .map_or(self.bricks.len(), |t| *t as usize);
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for brick in &self.bricks[*from as usize..to] {
                for a in 0..3 {
                    low[a] = brick[a].0.iter().fold(low[a], |m, x| m.min(*x));
                    high[a] = brick[a].0.iter().fold(high[a], |m, x| m.max(*x));
                }
            }
            self.groups.push([low, high]);
        }
        self.first.push(self.bricks.len() as u32);
        self.balls.finish();
        self.groups.finish();
    }

    /// The part of a vector that counts.
    pub fn project(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| if self.bins.counts[a] { x[a] } else { 0.0 })
    }

    /// Centre of a brick, and half its extents along the axes.
    #[inline(always)]
    pub fn middle(&self, brick: u32) -> [[f64; 3]; 2] {
        let [x, y, z] = &self.balls.centre;
        let n = brick as usize;
        [[x[n], y[n], z[n]], self.half[n]]
    }

    /// Bricks with points that may be nearer to x than the reach.
    #[inline(always)]
    pub fn near(&self, x: [f64; 3], reach: f64, out: &mut Vec<Seen>) {
        out.clear();
        let images = self.images(x, reach);
        // a little more, so that round-off loses nothing
        let reach = reach * (1.0 + 1e-9);
        for i in images[0][0]..=images[0][1] {
            for j in images[1][0]..=images[1][1] {
                if self.stopped() {
                    return;
                }
                for k in images[2][0]..=images[2][1] {
                    let shift = self.project(self.bins.cell.shift([i, j, k]));
                    let own = self.project(x);
                    let at = [own[0] - shift[0], own[1] - shift[1], own[2] - shift[2]];
                    self.about(at, reach, shift, out);
                }
            }
        }
    }

    #[inline(always)]
    fn about(&self, at: [f64; 3], reach: f64, shift: [f64; 3], out: &mut Vec<Seen>) {
        let count = self.first.len() - 1;
        let mut g = 0;
        while g < count {
            let beyond = self.groups.beyond(g, at, reach);
            let most = EIGHT.min(count - g);
            for n in 0..most {
                if beyond[n] > 0.0 {
                    continue;
                }
                let [from, to] = [self.first[g + n] as usize, self.first[g + n + 1] as usize];
                let beyond = self.balls.beyond(from, at, reach);
                for b in from..to {
                    if beyond[b - from] <= 0.0 {
                        let brick = b as u32;
                        out.push(Seen { brick, shift });
                    }
                }
            }
            g += EIGHT;
        }
    }

    /// Images of the cell along each axis from which a ball is reached: from and to.
    fn images(&self, x: [f64; 3], reach: f64) -> [[i32; 2]; 3] {
        let bins = self.bins;
        let cell: &Cell = bins.cell;
        let s = cell.fraction(x);
        std::array::from_fn(|a| match self.whole[a] {
            true => {
                let wide = reach / bins.height[a] * (1.0 + 1e-9) + 1e-12;
                [s[a] - wide, s[a] + wide].map(|t| t.floor().clamp(-1e6, 1e6) as i32)
            }
            false => [0; 2],
        })
    }
}

/// All triples from one to before another, the first axis fastest.
fn places(from: [i32; 3], to: [i32; 3]) -> impl Iterator<Item = [i32; 3]> {
    (from[2]..to[2]).flat_map(move |k| {
        (from[1]..to[1]).flat_map(move |j| (from[0]..to[0]).map(move |i| [i, j, k]))
    })
}

fn bounds(all: &[(u32, [f64; 3])]) -> [[f64; 3]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (_, x) in all {
        for a in 0..3 {
            (low[a], high[a]) = (low[a].min(x[a]), high[a].max(x[a]));
        }
    }
    [low, high]
}

/// Edges of blocks of eight: those with which a ball of this radius looks at the fewest points.
fn shape(size: [i32; 3], spacing: [f64; 3], radius: f64) -> [i32; 3] {
    let mut best = ([EIGHT as i32, 1, 1], f64::INFINITY);
    for i in 0..4 {
        for j in 0..4 - i {
            let edge: [i32; 3] = [i, j, 3 - i - j].map(|n| 1 << n);
            let (mut square, mut count) = (0.0, 1.0);
            for a in 0..3 {
                let extent = spacing[a] * f64::from(edge[a] - 1);
                square += 0.25 * extent * extent;
                count *= f64::from((size[a] + edge[a] - 1) / edge[a]);
            }
            let cost = count * (radius + square.sqrt()).powi(3);
            if cost < best.1 {
                best = (edge, cost);
            }
        }
    }
    best.0
}

/// Bits of a number below 1024, two places between each.
fn spread(mut x: u32) -> u32 {
    x = (x | x << 16) & 0x0300_00ff;
    x = (x | x << 8) & 0x0300_f00f;
    x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}
