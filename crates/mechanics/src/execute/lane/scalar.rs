//! One number: the portable reference.

use super::{Lane, Piece};

impl super::sealed::Sealed for f64 {}

impl Lane for f64 {
    const N: usize = 1;
    type Mask = bool;

    /// With the fused multiply-add of the processor, which plain code calls a function for.
    #[inline(never)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        crate::execute::simd::fused(piece)
    }

    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> f64 {
        // SAFETY: the caller's promise
        unsafe { *p }
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        // SAFETY: the caller's promise
        unsafe { *p = self }
    }
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [f64; 4] {
        // SAFETY: the caller's promise
        unsafe {
            let p = base.add(4 * *index as usize);
            [*p, *p.add(1), *p.add(2), *p.add(3)]
        }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [f64; 2] {
        // SAFETY: the caller's promise
        unsafe {
            let p = base.add(2 * *index as usize);
            [*p, *p.add(1)]
        }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> f64 {
        f64::from_bits(super::ROOT_MAGIC.wrapping_sub(self.to_bits() >> 1))
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> f64 {
        f64::from_bits(self.to_bits() << 52)
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [f64; 2] {
        let bits = self.to_bits();
        [
            f64::from_bits(bits & super::MANTISSA | super::ONE),
            f64::from_bits(bits >> 52 | super::TWO_TO_52),
        ]
    }
    #[inline(always)]
    fn fma(self, a: f64, b: f64) -> f64 {
        self.mul_add(a, b)
    }
    #[inline(always)]
    fn div(self, a: f64) -> f64 {
        self / a
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn round(self) -> f64 {
        self.round_ties_even()
    }
    #[inline(always)]
    fn lt(self, other: f64) -> bool {
        self < other
    }
    #[inline(always)]
    fn ge(self, other: f64) -> bool {
        self >= other
    }
    #[inline(always)]
    fn is_nan(self) -> bool {
        f64::is_nan(self)
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, part: usize) -> bool {
        bits >> part & 1 == 0
    }
    #[inline(always)]
    fn or(a: bool, b: bool) -> bool {
        a | b
    }
    #[inline(always)]
    fn bits(m: bool) -> u32 {
        m as u32
    }
    #[inline(always)]
    fn nan_if(self, m: bool) -> f64 {
        if m { f64::NAN } else { self }
    }
    #[inline(always)]
    fn zero_if(self, m: bool) -> f64 {
        if m { 0.0 } else { self }
    }
    #[inline(always)]
    fn select(m: bool, a: f64, b: f64) -> f64 {
        if m { a } else { b }
    }
}
