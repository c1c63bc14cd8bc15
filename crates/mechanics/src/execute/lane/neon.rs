//! Two numbers in a register of NEON, which every 64-bit ARM processor has.

use super::{Lane, Piece};
use std::arch::aarch64::*;
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x2(float64x2_t);

/// The bit of each lane, for the four parts of a tile.
static LANE_BIT: [[u64; 2]; 4] = [[1, 2], [4, 8], [16, 32], [64, 128]];

// SAFETY, for every block in this file: the instructions exist on every processor of this architecture; pointers are as the trait's
// callers promise.
impl Add for F64x2 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        unsafe { F64x2(vaddq_f64(self.0, o.0)) }
    }
}
impl Sub for F64x2 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        unsafe { F64x2(vsubq_f64(self.0, o.0)) }
    }
}
impl Mul for F64x2 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        unsafe { F64x2(vmulq_f64(self.0, o.0)) }
    }
}

impl super::sealed::Sealed for F64x2 {}

impl Lane for F64x2 {
    #[inline(never)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        piece.run()
    }

    const N: usize = 2;
    type Mask = uint64x2_t;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        unsafe { F64x2(vdupq_n_f64(x)) }
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> Self {
        unsafe { F64x2(vld1q_f64(p)) }
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        unsafe { vst1q_f64(p, self.0) }
    }
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4] {
        unsafe {
            let (p, q) = (
                base.add(4 * *index as usize),
                base.add(4 * *index.add(1) as usize),
            );
            let (a, b) = (vld1q_f64(p), vld1q_f64(p.add(2)));
            let (c, d) = (vld1q_f64(q), vld1q_f64(q.add(2)));
            [
                F64x2(vzip1q_f64(a, c)),
                F64x2(vzip2q_f64(a, c)),
                F64x2(vzip1q_f64(b, d)),
                F64x2(vzip2q_f64(b, d)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2] {
        unsafe {
            let a = vld1q_f64(base.add(2 * *index as usize));
            let b = vld1q_f64(base.add(2 * *index.add(1) as usize));
            [F64x2(vzip1q_f64(a, b)), F64x2(vzip2q_f64(a, b))]
        }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> Self {
        unsafe {
            let half = vshrq_n_u64::<1>(vreinterpretq_u64_f64(self.0));
            let magic = vdupq_n_u64(super::ROOT_MAGIC);
            F64x2(vreinterpretq_f64_u64(vsubq_u64(magic, half)))
        }
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> Self {
        unsafe {
            let bits = vreinterpretq_u64_f64(self.0);
            F64x2(vreinterpretq_f64_u64(vshlq_n_u64::<52>(bits)))
        }
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        unsafe {
            let bits = vreinterpretq_u64_f64(self.0);
            let of = |x: u64| vdupq_n_u64(x);
            let mantissa = vorrq_u64(vandq_u64(bits, of(super::MANTISSA)), of(super::ONE));
            let exponent = vorrq_u64(vshrq_n_u64::<52>(bits), of(super::TWO_TO_52));
            [
                F64x2(vreinterpretq_f64_u64(mantissa)),
                F64x2(vreinterpretq_f64_u64(exponent)),
            ]
        }
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        unsafe { F64x2(vfmaq_f64(b.0, self.0, a.0)) }
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        unsafe { F64x2(vdivq_f64(self.0, a.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { F64x2(vsqrtq_f64(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { F64x2(vabsq_f64(self.0)) }
    }
    /// Not `vminq_f64`, which has its own mind about zeros and what is not a number.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }
    #[inline(always)]
    fn round(self) -> Self {
        unsafe { F64x2(vrndnq_f64(self.0)) }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> uint64x2_t {
        unsafe { vcltq_f64(self.0, other.0) }
    }
    #[inline(always)]
    fn ge(self, other: Self) -> uint64x2_t {
        unsafe { vcgeq_f64(self.0, other.0) }
    }
    #[inline(always)]
    fn is_nan(self) -> uint64x2_t {
        unsafe {
            let equal = vreinterpretq_u32_u64(vceqq_f64(self.0, self.0));
            vreinterpretq_u64_u32(vmvnq_u32(equal))
        }
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, part: usize) -> uint64x2_t {
        unsafe {
            let lane = vld1q_u64(LANE_BIT[part].as_ptr());
            vceqzq_u64(vandq_u64(vdupq_n_u64(u64::from(bits)), lane))
        }
    }
    #[inline(always)]
    fn or(a: uint64x2_t, b: uint64x2_t) -> uint64x2_t {
        unsafe { vorrq_u64(a, b) }
    }
    #[inline(always)]
    fn bits(m: uint64x2_t) -> u32 {
        unsafe { (vgetq_lane_u64::<0>(m) as u32 & 1) | (vgetq_lane_u64::<1>(m) as u32 & 2) }
    }
    #[inline(always)]
    fn nan_if(self, m: uint64x2_t) -> Self {
        unsafe {
            let bits = vorrq_u64(vreinterpretq_u64_f64(self.0), m);
            F64x2(vreinterpretq_f64_u64(bits))
        }
    }
    #[inline(always)]
    fn zero_if(self, m: uint64x2_t) -> Self {
        unsafe {
            let bits = vbicq_u64(vreinterpretq_u64_f64(self.0), m);
            F64x2(vreinterpretq_f64_u64(bits))
        }
    }
    #[inline(always)]
    fn select(m: uint64x2_t, a: Self, b: Self) -> Self {
        unsafe { F64x2(vbslq_f64(m, a.0, b.0)) }
    }
}
