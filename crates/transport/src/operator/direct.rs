//! Sums over bonds, point by point. Products and sums alone, in one order: the bits are those of any instruction set.

use crate::flux::Psi;
use crate::grid::Padded;
use crate::kernel::Parity;
use crate::law::{Direction, Law};
use crate::stop::Stop;
use crate::threads::{PIECE, pieces};
use crate::weights::Stencil;

/// Points whose sums stay in registers: eight registers of AVX2, four of AVX-512.
const BLOCK: usize = 32;

/// Additions, about, after which it is asked whether to go on: some milliseconds.
const UNASKED: usize = 1 << 23;

/// `Σ_m w_m v(x + mh)` over all bonds, component `axis` of odd weights; of an even kernel `Σ_m w_m (v(x + mh) − v(x))`.
pub fn convolve(
    stencil: &Stencil,
    axis: usize,
    padded: &Padded,
    v: &[f64],
    out: &mut [f64],
    stop: &Stop,
) {
    let bonds: Vec<(isize, f64)> = { stencil.steps.iter().zip(&stencil.weights) }
        .filter(|(_, w)| w[axis] != 0.0)
        .map(|(m, w)| (padded.offset(*m), w[axis]))
        .collect();
    let [n, _] = padded.grid.cells;
    let unasked = (UNASKED / bonds.len().max(1)).max(BLOCK) / BLOCK * BLOCK;
    pieces(out, line(padded), 2 * bonds.len(), |first, out| {
        let mut start = padded.row(first / n) + first % n;
        for part in out.chunks_mut(unasked) {
            if stop.asked() {
                return;
            }
            row(stencil.parity, &bonds, v, start, part);
            start += part.len();
        }
    });
}

/// Points that are summed together by one thread: a piece of a line, a row of a plane.
fn line(padded: &Padded) -> usize {
    match padded.grid.cells {
        [_, 1] => PIECE,
        [n, _] => n,
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

/// Adds the transport of a flux that is no polynomial, `−Σ_m w_m F(u(x), u(x + mh))`: F of each pair once, for all pairs of a step together.
pub(super) fn carry(
    law: &Law,
    psi: &dyn Psi,
    padded: &Padded,
    direction: &[Vec<f64>],
    v: &[f64],
    (pairs, stop): (&mut Vec<f64>, &Stop),
    out: &mut [f64],
) {
    /// of an evaluation
    const WORK: usize = 16;
    let [n, rows] = padded.grid.cells;
    let Some(advection) = &law.advection else {
        return;
    };
    pairs.resize(padded.size(), 0.0);
    let own = line(padded);
    let length = if rows == 1 { PIECE } else { padded.stride };
    let stencil = &advection.stencil;
    for (m, w) in stencil.steps.iter().zip(&stencil.weights) {
        // steps go ahead in memory: m[1] ≥ 0, and m[0] > 0 where that is 0
        let offset = padded.offset(*m).unsigned_abs();
        let up = m[1].unsigned_abs();
        let low = padded.margin[0] - m[0].max(0).unsigned_abs();
        let high = padded.margin[0] + n + (-m[0]).max(0).unsigned_abs();
        if stop.asked() {
            return;
        }
        pieces(pairs, length, WORK, |first, piece| {
            if stop.asked() {
                return;
            }
            let row = first / padded.stride;
            if row + up < padded.margin[1] || row >= padded.margin[1] + rows {
                return;
            }
            let begin = (row * padded.stride + low).max(first);
            let end = (row * padded.stride + high).min(first + piece.len());
            if begin >= end {
                return;
            }
            let piece = &mut piece[begin - first..end - first];
            let (here, there) = (&v[begin..end], &v[begin + offset..end + offset]);
            for ((f, u), v) in piece.iter_mut().zip(here).zip(there) {
                *f = 0.5 * (u + v);
            }
            psi.values(piece);
            match advection.direction {
                Direction::Constant(d) => {
                    let w = w[0] * d[0] + w[1] * d[1];
                    piece.iter_mut().for_each(|f| *f *= w);
                }
                Direction::Field(_) => {
                    for (k, f) in piece.iter_mut().enumerate() {
                        let (p, q) = (begin + k, begin + k + offset);
                        let both = direction.iter().zip(w);
                        *f *= both.map(|(d, w)| 0.5 * w * (d[p] + d[q])).sum::<f64>();
                    }
                }
            }
        });
        pieces(out, own, 4, |first, out| {
            let p = padded.row(first / n) + first % n;
            let (ahead, behind) = (&pairs[p..], &pairs[p - offset..]);
            for ((out, ahead), behind) in out.iter_mut().zip(ahead).zip(behind) {
                *out -= ahead - behind;
            }
        });
    }
}
