//! Numbers with derivatives by several variables: of first order over lanes, for forces; of second order, for tangents.

use super::number::{Number, Over, each};
use super::spline::{Spline, Twin};
use crate::execute::lane::{Lane, elementary};
use crate::law::jet::Jet;
use std::ops::{Add, Mul, Sub};

/// A value and its slopes by `C` variables.
#[derive(Clone, Copy)]
pub struct Slopes<L, const C: usize> {
    pub value: L,
    pub slope: [L; C],
}

impl<L: Lane, const C: usize> Slopes<L, C> {
    /// Variable number `n`.
    #[inline(always)]
    pub fn variable(value: L, n: usize) -> Self {
        Self::along(value, L::splat(1.0), n)
    }

    /// What depends on variable number `n` alone.
    #[inline(always)]
    pub fn along(value: L, slope: L, n: usize) -> Self {
        let mut all = [L::splat(0.0); C];
        all[n] = slope;
        Slopes { value, slope: all }
    }

    /// A function's value and derivative at the value, by the chain rule.
    #[inline(always)]
    fn chain(self, value: L, derivative: L) -> Self {
        let mut slope = self.slope;
        for s in &mut slope {
            *s = derivative * *s;
        }
        Slopes { value, slope }
    }
}

impl<L: Lane, const C: usize> Add for Slopes<L, C> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        let mut slope = self.slope;
        for (s, o) in slope.iter_mut().zip(o.slope) {
            *s = *s + o;
        }
        Slopes {
            value: self.value + o.value,
            slope,
        }
    }
}

impl<L: Lane, const C: usize> Sub for Slopes<L, C> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        let mut slope = self.slope;
        for (s, o) in slope.iter_mut().zip(o.slope) {
            *s = *s - o;
        }
        Slopes {
            value: self.value - o.value,
            slope,
        }
    }
}

impl<L: Lane, const C: usize> Mul for Slopes<L, C> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let mut slope = self.slope;
        for (s, by) in slope.iter_mut().zip(o.slope) {
            *s = self.value.fma(by, *s * o.value);
        }
        Slopes {
            value: self.value * o.value,
            slope,
        }
    }
}

impl<L: Lane, const C: usize> Over<L> for Slopes<L, C> {
    #[inline(always)]
    fn lane(x: L) -> Self {
        Slopes {
            value: x,
            slope: [L::splat(0.0); C],
        }
    }
}

impl<L: Lane, const C: usize> Number for Slopes<L, C> {
    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self::lane(L::splat(x))
    }
    #[inline(always)]
    fn times(self, x: f64) -> Self {
        let x = L::splat(x);
        self.chain(self.value * x, x)
    }
    #[inline(always)]
    fn plus(self, x: f64) -> Self {
        Slopes {
            value: self.value + L::splat(x),
            slope: self.slope,
        }
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let r = L::splat(1.0).div(self.value);
        self.chain(r, L::splat(0.0) - r * r)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let r = Lane::sqrt(self.value);
        self.chain(r, L::splat(0.5).div(r))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = elementary::exp(self.value);
        self.chain(e, e)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(elementary::ln(self.value), L::splat(1.0).div(self.value))
    }
    #[inline(always)]
    fn table(self, table: &Spline) -> Self {
        let [value, derivative] = table.lanes(self.value);
        self.chain(value, derivative)
    }
    #[inline(always)]
    fn twin(self, twin: &Twin) -> [Self; 2] {
        let [[a, da], [b, db]] = twin.lanes(self.value);
        [self.chain(a, da), self.chain(b, db)]
    }
    #[inline(always)]
    fn of_twin(self, twin: &Twin, n: usize) -> Self {
        let [value, derivative] = twin.lanes_of(n, self.value);
        self.chain(value, derivative)
    }
    #[inline(always)]
    fn ln_1p(self) -> Self {
        let slope = L::splat(1.0).div(L::splat(1.0) + self.value);
        self.chain(each(self.value, f64::ln_1p), slope)
    }
    #[inline(always)]
    fn exp_m1(self) -> Self {
        let e = each(self.value, f64::exp_m1);
        self.chain(e, e + L::splat(1.0))
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        let mut slope = b.slope;
        for (n, s) in slope.iter_mut().enumerate() {
            *s = Lane::fma(
                self.value,
                a.slope[n],
                Lane::fma(self.slope[n], a.value, *s),
            );
        }
        Slopes {
            value: Lane::fma(self.value, a.value, b.value),
            slope,
        }
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        let r = L::splat(1.0).div(a.value);
        let value = self.value * r;
        let mut slope = self.slope;
        for (s, by) in slope.iter_mut().zip(a.slope) {
            *s = (*s - value * by) * r;
        }
        Slopes { value, slope }
    }
    #[inline(always)]
    fn any_below(self, limit: f64) -> bool {
        self.value.any_below(limit)
    }
    #[inline(always)]
    fn choose(self, limit: Self, a: Self, b: Self) -> Self {
        let m = self.value.lt(limit.value);
        let mut slope = a.slope;
        for (s, b) in slope.iter_mut().zip(b.slope) {
            *s = L::select(m, *s, b);
        }
        Slopes {
            value: L::select(m, a.value, b.value),
            slope,
        }
    }
}

/// A value with its first and second derivatives by `C` variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curved<const C: usize> {
    pub value: f64,
    pub slope: [f64; C],
    pub curvature: [[f64; C]; C],
}

