//! The factors nearest to 1 that satisfy the equations: a convex quadratic programme, then a polish to round-off.

use super::equations::Equations;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT,
    SolverStatus, ZeroConeT,
};

/// Lower bounds on factors that are tried, highest first. Factors that the equations force to vanish are left out.
const FLOORS: [f64; 4] = [0.25, 0.1, 0.02, 0.0];
/// Factors at most this far above their bound stay there while the rest is polished.
const HELD: f64 = 1e-7;
/// What counts as solved, of the largest term.
const SOLVED: f64 = 1e-13;
/// Weight of staying near 1 against the residual, where equations cannot be satisfied.
const NEAR_ONE: f64 = 1e-6;

/// Factors that satisfy the equations.
#[derive(Debug, Clone)]
pub struct Solution {
    pub factors: Vec<f64>,
    /// Lowest factor that was allowed, of those that need not vanish.
    pub floor: f64,
}

/// Unknowns that must vanish because a sum of terms of one sign does.
fn forced(equations: &Equations) -> Vec<bool> {
    let mut zero = vec![false; equations.unknowns];
    loop {
        let mut found = false;
        for (row, b) in equations.rows.iter().zip(&equations.right) {
            let mut open = row.iter().filter(|(k, _)| !zero[*k]);
            let Some((_, first)) = open.next() else {
                continue;
            };
            if *b == 0.0 && open.all(|(_, a)| a.signum() == first.signum()) {
                row.iter().for_each(|(k, _)| zero[*k] = true);
                found = true;
            }
        }
        if !found {
            return zero;
        }
    }
}

/// Columns of a matrix, from entries in order of rows.
fn matrix(rows: usize, columns: usize, entries: &[(usize, usize, f64)]) -> CscMatrix<f64> {
    let mut start = vec![0usize; columns + 1];
    entries.iter().for_each(|(_, c, _)| start[c + 1] += 1);
    for c in 0..columns {
        start[c + 1] += start[c];
    }
    let mut next = start.clone();
    let (mut row, mut value) = (vec![0; entries.len()], vec![0.0; entries.len()]);
    for (r, c, x) in entries {
        (row[next[*c]], value[next[*c]]) = (*r, *x);
        next[*c] += 1;
    }
    CscMatrix::new(rows, columns, start, row, value)
}

fn settings() -> DefaultSettings<f64> {
    DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_feas(1e-11)
        .tol_gap_abs(1e-11)
        .tol_gap_rel(1e-11)
        .build()
        .unwrap_or_default()
}

/// `min ½ Σ (λ − 1)² + ½/NEAR_ONE Σ r²` with `A λ − r = b` and `λ ≥ floor`; r = 0 unless `soft`.
fn programme(
    equations: &Equations,
    floor: &[f64],
    soft: bool,
) -> Result<(SolverStatus, Vec<f64>), String> {
    let (n, m) = (equations.unknowns, equations.rows.len());
    let slack = if soft { m } else { 0 };
    let mut objective: Vec<(usize, usize, f64)> = (0..n).map(|k| (k, k, 1.0)).collect();
    objective.extend((0..slack).map(|k| (n + k, n + k, 1.0 / NEAR_ONE)));
    let mut linear = vec![-1.0; n];
    linear.resize(n + slack, 0.0);
    let mut entries = vec![];
    for (e, row) in equations.rows.iter().enumerate() {
        entries.extend(row.iter().map(|(k, a)| (e, *k, *a)));
        if soft {
            entries.push((e, n + e, -1.0));
        }
    }
    let mut right = equations.right.clone();
    for (k, floor) in floor.iter().enumerate() {
        entries.push((m + k, k, -1.0));
        right.push(-floor);
    }
    let mut solver = DefaultSolver::new(
        &matrix(n + slack, n + slack, &objective),
        &linear,
        &matrix(m + n, n + slack, &entries),
        &right,
        &[ZeroConeT(m), NonnegativeConeT(n)],
        settings(),
    )
    .map_err(|e| e.to_string())?;
    solver.solve();
    let mut x = solver.solution.x.clone();
    x.truncate(n);
    Ok((solver.solution.status, x))
}

