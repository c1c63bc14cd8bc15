use super::*;
use std::convert::Infallible;

const EFFORT: Effort = Effort {
    tolerance: 1e-9,
    difference: 1e-4,
    evaluations: 1000,
};

/// Fits `curve(x, b)` between bounds; the parameters, their standard errors, and all else.
fn fitted(
    data: &[[f64; 2]],
    bounds: &[[f64; 2]],
    start: &[f64],
    curve: impl Fn(f64, &[f64]) -> f64,
) -> (Vec<f64>, Sure, Fit) {
    let real = |at: &[f64]| -> Vec<f64> {
        { at.iter().zip(bounds) }
            .map(|(x, [low, high])| low + (high - low) * x)
            .collect()
    };
    let parts: Vec<f64> = { start.iter().zip(bounds) }
        .map(|(b, [low, high])| (b - low) / (high - low))
        .collect();
    let mut model = |places: &[Vec<f64>]| -> Result<_, Infallible> {
        let one = |at: &Vec<f64>| {
            let b = real(at);
            Some(data.iter().map(|[x, y]| curve(*x, &b) - y).collect())
        };
        Ok(places.iter().map(one).collect())
    };
    let fit = fit(&parts, &EFFORT, &mut model).unwrap();
    let mut sure = sure(&fit.at, &fit.residuals, fit.slopes.as_ref().unwrap()).unwrap();
    for (error, [low, high]) in sure.errors.iter_mut().zip(bounds) {
        *error = error.map(|e| e * (high - low));
    }
    (real(&fit.at), sure, fit)
}

/// NIST's Misra1a (Misra 1978): x, y.
const MISRA1A: [[f64; 2]; 14] = [
    [77.6, 10.07],
    [114.9, 14.73],
    [141.1, 17.94],
    [190.8, 23.93],
    [239.9, 29.61],
    [289.0, 35.18],
    [332.8, 40.02],
    [378.4, 44.82],
    [434.8, 50.76],
    [477.3, 55.05],
    [536.8, 61.01],
    [593.1, 66.40],
    [689.1, 75.47],
    [760.0, 81.78],
];

fn near(found: f64, known: f64, within: f64) {
    assert!((found / known - 1.0).abs() < within, "{found} for {known}");
}

/// Certified values of the Statistical Reference Datasets, <https://www.itl.nist.gov/div898/strd/nls/data/misra1a.shtml>.
#[test]
fn a_certified_fit_is_found() {
    let curve = |x: f64, b: &[f64]| b[0] * (1.0 - (-b[1] * x).exp());
    let (b, sure, fit) = fitted(
        &MISRA1A,
        &[[100.0, 700.0], [1e-5, 1e-3]],
        &[500.0, 1e-4],
        curve,
    );
    assert_eq!(fit.ended, Ended::Converged);
    // as far as the last step was small beside the standard error
    near(b[0], 2.389_421_291_8e2, 2e-5);
    near(b[1], 5.501_564_318_1e-4, 2e-5);
    near(sure.errors[0].unwrap(), 2.707_007_524_1, 2e-4);
    near(sure.errors[1].unwrap(), 7.266_868_843_6e-6, 2e-4);
    near(sure.deviation, 1.018_787_633_0e-1, 1e-6);
    assert_eq!(sure.freedom, 12);
    // tables of Student's t
    near(sure.factor, 2.178_812_83, 1e-7);
}

#[test]
fn exact_data_give_exact_parameters() {
    let curve = |x: f64, b: &[f64]| b[0] * (b[1] * x).exp() + b[2];
    let known = [1.5, -0.7, 0.25];
    let data: Vec<[f64; 2]> = { (0..20).map(|n| f64::from(n) * 0.3) }
        .map(|x| [x, curve(x, &known)])
        .collect();
    let bounds = [[0.5, 4.0], [-3.0, -0.1], [0.0, 1.0]];
    let (b, sure, fit) = fitted(&data, &bounds, &[3.0, -2.0, 0.9], curve);
    assert_eq!(fit.ended, Ended::Converged);
    { b.iter().zip(known) }.for_each(|(b, known)| near(*b, known, 1e-8));
    assert!(sure.alike.is_empty() && sure.deviation < 1e-8);
}

/// Bounds that leave the best out: the other parameter is the best with the first at its bound.
#[test]
fn a_bound_holds() {
    let data: Vec<[f64; 2]> = (0..10)
        .map(|n| [f64::from(n), 2.0 * f64::from(n) + 3.0])
        .collect();
    let line = |x: f64, b: &[f64]| b[0] * x + b[1];
    let (b, sure, fit) = fitted(&data, &[[0.0, 1.5], [-20.0, 20.0]], &[0.2, -5.0], line);
    assert_eq!((fit.ended, b[0]), (Ended::Converged, 1.5));
    // the mean of y − 1.5 x
    near(b[1], 3.0 + 0.5 * 4.5, 1e-6);
    assert_eq!((sure.held, sure.errors[0]), (vec![true, false], None));
    // s/√m of a mean
    near(sure.errors[1].unwrap(), sure.deviation / 10f64.sqrt(), 1e-6);
}

#[test]
fn parameters_that_are_alike_are_named() {
    let data: Vec<[f64; 2]> = (1..9).map(|n| [f64::from(n), 6.0 * f64::from(n)]).collect();
    let product = |x: f64, b: &[f64]| b[0] * b[2] * x + 0.1 * (b[1] - 1.0) * x * x;
    let bounds = [[1.0, 5.0], [0.0, 3.0], [1.0, 5.0]];
    let (b, sure, _) = fitted(&data, &bounds, &[1.5, 2.0, 2.0], product);
    near(b[0] * b[2], 6.0, 1e-6);
    assert_eq!(sure.alike, [[0, 2]]);
    assert!(sure.errors.iter().all(Option::is_none));
}

#[test]
fn what_does_not_matter_is_told_and_so_is_the_limit() {
    let none = |_: f64, _: &[f64]| 1.0;
    let data = [[0.0, 2.0], [1.0, 3.0], [2.0, 0.0]];
    let (.., fit) = fitted(&data, &[[0.0, 1.0]], &[0.5], none);
    assert_eq!(fit.ended, Ended::Flat(0));
    let mut asked = 0;
    let mut model = |places: &[Vec<f64>]| -> Result<_, Infallible> {
        asked += places.len();
        Ok(places
            .iter()
            .map(|p| Some(vec![p[0].exp() - 1.2, p[0].sin()]))
            .collect())
    };
    let few = Effort {
        evaluations: 4,
        ..EFFORT
    };
    let fit = super::fit(&[0.9], &few, &mut model).unwrap();
    assert_eq!((fit.ended, fit.evaluations), (Ended::Spent, 4));
    assert_eq!(asked, 4);
}

/// A model without values beyond a place: the step there is taken back.
#[test]
fn places_without_a_value_are_left() {
    let mut model = |places: &[Vec<f64>]| -> Result<_, Infallible> {
        let one = |p: &Vec<f64>| (p[0] < 0.6).then(|| vec![(1.0 / p[0]).ln() - 1.0, 0.0]);
        Ok(places.iter().map(one).collect())
    };
    let fit = fit(&[0.02], &EFFORT, &mut model).unwrap();
    near(fit.at[0], (-1f64).exp(), 1e-8);
    assert!(matches!(
        super::fit(&[0.9], &EFFORT, &mut model),
        Err(Unfit::Start)
    ));
}
