//! A rectangle around the tip of a crack.

use crate::spec::JIntegralSpec;

/// A rectangle, and the modulus of what is in it.
pub(in crate::run) struct JIntegral {
    pub(super) spec: JIntegralSpec,
    /// `E′ = C₁₁ − C₁₂²/C₁₁` of the plane (pressure): E in plane stress, E/(1−ν²) in plane strain.
    pub(super) modulus: f64,
    pub(super) section: f64,
}

impl JIntegral {
    /// q at a place in the reference, and its gradient: a product of one function per axis, with two derivatives.
    pub(super) fn q(&self, x: [f64; 2]) -> (f64, [f64; 2]) {
        let mut each = [(0.0, 0.0); 2];
        for a in 0..2 {
            let (low, high) = (self.spec.low[a], self.spec.high[a]);
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            let s = (x[a] - middle) / half;
            // from 1 at half of the way to 0 at the side
            let t = (2.0 * s.abs() - 1.0).clamp(0.0, 1.0);
            let value = 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
            let slope = -30.0 * t * t * (1.0 - t) * (1.0 - t) * 2.0 * s.signum() / half;
            each[a] = (value, slope);
        }
        let [(p, dp), (r, dr)] = each;
        (p * r, [dp * r, p * dr])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn q_falls_from_one_to_nothing_with_its_gradient() {
        let j_integral = JIntegral {
            spec: JIntegralSpec {
                low: [-1.0, 2.0],
                high: [3.0, 4.0],
                direction: [1.0, 0.0],
            },
            modulus: 1.0,
            section: 1.0,
        };
        assert_eq!(j_integral.q([1.5, 3.2]), (1.0, [0.0, 0.0]));
        for x in [[3.0, 3.0], [1.0, 2.0], [-4.0, 9.0]] {
            assert_eq!(j_integral.q(x).0, 0.0);
        }
        let h = 1e-6;
        for x in [[2.3, 3.0], [-0.4, 3.8], [2.7, 2.1]] {
            let (_, slope) = j_integral.q(x);
            for a in 0..2 {
                let moved = |by: f64| {
                    let mut x = x;
                    x[a] += by;
                    j_integral.q(x).0
                };
                let difference = (moved(h) - moved(-h)) / (2.0 * h);
                assert!((slope[a] - difference).abs() < 1e-8, "{x:?}: {slope:?}");
            }
        }
    }
}
