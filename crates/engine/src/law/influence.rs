//! Influence functions ω of the bond length: written once, for plain numbers and for lanes.

use crate::execute::lane::{Lane, Piece};
use crate::spec::Influence;

/// ω for one horizon δ. Multiplications only (and `1/r` as given), hence the same bits in every width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfluenceFunction {
    kind: Influence,
    /// 1/δ
    inv_horizon: f64,
}

impl InfluenceFunction {
    pub fn new(kind: Influence, horizon: f64) -> Self {
        InfluenceFunction {
            kind,
            inv_horizon: 1.0 / horizon,
        }
    }

    /// ω(r); `inv_r` is 1/r.
    #[inline(always)]
    pub fn at<L: Lane>(&self, r: L, inv_r: L) -> L {
        let q = r * L::splat(self.inv_horizon);
        match self.kind {
            Influence::Constant => L::splat(1.0),
            Influence::Inverse => inv_r,
            Influence::Conical => L::splat(1.0) - q,
            Influence::Gaussian => L::apart(Gaussian(q)),
            Influence::CubicSpline => L::apart(CubicSpline(q)),
        }
    }
}

/// ω(r) for a horizon δ.
pub fn influence(kind: Influence, r: f64, horizon: f64) -> f64 {
    InfluenceFunction::new(kind, horizon).at(r, 1.0 / r)
}

struct Gaussian<L>(L);

impl<L: Lane> Piece for Gaussian<L> {
    type Out = L;
    #[inline(always)]
    fn run(self) -> L {
        gaussian(self.0)
    }
}

struct CubicSpline<L>(L);

impl<L: Lane> Piece for CubicSpline<L> {
    type Out = L;
    #[inline(always)]
    fn run(self) -> L {
        spline(self.0)
    }
}

/// `exp(−4 q²)` for 0 ≤ q ≤ 1 as `e⁻² T(½ − q²)⁴` with the Taylor polynomial T of exp, fifteen terms on
/// [−½, ½].
#[inline(always)]
fn gaussian<L: Lane>(q: L) -> L {
    let t = L::splat(0.5) - q * q;
    let mut p = L::splat(INVERSE_FACTORIALS[14]);
    for c in INVERSE_FACTORIALS[..14].iter().rev() {
        p = p.fma(t, L::splat(*c));
    }
    let square = p * p;
    L::splat(E_MINUS_TWO) * square * square
}

const INVERSE_FACTORIALS: [f64; 15] = {
    let mut c = [1.0; 15];
    let mut n = 1;
    while n < 15 {
        c[n] = c[n - 1] / n as f64;
        n += 1;
    }
    c
};

const E_MINUS_TWO: f64 = 0.135_335_283_236_612_7;

/// B-spline with knots at δ/2 and δ, scaled to 1 at the centre.
#[inline(always)]
fn spline<L: Lane>(q: L) -> L {
    let one = L::splat(1.0);
    let rest = one - q;
    let outer = L::splat(2.0) * rest * rest * rest;
    let inner = (q * q * L::splat(6.0)).fma(q - one, one);
    L::select(L::splat(0.5).lt(q), outer.zero_if(one.lt(q)), inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The formulas as books print them, of q = r/δ.
    fn printed(kind: Influence, r: f64, horizon: f64) -> f64 {
        let q = r / horizon;
        match kind {
            Influence::Constant => 1.0,
            Influence::Inverse => 1.0 / r,
            Influence::Conical => 1.0 - q,
            Influence::Gaussian => (-4.0 * q * q).exp(),
            Influence::CubicSpline if q <= 0.5 => 1.0 - 6.0 * q * q + 6.0 * q * q * q,
            Influence::CubicSpline if q <= 1.0 => 2.0 * (1.0 - q).powi(3),
            Influence::CubicSpline => 0.0,
        }
    }

    #[test]
    fn every_function_is_what_is_printed() {
        let d = 0.0031;
        for kind in Influence::ALL {
            let largest = printed(kind, 0.1 * d, d);
            for n in 1..=1000 {
                let r = d * f64::from(n) / 1000.0;
                let (found, exact) = (influence(kind, r, d), printed(kind, r, d));
                assert!(
                    (found - exact).abs() <= 1e-15 * largest.max(exact),
                    "{kind:?} at {r}: {found} is not {exact}"
                );
            }
        }
    }
}
