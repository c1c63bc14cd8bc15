//! Where u is known: middles of equal cells of an interval or a rectangle, and what lies around it.

use peridyne::error::BuildError;
use std::fmt;
use std::sync::Arc;

/// Most points of a grid: no machine holds more. What this one holds is for who runs a law to say ([`crate::memory`]).
const MOST: usize = 1 << 48;

/// Values at a place (length) and a time.
pub type Values = Arc<dyn Fn(&[f64; 3], f64) -> f64 + Send + Sync>;

/// Equal cells; in 1-D `cells[1]` is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    pub cells: [usize; 2],
    /// Edge of a cell (length).
    pub spacing: f64,
    /// Lower corner.
    pub low: [f64; 2],
    pub dimension: usize,
}

impl Grid {
    /// `n` cells from `a` to `b`.
    ///
    /// # Errors
    /// An interval that is none, no cells or too many.
    pub fn line(a: f64, b: f64, n: usize) -> Result<Grid, BuildError> {
        if !(a < b && a.is_finite() && b.is_finite()) {
            return Err(BuildError::invalid(
                "domain",
                format!("the domain must go from a lower to an upper end, not from {a} to {b}"),
            ));
        }
        Grid {
            cells: [n, 1],
            spacing: (b - a) / n as f64,
            low: [a, 0.0],
            dimension: 1,
        }
        .counted()
    }

    /// Square cells, `n` along x, from corner to corner.
    ///
    /// # Errors
    /// A rectangle that is none, or whose height is no whole number of cells; no cells or too many.
    pub fn plane(low: [f64; 2], high: [f64; 2], n: usize) -> Result<Grid, BuildError> {
        let line = Grid::line(low[0], high[0], n)?;
        let rows = Grid::line(low[1], high[1], 1)?.spacing / line.spacing;
        let whole = rows.round();
        if (rows - whole).abs() > 1e-6 * rows || whole < 1.0 {
            return Err(BuildError::invalid(
                "points",
                format!(
                    "cells are squares: {n} along x make {rows:.4} along y, which is no whole number"
                ),
            ));
        }
        Grid {
            cells: [n, whole as usize],
            low,
            dimension: 2,
            ..line
        }
        .counted()
    }

    fn counted(self) -> Result<Grid, BuildError> {
        match self.cells[0].checked_mul(self.cells[1]) {
            Some(0) => Err(BuildError::empty("points", "a grid needs points")),
            Some(n) if n <= MOST => Ok(self),
            _ => Err(BuildError::too_many(
                "points",
                format!("a grid has at most {MOST} points"),
            )),
        }
    }

    pub fn points(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Length or area of a cell.
    pub fn cell(&self) -> f64 {
        self.spacing.powi(self.dimension as i32)
    }

    /// The middle of a cell, also outside of the grid.
    pub fn middle(&self, i: isize, j: isize) -> [f64; 3] {
        let x = self.low[0] + self.spacing * (i as f64 + 0.5);
        match self.dimension {
            1 => [x, 0.0, 0.0],
            _ => [x, self.low[1] + self.spacing * (j as f64 + 0.5), 0.0],
        }
    }

    /// Of a point by its number: x runs fastest.
    pub fn place(&self, n: usize) -> [f64; 3] {
        self.middle((n % self.cells[0]) as isize, (n / self.cells[0]) as isize)
    }

    /// Values of a function at all points.
    pub fn sample(&self, f: impl Fn(&[f64; 3]) -> f64) -> Vec<f64> {
        (0..self.points()).map(|n| f(&self.place(n))).collect()
    }
}

/// What lies beyond the ends.
#[derive(Clone)]
pub enum Boundary {
    Periodic,
    /// Collars as wide as the horizon, in which u is given.
    Collars(Values),
}

impl fmt::Debug for Boundary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Boundary::Periodic => "Periodic",
            Boundary::Collars(_) => "Collars",
        })
    }
}

/// A grid with a margin of ghost cells, in which every partner of every point stands.
#[derive(Debug, Clone)]
pub(crate) struct Padded {
    pub grid: Grid,
    pub margin: [usize; 2],
    /// Cells of a row with its margins.
    pub stride: usize,
}

impl Padded {
    pub fn new(grid: Grid, reach: usize) -> Padded {
        let margin = [reach, if grid.dimension == 1 { 0 } else { reach }];
        Padded {
            grid,
            margin,
            stride: grid.cells[0] + 2 * margin[0],
        }
    }

    pub fn rows(&self) -> usize {
        self.grid.cells[1] + 2 * self.margin[1]
    }

    pub fn size(&self) -> usize {
        self.stride * self.rows()
    }

    /// Place of the first point of a row of the grid.
    pub fn row(&self, j: usize) -> usize {
        (j + self.margin[1]) * self.stride + self.margin[0]
    }

    /// Distance of partners in memory.
    pub fn offset(&self, m: [isize; 2]) -> isize {
        m[0] + m[1] * self.stride as isize
    }

    /// Places of all ghosts.
    pub fn ghosts(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let [n, rows] = self.grid.cells.map(|c| c as isize);
        let [a, b] = self.margin.map(|m| m as isize);
        (-b..rows + b).flat_map(move |j| {
            let inside = (0..rows).contains(&j);
            let count = 2 * a + if inside { 0 } else { n };
            (0..count).map(move |k| {
                let i = if inside && k >= a { n + k - a } else { k - a };
                self.grid.middle(i, j)
            })
        })
    }

    /// Puts the values of the grid's points and their ghosts.
    pub fn fill(&self, u: &[f64], boundary: &Boundary, t: f64, out: &mut Vec<f64>) {
        let [n, rows] = self.grid.cells;
        let [a, b] = self.margin.map(|m| m as isize);
        out.clear();
        out.reserve(self.size());
        for j in -b..rows as isize + b {
            match boundary {
                Boundary::Periodic => {
                    let row = &u[j.rem_euclid(rows as isize) as usize * n..][..n];
                    let wrapped = |i: isize| row[i.rem_euclid(n as isize) as usize];
                    out.extend((-a..0).map(wrapped));
                    out.extend_from_slice(row);
                    out.extend((n as isize..n as isize + a).map(wrapped));
                }
                Boundary::Collars(given) => {
                    let inside = (0..rows as isize).contains(&j);
                    for i in -a..n as isize + a {
                        out.push(match inside && (0..n as isize).contains(&i) {
                            true => u[j as usize * n + i as usize],
                            false => given(&self.grid.middle(i, j), t),
                        });
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ghosts are all cells around a grid, each once.
    #[test]
    fn ghosts_are_what_is_not_the_grid() {
        let line = Padded::new(Grid::line(0.0, 1.0, 4).unwrap(), 3);
        let x: Vec<f64> = line.ghosts().map(|x| x[0]).collect();
        assert_eq!(x, [-0.625, -0.375, -0.125, 1.125, 1.375, 1.625]);
        let grid = Grid::plane([0.0; 2], [1.0, 0.5], 4).unwrap();
        let plane = Padded::new(grid, 2);
        let inside = |x: &[f64; 3]| (0.0..1.0).contains(&x[0]) && (0.0..0.5).contains(&x[1]);
        assert!(plane.ghosts().all(|x| !inside(&x)));
        let mut all: Vec<[u64; 2]> = plane
            .ghosts()
            .map(|x| [x[0].to_bits(), x[1].to_bits()])
            .collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), plane.size() - grid.points());
    }
}
