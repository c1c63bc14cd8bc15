//! The two functions of a bond's relative square stretch `e = |ξ+η|²/|ξ|² − 1` that all forces are made of, without
//! division or root where `e` is small.
//!
//! `f(e)/e` is a sum of parts, `a(e) + e⁴ b(e) + e⁶ c(e)`. A part is added last, in one rounding, and where it is smaller than
//! half the last place of what it is added to it changes nothing: with it or without it, the bits are the same. So bonds that
//! are evaluated together take as many parts as the largest `e` of them asks for, and the answer of each depends on its own
//! `e` alone (docs/decisions/0004-own-answers.md).

use super::{Lane, Piece, TILE};
use std::hint::black_box;
use std::marker::PhantomData;

/// Terms of each part, and the first of each.
const PARTS: [usize; 3] = [4, 2, 4];
const FIRST: [usize; 3] = [0, PARTS[0], PARTS[0] + PARTS[1]];
const ROWS: usize = FIRST[2] + PARTS[2];
/// Up to this |e| the second part changes no bit, and the third none up to the next: both are below 2⁻⁵⁵, half the last place
/// of any number from ¼ to 1.
const NEAR: f64 = 1e-4;
const MIDDLE: f64 = 2.2e-3;
/// Up to this |e| three parts are exact to rounding; beyond, the root.
const WIDE: f64 = 1.0 / 32.0;

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

/// A function of `e` by a series and a root.
pub trait Function: Copy {
    /// Coefficients of `f(e)/e`, lowest first: Taylor's, but for those of the last part, which are interpolated at the
    /// Chebyshev nodes of its interval.
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
    /// Relative error 3.8e-17 beside that of rounding.
    #[rustfmt::skip]
    const COEFFICIENTS: [f64; ROWS] = [
        0.5, -3.0 / 8.0, 5.0 / 16.0, -35.0 / 128.0,
        63.0 / 256.0, -231.0 / 1024.0,
        0.20947263618236012, -0.19638059600277924, 0.1856349566685266, -0.17635457940273352,
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
    /// Relative error 1.8e-18 beside that of rounding.
    #[rustfmt::skip]
    const COEFFICIENTS: [f64; ROWS] = [
        0.5, -1.0 / 8.0, 1.0 / 16.0, -5.0 / 128.0,
        7.0 / 256.0, -21.0 / 1024.0,
        0.016113280294535754, -0.013092040179580882, 0.010917860603200625, -0.009280377265793081,
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

    /// `f(e)` of each `e`, none of which is larger than `largest`, to `sink` in order; not a number where `e` is not. False, and nothing
    /// is done: some are too large for the short sums, take [`Series::far`]. The bits of one do not depend on what it is
    /// evaluated with.
    #[inline(always)]
    pub fn near<L: Lane>(self, e: &[L], largest: L, sink: &mut impl Sink<L>) -> bool {
        if !L::any(L::splat(NEAR).lt(largest)) {
            self.short::<L, 1>(e, sink);
        } else if !L::any(L::splat(MIDDLE).lt(largest)) {
            self.short::<L, 2>(e, sink);
        } else {
            return false;
        }
        true
    }

    #[inline(always)]
    fn short<L: Lane, const COUNT: usize>(self, e: &[L], sink: &mut impl Sink<L>) {
        for (n, x) in e.iter().enumerate() {
            sink.put(n, self.sum::<L, COUNT, false>(*x));
        }
    }

    /// The same in the place of `e`, whatever they are.
    #[inline(always)]
    pub fn far<L: Lane>(self, e: &mut [L], largest: L) {
        let series = self;
        L::out_of_line(Far { series, e, largest });
    }

    /// `f(e)` of one.
    #[inline(always)]
    pub fn at<L: Lane>(self, e: L) -> L {
        let (mut near, mut far) = ([e], [e]);
        if self.near(&[e], e.abs(), &mut near) {
            near[0]
        } else {
            self.far(&mut far, e.abs());
            far[0]
        }
    }

    /// So many parts of the series, and with `ROOT` the root where `e` asks for it.
    #[inline(always)]
    fn sum<L: Lane, const COUNT: usize, const ROOT: bool>(self, e: L) -> L {
        let mut p = self.part(e, 0);
        if COUNT > 1 {
            let e2 = e * e;
            let e4 = e2 * e2;
            p = e4.fma(self.part(e, 1), p);
            if COUNT > 2 {
                p = (e4 * e2).fma(self.part(e, 2), p);
            }
        }
        let mut f = p * e;
        if ROOT {
            // both for all: to ask bond by bond costs more than it saves
            let far = L::splat(WIDE).lt(e.abs());
            f = L::select(far, F::exact(e), f);
        }
        f
    }

    /// Horner's scheme: the sweeps are bound by the number of operations, not by their depth.
    #[inline(always)]
    fn part<L: Lane>(self, x: L, part: usize) -> L {
        // SAFETY: rows of a static table, each as wide as the widest lane
        unsafe {
            let row = |k: usize| self.0.add((FIRST[part] + k) * TILE);
            let mut k = PARTS[part] - 1;
            let mut p = L::load(row(k));
            while k > 0 {
                k -= 1;
                p = p.fma(x, L::load(row(k)));
            }
            p
        }
    }
}

/// The longer sums, of bonds far from rest: a call is small beside them.
struct Far<'a, L: Lane, F> {
    series: Series<F>,
    e: &'a mut [L],
    largest: L,
}

impl<L: Lane, F: Function> Far<'_, L, F> {
    #[inline(always)]
    fn long<const ROOT: bool>(self) {
        for e in self.e {
            *e = self.series.sum::<L, 3, ROOT>(*e);
        }
    }
}

