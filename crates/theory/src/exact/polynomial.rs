//! Polynomials in the derivatives y′, y″, y‴, … of a deformation y(x); y′ may have negative powers.

use super::Field;
use num_traits::{One, Zero};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Neg;

/// What stands before a monomial: a number, or something that depends on y′ itself.
pub trait Coefficient: Clone + PartialEq + fmt::Debug + Zero + One + Neg<Output = Self> {
    /// `n/d`.
    fn rational(n: i64, d: i64) -> Self;
    /// Derivative by y′.
    fn by_slope(&self) -> Self;
}

impl<F: Field> Coefficient for F {
    fn rational(n: i64, d: i64) -> Self {
        F::ratio(n, d)
    }
    fn by_slope(&self) -> Self {
        F::zero()
    }
}

/// Powers of y′, y″, y‴, …, without zeros at the end.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Monomial(Vec<i32>);

impl Monomial {
    /// From powers of y′, y″, ….
    pub fn new(powers: &[i32]) -> Self {
        let used = powers.iter().rposition(|p| *p != 0).map_or(0, |k| k + 1);
        Monomial(powers[..used].to_vec())
    }

    /// Power of the derivative of this order (1: y′).
    pub fn power(&self, order: usize) -> i32 {
        self.0.get(order - 1).copied().unwrap_or(0)
    }

    /// The highest order of derivative that occurs.
    pub fn highest(&self) -> usize {
        self.0.len()
    }

    fn times(&self, o: &Monomial) -> Monomial {
        let n = self.0.len().max(o.0.len());
        Monomial::new(
            &(1..=n)
                .map(|k| self.power(k) + o.power(k))
                .collect::<Vec<_>>(),
        )
    }

    /// With the power of one derivative changed.
    fn shifted(&self, order: usize, by: i32) -> Monomial {
        let mut powers = self.0.clone();
        powers.resize(powers.len().max(order), 0);
        powers[order - 1] += by;
        Monomial::new(&powers)
    }
}

impl fmt::Display for Monomial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factors: Vec<String> = (1..=self.highest())
            .rev()
            .filter(|k| self.power(*k) != 0)
            .map(|k| {
                let name = if k <= 3 {
                    format!("y{}", "'".repeat(k))
                } else {
                    format!("y({k})")
                };
                match self.power(k) {
                    1 => name,
                    p => format!("{name}^{p}"),
                }
            })
            .collect();
        if factors.is_empty() {
            return f.write_str("1");
        }
        f.write_str(&factors.join(" "))
    }
}

/// A sum of monomials with coefficients that are not 0.
#[derive(Debug, Clone, PartialEq)]
pub struct JetPolynomial<F>(BTreeMap<Monomial, F>);

impl<F: Coefficient> JetPolynomial<F> {
    pub fn zero() -> Self {
        JetPolynomial(BTreeMap::new())
    }

    /// `c · y′^{powers[0]} y″^{powers[1]} …`
    pub fn term(c: F, powers: &[i32]) -> Self {
        let mut p = Self::zero();
        p.accumulate(Monomial::new(powers), c);
        p
    }

    /// `c` times the derivative of this order.
    pub fn derivative_of_order(order: usize, c: F) -> Self {
        let mut powers = vec![0; order];
        powers[order - 1] = 1;
        Self::term(c, &powers)
    }

    fn accumulate(&mut self, m: Monomial, c: F) {
        let sum = match self.0.remove(&m) {
            Some(old) => old + c,
            None => c,
        };
        if !sum.is_zero() {
            self.0.insert(m, sum);
        }
    }

