//! How points of a plate are drawn: each as a cell that is stretched, sheared and turned as the body is there, so that what is whole shows
//! no gaps and no pattern of them.
//!
//! A deformation gradient is the least squares' fit to the points of one side, of four sides the one that is strained least: across a
//! crack nothing holds. Where no fit holds, as among debris, a cell stays as it was.

use std::collections::HashMap;

use super::sizes::edges;

/// Points so many edges of a cell away say how it is deformed.
const NEAR: f64 = 1.6;
/// What a fit may miss, over the distance that it reaches; and the most by which a cell is stretched.
const MISSED: f64 = 0.2;
const LONGEST: f64 = 4.0;

/// Edges of a cell on the screen, right and up, over the spacing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    pub edges: [[f64; 2]; 2],
}

impl Cell {
    pub const WHOLE: Cell = Cell {
        edges: [[1.0, 0.0], [0.0, 1.0]],
    };

    fn of(f: &[[f64; 2]; 2], size: f64) -> Cell {
        Cell {
            edges: [0, 1].map(|k| [size * f[0][k], size * f[1][k]]),
        }
    }
}

/// The points of a plate in its reference, and which are near each.
pub struct Cells {
    spacing: f64,
    /// Of each point; `None`: all as large as the spacing.
    sizes: Option<Vec<f64>>,
    reference: Vec<[f64; 2]>,
    near: HashMap<[i64; 2], Vec<u32>>,
}

/// Sums of a fit.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    /// Σ ξ⊗ξ: xx, xy, yy.
    shape: [f64; 3],
    /// Σ η⊗ξ.
    moved: [[f64; 2]; 2],
    /// Σ η·η.
    square: f64,
}

impl Sums {
    fn add(&mut self, xi: [f64; 2], eta: [f64; 2]) {
        self.count += 1.0;
        self.shape[0] += xi[0] * xi[0];
        self.shape[1] += xi[0] * xi[1];
        self.shape[2] += xi[1] * xi[1];
        self.square += eta[0] * eta[0] + eta[1] * eta[1];
        for r in 0..2 {
            for c in 0..2 {
                self.moved[r][c] += eta[r] * xi[c];
            }
        }
    }

    /// The gradient and how far it misses, root mean square (length); `None`: the points lie on a line.
    fn fit(&self) -> Option<([[f64; 2]; 2], f64)> {
        let [xx, xy, yy] = self.shape;
        let area = xx * yy - xy * xy;
        if !(area > 1e-6 * (xx + yy) * (xx + yy)) {
            return None;
        }
        let f = self
            .moved
            .map(|[a, b]| [(a * yy - b * xy) / area, (b * xx - a * xy) / area]);
        // of the best fit: Σ η·η − F : Σ η⊗ξ
        let taken: f64 = (0..4)
            .map(|k| f[k / 2][k % 2] * self.moved[k / 2][k % 2])
            .sum();
        let missed = ((self.square - taken).max(0.0) / self.count).sqrt();
        Some((f, missed))
    }
}

/// Its principal stretches, rising, and how far they are from 1.
fn stretches(f: &[[f64; 2]; 2]) -> ([f64; 2], f64) {
    let [[a, b], [c, d]] = *f;
    let half = 0.5 * (a * a + b * b + c * c + d * d);
    let det = a * d - b * c;
    let root = (half * half - det * det).max(0.0).sqrt();
    let both = [half - root, half + root].map(|s| s.max(0.0).sqrt());
    let away = both.iter().map(|s| (s - 1.0).powi(2)).sum();
    (both, away)
}

impl Cells {
    pub fn of(reference: &[[f64; 3]], spacing: f64) -> Cells {
        let sizes = edges(reference, spacing);
        let sizes = sizes.map(|all| all.iter().map(|e| e / spacing).collect());
        let mut cells = Cells {
            spacing,
            sizes,
            reference: reference.iter().map(|x| [x[0], x[1]]).collect(),
            near: HashMap::new(),
        };
        if spacing > 0.0 {
            for (i, x) in cells.reference.iter().enumerate() {
                let place = cells.place(x);
                cells.near.entry(place).or_default().push(i as u32);
            }
        }
        cells
    }

