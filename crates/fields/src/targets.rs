//! Where fields are wanted, in bins like those of the particles: a point that lies in a box of fractions is found without looking at others.

use crate::FieldsError;
use crate::frame::Cell;
use crate::kernel::{Kernel, dot};
use peridyne::execute::memory::afford;

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
            Targets::Grid(n) => n.iter().fold(1, |all: usize, n| all.saturating_mul(*n)),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Do so many points fit into memory?
///
/// # Errors
/// They do not.
pub fn affordable(points: f64) -> Result<(), FieldsError> {
    let what = format!("{points} points");
    afford("points", &what, 24.0 * points, "")
        .map_err(|e| FieldsError(format!("{}: take fewer", e.message)))
}

/// Points in bins of a cell.
pub(crate) struct Bins<'a> {
    pub cell: &'a Cell,
    /// Axes along which the bins repeat.
    pub repeats: [bool; 3],
    pub counts: [bool; 3],
    /// Of φ, and of the cell along each axis (length).
    pub radius: f64,
    pub height: [f64; 3],
    pub bins: [i32; 3],
    pub low: [f64; 3],
    pub extent: [f64; 3],
    pub start: Vec<u32>,
    pub order: Vec<u32>,
    /// In the cell along axes that repeat.
    pub wrapped: Vec<[f64; 3]>,
    /// Distance of the points along each edge of the cell, where they are a grid: a point in each bin.
    pub spacing: Option<[f64; 3]>,
    /// Has somebody had enough?
    pub stop: fn() -> bool,
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
                let most = libm::cbrt(positions.len() as f64) * 2.0 + 8.0;
                std::array::from_fn(|a| match counts[a] {
                    true => (2.0 * (high[a] - low[a]) * height[a] / radius).clamp(1.0, most) as i32,
                    false => 1,
                })
            }
        };
        let extent = std::array::from_fn(|a| high[a] - low[a]);
        let total = bins.iter().map(|b| *b as usize).product::<usize>();
        let spacing = match targets {
            Targets::Grid(n) => Some(std::array::from_fn(|a| match counts[a] {
                true => dot(cell.edges[a], cell.edges[a]).sqrt() / n[a] as f64,
                false => 0.0,
            })),
            Targets::Points(_) => None,
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
            spacing,
            stop: crate::method::never,
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
    pub fn index(&self, b: [i32; 3]) -> usize {
        ((b[2] * self.bins[1] + b[1]) * self.bins[0] + b[0]) as usize
    }

    fn bin(&self, axis: usize, s: f64) -> i32 {
        let t = (s - self.low[axis]) / self.extent[axis] * f64::from(self.bins[axis]);
        t.floor().clamp(-1e9, 1e9) as i32
    }

    /// Bins that a range of fractions, widened by a length, touches: the first, and how many. Unwrapped on axes that repeat.
    pub fn range(&self, axis: usize, low: f64, high: f64, reach: f64) -> [i32; 2] {
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
}
