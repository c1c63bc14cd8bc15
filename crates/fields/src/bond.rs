//! The bond function `β_jk(x) = ∫₀¹ φ(x − λ x_j − (1 − λ) x_k) dλ` (4.0.81): how much of a bond counts at a point.
//!
//! Along a bond the squared distance from the point is `p² + ℓ²(λ − λ₀)²` with the distance p of its line, so β is an integral over
//! the part of the bond that lies in the ball of φ:
//! - polynomials of smoothness n are polynomials of degree 2n there: with the middle m and the half length h of what is inside,
//!   `1 − r²/S² = A − B s² − E s`, `A = 1 − (p² + ℓ²m²)/S²`, `B = ℓ²h²/S²`, `E = 2ℓ²mh/S²`, −1 < s < 1, whose powers have the means
//!   `Σ n!/((n−2k−j)! j! (2k)!) A^(n−2k−j) (−B)^j E^2k/(2j + 2k + 1)`;
//! - splines are powers of the distance, whose integrals are elementary (`asinh`);
//! - the Gaussian gives error functions; steps and cells the length of what is inside.
//!
//! Nothing is approximated: what is left is round-off, below 1e-12 of the peak of φ for bonds not shorter than 1e-3 widths. In
//! Fourier space `β̂ = φ̂ (e^{ik·x_j} − e^{ik·x_k}) / (i k·x_jk)` (4.0.90), which a test shows; a φ much wider than the bond leaves
//! `β = φ`, in the limit 1/V, the virial's.

use crate::gauss;
use crate::kernel::{GAUSSIAN_END, Kernel, Shape, dot};
use crate::patch::{EIGHT, Lanes};
use crate::polynomial;
use crate::scalars::Scalars;
use crate::segment::{Segment, View};
use crate::segments::Segments;
use crate::spline;
use crate::wide::widest;

widest!(
    /// β (1 / volume) of a bond at several points: columns x, y, z of the vectors to them from the end k, all 0 along axes that are
    /// averaged over; `bond` is from k to the end j. All are as long as `out`.
    pub bonds, (kernel: &Kernel, d: [&[f64]; 3], bond: [f64; 3], out: &mut [f64]) -> (), at_points
);

#[inline(always)]
fn at_points(kernel: &Kernel, d: [&[f64]; 3], bond: [f64; 3], out: &mut [f64]) {
    let mut segments = Segments::default();
    segments.begin(kernel);
    segments.add(kernel, [0.0; 3], kernel.project(bond));
    let mut first = 0;
    while first < out.len() {
        let count = EIGHT.min(out.len() - first);
        let mut x = [Lanes::ZERO; 3];
        for a in 0..3 {
            let from = &d[a][first..];
            match from.first_chunk::<EIGHT>() {
                Some(eight) => x[a] = Lanes(*eight),
                None => {
                    for k in 0..count {
                        x[a][k] = from[k];
                    }
                }
            }
        }
        let view = View::new(&x, [0.0; 3], segments.over());
        let mut beta = [Lanes::ZERO];
        segments.beta(kernel, &view, &[0], &mut beta);
        for k in 0..count {
            out[first + k] = segments.factor[0] * beta[0][k];
        }
        first += EIGHT;
    }
}

impl Kernel {
    /// β (1 / volume) at a point: from the end k to the point, and from k to the end j.
    pub fn bond(&self, d: [f64; 3], bond: [f64; 3]) -> f64 {
        let (d, bond) = (self.project(d), self.project(bond));
        let over = 1.0 / self.radius();
        let of = Segment::new([0.0; 3], bond, over);
        let scalars = Scalars(self);
        if scalars.wanted(of.length) {
            return scalars.at_point(d, bond, over);
        }
        let foot = of.seen(d.map(|c| c * over));
        let found = match self.shape() {
            Shape::Polynomial(n) => polynomial::at_point(n, foot, of.length),
            Shape::CubicSpline => spline::at_point::<3>(self, foot, of.length),
            Shape::QuarticSpline => spline::at_point::<4>(self, foot, of.length),
            Shape::Gaussian | Shape::Cell => gauss::at_point(foot, of.length),
        };
        found * self.norm / of.length
    }

