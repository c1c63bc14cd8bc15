//! What a bond of a cloud weighs: influence function times volume fraction, from its length alone.

use crate::execute::lane::Lane;
use crate::spec::Influence;

/// `ω(r0) ν(r0)`, evaluated in lanes wherever a bond is met, so that nothing needs to be stored.
///
/// ω is `inverse/r0 + constant + slope r0`, times the Gaussian or spline where asked for; ν = min(1, cut − rate r0).
#[derive(Debug, Clone, Copy)]
pub struct BondWeight {
    inverse: f64,
    constant: f64,
    slope: f64,
    shape: Shape,
    cut: f64,
    rate: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    One,
    /// 1/δ
    Gaussian(f64),
    /// 1/δ
    Spline(f64),
}

impl BondWeight {
    /// Influence for a horizon δ; `scaling` is the spacing over which a partner's volume fades at the horizon
    /// ([`crate::family::volume_fraction`]), `None` for whole volumes.
    pub fn new(influence: Influence, horizon: f64, scaling: Option<f64>) -> Self {
        let (inverse, constant, slope) = match influence {
            Influence::Inverse => (1.0, 0.0, 0.0),
            Influence::Conical => (0.0, 1.0, -1.0 / horizon),
            _ => (0.0, 1.0, 0.0),
        };
        BondWeight {
            inverse,
            constant,
            slope,
            shape: match influence {
                Influence::Gaussian => Shape::Gaussian(1.0 / horizon),
                Influence::CubicSpline => Shape::Spline(1.0 / horizon),
                _ => Shape::One,
            },
            cut: scaling.map_or(1.0, |h| 0.5 + horizon / h),
            rate: scaling.map_or(0.0, |h| 1.0 / h),
        }
    }

    /// `ω ν` of bonds of these lengths.
    #[inline(always)]
    pub fn at<L: Lane>(&self, r0: L, inv_r0: L) -> L {
        let one = L::splat(1.0);
        let fraction = r0.fma(L::splat(-self.rate), L::splat(self.cut)).min(one);
        let omega = inv_r0.fma(
            L::splat(self.inverse),
            r0.fma(L::splat(self.slope), L::splat(self.constant)),
        );
        match self.shape {
            Shape::One => omega * fraction,
            Shape::Gaussian(inv) => gaussian(r0 * L::splat(inv)) * fraction,
            Shape::Spline(inv) => spline(r0 * L::splat(inv)) * fraction,
        }
    }
}

/// `exp(−4 q²)` for 0 ≤ q ≤ 1 as `e⁻² T(½ − q²)⁴` with the Taylor polynomial T of exp, fifteen terms on
/// [−½, ½]: multiplications only, hence the same bits in every width.
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

/// The cubic B-spline of [`Influence::CubicSpline`].
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
    use crate::family::volume_fraction;
    use crate::law::influence::influence;

    #[test]
    fn lanes_weigh_like_the_plain_formulas() {
        let (d, h) = (0.0031, 0.001);
        for kind in [
            Influence::Constant,
            Influence::Inverse,
            Influence::Conical,
            Influence::Gaussian,
            Influence::CubicSpline,
        ] {
            for scaling in [None, Some(h)] {
                let w = BondWeight::new(kind, d, scaling);
                for n in 1..=1000 {
                    let r = d * n as f64 / 1000.0;
                    let nu = scaling.map_or(1.0, |h| volume_fraction(r, d, h));
                    let exact = influence(kind, r, d) * nu;
                    let scale = influence(kind, 0.1 * d, d);
                    assert!(
                        (w.at(r, 1.0 / r) - exact).abs() <= 1e-15 * scale.max(exact),
                        "{kind:?} at {r}: {} is not {exact}",
                        w.at(r, 1.0 / r)
                    );
                }
            }
        }
    }
}
