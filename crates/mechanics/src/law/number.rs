//! Numbers that laws are written over: plain numbers, one or several side by side, a number with its slope (forces, tangents),
//! or a Taylor series (elastic constants, gradient coefficients). So every law is written once, and its derivatives are exact.

use super::spline::{Spline, Twin};
use crate::execute::lane::{Lane, Piece, elementary};
use std::ops::{Add, Mul, Sub};

/// What a law may do with its arguments. Implemented by every lane, by [`Dual`] and by [`Jet`](super::jet::Jet); a law asks for
/// no more than this, so it needs no unsafe code and no instruction set.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn constant(x: f64) -> Self;
    /// Times a constant.
    #[inline(always)]
    fn times(self, x: f64) -> Self {
        self * Self::constant(x)
    }
    /// Plus a constant.
    #[inline(always)]
    fn plus(self, x: f64) -> Self {
        self + Self::constant(x)
    }
    fn recip(self) -> Self;
    fn sqrt(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    /// The value of a table.
    fn table(self, table: &Spline) -> Self;
    /// The values of two tables with the same knots.
    fn twin(self, twin: &Twin) -> [Self; 2];
    /// The value of one of them.
    fn of_twin(self, twin: &Twin, n: usize) -> Self;
    /// `ln(1 + x)` without cancellation.
    fn ln_1p(self) -> Self;
    /// `eˣ − 1` without cancellation.
    fn exp_m1(self) -> Self;
    /// `self · a + b`, rounded once where that is one operation.
    fn fma(self, a: Self, b: Self) -> Self;
    fn div(self, a: Self) -> Self;
    /// `below` where this is below `limit`, else `otherwise`.
    fn choose(self, limit: Self, below: Self, otherwise: Self) -> Self;
    /// `a` where this is below `limit`, else `b`.
    #[inline(always)]
    fn below(self, limit: f64, a: Self, b: Self) -> Self {
        self.choose(Self::constant(limit), a, b)
    }
    /// The smaller one; this where either is not a number.
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        other.choose(self, other, self)
    }
    /// The larger one; this where either is not a number.
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.choose(other, other, self)
    }
    /// Is any of these numbers below the limit?
    fn any_below(self, limit: f64) -> bool;
    /// Do a piece of work out of line, in code of these numbers' instruction set, where they have one.
    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        piece.run()
    }

    /// Whole powers, by squaring.
    #[inline(always)]
    fn power(self, mut n: u32) -> Self {
        let (mut base, mut out) = (self, None);
        while n > 0 {
            if n % 2 == 1 {
                out = Some(match out {
                    None => base,
                    Some(o) => o * base,
                });
            }
            n /= 2;
            if n > 0 {
                base = base * base;
            }
        }
        match out {
            Some(o) => o,
            None => Self::constant(1.0),
        }
    }
}

impl<L: Lane> Number for L {
    #[inline(always)]
    fn constant(x: f64) -> L {
        L::splat(x)
    }
    #[inline(always)]
    fn recip(self) -> L {
        L::splat(1.0).div(self)
    }
    #[inline(always)]
    fn sqrt(self) -> L {
        Lane::sqrt(self)
    }
    #[inline(always)]
    fn exp(self) -> L {
        elementary::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> L {
        elementary::ln(self)
    }
    #[inline(always)]
    fn ln_1p(self) -> L {
        each(self, libm::log1p)
    }
    #[inline(always)]
    fn exp_m1(self) -> L {
        each(self, libm::expm1)
    }
    #[inline(always)]
    fn fma(self, a: L, b: L) -> L {
        Lane::fma(self, a, b)
    }
    #[inline(always)]
    fn div(self, a: L) -> L {
        Lane::div(self, a)
    }
    #[inline(always)]
    fn choose(self, limit: L, below: L, otherwise: L) -> L {
        L::select(self.lt(limit), below, otherwise)
    }
    #[inline(always)]
    fn any_below(self, limit: f64) -> bool {
        L::any(self.lt(L::splat(limit)))
    }
    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        <L as Lane>::out_of_line(piece)
    }
    #[inline(always)]
    fn table(self, table: &Spline) -> L {
        table.lanes(self)[0]
    }
    #[inline(always)]
    fn twin(self, twin: &Twin) -> [L; 2] {
        let [[a, _], [b, _]] = twin.lanes(self);
        [a, b]
    }
    #[inline(always)]
    fn of_twin(self, twin: &Twin, n: usize) -> L {
        twin.lanes_of(n, self)[0]
    }
}

/// Numbers that hold lanes.
pub trait Over<L: Lane>: Number {
    /// What does not depend on the variables.
    fn lane(x: L) -> Self;
}

impl<L: Lane> Over<L> for L {
    #[inline(always)]
    fn lane(x: L) -> L {
        x
    }
}

/// A slope, or several: what derivatives are made of. Methods, not closures over lanes: those would not compile for the lanes' instruction set.
pub trait Slope<L: Lane>: Copy {
    fn zero() -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn scaled(self, by: L) -> Self;
    /// `by · self + other`, rounded once.
    fn fma(self, by: L, other: Self) -> Self;
    /// This where the mask is set, else the other.
    fn or(self, mask: L::Mask, other: Self) -> Self;
}

