//! Localization functions φ: how much a particle counts at a distance. All are normalised, `∫φ = 1`, in closed form.
//!
//! With the distance r, the width S and the number D of dimensions:
//!
//! | shape | φ | 0 beyond |
//! |---|---|---|
//! | polynomial of smoothness n | `c (1 − r²/S²)ⁿ`; n − 1 derivatives are continuous; n = 0 is a step | S |
//! | cubic spline | `c [(2 − q)³ − 4 (1 − q)₊³]`, q = 2r/S | S |
//! | quartic spline | `c [(5/2 − q)⁴ − 5 (3/2 − q)₊⁴ + 10 (1/2 − q)₊⁴]`, q = 5r/(2S) | S |
//! | Gaussian | `c exp(−r²/(2S²))` | 8 S, where it is 1.3e-14 of its peak |
//! | cell | `c` in a cube of edge S with edges along the axes | S/2 along each axis |
//!
//! An axis may be averaged over: distances along it do not count, and φ is divided by the extent of the frame there. So one
//! axis left is a profile, two are a plane of that thickness.

use crate::FieldsError;
use std::f64::consts::PI;

/// Which function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Of this smoothness, 0 to [`Shape::SMOOTHEST`].
    Polynomial(u32),
    CubicSpline,
    QuarticSpline,
    Gaussian,
    Cell,
}

/// Widths at which a Gaussian ends.
pub const GAUSSIAN_END: f64 = 8.0;

impl Shape {
    /// Highest smoothness of a polynomial.
    pub const SMOOTHEST: u32 = 7;

    pub fn name(self) -> &'static str {
        match self {
            Shape::Polynomial(0) => "step",
            Shape::Polynomial(_) => "polynomial",
            Shape::CubicSpline => "bspline",
            Shape::QuarticSpline => "quartic bspline",
            Shape::Gaussian => "gaussian",
            Shape::Cell => "cell",
        }
    }

    /// The formula, with the width S.
    pub fn formula(self) -> String {
        match self {
            Shape::Polynomial(0) => "c for r < S".into(),
            Shape::Polynomial(n) => format!("c (1 - r^2/S^2)^{n} for r < S"),
            Shape::CubicSpline => "c [(2 - q)^3 - 4 max(1 - q, 0)^3], q = 2 r/S < 2".into(),
            Shape::QuarticSpline => {
                "c [(5/2 - q)^4 - 5 max(3/2 - q, 0)^4 + 10 max(1/2 - q, 0)^4], q = 5 r/(2 S) < 5/2"
                    .into()
            }
            Shape::Gaussian => "c exp(-r^2/(2 S^2)) for r < 8 S".into(),
            Shape::Cell => "c where |x|, |y|, |z| < S/2".into(),
        }
    }
}

/// A truncated power `factor (radius − r)₊^power`, of which splines are sums.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Power {
    pub factor: f64,
    pub radius: f64,
}

/// A localization function.
#[derive(Debug, Clone, PartialEq)]
pub struct Kernel {
    shape: Shape,
    width: f64,
    /// Extent of the frame along axes that are averaged over (length).
    averaged: [Option<f64>; 3],
    /// c, over the extents (1 / volume).
    pub(crate) norm: f64,
    /// Distance beyond which φ is 0 (length).
    radius: f64,
    /// 1 for axes that count, else 0.
    pub(crate) counts: [f64; 3],
    /// Of splines.
    pub(crate) powers: Vec<Power>,
}

impl Kernel {
    /// In three dimensions.
    ///
    /// # Errors
    /// The width is not positive, or a polynomial of a smoothness that there is not.
    pub fn new(shape: Shape, width: f64) -> Result<Kernel, FieldsError> {
        Self::averaged(shape, width, [None; 3])
    }

