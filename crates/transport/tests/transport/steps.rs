//! Steps in time: orders, limits of stability, the implicit step.

use crate::sample::{evolution, fixed, line, operator};
use peridyne_transport::step::stable_step;
use peridyne_transport::{
    Boundary, Bump, Evaluation, Flux, Grid, Law, Method, RunError, StepSize, measure,
};
use std::sync::Arc;

const METHODS: [(Method, f64); 3] = [
    (Method::Ssprk3, 3.0),
    (Method::Rk4, 4.0),
    (Method::Imex, 2.0),
];

#[test]
fn methods_have_their_orders() {
    for (method, order) in METHODS {
        let law = line(48, Some(Flux::burgers()), Bump::Cosine, 0.6, 0.05);
        let run = |n: u32| {
            let mut e = evolution(
                &law,
                Evaluation::Fourier,
                f64::sin,
                method,
                fixed(0.8 / f64::from(n)),
            );
            e.run_to(0.8).unwrap();
            assert_eq!(e.steps, u64::from(n));
            e.u
        };
        let best = run(1280);
        let sizes = [20, 40, 80];
        let errors = sizes.map(|n| measure::distance(&run(n), &best));
        let orders = measure::orders(&sizes.map(|n| 1.0 / f64::from(n)), &errors);
        assert!(
            orders.iter().all(|o| *o > order - 0.2),
            "{method:?}: {errors:?} {orders:?}"
        );
    }
}

/// Waves of all lengths: below the limit none grows, a little above it one does.
#[test]
fn the_limit_of_the_step_is_where_waves_begin_to_grow() {
    for (flux, viscosity) in [(Some(Flux::linear(1.0)), 0.0), (None, 0.3)] {
        for method in [Method::Ssprk3, Method::Rk4] {
            let law = line(256, flux.clone(), Bump::Polynomial(2), 0.3, viscosity);
            let u: Vec<f64> = (0..256).map(|i| ((i * i) as f64 * 0.37).sin()).collect();
            let limit = stable_step(&operator(&law, Evaluation::Direct), method, &u, 0.0);
            for (part, grows) in [(0.999, false), (1.06, true)] {
                let size = StepSize::Fixed {
                    step: part * limit,
                    force_unstable: true,
                };
                let mut e = evolution(&law, Evaluation::Direct, |_| 0.0, method, size);
                e.u.clone_from(&u);
                let before = measure::energy(&e.u, 1.0);
                for _ in 0..600 {
                    if e.step(part * limit).is_err() {
                        break;
                    }
                }
                let after = measure::energy(&e.u, 1.0);
                assert_eq!(
                    after > before,
                    grows,
                    "{method:?} {viscosity} {part}: {before} {after}"
                );
            }
        }
    }
}

/// Transport and diffusion together: the straight line between both ends lies in the region.
#[test]
fn both_limits_together_are_stable() {
    for method in [Method::Ssprk3, Method::Rk4] {
        let amplification = |z: (f64, f64)| {
            let times =
                |a: (f64, f64), b: (f64, f64)| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
            let orders = if method == Method::Rk4 { 4 } else { 3 };
            let (mut term, mut sum) = ((1.0, 0.0), (1.0, 0.0));
            for k in 1..=orders {
                term = times(term, (z.0 / f64::from(k), z.1 / f64::from(k)));
                sum = (sum.0 + term.0, sum.1 + term.1);
            }
            f64::hypot(sum.0, sum.1)
        };
        let [i, r] = match method {
            Method::Ssprk3 => [3f64.sqrt(), 2.512_745_326_618_333],
            Method::Rk4 | Method::Imex => [8f64.sqrt(), 2.785_293_563_405_282],
        };
        for k in 0..=1000 {
            let part = f64::from(k) / 1000.0;
            assert!(amplification((-r * part, i * (1.0 - part))) <= 1.0 + 1e-12);
        }
        // ends are ends
        assert!(amplification((-1.001 * r, 0.0)) > 1.0 && amplification((0.0, 1.001 * i)) > 1.0);
    }
}

