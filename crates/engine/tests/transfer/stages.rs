//! Heat through statics and the motion after it.

use crate::sample::*;
use peridyne::run::{Options, build};
use peridyne::spec::*;

fn newton() -> Statics {
    Statics {
        method: Method::Newton,
        tolerance: 1e-12,
        ..Statics::default()
    }
}

fn held(set: &str, x: [Option<&str>; 2]) -> ConditionSpec {
    let [x, y] = x.map(|e| e.map(text));
    ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement([x, y, None]),
    }
}

/// A bar whose low end is held at a temperature, and whose high end cools.
fn bar(method: DiffusionMethod) -> Spec {
    let mut heat = heat(method);
    heat.initial = vec![("all".into(), text("1 + 0.3*sin(5*x)"))];
    let law = Exchange::Convection {
        coefficient: text("0.7"),
        ambient: text("0.2"),
    };
    heat.conditions = vec![
        on("low", DiffusionKind::Value(text("1"))),
        on("high", DiffusionKind::Exchange { law, area: None }),
    ];
    let mut spec = still(1, cells(1, 0.1, [0.0; 3], [2.0; 3]), 2, 1e-3, heat);
    spec.sets = vec![beyond("low", 0.1, -1.0), beyond("high", 1.9, 1.0)];
    spec
}

/// The same, pulled in so many increments and then let go.
fn pulled(method: DiffusionMethod, increments: u64, duration: Option<f64>) -> Spec {
    let mut spec = bar(method);
    let pull = ConditionSpec {
        set: "high".into(),
        kind: ConditionKind::BodyForce([Some(text("1e-3")), None, None]),
    };
    let low = held("low", [Some("0"), None]);
    spec.run.preload = Some(PreloadSpec {
        statics: newton(),
        increments,
        duration,
        conditions: vec![low.clone(), pull],
        rigid_bodies: vec![],
        cuts: vec![],
    });
    spec.loading.conditions = vec![low];
    spec.run.schedule.stepper = Stepper::Verlet;
    spec
}

/// Temperatures and accounts after some steps.
fn after(spec: &Spec, steps: u64) -> Vec<f64> {
    let mut sim = built(spec);
    run(&mut *sim, steps);
    let mut all = temperature(&mut *sim);
    for (_, account) in sim.diffusions() {
        all.extend([account.content, account.held, account.exchanged]);
        assert!(account.residual().abs() < 1e-10, "{account:?}");
    }
    all
}

fn same(a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

/// Heat does not see whether a body rests, is loaded or moves: it goes on through both stages as in a body that stands still for as long.
#[test]
fn heat_goes_on_from_statics_into_motion() {
    for method in [EXPLICIT, EULER, CRANK_NICOLSON, STEADY] {
        let spec = pulled(method, 4, Some(4e-3));
        for steps in [4, 5, 12] {
            same(&after(&spec, steps), &after(&bar(method), steps));
        }
    }
}

/// Increments whose t is the factor of a load take no time: nothing flows in them.
#[test]
fn nothing_flows_in_statics_without_a_duration() {
    for method in [EXPLICIT, EULER, CRANK_NICOLSON] {
        let spec = pulled(method, 3, None);
        for steps in [0, 1, 8] {
            same(&after(&spec, 3 + steps), &after(&bar(method), steps));
        }
    }
}

/// A warm body that is free to expand is `1 + α ΔT` times as large in equilibrium, and rests when it may move.
#[test]
fn a_body_rests_that_statics_has_let_expand() {
    let laws = [
        LawSpec::Pmb(PmbStiffness::Young(1.0)),
        LawSpec::Lps(Moduli {
            young: 1.0,
            poisson: 0.3,
        }),
    ];
    for law in laws {
        let mut heat = heat(EXPLICIT);
        heat.reference = 20.0;
        heat.materials[0].expansion = 1e-4;
        heat.initial = vec![("all".into(), text("80"))];
        let mut spec = still(2, cells(2, 1.0, [0.0; 3], [6.0, 5.0, 0.0]), 2, 0.1, heat);
        spec.bonds.influence = Influence::Inverse;
        spec.materials[0].law = law.clone();
        spec.sets = ["x", "y"]
            .map(|axis| SetSpec {
                name: axis.into(),
                members: Members::Where(text(&format!("{axis} < 1"))),
            })
            .to_vec();
        // the lowest rows glide where the expansion about the origin puts them
        let glide = vec![
            held("x", [Some("0.5*60e-4"), None]),
            held("y", [None, Some("0.5*60e-4")]),
        ];
        spec.run.preload = Some(PreloadSpec {
            statics: newton(),
            increments: 1,
            duration: None,
            conditions: glide.clone(),
            rigid_bodies: vec![],
            cuts: vec![],
        });
        spec.loading.conditions = glide;
        spec.run.schedule.stepper = Stepper::Verlet;
        let mut sim = built(&spec);
        for steps in [1, 50] {
            run(&mut *sim, steps);
            let kinetic = sim.ledger().unwrap().kinetic;
            assert!(kinetic < 1e-20, "{law:?}: {kinetic:e}");
            let snapshot = sim.snapshot(&[], false);
            let each = snapshot.reference.iter().zip(snapshot.displacement());
            for (x, u) in each {
                for a in 0..2 {
                    assert!((u[a] - 6e-3 * x[a]).abs() < 1e-9, "{law:?}: {u:?} at {x:?}");
                }
            }
        }
    }
}

/// What is held at a temperature that changes would be told the same times twice.
#[test]
fn a_temperature_that_changes_has_no_two_stages() {
    let mut spec = pulled(EXPLICIT, 2, Some(2e-3));
    let conditions = &mut spec.interactions.diffusions[0].conditions;
    conditions[0] = on("low", DiffusionKind::Value(text("1 + t")));
    let error = build(&spec, Options::default()).err().unwrap();
    assert_eq!(error.path, "heat");
    assert!(error.message.contains("t begins again"), "{error}");
}
