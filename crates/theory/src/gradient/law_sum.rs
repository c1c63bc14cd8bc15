//! Sums of products of what a chain's law says at one stretch: coefficients of a gradient equation that no law was put
//! into yet.

use crate::exact::Field;
use crate::exact::polynomial::Coefficient;
use num_traits::{One, Zero};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, Mul, Neg};

/// A number that a law has at the stretch y′ of a chain with spacing Δx; j counts the neighbours of one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Symbol {
    /// `F(k) = F⁽ᵏ⁾(R(0,0))/Δx`.
    Embedding(usize),
    /// `R(m,n) = 2 Σ_j (jΔx)ⁿ f_j⁽ᵐ⁾(jΔx y′)`; R(0,0) is the density ρ of a point.
    Density(usize, usize),
    /// `P(m,n) = Σ_j (jΔx)ⁿ φ_j⁽ᵐ⁾(jΔx y′)/Δx`; P(0,0) is the energy density of the bonds.
    Pair(usize, usize),
}

impl fmt::Display for Symbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Symbol::Embedding(k) => write!(f, "F({k})"),
            Symbol::Density(m, n) => write!(f, "R({m},{n})"),
            Symbol::Pair(m, n) => write!(f, "P({m},{n})"),
        }
    }
}

/// `Σ c · product of symbols`, coefficients not 0, symbols of a product in order.
#[derive(Debug, Clone, PartialEq)]
pub struct LawSum<F>(BTreeMap<Vec<Symbol>, F>);

impl<F: Field> LawSum<F> {
    /// `c` times the symbols.
    pub fn term(c: F, symbols: &[Symbol]) -> Self {
        let mut sum = LawSum(BTreeMap::new());
        sum.accumulate(symbols.to_vec(), c);
        sum
    }

    fn accumulate(&mut self, mut symbols: Vec<Symbol>, c: F) {
        symbols.sort_unstable();
        let sum = match self.0.remove(&symbols) {
            Some(old) => old + c,
            None => c,
        };
        if !sum.is_zero() {
            self.0.insert(symbols, sum);
        }
    }

    pub fn terms(&self) -> impl Iterator<Item = (&[Symbol], &F)> {
        self.0.iter().map(|(s, c)| (s.as_slice(), c))
    }

    /// The number that it is for a law.
    pub fn at(&self, value: impl Fn(Symbol) -> F) -> F {
        self.0.iter().fold(F::zero(), |sum, (symbols, c)| {
            sum + symbols.iter().fold(c.clone(), |p, s| p * value(*s))
        })
    }
}

impl<F: Field> Zero for LawSum<F> {
    fn zero() -> Self {
        LawSum(BTreeMap::new())
    }
    fn is_zero(&self) -> bool {
        self.0.is_empty()
    }
}

impl<F: Field> One for LawSum<F> {
    fn one() -> Self {
        Self::term(F::one(), &[])
    }
}

impl<F: Field> Add for LawSum<F> {
    type Output = Self;
    fn add(mut self, o: Self) -> Self {
        for (s, c) in o.0 {
            self.accumulate(s, c);
        }
        self
    }
}

impl<F: Field> Mul for LawSum<F> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let mut product = Self::zero();
        for (s, a) in &self.0 {
            for (t, b) in &o.0 {
                product.accumulate([&s[..], t].concat(), a.clone() * b.clone());
            }
        }
        product
    }
}

impl<F: Field> Neg for LawSum<F> {
    type Output = Self;
    fn neg(self) -> Self {
        LawSum(self.0.into_iter().map(|(s, c)| (s, -c)).collect())
    }
}

impl<F: Field> Coefficient for LawSum<F> {
    fn rational(n: i64, d: i64) -> Self {
        Self::term(F::ratio(n, d), &[])
    }

    /// `P(m,n)′ = P(m+1,n+1)`, R likewise, `F(k)′ = F(k+1) R(1,1)`.
    fn by_slope(&self) -> Self {
        let mut sum = Self::zero();
        for (symbols, c) in &self.0 {
            for at in 0..symbols.len() {
                let mut s = symbols.clone();
                match symbols[at] {
                    Symbol::Pair(m, n) => s[at] = Symbol::Pair(m + 1, n + 1),
                    Symbol::Density(m, n) => s[at] = Symbol::Density(m + 1, n + 1),
                    Symbol::Embedding(k) => {
                        s[at] = Symbol::Embedding(k + 1);
                        s.push(Symbol::Density(1, 1));
                    }
                }
                sum.accumulate(s, c.clone());
            }
        }
        sum
    }
}

impl<F: Field + fmt::Display> fmt::Display for LawSum<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("0");
        }
        for (n, (symbols, c)) in self.0.iter().enumerate() {
            let mut factors: Vec<String> = symbols.iter().map(Symbol::to_string).collect();
            if factors.is_empty() || !c.is_one() {
                factors.insert(0, c.to_string());
            }
            let separator = if n == 0 { "" } else { " + " };
            write!(f, "{separator}{}", factors.join(" "))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};

    #[test]
    fn slopes_follow_the_product_rule() {
        let a = LawSum::<Q>::term(q(2, 3), &[Symbol::Density(1, 3), Symbol::Embedding(2)]);
        let b = LawSum::<Q>::term(q(1, 1), &[Symbol::Pair(2, 2)]) + LawSum::one();
        assert_eq!(
            a.by_slope().to_string(),
            "2/3 F(2) R(2,4) + 2/3 F(3) R(1,1) R(1,3)"
        );
        let product = (a.clone() * b.clone()).by_slope();
        assert_eq!(product, a.by_slope() * b.clone() + a.clone() * b.by_slope());
        assert!((a.clone() + -a).is_zero());
        assert_eq!(b.to_string(), "1 + P(2,2)");
    }

    #[test]
    fn values_are_sums_of_products() {
        let a = LawSum::<f64>::term(1.5, &[Symbol::Embedding(1), Symbol::Density(2, 2)])
            + LawSum::term(-2.0, &[Symbol::Pair(2, 2)]);
        let value = |s| match s {
            Symbol::Embedding(_) => 2.0,
            Symbol::Density(..) => 5.0,
            Symbol::Pair(..) => 0.25,
        };
        assert_eq!(a.at(value), 14.5);
    }
}
