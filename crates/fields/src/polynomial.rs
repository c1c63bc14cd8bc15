//! β of polynomials in closed form, eight points at a time: what is inside is integrated from the foot to both of its ends.

use crate::patch::{EIGHT, Lanes};
use crate::segment::{Segment, View};

#[inline(always)]
pub(crate) fn polynomial(n: u32, all: &[Segment], view: &View, list: &[u32], out: &mut [Lanes]) {
    match n {
        0 => of_degree::<0>(all, view, list, out),
        1 => of_degree::<1>(all, view, list, out),
        2 => of_degree::<2>(all, view, list, out),
        3 => of_degree::<3>(all, view, list, out),
        4 => of_degree::<4>(all, view, list, out),
        5 => of_degree::<5>(all, view, list, out),
        6 => of_degree::<6>(all, view, list, out),
        _ => of_degree::<7>(all, view, list, out),
    }
}

/// The same of one point.
pub(crate) fn at_point(n: u32, foot: [f64; 2], length: f64) -> f64 {
    match n {
        0 => one::<0>(foot, length),
        1 => one::<1>(foot, length),
        2 => one::<2>(foot, length),
        3 => one::<3>(foot, length),
        4 => one::<4>(foot, length),
        5 => one::<5>(foot, length),
        6 => one::<6>(foot, length),
        _ => one::<7>(foot, length),
    }
}

/// `∫₀ᵗ (A − τ²)ⁿ dτ = t Σ c[j] A^(n−j) t^2j`.
const fn series(n: usize) -> [f64; 8] {
    let mut all = [0.0; 8];
    let (mut ways, mut j) = (1.0, 0);
    while j <= n {
        all[j] = ways / (2 * j + 1) as f64;
        ways *= -((n - j) as f64) / (j + 1) as f64;
        j += 1;
    }
    all
}

#[inline(always)]
fn of_degree<const N: usize>(all: &[Segment], view: &View, list: &[u32], out: &mut [Lanes]) {
    for (n, out) in list.iter().zip(out) {
        let of = all[*n as usize];
        // numbers of its own, one loop with a long body: so the compiler makes lanes of it
        let mut found = Lanes::ZERO;
        if of.is_here() {
            for k in 0..EIGHT {
                found[k] = one::<N>(of.foot::<true>(view, k), of.length);
            }
        } else {
            for k in 0..EIGHT {
                found[k] = one::<N>(of.foot::<false>(view, k), of.length);
            }
        }
        *out = found;
    }
}

#[inline(always)]
fn one<const N: usize>([foot, rest]: [f64; 2], length: f64) -> f64 {
    let table = const { series(N) };
    let rest = if rest > 0.0 { rest } else { 0.0 };
    let half = rest.sqrt();
    // from the foot to both ends of what is inside
    let low = if foot < half { foot } else { half };
    let low = if low > -half { low } else { -half };
    let high = length - foot;
    let high = if high < half { high } else { half };
    let high = if high > -half { high } else { -half };
    let (u, v) = (low * low, high * high);
    let (mut p, mut q) = (table[N], table[N]);
    let mut power = rest;
    for j in (0..N).rev() {
        let next = table[j] * power;
        p = u.mul_add(p, next);
        q = v.mul_add(q, next);
        power *= rest;
    }
    high.mul_add(q, low * p)
}
