//! What is left of a body whose bonds have broken: its equations, its balance, and what nothing holds.

use super::*;

/// Springs of stiffness 1 in a row from 0 to 10 that break at a stretch of 0.03, but for the two in the middle.
fn chain() -> Spec {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(1.0));
    let mut spec = block([10.0, 0.0, 0.0], 1, law);
    spec.bonds.horizon = Horizon::Ratio(1);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.03)));
    spec.sets.push(SetSpec {
        name: "tough".into(),
        members: Members::Region(Region::Block {
            low: [3.9, 0.0, 0.0],
            high: [6.1, 0.0, 0.0],
        }),
    });
    spec.damage.toughness.push(ToughnessSpec {
        set: "tough".into(),
        factor: ToughnessFactor::Stretch(text("100").unwrap()),
    });
    hold(&mut spec, "low", [number(0.0), None, None]);
    spec.run.schedule.steps = 4;
    spec.run.schedule.time_step = TimeStep::Fixed(0.25);
    spec
}

/// Every way to find an equilibrium, and the tolerance of its forces.
const ALL: [(Method, Solver, f64); 6] = [
    (Method::Linear, Solver::Direct, 1e-12),
    (Method::Linear, Solver::ConjugateGradients, 1e-12),
    (Method::Newton, Solver::Direct, 1e-12),
    (Method::Newton, Solver::ConjugateGradients, 1e-12),
    (Method::Relaxation, Solver::Auto, 1e-9),
    (Method::Fire, Solver::Auto, 1e-9),
];

/// A chain that is pulled apart: at t = 0.75 its ten springs have a stretch of 0.0375, and eight of them break. Points that have lost theirs rest where
/// they are; the two springs that hold three points together, which nothing holds, pull them together, and what they held is lost.
#[test]
fn points_that_have_lost_their_bonds_rest_where_they_are() {
    let spring = 0.5 * 0.0375f64.powi(2);
    for (method, solver, tolerance) in ALL {
        let mut spec = with(&chain(), method, solver, tolerance);
        hold(&mut spec, "high", [text("0.5*t"), None, None]);
        let mut sim = solved(&spec);
        let case = format!("{method:?} {solver:?}");
        let u = sim.displacements();
        let ledger = sim.ledger().unwrap();
        // relaxation ends where forces are 1e-9 of the greatest; displacements of chains of ten are 1e2 of that
        let bound = 1e3 * tolerance;
        for n in (1..4).chain(7..10) {
            let off = u[n][0] - 0.0375 * n as f64;
            assert!(off.abs() < bound, "{case}, point {n}: {off:e}");
        }
        assert_eq!([u[0][0], u[10][0]], [0.0, 0.5], "{case}");
        // made of equal points, they meet at their centre or where the first of them rests
        let meet = match method {
            Method::Relaxation | Method::Fire => 0.1875,
            Method::Linear | Method::Newton => 0.15,
        };
        for n in 4..7 {
            let off = u[n][0] - meet;
            assert!(off.abs() < bound, "{case}, point {n}: {off:e}");
        }
        assert!(ledger.strain < bound * spring, "{case}: {ledger:?}");
        for (is, expected) in [
            (ledger.released, 8.0 * spring),
            (ledger.dissipated, 2.0 * spring),
            (ledger.work_boundary_conditions, 10.0 * spring),
        ] {
            let off = is / expected - 1.0;
            assert!(off.abs() < bound, "{case}: {off:e} {ledger:?}");
        }
        assert!(
            ledger.residual().abs() < bound * spring,
            "{case}: {ledger:?}"
        );
    }
}

/// The same pulled by a force: nothing holds the last point when its spring has broken, and that is said instead of singular equations.
#[test]
fn a_load_on_what_nothing_holds_is_an_error_that_names_the_point() {
    for (method, solver, tolerance) in ALL {
        let mut spec = with(&chain(), method, solver, tolerance);
        spec.loading.conditions.push(ConditionSpec {
            set: "high".into(),
            kind: ConditionKind::BodyForce([text("0.05*t"), None, None]),
        });
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let said = loop {
            match sim.step() {
                Ok(()) => assert!(sim.step_number() < 4, "{method:?} {solver:?}"),
                Err(e) => break e.to_string(),
            }
        };
        assert!(
            said.contains("nothing holds point 10, and a load acts on it"),
            "{method:?} {solver:?}: {said}"
        );
        assert!(said.contains("prescribe its displacement"), "{said}");
        // linear increments see the break in the one after it
        let last = 2 + u64::from(method == Method::Linear);
        assert_eq!(sim.step_number(), last, "{method:?} {solver:?}");
    }
}

/// Linear solutions one after the other, between which bonds break: factors are those of the body that is left, as sweeps are, and the balance closes
/// through the break, up to which the loads have worked, and through what it leaves out of equilibrium.
#[test]
fn linear_increments_see_what_broke() {
    let of = |solver: Solver| {
        let law = LawSpec::Lps(Moduli {
            young: 2.0,
            poisson: 0.3,
        });
        let mut spec = block([12.0, 12.0, 0.0], 2, law);
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(2e-5)));
        spec.damage.precracks.push(PrecrackSpec {
            shape: CrackShape::Segment {
                from: [5.5, -1.0, 0.0],
                to: [5.5, 3.5, 0.0],
            },
            kind: CrackKind::Broken,
        });
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [text("2.6e-4*t"), number(0.0), None]);
        spec.run.schedule.steps = 5;
        spec.run.schedule.time_step = TimeStep::Fixed(0.2);
        let spec = with(&spec, Method::Linear, solver, 1e-12);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut seen = vec![(sim.broken(), sim.ledger().unwrap())];
        for _ in 0..5 {
            sim.step().unwrap();
            seen.push((sim.broken(), sim.ledger().unwrap()));
        }
        let said = sim.info().warnings.iter();
        (seen, said.filter(|w| w.contains("look once")).count())
    };
    let (direct, told) = of(Solver::Direct);
    let (swept, _) = of(Solver::ConjugateGradients);
    // something breaks before the last increment, which is that of another body
    assert!(direct[4].0 > direct[0].0, "{direct:?}");
    assert_eq!(told, 1);
    for ((broken, one), (as_many, other)) in direct.into_iter().zip(swept) {
        assert_eq!(broken, as_many);
        // forces are 1e-12 of those of the start away
        let off = (one.strain - other.strain).abs();
        assert!(off <= 1e-8 * other.strain, "{off:e} {one:?} {other:?}");
        for ledger in [one, other] {
            let residual = ledger.residual().abs();
            assert!(
                residual <= 1e-8 * ledger.work_boundary_conditions.abs(),
                "{residual:e} {ledger:?}"
            );
        }
    }
}
