//! What tests of these laws share.

use super::Unseen;
use crate::law::descriptor::{Given, Registered};
use crate::law::material::tensor::Matrix;
use crate::spec::{Parameters, Plane};

/// A gradient that sees everything, of no strain across.
pub const SEEN: Unseen<f64> = Unseen {
    stiffness: 0.0,
    square: 0.0,
    across: 0.0,
    reach: 1.0,
};

/// A law of one material.
pub fn made<L: Registered>(d: usize, plane: Plane, parameters: &Parameters) -> Result<L, String> {
    let given = Given {
        parameters,
        solid: None,
        micromodulus: None,
        critical_stretch: f64::INFINITY,
        breaks: false,
        density: 1.0,
        weighted_volume: None,
        first_moment: 1.0,
        horizon: 1.0,
        family: &[],
    };
    L::make(d, plane, &[given]).map_err(|(_, why)| why)
}

/// A slope by differences of fourth order.
pub fn slope(at: impl Fn(f64) -> f64) -> f64 {
    (8.0 * (at(1e-3) - at(-1e-3)) - (at(2e-3) - at(-2e-3))) / 12e-3
}

/// Is P the slope of the energy at H?
pub fn is_slope<const D: usize>(
    h: &Matrix<f64, D>,
    (p, within): (&Matrix<f64, D>, f64),
    energy: impl Fn(&Matrix<f64, D>) -> f64,
) {
    for r in 0..D {
        for s in 0..D {
            let slope = slope(|step| {
                let mut h = *h;
                h[r][s] += step;
                energy(&h)
            });
            let p = p[r][s];
            assert!((slope - p).abs() < within, "{r}{s}: {slope} {p}");
        }
    }
}
