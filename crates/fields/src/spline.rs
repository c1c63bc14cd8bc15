//! β of splines, sums of truncated powers of the distance: `∫ (ρ − r)ⁿ dt` over what lies within ρ, by the integrals of powers of
//! `r = √(p² + t²)`, which are elementary: `∫ r dt = ½ (t r + p² asinh(t/p))`, `∫ r³ dt = ¼ (t r³ + 3 p² ∫ r dt)`.

use crate::kernel::{Kernel, Power};
use crate::patch::{EIGHT, Lanes};
use crate::segment::{Segment, View};
use peridyne::execute::lane::elementary::ln;

/// Splines of degree N.
#[inline(always)]
pub(crate) fn spline<const N: usize>(
    kernel: &Kernel,
    all: &[Segment],
    view: &View,
    list: &[u32],
    out: &mut [Lanes],
) {
    let scale = kernel.radius().powi(N as i32);
    for (n, out) in list.iter().zip(out) {
        let of = all[*n as usize];
        let mut sum = Lanes::ZERO;
        for power in &kernel.powers {
            let (radius, factor) = (power.radius / kernel.radius(), power.factor * scale);
            if of.is_here() {
                for k in 0..EIGHT {
                    let found = part::<N>(of.foot::<true>(view, k), of.length, radius);
                    sum[k] = factor.mul_add(found, sum[k]);
                }
            } else {
                for k in 0..EIGHT {
                    let found = part::<N>(of.foot::<false>(view, k), of.length, radius);
                    sum[k] = factor.mul_add(found, sum[k]);
                }
            }
        }
        *out = sum;
    }
}

/// The same of one point.
pub(crate) fn at_point<const N: usize>(kernel: &Kernel, foot: [f64; 2], length: f64) -> f64 {
    let scale = kernel.radius().powi(N as i32);
    let of = |p: &Power| p.factor * scale * part::<N>(foot, length, p.radius / kernel.radius());
    kernel.powers.iter().map(of).sum()
}

/// `∫ (ρ − r)ⁿ dt` of a bond whose line passes at p².
#[inline(always)]
fn part<const N: usize>([foot, rest]: [f64; 2], length: f64, radius: f64) -> f64 {
    let square = 1.0 - rest;
    let square = if square > 0.0 { square } else { 0.0 };
    let rest = radius.mul_add(radius, -square);
    let half = if rest > 0.0 { rest } else { 0.0 }.sqrt();
    let low = if foot < half { -foot } else { -half };
    let high = length - foot;
    let high = if high < half { high } else { half };
    // nothing inside: both ends are one, and all differences 0
    let high = if high > low { high } else { low };
    let near = low.mul_add(low, square);
    let far = high.mul_add(high, square);
    let (r0, r1) = (near.sqrt(), far.sqrt());
    // p² (asinh(b/p) − asinh(a/p)), from sums of numbers of one sign; 0 at p = 0
    let floor = 1e-200;
    let g0 = r0 + low.abs() + floor;
    let g1 = r1 + high.abs() + floor;
    let (above, below) = if low >= 0.0 {
        (g1, g0)
    } else if high <= 0.0 {
        (g0, g1)
    } else {
        (g0 * g1, if square > floor { square } else { floor })
    };
    let log = square * ln(above / below);
    let span = high - low;
    let one = 0.5 * ((high * r1 - low * r0) + log);
    let two = ((high * far - low * near) + 2.0 * square * span) * (1.0 / 3.0);
    let three = 0.25 * ((high * r1 * far - low * r0 * near) + 3.0 * square * one);
    if N == 3 {
        let inner = radius * (radius * span - 3.0 * one) + 3.0 * two;
        return radius * inner - three;
    }
    let four = ((high * far * far - low * near * near) + 4.0 * square * two) * 0.2;
    let inner = radius * (radius * span - 4.0 * one) + 6.0 * two;
    radius * (radius * inner - 4.0 * three) + four
}