impl<const C: usize> Curved<C> {
    /// Variable number `n`.
    pub fn variable(value: f64, n: usize) -> Self {
        let mut all = Self::constant(value);
        all.slope[n] = 1.0;
        all
    }

    /// A function of one number, by its value and derivatives there.
    fn chain(self, [value, first, second]: [f64; 3]) -> Self {
        let s = self.slope;
        Curved {
            value,
            slope: s.map(|s| first * s),
            curvature: crate::array::from_fn(|m| {
                crate::array::from_fn(|n| first * self.curvature[m][n] + second * s[m] * s[n])
            }),
        }
    }

    fn of_jet(self, f: impl Fn(Jet<3>) -> Jet<3>) -> Self {
        self.chain(f(Jet::variable(self.value)).derivatives())
    }
}

impl<const C: usize> Add for Curved<C> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Curved {
            value: self.value + o.value,
            slope: crate::array::from_fn(|n| self.slope[n] + o.slope[n]),
            curvature: crate::array::from_fn(|m| {
                crate::array::from_fn(|n| self.curvature[m][n] + o.curvature[m][n])
            }),
        }
    }
}

impl<const C: usize> Sub for Curved<C> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + o.times(-1.0)
    }
}

impl<const C: usize> Mul for Curved<C> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self.slope, o.slope);
        Curved {
            value: self.value * o.value,
            slope: crate::array::from_fn(|n| self.value.mul_add(b[n], a[n] * o.value)),
            curvature: crate::array::from_fn(|m| {
                crate::array::from_fn(|n| {
                    let own = self.curvature[m][n].mul_add(o.value, self.value * o.curvature[m][n]);
                    a[m].mul_add(b[n], a[n].mul_add(b[m], own))
                })
            }),
        }
    }
}

impl<const C: usize> Over<f64> for Curved<C> {
    fn lane(x: f64) -> Self {
        Self::constant(x)
    }
}

impl<const C: usize> Number for Curved<C> {
    fn constant(value: f64) -> Self {
        Curved {
            value,
            slope: [0.0; C],
            curvature: [[0.0; C]; C],
        }
    }
    fn times(self, x: f64) -> Self {
        self.chain([self.value * x, x, 0.0])
    }
    fn recip(self) -> Self {
        let r = 1.0 / self.value;
        self.chain([r, -r * r, 2.0 * r * r * r])
    }
    fn sqrt(self) -> Self {
        let r = self.value.sqrt();
        self.chain([r, 0.5 / r, -0.25 / (r * self.value)])
    }
    fn exp(self) -> Self {
        self.chain([elementary::exp(self.value); 3])
    }
    fn ln(self) -> Self {
        let r = 1.0 / self.value;
        self.chain([elementary::ln(self.value), r, -r * r])
    }
    fn table(self, table: &Spline) -> Self {
        self.of_jet(|x| x.table(table))
    }
    fn twin(self, twin: &Twin) -> [Self; 2] {
        [0, 1].map(|n| self.of_twin(twin, n))
    }
    fn of_twin(self, twin: &Twin, n: usize) -> Self {
        self.of_jet(|x| x.of_twin(twin, n))
    }
    fn ln_1p(self) -> Self {
        self.of_jet(Jet::ln_1p)
    }
    fn exp_m1(self) -> Self {
        self.of_jet(Jet::exp_m1)
    }
    fn fma(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn div(self, a: Self) -> Self {
        self * a.recip()
    }
    fn any_below(self, limit: f64) -> bool {
        self.value < limit
    }
    fn choose(self, limit: Self, a: Self, b: Self) -> Self {
        if self.value < limit.value { a } else { b }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything that a law may do.
    fn mixed<N: Number>(x: N, y: N) -> N {
        let a = (x * y).sqrt().exp() - y.ln().times(0.3);
        let b = x.recip().fma(y, a).plus(2.0).div(x + y);
        b.ln_1p() + y.times(0.1).exp_m1() + x.power(3).below(100.0, a * b, x)
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let (x, y) = (1.3, 0.7);
        let first = mixed(Slopes::<f64, 2>::variable(x, 0), Slopes::variable(y, 1));
        let both = mixed(Curved::<2>::variable(x, 0), Curved::variable(y, 1));
        let slope =
            |x: f64, y: f64| mixed(Slopes::<f64, 2>::variable(x, 0), Slopes::variable(y, 1)).slope;
        assert!((both.value - mixed(x, y)).abs() < 1e-14);
        for n in 0..2 {
            assert!((both.slope[n] - first.slope[n]).abs() < 1e-13);
            let at = |h: f64| match n {
                0 => slope(x + h, y),
                _ => slope(x, y + h),
            };
            let (near, far) = ([at(1e-3), at(-1e-3)], [at(2e-3), at(-2e-3)]);
            for m in 0..2 {
                let difference =
                    (8.0 * (near[0][m] - near[1][m]) - (far[0][m] - far[1][m])) / 12e-3;
                assert!((both.curvature[m][n] - difference).abs() < 1e-9);
            }
            let at = |h: f64| match n {
                0 => mixed(x + h, y),
                _ => mixed(x, y + h),
            };
            let difference = (8.0 * (at(1e-3) - at(-1e-3)) - (at(2e-3) - at(-2e-3))) / 12e-3;
            assert!((both.slope[n] - difference).abs() < 1e-9);
        }
    }
}
