//! Tables of a function at equal distances, as embedded-atom potentials come: piecewise cubics.
//!
//! Slopes at the knots are five-point differences (two- and three-point ones at the ends), pieces are cubic Hermite
//! polynomials: the interpolation of LAMMPS (`pair_style eam`), so that energies agree to round-off.

use crate::execute::lane::{Lane, TILE};

/// A function tabulated at `x_m = m Δ`, m = 1…n (in the order of the file; `first` shifts the whole).
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// `[n][4]`: coefficients of `p³, p², p, 1` on piece m, `p` the part of a step beyond knot m.
    pieces: Vec<[f64; 4]>,
    inverse: f64,
    /// In steps: where knot 0 is.
    first: f64,
    /// Beyond the last knot: the last value and slope go on (`true`), or the last value stays.
    linear: bool,
}

impl Spline {
    /// From values at `first + m step`, m = 0…n−1, n ≥ 5. Beyond the last knot the function goes on as a straight line if
    /// `linear`, else it keeps its last value; before the first it keeps the first.
    pub fn new(first: f64, step: f64, values: &[f64], linear: bool) -> Spline {
        let n = values.len();
        assert!(n >= 5, "a table needs five values");
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
            inverse: 1.0 / step,
            first: first / step,
            linear,
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
        let (m, p) = self.place(x);
        (self.pieces[m], p, self.inverse)
    }

    #[inline(always)]
    fn place(&self, x: f64) -> (usize, f64) {
        let p = x * self.inverse - self.first;
        let last = self.pieces.len() as f64 - 2.0;
        // not a number goes to the first piece and stays what it is
        let m = p.min(last).max(0.0).floor();
        let mut rest = p - m;
        if !self.linear {
            rest = rest.min(1.0);
        }
        if p < 0.0 {
            rest = 0.0;
        }
        if self.linear && rest > 1.0 {
            // the straight line is the last piece, whose cubic and square terms are 0
            return (m as usize + 1, rest - 1.0);
        }
        (m as usize, rest)
    }

    /// Value, first, second and third derivative.
    #[inline(always)]
    pub fn at(&self, x: f64) -> [f64; 4] {
        let (m, p) = self.place(x);
        let [c, b, a, v] = self.pieces[m];
        let i = self.inverse;
        [
            ((c * p + b) * p + a) * p + v,
            ((3.0 * c * p + 2.0 * b) * p + a) * i,
            (6.0 * c * p + 2.0 * b) * i * i,
            6.0 * c * i * i * i,
        ]
    }

    /// Values and slopes in all lanes.
    #[inline(always)]
    pub fn lanes<L: Lane>(&self, x: L) -> [L; 2] {
        let x = x.to_array();
        let (mut index, mut part) = ([0u32; TILE], [0.0; TILE]);
        for l in 0..L::N {
            let (m, p) = self.place(x[l]);
            (index[l], part[l]) = (m as u32, p);
        }
        // SAFETY: every index is below the number of pieces
        unsafe {
            let p = L::load(part.as_ptr());
            let [c, b, a, v] = L::gather4(self.pieces.as_ptr().cast(), index.as_ptr());
            let value = c.fma(p, b).fma(p, a).fma(p, v);
            let slope = (c * L::splat(3.0)).fma(p, b + b).fma(p, a);
            [value, slope * L::splat(self.inverse)]
        }
    }

    /// The same function with `x` and values scaled: `f₂(x) = value · f(x / length)`.
    pub fn scaled(&self, length: f64, value: f64) -> Spline {
        Spline {
            pieces: self.pieces.iter().map(|p| p.map(|c| c * value)).collect(),
            inverse: self.inverse / length,
            ..*self
        }
    }

    pub fn bytes(&self) -> usize {
        32 * self.pieces.len()
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
            let [v, d, ..] = spline.at(x);
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
