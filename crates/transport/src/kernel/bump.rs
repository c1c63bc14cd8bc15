//! Bumps: smooth approximations of Dirac's delta on `|z| ≤ δ`, by their profile over `s = |z|/δ`.

/// A bump `b(z) ∝ B(|z|/δ)`, decreasing on `0 ≤ s ≤ 1` and 0 beyond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bump {
    /// `1 − s`: its slope is constant.
    Hat,
    /// `(1 + cos πs)/2`
    Cosine,
    /// `(1 − s²)^p`, p ≥ 1
    Polynomial(u32),
    /// `exp(−1/(1 − s²))`: all derivatives exist.
    Smooth,
}

impl Bump {
    /// `B(s)`, not normalised.
    pub fn value(self, s: f64) -> f64 {
        let q = 1.0 - s * s;
        match self {
            _ if s >= 1.0 => 0.0,
            Bump::Hat => 1.0 - s,
            Bump::Cosine => 0.5 * (1.0 + libm::cos(std::f64::consts::PI * s)),
            Bump::Polynomial(p) => q.powi(p as i32),
            Bump::Smooth => libm::exp(-1.0 / q),
        }
    }

    /// `B′(s)`; at `s = 1` the limit from inside.
    pub fn slope(self, s: f64) -> f64 {
        let q = 1.0 - s * s;
        let pi = std::f64::consts::PI;
        match self {
            _ if s > 1.0 => 0.0,
            Bump::Hat => -1.0,
            Bump::Cosine => -0.5 * pi * libm::sin(pi * s),
            Bump::Polynomial(p) => -2.0 * f64::from(p) * s * q.powi(p as i32 - 1),
            Bump::Smooth if q <= 0.0 => 0.0,
            Bump::Smooth => -2.0 * s / (q * q) * libm::exp(-1.0 / q),
        }
    }

    /// `B″(s)`; at `s = 1` the limit from inside.
    pub fn curvature(self, s: f64) -> f64 {
        let q = 1.0 - s * s;
        let pi = std::f64::consts::PI;
        match self {
            _ if s > 1.0 => 0.0,
            Bump::Hat => 0.0,
            Bump::Cosine => -0.5 * pi * pi * libm::cos(pi * s),
            Bump::Polynomial(1) => -2.0,
            Bump::Polynomial(p) => {
                let p = f64::from(p);
                -2.0 * p * libm::pow(q, p - 2.0) * (q - 2.0 * (p - 1.0) * s * s)
            }
            Bump::Smooth if q <= 0.0 => 0.0,
            Bump::Smooth => {
                let (q2, s2) = (q * q, s * s);
                libm::exp(-1.0 / q) * (4.0 * s2 / (q2 * q2) - 2.0 / q2 - 8.0 * s2 / (q2 * q))
            }
        }
    }

    /// Is `B′` 0 at the end, so that `B″` is all of the second derivative of the bump?
    pub fn has_curvature(self) -> bool {
        match self {
            Bump::Hat | Bump::Polynomial(0 | 1) => false,
            Bump::Cosine | Bump::Polynomial(_) | Bump::Smooth => true,
        }
    }

    /// The Fourier transform of the normalised bump on the line over `κ = kδ`, where a closed form is at hand: `sinc²(κ/2)`,
    /// `sinc κ · π²/(π² − κ²)`, and for `(1 − s²)^p` by the series `Σ (−κ²/4)^n / (n! (p + 3/2)_n)` (0F1, from Poisson's
    /// integral of the Bessel function `J_{p+1/2}`), which loses digits above κ = 20.
    pub fn transform(self, k: f64) -> Option<f64> {
        let pi = std::f64::consts::PI;
        let sinc = |x: f64| if x == 0.0 { 1.0 } else { libm::sin(x) / x };
        match self {
            Bump::Hat => Some(sinc(0.5 * k).powi(2)),
            Bump::Cosine if (k - pi).abs() < 1e-9 => Some(0.5),
            Bump::Cosine => Some(sinc(k) * pi * pi / (pi * pi - k * k)),
            Bump::Polynomial(p) => {
                let (mut term, mut sum) = (1.0, 1.0);
                for n in 0..200 {
                    let n = f64::from(n);
                    term *= -0.25 * k * k / ((n + 1.0) * (f64::from(p) + 1.5 + n));
                    sum += term;
                }
                Some(sum)
            }
            Bump::Smooth => None,
        }
    }
}
