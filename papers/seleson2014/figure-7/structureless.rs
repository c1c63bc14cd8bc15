//! The upscaled structureless EAM (3.4), (3.5) on a ring, with F′, f′ and φ′ differentiated by hand.

use peridyne::law::potential::mei::EamForm;

/// g and g′ of (3.9).
fn cut(x: f64) -> [f64; 2] {
    if x <= 0.0 {
        [1.0, 0.0]
    } else if x < 1.0 {
        let y = 1.0 - x;
        [
            y.powi(3) * (1.0 + 3.0 * x + 6.0 * x * x),
            -30.0 * x * x * y * y,
        ]
    } else {
        [0.0, 0.0]
    }
}

/// f and f′ of (3.8), over ρ_e.
fn density(s: &EamForm, r: f64) -> [f64; 2] {
    let [near, cutoff] = [s.near, s.cutoff].map(|x| s.nearest * x);
    let width = cutoff - near;
    let [g, slope] = cut((r - near) / width);
    let (mut sum, mut first) = (0.0, 0.0);
    for (l, c) in s.density.iter().enumerate() {
        let term = c * (s.nearest * s.density_length / r).powi(l as i32);
        sum += term;
        first -= l as f64 * term / r;
    }
    [sum * g, first * g + sum * slope / width].map(|x| x * s.density_scale)
}

/// φ′ of (3.7).
fn pair_slope(s: &EamForm, r: f64) -> f64 {
    let [near, cutoff] = [s.near, s.cutoff].map(|x| s.nearest * x);
    let width = cutoff - near;
    let [g, slope] = cut((r - near) / width);
    let pair_length = s.nearest * s.pair_length;
    let x = r / pair_length - 1.0;
    let line = 1.0 + s.lambda * x;
    let decay = (-s.gamma * x).exp();
    let first = (s.lambda - s.gamma * line) / pair_length;
    -s.pair * decay * (first * g + line * slope / width)
}

/// F′ of (3.6), by ρ/ρ_e.
fn embedding_slope(s: &EamForm, density: f64) -> f64 {
    let log = density.ln();
    let a = s.alpha / s.beta;
    // of [1 − a ln x] x^a: −a² ln x x^(a−1)
    let well = -a * a * log * density.powf(a - 1.0);
    let mut sum = 0.0;
    for &(count, distance) in &s.shells {
        let p = distance * s.shell_scale;
        let q = p * s.gamma / s.beta;
        let line = 1.0 + (p - 1.0) * s.lambda - p * s.lambda / s.beta * log;
        let decay = (-(p - 1.0) * s.gamma).exp() * density.powf(q);
        let [near, cutoff] = [s.near, s.cutoff].map(|x| s.nearest * x);
        let width = cutoff - near;
        let place = distance * s.nearest * (1.0 - log / s.beta);
        let [g, slope] = cut((place - near) / width);
        let inner = -distance * s.nearest / (s.beta * density) / width;
        sum += count
            * decay
            * ((-p * s.lambda / s.beta + q * line) / density * g + line * slope * inner);
    }
    -s.cohesive * well + 0.5 * s.pair * sum
}

/// Force densities of a ring of points with the spacing h: the sums over n of (3.4), all functions per volume h.
pub fn forces(s: &EamForm, h: f64, u: &[f64]) -> Vec<[f64; 3]> {
    let n = u.len() as i64;
    let distance = |i: i64, o: i64| {
        let j = (i + o).rem_euclid(n) as usize;
        o as f64 * h + u[j] - u[i as usize]
    };
    let around = || (-5..=5i64).filter(|o| *o != 0);
    let host: Vec<f64> = (0..n)
        .map(|i| around().map(|o| density(s, distance(i, o).abs())[0]).sum())
        .collect();
    let slope: Vec<f64> = host.iter().map(|x| embedding_slope(s, *x) / h).collect();
    (0..n)
        .map(|i| {
            let all = around().map(|o| {
                let y = distance(i, o);
                let j = (i + o).rem_euclid(n) as usize;
                let embedded = (slope[i as usize] + slope[j]) * density(s, y.abs())[1];
                (embedded + pair_slope(s, y.abs()) / h) * y.signum()
            });
            [all.sum(), 0.0, 0.0]
        })
        .collect()
}
