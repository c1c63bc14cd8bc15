//! Exact arithmetic: fractions, truncated power series, polynomials in the derivatives of a deformation.
//!
//! What a paper states as a fraction is computed as one. Everything is generic over [`Field`], so that the same text
//! serves numbers that are only known in floating point.

pub mod polynomial;
pub mod series;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Num, One, Signed, ToPrimitive, Zero};
use std::fmt::Debug;
use std::ops::Neg;

/// A fraction of whole numbers of any size.
pub type Q = BigRational;

/// Numbers that can be divided: fractions and `f64`.
pub trait Field: Clone + PartialEq + Debug + Num + Neg<Output = Self> {
    fn whole(n: i64) -> Self;
    /// Square root, where it is a number of the field.
    fn root(&self) -> Option<Self>;
    /// Exponential, where it is a number of the field.
    fn exponential(&self) -> Option<Self>;
    fn value(&self) -> f64;

    fn ratio(n: i64, d: i64) -> Self {
        Self::whole(n) / Self::whole(d)
    }

    /// Whole power, negative ones by division.
    fn to(&self, n: i32) -> Self {
        let p = num_traits::pow(self.clone(), n.unsigned_abs() as usize);
        if n < 0 { Self::one() / p } else { p }
    }
}

impl Field for f64 {
    fn whole(n: i64) -> f64 {
        n as f64
    }
    fn root(&self) -> Option<f64> {
        (*self >= 0.0).then(|| self.sqrt())
    }
    fn exponential(&self) -> Option<f64> {
        Some(libm::exp(*self))
    }
    fn value(&self) -> f64 {
        *self
    }
}

impl Field for Q {
    fn whole(n: i64) -> Q {
        Q::from_integer(n.into())
    }
    fn root(&self) -> Option<Q> {
        if self.is_negative() {
            return None;
        }
        let root = Q::new(self.numer().sqrt(), self.denom().sqrt());
        (&root * &root == *self).then_some(root)
    }
    fn exponential(&self) -> Option<Q> {
        self.is_zero().then(Q::one)
    }
    fn value(&self) -> f64 {
        self.to_f64().unwrap_or(f64::NAN)
    }
}

/// `n/d`.
pub fn q(n: i64, d: i64) -> Q {
    Q::ratio(n, d)
}

/// The number that a text states: `"17"`, `"-0.085"`, `"1.25e-3"` or `"3/4"`; `None` if it states none.
pub fn decimal(text: &str) -> Option<Q> {
    let text = text.trim();
    if let Some((n, d)) = text.split_once('/') {
        let (n, d) = (decimal(n)?, decimal(d)?);
        return (!d.is_zero()).then(|| n / d);
    }
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, e)) => (digits, e.parse::<i32>().ok()?),
        None => (text, 0),
    };
    // beyond any number that is meant
    if exponent.abs() > 10_000 {
        return None;
    }
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let bare = whole.strip_prefix(['-', '+']).unwrap_or(whole);
    if !bare.chars().chain(part.chars()).all(|c| c.is_ascii_digit())
        || (bare.len() + part.len()) == 0
    {
        return None;
    }
    let n: BigInt = format!("{bare}{part}").parse().ok()?;
    let value = Q::from_integer(n) * Q::whole(10).to(exponent - part.len() as i32);
    Some(if whole.starts_with('-') {
        -value
    } else {
        value
    })
}

/// The fraction that a floating-point number is; `None` if it is none.
pub fn binary(x: f64) -> Option<Q> {
    Q::from_float(x)
}

/// n!
pub fn factorial<F: Field>(n: usize) -> F {
    (1..=n as i64).fold(F::one(), |p, k| p * F::whole(k))
}

/// `Z_N(n) = Σ_{j=1}^N j^{−n}` for any whole n: the finite zeta function (seleson2009 below (5.2)), sums of powers.
pub fn zeta<F: Field>(neighbours: usize, n: i32) -> F {
    (1..=neighbours as i64).fold(F::zero(), |s, j| s + F::whole(j).to(-n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_the_fractions_they_state() {
        assert_eq!(decimal("0.085"), Some(q(17, 200)));
        assert_eq!(decimal(" -1.25e-3 "), Some(q(-1, 800)));
        assert_eq!(decimal("-0.5"), Some(q(-1, 2)));
        assert_eq!(decimal("1.44e12"), Some(q(1_440_000_000_000, 1)));
        assert_eq!(decimal("1.5/-3"), Some(q(-1, 2)));
        for bad in [
            "", "-", ".", "1/0", "1.2.3", "0x10", "1e", "1e99999", "nan", "1 2", "--1",
        ] {
            assert_eq!(decimal(bad), None, "{bad}");
        }
        assert_eq!(binary(0.375), Some(q(3, 8)));
        assert_eq!(q(-6, 8).to_string(), "-3/4");
    }

    #[test]
    fn roots_of_squares_only() {
        assert_eq!(q(9, 16).root(), Some(q(3, 4)));
        assert_eq!(q(1, 2).root(), None);
        assert_eq!(q(-1, 1).root(), None);
    }

    #[test]
    fn sums_of_powers() {
        assert_eq!(zeta::<Q>(4, -3), q(100, 1));
        assert_eq!(zeta::<Q>(3, 1), q(11, 6));
        assert_eq!(factorial::<Q>(6), q(720, 1));
    }
}
