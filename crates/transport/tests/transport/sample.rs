//! Laws that the tests share.

use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Grid, Kernel, Law, Method, Operator,
    Parity, Profile, StepSize,
};
use std::f64::consts::PI;

pub const BUMPS: [Bump; 5] = [
    Bump::Hat,
    Bump::Cosine,
    Bump::Polynomial(1),
    Bump::Polynomial(3),
    Bump::Smooth,
];

pub fn odd(bump: Bump, horizon: f64, dimension: usize) -> Kernel {
    Kernel::new(
        Parity::Odd,
        Profile::Slope(bump),
        horizon,
        dimension,
        false,
        "advection.kernel",
    )
    .unwrap()
}

pub fn even(bump: Bump, horizon: f64, dimension: usize) -> Kernel {
    Kernel::new(
        Parity::Even,
        Profile::Value(bump),
        horizon,
        dimension,
        false,
        "diffusion.kernel",
    )
    .unwrap()
}

/// A periodic law on `n` cells from 0 to 2π.
pub fn line(n: usize, flux: Option<Flux>, bump: Bump, horizon: f64, viscosity: f64) -> Law {
    let (a, s) = (odd(bump, horizon, 1), even(bump, horizon, 1));
    let grid = Grid::line(0.0, 2.0 * PI, n).unwrap();
    let flux = flux.map(|f| (f, Direction::Constant([1.0, 0.0]), &a));
    Law::new(
        grid,
        Boundary::Periodic,
        flux,
        (viscosity > 0.0).then_some((viscosity, &s)),
    )
    .unwrap()
}

pub fn operator(law: &Law, evaluation: Evaluation) -> Operator {
    Operator::new(law.clone(), evaluation).unwrap()
}

pub fn evolution(
    law: &Law,
    evaluation: Evaluation,
    u: impl Fn(f64) -> f64,
    method: Method,
    size: StepSize,
) -> Evolution {
    let u = law.grid.sample(|x| u(x[0]));
    Evolution::new(operator(law, evaluation), u, method, size)
}

pub fn fixed(step: f64) -> StepSize {
    StepSize::Fixed {
        step,
        force_unstable: false,
    }
}
