//! The bits do not know how many threads there are.

use crate::sample::{even, odd};
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Formula, Grid, Law, Method, Operator,
    StepSize,
};
use std::sync::Arc;

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// Two steps of a law, and the rate of its energy, in bits.
fn bits(law: &Law, evaluation: Evaluation, method: Method) -> Vec<u64> {
    let u = { law.grid }.sample(|x| (5.0 * x[0]).sin() + 0.3 * (7.0 * x[1] + x[0]).cos());
    let operator = Operator::new(law.clone(), evaluation).unwrap();
    let mut e = Evolution::new(operator, u, method, StepSize::Part(0.5));
    for _ in 0..2 {
        let dt = e.next_step(1e9).unwrap();
        e.step(dt).unwrap();
    }
    let rate = e.operator.energy_rate(&e.u, e.time);
    e.u.iter().chain([&rate]).map(|u| u.to_bits()).collect()
}

#[test]
fn one_two_and_three_threads_give_the_same_bits() {
    let function = || {
        let f = Formula::new("abs(x)*x/2 + sin(x)", &[]).unwrap();
        Flux::of_formula(f, -2.0, 2.0)
    };
    let collars = || Boundary::Collars(Arc::new(|x: &[f64; 3], t| x[0] + t));
    let field = || {
        Direction::Field([
            Arc::new(|x, _| x[1].sin()),
            Arc::new(|x, _| (2.0 * x[0]).cos()),
        ])
    };
    let mut laws = vec![];
    // not a whole number of pieces
    let line = Grid::line(0.0, 1.0, 33_001).unwrap();
    for (flux, boundary) in [
        (Flux::burgers(), Boundary::Periodic),
        (Flux::of_mean(&[0.1, 1.0, 0.5, 0.2]), collars()),
        (function(), Boundary::Periodic),
        (function(), collars()),
    ] {
        let (a, s) = (
            odd(Bump::Cosine, 12.3 * line.spacing, 1),
            even(Bump::Cosine, 9.0 * line.spacing, 1),
        );
        let flux = Some((flux, Direction::Constant([1.0, 0.0]), &a));
        laws.push(Law::new(line, boundary, flux, Some((1e-5, &s))).unwrap());
    }
    let plane = Grid::plane([0.0, 0.0], [1.0, 0.5], 150).unwrap();
    for (flux, direction, boundary) in [
        (Flux::burgers(), field(), Boundary::Periodic),
        (Flux::burgers(), Direction::Constant([0.6, 0.8]), collars()),
        (function(), field(), Boundary::Periodic),
    ] {
        let (a, s) = (
            odd(Bump::Cosine, 4.5 * plane.spacing, 2),
            even(Bump::Cosine, 4.0 * plane.spacing, 2),
        );
        let flux = Some((flux, direction, &a));
        laws.push(Law::new(plane, boundary, flux, Some((1e-4, &s))).unwrap());
    }
    for (number, law) in laws.iter().enumerate() {
        for evaluation in [Evaluation::Direct, Evaluation::Fourier] {
            if evaluation == Evaluation::Fourier && !law.is_convolution() {
                continue;
            }
            for method in [Method::Ssprk3, Method::Rk4, Method::Imex] {
                let [one, two, three] =
                    [1, 2, 3].map(|n| on_threads(n, || bits(law, evaluation, method)));
                assert!(
                    one == two && one == three,
                    "law {number} {evaluation:?} {method:?}"
                );
            }
        }
    }
}
