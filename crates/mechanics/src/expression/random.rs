//! Random fields that are functions of place: the same for every run, thread and machine.

/// 53 bits from three whole numbers (the finaliser of SplitMix64, Steele, Lea and Flood 2014, applied to each in turn).
fn bits(cell: [f64; 3]) -> u64 {
    cell.iter().fold(0x9e37_79b9_7f4a_7c15, |state, &c| {
        // beyond 2^63 a cell is no whole number any more: the cast saturates
        let mut z = (state ^ (c as i64 as u64)).wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }) >> 11
}

/// Uniform in `[0, 1)`, one number per unit cell; cells are independent.
pub(super) fn random(x: [f64; 3]) -> f64 {
    if x.iter().any(|x| !x.is_finite()) {
        return f64::NAN;
    }
    bits(x.map(f64::floor)) as f64 / (1u64 << 53) as f64
}

/// Random numbers in `[−1, 1]` at the corners of unit cells, and between them a blend with two continuous derivatives.
pub(super) fn noise(x: [f64; 3]) -> f64 {
    let low = x.map(f64::floor);
    let weight: [f64; 3] = crate::array::from_fn(|a| {
        let s = x[a] - low[a];
        s * s * s * (10.0 + s * (6.0 * s - 15.0))
    });
    (0..8).fold(0.0, |sum, corner: usize| {
        let mut part = 1.0;
        let cell = crate::array::from_fn(|a| {
            let up = corner >> a & 1;
            part *= if up == 1 { weight[a] } else { 1.0 - weight[a] };
            low[a] + up as f64
        });
        sum + part * (2.0 * random(cell) - 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_uniform_and_neighbours_independent() {
        let n = 60;
        let all: Vec<f64> = (0..n * n)
            .map(|k| random([f64::from(k % n) + 0.5, f64::from(k / n) - 20.0, 0.0]))
            .collect();
        let count = all.len() as f64;
        let mean = all.iter().sum::<f64>() / count;
        let variance = all.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
        let along: f64 = all.windows(2).map(|w| (w[0] - 0.5) * (w[1] - 0.5)).sum();
        let across: f64 = all
            .windows(n as usize + 1)
            .map(|w| (w[0] - 0.5) * (w[n as usize] - 0.5))
            .sum();
        // four standard deviations of each
        assert!((mean - 0.5).abs() < 4.0 / (12.0 * count).sqrt());
        assert!((variance - 1.0 / 12.0).abs() < 4.0 / (180.0 * count).sqrt());
        for product in [along, across] {
            assert!((product / count * 12.0).abs() < 4.0 / count.sqrt());
        }
        assert_eq!(random([0.1, 0.9, -0.1]), random([0.9, 0.1, -0.9]));
        assert!(random([f64::NAN, 0.0, 0.0]).is_nan());
    }

    #[test]
    fn noise_is_smooth_and_passes_through_the_corners() {
        let corner = [3.0, -2.0, 7.0];
        assert_eq!(noise(corner), 2.0 * random(corner) - 1.0);
        let d = 1e-4;
        for k in 0..200 {
            let x = f64::from(k) * 0.05 - 5.0;
            let at = |s: f64| noise([x + s, 0.3, 0.6]);
            let [a, b, c, e] = [-2.0, -1.0, 1.0, 2.0].map(|s| at(s * d));
            assert!((-1.0..=1.0).contains(&at(0.0)));
            // the third difference of a function with two continuous derivatives vanishes faster than d²
            assert!((e - 2.0 * c + 2.0 * b - a).abs() < 0.02 * d * d);
        }
    }
}
