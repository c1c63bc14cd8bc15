//! What steps add to u: the estimate, the tolerance, and stops.

use crate::sample::{even, evolution, fixed, line, odd};
use peridyne_transport::{
    Boundary, Bump, Direction, Evaluation, Evolution, Flux, Grid, Law, Method, Operator, RunError,
    StepSize, Stop, measure,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const METHODS: [Method; 3] = [Method::Ssprk3, Method::Rk4, Method::Imex];

fn within(tolerance: f64, duration: f64) -> StepSize {
    StepSize::Within {
        part: 0.8,
        tolerance,
        duration,
    }
}

/// Laws with a time until which they run: nearly a shock, on a ring; what comes in through a collar; a plane.
fn laws() -> Vec<(Law, Evaluation, f64)> {
    let flat = Direction::Constant([1.0, 0.0]);
    let grid = Grid::line(0.0, 1.0, 60).unwrap();
    let (a, s) = (odd(Bump::Cosine, 0.1, 1), even(Bump::Cosine, 0.08, 1));
    let wave = Boundary::Collars(Arc::new(
        |x, t: f64| if x[0] < 0.0 { (9.0 * t).sin() } else { 0.0 },
    ));
    let open = Law::new(
        grid,
        wave,
        Some((Flux::of_mean(&[0.0, 1.0, 0.3]), flat, &a)),
        Some((3e-3, &s)),
    );
    let plane = Grid::plane([0.0; 2], [1.0; 2], 24).unwrap();
    let (a, s) = (odd(Bump::Cosine, 0.15, 2), even(Bump::Cosine, 0.15, 2));
    let turned = Direction::Field([Arc::new(|x, _| 0.5 - x[1]), Arc::new(|x, _| x[0] - 0.5)]);
    let plane = Law::new(
        plane,
        Boundary::Periodic,
        Some((Flux::burgers(), turned, &a)),
        Some((1e-3, &s)),
    );
    vec![
        (
            line(128, Some(Flux::burgers()), Bump::Polynomial(3), 0.4, 0.02),
            Evaluation::Fourier,
            0.9,
        ),
        (open.unwrap(), Evaluation::Direct, 0.7),
        (plane.unwrap(), Evaluation::Fourier, 0.8),
    ]
}

/// From a wave of the ring, in collars from rest.
fn start(law: &Law, evaluation: Evaluation, method: Method, size: StepSize) -> Evolution {
    let length = law.grid.spacing * law.grid.cells[0] as f64;
    let wave = |x: f64| (std::f64::consts::TAU * x / length).sin();
    let rest = |_| 0.0;
    match law.periodic() {
        true => evolution(law, evaluation, wave, method, size),
        false => evolution(law, evaluation, rest, method, size),
    }
}

/// The error that a run states is no smaller than that against steps 1/50 as long as its own, and within the tolerance where the law lets errors grow little.
#[test]
fn stated_errors_are_errors() {
    for (number, (law, evaluation, end)) in laws().iter().enumerate() {
        let mut best = start(law, *evaluation, Method::Rk4, within(1e-11, *end));
        best.run_to(*end).unwrap();
        for method in METHODS {
            for tolerance in [1e-3, 1e-5] {
                let mut e = start(law, *evaluation, method, within(tolerance, *end));
                e.run_to(*end).unwrap();
                let off = measure::distance(&e.u, &best.u);
                let [now, most] = e.error().unwrap();
                let known = best.error().unwrap()[0];
                assert!(
                    off <= now + known && now <= most,
                    "{number} {method:?} {tolerance}: {off:e} {now:e}"
                );
                let allowed = tolerance * e.scale().unwrap();
                assert!(
                    most <= 3.0 * allowed,
                    "{number} {method:?} {tolerance}: {most:e} {allowed:e}"
                );
                // steps that are asked for, whose error is stated too
                let step = *end / (2.0 * e.steps as f64);
                let mut plain = start(law, *evaluation, method, fixed(step));
                let mut told = start(law, *evaluation, method, fixed(step));
                told.estimate();
                plain.run_to(*end).unwrap();
                told.run_to(*end).unwrap();
                assert!(plain.u == told.u && plain.steps == told.steps && plain.error().is_none());
                let off = measure::distance(&told.u, &best.u);
                let [now, _] = told.error().unwrap();
                assert!(
                    off <= now + known,
                    "{number} {method:?} {step}: {off:e} {now:e}"
                );
            }
        }
    }
}

/// The times at which a run is looked at do not change it by more than it states.
#[test]
fn looks_change_no_more_than_the_stated_error() {
    for (number, (law, evaluation, end)) in laws().iter().enumerate() {
        for method in METHODS {
            let run = |looks: u32| {
                let mut e = start(law, *evaluation, method, within(1e-4, *end));
                for k in 1..=looks {
                    e.run_to(*end * f64::from(k) / f64::from(looks)).unwrap();
                }
                e
            };
            let runs = [1, 7, 40].map(run);
            for pair in runs.windows(2) {
                let off = measure::distance(&pair[0].u, &pair[1].u);
                let stated: f64 = pair.iter().map(|e| e.error().unwrap()[0]).sum();
                assert!(off <= stated, "{number} {method:?}: {off:e} {stated:e}");
            }
        }
    }
}

/// Small differences that the law lets grow are stated: past the shock of the inviscid law steps of 1e-6 add much more, and say so.
#[test]
fn growth_is_stated() {
    let law = line(256, Some(Flux::burgers()), Bump::Smooth, 0.15, 0.0);
    let run = |tolerance: f64| {
        let mut e = evolution(
            &law,
            Evaluation::Fourier,
            f64::sin,
            Method::Rk4,
            within(tolerance, 1.5),
        );
        e.run_to(1.5).unwrap();
        e
    };
    let (coarse, fine) = (run(1e-5), run(1e-8));
    let off = measure::distance(&coarse.u, &fine.u);
    let [now, _] = coarse.error().unwrap();
    assert!(off <= now + fine.error().unwrap()[0], "{off:e} {now:e}");
}

/// What jumps in time is stepped over in steps that end, and a state at rest in one.
#[test]
fn jumps_in_time_and_rest_end() {
    let a = odd(Bump::Cosine, 0.1, 1);
    let grid = Grid::line(0.0, 1.0, 40).unwrap();
    for height in [1.0, 0.0] {
        let given = Boundary::Collars(Arc::new(
            move |x, t| if x[0] < 0.0 && t > 0.37 { height } else { 0.0 },
        ));
        let law = Law::new(
            grid,
            given,
            Some((Flux::linear(1.0), Direction::Constant([1.0, 0.0]), &a)),
            None,
        )
        .unwrap();
        let run = |at: &[f64]| {
            let mut e = evolution(
                &law,
                Evaluation::Direct,
                |_| 0.0,
                Method::Rk4,
                within(1e-7, 1.0),
            );
            for end in at {
                e.run_to(*end).unwrap();
            }
            e
        };
        // the jump is not seen, and where a step begins
        let (seen, known) = (run(&[1.0]), run(&[0.37, 1.0]));
        let off = measure::distance(&seen.u, &known.u);
        let stated = seen.error().unwrap()[0] + known.error().unwrap()[0];
        assert!(off <= stated && stated < 1e-5, "{off:e} {stated:e}");
        assert!(seen.steps < 4000, "{}", seen.steps);
    }
}

/// A stop is heard within a step, and leaves the state before it; within conjugate gradients too.
#[test]
fn stops_leave_the_last_state() {
    for (number, (law, evaluation, end)) in laws().into_iter().enumerate() {
        for method in METHODS {
            for after in [0, 1, 5, 12] {
                let asked = Arc::new(AtomicUsize::new(0));
                let seen = asked.clone();
                let mut e = start(&law, evaluation, method, within(1e-4, end));
                e.run_to(0.1 * end).unwrap();
                let before = (e.u.clone(), e.time, e.steps, e.error());
                e.operator.stop_when(Stop::new(move || {
                    seen.fetch_add(1, Ordering::Relaxed) >= after
                }));
                let told = e.step_to(end).unwrap_err();
                assert!(
                    matches!(told, RunError::Ended { .. }),
                    "{number} {method:?} {after}: {told}"
                );
                assert_eq!((e.u.clone(), e.time, e.steps, e.error()), before);
                // it goes on as if it had not been asked
                e.operator.stop_when(Stop::default());
                e.step_to(end).unwrap();
            }
        }
    }
}

/// A flux whose slope is none at an end of its domain has a stable step; one that has no finite slope anywhere is refused instead of taken in one step.
#[test]
fn slopes_at_the_edge_of_a_domain_are_slopes() {
    let root = Flux::Function(Arc::new(|u: f64| u.powf(1.5)));
    assert!((root.fastest(0.0, 1.0) - 1.5).abs() < 1e-4);
    let none = Flux::Function(Arc::new(|u: f64| if u == 0.5 { 0.0 } else { f64::NAN }));
    let law = line(64, Some(none), Bump::Cosine, 0.6, 0.0);
    let e = evolution(
        &law,
        Evaluation::Direct,
        |_| 0.5,
        Method::Rk4,
        StepSize::Part(0.5),
    );
    let told = e.next_step(1.0).unwrap_err();
    assert!(matches!(told, RunError::NoStep { .. }), "{told}");
}

/// What is weighed is more than what is there: state, stages and sums of a law, on grids that only their memory bounds.
#[test]
fn memory_grows_with_all_that_is_kept() {
    use peridyne_transport::memory::bytes;
    let line = |n: usize| Grid::line(0.0, 1.0, n).unwrap();
    let short = bytes(&line(1_000_000), [Some(1e-5), None], false);
    assert!((150e6..400e6).contains(&short), "{short:e}");
    assert!(bytes(&line(1_000_000), [Some(1e-5), None], true) > short + 100e6);
    // half a million spacings: tables of transforms eight times as long, and ghosts
    assert!(bytes(&line(1_000_000), [Some(1e-5), Some(0.5)], false) > short + 400e6);
    assert!(bytes(&line(1 << 40), [Some(1e-9), None], false) > 1e14);
    let plane = Grid::plane([0.0; 2], [1.0; 2], 1000).unwrap();
    let near = bytes(&plane, [Some(0.01), None], false);
    assert!(bytes(&plane, [Some(0.4), None], false) > near + 0.5e9);
    assert!(
        Operator::new(
            crate::sample::line(64, None, Bump::Cosine, 0.6, 0.1),
            Evaluation::Direct
        )
        .is_ok()
    );
}
