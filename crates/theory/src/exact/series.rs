//! Power series truncated after a fixed number of terms, over fractions or floating-point numbers.

use super::Field;

/// Coefficients of x⁰, x¹, …; both sides of an operation have the same number of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Series<F>(pub Vec<F>);

impl<F: Field> Series<F> {
    /// A constant, with `terms` coefficients.
    pub fn constant(terms: usize, c: F) -> Self {
        Self::monomial(terms, 0, c)
    }

    /// `c x^power`.
    pub fn monomial(terms: usize, power: usize, c: F) -> Self {
        let mut a = vec![F::zero(); terms];
        if power < terms {
            a[power] = c;
        }
        Series(a)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn add(&self, o: &Self) -> Self {
        let sum = |(a, b): (&F, &F)| a.clone() + b.clone();
        Series(self.0.iter().zip(&o.0).map(sum).collect())
    }

    pub fn scale(&self, c: &F) -> Self {
        Series(self.0.iter().map(|a| a.clone() * c.clone()).collect())
    }

    pub fn mul(&self, o: &Self) -> Self {
        Series(
            (0..self.len())
                .map(|n| (0..=n).fold(F::zero(), |s, k| s + self.0[k].clone() * o.0[n - k].clone()))
                .collect(),
        )
    }

    /// Quotient; `None` if the divisor has no constant term.
    pub fn div(&self, o: &Self) -> Option<Self> {
        let first = o.0.first()?;
        if first.is_zero() {
            return None;
        }
        let mut a: Vec<F> = vec![];
        for n in 0..self.len() {
            let known = (0..n).fold(F::zero(), |s, k| s + a[k].clone() * o.0[n - k].clone());
            a.push((self.0[n].clone() - known) / first.clone());
        }
        Some(Series(a))
    }

    /// Whole power; `None` if it is negative and there is no constant term.
    pub fn powi(&self, n: i32) -> Option<Self> {
        let one = Self::constant(self.len(), F::one());
        let p = (0..n.unsigned_abs()).fold(one.clone(), |p, _| p.mul(self));
        if n < 0 { one.div(&p) } else { Some(p) }
    }

    /// Square root; `None` if the constant term is 0 or its root is not in the field.
    pub fn sqrt(&self) -> Option<Self> {
        let first = self.0.first()?.root()?;
        if first.is_zero() {
            return None;
        }
        let mut a = vec![first.clone()];
        for n in 1..self.len() {
            let known = (1..n).fold(F::zero(), |s, k| s + a[k].clone() * a[n - k].clone());
            a.push((self.0[n].clone() - known) / (F::whole(2) * first.clone()));
        }
        Some(Series(a))
    }

    /// Exponential; `None` if that of the constant term is not in the field.
    pub fn exp(&self) -> Option<Self> {
        let mut a = vec![self.0.first()?.exponential()?];
        for n in 1..self.len() {
            let sum = (1..=n).fold(F::zero(), |s, k| {
                s + F::whole(k as i64) * self.0[k].clone() * a[n - k].clone()
            });
            a.push(sum / F::whole(n as i64));
        }
        Some(Series(a))
    }

    /// Cosine and sine; `None` unless the constant term is 0.
    pub fn cos_sin(&self) -> Option<[Self; 2]> {
        if !self.0.first()?.is_zero() {
            return None;
        }
        let (mut c, mut s) = (vec![F::one()], vec![F::zero()]);
        for n in 1..self.len() {
            let sum = |of: &[F]| {
                (1..=n).fold(F::zero(), |t, k| {
                    t + F::whole(k as i64) * self.0[k].clone() * of[n - k].clone()
                }) / F::whole(n as i64)
            };
            let (dc, ds) = (-sum(&s), sum(&c));
            c.push(dc);
            s.push(ds);
        }
        Some([Series(c), Series(s)])
    }

    /// `self(inner(x))`; `None` unless the inner constant term is 0.
    pub fn compose(&self, inner: &Self) -> Option<Self> {
        if !inner.0.first()?.is_zero() {
            return None;
        }
        let zero = Self::constant(self.len(), F::zero());
        Some(self.0.iter().rev().fold(zero, |p, c| {
            p.mul(inner).add(&Self::constant(self.len(), c.clone()))
        }))
    }

    /// The sum at x.
    pub fn at(&self, x: F) -> F {
        let step = |s: F, c: &F| s * x.clone() + c.clone();
        self.0.iter().rev().fold(F::zero(), step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, factorial, q};

    const TERMS: usize = 9;

    fn x() -> Series<Q> {
        Series::monomial(TERMS, 1, q(1, 1))
    }

    #[test]
    fn textbook_series() {
        let e = x().exp().unwrap();
        for (n, c) in e.0.iter().enumerate() {
            assert_eq!(*c, q(1, 1) / factorial::<Q>(n));
        }
        let root = Series::constant(TERMS, q(1, 1)).add(&x()).sqrt().unwrap();
        assert_eq!(
            root.0[..5],
            [q(1, 1), q(1, 2), q(-1, 8), q(1, 16), q(-5, 128)]
        );
        assert_eq!(Series::constant(3, q(2, 1)).sqrt(), None);
        assert_eq!(Series::constant(3, q(2, 1)).exp(), None);
    }

    #[test]
    fn identities_hold_term_by_term() {
        let inner = x().add(&Series::monomial(TERMS, 2, q(-3, 7)));
        let [c, s] = inner.cos_sin().unwrap();
        let one = Series::constant(TERMS, q(1, 1));
        assert_eq!(c.mul(&c).add(&s.mul(&s)), one);
        let [plain, _] = x().cos_sin().unwrap();
        assert_eq!(plain.compose(&inner).unwrap(), c);
        assert_eq!(
            inner.exp().unwrap(),
            x().exp().unwrap().compose(&inner).unwrap()
        );
        let e = inner.exp().unwrap();
        assert_eq!(e.powi(-3).unwrap(), inner.scale(&q(-3, 1)).exp().unwrap());
        assert_eq!(e.div(&e).unwrap(), one);
        assert_eq!(x().powi(-1), None);
        assert_eq!(e.compose(&one), None);
    }

    #[test]
    fn floats_follow_the_fractions() {
        let a = Series(vec![0.3f64, 1.0, 0.5, 0.0, 0.0, 0.0]);
        let root = a.exp().unwrap().sqrt().unwrap();
        let half = a.scale(&0.5).exp().unwrap();
        for (a, b) in root.0.iter().zip(&half.0) {
            assert!((a - b).abs() < 1e-15);
        }
        assert!((Series(vec![1.0, 2.0, 3.0]).at(0.5) - 2.75).abs() < 1e-15);
    }
}
