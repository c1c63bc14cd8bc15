//! Taylor series as numbers: any potential evaluated on one yields its derivatives of any order, exactly.

use super::number::Number;
use super::potential::Potential;
use super::spline::{Spline, Twin};
use std::ops::{Add, Mul, Sub};

/// `Σ a_n t^n`, n < N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<const N: usize>(pub [f64; N]);

impl<const N: usize> Jet<N> {
    /// The variable itself, at `x`.
    pub fn variable(x: f64) -> Self {
        let mut a = [0.0; N];
        a[0] = x;
        if N > 1 {
            a[1] = 1.0;
        }
        Jet(a)
    }

    /// Value, first, second, … derivative.
    pub fn derivatives(self) -> [f64; N] {
        let mut factorial = 1.0;
        let mut d = self.0;
        for (n, x) in d.iter_mut().enumerate() {
            factorial *= n.max(1) as f64;
            *x *= factorial;
        }
        d
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Jet(crate::array::from_fn(|n| self.0[n] + o.0[n]))
    }
}
impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Jet(crate::array::from_fn(|n| self.0[n] - o.0[n]))
    }
}
impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Jet(crate::array::from_fn(|n| {
            (0..=n).map(|k| self.0[k] * o.0[n - k]).sum()
        }))
    }
}

