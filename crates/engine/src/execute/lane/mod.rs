//! A lane type: one `f64`, or several in a vector register. Laws are written once, over any lane.
//!
//! Every operation is the IEEE one (fused where it says so), so all widths give the same bits.

use std::ops::{Add, Mul, Sub};

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
pub mod scalar;

/// Number of points that one byte of bond bits covers.
pub const TILE: usize = 8;

/// `N` numbers advancing together.
///
/// # Safety of implementations
/// Vector implementations may only be used inside functions compiled for their instruction set; [`super::simd`]
/// is the one place that does this.
pub trait Lane: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Lanes; divides [`TILE`].
    const N: usize;
    type Mask: Copy;

    fn splat(x: f64) -> Self;
    /// # Safety
    /// `p` is valid for reading `N` numbers.
    unsafe fn load(p: *const f64) -> Self;
    /// # Safety
    /// `p` is valid for writing `N` numbers.
    unsafe fn store(self, p: *mut f64);
    /// Four-number records at `base + 4 index[l]`, transposed: result `[c]` holds component `c` of all lanes.
    /// # Safety
    /// `index` is valid for reading `N` numbers and every record is readable.
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4];
    /// Two-number records at `base + 2 index[l]`, transposed like [`Lane::gather4`].
    /// # Safety
    /// `index` is valid for reading `N` numbers and every record is readable.
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2];
    /// `ROOT_MAGIC − (bits >> 1)` as a number: 1/√self within 3.5 %, the same on every machine.
    fn inv_sqrt_estimate(self) -> Self;
    /// `self * a + b`, rounded once.
    fn fma(self, a: Self, b: Self) -> Self;
    fn div(self, a: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The smaller one; `other` where `self` is not a number.
    fn min(self, other: Self) -> Self;
    /// To the nearest integer, ties to even.
    fn round(self) -> Self;
    /// Ordered comparison: false where either is not a number.
    fn lt(self, other: Self) -> Self::Mask;
    fn ge(self, other: Self) -> Self::Mask;
    /// Lanes whose bit in `bits` is 0; vector `part` of the tile reads bits `part·N ..`.
    fn dead(bits: u8, part: usize) -> Self::Mask;
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One bit per lane.
    fn bits(m: Self::Mask) -> u32;
    /// Not a number where `m`.
    fn nan_if(self, m: Self::Mask) -> Self;
    /// 0 where `m`.
    fn zero_if(self, m: Self::Mask) -> Self;
    /// `a` where `m`, else `b`.
    fn select(m: Self::Mask, a: Self, b: Self) -> Self;

    #[inline(always)]
    fn any(m: Self::Mask) -> bool {
        Self::bits(m) != 0
    }
    /// All lanes as an array (the first `N` entries).
    #[inline(always)]
    fn to_array(self) -> [f64; TILE] {
        let mut a = [0.0; TILE];
        // SAFETY: N ≤ TILE
        unsafe { self.store(a.as_mut_ptr()) };
        a
    }
}

/// Minimises the error of [`Lane::inv_sqrt_estimate`] (Lomont 2003, 64 bits).
const ROOT_MAGIC: u64 = 0x5fe6_eb50_c7b5_37a9;

/// `1/√a` for normal a > 0 within 2 units in the last place, without division or root: the estimate and two steps
/// of fourth order, `y (1 − h/2 + 3h²/8 − 5h³/16)` with `h = a y² − 1` (|h| ≤ 0.07, then 1e-5, then round-off).
#[inline(always)]
pub fn inv_sqrt<L: Lane>(a: L) -> L {
    let mut y = a.inv_sqrt_estimate();
    for _ in 0..2 {
        let h = (a * y).fma(y, L::splat(-1.0));
        let p = L::splat(-0.3125).fma(h, L::splat(0.375));
        let p = p.fma(h, L::splat(-0.5));
        y = (y * h).fma(p, y);
    }
    y
}

/// Where the series below is exact to rounding: seven terms leave 0.4 e⁷ ≤ 7e-16.
const SERIES: f64 = 1.0 / 128.0;

/// Lanes that need the root instead of the series.
#[inline(always)]
pub fn beyond_series<L: Lane>(e: L) -> L::Mask {
    e.abs().ge(L::splat(SERIES))
}

#[inline(always)]
fn horner<L: Lane>(e: L, c: [f64; 7]) -> L {
    let mut p = L::splat(c[6]);
    for k in (0..6).rev() {
        p = p.fma(e, L::splat(c[k]));
    }
    p * e
}

/// `1 − (1+e)^(−½)`, binomial series; only where not [`beyond_series`].
///
/// With `e = |ξ+η|²/|ξ|² − 1` this is (r − r0)/r: extension over current length.
#[inline(always)]
pub fn extension_over_length_series<L: Lane>(e: L) -> L {
    horner(
        e,
        [
            0.5,
            -0.375,
            0.3125,
            -0.2734375,
            0.24609375,
            -0.2255859375,
            0.20947265625,
        ],
    )
}

/// `(1+e)^(½) − 1`, binomial series; only where not [`beyond_series`]. This is the stretch (r − r0)/r0.
#[inline(always)]
pub fn stretch_series<L: Lane>(e: L) -> L {
    horner(
        e,
        [
            0.5,
            -0.125,
            0.0625,
            -0.0390625,
            0.02734375,
            -0.0205078125,
            0.01611328125,
        ],
    )
}

/// `1 − (1+e)^(−½)` anywhere e > −1: series where it is exact, `e/(w(1+w))` with `w = √(1+e)` beyond.
/// Lane by lane the same choice, so the width does not show.
#[inline(always)]
pub fn extension_over_length<L: Lane>(e: L) -> L {
    let far = beyond_series(e);
    let near = extension_over_length_series(e);
    if !L::any(far) {
        return near;
    }
    let one = L::splat(1.0);
    let w = (one + e).sqrt();
    L::select(far, e.div(w * (one + w)), near)
}

/// `√(1+e) − 1` anywhere e ≥ −1.
#[inline(always)]
pub fn stretch<L: Lane>(e: L) -> L {
    let far = beyond_series(e);
    let near = stretch_series(e);
    if !L::any(far) {
        return near;
    }
    let one = L::splat(1.0);
    L::select(far, e.div(one + (one + e).sqrt()), near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_root_is_exact_to_two_units() {
        let mut a = 1e-30;
        while a < 1e30 {
            let exact = 1.0 / f64::sqrt(a);
            assert!((inv_sqrt(a) - exact).abs() <= 4.5e-16 * exact, "at {a}");
            a *= 1.00837;
        }
    }

    #[test]
    fn series_and_root_agree_with_the_closed_form() {
        let mut e = 1e-12;
        while e < 3.0 {
            for e in [e, -e] {
                if e <= -1.0 {
                    continue;
                }
                // exact value without cancellation
                let w = (1.0f64 + e).sqrt();
                let g = e / (w * (1.0 + w));
                let s = e / (1.0 + w);
                assert!(
                    (extension_over_length(e) - g).abs() <= 2e-15 * g.abs(),
                    "g at {e}"
                );
                assert!((stretch(e) - s).abs() <= 2e-15 * s.abs(), "s at {e}");
            }
            e *= 1.37;
        }
        assert_eq!(extension_over_length(0.0), 0.0);
        assert_eq!(stretch(0.0), 0.0);
    }
}
