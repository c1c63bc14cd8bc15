//! Dispersion in one dimension: finite sums of a chain, and the spring integral in closed form.

use crate::gradient::linear::LinearChain;
use num_complex::Complex64;

impl LinearChain<f64> {
    /// ω² of wave number k, for points of mass ρΔx.
    pub fn squared(&self, k: f64, density: f64) -> f64 {
        self.at(k)[0] / (density * self.spacing)
    }

    /// ω, `None` if imaginary.
    pub fn frequency(&self, k: f64, density: f64) -> Option<f64> {
        let w = self.squared(k, density);
        (w >= 0.0).then(|| w.sqrt())
    }

    /// ω/k; the long-wave speed at k = 0.
    pub fn phase_velocity(&self, k: f64, density: f64) -> Option<f64> {
        if k == 0.0 {
            let c = self.coefficients(1)[0] / density;
            return (c >= 0.0).then(|| c.sqrt());
        }
        Some(self.frequency(k, density)? / k)
    }

    /// dω/dk; the long-wave speed at k = 0.
    pub fn group_velocity(&self, k: f64, density: f64) -> Option<f64> {
        match self.frequency(k, density)? {
            w if w > 0.0 => Some(self.at(k)[1] / (density * self.spacing) / (2.0 * w)),
            _ => self.phase_velocity(0.0, density),
        }
    }

    /// mω² and its first two derivatives by k. Versines are 2 sin²(x/2): no cancellation in long waves.
    pub(crate) fn at(&self, k: f64) -> [f64; 3] {
        let (mut w, mut g) = ([0.0; 3], [0.0; 3]);
        for (j, stiffness) in self.stiffness.iter().enumerate() {
            let x = (j + 1) as f64 * self.spacing;
            let (sin, cos) = libm::sincos(k * x);
            w[0] += 4.0 * stiffness * libm::sin(0.5 * k * x).powi(2);
            w[1] += 2.0 * stiffness * x * sin;
            w[2] += 2.0 * stiffness * x * x * cos;
        }
        for (j, share) in self.share.iter().enumerate() {
            let x = (j + 1) as f64 * self.spacing;
            let (sin, cos) = libm::sincos(k * x);
            g[0] += 2.0 * share * sin;
            g[1] += 2.0 * share * x * cos;
            g[2] -= 2.0 * share * x * x * sin;
        }
        let f = self.curvature;
        [
            w[0] + f * g[0] * g[0],
            w[1] + 2.0 * f * g[0] * g[1],
            w[2] + 2.0 * f * (g[1] * g[1] + g[0] * g[2]),
        ]
    }
}

/// The integral of springs (seleson2009 (4.3)): `ω = √(K₁/ρ) √(4 Cin(kδ))/δ`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringContinuum {
    pub k1: f64,
    pub density: f64,
    pub horizon: f64,
}

impl SpringContinuum {
    pub fn frequency(&self, k: f64) -> f64 {
        (self.k1 / self.density * 4.0 * cin(k * self.horizon)).sqrt() / self.horizon
    }

    pub fn phase_velocity(&self, k: f64) -> f64 {
        if k == 0.0 {
            (self.k1 / self.density).sqrt()
        } else {
            self.frequency(k) / k.abs()
        }
    }

    /// `dω/dk = (K₁/ρ)(2/δ²) (1 − cos kδ)/(kω)`
    pub fn group_velocity(&self, k: f64) -> f64 {
        if k == 0.0 {
            return self.phase_velocity(0.0);
        }
        let versine = 2.0 * libm::sin(0.5 * k * self.horizon).powi(2);
        self.k1 / self.density * 2.0 / self.horizon.powi(2) * versine / (k * self.frequency(k))
    }
}

const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;
/// Up to here the series loses less than two digits, and from here on the continued fraction is short.
const SERIES: f64 = 4.0;

/// `Cin(z) = ∫₀^z (1 − cos t)/t dt = γ + ln z − Ci(z)`, even in z.
///
/// A power series for small z; beyond, `Ci(z) = −Re E₁(iz)` by Lentz's continued fraction.
pub fn cin(z: f64) -> f64 {
    let z = z.abs();
    if z.is_infinite() {
        return f64::INFINITY;
    }
    if z <= SERIES {
        let x = z * z;
        let mut term = 1.0;
        let mut sum = 0.0;
        for n in 1..40 {
            let two = 2.0 * n as f64;
            term *= -x / (two * (two - 1.0));
            let part = -term / two;
            sum += part;
            if part.abs() <= 1e-17 * sum {
                break;
            }
        }
        return sum;
    }
    EULER_GAMMA + libm::log(z) - cosine_integral(z)
}

