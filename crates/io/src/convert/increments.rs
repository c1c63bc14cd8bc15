//! What a prescribed displacement of Peridigm comes to.
//!
//! Each step adds `f(t) − f(t of the step before)` to what is there; where that is 0, the displacement becomes f itself. Hence f where it
//! does not depend on time, and `u₀ + f(t) − f(t₀)` where it changes in every step, from the initial displacement u₀ and the initial
//! time t₀ on.

use super::clock::Clock;
use super::points::Points;
use super::program::Program;
use super::solver::Solver;
use peridyne::expression::Expression;

/// What conditions act on, and when.
pub struct Stage<'a> {
    pub program: Program,
    pub points: &'a Points,
    pub names: &'a [String],
    pub solver: &'a Solver,
    pub dimension: usize,
}

/// Most steps that are looked at.
const STEPS: u64 = 1000;

/// The displacement of a set, and whether it differs from `value`; `before` are initial displacements with their points.
///
/// # Errors
/// It is no expression, or no one expression says what it comes to.
pub fn total(
    value: &str,
    set: &str,
    before: &[(&str, Vec<u32>)],
    stage: &Stage,
) -> Result<(String, bool), String> {
    let (clock, from) = (stage.solver.clock, stage.solver.from);
    let plain = clock.expression(value)?;
    let time = Clock {
        start: 0.0,
        scale: 1.0,
    };
    let parse = |text: &str| {
        Expression::parse(text, &[]).map_err(|e| format!("no expression: {}", e.message))
    };
    let f = parse(&time.expression(value)?)?;
    if !f.depends_on_time() {
        return Ok((plain, false));
    }
    let points = stage.points.of(set);
    let at = |i: &u32| &stage.points.position[*i as usize];
    // the last one that holds a point is what it starts with
    let mut starts = vec![];
    for (text, on) in before {
        let text = time.at(text, 0.0)?;
        starts.push((parse(&text)?, text, on));
    }
    let start = |i: &u32| {
        let last = starts.iter().rev().find(|s| s.2.binary_search(i).is_ok());
        last.map_or(0.0, |s| s.0.eval(at(i), 0.0))
    };
    let offset = |i: &u32| start(i) - f.eval(at(i), from);
    let size = { points.iter() }
        .map(|i| f.eval(at(i), from).abs().max(start(i).abs()))
        .fold(0.0, f64::max);
    let moved: Vec<u32> = { points.iter().copied() }
        .filter(|i| offset(i).abs() > 1e-12 * size)
        .collect();
    if moved.is_empty() {
        return Ok((plain, false));
    }
    if moved.iter().any(|i| keeps(&f, at(i), stage)) {
        return Err("Peridigm adds what it changes by in each step, from another value on than its first, and takes it itself in steps in which it does not change: no one expression says that; write the displacement that is meant".into());
    }
    let first = offset(&points[0]);
    if points
        .iter()
        .all(|i| (offset(i) - first).abs() <= 1e-12 * size)
    {
        let sign = if first < 0.0 { '-' } else { '+' };
        return Ok((format!("({plain}) {sign} {:?}", first.abs()), true));
    }
    let gone = format!("({plain}) - ({})", clock.at(value, from)?);
    let mut whole = starts.iter().rev();
    match whole.find(|s| points.iter().any(|i| s.2.binary_search(i).is_ok())) {
        None => Ok((gone, true)),
        Some(s) if points.iter().all(|i| s.2.binary_search(i).is_ok()) => {
            Ok((format!("{gone} + ({})", s.1), true))
        }
        Some(_) => Err("some of its points have an initial displacement, which Peridigm adds to: split the set".into()),
    }
}

/// Does it stay the same over a step at a place, or over two on end where steps are not known one by one?
fn keeps(f: &Expression, x: &[f64; 3], stage: &Stage) -> bool {
    let solver = stage.solver;
    let steps = solver.steps.unwrap_or(STEPS).max(1);
    let step = (solver.to - solver.from) / steps as f64;
    let at = |n: u64| f.eval(x, solver.from + n as f64 * step);
    let every = steps.div_ceil(STEPS);
    (0..steps).step_by(every as usize).any(|n| {
        let [a, b, c] = [n, n + 1, n + 2].map(at);
        a == b && (b == c || (every == 1 && solver.steps.is_some()))
    })
}
