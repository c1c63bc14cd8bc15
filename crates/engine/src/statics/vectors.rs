//! Sums over points with a fixed order, so that solvers give the same bits for any number of threads.

use crate::execute::exact::Exact;
use rayon::prelude::*;

/// What a point resists with against its own place (force / length).
pub type Block<const D: usize> = [[f64; D]; D];

/// The same number along every axis.
pub fn diagonal<const D: usize>(x: f64) -> Block<D> {
    crate::array::from_fn(|a| crate::array::from_fn(|b| if a == b { x } else { 0.0 }))
}

/// Points per partial sum.
const CHUNK: usize = 4096;

/// `x · y`
pub fn dot<const D: usize>(x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
    let part = |(x, y): (&[[f64; D]], &[[f64; D]])| -> f64 {
        let both = x.iter().zip(y);
        both.map(|(x, y)| (0..D).map(|a| x[a] * y[a]).sum::<f64>())
            .sum()
    };
    let parts: Vec<f64> = x
        .par_chunks(CHUNK)
        .zip(y.par_chunks(CHUNK))
        .map(part)
        .collect();
    parts.iter().sum()
}

/// `x · y` without rounding, for solvers that ranks share.
pub fn product<const D: usize>(x: &[[f64; D]], y: &[[f64; D]]) -> Exact {
    let part = |(x, y): (&[[f64; D]], &[[f64; D]])| -> Exact {
        let (x, y) = (x.as_flattened().iter(), y.as_flattened());
        x.zip(y).map(|(x, y)| x * y).collect()
    };
    let parts: Vec<Exact> = x
        .par_chunks(CHUNK)
        .zip(y.par_chunks(CHUNK))
        .map(part)
        .collect();
    let mut sum = Exact::ZERO;
    parts.iter().for_each(|part| sum.merge(part));
    sum
}

/// `y += s x`
pub fn add<const D: usize>(y: &mut [[f64; D]], s: f64, x: &[[f64; D]]) {
    y.par_chunks_mut(CHUNK)
        .zip(x.par_chunks(CHUNK))
        .for_each(|(y, x)| {
            for (y, x) in y.iter_mut().zip(x) {
                for a in 0..D {
                    y[a] = s.mul_add(x[a], y[a]);
                }
            }
        });
}

/// `y = x + s y`
pub fn add_to_multiple<const D: usize>(y: &mut [[f64; D]], s: f64, x: &[[f64; D]]) {
    y.par_chunks_mut(CHUNK)
        .zip(x.par_chunks(CHUNK))
        .for_each(|(y, x)| {
            for (y, x) in y.iter_mut().zip(x) {
                for a in 0..D {
                    y[a] = s.mul_add(y[a], x[a]);
                }
            }
        });
}

/// `√(x · x)`
pub fn norm<const D: usize>(x: &[[f64; D]]) -> f64 {
    dot(x, x).sqrt()
}
