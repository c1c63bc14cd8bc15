//! Initial profiles of the papers.

/// Rises from 0 at s = 0 to 1 at s = 1, with ten derivatives that vanish at both ends: the polynomial of degree 21.
///
/// `S(s) = s¹¹ Σ_{k=0..10} C(10+k, k) (1−s)^k`, mirrored at s = ½ (`S(s) = 1 − S(1−s)`): the expanded powers of seleson2009's
/// polynomial lose 3e-9 near s = 1. Constant outside 0…1.
pub fn rise(s: f64) -> f64 {
    if s > 0.5 {
        return 1.0 - rise(1.0 - s);
    }
    if s <= 0.0 || s.is_nan() {
        return if s.is_nan() { s } else { 0.0 };
    }
    let (mut sum, mut term) = (0.0, 1.0);
    for k in 0..=10 {
        sum += term;
        // C(10+k+1, k+1) = C(10+k, k) (11+k)/(k+1)
        term *= (1.0 - s) * f64::from(11 + k) / f64::from(k + 1);
    }
    s.powi(11) * sum
}

/// A pulse of a height around a centre: 0 from `half_width` on.
pub fn pulse(x: f64, centre: f64, half_width: f64, height: f64) -> f64 {
    height * rise((half_width - (x - centre).abs()) / half_width)
}

/// p(x) of seleson2009, section 4.4.1: support [490, 510], height 1 at 500.
pub fn seleson2009(x: f64) -> f64 {
    pulse(x, 500.0, 10.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// S' = 21!/(10!)² s¹⁰ (1−s)¹⁰: the only polynomial of degree 20 with these zeros and integral 1.
    fn slope(s: f64) -> f64 {
        let factor: f64 =
            (11..=21).map(f64::from).product::<f64>() / (1..=10).map(f64::from).product::<f64>();
        factor * (s * (1.0 - s)).powi(10)
    }

    #[test]
    fn the_rise_is_the_integral_of_its_slope() {
        // Simpson's rule on 2000 pieces: error below 1e-14
        let (n, mut sum) = (2000, 0.0);
        for k in 0..n {
            let (a, b) = (f64::from(k) / f64::from(n), f64::from(k + 1) / f64::from(n));
            sum += (b - a) / 6.0 * (slope(a) + 4.0 * slope(0.5 * (a + b)) + slope(b));
            assert!((rise(b) - sum).abs() < 1e-13, "{b}: {} {sum}", rise(b));
        }
    }

    #[test]
    fn the_profile_has_its_ends_and_its_symmetry() {
        assert_eq!([490.0, 510.0, 0.0, 1000.0].map(seleson2009), [0.0; 4]);
        assert_eq!(seleson2009(500.0), 1.0);
        assert_eq!(seleson2009(495.0), 0.5);
        for k in 0..1000 {
            let x = 0.01 * f64::from(k);
            let [left, right] = [seleson2009(500.0 - x), seleson2009(500.0 + x)];
            assert!(
                (left - right).abs() < 1e-15 && (0.0..=1.0).contains(&left),
                "{x}"
            );
        }
        // ten derivatives vanish: near the end it is C(21,10) s¹¹ and near the top 1 minus that
        let s = 1e-3f64;
        assert!((rise(s) / (352_716.0 * s.powi(11)) - 1.0).abs() < 1e-2);
        assert!(rise(f64::NAN).is_nan());
    }
}
