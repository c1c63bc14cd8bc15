//! Exponential and logarithm of lanes: the same operations, so the same bits, on every width, and no calls.

use super::Lane;

/// 2⁵³ − 2⁵¹: numbers near it are whole, and their lowest bits are those of what was added.
const WHOLE: f64 = 6_755_399_441_055_744.0;
/// ln 2 in two parts; the first has 32 trailing zeros, so that small whole multiples of it are exact.
const LN2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// `2ⁿ` of a whole n, −1023 < n ≤ 1023.
#[inline(always)]
fn two_to<L: Lane>(n: L) -> L {
    (n + L::splat(WHOLE + 1023.0)).exponent_from_bits()
}

/// `eˣ` within a unit in the last place: `x = n ln 2 + r`, |r| ≤ ½ ln 2, and Taylor's polynomial of degree 13, whose rest is below
/// 2⁻⁵⁷. ∞ and 0 where the result is too large or too small; not a number where x is not.
#[inline(always)]
pub fn exp<L: Lane>(x: L) -> L {
    // beyond these all is said
    let kept = x.max(L::splat(-760.0)).min(L::splat(720.0));
    let n = (kept * L::splat(std::f64::consts::LOG2_E)).round();
    let r = n.fma(L::splat(-LN2[1]), n.fma(L::splat(-LN2[0]), kept));
    let mut p = L::splat(INVERSE_FACTORIAL[11]);
    let mut k = 11;
    while k > 0 {
        k -= 1;
        p = p.fma(r, L::splat(INVERSE_FACTORIAL[k]));
    }
    let whole = (r * r).fma(p, r) + L::splat(1.0);
    // in two halves, each of which is a normal number
    let half = (n * L::splat(0.5)).round();
    (whole * two_to(half) * two_to(n - half)).nan_if(x.is_nan())
}

/// 1/2!, 1/3!, …, 1/13!
const INVERSE_FACTORIAL: [f64; 12] = {
    let mut all = [0.0; 12];
    let (mut k, mut factorial) = (0, 1.0);
    while k < 12 {
        factorial *= (k + 2) as f64;
        all[k] = 1.0 / factorial;
        k += 1;
    }
    all
};

/// Of `(ln(1+f) − 2s)/s`, `s = f/(2+f)`, in s² (fdlibm's `e_log.c`, Sun Microsystems 1993; error below 2⁻⁵⁸).
const LOG: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];

/// `ln x` within a unit in the last place: `x = 2ᵉ (1+f)`, √½ < 1+f ≤ √2. −∞ of 0, not a number below.
#[inline(always)]
pub fn ln<L: Lane>(x: L) -> L {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let small = x.lt(L::splat(f64::MIN_POSITIVE));
    let two_to_54 = L::splat(18_014_398_509_481_984.0);
    let [m, e] = L::select(small, x * two_to_54, x).mantissa_and_exponent();
    let e = e - L::splat(4_503_599_627_370_496.0 + 1023.0);
    let e = e - L::select(small, L::splat(54.0), zero);
    let large = m.ge(L::splat(std::f64::consts::SQRT_2));
    let f = L::select(large, m * L::splat(0.5), m) - one;
    let e = e + L::select(large, one, zero);
    let s = f.div(L::splat(2.0) + f);
    let z = s * s;
    let mut r = L::splat(LOG[6]);
    let mut k = 6;
    while k > 0 {
        k -= 1;
        r = r.fma(z, L::splat(LOG[k]));
    }
    let square = L::splat(0.5) * f * f;
    let rest = e.fma(L::splat(LN2[1]), s * (r.fma(z, square)));
    let found = e.fma(L::splat(LN2[0]), f - (square - rest));
    let infinity = L::splat(f64::INFINITY);
    let found = L::select(x.ge(infinity), infinity, found);
    let found = L::select(x.lt(L::splat(5e-324)), zero - infinity, found);
    found.nan_if(L::or(x.is_nan(), x.lt(zero)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::execute::simd::{Kernel, Simd};

    /// Units in the last place between a value and the exact one.
    fn apart(found: f64, exact: f64) -> f64 {
        if found.to_bits() == exact.to_bits() {
            return 0.0;
        }
        let place = (f64::from_bits(exact.to_bits() + 1) - exact).abs();
        (found - exact).abs() / place
    }

    fn arguments() -> Vec<f64> {
        let mut all = vec![];
        let mut x = 1e-300;
        while x < 1e300 {
            all.push(x);
            x *= 1.0037;
        }
        all
    }

    #[test]
    fn exponentials_are_exact_to_a_unit() {
        let mut worst = 0.0f64;
        for x in arguments().into_iter().filter(|x| *x < 709.0) {
            for x in [x, -x].into_iter().filter(|x| *x > -708.0) {
                worst = worst.max(apart(exp(x), x.exp()));
            }
        }
        assert!(worst <= 1.0, "{worst}");
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(710.0), f64::INFINITY);
        assert_eq!(exp(f64::INFINITY), f64::INFINITY);
        assert_eq!(exp(-1e6), 0.0);
        assert_eq!(exp(f64::NEG_INFINITY), 0.0);
        assert!(exp(f64::NAN).is_nan());
        // below the normal numbers, within their last place
        assert!((exp(-740.0f64) - (-740.0f64).exp()).abs() <= 5e-324);
    }

    #[test]
    fn logarithms_are_exact_to_a_unit() {
        let mut worst = 0.0f64;
        for x in arguments() {
            worst = worst.max(apart(ln(x), x.ln()));
        }
        for n in -1000..1000 {
            let x = 1.0 + 1e-4 * f64::from(n);
            worst = worst.max(apart(ln(x), x.ln()));
        }
        assert!(worst <= 1.0, "{worst}");
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(0.0), f64::NEG_INFINITY);
        assert_eq!(ln(f64::INFINITY), f64::INFINITY);
        assert!(ln(-1.0).is_nan() && ln(f64::NAN).is_nan());
        assert!(apart(ln(1e-310), 1e-310f64.ln()) <= 1.0);
    }

    struct Both(Vec<f64>);

    impl Kernel for Both {
        type Out = Vec<u64>;
        type Home = Self;
        #[inline(always)]
        fn block<L: Lane>(&self, _: usize) -> Vec<u64> {
            let mut bits = vec![];
            for x in self.0.chunks_exact(super::super::TILE) {
                for n in 0..super::super::TILE / L::N {
                    // SAFETY: chunks are whole tiles
                    let x = unsafe { L::load(x.as_ptr().add(n * L::N)) };
                    for y in [exp(x), ln(x)] {
                        // which of the many that are no numbers, nobody says
                        let same = |y: &f64| if y.is_nan() { f64::NAN } else { *y };
                        bits.extend(y.to_array()[..L::N].iter().map(|y| same(y).to_bits()));
                    }
                }
            }
            bits
        }
    }

    #[test]
    fn all_widths_give_the_same_bits() {
        let mut x: Vec<f64> = arguments().into_iter().flat_map(|x| [x, -x]).collect();
        x.extend([f64::NAN, f64::INFINITY, 0.0, 1e-320]);
        x.truncate(x.len() / 8 * 8);
        let kernel = Both(x);
        let all = Simd::each(&kernel);
        assert!(all.windows(2).all(|w| w[0] == w[1]));
    }
}