    /// φ at several points, from columns of the vectors to them.
    #[inline(always)]
    pub(crate) fn values(&self, d: &[Lanes; 3], out: &mut Lanes) {
        let [x, y, z] = d;
        let over = 1.0 / (self.radius() * self.radius());
        match self.shape() {
            Shape::Polynomial(power) => {
                for n in 0..EIGHT {
                    let q = x[n].mul_add(x[n], y[n].mul_add(y[n], z[n] * z[n]));
                    let rest = (-q).mul_add(over, 1.0);
                    let mut value = self.norm;
                    for _ in 0..power {
                        value *= rest;
                    }
                    out[n] = if rest > 0.0 { value } else { 0.0 };
                }
            }
            Shape::CubicSpline | Shape::QuarticSpline | Shape::Gaussian | Shape::Cell => {
                for n in 0..EIGHT {
                    out[n] = self.value([x[n], y[n], z[n]]);
                }
            }
        }
    }
}

impl Kernel {
    /// β of a bond of a Gaussian, without its factor.
    pub(crate) fn gaussian_part(&self, d: [f64; 3], bond: [f64; 3]) -> f64 {
        let width = self.width();
        let length = dot(bond, bond);
        let foot = dot(d, bond) / length;
        let across: [f64; 3] = std::array::from_fn(|a| d[a] - foot * bond[a]);
        let square = dot(across, across);
        let rest = GAUSSIAN_END * GAUSSIAN_END * width * width - square;
        if rest <= 0.0 {
            return 0.0;
        }
        let half = (rest / length).sqrt();
        let (low, high) = ((foot - half).max(0.0), (foot + half).min(1.0));
        if low >= high {
            return 0.0;
        }
        let length = length.sqrt();
        let unit = std::f64::consts::SQRT_2 * width;
        let [low, high] = [low, high].map(|l| length * (l - foot) / unit);
        let across = libm::exp(-0.5 * square / (width * width));
        let part = 0.5 * std::f64::consts::PI.sqrt() * erf_between(low, high);
        across * part * unit / length
    }

    pub(crate) fn cell_part(&self, d: [f64; 3], bond: [f64; 3]) -> f64 {
        let (mut low, mut high) = (0.0f64, 1.0f64);
        let half = 0.5 * self.width();
        for a in 0..3 {
            let d = d[a];
            if bond[a] == 0.0 {
                if !(d > -half && d <= half) {
                    return 0.0;
                }
                continue;
            }
            let ends = [(d - half) / bond[a], (d + half) / bond[a]];
            low = low.max(ends[0].min(ends[1]));
            high = high.min(ends[0].max(ends[1]));
        }
        self.norm * (high - low).max(0.0)
    }
}

