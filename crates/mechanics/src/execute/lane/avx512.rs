//! Eight numbers in an AVX-512 register.

use super::{Lane, Piece};
use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x8(__m512d);

// SAFETY, for every block in this file: the instructions exist, because `simd` calls these functions only after
// detecting AVX-512 F and DQ; pointers are as the trait's callers promise.
impl Add for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        unsafe { F64x8(_mm512_add_pd(self.0, o.0)) }
    }
}
impl Sub for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        unsafe { F64x8(_mm512_sub_pd(self.0, o.0)) }
    }
}
impl Mul for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        unsafe { F64x8(_mm512_mul_pd(self.0, o.0)) }
    }
}

/// One register of two halves.
#[inline(always)]
unsafe fn both(low: __m256d, high: __m256d) -> __m512d {
    unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high) }
}

#[inline(always)]
unsafe fn record4(base: *const f64, index: u32) -> __m256d {
    unsafe { _mm256_loadu_pd(base.add(4 * index as usize)) }
}

/// Records of `index[0]` and `index[2]`.
#[inline(always)]
unsafe fn two2(base: *const f64, index: *const u32) -> __m256d {
    unsafe {
        let low = _mm_loadu_pd(base.add(2 * *index as usize));
        let high = _mm_loadu_pd(base.add(2 * *index.add(2) as usize));
        _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(low), high)
    }
}

#[target_feature(enable = "avx512f,avx512dq,avx2,fma")]
#[inline(never)]
fn out_of_line<P: Piece>(piece: P) -> P::Out {
    piece.run()
}

impl super::sealed::Sealed for F64x8 {}

impl Lane for F64x8 {
    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        unsafe { out_of_line(piece) }
    }

    const N: usize = 8;
    type Mask = __mmask8;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        unsafe { F64x8(_mm512_set1_pd(x)) }
    }
    #[inline(always)]
    unsafe fn load(p: *const f64) -> Self {
        unsafe { F64x8(_mm512_loadu_pd(p)) }
    }
    #[inline(always)]
    unsafe fn store(self, p: *mut f64) {
        unsafe { _mm512_storeu_pd(p, self.0) }
    }
    /// Whole-record loads and a transpose: gathers take an instruction's time for each number.
    #[inline(always)]
    unsafe fn gather4(base: *const f64, index: *const u32) -> [Self; 4] {
        unsafe {
            let a = both(record4(base, *index), record4(base, *index.add(4)));
            let b = both(record4(base, *index.add(1)), record4(base, *index.add(5)));
            let c = both(record4(base, *index.add(2)), record4(base, *index.add(6)));
            let d = both(record4(base, *index.add(3)), record4(base, *index.add(7)));
            let (ab02, ab13) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
            let (cd02, cd13) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
            let low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
            let high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
            [
                F64x8(_mm512_permutex2var_pd(ab02, low, cd02)),
                F64x8(_mm512_permutex2var_pd(ab13, low, cd13)),
                F64x8(_mm512_permutex2var_pd(ab02, high, cd02)),
                F64x8(_mm512_permutex2var_pd(ab13, high, cd13)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn gather2(base: *const f64, index: *const u32) -> [Self; 2] {
        unsafe {
            let even = both(two2(base, index), two2(base, index.add(4)));
            let odd = both(two2(base, index.add(1)), two2(base, index.add(5)));
            [
                F64x8(_mm512_unpacklo_pd(even, odd)),
                F64x8(_mm512_unpackhi_pd(even, odd)),
            ]
        }
    }
    #[inline(always)]
    fn inv_sqrt_estimate(self) -> Self {
        unsafe {
            let half = _mm512_srli_epi64::<1>(_mm512_castpd_si512(self.0));
            let magic = _mm512_set1_epi64(super::ROOT_MAGIC as i64);
            F64x8(_mm512_castsi512_pd(_mm512_sub_epi64(magic, half)))
        }
    }
    #[inline(always)]
    fn exponent_from_bits(self) -> Self {
        unsafe {
            F64x8(_mm512_castsi512_pd(_mm512_slli_epi64::<52>(
                _mm512_castpd_si512(self.0),
            )))
        }
    }
    #[inline(always)]
    fn mantissa_and_exponent(self) -> [Self; 2] {
        unsafe {
            let bits = _mm512_castpd_si512(self.0);
            let of = |x: u64| _mm512_set1_epi64(x as i64);
            let mantissa =
                _mm512_or_si512(_mm512_and_si512(bits, of(super::MANTISSA)), of(super::ONE));
            let exponent = _mm512_or_si512(_mm512_srli_epi64::<52>(bits), of(super::TWO_TO_52));
            [
                F64x8(_mm512_castsi512_pd(mantissa)),
                F64x8(_mm512_castsi512_pd(exponent)),
            ]
        }
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        unsafe { F64x8(_mm512_fmadd_pd(self.0, a.0, b.0)) }
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        unsafe { F64x8(_mm512_div_pd(self.0, a.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { F64x8(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        unsafe { F64x8(_mm512_abs_pd(self.0)) }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        unsafe { F64x8(_mm512_min_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        unsafe { F64x8(_mm512_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn round(self) -> Self {
        unsafe {
            F64x8(_mm512_roundscale_pd::<
                { _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC },
            >(self.0))
        }
    }
    #[inline(always)]
    fn lt(self, other: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn ge(self, other: Self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_GE_OQ>(self.0, other.0) }
    }
    #[inline(always)]
    fn is_nan(self) -> __mmask8 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_UNORD_Q>(self.0, self.0) }
    }
    #[inline(always)]
    fn dead_in_part(bits: u8, _part: usize) -> __mmask8 {
        !bits
    }
    #[inline(always)]
    fn or(a: __mmask8, b: __mmask8) -> __mmask8 {
        a | b
    }
    #[inline(always)]
    fn bits(m: __mmask8) -> u32 {
        m as u32
    }
    #[inline(always)]
    fn nan_if(self, m: __mmask8) -> Self {
        unsafe { F64x8(_mm512_mask_mov_pd(self.0, m, _mm512_set1_pd(f64::NAN))) }
    }
    #[inline(always)]
    fn zero_if(self, m: __mmask8) -> Self {
        unsafe { F64x8(_mm512_maskz_mov_pd(!m, self.0)) }
    }
    #[inline(always)]
    fn select(m: __mmask8, a: Self, b: Self) -> Self {
        unsafe { F64x8(_mm512_mask_mov_pd(b.0, m, a.0)) }
    }
}
