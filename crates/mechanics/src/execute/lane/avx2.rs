//! Four numbers in an AVX2 register.

use super::{Lane, Piece};
use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x4(__m256d);

/// The bit of each lane, for the two parts of a tile.
static LANE_BIT: [[u64; 4]; 2] = [[1, 2, 4, 8], [16, 32, 64, 128]];

// SAFETY, for every block in this file: the instructions exist, because `simd` calls these functions only after
// detecting AVX2 and FMA; pointers are as the trait's callers promise.
impl Add for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        unsafe { F64x4(_mm256_add_pd(self.0, o.0)) }
    }
}
impl Sub for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        unsafe { F64x4(_mm256_sub_pd(self.0, o.0)) }
    }
}
impl Mul for F64x4 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        unsafe { F64x4(_mm256_mul_pd(self.0, o.0)) }
    }
}

#[target_feature(enable = "avx2,fma")]
#[inline(never)]
fn out_of_line<P: Piece>(piece: P) -> P::Out {
    piece.run()
}

impl super::sealed::Sealed for F64x4 {}

impl Lane for F64x4 {
    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        unsafe { out_of_line(piece) }
    }

    const N: usize = 4;
    type Mask = __m256d;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        unsafe { F64x4(_mm256_set1_pd(x)) }
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> Self {
        unsafe { F64x4(_mm256_loadu_pd(p)) }
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        unsafe { _mm256_storeu_pd(p, self.0) }
    }
    /// Four whole-record loads and a transpose: AVX2 gathers are slower.
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4] {
        unsafe {
            let a = _mm256_loadu_pd(base.add(4 * *index as usize));
            let b = _mm256_loadu_pd(base.add(4 * *index.add(1) as usize));
            let c = _mm256_loadu_pd(base.add(4 * *index.add(2) as usize));
            let d = _mm256_loadu_pd(base.add(4 * *index.add(3) as usize));
            let (ab0, ab1) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (cd0, cd1) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            [
                F64x4(_mm256_permute2f128_pd::<0x20>(ab0, cd0)),
                F64x4(_mm256_permute2f128_pd::<0x20>(ab1, cd1)),
                F64x4(_mm256_permute2f128_pd::<0x31>(ab0, cd0)),
                F64x4(_mm256_permute2f128_pd::<0x31>(ab1, cd1)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2] {
        unsafe {
            let a = _mm_loadu_pd(base.add(2 * *index as usize));
            let b = _mm_loadu_pd(base.add(2 * *index.add(1) as usize));
            let c = _mm_loadu_pd(base.add(2 * *index.add(2) as usize));
            let d = _mm_loadu_pd(base.add(2 * *index.add(3) as usize));
            let ac = _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(a), c);
            let bd = _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(b), d);
            [
                F64x4(_mm256_unpacklo_pd(ac, bd)),
                F64x4(_mm256_unpackhi_pd(ac, bd)),
            ]
        }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> Self {
        unsafe {
            let half = _mm256_srli_epi64::<1>(_mm256_castpd_si256(self.0));
            let magic = _mm256_set1_epi64x(super::ROOT_MAGIC as i64);
            F64x4(_mm256_castsi256_pd(_mm256_sub_epi64(magic, half)))
        }
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> Self {
        unsafe {
            F64x4(_mm256_castsi256_pd(_mm256_slli_epi64::<52>(
                _mm256_castpd_si256(self.0),
            )))
        }
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        unsafe {
            let bits = _mm256_castpd_si256(self.0);
            let of = |x: u64| _mm256_set1_epi64x(x as i64);
            let mantissa =
                _mm256_or_si256(_mm256_and_si256(bits, of(super::MANTISSA)), of(super::ONE));
            let exponent = _mm256_or_si256(_mm256_srli_epi64::<52>(bits), of(super::TWO_TO_52));
            [
                F64x4(_mm256_castsi256_pd(mantissa)),
                F64x4(_mm256_castsi256_pd(exponent)),
            ]
        }
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        unsafe { F64x4(_mm256_fmadd_pd(self.0, a.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        unsafe { F64x4(_mm256_div_pd(self.0, a.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { F64x4(_mm256_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { F64x4(_mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        unsafe { F64x4(_mm256_min_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        unsafe { F64x4(_mm256_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn round(self) -> Self {
        unsafe {
            F64x4(_mm256_round_pd::<
                { _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC },
            >(self.0))
        }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> __m256d {
        unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn ge(self, other: Self) -> __m256d {
        unsafe { _mm256_cmp_pd::<_CMP_GE_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn is_nan(self) -> __m256d {
        unsafe { _mm256_cmp_pd::<_CMP_UNORD_Q>(self.0, self.0) }
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, part: usize) -> __m256d {
        unsafe {
            let lane = _mm256_loadu_si256(LANE_BIT[part].as_ptr().cast());
            let set = _mm256_and_si256(_mm256_set1_epi8(bits as i8), lane);
            _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, _mm256_setzero_si256()))
        }
    }
    #[inline(always)]
    fn or(a: __m256d, b: __m256d) -> __m256d {
        unsafe { _mm256_or_pd(a, b) }
    }
    #[inline(always)]
    fn bits(m: __m256d) -> u32 {
        unsafe { _mm256_movemask_pd(m) as u32 }
    }
    #[inline(always)]
    fn nan_if(self, m: __m256d) -> Self {
        unsafe { F64x4(_mm256_or_pd(self.0, m)) }
    }
    #[inline(always)]
    fn zero_if(self, m: __m256d) -> Self {
        unsafe { F64x4(_mm256_andnot_pd(m, self.0)) }
    }
    #[inline(always)]
    fn select(m: __m256d, a: Self, b: Self) -> Self {
        unsafe { F64x4(_mm256_blendv_pd(b.0, a.0, m)) }
    }
}