impl<const N: usize> Number for Jet<N> {
    fn constant(x: f64) -> Self {
        let mut a = [0.0; N];
        a[0] = x;
        Jet(a)
    }
    fn times(self, x: f64) -> Self {
        Jet(self.0.map(|a| a * x))
    }
    fn recip(self) -> Self {
        let a = self.0;
        let mut r = [0.0; N];
        r[0] = 1.0 / a[0];
        for n in 1..N {
            let known: f64 = (1..=n).map(|k| a[k] * r[n - k]).sum();
            r[n] = -known * r[0];
        }
        Jet(r)
    }
    fn sqrt(self) -> Self {
        let a = self.0;
        let mut r = [0.0; N];
        r[0] = a[0].sqrt();
        for n in 1..N {
            let known: f64 = (1..n).map(|k| r[k] * r[n - k]).sum();
            r[n] = (a[n] - known) / (2.0 * r[0]);
        }
        Jet(r)
    }
    fn exp(self) -> Self {
        let a = self.0;
        let mut r = [0.0; N];
        r[0] = libm::exp(a[0]);
        for n in 1..N {
            let sum: f64 = (1..=n).map(|k| k as f64 * a[k] * r[n - k]).sum();
            r[n] = sum / n as f64;
        }
        Jet(r)
    }
    fn ln(self) -> Self {
        let a = self.0;
        let mut r = [0.0; N];
        r[0] = libm::log(a[0]);
        for n in 1..N {
            let known: f64 = (1..n).map(|k| k as f64 * r[k] * a[n - k]).sum();
            r[n] = (a[n] - known / n as f64) / a[0];
        }
        Jet(r)
    }
    /// Of the cubic that holds at the value; its derivatives jump at the knots from the second on.
    fn table(self, table: &Spline) -> Self {
        let (cubic, part, inverse) = table.piece(self.0[0]);
        self.cubic(cubic, part, inverse)
    }
    fn twin(self, twin: &Twin) -> [Self; 2] {
        let (cubics, part, inverse) = twin.piece(self.0[0]);
        cubics.map(|c| self.cubic(c, part, inverse))
    }
    fn of_twin(self, twin: &Twin, n: usize) -> Self {
        self.twin(twin)[n]
    }
    fn ln_1p(self) -> Self {
        let mut r = self.plus(1.0).ln();
        r.0[0] = libm::log1p(self.0[0]);
        r
    }
    fn exp_m1(self) -> Self {
        let mut r = self.exp();
        r.0[0] = libm::expm1(self.0[0]);
        r
    }
    fn fma(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn div(self, a: Self) -> Self {
        self * a.recip()
    }
    fn any_below(self, limit: f64) -> bool {
        self.0[0] < limit
    }
    fn choose(self, limit: Self, a: Self, b: Self) -> Self {
        if self.0[0] < limit.0[0] { a } else { b }
    }
}

impl<const N: usize> Jet<N> {
    /// A piece of a table, `part` steps beyond its knot.
    fn cubic(self, [c, b, a, v]: [f64; 4], part: f64, inverse: f64) -> Self {
        let mut p = self.times(inverse);
        p.0[0] = part;
        ((p.times(c).plus(b) * p).plus(a) * p).plus(v)
    }
}

/// φ, φ′, φ″, … of the distance.
pub fn pair<const N: usize>(potential: &impl Potential, r: f64) -> [f64; N] {
    let r = Jet::<N>::variable(r);
    potential.pair(r * r).derivatives()
}

/// f, f′, f″, … of the distance.
pub fn density<const N: usize>(potential: &impl Potential, r: f64) -> [f64; N] {
    let r = Jet::<N>::variable(r);
    potential.density(r * r).derivatives()
}

/// F, F′, F″, … of the density.
pub fn embedding<const N: usize>(potential: &impl Potential, rho: f64) -> [f64; N] {
    potential.embedding(Jet::<N>::variable(rho)).derivatives()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::potential::lennard_jones::LennardJones;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-13 * b.abs().max(1.0), "{a} is not {b}");
    }

    #[test]
    fn derivatives_of_a_power_law() {
        let lj = LennardJones {
            epsilon: 0.7,
            sigma: 1.1,
        };
        let r = 1.3f64;
        let d = pair::<7>(&lj, r);
        let mut expected = [4.0 * 0.7 * 1.1f64.powi(12), -4.0 * 0.7 * 1.1f64.powi(6)];
        let (mut n, mut m) = (12.0, 6.0);
        expected[0] *= r.powf(-n);
        expected[1] *= r.powf(-m);
        for value in d {
            let sum = expected[0] + expected[1];
            assert!((value - sum).abs() < 1e-13 * expected[0].abs());
            expected[0] *= -n / r;
            expected[1] *= -m / r;
            (n, m) = (n + 1.0, m + 1.0);
        }
    }

    #[test]
    fn functions_are_inverse_to_each_other() {
        // terms of up to 1e4 cancel
        let x = Jet::<8>::variable(0.8) * Jet::variable(0.8) + Jet::constant(0.3);
        let pairs = [
            (x.ln().exp(), x),
            (x.sqrt() * x.sqrt(), x),
            (x.recip() * x, Jet::constant(1.0)),
            (x.power(5) * x.recip().power(4), x),
        ];
        for (a, b) in pairs {
            for n in 0..8 {
                assert!((a.0[n] - b.0[n]).abs() < 1e-11, "{a:?} is not {b:?}");
            }
        }
        let d = Jet::<6>::variable(2.0).ln().derivatives();
        for (n, expected) in [2f64.ln(), 0.5, -0.25, 0.25, -0.375, 0.75]
            .iter()
            .enumerate()
        {
            close(d[n], *expected);
        }
    }

    #[test]
    fn tables_are_cubics_between_knots() {
        let values: Vec<f64> = (0..20).map(|m| (0.3 * m as f64).sin()).collect();
        let table = Spline::new(0.5, 0.1, &values, false);
        let d = Jet::<6>::variable(1.237).table(&table).derivatives();
        let all = |x: f64| {
            let ([c, b, a, v], p, i) = table.piece(x);
            [
                ((c * p + b) * p + a) * p + v,
                ((3.0 * c * p + 2.0 * b) * p + a) * i,
                (6.0 * c * p + 2.0 * b) * i * i,
                6.0 * c * i * i * i,
            ]
        };
        let expected = all(1.237);
        let [value, slope] = table.at(1.237);
        close(d[0], value);
        close(d[1], slope);
        for n in 0..4 {
            close(d[n], expected[n]);
        }
        assert_eq!(d[4..], [0.0, 0.0]);
        // chain rule: table(x²)
        let x = Jet::<3>::variable(1.1);
        let d = (x * x).table(&table).derivatives();
        let [_, first, second, _] = all(1.21);
        close(d[1], 2.2 * first);
        close(d[2], 4.84 * second + 2.0 * first);
    }
}
