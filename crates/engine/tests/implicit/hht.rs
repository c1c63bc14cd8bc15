//! The method of Hilber, Hughes and Taylor against its amplification matrix; what it takes from the energy.

use super::*;

/// One step of `u'' = −ω² u` as the method says it, `[u, Δt v, Δt² a]`, `w = ωΔt`: the rows of Hilber, Hughes & Taylor (1977),
/// solved for the three.
fn amplified(alpha: f64, w: f64, [u, v, a]: [f64; 3]) -> [f64; 3] {
    let (beta, gamma) = (0.25 * (1.0 - alpha).powi(2), 0.5 - alpha);
    let ahead = u + v + (0.5 - beta) * a;
    let rate = w * w * ((1.0 + alpha) * ahead - alpha * u);
    let next = -rate / (1.0 + w * w * (1.0 + alpha) * beta);
    [
        ahead + beta * next,
        v + (1.0 - gamma) * a + gamma * next,
        next,
    ]
}

/// Two points, one of them held: an oscillator with ω = 1.
fn oscillator(alpha: f64, w: f64, u: f64) -> Box<dyn Simulation> {
    let mut spec = block([1.0, 0.0, 0.0], 1, SPRINGS, 1);
    spec.loading.conditions.push(ConditionSpec {
        set: "low".into(),
        kind: ConditionKind::Displacement([text("0"), None, None]),
    });
    spec.loading.initial.push(InitialSpec {
        set: "high".into(),
        displacement: [text(&format!("{u}")), None, None],
        velocity: [None, None, None],
    });
    spec.run.schedule.stepper = Stepper::Newmark(Newmark {
        tolerance: 1e-14,
        ..Newmark::hht(alpha)
    });
    spec.run.schedule.time_step = TimeStep::Fixed(w);
    built(&spec)
}

#[test]
fn an_oscillator_goes_as_the_amplification_matrix_says() {
    for alpha in [0.0, -0.05, -0.1, -0.3, -1.0 / 3.0] {
        for w in [0.1, 1.0, 10.0, 300.0] {
            let mut sim = oscillator(alpha, w, 0.01);
            let mut state = [0.01, 0.0, -w * w * 0.01];
            for n in 0..60 {
                sim.step().unwrap();
                state = amplified(alpha, w, state);
                let u = sim.displacements()[1][0];
                assert!(
                    (u - state[0]).abs() < 1e-11 * 0.01,
                    "α = {alpha}, ωΔt = {w}, step {n}: {u:e}, not {:e}",
                    state[0]
                );
            }
        }
    }
}

/// Far above the step, a mode keeps `(1 + α)/(1 − α)` of itself in a step.
#[test]
fn what_is_fast_is_damped_by_the_spectral_radius() {
    for alpha in [-0.05, -0.1, -0.2, -1.0 / 3.0] {
        let mut sim = oscillator(alpha, 1e4, 0.01);
        // a root met several times falls as n² ρⁿ: far steps are asked
        let at = |sim: &mut dyn Simulation| {
            let (u, v) = (sim.displacements()[1][0], sim.velocities()[1][0]);
            u.abs().max(v.abs() * 1e4)
        };
        (0..10).for_each(|_| sim.step().unwrap());
        let early = at(sim.as_mut());
        (0..60).for_each(|_| sim.step().unwrap());
        let each = (at(sim.as_mut()) / early).powf(1.0 / 60.0);
        let exact = (1.0 + alpha) / (1.0 - alpha);
        // (70/10)^(2/60) is 1.07
        assert!(each < 1.08 * exact, "α = {alpha}: {each} {exact}");
        assert!(each > 0.95 * exact, "α = {alpha}: {each} {exact}");
    }
}

#[test]
fn it_is_of_second_order_and_takes_little_of_what_is_slow() {
    for alpha in [-0.1, -0.3] {
        let mut errors = vec![];
        for steps in [200u32, 400, 800] {
            let (duration, omega) = (17.0, 2.0 * (3.0 * PI / 40.0).sin());
            let mut spec = block([19.0, 0.0, 0.0], 1, SPRINGS, 1);
            start(&mut spec, "0.01*cos(3*pi*(x+0.5)/20)", ["0", "0"]);
            spec.run.schedule.stepper = Stepper::Newmark(Newmark::hht(alpha));
            spec.run.schedule.time_step = TimeStep::Fixed(duration / f64::from(steps));
            let mut sim = built(&spec);
            (0..steps).for_each(|_| sim.step().unwrap());
            let u = sim.displacements()[0][0] / (3.0 * PI * 0.5 / 20.0).cos();
            errors.push((u / 0.01 - (omega * duration).cos()).abs());
            let l = sim.ledger().unwrap();
            assert!(l.numerical > 0.0 && l.numerical < 0.1 * l.initial, "{l:?}");
        }
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!(
                (order - 2.0).abs() < 0.1,
                "α = {alpha}: order {order}, {errors:?}"
            );
        }
    }
}

/// Of a linear body the account of the method closes the balance to round-off, whatever is lost.
#[test]
fn what_the_method_takes_has_an_account_of_its_own() {
    let plain = Newmark {
        beta: 0.3025,
        gamma: 0.6,
        ..Newmark::default()
    };
    for options in [Newmark::hht(-0.1), Newmark::hht(-0.3), plain] {
        let mut spec = block([11.0, 6.0, 0.0], 2, SPRINGS, 2);
        start(
            &mut spec,
            "0.02*sin(2*x*y)",
            ["0.01*sin(3*x+y)", "0.02*cos(x-2*y)"],
        );
        spec.loading.conditions.push(ConditionSpec {
            set: "high".into(),
            kind: ConditionKind::BodyForce([text("1e-3*sin(t)"), None, None]),
        });
        spec.run.schedule.stepper = Stepper::Newmark(Newmark {
            tolerance: 1e-13,
            ..options
        });
        spec.run.schedule.time_step = TimeStep::Fraction(3.0);
        let mut sim = built(&spec);
        let first = sim.ledger().unwrap();
        for _ in 0..100 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            assert!(l.residual().abs() < 1e-11 * first.initial, "{l:?}");
        }
        let l = sim.ledger().unwrap();
        assert!(l.numerical > 0.2 * first.initial, "{l:?}");
    }
}
