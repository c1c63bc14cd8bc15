//! Sums over bonds, point by point. Products and sums alone, in one order: the bits are those of any instruction set.

use crate::flux::Flux;
use crate::grid::Padded;
use crate::kernel::Parity;
use crate::law::Law;
use crate::weights::Stencil;

/// Points whose sums stay in registers: eight registers of AVX2, four of AVX-512.
const BLOCK: usize = 32;

/// `Σ_m w_m v(x + mh)` over all bonds, component `axis` of odd weights; of an even kernel `Σ_m w_m (v(x + mh) − v(x))`.
pub fn convolve(stencil: &Stencil, axis: usize, padded: &Padded, v: &[f64], out: &mut [f64]) {
    let bonds: Vec<(isize, f64)> = { stencil.steps.iter().zip(&stencil.weights) }
        .filter(|(_, w)| w[axis] != 0.0)
        .map(|(m, w)| (padded.offset(*m), w[axis]))
        .collect();
    let n = padded.grid.cells[0];
    for (j, out) in out.chunks_exact_mut(n).enumerate() {
        row(stencil.parity, &bonds, v, padded.row(j), out);
    }
}

fn row(parity: Parity, bonds: &[(isize, f64)], v: &[f64], start: usize, out: &mut [f64]) {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: just detected
            return unsafe { with_avx512(parity, bonds, v, start, out) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: just detected
            return unsafe { with_avx2(parity, bonds, v, start, out) };
        }
    }
    of_row(parity, bonds, v, start, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn with_avx512(parity: Parity, bonds: &[(isize, f64)], v: &[f64], start: usize, out: &mut [f64]) {
    of_row(parity, bonds, v, start, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(parity: Parity, bonds: &[(isize, f64)], v: &[f64], start: usize, out: &mut [f64]) {
    of_row(parity, bonds, v, start, out);
}

#[inline(always)]
fn of_row(parity: Parity, bonds: &[(isize, f64)], v: &[f64], start: usize, out: &mut [f64]) {
    let mut at = start;
    let mut blocks = out.chunks_exact_mut(BLOCK);
    for block in &mut blocks {
        match parity {
            Parity::Odd => odd::<BLOCK>(bonds, v, at, block),
            Parity::Even => even::<BLOCK>(bonds, v, at, block),
        }
        at += BLOCK;
    }
    for one in blocks.into_remainder().chunks_exact_mut(1) {
        match parity {
            Parity::Odd => odd::<1>(bonds, v, at, one),
            Parity::Even => even::<1>(bonds, v, at, one),
        }
        at += 1;
    }
}

#[inline(always)]
fn odd<const N: usize>(bonds: &[(isize, f64)], v: &[f64], at: usize, out: &mut [f64]) {
    let mut sum = [0.0; N];
    for (offset, w) in bonds {
        let ahead = &v[at.wrapping_add_signed(*offset)..][..N];
        let behind = &v[at.wrapping_add_signed(-*offset)..][..N];
        for i in 0..N {
            sum[i] += w * (ahead[i] - behind[i]);
        }
    }
    out.copy_from_slice(&sum);
}

#[inline(always)]
fn even<const N: usize>(bonds: &[(isize, f64)], v: &[f64], at: usize, out: &mut [f64]) {
    let mut sum = [0.0; N];
    let here = &v[at..][..N];
    for (offset, w) in bonds {
        let ahead = &v[at.wrapping_add_signed(*offset)..][..N];
        let behind = &v[at.wrapping_add_signed(-*offset)..][..N];
        for i in 0..N {
            sum[i] += w * ((ahead[i] - here[i]) + (behind[i] - here[i]));
        }
    }
    out.copy_from_slice(&sum);
}

/// Each bond with an end in the grid once: `visit(p, q, flux weight, spreading weight)`, p before q in memory, of which either may be a ghost
/// of a collar. Where the boundary is periodic the first end is a point and the other possibly its image.
pub(super) fn pairs(
    law: &Law,
    padded: &Padded,
    direction: &[Vec<f64>],
    mut visit: impl FnMut(usize, usize, bool, bool, f64, f64),
) {
    let grid = &padded.grid;
    let [n, rows] = grid.cells.map(|c| c as isize);
    let mut over = |stencil: &Stencil, carries: bool| {
        for (m, w) in stencil.steps.iter().zip(&stencil.weights) {
            let offset = padded.offset(*m);
            // first ends in the grid, and behind it where the second is still inside
            let collars = !law.periodic();
            let (from_j, from_i) = match collars {
                true => (-m[1].max(0), -m[0].max(0)),
                false => (0, 0),
            };
            let to_i = if collars { n + (-m[0]).max(0) } else { n };
            for j in from_j..rows {
                for i in from_i..to_i {
                    let inside = |i: isize, j: isize| (0..n).contains(&i) && (0..rows).contains(&j);
                    let (first, second) = (inside(i, j), !collars || inside(i + m[0], j + m[1]));
                    if !(first || second) {
                        continue;
                    }
                    let p = padded.row(0).wrapping_add_signed(padded.offset([i, j]));
                    let q = p.wrapping_add_signed(offset);
                    match carries {
                        true => {
                            let w = { direction.iter().zip(w) }
                                .map(|(d, w)| 0.5 * w * (d[p] + d[q]))
                                .sum();
                            visit(p, q, first, second, w, 0.0);
                        }
                        false => visit(p, q, first, second, 0.0, w[0]),
                    }
                }
            }
        }
    };
    if let Some(advection) = &law.advection {
        over(&advection.stencil, true);
    }
    if let Some(diffusion) = &law.diffusion {
        over(&diffusion.stencil, false);
    }
}

/// Adds the transport of a flux that is no polynomial: `−Σ_m w_m F(u(x), u(x + mh))`.
pub(super) fn carry(
    law: &Law,
    flux: &Flux,
    padded: &Padded,
    direction: &[Vec<f64>],
    v: &[f64],
    out: &mut [f64],
) {
    let n = padded.grid.cells[0];
    let Some(advection) = &law.advection else {
        return;
    };
    for (m, w) in advection
        .stencil
        .steps
        .iter()
        .zip(&advection.stencil.weights)
    {
        let offset = padded.offset(*m);
        for (j, out) in out.chunks_exact_mut(n).enumerate() {
            let start = padded.row(j);
            for (i, out) in out.iter_mut().enumerate() {
                let p = start + i;
                let [ahead, behind] = [offset, -offset].map(|o| {
                    let q = p.wrapping_add_signed(o);
                    let w: f64 = { direction.iter().zip(w) }
                        .map(|(d, w)| 0.5 * w * (d[p] + d[q]))
                        .sum();
                    w * flux.value(v[p], v[q])
                });
                *out -= ahead - behind;
            }
        }
    }
}
