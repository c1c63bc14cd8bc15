//! Eight single numbers: the portable path.
//!
//! Where vector paths exist beside it, this one serves old machines and as a reference, and its operations are calls: inlined
//! into every loop, eight times each, they would be the larger part of the program and of the time to compile it.

use super::{Lane, Piece, TILE};
use crate::array::from_fn;
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy)]
pub struct Eight([f64; TILE]);

type Mask = [bool; TILE];

#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    inline(always)
)]
fn one(a: &Eight, f: impl Fn(f64) -> f64) -> Eight {
    Eight(from_fn(|l| f(a.0[l])))
}

#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    inline(always)
)]
fn two(a: &Eight, b: &Eight, f: impl Fn(f64, f64) -> f64) -> Eight {
    Eight(from_fn(|l| f(a.0[l], b.0[l])))
}

#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    inline(always)
)]
fn test(a: &Eight, b: &Eight, f: impl Fn(f64, f64) -> bool) -> Mask {
    from_fn(|l| f(a.0[l], b.0[l]))
}

#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    inline(always)
)]
fn blend(m: &Mask, a: &Eight, b: &Eight) -> Eight {
    Eight(from_fn(|l| f64::select(m[l], a.0[l], b.0[l])))
}

/// Records of `N` numbers, transposed.
#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
#[cfg_attr(
    not(any(target_arch = "x86_64", target_arch = "aarch64")),
    inline(always)
)]
unsafe fn gather<const N: usize>(base: *const f64, index: *const u32) -> [Eight; N] {
    from_fn(|c| {
        // SAFETY: the caller's promise
        Eight(from_fn(|l| unsafe {
            *base.add(N * *index.add(l) as usize + c)
        }))
    })
}

impl Add for Eight {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        two(&self, &o, |a, b| a + b)
    }
}
impl Sub for Eight {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        two(&self, &o, |a, b| a - b)
    }
}
impl Mul for Eight {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        two(&self, &o, |a, b| a * b)
    }
}

impl super::sealed::Sealed for Eight {}

impl Lane for Eight {
    const N: usize = TILE;
    type Mask = Mask;

    #[inline(never)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        piece.run()
    }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Eight([x; TILE])
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> Self {
        // SAFETY: the caller's promise
        Eight(unsafe { p.cast::<[f64; TILE]>().read_unaligned() })
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        // SAFETY: the caller's promise
        unsafe { p.cast::<[f64; TILE]>().write_unaligned(self.0) }
    }
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4] {
        // SAFETY: the caller's promise
        unsafe { gather(base, index) }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2] {
        // SAFETY: the caller's promise
        unsafe { gather(base, index) }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> Self {
        one(&self, |a| a.inv_sqrt_estimate())
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> Self {
        one(&self, |a| a.exponent_from_bits())
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        from_fn(|n| one(&self, |a| a.mantissa_and_exponent()[n]))
    }
    #[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), inline(never))]
    #[cfg_attr(
        not(any(target_arch = "x86_64", target_arch = "aarch64")),
        inline(always)
    )]
    fn fma(self, a: Self, b: Self) -> Self {
        Eight(from_fn(|l| self.0[l].mul_add(a.0[l], b.0[l])))
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        two(&self, &a, |x, y| x / y)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        one(&self, f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        one(&self, f64::abs)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        two(&self, &other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        two(&self, &other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn round(self) -> Self {
        one(&self, f64::round_ties_even)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        test(&self, &other, |a, b| a < b)
    }
    #[inline(always)]
    fn ge(self, other: Self) -> Mask {
        test(&self, &other, |a, b| a >= b)
    }
    #[inline(always)]
    fn is_nan(self) -> Mask {
        self.0.map(f64::is_nan)
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, part: usize) -> Mask {
        from_fn(|l| bits >> (part * TILE + l) & 1 == 0)
    }
    #[inline(always)]
    fn or(a: Mask, b: Mask) -> Mask {
        from_fn(|l| a[l] | b[l])
    }
    #[inline(always)]
    fn bits(m: Mask) -> u32 {
        (0..TILE).fold(0, |bits, l| bits | u32::from(m[l]) << l)
    }
    #[inline(always)]
    fn nan_if(self, m: Mask) -> Self {
        blend(&m, &Self::splat(f64::NAN), &self)
    }
    #[inline(always)]
    fn zero_if(self, m: Mask) -> Self {
        blend(&m, &Self::splat(0.0), &self)
    }
    #[inline(always)]
    fn select(m: Mask, a: Self, b: Self) -> Self {
        blend(&m, &a, &b)
    }
}
