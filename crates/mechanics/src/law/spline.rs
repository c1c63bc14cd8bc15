//! Tables of a function at equal distances, as embedded-atom potentials come: piecewise cubics.
//!
//! Slopes at the knots are five-point differences (two- and three-point ones at the ends), pieces are cubic Hermite
//! polynomials: the interpolation of LAMMPS (`pair_style eam`), so that energies agree to round-off.

use crate::execute::lane::{Lane, TILE};

/// Where the knots of a table are: `first + m step`, m = 0 … n−1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knots {
    /// 1 / step
    inverse: f64,
    /// In steps: where knot 0 is.
    first: f64,
    /// Number of the last knot but one.
    last: f64,
    /// Beyond the last knot: a straight line (`true`), or the last value.
    linear: bool,
}

impl Knots {
    /// Knot below x, and the part of a step beyond it.
    #[inline(always)]
    fn place<L: Lane>(&self, x: L) -> (L, L) {
        let zero = L::splat(0.0);
        // not a number stays what it is, on piece 0
        let p = (x * L::splat(self.inverse) - L::splat(self.first)).max(zero);
        // of a whole number this may be the knot before: the pieces meet there
        let mut m = (p - L::splat(0.5)).round();
        m = m.max(zero).min(L::splat(self.last));
        let one = L::splat(1.0);
        let part = p - m;
        if self.linear {
            // the straight line is the piece after the last, whose cubic and square terms are 0
            let beyond = one.lt(part);
            (
                L::select(beyond, m + one, m),
                L::select(beyond, part - one, part),
            )
        } else {
            (m, part.min(one))
        }
    }
}

/// Whole numbers below 2³² as indices, times `stride`.
#[inline(always)]
fn indices<L: Lane>(m: L, stride: u32) -> [u32; TILE] {
    // the last bits of a number of this size count whole ones
    const WHOLE: f64 = 4503599627370496.0;
    let bits = (m + L::splat(WHOLE)).to_array();
    let mut index = [0; TILE];
    for l in 0..L::N {
        index[l] = bits[l].to_bits() as u32 * stride;
    }
    index
}

/// Value and slope of cubics in p.
#[inline(always)]
fn cubic<L: Lane>([c, b, a, v]: [L; 4], p: L, inverse: f64) -> [L; 2] {
    let value = c.fma(p, b).fma(p, a).fma(p, v);
    let slope = (c * L::splat(3.0)).fma(p, b + b).fma(p, a);
    [value, slope * L::splat(inverse)]
}

/// A tabulated function.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// `[n][4]`: coefficients of `p³, p², p, 1` on piece m, `p` the part of a step beyond knot m.
    pieces: Vec<[f64; 4]>,
    knots: Knots,
}

impl Spline {
    /// From values at `first + m step`, m = 0…n−1, n ≥ 5. Beyond the last knot the function goes on as a straight line if
    /// `linear`, else it keeps its last value; before the first it keeps the first.
    ///
    /// # Panics
    /// If there are fewer values, or the step is no positive number, or the first knot is nowhere.
    pub fn new(first: f64, step: f64, values: &[f64], linear: bool) -> Spline {
        let n = values.len();
        assert!(n >= 5, "a table needs five values");
        assert!(n < 1 << 30, "indices count with 32 bits");
        assert!(
            step > 0.0 && step.is_finite() && first.is_finite(),
            "a table needs a positive step and a first knot"
        );
        let f = |m: usize| values[m];
        let mut slope = vec![0.0; n];
        slope[0] = f(1) - f(0);
        slope[1] = 0.5 * (f(2) - f(0));
        slope[n - 2] = 0.5 * (f(n - 1) - f(n - 3));
        slope[n - 1] = f(n - 1) - f(n - 2);
        for m in 2..n - 2 {
            slope[m] = ((f(m - 2) - f(m + 2)) + 8.0 * (f(m + 1) - f(m - 1))) / 12.0;
        }
        let pieces = (0..n)
            .map(|m| {
                let (mut b, mut c) = (0.0, 0.0);
                if m + 1 < n {
                    let rise = f(m + 1) - f(m);
                    b = 3.0 * rise - 2.0 * slope[m] - slope[m + 1];
                    c = slope[m] + slope[m + 1] - 2.0 * rise;
                }
                [c, b, slope[m], f(m)]
            })
            .collect();
        Spline {
            pieces,
            knots: Knots {
                inverse: 1.0 / step,
                first: first / step,
                last: n as f64 - 2.0,
                linear,
            },
        }
    }

    /// Number of knots.
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Coefficients of the local cubic in the part of a step beyond its knot, that part, and 1/step: what any
    /// derivative is made of.
    pub fn piece(&self, x: f64) -> ([f64; 4], f64, f64) {
        let (m, p) = self.knots.place(x);
        (self.pieces[m as usize], p, self.knots.inverse)
    }