/// Diffusion implicit: steps a thousand times the explicit limit, in Fourier space, by conjugate gradients on the same grid, and with collars.
#[test]
fn stiff_diffusion_takes_long_steps() {
    let law = line(128, Some(Flux::burgers()), Bump::Smooth, 0.3, 500.0);
    let u: Vec<f64> = (0..128)
        .map(|i| 0.1 * ((i * i) as f64 * 0.37).sin())
        .collect();
    let explicit = stable_step(&operator(&law, Evaluation::Direct), Method::Rk4, &u, 0.0);
    let dt = 1000.0 * explicit;
    let [a, b] = [Evaluation::Fourier, Evaluation::Direct].map(|way| {
        let mut e = evolution(&law, way, |_| 0.0, Method::Imex, fixed(dt));
        e.u.clone_from(&u);
        for _ in 0..5 {
            let next = e.next_step(1.0).unwrap().min(dt);
            e.step(next).unwrap();
        }
        e.u
    });
    assert!(
        measure::distance(&a, &b) < 1e-12,
        "{:e}",
        measure::distance(&a, &b)
    );
    let mean = measure::mass(&u, 1.0 / 128.0);
    assert!(a.iter().all(|v| (v - mean).abs() < 1e-3));
    let s = crate::sample::even(Bump::Smooth, 0.3, 1);
    let grid = Grid::line(0.0, 1.0, 40).unwrap();
    let given = Boundary::Collars(Arc::new(|x, t| x[0] + t));
    let law = Law::new(grid, given, None, Some((1.0, &s))).unwrap();
    // (1 − c S) u = f of the linear u is u itself
    let mut u = grid.sample(|x| x[0] + 0.7);
    let before = u.clone();
    operator(&law, Evaluation::Direct)
        .solve(50.0, 0.7, &mut u)
        .unwrap();
    assert!(
        measure::distance(&u, &before) < 1e-11,
        "{:e}",
        measure::distance(&u, &before)
    );
}

#[test]
fn unstable_steps_are_refused_and_bad_states_left_alone() {
    let law = line(64, Some(Flux::burgers()), Bump::Cosine, 0.6, 0.0);
    let e = evolution(
        &law,
        Evaluation::Direct,
        f64::sin,
        Method::Ssprk3,
        fixed(10.0),
    );
    let told = e.next_step(100.0).unwrap_err().to_string();
    assert!(
        told.contains("is unstable") && told.contains("steps up to"),
        "{told}"
    );
    let root = Flux::Function(Arc::new(|u: f64| u.sqrt()));
    let law = line(64, Some(root), Bump::Cosine, 0.6, 0.0);
    let mut e = evolution(
        &law,
        Evaluation::Direct,
        |x| 0.01 + x.sin().abs(),
        Method::Ssprk3,
        fixed(1.0),
    );
    e.u[3] = -0.5;
    let before = e.u.clone();
    let told = e.step(0.1).unwrap_err();
    assert!(matches!(told, RunError::NotFinite { .. }), "{told}");
    assert_eq!((e.u, e.time, e.steps), (before, 0.0, 0));
}

/// What comes in through a collar counts for the step, also where u is still 0 everywhere and where the collar is 0 until later.
#[test]
fn collars_count_for_the_step() {
    let a = crate::sample::odd(Bump::Cosine, 0.2, 1);
    let grid = Grid::line(0.0, 1.0, 50).unwrap();
    let law = |given: fn(f64) -> f64| {
        let boundary = Boundary::Collars(Arc::new(
            move |x, t| if x[0] < 0.0 { given(t) } else { 0.0 },
        ));
        let flux = (
            Flux::burgers(),
            peridyne_transport::Direction::Constant([1.0, 0.0]),
            &a,
        );
        Law::new(grid, boundary, Some(flux), None).unwrap()
    };
    let step = |given| {
        let e = evolution(
            &law(given),
            Evaluation::Direct,
            |_| 0.0,
            Method::Rk4,
            StepSize::Part(0.5),
        );
        e.next_step(1e5).unwrap()
    };
    let periodic = line(
        50,
        Some(Flux::burgers()),
        Bump::Cosine,
        0.2 * 2.0 * std::f64::consts::PI,
        0.0,
    );
    let one = vec![1.0; 50];
    // the same grid and horizon, 2π times as long
    let limit = stable_step(
        &operator(&periodic, Evaluation::Direct),
        Method::Rk4,
        &one,
        0.0,
    ) / (2.0 * std::f64::consts::PI);
    // a whole number of steps leads to the end
    let found = step(|_| 1.0);
    assert!(
        (found / (0.5 * limit) - 1.0).abs() < 1e-5,
        "{found} {limit}"
    );
    let rising = step(|t| if t > 0.0 { 1.0 } else { 0.0 });
    assert!(
        (rising / (0.5 * limit) - 1.0).abs() < 1e-5,
        "{rising} {limit}"
    );
    // a given step that is too long for what comes in is refused
    let e = evolution(
        &law(|_| 1.0),
        Evaluation::Direct,
        |_| 0.0,
        Method::Rk4,
        fixed(1.1 * limit),
    );
    assert!(matches!(e.next_step(10.0), Err(RunError::Unstable { .. })));
}
