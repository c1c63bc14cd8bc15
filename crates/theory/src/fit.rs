//! Parameters between bounds with which a model comes nearest to data: nonlinear least squares, and how sure they are.
//!
//! Steps are those of Levenberg and Marquardt (Marquardt 1963) among all that stay between the bounds, each a convex quadratic programme
//! (Kanzow, Yamashita and Fukushima 2004). Slopes are central differences. Uncertainties are those of the linear model about the
//! solution, s²(JᵀJ)⁻¹ (Bates and Watts 1988, sections 2.1 and 2.2): with few data, or a curved model, they are approximations.
//!
//! Each parameter is a part of its interval, from 0 to 1. The model is asked for many at once, so that it may work side by side.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT};
use peridyne_algebra::{Factors, symmetric_eigen};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Residuals at each of these places; `None` where the model has none.
pub type Model<'a, E> = dyn FnMut(&[Vec<f64>]) -> Result<Vec<Option<Vec<f64>>>, E> + 'a;

/// Of the largest eigenvalue of JᵀJ with columns of length 1: less is singular, as far as differences tell.
const SINGULAR: f64 = 1e-8;
/// Parameters so near to a bound are at it.
const AT_BOUND: f64 = 1e-7;
/// The residual along the model's tangent over that across it, by degrees of freedom: a step would be that part of the standard
/// error (Bates and Watts 1988, section 2.2.3).
const OFFSET: f64 = 1e-3;
/// Steps are damped from this on, up to the other.
const DAMPING: [f64; 2] = [1e-3, 1e10];
/// The fall of the squared residual that is enough, of that foretold.
const FALL: f64 = 1e-4;

/// How far to go.
#[derive(Debug, Clone, Copy)]
pub struct Effort {
    /// Steps shorter than this part of every interval are none.
    pub tolerance: f64,
    /// Half the distance between the two places that a slope is found from.
    pub difference: f64,
    /// Times that the model may be asked.
    pub evaluations: usize,
}

/// Why a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// The best step is none, or small beside the standard errors.
    Converged,
    /// No step makes the residual smaller, and the best one is not none: the model is not smooth, or not exact enough.
    Stalled,
    /// The model was asked as often as allowed.
    Spent,
    /// The model does not depend on this parameter here.
    Flat(usize),
}

/// Why there is no fit.
#[derive(Debug)]
pub enum Unfit<E> {
    Model(E),
    /// The model has no value where the fit begins.
    Start,
    /// It has none on either side along this parameter.
    Slope(usize),
    /// The quadratic programme of a step has no solution.
    Step(String),
}

/// Where a fit ended.
#[derive(Debug, Clone)]
pub struct Fit {
    pub at: Vec<f64>,
    pub residuals: Vec<f64>,
    /// Derivatives of the residuals by each parameter there, if they were found.
    pub slopes: Option<Vec<Vec<f64>>>,
    pub ended: Ended,
    pub evaluations: usize,
    pub steps: usize,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The linear model at a place.
struct Tangent<'a> {
    at: &'a [f64],
    residuals: &'a [f64],
    slopes: &'a [Vec<f64>],
    /// JᵀJ and Jᵀr.
    square: Vec<Vec<f64>>,
    gradient: Vec<f64>,
}

impl<'a> Tangent<'a> {
    fn new(at: &'a [f64], residuals: &'a [f64], slopes: &'a [Vec<f64>]) -> Self {
        let row = |a: &Vec<f64>| slopes.iter().map(|b| dot(a, b)).collect();
        Tangent {
            at,
            residuals,
            slopes,
            square: slopes.iter().map(row).collect(),
            gradient: slopes.iter().map(|a| dot(a, residuals)).collect(),
        }
    }

    /// What the residuals change by.
    fn change(&self, step: &[f64]) -> Vec<f64> {
        let of = |i: usize| self.slopes.iter().zip(step).map(|(s, p)| s[i] * p).sum();
        (0..self.residuals.len()).map(of).collect()
    }

    /// How far the squared residual falls.
    fn fall(&self, step: &[f64]) -> f64 {
        let change = self.change(step);
        -2.0 * dot(self.residuals, &change) - dot(&change, &change)
    }