    /// The same, averaged over axes with these extents.
    ///
    /// # Errors
    /// As [`Kernel::new`]; an extent is not positive, or no axis is left.
    pub fn averaged(
        shape: Shape,
        width: f64,
        averaged: [Option<f64>; 3],
    ) -> Result<Kernel, FieldsError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        if !positive(width) {
            return Err(FieldsError(format!(
                "the width of the localization function is {width}: it must be positive"
            )));
        }
        if let Shape::Polynomial(n) = shape
            && n > Shape::SMOOTHEST
        {
            return Err(FieldsError(format!(
                "polynomials have a smoothness of 0 to {}, not {n}",
                Shape::SMOOTHEST
            )));
        }
        if averaged.iter().flatten().any(|e| !positive(*e)) {
            return Err(FieldsError(
                "an axis that is averaged over has no extent: give the frame a box there".into(),
            ));
        }
        let dimension = averaged.iter().filter(|a| a.is_none()).count();
        if dimension == 0 {
            return Err(FieldsError("all three axes are averaged over".into()));
        }
        let scale = match shape {
            Shape::Polynomial(_) | Shape::Gaussian | Shape::Cell => width,
            Shape::CubicSpline => width / 2.0,
            Shape::QuarticSpline => width / 2.5,
        };
        let extents: f64 = averaged.iter().flatten().product();
        let norm = constant(shape, dimension) / (scale.powi(dimension as i32) * extents);
        let power = |factor: f64, radius: f64, n: i32| Power {
            factor: factor / scale.powi(n),
            radius: radius * scale,
        };
        let powers = match shape {
            Shape::CubicSpline => vec![power(1.0, 2.0, 3), power(-4.0, 1.0, 3)],
            Shape::QuarticSpline => {
                vec![power(1.0, 2.5, 4), power(-5.0, 1.5, 4), power(10.0, 0.5, 4)]
            }
            Shape::Polynomial(_) | Shape::Gaussian | Shape::Cell => vec![],
        };
        Ok(Kernel {
            shape,
            width,
            averaged,
            norm,
            radius: match shape {
                Shape::Gaussian => GAUSSIAN_END * width,
                Shape::Cell => 0.5 * width * (dimension as f64).sqrt(),
                Shape::Polynomial(_) | Shape::CubicSpline | Shape::QuarticSpline => width,
            },
            counts: averaged.map(|a| if a.is_none() { 1.0 } else { 0.0 }),
            powers,
        })
    }

    pub fn shape(&self) -> Shape {
        self.shape
    }

    pub fn width(&self) -> f64 {
        self.width
    }

    /// Distance beyond which φ is 0 (length).
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Extent of each axis that is averaged over.
    pub fn averaged_axes(&self) -> [Option<f64>; 3] {
        self.averaged
    }

    /// Is φ's gradient continuous, so that balance laws hold at every point?
    pub fn is_smooth(&self) -> bool {
        match self.shape {
            Shape::Polynomial(n) => n >= 2,
            Shape::CubicSpline | Shape::QuarticSpline | Shape::Gaussian => true,
            Shape::Cell => false,
        }
    }

    /// The part of a vector that counts.
    pub(crate) fn project(&self, d: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|a| d[a] * self.counts[a])
    }

    /// φ (1 / volume) at `d = x − x_j`.
    pub fn value(&self, d: [f64; 3]) -> f64 {
        let d = self.project(d);
        let q = dot(d, d);
        let radius = self.radius * self.radius;
        if let Shape::Cell = self.shape {
            return if self.in_cell(d) { self.norm } else { 0.0 };
        }
        if q >= radius {
            return 0.0;
        }
        self.norm
            * match self.shape {
                Shape::Polynomial(n) => (1.0 - q / radius).powi(n as i32),
                Shape::CubicSpline => self.spline(q.sqrt(), 3),
                Shape::QuarticSpline => self.spline(q.sqrt(), 4),
                Shape::Gaussian => libm::exp(-0.5 * q / (self.width * self.width)),
                Shape::Cell => 0.0,
            }
    }

    /// ∇φ (1 / volume / length) at `d = x − x_j`; 0 at the jumps of steps and cells.
    pub fn gradient(&self, d: [f64; 3]) -> [f64; 3] {
        let d = self.project(d);
        let q = dot(d, d);
        let radius = self.radius * self.radius;
        if q >= radius {
            return [0.0; 3];
        }
        // slope over r
        let slope = match self.shape {
            Shape::Polynomial(0) | Shape::Cell => 0.0,
            Shape::Polynomial(n) => {
                -2.0 * f64::from(n) / radius * (1.0 - q / radius).powi(n as i32 - 1)
            }
            Shape::CubicSpline => self.spline_slope(q.sqrt(), 3),
            Shape::QuarticSpline => self.spline_slope(q.sqrt(), 4),
            Shape::Gaussian => {
                let w = self.width * self.width;
                -libm::exp(-0.5 * q / w) / w
            }
        };
        d.map(|c| c * slope * self.norm)
    }

    pub(crate) fn in_cell(&self, d: [f64; 3]) -> bool {
        // half open, so that cells side by side count every particle once
        let half = 0.5 * self.width;
        d.iter().all(|c| *c > -half && *c <= half)
    }

    fn spline(&self, r: f64, n: i32) -> f64 {
        let inside = self.powers.iter().filter(|p| r < p.radius);
        inside.map(|p| p.factor * (p.radius - r).powi(n)).sum()
    }

    fn spline_slope(&self, r: f64, n: i32) -> f64 {
        if r == 0.0 {
            return 0.0;
        }
        let inside = self.powers.iter().filter(|p| r < p.radius);
        let slope: f64 = inside
            .map(|p| -f64::from(n) * p.factor * (p.radius - r).powi(n - 1))
            .sum();
        slope / r
    }
}

