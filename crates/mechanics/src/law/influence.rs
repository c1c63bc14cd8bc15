//! Influence functions ω(ξ): written once, for plain numbers and for lanes.
//!
//! One that knows directions need not be the same from both ends. State-based laws weigh with ω(ξ) at i and ω(−ξ) at j: action is reaction
//! whatever they are (sandia2010, Remark 3.0.2; ω₊ and ω₋ of Algorithm 2). A bond-based bond has one micromodulus: its pull is
//! `T[i]⟨ξ⟩ − T[j]⟨−ξ⟩` of `T⟨ξ⟩ = ½ c ω(ξ) s`, so that its ω is the mean of both.

use crate::execute::lane::{Lane, Piece, TILE};
use crate::spec::{Formula, Influence};

/// ω for one horizon δ. Multiplications only (and `1/r` as given), hence the same bits in every width; expressions are evaluated number by
/// number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfluenceFunction {
    kind: Influence,
    /// δ and 1/δ
    horizon: f64,
    inv_horizon: f64,
    /// Is it the mean of both ends?
    mean: bool,
}

impl InfluenceFunction {
    pub fn new(kind: Influence, horizon: f64) -> Self {
        InfluenceFunction {
            kind,
            horizon,
            inv_horizon: 1.0 / horizon,
            mean: false,
        }
    }

    /// `½ (ω(ξ) + ω(−ξ))` of this.
    pub fn mean(self) -> Self {
        InfluenceFunction { mean: true, ..self }
    }

    /// Is ω(ξ) another than ω(−ξ)?
    #[inline(always)]
    pub fn is_directed(&self) -> bool {
        !self.mean && self.kind.is_directed()
    }

    /// What it is, and for which horizon (length).
    pub fn kind(&self) -> (Influence, f64) {
        (self.kind, self.horizon)
    }

    /// Is it 1?
    #[inline(always)]
    pub fn is_constant(&self) -> bool {
        self.kind == Influence::Constant
    }

    /// Is it another one at another horizon?
    #[inline(always)]
    pub fn knows_horizon(&self) -> bool {
        self.kind.knows_horizon()
    }

    /// ω(ξ); `r` is |ξ| and `inv_r` is 1/r.
    #[inline(always)]
    pub fn at<L: Lane, const D: usize>(&self, xi: &[L; D], r: L, inv_r: L) -> L {
        let q = r * L::splat(self.inv_horizon);
        self.of(xi, r, inv_r, q, L::splat(self.horizon))
    }

    /// The same of points with another `horizon` (length): a bond that is longer, of which they hold a part of a cell, has ω at that.
    #[inline(always)]
    pub fn within<L: Lane, const D: usize>(&self, xi: &[L; D], r: L, inv_r: L, horizon: L) -> L {
        if !self.knows_horizon() {
            return self.at(xi, r, inv_r);
        }
        let one = L::splat(1.0);
        let part = (horizon * inv_r).min(one);
        let mut inside = *xi;
        for a in 0..D {
            inside[a] = xi[a] * part;
        }
        let q = r.div(horizon).min(one);
        self.of(&inside, r * part, inv_r, q, horizon)
    }

    /// `q` is r over the horizon.
    #[inline(always)]
    fn of<L: Lane, const D: usize>(&self, xi: &[L; D], r: L, inv_r: L, q: L, horizon: L) -> L {
        match self.kind {
            Influence::Constant => L::splat(1.0),
            Influence::Inverse => inv_r,
            Influence::Linear => L::splat(1.0) - q,
            Influence::Gaussian => L::out_of_line(Gaussian(q)),
            Influence::CubicSpline => L::out_of_line(CubicSpline(q)),
            Influence::Formula(formula) => L::out_of_line(Written {
                formula,
                horizon,
                mean: self.mean,
                xi: *xi,
                r,
            }),
        }
    }
}

/// ω(ξ) for a horizon δ; `r` is |ξ|.
pub fn influence<const D: usize>(kind: Influence, xi: &[f64; D], r: f64, horizon: f64) -> f64 {
    InfluenceFunction::new(kind, horizon).at(xi, r, 1.0 / r)
}

/// `½ (ω(ξ) + ω(−ξ))`
pub fn mean_influence<const D: usize>(kind: Influence, xi: &[f64; D], r: f64, horizon: f64) -> f64 {
    let function = InfluenceFunction::new(kind, horizon);
    function.mean().at(xi, r, 1.0 / r)
}

struct Written<L, const D: usize> {
    formula: Formula,
    horizon: L,
    mean: bool,
    xi: [L; D],
    r: L,
}

