//! Angles by distances.

use crate::law::number::Number;

/// Cosines are kept so far from ±1, where an angle has no slope.
const STRAIGHT: f64 = 1e-14;

/// Of the angle at the second of three particles.
#[inline(always)]
pub(super) fn cosine<N: Number>(xi: &[N]) -> N {
    let [first, across, second] = [xi[0], xi[1], xi[2]];
    let both = (first * second).sqrt().times(2.0);
    (first + second - across).div(both)
}

/// `arccos c`, 0 to π, by `2 arctan √((1−c)/(1+c))`.
#[inline(always)]
pub(super) fn arc_cosine<N: Number>(c: N) -> N {
    let one = N::constant(1.0);
    let c = c
        .least(N::constant(1.0 - STRAIGHT))
        .most(N::constant(STRAIGHT - 1.0));
    let half = (one - c).div(one + c).sqrt();
    let inverse = half.recip();
    // up to tan π/8 by its series, the rest by π/4 and π/2
    let small = half.below(1.0, half, inverse);
    let turned = small.plus(-1.0).div(small.plus(1.0));
    let near = small.below(NEAR, small, turned);
    let arc = arc_tangent(near);
    let arc = small.below(NEAR, arc, arc.plus(std::f64::consts::FRAC_PI_4));
    let arc = half.below(1.0, arc, arc.times(-1.0).plus(std::f64::consts::FRAC_PI_2));
    arc.times(2.0)
}

/// tan π/8.
const NEAR: f64 = std::f64::consts::SQRT_2 - 1.0;

/// `x − x³/3 + …`; the rest is below 1e-18 for |x| ≤ tan π/8.
#[inline(always)]
fn arc_tangent<N: Number>(x: N) -> N {
    let square = x * x;
    let mut sum = N::constant(1.0 / 45.0);
    let mut k = 22;
    while k > 0 {
        k -= 1;
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        sum = sum.fma(square, N::constant(sign / f64::from(2 * k + 1)));
    }
    x * sum
}

#[cfg(test)]
mod tests {
    use super::arc_cosine;
    use crate::law::slopes::Curved;

    #[test]
    fn arcs_are_exact() {
        for n in -999..=999 {
            let c = f64::from(n) * 1e-3;
            let found = arc_cosine(Curved::<1>::variable(c, 0));
            assert!((found.value - c.acos()).abs() < 1e-15 * 4.0, "{c}");
            let slope = -1.0 / (1.0 - c * c).sqrt();
            assert!((found.slope[0] / slope - 1.0).abs() < 1e-12, "{c}");
            let bend = c * slope * slope * slope;
            let off = (found.curvature[0][0] - bend).abs();
            assert!(off < 1e-11 * (1.0 + bend.abs()), "{c}: {off}");
        }
        for c in [1.0, -1.0] {
            let found = arc_cosine(Curved::<1>::variable(c, 0));
            assert!((found.value - f64::acos(c)).abs() < 2e-7 && found.slope[0] == 0.0);
        }
    }
}
