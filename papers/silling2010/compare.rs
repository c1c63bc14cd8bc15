//! Equilibrium, and how far two levels are apart.

use peridyne::statics::{Direct, LinearBody, Support};

use crate::Failure;

pub fn failed(e: impl std::fmt::Display) -> Failure {
    Failure::new(e.to_string())
}

/// Displacements of a body with some points held, under body force densities.
pub fn equilibrium<const D: usize>(
    body: &LinearBody<D>,
    held: &[(usize, [f64; D])],
    density: &[(usize, [f64; D])],
) -> Result<Vec<[f64; D]>, Failure> {
    let mut support = Support::none(body.points());
    let mut given = vec![[0.0; D]; body.points()];
    for (i, u) in held {
        support.free[*i] = [false; D];
        given[*i] = *u;
    }
    let mut force: Vec<[f64; D]> = (0..body.points()).map(|i| body.force(&given, i)).collect();
    for (i, b) in density {
        for a in 0..D {
            force[*i][a] += b[a];
        }
    }
    for (f, v) in force.iter_mut().zip(&body.volume) {
        *f = f.map(|f| f * v);
    }
    let factors = Direct::new(body, &support, 0.0).map_err(failed)?;
    let mut u = factors.solve(&force);
    for (i, given) in held {
        u[*i] = *given;
    }
    Ok(u)
}

/// Largest difference of components over the largest of `b`.
pub fn largest<const D: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> f64 {
    let most = b.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let off = a.as_flattened().iter().zip(b.as_flattened());
    off.fold(0.0f64, |m, (a, b)| m.max((a - b).abs())) / most
}
