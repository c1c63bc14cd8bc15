//! The points near a block of particles, side by side.

use crate::targets::Bins;

/// Numbers that are taken at once.
pub(crate) const EIGHT: usize = 8;

/// Points side by side in a patch, and the periods by which they are to be moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    pub from: u32,
    pub to: u32,
    pub shift: [f64; 3],
}

/// Runs of points, and room to find them.
#[derive(Debug, Default)]
pub(crate) struct Runs {
    pub all: Vec<Run>,
    pieces: [Vec<[i32; 3]>; 3],
}

impl Runs {
    pub fn points(&self) -> usize {
        self.all
            .iter()
            .map(|run| (run.to - run.from) as usize)
            .sum()
    }
}

/// Points near a block of particles.
pub(crate) struct Patch<'a> {
    bins: &'a Bins<'a>,
    /// Axes of which all bins are there.
    whole: [bool; 3],
    first: [i32; 3],
    size: [i32; 3],
    start: Vec<u32>,
    /// Of all points.
    pub index: Vec<u32>,
    /// Columns of their coordinates, of the image near the block; 0 along axes that are averaged over. [`EIGHT`] longer than `index`.
    pub x: [Vec<f64>; 3],
    /// The same of the first points of rows along x, where there are such rows.
    rows: [Vec<f64>; 3],
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
            first,
            size,
            start: vec![0],
            index: vec![],
            x: Default::default(),
            rows: Default::default(),
        };
        for k in 0..size[2] {
            for j in 0..size[1] {
                for i in 0..size[0] {
                    patch.add([i, j, k]);
                }
            }
        }
        // columns are read by eights
        for column in &mut patch.x {
            column.resize(column.len() + EIGHT, 0.0);
        }
        if bins.step.is_some() {
            let length = size[0] as usize;
            for a in 0..3 {
                let column = &patch.x[a][..patch.index.len()];
                patch.rows[a] = column.iter().step_by(length.max(1)).copied().collect();
                patch.rows[a].resize(patch.rows[a].len() + EIGHT, 0.0);
            }
        }
        patch
    }

    fn add(&mut self, local: [i32; 3]) {
        let bins = self.bins;
        let mut bin = [0; 3];
        let mut image = [0; 3];
        for a in 0..3 {
            let n = self.first[a] + local[a];
            if bins.repeats[a] {
                bin[a] = n.rem_euclid(bins.bins[a]);
                image[a] = n.div_euclid(bins.bins[a]);
            } else {
                bin[a] = n;
            }
        }
        let place = bins.index(bin);
        let shift = bins.cell.shift(image);
        for &p in &bins.order[bins.start[place] as usize..bins.start[place + 1] as usize] {
            self.index.push(p);
            for a in 0..3 {
                let x = bins.wrapped[p as usize][a] + shift[a];
                self.x[a].push(if bins.counts[a] { x } else { 0.0 });
            }
        }
        self.start.push(self.index.len() as u32);
    }

    /// The part of a vector that counts.
    pub fn project(&self, x: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| if self.bins.counts[a] { x[a] } else { 0.0 })
    }

    /// Pieces of a range of bins: where it begins in the patch, its length, and the image that the patch shows.
    fn pieces(&self, axis: usize, at: f64, reach: f64, out: &mut Vec<[i32; 3]>) {
        out.clear();
        let [mut from, mut count] = self.bins.range(axis, at, at, reach);
        let n = self.bins.bins[axis];
        if !self.whole[axis] {
            from -= self.first[axis];
            count = count.min(self.size[axis] - from);
            if from < 0 {
                count += from;
                from = 0;
            }
            if count > 0 {
                out.push([from, count, 0]);
            }
            return;
        }
        while count > 0 {
            let (at, image) = (from.rem_euclid(n), from.div_euclid(n));
            let here = count.min(n - at);
            out.push([at, here, image]);
            from += here;
            count -= here;
        }
    }

    /// Runs of points that may be nearer to x than the reach.
    #[inline(always)]
    pub fn near(&self, x: [f64; 3], reach: f64, runs: &mut Runs) {
        let bins = self.bins;
        let Runs { all, pieces } = runs;
        all.clear();
        let s = bins.cell.fraction(x);
        for a in 0..3 {
            self.pieces(a, s[a], reach, &mut pieces[a]);
        }
        let ball = Ball::new(bins, x, reach);
        let [px, py, pz] = pieces;
        for z in pz.iter() {
            for y in py.iter() {
                for x in px.iter() {
                    let image = [x[2], y[2], z[2]];
                    let shift = match image == [0; 3] {
                        true => [0.0; 3],
                        false => bins.cell.shift(image),
                    };
                    let between = [x[0], x[0] + x[1]];
                    for k in z[0]..z[0] + z[1] {
                        let mut j = y[0];
                        while j < y[0] + y[1] {
                            let row = (k * self.size[1] + j) as usize;
                            let count = EIGHT.min((y[0] + y[1] - j) as usize);
                            let ends = match bins.step {
                                Some(step) => ball.rows(self.eight(row), shift, step, between),
                                None => [[between[0]; EIGHT], [between[1]; EIGHT]],
                            };
                            for n in 0..count {
                                let [from, to] = [ends[0][n], ends[1][n]];
                                if from < to {
                                    let first = (row + n) * self.size[0] as usize;
                                    let [from, to] =
                                        [from, to].map(|b| self.start[first + b as usize]);
                                    all.push(Run { from, to, shift });
                                }
                            }
                            j += EIGHT as i32;
                        }
                    }
                }
            }
        }
    }

    /// x of the first points of eight rows, y and z.
    #[inline(always)]
    fn eight(&self, row: usize) -> [&[f64; EIGHT]; 3] {
        const NONE: [f64; EIGHT] = [0.0; EIGHT];
        let [x, y, z] = &self.rows;
        [x, y, z].map(|column| column[row..].first_chunk().unwrap_or(&NONE))
    }
}

