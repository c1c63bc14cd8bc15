//! The two functions of a bond's relative square stretch `e = |ξ+η|²/|ξ|² − 1` that all forces are made of, without
//! division or root where `e` is small.

use super::{Lane, TILE};
use std::hint::black_box;

/// Below this |e| six terms are exact to rounding.
pub const LIMIT: f64 = 1.0 / 256.0;

/// Coefficients and the limit, each repeated over a register.
#[repr(align(64))]
struct Table([[f64; TILE]; 7]);

const fn table(c: [f64; 6]) -> Table {
    let mut t = [[LIMIT; TILE]; 7];
    let mut k = 0;
    while k < 6 {
        t[k] = [c[k]; TILE];
        k += 1;
    }
    Table(t)
}

/// `(1 − (1+e)^(−½))/e`: interpolated at the six Chebyshev nodes of |e| ≤ 2⁻⁸; relative error 9.3e-17.
static EXTENSION: Table = table([
    0.5,
    -0.375,
    0.3124999999725654,
    -0.2734374999742801,
    0.24609854452148686,
    -0.22559043236480483,
]);

/// `((1+e)^½ − 1)/e`, likewise; relative error 7.2e-18.
static STRETCH: Table = table([
    0.5,
    -0.125,
    0.06249999999788965,
    -0.039062499998285344,
    0.027344118808026167,
    -0.02050811215668201,
]);

/// A series ready for a hot loop: its coefficients are operands in memory, which a compiler that saw their values
/// would turn into one more instruction each.
#[derive(Clone, Copy)]
pub struct Series(*const f64);

impl Series {
    /// `1 − (1+e)^(−½) = (r − r0)/r`: extension over current length.
    #[inline(always)]
    pub fn extension_over_length() -> Series {
        Series(black_box(EXTENSION.0.as_ptr().cast()))
    }

    /// `(1+e)^½ − 1 = (r − r0)/r0`: the stretch.
    #[inline(always)]
    pub fn stretch() -> Series {
        Series(black_box(STRETCH.0.as_ptr().cast()))
    }

    #[inline(always)]
    fn row<L: Lane>(self, k: usize) -> L {
        // SAFETY: k ≤ 6 rows of a static table, each as wide as the widest lane
        unsafe { L::load(self.0.add(k * TILE)) }
    }

    /// Lanes where only the root is exact.
    #[inline(always)]
    pub fn beyond<L: Lane>(self, e: L) -> L::Mask {
        e.abs().ge(self.row(6))
    }

    /// The series, by Horner's scheme (the sweeps are bound by the number of operations, not by their depth);
    /// meaningless [beyond](Series::beyond).
    #[inline(always)]
    pub fn at<L: Lane>(self, e: L) -> L {
        let mut p = self.row::<L>(5);
        for k in [4, 3, 2, 1, 0] {
            p = p.fma(e, self.row(k));
        }
        p * e
    }
}

/// `1 − (1+e)^(−½)` for any e > −1: series where it is exact, `e/(w(1+w))` with `w = √(1+e)` beyond. The choice is made
/// lane by lane, so that the width does not show.
#[inline(always)]
pub fn extension_over_length<L: Lane>(e: L) -> L {
    let series = Series::extension_over_length();
    let (near, far) = (series.at(e), series.beyond(e));
    let one = L::splat(1.0);
    let w = (one + e).sqrt();
    L::select(far, e.div(w * (one + w)), near)
}

/// `(1+e)^½ − 1` for any e ≥ −1.
#[inline(always)]
pub fn stretch<L: Lane>(e: L) -> L {
    let series = Series::stretch();
    let (near, far) = (series.at(e), series.beyond(e));
    let one = L::splat(1.0);
    L::select(far, e.div(one + (one + e).sqrt()), near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_root_agree_with_the_closed_form() {
        let mut e = 1e-12;
        while e < 3.0 {
            for e in [e, -e] {
                if e <= -1.0 {
                    continue;
                }
                // without cancellation
                let w = (1.0f64 + e).sqrt();
                let g = e / (w * (1.0 + w));
                let s = e / (1.0 + w);
                assert!(
                    (extension_over_length(e) - g).abs() <= 1e-15 * g.abs(),
                    "g at {e}"
                );
                assert!((stretch(e) - s).abs() <= 1e-15 * s.abs(), "s at {e}");
            }
            e *= 1.037;
        }
        assert_eq!(extension_over_length(0.0), 0.0);
        assert_eq!(stretch(0.0), 0.0);
    }
}