/// `Ci(z) = −Re E₁(iz)`, z beyond the series.
fn cosine_integral(z: f64) -> f64 {
    let mut b = Complex64::new(1.0, z);
    let mut c = Complex64::new(1e300, 0.0);
    let mut d = b.inv();
    let mut h = d;
    for n in 1..500 {
        let a = -((n * n) as f64);
        b += 2.0;
        d = (d * a + b).inv();
        c = b + c.inv() * a;
        let factor = c * d;
        h *= factor;
        if (factor - 1.0).norm() < 1e-16 {
            break;
        }
    }
    -(h * Complex64::from_polar(1.0, -z)).re
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Q, q};
    use crate::gradient::linear::{dispersion_series, springs_continuum};

    #[test]
    fn cin_at_known_points() {
        // Σ (−1)^{n+1} z^{2n}/(2n (2n)!) in fractions
        for (z, expected) in [
            (1e-3, 2.499_999_895_833_335_6e-7),
            (0.5, 6.185_256_314_820_045e-2),
            (1.0, 0.239_811_742_000_564_74),
        ] {
            assert!((cin(z) - expected).abs() < 1e-15, "{z}: {}", cin(z));
        }
        // both forms, where they meet and on either side
        for z in [2.5, 3.0, 3.5, 3.999, 4.0] {
            let by_fraction = EULER_GAMMA + f64::ln(z) - cosine_integral(z);
            assert!((cin(z) - by_fraction).abs() < 3e-15, "{z}");
        }
        // slopes everywhere, by Gauss's rule between neighbours
        let mut z = 0.1f64;
        while z < 300.0 {
            let h = 0.2;
            let x = [
                -0.906179845938664,
                -0.5384693101056831,
                0.0,
                0.5384693101056831,
                0.906179845938664,
            ];
            let w = [
                0.2369268850561891,
                0.4786286704993665,
                0.5688888888888889,
                0.4786286704993665,
                0.2369268850561891,
            ];
            let integral: f64 = x
                .iter()
                .zip(w)
                .map(|(x, w)| {
                    let t: f64 = z + 0.5 * h * (1.0 + x);
                    0.5 * h * w * (1.0 - t.cos()) / t
                })
                .sum();
            assert!((cin(z + h) - cin(z) - integral).abs() < 1e-14, "{z}");
            z += 1.37;
        }
        assert_eq!(cin(-2.0), cin(2.0));
        assert_eq!(cin(0.0), 0.0);
    }

    #[test]
    fn finite_chains_tend_to_the_integral() {
        let horizon = 5.0;
        let integral = SpringContinuum {
            k1: 1.3,
            density: 0.7,
            horizon,
        };
        for k in [0.1, 0.6, 2.0] {
            let error = |n: usize| {
                let chain = LinearChain::springs(1.3, horizon / n as f64, n);
                chain.frequency(k, 0.7).unwrap() / integral.frequency(k) - 1.0
            };
            let (coarse, fine) = (error(400), error(800));
            assert!(fine.abs() < 5e-3);
            // first order: c = 2K1/δ² against 2K1/(δ²(1 + 1/N)), and the rectangle rule
            assert!((coarse / fine - 2.0).abs() < 0.05, "{k}: {coarse} {fine}");
        }
    }

    #[test]
    fn series_are_the_long_waves() {
        let c: Vec<Q> = springs_continuum(q(1, 1), q(1, 1), 8);
        let [_, root] = dispersion_series(&c).unwrap();
        let unit = SpringContinuum {
            k1: 1.0,
            density: 1.0,
            horizon: 1.0,
        };
        let chain = LinearChain::springs(q(1, 1), q(1, 6), 6);
        let [_, finite] = dispersion_series(&chain.coefficients(8)).unwrap();
        let sum = |s: &[Q], k: f64| {
            s.iter().rev().fold(0.0, |t, c| {
                t * k * k + num_traits::ToPrimitive::to_f64(c).unwrap()
            })
        };
        for k in [0.1, 0.4, 0.8f64] {
            assert!((sum(&root.0, k) - unit.frequency(k) / k).abs() < 1e-12);
            let w = chain.approximate().phase_velocity(k, 1.0).unwrap();
            assert!((sum(&finite.0, k) - w).abs() < 1e-12);
        }
        // long waves keep their digits
        assert!((unit.phase_velocity(1e-9) - 1.0).abs() < 1e-15);
        assert!((chain.approximate().phase_velocity(1e-9, 1.0).unwrap() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn group_velocity_is_the_slope() {
        let unit = SpringContinuum {
            k1: 2.0,
            density: 1.0,
            horizon: 3.0,
        };
        let chain = LinearChain::structured_eam(3.0, 2.0, 1, 0.4, 4);
        let h = 1e-5;
        for k in [0.3, 1.1, 2.9] {
            let d = (unit.frequency(k + h) - unit.frequency(k - h)) / (2.0 * h);
            assert!((unit.group_velocity(k) - d).abs() < 1e-9);
            let w = |k| chain.frequency(k, 1.0).unwrap();
            let d = (w(k + h) - w(k - h)) / (2.0 * h);
            assert!((chain.group_velocity(k, 1.0).unwrap() - d).abs() < 1e-9);
        }
        assert!((chain.group_velocity(0.0, 1.0).unwrap() - 3.5f64.sqrt()).abs() < 1e-14);
        assert_eq!(unit.group_velocity(0.0), 2f64.sqrt());
    }
}
