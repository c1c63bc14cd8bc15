//! The two functions of a bond's relative square stretch `e = |ξ+η|²/|ξ|² − 1` that all forces are made of, without
//! division or root where `e` is small.

use super::{Lane, TILE};
use std::hint::black_box;
use std::marker::PhantomData;

/// Terms of the three series, and the |e| up to which each is exact to rounding.
const NEAR: (usize, f64) = (3, 1.0 / 131_072.0);
const MIDDLE: (usize, f64) = (5, 1.0 / 1024.0);
const WIDE: (usize, f64) = (9, 1.0 / 32.0);
const ROWS: usize = NEAR.0 + MIDDLE.0 + WIDE.0;

/// Where values go: a trait and not a closure, so that it is compiled with its caller's instruction set.
/// Implement `put` with `#[inline(always)]`.
pub trait Sink<L> {
    /// Value number `k`.
    fn put(&mut self, k: usize, value: L);
}

impl<L, const N: usize> Sink<L> for [L; N] {
    #[inline(always)]
    fn put(&mut self, k: usize, value: L) {
        self[k] = value;
    }
}

/// A function of `e` by three series and a root.
pub trait Function: Copy {
    /// Coefficients of `f(e)/e`, lowest first, interpolated at the Chebyshev nodes of each interval.
    const COEFFICIENTS: [f64; ROWS];
    const TABLE: &'static Table;
    /// For any e > −1, without cancellation.
    fn exact<L: Lane>(e: L) -> L;
}

/// `1 − (1+e)^(−½) = (r − r0)/r`: extension over current length.
#[derive(Clone, Copy)]
pub struct Extension;

/// `(1+e)^½ − 1 = (r − r0)/r0`.
#[derive(Clone, Copy)]
pub struct Stretch;

impl Function for Extension {
    /// Relative errors 6.1e-17, 2.5e-17, 4.1e-17.
    #[rustfmt::skip]
    const COEFFICIENTS: [f64; ROWS] = [
        0.5, -0.3750000000119371, 0.3125000000107434,
        0.5, -0.3749999999999359, 0.31249999999994044, -0.2734377689196167, 0.24609399971107618,
        0.5, -0.37499999999999434, 0.3124999999999946, -0.2734375000770698, 0.24609375007356768, -0.22558565344138345,
        0.20947238509963742, -0.1967682863372609, 0.18584063437886522,
    ];
    const TABLE: &'static Table = {
        static TABLE: Table = table(Extension::COEFFICIENTS);
        &TABLE
    };
    #[inline(always)]
    fn exact<L: Lane>(e: L) -> L {
        let one = L::splat(1.0);
        let w = (one + e).sqrt();
        e.div(w * (one + w))
    }
}

impl Function for Stretch {
    /// Relative errors 8.7e-18, 2.3e-18, 2.4e-18.
    #[rustfmt::skip]
    const COEFFICIENTS: [f64; ROWS] = [
        0.5, -0.1250000000017053, 0.06250000000119371,
        0.5, -0.12499999999999417, 0.06249999999999542, -0.03906252444723247, 0.027343769208540505,
        0.5, -0.12499999999999971, 0.06249999999999974, -0.03906250000405494, 0.027343750003502126,
        -0.020507797554129306, 0.016113268341746034, -0.01311244000002537, 0.010927651958395687,
    ];
    const TABLE: &'static Table = {
        static TABLE: Table = table(Stretch::COEFFICIENTS);
        &TABLE
    };
    #[inline(always)]
    fn exact<L: Lane>(e: L) -> L {
        let one = L::splat(1.0);
        e.div(one + (one + e).sqrt())
    }
}

/// Coefficients, each repeated over a register.
#[repr(align(64))]
pub struct Table([[f64; TILE]; ROWS]);

const fn table(c: [f64; ROWS]) -> Table {
    let mut t = [[0.0; TILE]; ROWS];
    let mut k = 0;
    while k < ROWS {
        t[k] = [c[k]; TILE];
        k += 1;
    }
    Table(t)
}

/// A function ready for a hot loop: its coefficients are operands in memory, which a compiler that saw their values
/// would turn into one more instruction each.
#[derive(Clone, Copy)]
pub struct Series<F>(*const f64, PhantomData<F>);

impl<F: Function> Series<F> {
    #[allow(clippy::new_without_default)]
    #[inline(always)]
    pub fn new() -> Self {
        Series(black_box(F::TABLE.0.as_ptr().cast()), PhantomData)
    }

    /// `f(e)` of each `e`, none of which lies outside `least..most`, to `sink` in order; not a number where `e` is not.
    ///
    /// All take the same series, the shortest that is exact for the largest: the result of one depends, within
    /// rounding, on what it is evaluated with.
    #[inline(always)]
    pub fn each<L: Lane>(self, e: &[L], least: L, most: L, sink: &mut impl Sink<L>) {
        let largest = (L::splat(0.0) - least).max(most);
        if !L::any(L::splat(NEAR.1).lt(largest)) {
            self.terms::<L, { NEAR.0 }>(0, e, sink);
        } else if !L::any(L::splat(MIDDLE.1).lt(largest)) {
            self.terms::<L, { MIDDLE.0 }>(NEAR.0, e, sink);
        } else if !L::any(L::splat(WIDE.1).lt(largest)) {
            self.terms::<L, { WIDE.0 }>(NEAR.0 + MIDDLE.0, e, sink);
        } else {
            for (k, x) in e.iter().enumerate() {
                sink.put(k, F::exact(*x));
            }
        }
    }

    /// Horner's scheme: the sweeps are bound by the number of operations, not by their depth.
    #[inline(always)]
    fn terms<L: Lane, const T: usize>(self, first: usize, e: &[L], sink: &mut impl Sink<L>) {
        // SAFETY: rows of a static table, each as wide as the widest lane
        let row = |k: usize| unsafe { self.0.add((first + k) * TILE) };
        for (n, x) in e.iter().enumerate() {
            // SAFETY: as above
            unsafe {
                let mut p = L::load(row(T - 1));
                let mut k = T - 1;
                while k > 0 {
                    k -= 1;
                    p = p.fma(*x, L::load(row(k)));
                }
                sink.put(n, p * *x);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<F: Function>() {
        let series = Series::<F>::new();
        let mut e = 1e-12;
        while e < 3.0 {
            for e in [e, -e] {
                if e <= -1.0 {
                    continue;
                }
                let mut all = [0.0];
                series.each(&[e], e.min(0.0), e.max(0.0), &mut all);
                let exact = F::exact(e);
                assert!((all[0] - exact).abs() <= 5e-16 * exact.abs(), "at {e}");
            }
            e *= 1.037;
        }
        let mut none = [1.0; 2];
        series.each(&[0.0, f64::NAN], 0.0, 0.0, &mut none);
        assert_eq!(none[0], 0.0);
        assert!(none[1].is_nan());
    }

    #[test]
    fn series_and_root_agree_with_the_closed_form() {
        check::<Extension>();
        check::<Stretch>();
    }
}
