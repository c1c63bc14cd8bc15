//! Integrals of functions that somebody wrote: adaptive Gauss–Kronrod quadrature, which halves the interval whose two rules differ most.

/// Nodes of the 15-point Kronrod rule on [0, 1] of [−1, 1], those of Gauss's 7 points at odd places, and both weights (QUADPACK, QK15).
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_56,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

/// Most intervals, and what they may be off by at the end.
const MOST: usize = 1000;
const BAD: f64 = 1e-10;

/// `∫_a^b f dx` to a part `tolerance` of it; infinite where it does not converge.
pub fn integral(f: &dyn Fn(f64) -> f64, a: f64, b: f64, tolerance: f64) -> f64 {
    let piece = |a: f64, b: f64| {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let (mut kronrod, mut gauss) = (0.0, 0.0);
        for (n, x) in NODES.iter().enumerate() {
            let both = match n == 7 {
                true => f(middle),
                false => f(middle - half * x) + f(middle + half * x),
            };
            kronrod += KRONROD[n] * both;
            if n % 2 == 1 {
                gauss += GAUSS[n / 2] * both;
            }
        }
        [a, b, half * kronrod, half * (kronrod - gauss).abs()]
    };
    let mut pieces = vec![piece(a, b)];
    loop {
        let [mut total, mut error, mut worst] = [0.0, 0.0, 0.0];
        let mut at = 0;
        for (n, [_, _, value, off]) in pieces.iter().enumerate() {
            total += value;
            error += off;
            if *off > worst {
                (worst, at) = (*off, n);
            }
        }
        if error <= tolerance * total.abs() {
            return total;
        }
        if pieces.len() >= MOST || !error.is_finite() {
            return match error <= BAD * total.abs() {
                true => total,
                false => f64::INFINITY,
            };
        }
        let [a, b, ..] = pieces[at];
        let middle = 0.5 * (a + b);
        pieces[at] = piece(a, middle);
        pieces.push(piece(middle, b));
    }
}

#[cfg(test)]
mod tests {
    use super::integral;

    /// Smooth, with a kink, with a corner that is no point of any halving, and without a slope or a value at the end.
    #[test]
    fn integrals_are_those_of_the_antiderivative() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 6] = [
            (|x| x.powi(13), 0.0, 2.0, 2f64.powi(14) / 14.0),
            (f64::exp, -1.0, 3.0, 3f64.exp() - (-1f64).exp()),
            (|x| (x - 0.3).abs(), 0.0, 1.0, 0.045 + 0.245),
            (|x| if x < 1.0 / 3.0 { 1.0 } else { 4.0 }, 0.0, 1.0, 3.0),
            (f64::sqrt, 0.0, 1.0, 2.0 / 3.0),
            (|x| x.powf(-0.75), 0.0, 1.0, 4.0),
        ];
        for (f, a, b, exact) in cases {
            let found = integral(&f, a, b, 1e-14);
            assert!((found / exact - 1.0).abs() < 1e-13, "{found} {exact}");
        }
        assert_eq!(integral(&f64::recip, 0.0, 1.0, 1e-14), f64::INFINITY);
        assert_eq!(integral(&|_| f64::NAN, 0.0, 1.0, 1e-14), f64::INFINITY);
    }
}
