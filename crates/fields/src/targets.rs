//! Where fields are wanted, in bins like those of the particles: a point that lies in a box of fractions is found without looking at others.

use crate::FieldsError;
use crate::frame::Cell;
use crate::kernel::Kernel;

/// Where fields are wanted.
#[derive(Debug, Clone, PartialEq)]
pub enum Targets {
    /// The centres of this many equal pieces of the cell along each of its edges, the first axis fastest.
    Grid([usize; 3]),
    Points(Vec<[f64; 3]>),
}

impl Targets {
    /// Points evenly on a line, both ends included.
    pub fn line(from: [f64; 3], to: [f64; 3], count: usize) -> Targets {
        let part = |k: usize| k as f64 / (count.max(2) - 1) as f64;
        let at = |t: f64| std::array::from_fn(|a| from[a] + t * (to[a] - from[a]));
        Targets::Points((0..count).map(|k| at(part(k))).collect())
    }

    /// Points evenly on a parallelogram, the first edge fastest, borders included.
    pub fn plane(corner: [f64; 3], edges: [[f64; 3]; 2], counts: [usize; 2]) -> Targets {
        let part = |k: usize, n: usize| k as f64 / (n.max(2) - 1) as f64;
        let mut points = vec![];
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let [s, t] = [part(i, counts[0]), part(j, counts[1])];
                points.push(std::array::from_fn(|a| {
                    corner[a] + s * edges[0][a] + t * edges[1][a]
                }));
            }
        }
        Targets::Points(points)
    }

    /// The points, as they lie in a cell.
    pub fn positions(&self, cell: &Cell) -> Vec<[f64; 3]> {
        match self {
            Targets::Points(points) => points.clone(),
            Targets::Grid([nx, ny, nz]) => {
                let mut all = Vec::with_capacity(nx * ny * nz);
                let part = |k: usize, n: usize| (k as f64 + 0.5) / n as f64;
                for k in 0..*nz {
                    for j in 0..*ny {
                        for i in 0..*nx {
                            all.push(cell.at([part(i, *nx), part(j, *ny), part(k, *nz)]));
                        }
                    }
                }
                all
            }
        }
    }

    pub fn len(&self) -> usize {
        match self {
            Targets::Points(points) => points.len(),
            Targets::Grid(n) => n.iter().product(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Points in bins of a cell.
pub(crate) struct Bins<'a> {
    cell: &'a Cell,
    /// Axes along which the bins repeat.
    repeats: [bool; 3],
    counts: [bool; 3],
    /// Of φ, and of the cell along each axis (length).
    radius: f64,
    height: [f64; 3],
    bins: [i32; 3],
    low: [f64; 3],
    extent: [f64; 3],
    start: Vec<u32>,
    order: Vec<u32>,
    /// In the cell along axes that repeat.
    wrapped: Vec<[f64; 3]>,
    /// Distance along x of the points in a row of bins, where rows lie along x, a point in each bin.
    step: Option<f64>,
}

const MOST: usize = 200_000_000;

impl<'a> Bins<'a> {
    pub fn new(
        targets: &Targets,
        cell: &'a Cell,
        kernel: &Kernel,
    ) -> Result<Bins<'a>, FieldsError> {
        let counts = kernel.averaged_axes().map(|a| a.is_none());
        if targets.len() > MOST {
            return Err(FieldsError(format!(
                "{} points, of which {MOST} are taken: use a coarser grid",
                targets.len()
            )));
        }
        if let Targets::Grid(n) = targets {
            for a in 0..3 {
                let name = ["x", "y", "z"][a];
                if n[a] == 0 {
                    return Err(FieldsError(format!("the grid has 0 points along {name}")));
                }
                if !counts[a] && n[a] != 1 {
                    return Err(FieldsError(format!(
                        "{name} is averaged over: the grid has 1 point along it, not {}",
                        n[a]
                    )));
                }
            }
        }
        let repeats: [bool; 3] = std::array::from_fn(|a| cell.periodic[a] && counts[a]);
        let positions = targets.positions(cell);
        if let Some(k) = positions
            .iter()
            .position(|x| x.iter().any(|c| !c.is_finite()))
        {
            return Err(FieldsError(format!("point {} is not finite", k + 1)));
        }
        let only = cell.with_periods(repeats);
        let wrapped: Vec<[f64; 3]> = positions.iter().map(|x| only.wrap(*x)).collect();
        let (mut low, mut high) = ([0.0; 3], [1.0; 3]);
        let (radius, height) = (kernel.radius(), [0, 1, 2].map(|a| cell.height(a)));
        let bins = match targets {
            Targets::Grid(n) => n.map(|n| n as i32),
            Targets::Points(_) => {
                for a in (0..3).filter(|a| !repeats[*a]) {
                    let all = wrapped.iter().map(|x| cell.fraction(*x)[a]);
                    low[a] = all.clone().fold(f64::INFINITY, f64::min);
                    high[a] = all.fold(f64::NEG_INFINITY, f64::max).max(low[a] + 1e-9);
                }
                let most = (positions.len() as f64).cbrt() * 2.0 + 8.0;
                std::array::from_fn(|a| match counts[a] {
                    true => (2.0 * (high[a] - low[a]) * height[a] / radius).clamp(1.0, most) as i32,
                    false => 1,
                })
            }
        };
        let extent = std::array::from_fn(|a| high[a] - low[a]);
        let total = bins.iter().map(|b| *b as usize).product::<usize>();
        let along = cell.edges[0];
        let step = match targets {
            Targets::Grid(n)
                if along[1] == 0.0 && along[2] == 0.0 && along[0] > 0.0 && counts[0] =>
            {
                Some(along[0] / n[0] as f64)
            }
            Targets::Grid(_) | Targets::Points(_) => None,
        };
        let mut all = Bins {
            cell,
            repeats,
            counts,
            radius,
            height,
            bins,
            low,
            extent,
            start: vec![0; total + 1],
            order: vec![0; positions.len()],
            wrapped,
            step,
        };
        let place: Vec<usize> = all.wrapped.iter().map(|x| all.place(*x)).collect();
        for p in &place {
            all.start[p + 1] += 1;
        }
        for b in 1..all.start.len() {
            all.start[b] += all.start[b - 1];
        }
        let mut next = all.start.clone();
        for (i, p) in place.iter().enumerate() {
            all.order[next[*p] as usize] = i as u32;
            next[*p] += 1;
        }
        Ok(all)
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.wrapped.len()
    }

    fn place(&self, x: [f64; 3]) -> usize {
        let s = self.cell.fraction(x);
        let b: [i32; 3] = std::array::from_fn(|a| match self.counts[a] {
            true => (self.bin(a, s[a]).max(0)).min(self.bins[a] - 1),
            false => 0,
        });
        self.index(b)
    }

    /// Along the first axis they are side by side.
    fn index(&self, b: [i32; 3]) -> usize {
        ((b[2] * self.bins[1] + b[1]) * self.bins[0] + b[0]) as usize
    }

    fn bin(&self, axis: usize, s: f64) -> i32 {
        let t = (s - self.low[axis]) / self.extent[axis] * f64::from(self.bins[axis]);
        t.floor().clamp(-1e9, 1e9) as i32
    }

    /// Bins that a range of fractions, widened by a length, touches: the first, and how many. Unwrapped on axes that repeat.
    fn range(&self, axis: usize, low: f64, high: f64, reach: f64) -> [i32; 2] {
        if !self.counts[axis] {
            return [0, 1];
        }
        // a little more, so that round-off at a face loses nothing
        let wide = reach / self.height[axis] * (1.0 + 1e-9) + 1e-12;
        let (mut from, mut to) = (self.bin(axis, low - wide), self.bin(axis, high + wide));
        if !self.repeats[axis] {
            (from, to) = (from.max(0), to.min(self.bins[axis] - 1));
        }
        [from, (to - from + 1).max(0)]
    }

    /// The points near a box of fractions.
    pub fn patch(&self, bounds: [[f64; 3]; 2]) -> Patch<'_> {
        let mut first = [0; 3];
        let mut size = [0; 3];
        for a in 0..3 {
            let [from, count] = self.range(a, bounds[0][a], bounds[1][a], self.radius);
            // all of an axis that repeats begin at 0
            [first[a], size[a]] = match self.repeats[a] && count >= self.bins[a] {
                true => [0, self.bins[a]],
                false => [from, count],
            };
        }
        let mut patch = Patch {
            bins: self,
            whole: std::array::from_fn(|a| self.repeats[a] && size[a] == self.bins[a]),
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
        if self.step.is_some() {
            let length = size[0] as usize;
            for a in 0..3 {
                let column = &patch.x[a][..patch.index.len()];
                patch.rows[a] = column.iter().step_by(length.max(1)).copied().collect();
                patch.rows[a].resize(patch.rows[a].len() + EIGHT, 0.0);
            }
        }
        patch
    }
}

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

impl Patch<'_> {
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