    /// Value and slope.
    #[inline(always)]
    pub fn at(&self, x: f64) -> [f64; 2] {
        let (m, p) = self.knots.place(x);
        cubic(self.pieces[m as usize], p, self.knots.inverse)
    }

    /// Values and slopes in all lanes.
    #[inline(always)]
    pub fn lanes<L: Lane>(&self, x: L) -> [L; 2] {
        let (m, p) = self.knots.place(x);
        let index = indices(m, 1);
        // SAFETY: every index is below the number of pieces
        let c = unsafe { L::gather4(self.pieces.as_ptr().cast(), index.as_ptr()) };
        cubic(c, p, self.knots.inverse)
    }

    /// The same function with `x` and values scaled: `f₂(x) = value · f(x / length)`.
    pub fn scaled(&self, length: f64, value: f64) -> Spline {
        Spline {
            pieces: self.pieces.iter().map(|p| p.map(|c| c * value)).collect(),
            knots: Knots {
                inverse: self.knots.inverse / length,
                ..self.knots
            },
        }
    }

    pub fn bytes(&self) -> usize {
        32 * self.pieces.len()
    }
}

/// Two functions on the same knots, side by side: one look-up for both.
#[derive(Debug, Clone, PartialEq)]
pub struct Twin {
    pieces: Vec<[[f64; 4]; 2]>,
    knots: Knots,
}

impl Twin {
    /// # Panics
    /// If the knots differ.
    pub fn new(first: &Spline, second: &Spline) -> Twin {
        assert!(first.knots == second.knots, "twins share their knots");
        Twin {
            pieces: first
                .pieces
                .iter()
                .zip(&second.pieces)
                .map(|(a, b)| [*a, *b])
                .collect(),
            knots: first.knots,
        }
    }

    /// One of the two as a table of its own.
    pub fn part(&self, n: usize) -> Spline {
        Spline {
            pieces: self.pieces.iter().map(|p| p[n]).collect(),
            knots: self.knots,
        }
    }

    /// Coefficients of both local cubics, the part of a step, and 1/step.
    pub fn piece(&self, x: f64) -> ([[f64; 4]; 2], f64, f64) {
        let (m, p) = self.knots.place(x);
        (self.pieces[m as usize], p, self.knots.inverse)
    }

    /// Values and slopes of both in all lanes.
    #[inline(always)]
    pub fn lanes<L: Lane>(&self, x: L) -> [[L; 2]; 2] {
        let (m, p) = self.knots.place(x);
        let index = indices(m, 2);
        // SAFETY: every index is below the number of pieces
        unsafe {
            let base: *const f64 = self.pieces.as_ptr().cast();
            let a = L::gather4(base, index.as_ptr());
            let b = L::gather4(base.add(4), index.as_ptr());
            [
                cubic(a, p, self.knots.inverse),
                cubic(b, p, self.knots.inverse),
            ]
        }
    }

    /// Values and slopes of one of the two in all lanes.
    ///
    /// # Panics
    /// If `n` is not 0 or 1.
    #[inline(always)]
    pub fn lanes_of<L: Lane>(&self, n: usize, x: L) -> [L; 2] {
        assert!(n < 2, "twins are two");
        let (m, p) = self.knots.place(x);
        let index = indices(m, 2);
        // SAFETY: every index is below the number of pieces
        unsafe {
            let base: *const f64 = self.pieces.as_ptr().cast();
            cubic(
                L::gather4(base.add(4 * n), index.as_ptr()),
                p,
                self.knots.inverse,
            )
        }
    }

    pub fn bytes(&self) -> usize {
        64 * self.pieces.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_reproduced_inside_and_lanes_agree() {
        let f = |x: f64| 2.0 - x + 0.5 * x * x - 0.1 * x * x * x;
        let values: Vec<f64> = (0..40).map(|m| f(0.3 + 0.1 * m as f64)).collect();
        let spline = Spline::new(0.3, 0.1, &values, false);
        for k in 0..300 {
            let x = 0.5 + 0.011 * k as f64;
            let [v, d] = spline.at(x);
            assert_eq!(
                spline.lanes(x).map(|y| (y * 1e12).round()),
                [v, d].map(|y| (y * 1e12).round())
            );
            if x < 3.9 {
                assert!((v - f(x)).abs() < 1e-13, "{x}");
                assert!((d - (-1.0 + x - 0.3 * x * x)).abs() < 1e-12, "{x}");
            }
        }
    }

    #[test]
    fn beyond_the_ends() {
        let values: Vec<f64> = (0..10).map(|m| (m * m) as f64).collect();
        let line = Spline::new(0.0, 1.0, &values, true);
        let flat = Spline::new(0.0, 1.0, &values, false);
        assert_eq!(line.at(11.0)[0], 81.0 + 2.0 * 17.0);
        assert_eq!(flat.at(11.0)[0], 81.0);
        assert_eq!(line.at(-3.0)[0], 0.0);
    }
}