impl<L: Lane, F: Function> Piece for Far<'_, L, F> {
    type Out = ();
    #[inline(always)]
    fn run(self) {
        if L::any(L::splat(WIDE).lt(self.largest)) {
            self.long::<true>();
        } else {
            self.long::<false>();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn each<F: Function, const N: usize>(
        series: Series<F>,
        mut e: [f64; N],
        largest: f64,
    ) -> [f64; N] {
        let mut all = e;
        if series.near(&e, largest, &mut all) {
            return all;
        }
        series.far(&mut e, largest);
        e
    }

    fn check<F: Function>() {
        let series = Series::<F>::new();
        let mut e = 1e-12;
        while e < 3.0 {
            for e in [e, -e] {
                if e <= -1.0 {
                    continue;
                }
                let [found] = each(series, [e], e.abs());
                let exact = F::exact(e);
                assert!((found - exact).abs() <= 5e-16 * exact.abs(), "at {e}");
                assert_eq!(series.at(e).to_bits(), found.to_bits(), "at {e}");
            }
            e *= 1.037;
        }
        let none = each(series, [0.0, f64::NAN], 0.0);
        assert_eq!(none[0], 0.0);
        assert!(none[1].is_nan());
    }

    /// Alone, and beside ever larger ones.
    fn check_company<F: Function>() {
        let series = Series::<F>::new();
        let mut e = 1e-12;
        while e < 0.9 {
            for e in [e, -e] {
                let bits = |company: f64| {
                    // what is not a number is not the largest
                    let largest = e.abs().max(company.abs());
                    each(series, [e, company], largest)[0].to_bits()
                };
                let alone = bits(e);
                for company in [1e-30, 5e-5, 1e-3, 0.02, 0.5, -0.5, f64::NAN] {
                    assert_eq!(bits(company), alone, "{e} beside {company}");
                }
            }
            e *= 1.0007;
        }
    }

    /// What a part adds below its interval is less than half a last place, whatever the rounding of its own sum.
    fn check_parts<F: Function>() {
        let c = F::COEFFICIENTS;
        for (first, end, limit) in [(4, 6, NEAR), (6, 10, MIDDLE)] {
            let most: f64 = (first..end)
                .map(|k| c[k].abs() * limit.powi(k as i32))
                .sum();
            assert!(most < 0.999 * 2f64.powi(-55), "{most:e}");
        }
    }

    #[test]
    fn series_and_root_agree_with_the_closed_form() {
        check::<Extension>();
        check::<Stretch>();
    }

    #[test]
    fn the_answer_of_a_bond_is_its_own() {
        check_company::<Extension>();
        check_company::<Stretch>();
        check_parts::<Extension>();
        check_parts::<Stretch>();
    }
}
