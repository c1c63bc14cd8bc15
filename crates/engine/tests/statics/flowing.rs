//! Equilibrium of what flows: laws that remember have forces and another stiffness at the reference.

use super::*;

/// A plate between two grips that is pulled until bonds break, and let back; plane strain.
fn pulled(law: LawSpec, fracture: Option<FractureSpec>) -> Spec {
    let mut spec = block([11.0, 6.0, 0.0], 2, law);
    spec.space.plane = Plane::Strain;
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.materials[0].fracture = fracture;
    let ends = |name: &str, sign: f64, x: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        }),
    };
    spec.sets = vec![ends("low", 1.0, 1.6), ends("high", -1.0, 9.4)];
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    let pull = "t < 0.7 ? 0.3*t : 0.21 - 0.1*(t - 0.7)";
    hold(&mut spec, "high", [text(pull), number(0.0), None]);
    spec.run.schedule.steps = 6;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0 / 6.0);
    spec
}

fn law(name: &str) -> LawSpec {
    let parameters = [
        ("young", 10.0),
        ("poisson", 0.3),
        ("yield_stress", 0.05),
        ("hardening", 0.5),
    ];
    LawSpec::named(name, Parameters::numbers(&parameters))
}

/// Neither relaxation nor conjugate gradients may take their stiffness from the reference, and both come where factored equations come, through flow,
/// breaks and unloading.
#[test]
fn methods_agree_on_what_flows_and_breaks() {
    for breaks in [false, true] {
        let fracture = breaks.then(|| FractureSpec::new(Criterion::Stretch(0.02)));
        let spec = pulled(law("elastic_plastic"), fracture);
        let of = |method, solver, tolerance| {
            let mut sim = solved(&with(&spec, method, solver, tolerance));
            // points on the yield surface have the slopes of flow, or none, whole
            let body = sim.linear_body().of::<2>().unwrap();
            let asymmetry = body.soundness().asymmetry;
            assert!(asymmetry < 1e-10, "{method:?} {solver:?}: {asymmetry:e}");
            (
                sim.ledger().unwrap(),
                sim.broken(),
                sim.scalars("plastic_strain"),
            )
        };
        let (newton, broken, strain) = of(Method::Newton, Solver::Direct, 1e-9);
        assert_eq!(broken > 0, breaks, "{newton:?}");
        assert!(newton.dissipated > newton.strain, "{newton:?}");
        let most = strain.iter().copied().fold(0.0, f64::max);
        for (method, solver, tolerance) in [
            (Method::Newton, Solver::ConjugateGradients, 1e-9),
            (Method::Relaxation, Solver::Auto, 1e-8),
            (Method::Fire, Solver::Auto, 1e-8),
        ] {
            let (other, count, own) = of(method, solver, tolerance);
            let case = format!("{method:?} {solver:?}, breaks: {breaks}");
            assert_eq!(count, broken, "{case}: {other:?}");
            for (is, expected) in [
                (other.strain, newton.strain),
                (other.dissipated, newton.dissipated),
                (
                    other.work_boundary_conditions,
                    newton.work_boundary_conditions,
                ),
            ] {
                let off = (is / expected - 1.0).abs();
                assert!(off < 1e-4, "{case}: {off:e} {other:?} {newton:?}");
            }
            for (a, b) in own.iter().zip(&strain) {
                assert!((a - b).abs() < 1e-3 * most, "{case}: {a} {b}");
            }
        }
    }
}

/// The stiffness of a law in rate form that bears stress has no energy, and is told apart from a body in which action is not reaction.
#[test]
fn a_stiffness_without_symmetry_is_named_by_its_cause() {
    let spec = pulled(law("hypoelastic_plastic"), None);
    let spec = with(&spec, Method::Newton, Solver::Direct, 1e-8);
    let mut sim = solved(&spec);
    let said = sim.modes(2).unwrap_err().to_string();
    assert!(said.contains("the stiffness is not symmetric"), "{said}");
    assert!(said.contains("laws in rate form under stress"), "{said}");
    assert!(said.contains("of the body at rest"), "{said}");
    // of the body at rest they are found
    let mut rest = build(&spec, Options::default()).unwrap();
    rest.start(true);
    assert!(rest.modes(2).unwrap()[0].square > 0.0);
}

/// A band that is pulled apart by flow: points that have lost all their bonds are no singular equations, and nothing ends in what is not a number.
#[test]
fn a_band_that_flows_and_breaks_stays_in_numbers() {
    let mut spec = block([13.0, 10.0, 0.0], 2, law("hypoelastic_plastic"));
    spec.space.plane = Plane::Strain;
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::PlasticStrain(0.002)));
    let rows = |name: &str, sign: f64, y: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [0.0, y, 0.0],
            normal: [0.0, sign, 0.0],
        }),
    };
    spec.sets = vec![rows("low", 1.0, 2.5), rows("high", -1.0, 7.5)];
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [number(0.0), text("0.06*t"), None]);
    spec.run.schedule.steps = 16;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0 / 16.0);
    let spec = with(&spec, Method::Newton, Solver::Auto, 1e-8);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let mut done = 0;
    while done < 16 {
        match sim.step() {
            Ok(()) => done += 1,
            Err(e) => {
                let said = e.to_string();
                assert!(
                    !said.contains("NaN") && !said.contains("unstable"),
                    "{said}"
                );
                println!("ends in increment {}: {said}", done + 1);
                break;
            }
        }
        let l = sim.ledger().unwrap();
        assert!(
            [
                l.strain,
                l.released,
                l.dissipated,
                l.work_boundary_conditions
            ]
            .iter()
            .all(|x| x.is_finite()),
            "{done}: {l:?}"
        );
        assert!(
            sim.displacements().iter().flatten().all(|u| u.is_finite()),
            "{done}"
        );
    }
    // two points lose all their bonds in increment 14
    assert!(sim.broken() > 0 && done >= 13, "{done}");
}
