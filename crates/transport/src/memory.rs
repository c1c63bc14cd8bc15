//! What a law takes of memory, before any of it is made.

use crate::grid::Grid;

/// Bytes of a number.
const NUMBER: f64 = 8.0;

/// Arrays over the points: the state, the other solution and what both become; rates and the stage of a step; sums of the operator; of conjugate gradients; of a row of the
/// history.
const OF_STATE: f64 = 5.0 + 6.0 + 1.0 + 3.0 + 2.0;

/// Arrays over the points and their ghosts: values, what is summed, a direction, pairs of a function.
const PADDED: f64 = 4.0;

/// Numbers for each number of a line that is transformed: tables and memory of its transforms, there and back, of the worst length.
const LINE: f64 = 40.0;

/// The same of a length that is a power of two.
const EVEN_LINE: f64 = 8.0;

/// Arrays of a plane that is transformed: spectra of rows and columns.
const PLANE: f64 = 3.0;

/// Numbers of a bond: its step, its weight, and both before they are corrected and along a direction.
const BOND: f64 = 12.0;

/// Bytes that a law on a grid and its steps take at most, with kernels of these horizons; `fourier`: may it be summed by Fourier transforms?
pub fn bytes(grid: &Grid, horizons: [Option<f64>; 2], fourier: bool) -> f64 {
    let [n, rows] = grid.cells.map(|c| c as f64);
    let plane = grid.dimension > 1;
    let reach = |horizon: f64| (horizon / grid.spacing).max(0.0).ceil();
    let longest = horizons
        .into_iter()
        .flatten()
        .map(reach)
        .fold(0.0, f64::max);
    let padded = match plane {
        true => (n + 2.0 * longest) * (rows + 2.0 * longest),
        false => n + 2.0 * longest,
    };
    let transforms = |n: f64, rows: f64, kernels: f64, line: f64| {
        let arrays = kernels + if plane { PLANE } else { 1.0 };
        arrays * n * rows + line * if plane { n + rows } else { n }
    };
    // kernels along each axis, that which spreads, and one while it is made
    let kernels = grid.dimension as f64 + 2.0;
    let own = if fourier {
        transforms(n, rows, kernels, LINE)
    } else {
        0.0
    };
    // their largest values, on a grid of their own
    let fine = |r: f64| {
        let n = libm::exp2(libm::log2(8.0 * r + 8.0).ceil());
        let rows = if plane { n } else { 1.0 };
        transforms(n, rows, grid.dimension as f64 + 1.0, EVEN_LINE)
    };
    let bonds = |r: f64| if plane { 1.6 * r * r } else { r };
    let each = horizons.into_iter().flatten().map(reach);
    let of_kernels: f64 = each.map(|r| BOND * bonds(r)).sum::<f64>() + fine(longest);
    NUMBER * (OF_STATE * n * rows + PADDED * padded + own + of_kernels)
}
