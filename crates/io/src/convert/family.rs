//! Who talks to whom there, and whether a ball of the horizon says the same here.
//!
//! Here bonds are pairs with `|ξ|² ≤ δ²` in plain arithmetic. PeriLab and Peridigm's trees take the same, Peridigm after a box of
//! `x ± δ`; a grid of Peridigm has the cells of a box, of which `NeighborhoodType: Spherical` keeps those with `|ξ|² − δ² < 0`.

use super::points::Points;
use super::program::Program;
use std::collections::HashMap;

/// How the other program looks for partners.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// `|ξ|² ≤ δ²`.
    Ball,
    /// The same, within a box of `x ± δ`.
    BoxedBall,
    /// Cells of a box of a grid with `|ξ|² < δ²`.
    OpenBall,
    /// All cells of a box of a grid.
    Cells,
}

impl Search {
    /// Of a program; `grid`: its points are cells of a grid, `ball`: of which it takes a ball.
    pub fn of(program: Program, grid: bool, ball: bool) -> Self {
        match (program, grid, ball) {
            (Program::PeriLab, ..) => Search::Ball,
            (Program::Peridigm, false, _) => Search::BoxedBall,
            (Program::Peridigm, true, true) => Search::OpenBall,
            (Program::Peridigm, true, false) => Search::Cells,
        }
    }
}

/// The horizon whose ball is the family of the other program, and what should be known of it.
///
/// # Errors
/// No ball is.
pub fn horizon(
    points: &Points,
    given: f64,
    search: Search,
) -> Result<(f64, Option<String>), String> {
    let Some(differs) = differs(points, given, search) else {
        let told = "bonds as long as the horizon were not looked at, there are too many: round-off decides about them";
        return Ok((given, Some(told.into())));
    };
    match differs.horizon(given) {
        Some(found) if found == given => Ok((found, None)),
        Some(found) => {
            let ties = if found > given {
                "count"
            } else {
                "do not count"
            };
            let told = format!(
                "bonds as long as the horizon {given:?} {ties} there: here it is {found:?}"
            );
            Ok((found, Some(told)))
        }
        None => {
            let Differs { there, here, .. } = differs;
            let what = match search {
                Search::Cells => {
                    "on a grid of Peridigm without NeighborhoodType Spherical the family is a box of cells, here a ball"
                }
                _ => "round-off decides there about bonds as long as the horizon",
            };
            Err(format!(
                "{what}: {there} directed bonds are missing, {here} are added"
            ))
        }
    }
}

/// Pairs of points, each each counted at both ends.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Differs {
    /// There alone.
    there: u64,
    /// In the ball alone.
    here: u64,
    /// Within round-off of the horizon, and bonds there.
    tied: u64,
    /// Within round-off of the horizon, and no bonds there.
    untied: u64,
}

/// Part of the horizon that counts as round-off; the engine's is 1e-9.
const NEAR: f64 = 2e-9;

/// Most pairs that are looked at.
const MOST: u64 = 1 << 31;

impl Differs {
    /// The horizon that makes the family of the other program out of a ball, where one does.
    fn horizon(&self, horizon: f64) -> Option<f64> {
        match self {
            Differs {
                there: 0, here: 0, ..
            } => Some(horizon),
            // all that differ are ties of one kind
            Differs {
                here: 0,
                untied: 0,
                there,
                tied,
            } if there <= tied => Some(horizon * (1.0 + NEAR)),
            Differs {
                there: 0,
                tied: 0,
                here,
                untied,
            } if here <= untied => Some(horizon * (1.0 - NEAR)),
            _ => None,
        }
    }
}

/// What differs; `None`: there are too many pairs to look at.
fn differs(points: &Points, horizon: f64, search: Search) -> Option<Differs> {
    let cells = cells_of(points, horizon);
    let boxed = |a: &[f64; 3], b: &[f64; 3]| {
        (0..3).all(|k| a[k] - horizon <= b[k] && b[k] <= a[k] + horizon)
    };
    // a grid counts cells, so that positions here need not
    let near_cells = |i: usize, j: usize| match (&points.grid, cells) {
        (Some(grid), Some(most)) => {
            let [nx, ny, _] = grid.count;
            let cell = |i: usize| [i % nx, i / nx % ny, i / nx / ny];
            let (a, b) = (cell(i), cell(j));
            (0..3).all(|k| a[k].abs_diff(b[k]) <= most[k])
        }
        _ => true,
    };
    let square = horizon * horizon;
    let mut found = Differs::default();
    pairs(points, reach(points, horizon, search), |i, j, d| {
        let [a, b] = [i, j].map(|n| &points.position[n]);
        let here = d <= square;
        let there = match search {
            Search::Ball => here,
            Search::BoxedBall => here && boxed(a, b),
            Search::OpenBall => d - square < 0.0 && near_cells(i, j),
            Search::Cells => near_cells(i, j),
        };
        found.there += u64::from(there && !here);
        found.here += u64::from(here && !there);
        if (d.sqrt() / horizon - 1.0).abs() <= NEAR / 2.0 {
            found.tied += u64::from(there);
            found.untied += u64::from(!there);
        }
    })
    .then_some(found)
}

/// Cells of a grid within the horizon along each axis, rounded as there.
fn cells_of(points: &Points, horizon: f64) -> Option<[usize; 3]> {
    let grid = points.grid?;
    Some(std::array::from_fn(|k| {
        let cells = horizon / grid.edge[k];
        let whole = cells.floor();
        let more = f64::from(u8::from(cells - whole >= 0.5));
        ((whole + more) as usize).min(grid.count[k])
    }))
}

/// How far partners may be.
fn reach(points: &Points, horizon: f64, search: Search) -> f64 {
    let corner = match (search, points.grid, cells_of(points, horizon)) {
        (Search::Cells, Some(grid), Some(most)) => {
            let edges = (0..3).map(|k| (most[k] as f64 * grid.edge[k]).powi(2));
            edges.sum::<f64>().sqrt()
        }
        _ => 0.0,
    };
    horizon.max(corner) * (1.0 + 2.0 * NEAR)
}

/// Visits every pair nearer than `reach` from both ends, with its squared distance; false: there were too many.
fn pairs(points: &Points, reach: f64, mut visit: impl FnMut(usize, usize, f64)) -> bool {
    let cell = |x: &[f64; 3]| x.map(|c| (c / reach).floor() as i64);
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (i, x) in points.position.iter().enumerate() {
        cells.entry(cell(x)).or_default().push(i as u32);
    }
    let around = || (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
    let mut looked = 0;
    for (i, x) in points.position.iter().enumerate() {
        let own = cell(x);
        for step in around() {
            let key = std::array::from_fn(|k| own[k].saturating_add(step[k]));
            let others = cells.get(&key).map_or(&[][..], Vec::as_slice);
            looked += others.len() as u64;
            if looked > MOST {
                return false;
            }
            for j in others.iter().map(|j| *j as usize).filter(|j| *j != i) {
                let y = &points.position[j];
                let mut square = 0.0;
                for k in 0..3 {
                    let d = x[k] - y[k];
                    square += d * d;
                }
                if square <= reach * reach {
                    visit(i, j, square);
                }
            }
        }
    }
    true
}
