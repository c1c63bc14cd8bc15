//! Two registers advancing together: what they share (constants of a bond, loop control) is paid for once.

use super::{Lane, Piece};
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy)]
pub struct Pair<L>(L, L);

impl<L: Lane> Add for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Pair(self.0 + o.0, self.1 + o.1)
    }
}
impl<L: Lane> Sub for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Pair(self.0 - o.0, self.1 - o.1)
    }
}
impl<L: Lane> Mul for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Pair(self.0 * o.0, self.1 * o.1)
    }
}

// SAFETY, for every block: as the trait's callers promise
impl<L: Lane> super::sealed::Sealed for Pair<L> {}

impl<L: Lane> Lane for Pair<L> {
    const N: usize = 2 * L::N;
    type Mask = (L::Mask, L::Mask);

    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        L::out_of_line(piece)
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        let x = L::splat(x);
        Pair(x, x)
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> Self {
        unsafe { Pair(L::load(p), L::load(p.add(L::N))) }
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        unsafe {
            self.0.store(p);
            self.1.store(p.add(L::N));
        }
    }
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4] {
        unsafe {
            let [a, b, c, d] = L::gather4(base, index);
            let [e, f, g, h] = L::gather4(base, index.add(L::N));
            [Pair(a, e), Pair(b, f), Pair(c, g), Pair(d, h)]
        }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2] {
        unsafe {
            let [a, b] = L::gather2(base, index);
            let [c, d] = L::gather2(base, index.add(L::N));
            [Pair(a, c), Pair(b, d)]
        }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> Self {
        Pair(self.0.inv_sqrt_estimate(), self.1.inv_sqrt_estimate())
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> Self {
        Pair(self.0.exponent_from_bits(), self.1.exponent_from_bits())
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        let [a, b] = self.0.mantissa_and_exponent();
        let [c, d] = self.1.mantissa_and_exponent();
        [Pair(a, c), Pair(b, d)]
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        Pair(self.0.fma(a.0, b.0), self.1.fma(a.1, b.1))
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        Pair(self.0.div(a.0), self.1.div(a.1))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Pair(self.0.sqrt(), self.1.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Pair(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        Pair(self.0.min(o.0), self.1.min(o.1))
    }
    #[inline(always)]
    fn max(self, o: Self) -> Self {
        Pair(self.0.max(o.0), self.1.max(o.1))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Pair(self.0.round(), self.1.round())
    }
    #[inline(always)]
    fn lt(self, o: Self) -> Self::Mask {
        (self.0.lt(o.0), self.1.lt(o.1))
    }
    #[inline(always)]
    fn ge(self, o: Self) -> Self::Mask {
        (self.0.ge(o.0), self.1.ge(o.1))
    }
    #[inline(always)]
    fn is_nan(self) -> Self::Mask {
        (self.0.is_nan(), self.1.is_nan())
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, part: usize) -> Self::Mask {
        (
            L::dead_in_part(bits, 2 * part),
            L::dead_in_part(bits, 2 * part + 1),
        )
    }
    #[inline(always)]
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask {
        (L::or(a.0, b.0), L::or(a.1, b.1))
    }
    #[inline(always)]
    fn bits(m: Self::Mask) -> u32 {
        L::bits(m.0) | L::bits(m.1) << L::N
    }
    #[inline(always)]
    fn nan_if(self, m: Self::Mask) -> Self {
        Pair(self.0.nan_if(m.0), self.1.nan_if(m.1))
    }
    #[inline(always)]
    fn zero_if(self, m: Self::Mask) -> Self {
        Pair(self.0.zero_if(m.0), self.1.zero_if(m.1))
    }
    #[inline(always)]
    fn select(m: Self::Mask, a: Self, b: Self) -> Self {
        Pair(L::select(m.0, a.0, b.0), L::select(m.1, a.1, b.1))
    }
}
