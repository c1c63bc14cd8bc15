//! Solutions along characteristics, and of a viscous shock.

use crate::flux::Flux;

/// The solution of `u_t + f(u)_x = 0` along characteristics, `u = g(x − t f′(u))` (sandia2010 (2.0.12), which solves the local equation; of the nonlocal
/// one it leaves a residual of O(δ²)), for t before the first shock: by bisection for the foot of the characteristic between `x − t·fastest` and `x + t·fastest`.
pub fn characteristics(flux: &Flux, g: impl Fn(f64) -> f64, fastest: f64, x: f64, t: f64) -> f64 {
    let ahead = |foot: f64| foot + t * flux.speed(g(foot)) - x;
    let (mut low, mut high) = (x - t * fastest - 1e-12, x + t * fastest + 1e-12);
    while high - low > 4.0 * f64::EPSILON * x.abs().max(fastest * t).max(1e-3) {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        match ahead(middle) < 0.0 {
            true => low = middle,
            false => high = middle,
        }
    }
    g(0.5 * (low + high))
}

/// When characteristics first cross: `−1/min (f′(g))_x`, of values on a line, fine enough that differences are derivatives, over the ends too where the line is `periodic`;
/// `None` where they never do, as far as that is above the round-off of speeds.
pub fn shock_time(flux: &Flux, u: &[f64], spacing: f64, periodic: bool) -> Option<f64> {
    let speed: Vec<f64> = u.iter().map(|u| flux.speed(*u)).collect();
    let fastest = speed.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
    // of a function slopes are differences themselves
    let known = match flux {
        Flux::Polynomial(_) => 8.0 * f64::EPSILON,
        Flux::Function(_) => 1e-9,
    };
    let ends = (periodic && u.len() > 1).then(|| speed[0] - speed[u.len() - 1]);
    let steps = speed.windows(2).map(|w| w[1] - w[0]).chain(ends);
    let steepest = steps.fold(0.0, f64::min);
    (steepest < -known * fastest).then(|| -spacing / steepest)
}

/// The viscous shock of the local Burgers equation from `left` down to `right`, at rest about 0 in its own frame:
/// `(l + r)/2 − (l − r)/2 tanh((l − r) x/4ε)`; it moves at `(l + r)/2`.
pub fn viscous_shock(left: f64, right: f64, viscosity: f64, x: f64) -> f64 {
    let (mean, half) = (0.5 * (left + right), 0.5 * (left - right));
    mean - half * libm::tanh(half * x / (2.0 * viscosity))
}
