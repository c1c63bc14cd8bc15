//! Velocity Verlet: energy that does not drift, and an error of second order in the step.

use crate::sample::*;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

fn small(kind: LatticeKind, cells: [usize; 3]) -> Place {
    Place {
        kind,
        plane: Plane::Stress,
        ratio: 2,
        cells,
    }
}

/// Slope of a straight line through `y` over 0..1.
fn trend(y: &[f64]) -> f64 {
    let n = y.len() as f64;
    let mean = y.iter().sum::<f64>() / n;
    let (mut xy, mut xx) = (0.0, 0.0);
    for (i, y) in y.iter().enumerate() {
        let x = (i as f64 + 0.5) / n - 0.5;
        xy += x * (y - mean);
        xx += x * x;
    }
    xy / xx
}

#[test]
fn energy_does_not_drift() {
    for place in [
        small(LatticeKind::Chain, [12, 1, 1]),
        small(LatticeKind::Square, [4, 5, 1]),
        small(LatticeKind::Cubic, [3, 3, 3]),
    ] {
        for name in ["pmb", "lps", "lps mixed"] {
            let case = Case::of(name, place);
            let mut wobble = vec![];
            for fraction in [0.5, 0.25] {
                let mut spec = case.spec();
                spec.run.schedule.time_step = TimeStep::Fraction(fraction);
                let mut sim = made(&spec);
                let n = sim.vectors("reference").len();
                sim.set_displacements(&Random(29).vectors(n, case.d(), 0.004 * H));
                sim.start(true);
                let start = sim.ledger().unwrap();
                let total = start.strain + start.kinetic;
                let energy: Vec<f64> = (0..2500)
                    .map(|_| {
                        steps(sim.as_mut(), 4);
                        let l = sim.ledger().unwrap();
                        (l.strain + l.kinetic) / total - 1.0
                    })
                    .collect();
                let mean = energy.iter().sum::<f64>() / energy.len() as f64;
                let spread = (energy.iter().map(|e| (e - mean).powi(2)).sum::<f64>()
                    / energy.len() as f64)
                    .sqrt();
                let drift = trend(&energy);
                println!(
                    "{name} on {:?}: wobble {spread:.1e}, drift {drift:.1e} of the energy in 10,000 steps of {fraction}",
                    place.kind
                );
                // the trend of a wobble without drift is √(12/n) of it, a few times over
                assert!(
                    drift.abs() < 0.3 * spread,
                    "{}: {drift:e} of {spread:e}",
                    case.name()
                );
                assert!(
                    spread < 0.2 * fraction * fraction,
                    "{}: {spread:e}",
                    case.name()
                );
                wobble.push(spread);
            }
            let ratio = wobble[0] / wobble[1];
            assert!((3.0..6.5).contains(&ratio), "the wobble is O(Δt²): {ratio}");
        }
    }
}