    /// The step between the bounds to the least of the squared residual and of `damping` times its own square, in units of the slopes.
    fn step(&self, damping: f64) -> Result<Vec<f64>, String> {
        let n = self.at.len();
        let most = (0..n).fold(0.0f64, |m, k| m.max(self.square[k][k]));
        let entry = |i: usize, j: usize| {
            let own = self.square[i][i].max(1e-12 * most);
            self.square[i][j] + if i == j { (damping + 1e-14) * own } else { 0.0 }
        };
        let bounds = |k: usize| [-self.at[k], 1.0 - self.at[k]];
        // numbers about 1 for the solver
        let lower = |j: usize| 0..=j;
        let starts = (0..=n).map(|j| j * (j + 1) / 2).collect();
        let rows = (0..n).flat_map(lower).collect();
        let values = (0..n).flat_map(|j| lower(j).map(move |i| entry(i, j) / most));
        let objective = CscMatrix::new(n, n, starts, rows, values.collect());
        // p ≤ high, −p ≤ −low
        let both = (0..n).flat_map(|k| [k, n + k]).collect();
        let signs = (0..n).flat_map(|_| [1.0, -1.0]).collect();
        let box_of = CscMatrix::new(2 * n, n, (0..=n).map(|k| 2 * k).collect(), both, signs);
        let high = (0..n).map(|k| bounds(k)[1]);
        let right: Vec<f64> = high.chain((0..n).map(|k| -bounds(k)[0])).collect();
        let linear: Vec<f64> = self.gradient.iter().map(|g| g / most).collect();
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .tol_feas(1e-11)
            .tol_gap_abs(1e-11)
            .tol_gap_rel(1e-11)
            .build();
        let mut solver = DefaultSolver::new(
            &objective,
            &linear,
            &box_of,
            &right,
            &[NonnegativeConeT(2 * n)],
            settings.unwrap_or_default(),
        )
        .map_err(|e| e.to_string())?;
        solver.solve();
        let mut step = solver.solution.x.clone();
        if step.len() != n || step.iter().any(|p| !p.is_finite()) {
            return Err(format!("{:?}", solver.solution.status));
        }
        // it says which stay at their bounds; the others are found to round-off, and stay where they would go beyond
        let mut free = vec![true; n];
        for k in 0..n {
            let [low, high] = bounds(k);
            let down = self.gradient[k] + (0..n).map(|j| entry(k, j) * step[j]).sum::<f64>();
            match (step[k] - low < AT_BOUND, high - step[k] < AT_BOUND) {
                (true, _) if down >= 0.0 => (step[k], free[k]) = (low, false),
                (_, true) if down <= 0.0 => (step[k], free[k]) = (high, false),
                _ => {}
            }
        }
        loop {
            let own: Vec<usize> = (0..n).filter(|k| free[*k]).collect();
            for (k, p) in own.iter().zip(self.least(&own, &step, &entry)) {
                step[*k] = p;
            }
            let beyond = |k: &&usize| step[**k] != step[**k].clamp(bounds(**k)[0], bounds(**k)[1]);
            let beyond: Vec<usize> = own.iter().filter(beyond).copied().collect();
            for k in &beyond {
                let [low, high] = bounds(*k);
                (step[*k], free[*k]) = (step[*k].clamp(low, high), false);
            }
            if beyond.is_empty() {
                return Ok(step);
            }
        }
    }

    /// Where the least is for these, with all others where they are.
    fn least(&self, free: &[usize], step: &[f64], entry: &dyn Fn(usize, usize) -> f64) -> Vec<f64> {
        let lower = |a: usize| (0..=a).map(move |b| (a, b, entry(free[a], free[b])));
        let lower: Vec<_> = (0..free.len()).flat_map(lower).collect();
        let pull = |k: &usize| {
            let held = (0..step.len()).filter(|j| !free.contains(j));
            -self.gradient[*k] - held.map(|j| entry(*k, j) * step[j]).sum::<f64>()
        };
        let mut found: Vec<f64> = free.iter().map(pull).collect();
        match Factors::symmetric(free.len(), &lower, |_| true) {
            Ok(factors) if !free.is_empty() => factors.solve(&mut found),
            // the solver's own are good enough
            Ok(_) | Err(_) => found = free.iter().map(|k| step[*k]).collect(),
        }
        found
    }

