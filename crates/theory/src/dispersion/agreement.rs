//! Up to which wave two models agree.

/// The first wave number at which the relative difference `|left/right − 1|` of two frequencies passes `tolerance`, found
/// on `steps` equal steps up to `end` and refined by bisection; `None` if it does not. Imaginary frequencies (`None`) differ.
pub fn departure(
    left: impl Fn(f64) -> Option<f64>,
    right: impl Fn(f64) -> Option<f64>,
    end: f64,
    steps: usize,
    tolerance: f64,
) -> Option<f64> {
    let apart = |k: f64| match (left(k), right(k)) {
        (Some(l), Some(r)) => (l - r).is_nan() || (l - r).abs() > tolerance * r.abs(),
        (None, None) => false,
        _ => true,
    };
    let steps = steps.max(1);
    let at = |i: usize| end * i as f64 / steps as f64;
    let first = (1..=steps).find(|i| apart(at(*i)))?;
    let (mut low, mut high) = (at(first - 1), at(first));
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if apart(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

/// The same as a wavelength, `2π/k`: longer waves agree.
pub fn shortest_wavelength(
    left: impl Fn(f64) -> Option<f64>,
    right: impl Fn(f64) -> Option<f64>,
    end: f64,
    steps: usize,
    tolerance: f64,
) -> Option<f64> {
    departure(left, right, end, steps, tolerance).map(|k| 2.0 * std::f64::consts::PI / k)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gradient::linear::LinearChain;
    use std::f64::consts::PI;

    #[test]
    fn a_nearest_neighbour_chain_leaves_the_wave_equation() {
        // sin(x)/x = 0.99 at x = k a/2
        let chain = LinearChain::springs(1.0, 1.0, 1);
        let k = departure(|k| chain.frequency(k, 1.0), Some, PI, 10, 0.01).unwrap();
        assert!(((0.5 * k).sin() / (0.5 * k) - 0.99).abs() < 1e-14);
        let wavelength =
            shortest_wavelength(|k| chain.frequency(k, 1.0), Some, PI, 10, 0.01).unwrap();
        assert!((wavelength - 2.0 * PI / k).abs() < 1e-14);
        assert_eq!(departure(Some, Some, PI, 10, 0.0), None);
        let stops = |k: f64| (k < 1.0).then_some(k);
        assert!((departure(stops, Some, PI, 7, 0.01).unwrap() - 1.0).abs() < 1e-15);
    }
}