    pub fn terms(&self) -> impl Iterator<Item = (&Monomial, &F)> {
        self.0.iter()
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Coefficient of `y′^{powers[0]} y″^{powers[1]} …`
    pub fn coefficient(&self, powers: &[i32]) -> F {
        self.of(&Monomial::new(powers))
    }

    /// Coefficient of a monomial.
    pub fn of(&self, m: &Monomial) -> F {
        self.0.get(m).cloned().unwrap_or_else(F::zero)
    }

    pub fn add(&self, o: &Self) -> Self {
        let mut sum = self.clone();
        for (m, c) in &o.0 {
            sum.accumulate(m.clone(), c.clone());
        }
        sum
    }

    pub fn sub(&self, o: &Self) -> Self {
        self.add(&o.scale(&-F::one()))
    }

    pub fn scale(&self, c: &F) -> Self {
        let mut p = Self::zero();
        for (m, a) in &self.0 {
            p.accumulate(m.clone(), a.clone() * c.clone());
        }
        p
    }

    pub fn mul(&self, o: &Self) -> Self {
        let mut p = Self::zero();
        for (m, a) in &self.0 {
            for (n, b) in &o.0 {
                p.accumulate(m.times(n), a.clone() * b.clone());
            }
        }
        p
    }

    /// Partial derivative by the derivative of this order.
    pub fn partial(&self, order: usize) -> Self {
        let mut p = Self::zero();
        for (m, c) in &self.0 {
            let power = m.power(order);
            if power != 0 {
                p.accumulate(
                    m.shifted(order, -1),
                    c.clone() * F::rational(power as i64, 1),
                );
            }
            if order == 1 {
                p.accumulate(m.clone(), c.by_slope());
            }
        }
        p
    }

    /// Total derivative by x.
    pub fn total(&self) -> Self {
        let mut p = Self::zero();
        for (m, c) in &self.0 {
            for order in 1..=m.highest() {
                let power = m.power(order);
                if power != 0 {
                    let n = m.shifted(order, -1).shifted(order + 1, 1);
                    p.accumulate(n, c.clone() * F::rational(power as i64, 1));
                }
            }
            p.accumulate(m.shifted(2, 1), c.by_slope());
        }
        p
    }

    /// The highest order of derivative that occurs.
    pub fn highest(&self) -> usize {
        self.0.keys().map(Monomial::highest).max().unwrap_or(0)
    }

    /// Coefficients of another kind.
    pub fn map<G: Coefficient>(&self, f: impl Fn(&F) -> G) -> JetPolynomial<G> {
        let mut p = JetPolynomial::zero();
        for (m, c) in &self.0 {
            p.accumulate(m.clone(), f(c));
        }
        p
    }
}

impl<F: Field> JetPolynomial<F> {
    /// Value where `jet = [y′, y″, …]`; derivatives beyond it are 0.
    pub fn at(&self, jet: &[f64]) -> f64 {
        self.0
            .iter()
            .map(|(m, c)| {
                (1..=m.highest()).fold(c.value(), |v, k| {
                    v * jet.get(k - 1).copied().unwrap_or(0.0).powi(m.power(k))
                })
            })
            .sum()
    }
}

impl<F: Coefficient + fmt::Display> fmt::Display for JetPolynomial<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_zero() {
            return f.write_str("0");
        }
        for (n, (m, c)) in self.0.iter().enumerate() {
            let sep = if n == 0 { "" } else { " + " };
            write!(f, "{sep}({c}) {m}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    #[test]
    fn derivatives_follow_product_and_chain_rule() {
        // d/dx (y'' ^2 / y') = 2 y'' y''' / y' − y''^3 / y'^2
        let p = JetPolynomial::term(q(1, 1), &[-1, 2]);
        let expected =
            JetPolynomial::term(q(2, 1), &[-1, 1, 1]).add(&JetPolynomial::term(q(-1, 1), &[-2, 3]));
        assert_eq!(p.total(), expected);
        assert_eq!(p.partial(2), JetPolynomial::term(q(2, 1), &[-1, 1]));
        assert_eq!(p.partial(1), JetPolynomial::term(q(-1, 1), &[-2, 2]));
        assert!(p.partial(3).is_zero());
        // D(ab) = a Db + b Da
        let a = JetPolynomial::term(q(1, 3), &[2, 0, 1]).add(&p);
        assert_eq!(a.mul(&p).total(), a.mul(&p.total()).add(&p.mul(&a.total())));
        assert!(a.sub(&a).is_zero());
    }

    #[test]
    fn values_and_names() {
        let p = JetPolynomial::<Q>::term(q(3, 2), &[-2, 1, 0, 1]);
        assert!((p.at(&[2.0, 5.0, 0.0, 4.0]) - 1.5 * 0.25 * 20.0).abs() < 1e-15);
        assert_eq!(p.at(&[2.0, 5.0]), 0.0);
        assert_eq!(p.to_string(), "(3/2) y(4) y'' y'^-2");
        assert_eq!(p.highest(), 4);
        assert_eq!(p.coefficient(&[-2, 1, 0, 1, 0]), q(3, 2));
    }
}