/// c of a shape whose scale is 1.
fn constant(shape: Shape, dimension: usize) -> f64 {
    match shape {
        // ∫₀¹ s^(D−1) (1 − s²)ⁿ ds = Π 2k / (D Π (2k + D)), times the surface of the unit ball
        Shape::Polynomial(n) => {
            let d = dimension as f64;
            let surface = [2.0, 2.0 * PI, 4.0 * PI][dimension - 1];
            let ratio: f64 = (1..=n)
                .map(|k| (2.0 * f64::from(k) + d) / (2.0 * f64::from(k)))
                .product();
            d * ratio / surface
        }
        Shape::CubicSpline => [1.0 / 6.0, 5.0 / (14.0 * PI), 1.0 / (4.0 * PI)][dimension - 1],
        Shape::QuarticSpline => {
            [1.0 / 24.0, 96.0 / (1199.0 * PI), 1.0 / (20.0 * PI)][dimension - 1]
        }
        Shape::Gaussian => {
            let end = libm::exp(-0.5 * GAUSSIAN_END * GAUSSIAN_END);
            // what lies beyond the end; of one dimension 1e-15
            let beyond = [0.0, end, (2.0 / PI).sqrt() * GAUSSIAN_END * end][dimension - 1];
            libm::pow(2.0 * PI, -0.5 * dimension as f64) / (1.0 - beyond)
        }
        Shape::Cell => 1.0,
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    pub const ALL: [Shape; 8] = [
        Shape::Polynomial(0),
        Shape::Polynomial(1),
        Shape::Polynomial(3),
        Shape::Polynomial(7),
        Shape::CubicSpline,
        Shape::QuarticSpline,
        Shape::Gaussian,
        Shape::Cell,
    ];

    /// Simpson's rule over the radius, times the surface of the sphere.
    #[test]
    fn all_are_normalised_in_one_two_and_three_dimensions() {
        for shape in ALL {
            for d in 1..=3usize {
                let extents = std::array::from_fn(|a| (a >= d).then_some(2.0 + a as f64));
                let volume: f64 = extents.iter().flatten().product();
                let kernel = Kernel::averaged(shape, 1.3, extents).unwrap();
                let sum = if shape == Shape::Cell {
                    kernel.value([0.1, 0.0, 50.0 * f64::from(d < 3)]) * 1.3f64.powi(d as i32)
                } else {
                    // a whole number of intervals for each piece of a spline
                    let n = 400_000;
                    let step = kernel.radius() / f64::from(n);
                    let f = |k: i32| {
                        let r = step * f64::from(k) * (1.0 - 1e-15);
                        kernel.value([r, 0.0, 0.0]) * [2.0, 2.0 * PI * r, 4.0 * PI * r * r][d - 1]
                    };
                    let inner: f64 = (1..n)
                        .map(|k| f(k) * if k % 2 == 1 { 4.0 } else { 2.0 })
                        .sum();
                    (f(0) + inner + f(n)) * step / 3.0
                };
                let error = (sum * volume - 1.0).abs();
                assert!(error < 1e-10, "{shape:?} {d}: {error:e}");
            }
        }
    }

    #[test]
    fn gradients_are_slopes() {
        for shape in ALL.into_iter().filter(|s| *s != Shape::Cell) {
            let kernel = Kernel::new(shape, 1.3).unwrap();
            let x = [0.3, -0.4, 0.2];
            let gradient = kernel.gradient(x);
            for a in 0..3 {
                let at = |h: f64| {
                    let mut y = x;
                    y[a] += h;
                    kernel.value(y)
                };
                let h = 1e-3;
                let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
                assert!(
                    (slope - gradient[a]).abs() < 1e-8,
                    "{shape:?}: {slope} {gradient:?}"
                );
            }
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        assert!(Kernel::new(Shape::Gaussian, 0.0).is_err());
        assert!(Kernel::new(Shape::Gaussian, f64::NAN).is_err());
        assert!(Kernel::new(Shape::Polynomial(8), 1.0).is_err());
        assert!(Kernel::averaged(Shape::Cell, 1.0, [Some(1.0); 3]).is_err());
        assert!(Kernel::averaged(Shape::Cell, 1.0, [Some(0.0), None, None]).is_err());
    }
}
