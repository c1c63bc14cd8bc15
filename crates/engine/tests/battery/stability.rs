//! Below the stability limit a run stays bounded; above it, it stops with an error and a state that can be looked at.

use crate::sample::*;
use crate::waves::{chain, chain_omega2};
use peridyne::error::RunError;
use peridyne::run::Options;
use peridyne::spec::*;

/// The true limit of the step of a chain of 60 points.
fn limit(name: &str) -> f64 {
    let spec = chain(name, 60);
    let mut sim = at_rest(&spec);
    let largest = (0..=30)
        .map(|k| chain_omega2(&spec, sim.as_mut(), k as f64 / 30.0 * std::f64::consts::PI))
        .fold(0.0, f64::max);
    2.0 / largest.sqrt()
}

#[test]
fn below_the_limit_a_run_stays_bounded() {
    for name in ["pmb", "lps"] {
        let mut spec = chain(name, 60);
        spec.run.schedule.time_step = TimeStep::Fixed(0.99 * limit(name));
        let mut sim = made(&spec);
        sim.set_displacements(&Random(41).vectors(60, 1, 1e-6 * H));
        sim.start(true);
        let start = largest(&sim.displacements());
        let mut top: f64 = 0.0;
        for _ in 0..5000 {
            sim.step().unwrap();
            top = top.max(largest(&sim.displacements()));
        }
        sim.ledger().unwrap();
        assert!(top < 20.0 * start, "{name}: {top:e} from {start:e}");
    }
}

#[test]
fn above_the_limit_a_run_stops_with_a_finite_state() {
    for name in ["pmb", "lps"] {
        let mut spec = chain(name, 60);
        spec.run.schedule.time_step = TimeStep::Fixed(1.05 * limit(name));
        let mut sim = made(&spec);
        assert!(
            sim.info()
                .warnings
                .iter()
                .any(|w| w.contains("stability limit"))
        );
        sim.set_displacements(&Random(41).vectors(60, 1, 1e-6 * H));
        sim.start(true);
        let mut error = None;
        for n in 0..2000 {
            if let Err(e) = sim.step() {
                error = Some((n, e));
                break;
            }
        }
        let (n, error) = error.expect("an unstable run must stop");
        assert!(
            matches!(error, RunError::TooFast { step, .. } if step == n + 1),
            "{error}"
        );
        assert_eq!(sim.step_number(), n);
        for field in [
            sim.displacements(),
            sim.velocities(),
            sim.vectors("force_density"),
        ] {
            assert!(field.iter().flatten().all(|c| c.is_finite()));
        }
        assert!(sim.ledger().is_err(), "the balance shows it too");
    }
}

#[test]
fn the_ledger_sees_an_unstable_run_before_it_bursts() {
    for case in cases()
        .into_iter()
        .filter(|c| c.material.name == "lps" && c.d() > 1)
    {
        let mut spec = case.spec();
        spec.run.schedule.time_step = TimeStep::Fraction(1.1);
        let mut sim = made(&spec);
        let n = sim.vectors("reference").len();
        sim.set_displacements(&Random(43).vectors(n, case.d(), 1e-8 * H));
        sim.start(true);
        let seen = (0..500).find_map(|_| {
            sim.step().expect("the ledger should have seen it");
            sim.ledger().err()
        });
        assert!(
            matches!(seen, Some(RunError::Unstable { .. })),
            "{}",
            case.name()
        );
    }
}

#[test]
fn a_step_above_the_limit_is_refused() {
    for case in cases() {
        let mut spec = case.spec();
        spec.run.schedule.time_step = TimeStep::Fraction(1.01);
        spec.run.schedule.force_unstable = false;
        let error = build(&spec, Options::default())
            .err()
            .expect("too long a step");
        assert!(
            error.message.contains("above the stability limit"),
            "{error}"
        );
        spec.run.schedule.time_step = TimeStep::Fraction(0.99);
        assert!(build(&spec, Options::default()).is_ok());
    }
}

/// Energy asked for at the very step at which something begins is no sign of instability.
#[test]
fn a_run_that_begins_is_not_unstable() {
    for case in cases() {
        let ramp = ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::BodyForce([Some(e("0.01*t")), None, None]),
        };
        let mut spec = case.spec();
        spec.loading.conditions = vec![ramp];
        let mut sim = made(&spec);
        sim.start(true);
        for _ in 0..3 {
            sim.step().unwrap();
            sim.ledger().unwrap();
        }
        // S = C : E of soft directions gives way under a ball that is as stiff: below 1/√3 of its length a bar pushes less the more it is pushed
        if !case.material.is_isotropic() {
            continue;
        }
        let mut spec = case.spec();
        spec.loading.rigid_bodies = vec![RigidBodySpec::sphere(
            10.0,
            H,
            RigidBodyMotion::Kinematic([e("-0.6+0.3*t"), e("0"), e("0")]),
        )];
        let mut sim = made(&spec);
        sim.start(true);
        // it touches in the first steps; rubber that it has gone through is stiffer than its step allows
        for _ in 0..12 {
            sim.step()
                .unwrap_or_else(|e| panic!("{}: {e}", case.name()));
            sim.ledger().unwrap();
        }
    }
}

/// A point without a place stops the run at once, and the error says which one.
#[test]
fn a_displacement_that_is_not_a_number_stops_the_run() {
    for case in cases() {
        for place in [f64::NAN, f64::INFINITY] {
            let mut sim = made(&case.spec());
            assert!(sim.write("displacement", 0, 3, &[place]));
            sim.start(true);
            let error = sim.step().expect_err("a point is nowhere").to_string();
            assert!(error.contains("point 4"), "{}: {error}", case.name());
        }
    }
}