/// `erf(b) − erf(a)`, a ≤ b, to a few units of the last digit of what is larger, of both tails too.
fn erf_between(a: f64, b: f64) -> f64 {
    use libm::{erf, erfc};
    if a > 0.5 {
        erfc(a) - erfc(b)
    } else if b < -0.5 {
        erfc(-b) - erfc(-a)
    } else {
        erf(b) - erf(a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Shape; 7] = [
        Shape::Polynomial(1),
        Shape::Polynomial(2),
        Shape::Polynomial(3),
        Shape::Polynomial(7),
        Shape::CubicSpline,
        Shape::QuarticSpline,
        Shape::Gaussian,
    ];

    fn points() -> Vec<([f64; 3], [f64; 3])> {
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        };
        let mut all: Vec<_> = (0..40)
            .map(|k| {
                let size = [0.01, 0.5, 2.0, 4.0][k % 4];
                let d = [random() * 1.2, random() * 1.2, random() * 1.2];
                (d, [random() * size, random() * size, random() * size])
            })
            .collect();
        // on the line of the bond, and at an end
        all.push(([0.2, 0.0, 0.0], [1.5, 0.0, 0.0]));
        all.push(([0.0, 0.0, 0.0], [0.3, 0.4, 0.0]));
        all
    }

    /// Nodes and weights of Gauss's rule on [0, 1] with n points.
    fn gauss(n: usize) -> Vec<[f64; 2]> {
        let m = n as f64;
        let mut rule = vec![];
        for k in 0..n {
            let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (m + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut before, mut value) = (1.0, x);
                for j in 2..=n {
                    let j = j as f64;
                    (before, value) = (
                        value,
                        ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j,
                    );
                }
                slope = m * (x * value - before) / (x * x - 1.0);
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-16 {
                    break;
                }
            }
            rule.push([0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)]);
        }
        rule
    }

    /// Gauss's rule on many pieces.
    fn quadrature(kernel: &Kernel, d: [f64; 3], bond: [f64; 3], pieces: usize) -> f64 {
        let rule = gauss(8);
        let mut sum = 0.0;
        for k in 0..pieces {
            for [node, weight] in &rule {
                let l = (k as f64 + node) / pieces as f64;
                sum += weight * kernel.value(std::array::from_fn(|a| d[a] - l * bond[a]));
            }
        }
        sum / pieces as f64
    }

    #[test]
    fn closed_forms_are_what_quadrature_gives() {
        for shape in ALL {
            for averaged in [[None; 3], [None, None, Some(2.0)]] {
                let kernel = Kernel::averaged(
                    shape,
                    if shape == Shape::Gaussian { 0.3 } else { 1.1 },
                    averaged,
                )
                .unwrap();
                let peak = kernel.value([0.0; 3]);
                for (d, bond) in points() {
                    let closed = kernel.bond(d, bond);
                    let error = (closed - quadrature(&kernel, d, bond, 2000)).abs() / peak;
                    // the kinks of the flattest polynomial are what quadrature misses
                    let bound = if shape == Shape::Polynomial(1) {
                        1e-7
                    } else {
                        2e-12
                    };
                    assert!(error < bound, "{shape:?} {d:?} {bond:?}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn steps_and_cells_take_the_length_inside() {
        for (shape, inside) in [(Shape::Polynomial(0), 0.5), (Shape::Cell, 0.25)] {
            let kernel = Kernel::new(shape, 1.0).unwrap();
            let beta = kernel.bond([0.0; 3], [2.0, 0.0, 0.0]);
            assert!((beta - inside * kernel.value([0.0; 3])).abs() < 1e-15);
        }
    }

    /// `φ_j − φ_k = −∇·(x_jk β)`: what stress and heat flux rest on.
    #[test]
    fn the_divergence_of_a_bond_is_the_difference_of_its_ends() {
        for shape in ALL.into_iter().filter(|s| *s != Shape::Polynomial(1)) {
            let kernel =
                Kernel::new(shape, if shape == Shape::Gaussian { 0.4 } else { 1.1 }).unwrap();
            let peak = kernel.value([0.0; 3]);
            for (d, bond) in points() {
                let along = |h: f64| -> f64 {
                    let y = std::array::from_fn(|a| d[a] + h * bond[a]);
                    kernel.bond(y, bond)
                };
                // x_jk·∇β is the slope along the bond
                let h = 2e-4;
                let slope = (8.0 * (along(h) - along(-h)) - (along(2.0 * h) - along(-2.0 * h)))
                    / (12.0 * h);
                let far: [f64; 3] = std::array::from_fn(|a| d[a] - bond[a]);
                let ends = kernel.value(far) - kernel.value(d);
                let error = (ends + slope).abs() / peak;
                assert!(error < 2e-6, "{shape:?} {d:?} {bond:?}: {error:e}");
                // the other sign is wrong by far more wherever there is anything
                assert!(ends.abs() < 1e-3 * peak || (ends - slope).abs() / peak > 1e-3);
            }
        }
    }

    /// `∫β = 1`, by the rectangle rule, which is as exact as φ is smooth; and (4.0.90) at three wave vectors.
    #[test]
    fn a_bond_counts_once_and_has_the_spectrum_of_the_book() {
        for (shape, width, bound) in [
            (Shape::Gaussian, 0.35, 1e-9),
            (Shape::Polynomial(7), 1.5, 1e-6),
            (Shape::Polynomial(3), 1.2, 2e-4),
            (Shape::CubicSpline, 1.4, 2e-4),
            (Shape::QuarticSpline, 1.4, 2e-4),
        ] {
            let kernel = Kernel::new(shape, width).unwrap();
            let bond = [0.7, -0.4, 0.5];
            let (low, n, h) = (-4.0, 40, 0.2);
            let waves = [[0.0; 3], [0.9, 0.2, -0.4], [-0.3, 1.1, 0.6]];
            let mut spectrum = [[[0.0; 2]; 3]; 2];
            for i in 0..n * n * n {
                let x: [f64; 3] = [i / (n * n), i / n % n, i % n].map(|k| low + h * k as f64);
                // k at the origin, j at the end of the bond
                let values = [kernel.value(x), kernel.bond(x, bond)];
                for (s, value) in values.into_iter().enumerate() {
                    for (w, k) in waves.iter().enumerate() {
                        let phase = dot(*k, x);
                        spectrum[s][w][0] += value * phase.cos() * h * h * h;
                        spectrum[s][w][1] += value * phase.sin() * h * h * h;
                    }
                }
            }
            for (w, k) in waves.iter().enumerate() {
                let phase = dot(*k, bond);
                // (e^{iθ} − 1)/(iθ), real and imaginary
                let factor = match w {
                    0 => [1.0, 0.0],
                    _ => [phase.sin() / phase, (1.0 - phase.cos()) / phase],
                };
                let phi = spectrum[0][w];
                let expected = [
                    phi[0] * factor[0] - phi[1] * factor[1],
                    phi[0] * factor[1] + phi[1] * factor[0],
                ];
                for c in 0..2 {
                    let error = (spectrum[1][w][c] - expected[c]).abs();
                    assert!(error < bound, "{shape:?} {w} {c}: {error:e}");
                }
            }
            assert!((spectrum[1][0][0] - 1.0).abs() < bound);
        }
    }

    /// A φ much wider than the bond sees a point: β − φ(middle) falls as S⁻² of φ.
    #[test]
    fn wide_functions_leave_the_virial() {
        let bond = [0.6, 0.3, -0.2];
        let d = [0.8, 0.1, 0.3];
        let error = |width: f64| {
            let kernel = Kernel::new(Shape::Gaussian, width).unwrap();
            kernel.bond(d, bond) / kernel.value([0.0; 3]) - 1.0
        };
        let order = (error(20.0) / error(40.0)).log2();
        assert!((order - 2.0).abs() < 0.05, "{order}");
    }

    #[test]
    fn error_functions_are_right() {
        // Abramowitz & Stegun, table 7.1, and erfc(3) of the continued fraction's tables
        for (b, value) in [
            (0.5, 0.520_499_877_813_046_5),
            (1.0, 0.842_700_792_949_714_9),
            (2.0, 0.995_322_265_018_952_7),
        ] {
            let of = erf_between(0.0, b);
            assert!((of - value).abs() < 2e-16, "{b}: {of}");
        }
        for tail in [erf_between(3.0, 30.0), erf_between(-30.0, -3.0)] {
            assert!((tail / 2.209_049_699_858_544e-5 - 1.0).abs() < 1e-13);
        }
    }
}
