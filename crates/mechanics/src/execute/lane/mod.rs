//! A lane type: one `f64`, or several in a vector register. Laws are written once, over any lane.
//!
//! Every operation is the IEEE one (fused where it says so), so all widths give the same bits.

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::F64x4;
#[cfg(target_arch = "x86_64")]
pub(super) use avx512::F64x8;
pub(super) use eight::Eight;
#[cfg(target_arch = "aarch64")]
pub(super) use neon::F64x2;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(super) use pair::Pair;
use std::ops::{Add, Mul, Sub};

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod eight;
pub mod elementary;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod pair;
mod scalar;
pub(crate) mod series;

/// Number of points that one byte of bond bits covers.
pub const TILE: usize = 8;

/// Work on lanes that many loops have in common, or that they seldom do: compiled once and called ([`Lane::out_of_line`]), not
/// copied into each of them. Implement `run` with `#[inline(always)]`.
pub trait Piece {
    type Out;
    fn run(self) -> Self::Out;
}

/// Only this crate makes lanes.
pub(crate) mod sealed {
    pub trait Sealed {}
}

/// `N` numbers advancing together. Laws are written over any; what lanes there are is known inside kernels alone, but for a
/// single `f64`.
///
/// # Safety of implementations
/// Vector implementations may only be used inside functions compiled for their instruction set; [`super::simd`]
/// is the one place that does this.
pub trait Lane:
    sealed::Sealed + Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
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
    /// `2ⁿ` of `2⁵³ − 2⁵¹ + 1023 + n`, −1023 < n ≤ 1023: the lowest bits become the exponent.
    fn exponent_from_bits(self) -> Self;
    /// Mantissa from 1 to 2, and `2⁵² + 1023 + exponent`, of a positive normal number.
    fn mantissa_and_exponent(self) -> [Self; 2];
    /// `self * a + b`, rounded once.
    fn fma(self, a: Self, b: Self) -> Self;
    fn div(self, a: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    /// The smaller one; `other` where `self` is not a number.
    fn min(self, other: Self) -> Self;
    /// The larger one; `other` where `self` is not a number.
    fn max(self, other: Self) -> Self;
    /// To the nearest integer, ties to even.
    fn round(self) -> Self;
    /// Ordered comparison: false where either is not a number.
    fn lt(self, other: Self) -> Self::Mask;
    fn ge(self, other: Self) -> Self::Mask;
    fn is_nan(self) -> Self::Mask;
    /// Lanes whose bit in `bits` is 0; vector `part` of a tile reads bits `part·N ..`.
    fn dead_in_part(bits: u8, part: usize) -> Self::Mask;
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One bit per lane.
    fn bits(m: Self::Mask) -> u32;
    /// Not a number where `m`.
    fn nan_if(self, m: Self::Mask) -> Self;
    /// 0 where `m`.
    fn zero_if(self, m: Self::Mask) -> Self;
    /// `a` where `m`, else `b`.
    fn select(m: Self::Mask, a: Self, b: Self) -> Self;

    /// Do a piece of work out of line, in code of this lane's instruction set.
    fn out_of_line<P: Piece>(piece: P) -> P::Out;

    /// Lanes whose bit in `bits` is 0.
    #[inline(always)]
    fn dead(bits: u8) -> Self::Mask {
        Self::dead_in_part(bits, 0)
    }
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

/// Bits of the mantissa; of 1; of 2⁵².
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
const ONE: u64 = 0x3ff0_0000_0000_0000;
const TWO_TO_52: u64 = 0x4330_0000_0000_0000;

/// Minimises the error of [`Lane::inv_sqrt_estimate`] (Lomont 2003, 64 bits).
const ROOT_MAGIC: u64 = 0x5fe6_eb50_c7b5_37a9;

/// Ask for the cache line of an address, which need not be one.
#[inline(always)]
pub fn prefetch(_place: *const f64) {
    #[cfg(target_arch = "aarch64")]
    // SAFETY: a hint, as below
    unsafe {
        std::arch::asm!("prfm pldl1keep, [{}]", in(reg) _place, options(nostack, readonly, preserves_flags));
    }
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a hint; every machine of this kind takes it, and no address faults
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(_place.cast());
    }
}

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