/// Every kind of condition whose force depends on positions and time only.
#[test]
fn the_error_is_of_second_order_in_the_step() {
    for place in [
        small(LatticeKind::Chain, [12, 1, 1]),
        small(LatticeKind::Triangular, [5, 3, 1]),
        small(LatticeKind::Cubic, [4, 3, 3]),
    ] {
        for name in ["pmb mixed", "lps"] {
            let case = Case::of(name, place);
            let mut spec = case.spec();
            let end = 6.0;
            spec.loading.conditions = vec![ConditionSpec {
                set: "all".into(),
                kind: ConditionKind::BodyForce([Some(e("0.05*sin(3*t+x)")), None, None]),
            }];
            spec.sets.push(SetSpec {
                name: "foot".into(),
                members: Members::Region(peridyne::space::region::Region::HalfSpace {
                    point: [0.1 * H, 0.0, 0.0],
                    normal: [1.0, 0.0, 0.0],
                }),
            });
            spec.loading.conditions.push(ConditionSpec {
                set: "foot".into(),
                kind: ConditionKind::Displacement([Some(e("0.02*sin(2*t)")), None, None]),
            });
            let mut run = |n: usize| {
                spec.run.schedule.time_step = TimeStep::Fixed(end / n as f64);
                let mut sim = made(&spec);
                let count = sim.vectors("reference").len();
                sim.set_velocities(&Random(31).vectors(count, case.d(), 0.02));
                sim.start(true);
                steps(sim.as_mut(), n);
                (sim.displacements(), sim.velocities())
            };
            let exact = run(3200);
            let errors: Vec<[f64; 2]> = [100, 200, 400]
                .into_iter()
                .map(|n| {
                    let (u, v) = run(n);
                    [distance(&u, &exact.0), distance(&v, &exact.1)]
                })
                .collect();
            for k in 0..2 {
                let (a, b) = (errors[0][k] / errors[1][k], errors[1][k] / errors[2][k]);
                println!(
                    "{name} on {:?}: {} errors fall by {a:.2}, {b:.2}",
                    place.kind,
                    ["position", "velocity"][k]
                );
                assert!(
                    (3.5..4.6).contains(&a) && (3.7..4.4).contains(&b),
                    "{}: {a}, {b}",
                    case.name()
                );
            }
        }
    }
}

/// A run taken back by turning all velocities ends where it began.
#[test]
fn motion_is_reversible() {
    let case = Case::of("lps", small(LatticeKind::Bcc, [3, 3, 2]));
    let mut sim = made(&case.spec());
    let n = sim.vectors("reference").len();
    let u0 = Random(37).vectors(n, 3, 0.02 * H);
    sim.set_displacements(&u0);
    sim.start(true);
    steps(sim.as_mut(), 200);
    let away = distance(&sim.displacements(), &u0);
    let v: Vec<_> = sim.velocities().iter().map(|v| v.map(|c| -c)).collect();
    sim.set_velocities(&v);
    steps(sim.as_mut(), 200);
    let back = distance(&sim.displacements(), &u0);
    assert!(away > 0.01 * H && back < 1e-10 * away, "{away:e} {back:e}");
}

/// Damping of a body that moves as a whole, `ρ v' = −c(t) v`: the closed form, to second order in the step.
#[test]
fn damping_is_of_second_order_and_may_change_in_time() {
    for place in [
        small(LatticeKind::Chain, [6, 1, 1]),
        small(LatticeKind::Square, [4, 4, 1]),
        small(LatticeKind::Cubic, [3, 3, 3]),
    ] {
        for (c, integral) in [("0.8", 0.8 * 2.0), ("0.8*t", 0.4 * 4.0)] {
            let case = Case::of("lps", place);
            let error = |n: usize| {
                let mut spec = case.spec();
                spec.loading.conditions = vec![ConditionSpec {
                    set: "all".into(),
                    kind: ConditionKind::Damping(e(c)),
                }];
                spec.run.schedule.time_step = TimeStep::Fixed(2.0 / n as f64);
                let mut sim = made(&spec);
                let count = sim.vectors("reference").len();
                sim.set_velocities(&vec![[0.3, 0.0, 0.0]; count]);
                sim.start(true);
                steps(sim.as_mut(), n);
                let l = sim.ledger().unwrap();
                assert!(l.residual().abs() < 1e-3 * l.dissipated, "{c}: {l:?}");
                sim.velocities()[0][0] / 0.3 - (-integral / RHO).exp()
            };
            let errors: Vec<f64> = [20, 40, 80].into_iter().map(error).collect();
            let (a, b) = (errors[0] / errors[1], errors[1] / errors[2]);
            println!(
                "damping by {c} on {:?}: off by {:.1e}, falls by {a:.2}, {b:.2}",
                place.kind, errors[2]
            );
            assert!(
                errors[2].abs() < 1e-4 && (3.8..4.2).contains(&b),
                "{c}: {errors:?}"
            );
        }
    }
}