/// A ball, as rows of points along x see it.
struct Ball {
    centre: [f64; 3],
    /// A little more than the radius, squared.
    square: f64,
    /// 1 for axes that count, else 0.
    counts: [f64; 2],
}

impl Ball {
    #[inline(always)]
    fn new(bins: &Bins, centre: [f64; 3], radius: f64) -> Ball {
        Ball {
            centre,
            square: radius * radius * (1.0 + 1e-9),
            counts: [1, 2].map(|a| if bins.counts[a] { 1.0 } else { 0.0 }),
        }
    }

    /// Bins of eight rows between which points are inside, of those between two; first points of the rows are at x.
    #[inline(always)]
    fn rows(
        &self,
        [x, y, z]: [&[f64; EIGHT]; 3],
        shift: [f64; 3],
        step: f64,
        between: [i32; 2],
    ) -> [[i32; EIGHT]; 2] {
        let off: [f64; 3] = std::array::from_fn(|a| shift[a] - self.centre[a]);
        let [first, last] = between.map(f64::from);
        let over = 1.0 / step;
        let mut ends = [[0; EIGHT]; 2];
        for n in 0..EIGHT {
            let y = (y[n] + off[1]) * self.counts[0];
            let z = (z[n] + off[2]) * self.counts[1];
            let rest = self.square - (y * y + z * z);
            let wide = if rest > 0.0 { rest } else { 0.0 }.sqrt();
            let to = -(x[n] + off[0]);
            let from = ((to - wide) * over).ceil();
            let to = ((to + wide) * over).floor() + 1.0;
            let from = if from > first { from } else { first };
            let to = if to < last { to } else { last };
            let inside = rest > 0.0 && from < to;
            ends[0][n] = if inside { from } else { first } as i32;
            ends[1][n] = if inside { to } else { first } as i32;
        }
        ends
    }
}