impl<L: Lane, const D: usize> Piece for Written<L, D> {
    type Out = L;
    #[inline(always)]
    fn run(self) -> L {
        let (r, horizon) = (self.r.to_array(), self.horizon.to_array());
        let mut xi = [[0.0; TILE]; 3];
        for a in 0..D {
            xi[a] = self.xi[a].to_array();
        }
        let both = self.mean && self.formula.is_directed();
        let mut all = [0.0; TILE];
        for l in 0..L::N {
            let of = [xi[0][l], xi[1][l], xi[2][l]];
            all[l] = self.formula.at(of, r[l], horizon[l]);
            if both {
                let back = [-of[0], -of[1], -of[2]];
                all[l] = 0.5 * (all[l] + self.formula.at(back, r[l], horizon[l]));
            }
        }
        // SAFETY: a number per lane
        unsafe { L::load(all.as_ptr()) }
    }
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
            Influence::Linear => 1.0 - q,
            Influence::Gaussian => (-4.0 * q * q).exp(),
            Influence::CubicSpline if q <= 0.5 => 1.0 - 6.0 * q * q + 6.0 * q * q * q,
            Influence::CubicSpline if q <= 1.0 => 2.0 * (1.0 - q).powi(3),
            Influence::CubicSpline => 0.0,
            Influence::Formula(_) => f64::NAN,
        }
    }

    #[test]
    fn every_function_is_what_is_printed() {
        let d = 0.0031;
        for kind in Influence::ALL {
            let largest = printed(kind, 0.1 * d, d);
            for n in 1..=1000 {
                let r = d * f64::from(n) / 1000.0;
                let (found, exact) = (influence(kind, &[r], r, d), printed(kind, r, d));
                assert!(
                    (found - exact).abs() <= 1e-15 * largest.max(exact),
                    "{kind:?} at {r}: {found} is not {exact}"
                );
            }
        }
    }

    /// The words as expressions, in lanes and one by one; and the two ends of a directed one.
    #[test]
    fn expressions_are_what_they_say() {
        let d = 0.0031;
        let words = [
            (Influence::Constant, "1"),
            (Influence::Inverse, "1/r"),
            (Influence::Linear, "1 - r/delta"),
            (Influence::Gaussian, "exp(-(2*r/delta)^2)"),
        ];
        for (word, text) in words {
            let written = Influence::Formula(Formula::parse(text, &[]).unwrap());
            assert!(!written.is_directed());
            for n in 1..=100 {
                let r = d * f64::from(n) / 100.0;
                let [found, exact] = [written, word].map(|k| influence(k, &[r], r, d));
                assert!((found - exact).abs() <= 2e-15 * (1.0 + exact), "{text} {r}");
            }
        }
        let upwind = Influence::Formula(Formula::parse("1 + xi_x/r", &[]).unwrap());
        assert!(upwind.is_directed());
        assert_eq!(influence(upwind, &[3.0, 4.0], 5.0, d), 1.6);
        assert_eq!(influence(upwind, &[-3.0, -4.0], 5.0, d), 0.4);
        assert_eq!(mean_influence(upwind, &[3.0, 4.0], 5.0, d), 1.0);
    }

    /// Of points with another horizon it is the function of that, and beyond it what that is at its end.
    #[test]
    fn points_of_another_horizon_have_its_function() {
        let (longest, own) = (0.0031, 0.0017);
        let written = |text| Influence::Formula(Formula::parse(text, &[]).unwrap());
        let all = [
            written("exp(-r/delta)"),
            written("(1 + 0.5*xi_x/r)*(1 - r/delta)"),
            written("1/r"),
        ];
        for kind in Influence::ALL.into_iter().chain(all) {
            let function = InfluenceFunction::new(kind, longest);
            for n in 1..=100 {
                let r = longest * f64::from(n) / 100.0;
                let xi = [0.6 * r, -0.8 * r];
                let found = function.within(&xi, r, 1.0 / r, own);
                let part = match kind.knows_horizon() && r > own {
                    true => own / r,
                    false => 1.0,
                };
                let inside = xi.map(|x| part * x);
                let exact = influence(kind, &inside, part * r, own);
                assert!(
                    (found - exact).abs() <= 4e-15 * (1.0 + exact.abs()),
                    "{kind:?} at {r}: {found:e} {exact:e}"
                );
            }
        }
    }

    /// One text is one formula, and another text or another constant another.
    #[test]
    fn formulas_are_equal_where_their_texts_are() {
        let of = |text, a| Formula::parse(text, &[("a", a)]).unwrap();
        assert_eq!(of("r^a", 2.0), of("r^a", 2.0));
        assert_ne!(of("r^a", 2.0), of("r^a", 3.0));
        assert_ne!(of("r^2", 2.0), of("r^a", 2.0));
    }
}