/// The nearest solution of the equations in the unknowns that are free (conjugate gradients on the normal equations
/// from zero: the shortest correction). Returns whether it is one to round-off.
fn polish(equations: &Equations, x: &mut [f64], free: &[bool]) -> bool {
    let scale = equations.right.iter().fold(1.0f64, |m, b| m.max(b.abs()));
    let largest = |r: &[f64]| r.iter().fold(0.0f64, |m, r| m.max(r.abs()));
    let dot = |a: &[f64]| a.iter().map(|x| x * x).sum::<f64>();
    let gradient = |r: &[f64]| {
        let mut g = equations.transposed(r);
        g.iter_mut()
            .zip(free)
            .filter(|(_, free)| !**free)
            .for_each(|(g, _)| *g = 0.0);
        g
    };
    for _ in 0..4 {
        let mut r: Vec<f64> = equations.residual(x).iter().map(|r| -r).collect();
        if largest(&r) <= SOLVED * scale {
            return true;
        }
        let mut g = gradient(&r);
        let mut p = g.clone();
        let mut gg = dot(&g);
        let enough = 1e-34 * gg.max(1e-30);
        for _ in 0..20 * equations.unknowns.min(2000) {
            if gg <= enough {
                break;
            }
            let q: Vec<f64> = equations
                .rows
                .iter()
                .map(|row| row.iter().map(|(k, a)| a * p[*k]).sum())
                .collect();
            let alpha = gg / dot(&q);
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += alpha * p);
            r.iter_mut().zip(&q).for_each(|(r, q)| *r -= alpha * q);
            g = gradient(&r);
            let new = dot(&g);
            p.iter_mut()
                .zip(&g)
                .for_each(|(p, g)| *p = g + new / gg * *p);
            gg = new;
        }
    }
    largest(&equations.residual(x)) <= 10.0 * SOLVED * scale
}

/// Least change from 1 with the highest of [`FLOORS`] that goes; `None` if no non-negative factors do it.
///
/// # Errors
/// What the solver of quadratic programmes says about its input.
pub fn exact(equations: &Equations) -> Result<Option<Solution>, String> {
    let zero = forced(equations);
    for at_least in FLOORS {
        let floor: Vec<f64> = zero
            .iter()
            .map(|z| if *z { 0.0 } else { at_least })
            .collect();
        let (status, mut x) = programme(equations, &floor, false)?;
        if !matches!(
            status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        ) {
            continue;
        }
        let free: Vec<bool> = x
            .iter()
            .zip(&floor)
            .zip(&zero)
            .map(|((x, f), zero)| !zero && x - f > HELD)
            .collect();
        for ((x, f), free) in x.iter_mut().zip(&floor).zip(&free) {
            if !free {
                *x = *f;
            }
        }
        if polish(equations, &mut x, &free) && x.iter().zip(&floor).all(|(x, f)| *x >= f - 1e-6) {
            return Ok(Some(Solution {
                factors: x,
                floor: at_least,
            }));
        }
    }
    Ok(None)
}

/// Non-negative factors that leave the least squares of residuals.
///
/// # Errors
/// As [`exact`].
pub fn nearest(equations: &Equations) -> Result<Vec<f64>, String> {
    let (_, x) = programme(equations, &vec![0.0; equations.unknowns], true)?;
    Ok(x.iter().map(|x| x.max(0.0)).collect())
}

/// The numbers of any sign nearest to 1 that satisfy the equations, or leave the least squares of residuals; do they satisfy?
pub fn shortest(equations: &Equations) -> (Vec<f64>, bool) {
    let mut x = vec![1.0; equations.unknowns];
    let exact = polish(equations, &mut x, &vec![true; equations.unknowns]);
    (x, exact)
}
