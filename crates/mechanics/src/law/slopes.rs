//! Numbers with derivatives by several variables: of first order over lanes, for forces; of second order, for tangents.

use super::number::{Dual, Number, Over};
use super::spline::{Spline, Twin};
use crate::execute::lane::{Lane, elementary};
use crate::law::jet::Jet;
use std::ops::{Add, Mul, Sub};

/// A value and its slopes by `C` variables.
pub type Slopes<L, const C: usize> = Dual<L, [L; C]>;

impl<L: Lane, const C: usize> Slopes<L, C> {
    /// Variable number `n`.
    #[inline(always)]
    pub fn nth(value: L, n: usize) -> Self {
        Self::along(value, L::splat(1.0), n)
    }

    /// What depends on variable number `n` alone.
    #[inline(always)]
    pub fn along(value: L, slope: L, n: usize) -> Self {
        let mut all = [L::splat(0.0); C];
        all[n] = slope;
        Dual { value, slope: all }
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
        let first = mixed(Slopes::<f64, 2>::nth(x, 0), Slopes::nth(y, 1));
        let both = mixed(Curved::<2>::variable(x, 0), Curved::variable(y, 1));
        let slope = |x: f64, y: f64| mixed(Slopes::<f64, 2>::nth(x, 0), Slopes::nth(y, 1)).slope;
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
