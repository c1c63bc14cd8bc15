//! Relaxation of a strain that is held: of shear exactly, of a bar with free sides.

use super::{block, e, led, stress};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn elastic() -> Parameters {
    Parameters::numbers(&[("young", 1.0), ("poisson", 0.3)])
}

fn viscoelastic(branches: &[[f64; 2]]) -> LawSpec {
    let rows = branches.iter().map(|b| b.to_vec()).collect();
    LawSpec::named(
        "viscoelastic",
        elastic().with("branches", Parameter::Rows(rows)),
    )
}

fn lps() -> LawSpec {
    LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    })
}

/// `σ(t) = Gγ (1 − Σλ + Σ λ (τ/t₁)(e^(t₁/τ) − 1) e^(−t/τ))` after a ramp of length t₁, which here is one step.
#[test]
fn shear_relaxes_by_its_modulus() {
    let branches = [[0.5, 3.0], [0.2, 40.0]];
    let slid = |law: LawSpec| {
        let mut spec = block(LatticeKind::Cubic, [9; 3], 2, law);
        led(&mut spec, ["1e-7*y*min(t, 1)", "0", "0"])
    };
    let mut solid = slid(lps());
    solid.step().unwrap();
    let at_once = stress(solid.as_mut(), "xy");
    let mut sim = slid(viscoelastic(&branches));
    for n in 1..=60 {
        sim.step().unwrap();
        let relaxed: f64 = branches
            .iter()
            .map(|[part, time]| {
                let ramp = time * (1.0 / time).exp_m1();
                part * (ramp * (-f64::from(n) / time).exp() - 1.0)
            })
            .sum();
        let found = stress(sim.as_mut(), "xy") / at_once;
        assert!(
            (found - (1.0 + relaxed)).abs() < 1e-6,
            "{n}: {found} is not {}",
            1.0 + relaxed
        );
    }
}

/// The pull of a bar with free sides, whose bulk modulus stays and whose shear modulus has one branch:
/// `E(t) = E∞ + (E₀ − E∞) e^(−t/τ_E)`, `1/τ_E = (3K b + G a)/(3K + G)`, `b = 1/τ`, `a = (1 − λ)/τ`, `E₀ = 9KG/(3K + G)`,
/// `E∞ = 9KG a/(3K b + G a)` (the elastic solution in Laplace space), after a ramp of length t₁.
#[test]
fn a_bar_relaxes_as_the_classical_one() {
    let (part, time, ramp) = (0.6, 500.0f64, 100.0f64);
    // a step, and how it is made: an increment of statics, a large implicit step, or a small explicit one
    let pull_by = |law: LawSpec, stepper: Stepper, step: f64| -> Vec<f64> {
        let mut spec = block(LatticeKind::Cubic, [16, 4, 4], 2, law);
        let end = |sign: f64| {
            Members::Region(Region::HalfSpace {
                point: [6.0 * sign, 0.0, 0.0],
                normal: [-sign, 0.0, 0.0],
            })
        };
        spec.sets = [("low", -1.0), ("high", 1.0)]
            .map(|(name, sign)| SetSpec {
                name: name.into(),
                members: end(sign),
            })
            .to_vec();
        let held = |set: &str, u: &str| ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([Some(e(u)), None, None]),
        };
        let statics = matches!(stepper, Stepper::Statics(_));
        spec.loading.conditions = vec![
            held("low", "0"),
            held("high", &format!("1e-4*min(t/{ramp}, 1)")),
        ];
        if statics {
            // two sides slide, which hinders no contraction
            for (name, axis) in [("front", 1), ("bottom", 2)] {
                let mut point = [0.0; 3];
                point[axis] = -1.0;
                let normal = std::array::from_fn(|a| if a == axis { 1.0 } else { 0.0 });
                spec.sets.push(SetSpec {
                    name: name.into(),
                    members: Members::Region(Region::HalfSpace { point, normal }),
                });
                spec.loading.conditions.push(ConditionSpec {
                    set: name.into(),
                    kind: ConditionKind::Displacement(std::array::from_fn(|a| {
                        (a == axis).then(|| e("0"))
                    })),
                });
            }
        } else {
            spec.loading.conditions.push(ConditionSpec {
                set: "all".into(),
                kind: ConditionKind::Damping(e("0.1")),
            });
        }
        spec.run.probes = vec![ProbeSpec {
            name: "pull".into(),
            set: "high".into(),
            measure: Measure::Reaction,
        }];
        spec.run.schedule.stepper = stepper;
        spec.run.schedule.time_step = TimeStep::Fixed(step);
        let every = (150.0 / step) as usize;
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut all = vec![];
        for n in 1..=10 * every {
            sim.step().unwrap();
            if n % every == 0 && n > 2 * every {
                all.push(sim.measure()[0]);
            }
        }
        all
    };
    let (k, g) = (1.0 / 1.2, 1.0 / 2.6);
    let (b, a) = (1.0 / time, (1.0 - part) / time);
    let at_once = 9.0 * k * g / (3.0 * k + g);
    let at_last = 9.0 * k * g * a / (3.0 * k * b + g * a);
    let of_bar = (3.0 * k + g) / (3.0 * k * b + g * a);
    let spread = of_bar / ramp * (ramp / of_bar).exp_m1();
    let timed = Statics {
        method: Method::Newton,
        timed: true,
        ..Statics::default()
    };
    let mut explicit = vec![];
    for (stepper, step) in [
        (Stepper::Verlet, 0.25),
        (Stepper::Newmark(Newmark::default()), 10.0),
        (Stepper::Statics(timed), 50.0),
    ] {
        let found = pull_by(viscoelastic(&[[part, time]]), stepper, step);
        let solids = pull_by(lps(), stepper, step);
        for ((n, relaxed), solid) in found.iter().enumerate().zip(solids) {
            let t = 150.0 * (n + 3) as f64;
            let classical =
                (at_last + (at_once - at_last) * spread * (-t / of_bar).exp()) / at_once;
            let ratio = relaxed / solid;
            println!("t = {t}: {ratio:.4}, classical {classical:.4}");
            // what a bar of four points misses is its surface, and the same by all
            if stepper == Stepper::Verlet {
                assert!(
                    (ratio - classical).abs() < 0.02,
                    "{t}: {ratio} is not {classical}"
                );
                explicit.push(ratio);
            }
            assert!(
                (ratio - explicit[n]).abs() < 0.01,
                "{t}: {ratio} is not {} by {stepper:?}",
                explicit[n]
            );
        }
    }
}

