//! Space wound up on rings of cells, one for each axis (see [`Cells`](super::cells)), and the points that go there.

use crate::body::{Body, Layout};

/// Units of a ring.
pub(super) const FULL: f64 = (1u64 << 32) as f64;

/// The distinct cells around one of those on rings, itself included.
pub(super) fn each_around<const D: usize>(
    count: [usize; D],
    at: [usize; D],
    visit: impl FnMut(usize),
) {
    // 3^D of them, built up axis by axis
    let mut around = [0usize; 27];
    let (mut len, mut stride) = (1, 1);
    for a in 0..D {
        let n = count[a];
        let up = if at[a] + 1 == n { 0 } else { at[a] + 1 };
        let down = if at[a] == 0 { n - 1 } else { at[a] - 1 };
        let ring = [at[a], up, down];
        let distinct = n.min(3);
        for k in (0..len).rev() {
            for (r, c) in ring[..distinct].iter().enumerate().rev() {
                around[r * len + k] = around[k] + c * stride;
            }
        }
        len *= distinct;
        stride *= n;
    }
    around[..len].iter().copied().for_each(visit);
}

/// The cell of a coordinate on each ring.
#[inline(always)]
pub(super) fn cell_at<const D: usize>(count: [usize; D], place: &[u32; D]) -> [usize; D] {
    crate::array::from_fn(|a| ((place[a] as u64 * count[a] as u64) >> 32) as usize)
}

/// Its number among all.
#[inline(always)]
pub(super) fn number<const D: usize>(count: [usize; D], cell: [usize; D]) -> usize {
    (0..D).rev().fold(0, |c, a| c * count[a] + cell[a])
}

/// The fraction of `t / 2³²` above a whole number, in units of 2⁻³²: the low half of the integer.
pub(super) fn wind(t: f64) -> u32 {
    t as i64 as u32
}

/// Slot and reference position of every point. On a grid, walked row by row: finding the coordinates of a single slot
/// takes divisions.
pub(super) fn each_point<const D: usize>(body: &Body<D>, mut visit: impl FnMut(usize, [f64; D])) {
    each_of(body, 0, &mut visit);
}

/// The same of a body whose slots begin at `start`.
fn each_of<const D: usize>(body: &Body<D>, start: usize, visit: &mut impl FnMut(usize, [f64; D])) {
    let grid = match &body.layout {
        Layout::Cloud(x) => {
            for &slot in &body.slots {
                visit(
                    start + slot as usize,
                    crate::array::from_fn(|a| x[a][slot as usize]),
                );
            }
            return;
        }
        Layout::Several(pieces) => {
            for p in pieces {
                each_of(&p.body, p.first, visit);
            }
            return;
        }
        Layout::Grid(grid) => grid,
    };
    let lattice = &grid.lattice;
    let edges = lattice.kind.edges();
    // a part of a grid has some of its cells
    let wide = grid.cells[0];
    let all: usize = grid.cells.iter().product();
    let last = (grid.first + grid.stride).min(all);
    let rows = grid.first / wide..last.div_ceil(wide);
    for (b, site) in lattice.kind.basis().iter().enumerate() {
        let coordinate = |a: usize, c: usize| {
            let quarter = 4 * (c as i32 + grid.low[a]) + site[a];
            lattice.origin[a] + lattice.spacing * edges[a] * (quarter as f64 / 4.0)
        };
        for row in rows.clone() {
            let mut x = [0.0; D];
            let mut rest = row;
            for a in 1..D {
                x[a] = coordinate(a, rest % grid.cells[a]);
                rest /= grid.cells[a];
            }
            let begin = row * wide;
            let first = grid.guard + b * grid.stride;
            for cell in begin.max(grid.first)..(begin + wide).min(last) {
                let slot = first + cell - grid.first;
                if grid.is_owned(slot) {
                    x[0] = coordinate(0, cell - begin);
                    visit(start + slot, x);
                }
            }
        }
    }
}