impl<L: Lane> Slope<L> for L {
    #[inline(always)]
    fn zero() -> L {
        L::splat(0.0)
    }
    #[inline(always)]
    fn add(self, other: L) -> L {
        self + other
    }
    #[inline(always)]
    fn sub(self, other: L) -> L {
        self - other
    }
    #[inline(always)]
    fn scaled(self, by: L) -> L {
        by * self
    }
    #[inline(always)]
    fn fma(self, by: L, other: L) -> L {
        Lane::fma(by, self, other)
    }
    #[inline(always)]
    fn or(self, mask: L::Mask, other: L) -> L {
        L::select(mask, self, other)
    }
}

impl<L: Lane, const C: usize> Slope<L> for [L; C] {
    #[inline(always)]
    fn zero() -> Self {
        [L::splat(0.0); C]
    }
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        for n in 0..C {
            self[n] = self[n] + other[n];
        }
        self
    }
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        for n in 0..C {
            self[n] = self[n] - other[n];
        }
        self
    }
    #[inline(always)]
    fn scaled(mut self, by: L) -> Self {
        for n in 0..C {
            self[n] = by * self[n];
        }
        self
    }
    #[inline(always)]
    fn fma(mut self, by: L, other: Self) -> Self {
        for n in 0..C {
            self[n] = Lane::fma(by, self[n], other[n]);
        }
        self
    }
    #[inline(always)]
    fn or(mut self, mask: L::Mask, other: Self) -> Self {
        for n in 0..C {
            self[n] = L::select(mask, self[n], other[n]);
        }
        self
    }
}

/// Values and slopes of a whole lane: `f + f′ε`, ε² = 0; or several slopes ([`Slopes`](super::slopes::Slopes)).
#[derive(Debug, Clone, Copy)]
pub struct Dual<L, S = L> {
    pub value: L,
    pub slope: S,
}

impl<L: Lane> Dual<L> {
    /// The variable itself.
    #[inline(always)]
    pub fn variable(value: L) -> Self {
        Dual {
            value,
            slope: L::splat(1.0),
        }
    }
}

impl<L: Lane, S: Slope<L>> Dual<L, S> {
    /// A function's value and derivative at the value, by the chain rule.
    #[inline(always)]
    fn chain(self, value: L, derivative: L) -> Self {
        Dual {
            value,
            slope: self.slope.scaled(derivative),
        }
    }
}

impl<L: Lane, S: Slope<L>> Over<L> for Dual<L, S> {
    #[inline(always)]
    fn lane(value: L) -> Self {
        Dual {
            value,
            slope: S::zero(),
        }
    }
}

impl<L: Lane, S: Slope<L>> Add for Dual<L, S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Dual {
            value: self.value + o.value,
            slope: self.slope.add(o.slope),
        }
    }
}
impl<L: Lane, S: Slope<L>> Sub for Dual<L, S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Dual {
            value: self.value - o.value,
            slope: self.slope.sub(o.slope),
        }
    }
}
impl<L: Lane, S: Slope<L>> Mul for Dual<L, S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        Dual {
            value: self.value * o.value,
            slope: o.slope.fma(self.value, self.slope.scaled(o.value)),
        }
    }
}

/// A function of a plain number in every lane. No closure, so that this compiles for the lane's instruction set.
#[inline(always)]
fn each<L: Lane>(x: L, f: fn(f64) -> f64) -> L {
    let mut a = x.to_array();
    for v in &mut a[..L::N] {
        *v = f(*v);
    }
    // SAFETY: N ≤ TILE
    unsafe { L::load(a.as_ptr()) }
}

impl<L: Lane, S: Slope<L>> Number for Dual<L, S> {
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
        Dual {
            value: self.value + L::splat(x),
            slope: self.slope,
        }
    }
    #[inline(always)]
    fn recip(self) -> Self {
        let r = Lane::div(L::splat(1.0), self.value);
        self.chain(r, L::splat(0.0) - r * r)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let r = Lane::sqrt(self.value);
        self.chain(r, Lane::div(L::splat(0.5), r))
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = elementary::exp(self.value);
        self.chain(e, e)
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(
            elementary::ln(self.value),
            Lane::div(L::splat(1.0), self.value),
        )
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
        let slope = Lane::div(L::splat(1.0), L::splat(1.0) + self.value);
        self.chain(each(self.value, libm::log1p), slope)
    }
    #[inline(always)]
    fn exp_m1(self) -> Self {
        let e = each(self.value, libm::expm1);
        self.chain(e, e + L::splat(1.0))
    }
    #[inline(always)]
    fn fma(self, a: Self, b: Self) -> Self {
        let own = self.slope.fma(a.value, b.slope);
        Dual {
            value: Lane::fma(self.value, a.value, b.value),
            slope: a.slope.fma(self.value, own),
        }
    }
    #[inline(always)]
    fn div(self, a: Self) -> Self {
        let r = Lane::div(L::splat(1.0), a.value);
        let value = self.value * r;
        Dual {
            value,
            slope: self.slope.sub(a.slope.scaled(value)).scaled(r),
        }
    }
    #[inline(always)]
    fn any_below(self, limit: f64) -> bool {
        self.value.any_below(limit)
    }
    #[inline(always)]
    fn out_of_line<P: Piece>(piece: P) -> P::Out {
        <L as Lane>::out_of_line(piece)
    }
    #[inline(always)]
    fn choose(self, limit: Self, a: Self, b: Self) -> Self {
        let m = self.value.lt(limit.value);
        Dual {
            value: L::select(m, a.value, b.value),
            slope: a.slope.or(m, b.slope),
        }
    }
}