    fn place(&self, x: &[f64; 2]) -> [i64; 2] {
        x.map(|c| (c / (2.0 * self.spacing)).floor() as i64)
    }

    /// The cell of each point, with points at these places.
    pub fn at(&self, moved: &[[f64; 3]]) -> Vec<Cell> {
        (0..self.reference.len())
            .map(|i| {
                let size = self.sizes.as_ref().map_or(1.0, |all| all[i]);
                let f = self.gradient(i, size, moved);
                f.map_or(Cell::of(&[[1.0, 0.0], [0.0, 1.0]], size), |f| {
                    Cell::of(&f, size)
                })
            })
            .collect()
    }

    fn gradient(&self, i: usize, size: f64, moved: &[[f64; 3]]) -> Option<[[f64; 2]; 2]> {
        let reach = (NEAR * size.min(1.25)) * self.spacing;
        let from = self.reference[i];
        let way = |j: usize| [0, 1].map(|a| moved[j][a] - moved[i][a]);
        let mut sides = [Sums::default(); 4];
        let [column, row] = self.place(&from);
        for n in 0..9 {
            let place = [column + n % 3 - 1, row + n / 3 - 1];
            for &j in self.near.get(&place).into_iter().flatten() {
                let x = self.reference[j as usize];
                let xi = [x[0] - from[0], x[1] - from[1]];
                let far = xi[0] * xi[0] + xi[1] * xi[1];
                let eta = way(j as usize);
                if far == 0.0 || far > reach * reach || !eta.iter().all(|c| c.is_finite()) {
                    continue;
                }
                let beside = 1e-3 * reach;
                let on = [
                    xi[0] > beside,
                    xi[0] < -beside,
                    xi[1] > beside,
                    xi[1] < -beside,
                ];
                let all = sides.iter_mut().zip(on).filter(|(_, on)| *on);
                all.for_each(|(side, _)| side.add(xi, eta));
            }
        }
        let fits = sides
            .iter()
            .filter_map(Sums::fit)
            .filter_map(|(f, missed)| {
                let ([low, high], away) = stretches(&f);
                let holds = missed < MISSED * reach && low > 1.0 / LONGEST && high < LONGEST;
                let right = f[0][0] * f[1][1] - f[0][1] * f[1][0] > 0.0;
                (holds && right).then_some((f, away))
            });
        fits.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(f, _)| f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice() -> Vec<[f64; 3]> {
        (0..100)
            .map(|n| [f64::from(n % 10), f64::from(n / 10), 0.0])
            .collect()
    }

    #[test]
    fn cells_are_deformed_as_the_body_is() {
        let reference = lattice();
        let cells = Cells::of(&reference, 1.0);
        let f = [[1.8, 0.3], [-0.2, 0.7]];
        let moved = |x: &[f64; 3]| {
            [0, 1, 2].map(|a| {
                if a < 2 {
                    f[a][0] * x[0] + f[a][1] * x[1]
                } else {
                    0.0
                }
            })
        };
        let all: Vec<[f64; 3]> = reference.iter().map(moved).collect();
        for cell in cells.at(&all) {
            for (k, edge) in cell.edges.iter().enumerate() {
                assert!(
                    (0..2).all(|a| (edge[a] - f[a][k]).abs() < 1e-12),
                    "{edge:?}"
                );
            }
        }
    }

    #[test]
    fn a_crack_opens_and_debris_stays_as_it_was() {
        let reference = lattice();
        let cells = Cells::of(&reference, 1.0);
        // the right half is gone by 1.5 spacings, and one point flies
        let mut all: Vec<[f64; 3]> = { reference.iter() }
            .map(|x| [x[0] + if x[0] > 4.5 { 1.5 } else { 0.0 }, x[1], 0.0])
            .collect();
        all[0] = [-70.0, 31.0, 0.0];
        all[99] = [f64::NAN; 3];
        for (i, cell) in cells.at(&all).iter().enumerate() {
            assert_eq!(*cell, Cell::WHOLE, "{i}");
        }
    }
}