    /// The next place and the residuals there, or why there is none.
    fn next<E>(
        &self,
        damping: &mut f64,
        (evaluations, effort): (&mut usize, &Effort),
        model: &mut Model<E>,
    ) -> Result<Result<(Vec<f64>, Vec<f64>), Ended>, Unfit<E>> {
        let best = self.step(0.0).map_err(Unfit::Step)?;
        if self.settled(&best, effort.tolerance) {
            return Ok(Err(Ended::Converged));
        }
        let square = dot(self.residuals, self.residuals);
        while *damping <= DAMPING[1] {
            if *evaluations == effort.evaluations {
                return Ok(Err(Ended::Spent));
            }
            let step = self.step(*damping).map_err(Unfit::Step)?;
            if step.iter().all(|p| p.abs() <= effort.tolerance) {
                break;
            }
            let place: Vec<f64> = { self.at.iter().zip(&step) }
                .map(|(x, p)| (x + p).clamp(0.0, 1.0))
                .collect();
            *evaluations += 1;
            if let Some(residuals) = one(&place, model)? {
                let part = (square - dot(&residuals, &residuals)) / self.fall(&step);
                if part > FALL {
                    // Nielsen 1999: the damping falls as far as the linear model was right
                    *damping *= (1.0 - (2.0 * part - 1.0).powi(3)).clamp(1.0 / 3.0, 2.0);
                    return Ok(Ok((place, residuals)));
                }
            }
            *damping *= 4.0;
        }
        Ok(Err(Ended::Stalled))
    }

    /// Is this best step none, or one that no measurement could tell?
    fn settled(&self, step: &[f64], tolerance: f64) -> bool {
        let along = self.change(step);
        let along = dot(&along, &along);
        let across = (dot(self.residuals, self.residuals) - along).max(0.0);
        let (m, n) = (self.residuals.len() as f64, step.len() as f64);
        let small = along * (m - n) <= OFFSET * OFFSET * across * n;
        small || step.iter().all(|p| p.abs() <= tolerance)
    }
}

/// Fits from `start` on.
///
/// # Errors
/// Those of the model; it has no value at the start or about a place.
pub fn fit<E>(start: &[f64], effort: &Effort, model: &mut Model<E>) -> Result<Fit, Unfit<E>> {
    let mut fit = Fit {
        at: start.to_vec(),
        residuals: one(start, model)?.ok_or(Unfit::Start)?,
        slopes: None,
        ended: Ended::Spent,
        evaluations: 1,
        steps: 0,
    };
    let mut damping = DAMPING[0];
    loop {
        let places = about(&fit.at, effort.difference);
        if fit.evaluations + places.len() > effort.evaluations {
            return Ok(fit);
        }
        fit.evaluations += places.len();
        let values = model(&places).map_err(Unfit::Model)?;
        let slopes = slopes(&fit.at, &fit.residuals, &places, &values)?;
        let tangent = Tangent::new(&fit.at, &fit.residuals, &slopes);
        let next = match slopes.iter().position(|s| dot(s, s) == 0.0) {
            Some(k) => Err(Ended::Flat(k)),
            None => {
                let asked = (&mut fit.evaluations, effort);
                tangent.next(&mut damping, asked, model)?
            }
        };
        match next {
            Ok((at, residuals)) => {
                (fit.at, fit.residuals) = (at, residuals);
                fit.steps += 1;
            }
            Err(ended) => {
                (fit.ended, fit.slopes) = (ended, Some(slopes));
                return Ok(fit);
            }
        }
    }
}

fn one<E>(place: &[f64], model: &mut Model<E>) -> Result<Option<Vec<f64>>, Unfit<E>> {
    let found = model(&[place.to_vec()]).map_err(Unfit::Model)?;
    Ok(found.into_iter().next().flatten())
}

/// Two places for each parameter, one where the other would be out of bounds.
fn about(at: &[f64], difference: f64) -> Vec<Vec<f64>> {
    let one = |k: usize, by: f64| {
        let mut place = at.to_vec();
        place[k] += by;
        (0.0..=1.0).contains(&place[k]).then_some(place)
    };
    let each = (0..at.len()).flat_map(|k| [one(k, -difference), one(k, difference)]);
    each.flatten().collect()
}