/// `σ_xy = σ_y/√3 (1 + C ln(γ̇/(√3 ε̇₀)))` of steady shear without hardening, by explicit and by implicit steps.
#[test]
fn an_implicit_step_tells_a_law_of_rates_its_length() {
    let law = LawSpec::named(
        "hypoelastic_plastic",
        Parameters::numbers(&[
            ("young", 1.0),
            ("poisson", 0.3),
            ("yield_stress", 1e-5),
            ("rate_sensitivity", 0.1),
            ("reference_rate", 1e-8),
        ])
        .with("rate_law", Parameter::Word("johnson_cook".into())),
    );
    let exact = 1e-5 / 3f64.sqrt() * 0.1f64.mul_add((1e3 / 3f64.sqrt()).ln(), 1.0);
    for stepper in [
        Stepper::Verlet,
        Stepper::Newmark(Newmark::default()),
        Stepper::Newmark(Newmark::hht(-0.1)),
    ] {
        // the point in the middle and all its partners have full families
        let mut spec = block(LatticeKind::Cubic, [9; 3], 2, law.clone());
        spec.bonds.influence = Influence::Constant;
        spec.run.schedule.stepper = stepper;
        let mut sim = led(&mut spec, ["1e-5*y*t", "0", "0"]);
        for _ in 0..20 {
            sim.step().unwrap();
        }
        let found = stress(sim.as_mut(), "xy");
        assert!(
            (found / exact - 1.0).abs() < 2e-3,
            "{found} is not {exact} by {stepper:?}"
        );
    }
}

/// Creep of a bar under a pull that grows for a time t₁ and stays, of the bulk modulus K and one branch of the shear modulus: strains follow
/// `J(t) = 1/9K + (1 − λ e^(−(1 − λ)t/τ))/(3G(1 − λ))` (the elastic solution in Laplace space). Off by the square of the increment.
#[test]
fn a_bar_creeps_in_equilibrium() {
    let (part, time, ramp, pull) = (0.6, 3.0f64, 2.0f64, 1e-7);
    let (k, g) = (1.0 / 1.2, 1.0 / 2.6);
    let rate = (1.0 - part) / time;
    let lasting = 1.0 / (9.0 * k) + 1.0 / (3.0 * g * (1.0 - part));
    let exact = |t: f64| {
        let gone = ((-rate * (t - ramp)).exp() - (-rate * t).exp()) / (rate * ramp);
        pull * (lasting - part / (3.0 * g * (1.0 - part)) * gone)
    };
    let off = |parts: u32| {
        let law = viscoelastic(&[[part, time]]);
        let mut spec = block(LatticeKind::Chain, [61, 1, 1], 2, law);
        let of = |name: &str, members: &str| SetSpec {
            name: name.into(),
            members: Members::Where(e(members)),
        };
        spec.sets = vec![
            of("low", "x < -28.5"),
            of("high", "x > 28.5"),
            of("middle", "abs(x) < 0.5"),
        ];
        // two points at either end
        let pulled = |set: &str, sign: f64| ConditionSpec {
            set: set.into(),
            kind: ConditionKind::BodyForce([
                Some(e(&format!("{:e}*min(t/{ramp}, 1)", 0.5 * sign * pull))),
                None,
                None,
            ]),
        };
        spec.loading.conditions = vec![
            pulled("low", -1.0),
            pulled("high", 1.0),
            ConditionSpec {
                set: "middle".into(),
                kind: ConditionKind::Displacement([Some(e("0")), None, None]),
            },
        ];
        let step = 1.0 / f64::from(parts);
        spec.run.schedule.time_step = TimeStep::Fixed(step);
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            method: Method::Newton,
            timed: true,
            tolerance: 1e-12,
            ..Statics::default()
        });
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut worst = 0.0f64;
        for n in 1..=12 * parts {
            sim.step().unwrap();
            let t = f64::from(n) * step;
            if t <= ramp {
                continue;
            }
            let snapshot = sim.snapshot(&[], false);
            let u = snapshot.displacement();
            let found = (u[33][0] - u[27][0]) / 6.0;
            worst = worst.max((found / exact(t) - 1.0).abs());
        }
        worst
    };
    let errors = [1, 2, 4].map(off);
    assert!(errors[2] < 2e-3, "{errors:?}");
    let falls = [errors[0] / errors[1], errors[1] / errors[2]];
    assert!(falls.iter().all(|f| (3.0..6.0).contains(f)), "{errors:?}");
}