/// Of what was found about a place; from one side where the other has nothing.
fn slopes<E>(
    at: &[f64],
    residuals: &[f64],
    places: &[Vec<f64>],
    values: &[Option<Vec<f64>>],
) -> Result<Vec<Vec<f64>>, Unfit<E>> {
    let along = |k: usize| {
        let own = places.iter().zip(values).filter(|(p, _)| p[k] != at[k]);
        let mut found = own.filter_map(|(p, v)| v.as_ref().map(|v| (p[k], v)));
        let first = found.next().ok_or(Unfit::Slope(k))?;
        let own = residuals.to_vec();
        let (second, other) = found.next().unwrap_or((at[k], &own));
        let by = second - first.0;
        Ok({ first.1.iter().zip(other) }
            .map(|(a, b)| (b - a) / by)
            .collect())
    };
    (0..at.len()).map(along).collect()
}

/// How sure parameters are.
#[derive(Debug, Clone)]
pub struct Sure {
    /// Residuals less parameters that are free.
    pub freedom: usize,
    /// s: the root of the squared residual over the degrees of freedom.
    pub deviation: f64,
    /// Standard errors; `None` of those at a bound, and of all where some cannot be told apart.
    pub errors: Vec<Option<f64>>,
    /// Half the interval of 95 % over the standard error: Student's t.
    pub factor: f64,
    /// Correlation of parameters; NaN where one has no standard error.
    pub correlation: Vec<Vec<f64>>,
    /// Those at a bound, which are not free.
    pub held: Vec<bool>,
    /// Of which only some combination is known.
    pub alike: Vec<Vec<usize>>,
}

/// Of a fit with slopes; `None` if there are no more residuals than parameters that are free.
pub fn sure(at: &[f64], residuals: &[f64], slopes: &[Vec<f64>]) -> Option<Sure> {
    let n = at.len();
    let held: Vec<bool> = at
        .iter()
        .map(|x| *x < AT_BOUND || *x > 1.0 - AT_BOUND)
        .collect();
    let free: Vec<usize> = (0..n).filter(|k| !held[*k]).collect();
    let freedom = residuals.len().checked_sub(free.len()).filter(|f| *f > 0)?;
    let deviation = (dot(residuals, residuals) / freedom as f64).sqrt();
    let factor = StudentsT::new(0.0, 1.0, freedom as f64)
        .ok()?
        .inverse_cdf(0.975);
    let mut sure = Sure {
        freedom,
        deviation,
        errors: vec![None; n],
        factor,
        correlation: vec![vec![f64::NAN; n]; n],
        held,
        alike: vec![],
    };
    let length: Vec<f64> = free
        .iter()
        .map(|k| dot(&slopes[*k], &slopes[*k]).sqrt())
        .collect();
    let known: Vec<usize> = (0..free.len()).filter(|a| length[*a] > 0.0).collect();
    sure.alike
        .extend({ (0..free.len()).filter(|a| length[*a] == 0.0) }.map(|a| vec![free[a]]));
    if known.is_empty() {
        return Some(sure);
    }
    let entry = |a: usize, b: usize| {
        let (a, b) = (known[a], known[b]);
        dot(&slopes[free[a]], &slopes[free[b]]) / (length[a] * length[b])
    };
    let (values, vectors) = symmetric_eigen(known.len(), entry)?;
    let largest = values.last().copied().unwrap_or(0.0);
    for (value, vector) in values.iter().zip(&vectors) {
        if *value <= SINGULAR * largest {
            let part = |a: &usize| vector[*a].abs() > 0.1;
            sure.alike.push(
                (0..known.len())
                    .filter(part)
                    .map(|a| free[known[a]])
                    .collect(),
            );
        }
    }
    if !sure.alike.is_empty() {
        return Some(sure);
    }
    let inverse = |a: usize, b: usize| -> f64 {
        { values.iter().zip(&vectors) }
            .map(|(l, v)| v[a] * v[b] / l)
            .sum()
    };
    for (a, k) in free.iter().enumerate() {
        sure.errors[*k] = Some(deviation * inverse(a, a).sqrt() / length[a]);
        for (b, j) in free.iter().enumerate() {
            sure.correlation[*k][*j] = inverse(a, b) / (inverse(a, a) * inverse(b, b)).sqrt();
        }
    }
    Some(sure)
}

#[cfg(test)]
mod tests;
