//! Equilibrium and vibration against closed forms, and one method against the others.

#[path = "statics/flowing.rs"]
mod flowing;
#[path = "statics/path.rs"]
mod path;
#[path = "statics/preload.rs"]
mod preload;
#[path = "statics/sequence.rs"]
mod sequence;
#[path = "statics/torn.rs"]
mod torn;
#[path = "statics/touching.rs"]
mod touching;

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn number(x: f64) -> Option<Expression> {
    Some(Expression::parse(&format!("{x:e}"), &[]).unwrap())
}

fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

/// A block of whole spacings from 0 to `size` (in spacings of 1), its low and high ends along x as sets.
fn block(size: [f64; 3], d: usize, law: LawSpec) -> Spec {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let body = BodySpec::Lattice {
        kind,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: std::array::from_fn(|a| if a < d { size[a] } else { 0.0 }),
        },
        perturb: None,
    };
    let mut spec = Spec::new(d, body, 1.0, law);
    let end = |name: &str, sign: f64, x: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        }),
    };
    spec.sets = vec![end("low", 1.0, 0.1), end("high", -1.0, size[0] - 0.1)];
    spec.run.schedule = Schedule {
        steps: 1,
        time_step: TimeStep::Fixed(1.0),
        force_unstable: false,
        stepper: Stepper::Statics(Statics::default()),
    };
    spec
}

fn hold(spec: &mut Spec, set: &str, u: [Option<Expression>; 3]) {
    spec.loading.conditions.push(ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement(u),
    });
}

fn solved(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    for _ in 0..spec.run.schedule.steps {
        sim.step().unwrap();
    }
    sim
}

fn with(spec: &Spec, method: Method, solver: Solver, tolerance: f64) -> Spec {
    let mut spec = spec.clone();
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method,
        solver,
        tolerance,
        ..Statics::default()
    });
    spec
}

const SPRINGS: LawSpec = LawSpec::Springs(PmbStiffness::Micromodulus(1.0));

#[test]
fn springs_in_series_stretch_evenly() {
    for solver in [Solver::Direct, Solver::ConjugateGradients] {
        let mut spec = with(
            &block([100.0, 0.0, 0.0], 1, SPRINGS),
            Method::Linear,
            solver,
            1e-13,
        );
        hold(&mut spec, "low", [number(0.0), None, None]);
        hold(&mut spec, "high", [number(0.5), None, None]);
        let mut sim = solved(&spec);
        for (x, u) in sim.vectors("reference").iter().zip(sim.displacements()) {
            assert!((u[0] - 0.005 * x[0]).abs() < 1e-13, "{u:?} at {x:?}");
        }
        // c = 1, volumes 1: each of 100 springs holds ½ 0.005²
        let ledger = sim.ledger().unwrap();
        assert!((ledger.strain - 100.0 * 0.5 * 0.005f64.powi(2)).abs() < 1e-15);
        assert!(ledger.residual().abs() < 1e-15, "{ledger:?}");
    }
}

#[test]
fn a_hanging_chain_is_a_parabola() {
    let mut spec = block([50.0, 0.0, 0.0], 1, SPRINGS);
    hold(&mut spec, "low", [number(0.0), None, None]);
    spec.loading.conditions.push(ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::BodyForce([text("1e-6*t"), None, None]),
    });
    spec.run.schedule.steps = 4;
    spec.run.schedule.time_step = TimeStep::Fixed(0.25);
    let mut sim = solved(&spec);
    // the k-th spring carries all points from k on
    let mut exact = 0.0;
    for (k, u) in sim.displacements().iter().enumerate().skip(1) {
        exact += 1e-6 * (51.0 - k as f64);
        assert!(
            (u[0] - exact).abs() < 1e-12 * exact,
            "{k}: {} {exact}",
            u[0]
        );
    }
    assert!(sim.ledger().unwrap().residual().abs() < 1e-12 * sim.ledger().unwrap().strain);
    assert_eq!(sim.solved().unwrap().iterations, 1);
}

/// A clamped plate or block that is sheared and stretched.
fn clamped(d: usize, law: LawSpec, size: f64) -> Spec {
    let mut spec = block([9.0, 5.0, 4.0], d, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    hold(&mut spec, "low", [number(0.0), number(0.0), number(0.0)]);
    let wave = format!("{size}*(1+0.3*y)");
    hold(&mut spec, "high", [number(2.0 * size), text(&wave), None]);
    spec
}

#[test]
fn methods_agree_where_strains_are_small() {
    let lps = LawSpec::Lps(Moduli {
        young: 3.0,
        poisson: 0.2,
    });
    for d in [2, 3] {
        for law in [LawSpec::Pmb(PmbStiffness::Young(2.0)), lps.clone()] {
            let spec = clamped(d, law.clone(), 1e-9);
            let reference =
                solved(&with(&spec, Method::Linear, Solver::Direct, 1e-12)).displacements();
            for (method, solver, tolerance, apart) in [
                (Method::Linear, Solver::ConjugateGradients, 1e-12, 1e-9),
                (Method::Newton, Solver::Direct, 1e-7, 1e-7),
                (Method::Newton, Solver::ConjugateGradients, 1e-7, 1e-6),
                (Method::Relaxation, Solver::Auto, 1e-7, 1e-5),
                (Method::Fire, Solver::Auto, 1e-7, 1e-5),
            ] {
                let mut sim = solved(&with(&spec, method, solver, tolerance));
                for (u, r) in sim.displacements().iter().zip(&reference) {
                    for a in 0..3 {
                        assert!(
                            (u[a] - r[a]).abs() < apart * 2e-9,
                            "{d}-D {law:?} {method:?} {solver:?}: {u:?} {r:?}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn newton_and_relaxation_agree_where_strains_are_large() {
    let spec = clamped(2, LawSpec::Pmb(PmbStiffness::Young(2.0)), 0.4);
    let mut newton = solved(&with(&spec, Method::Newton, Solver::Auto, 1e-12));
    let mut relaxed = solved(&with(&spec, Method::Relaxation, Solver::Auto, 1e-10));
    let mut fire = solved(&with(&spec, Method::Fire, Solver::Auto, 1e-10));
    let mut linear = solved(&with(&spec, Method::Linear, Solver::Auto, 1e-10));
    let apart = |a: &mut dyn Simulation, b: &mut dyn Simulation| {
        let pairs = a.displacements().into_iter().zip(b.displacements());
        pairs
            .flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs()))
            .fold(0.0, f64::max)
    };
    assert!(apart(newton.as_mut(), relaxed.as_mut()) < 1e-8);
    assert!(apart(newton.as_mut(), fire.as_mut()) < 1e-8);
    assert!(apart(newton.as_mut(), linear.as_mut()) > 1e-3);
    assert!(
        linear
            .info()
            .warnings
            .iter()
            .any(|w| w.contains("method = \"newton\""))
    );
    // in equilibrium the energy is least: nothing moves it down
    let energy = newton.ledger().unwrap().strain;
    let mut u = newton.displacements();
    u[25][1] += 1e-3;
    newton.set_displacements(&u);
    assert!(newton.ledger().unwrap().strain > energy);
}

#[test]
fn newton_converges_in_any_units() {
    // steel in millimetres of metres: bond constants are twenty orders of magnitude from 1
    let mut spec = block(
        [12.0, 4.0, 0.0],
        2,
        LawSpec::Lps(Moduli {
            young: 2e11,
            poisson: 0.3,
        }),
    );
    if let BodySpec::Lattice {
        spacing, region, ..
    } = &mut spec.body
    {
        *spacing = 1e-3;
        *region = Region::Block {
            low: [0.0; 3],
            high: [12e-3, 4e-3, 0.0],
        };
    }
    for (set, x) in spec.sets.iter_mut().zip([0.1e-3, 11.9e-3]) {
        if let Members::Region(Region::HalfSpace { point, .. }) = &mut set.members {
            point[0] = x;
        }
    }
    spec.space.section = 1e-3;
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.bonds.influence = Influence::Inverse;
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [number(1e-5), number(4e-4), None]);
    let mut sim = solved(&with(&spec, Method::Newton, Solver::Direct, 1e-10));
    let iterations = sim.solved().unwrap().iterations;
    assert!(iterations <= 5, "{iterations}");
    let body = sim.linear_body().of::<2>().unwrap();
    assert!(body.soundness().asymmetry < 1e-12, "{:?}", body.soundness());
    assert!(sim.modes(4).unwrap()[0].square > 0.0);
}

#[test]
fn modes_of_a_chain_are_the_closed_form() {
    // held at one end, free at the other: ω_k = 2 sin((2k−1)π / (2(2n+1)))
    let n = 40;
    let mut spec = block([n as f64, 0.0, 0.0], 1, SPRINGS);
    hold(&mut spec, "low", [number(0.0), None, None]);
    spec.run.schedule.steps = 0;
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let modes = sim.modes(6).unwrap();
    for (k, mode) in modes.iter().enumerate() {
        let angle = (2.0 * k as f64 + 1.0) * std::f64::consts::PI / (4.0 * n as f64 + 2.0);
        let exact = 2.0 * angle.sin() / (2.0 * std::f64::consts::PI);
        assert!(
            (mode.frequency / exact - 1.0).abs() < 1e-10,
            "{k}: {} {exact}",
            mode.frequency
        );
        let norm: f64 = mode.shape.iter().map(|x| x[0] * x[0]).sum();
        assert!((norm - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_free_block_has_six_rigid_modes() {
    let mut spec = block([4.0, 3.0, 3.0], 3, LawSpec::Pmb(PmbStiffness::Young(2.0)));
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.run.schedule.steps = 0;
    let mut sim = build(&spec, Options::default()).unwrap();
    let modes = sim.modes(8).unwrap();
    let elastic = modes[6].square;
    assert!(elastic > 1e-3, "{elastic}");
    assert!(
        modes[..6].iter().all(|m| m.square.abs() < 1e-9 * elastic),
        "{:?}",
        modes.iter().map(|m| m.square).collect::<Vec<_>>()
    );
}

#[test]
fn a_body_that_is_not_held_is_refused_with_the_motion() {
    let told = |spec: &Spec| build(spec, Options::default()).err().unwrap().to_string();
    let mut spec = block([6.0, 4.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(2.0)));
    assert!(told(&spec).contains("translation along"), "{}", told(&spec));
    hold(&mut spec, "low", [number(0.0), None, None]);
    assert!(
        told(&spec).contains("translation along y"),
        "{}",
        told(&spec)
    );
    spec.loading.conditions.push(ConditionSpec {
        set: "high".into(),
        kind: ConditionKind::Velocity([None, number(0.0), None]),
    });
    assert!(told(&spec).contains("velocity"), "{}", told(&spec));
}

#[test]
fn a_notched_plate_breaks_increment_by_increment() {
    let mut spec = block([12.0, 12.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(2.0)));
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.02)));
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [5.5, -1.0, 0.0],
            to: [5.5, 3.5, 0.0],
        },
        kind: CrackKind::Broken,
    });
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [text("0.3*t"), number(0.0), None]);
    spec.run.schedule.steps = 6;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0 / 6.0);
    for method in [Method::Newton, Method::Relaxation] {
        let mut sim = build(&with(&spec, method, Solver::Auto, 1e-7), Options::default()).unwrap();
        sim.start(true);
        let mut broken = vec![sim.broken()];
        for _ in 0..6 {
            // when the plate has come apart the rest of it has nothing to hold it, and that is said
            match sim.step() {
                Ok(()) => broken.push(sim.broken()),
                Err(e) => {
                    assert!(e.to_string().contains("increment"), "{e}");
                    break;
                }
            }
        }
        assert_eq!(broken[1], broken[0], "{method:?}");
        assert!(broken.last() > broken.first(), "{method:?}: {broken:?}");
    }
}

/// Where bonds let go, loads have worked up to the break, and what the way to the next equilibrium sets free is lost: for every law, method and
/// release the balance closes but for what strains of 1e-5 are not linear in.
#[test]
fn the_ledger_of_statics_closes_through_breaks() {
    for law in [
        LawSpec::Pmb(PmbStiffness::Young(2.0)),
        LawSpec::Lps(Moduli {
            young: 2.0,
            poisson: 0.2,
        }),
    ] {
        for (method, tolerance) in [(Method::Newton, 1e-9), (Method::Relaxation, 1e-7)] {
            for breakage in [Breakage::BeforeForce, Breakage::AfterForce] {
                let mut spec = block([12.0, 12.0, 0.0], 2, law.clone());
                spec.bonds.horizon = Horizon::Ratio(2);
                spec.damage.breakage = breakage;
                spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(2e-5)));
                spec.damage.precracks.push(PrecrackSpec {
                    shape: CrackShape::Segment {
                        from: [5.5, -1.0, 0.0],
                        to: [5.5, 3.5, 0.0],
                    },
                    kind: CrackKind::Broken,
                });
                hold(&mut spec, "low", [number(0.0), number(0.0), None]);
                hold(&mut spec, "high", [text("1.6e-4*t"), number(0.0), None]);
                spec.run.schedule.steps = 4;
                spec.run.schedule.time_step = TimeStep::Fixed(0.25);
                let case = format!("{law:?} {method:?} {breakage:?}");
                let spec = with(&spec, method, Solver::Auto, tolerance);
                let mut sim = build(&spec, Options::default()).unwrap();
                sim.start(true);
                let cut = sim.broken();
                let mut last = sim.ledger().unwrap();
                // up to where it comes apart
                while sim.step_number() < 4 && sim.step().is_ok() {
                    last = sim.ledger().unwrap();
                }
                assert!(sim.broken() > cut, "{case}: nothing breaks");
                assert!(last.dissipated > 0.05 * last.released, "{case}: {last:?}");
                let off = last.residual().abs() / last.work_boundary_conditions;
                println!(
                    "{case}: {off:e}, lost {:e} of {:e}",
                    last.dissipated, last.released
                );
                assert!(off < 1e-4, "{case}: {off:e} {last:?}");
            }
        }
    }
}

/// The same where bonds break by the work done on them: what they pull up to the break is work, too.
#[test]
fn the_ledger_of_statics_closes_through_breaks_by_stretch_and_by_work() {
    let of = |criterion, increments: u64| {
        let law = LawSpec::Lps(Moduli {
            young: 2.0,
            poisson: 0.3,
        });
        let mut spec = block([10.0, 13.0, 0.0], 2, law);
        spec.space.plane = Plane::Strain;
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.materials[0].fracture = Some(FractureSpec::new(criterion));
        // grips as thick as the horizon
        let grip = |name: &str, sign: f64, x: f64| SetSpec {
            name: name.into(),
            members: Members::Region(Region::HalfSpace {
                point: [x, 0.0, 0.0],
                normal: [sign, 0.0, 0.0],
            }),
        };
        spec.sets = vec![grip("low", 1.0, 2.5), grip("high", -1.0, 7.5)];
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [text("6e-5*t"), number(0.0), None]);
        spec.run.schedule.steps = increments;
        spec.run.schedule.time_step = TimeStep::Fixed(1.0 / increments as f64);
        let spec = with(&spec, Method::Newton, Solver::Auto, 1e-9);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut last = sim.ledger().unwrap();
        while sim.step_number() < increments && sim.step().is_ok() {
            last = sim.ledger().unwrap();
        }
        let off = last.residual().abs() / last.work_boundary_conditions;
        println!("{criterion:?} in {increments}: {off:e}, {last:?}");
        assert!(sim.broken() > 0, "{criterion:?}: nothing breaks");
        assert!(last.released > 0.0, "{criterion:?}: {last:?}");
        assert!(
            off < 1e-4,
            "{criterion:?} in {increments}: {off:e} {last:?}"
        );
    };
    for increments in [2, 4, 16] {
        of(Criterion::BondEnergy(3e-10), increments);
        of(Criterion::Stretch(7e-6), increments);
    }
}

/// A body that begins out of equilibrium goes to it in the first increment; what that sets free is all it had, is lost, and is said.
#[test]
fn a_start_out_of_equilibrium_is_accounted_for() {
    for law in [
        LawSpec::Pmb(PmbStiffness::Young(2.0)),
        LawSpec::Lps(Moduli {
            young: 2.0,
            poisson: 0.2,
        }),
    ] {
        for (method, tolerance) in [
            (Method::Newton, 1e-9),
            (Method::Relaxation, 1e-8),
            (Method::Linear, 1e-9),
        ] {
            let mut spec = block([12.0, 7.0, 0.0], 2, law.clone());
            spec.bonds.horizon = Horizon::Ratio(3);
            hold(&mut spec, "low", [number(0.0), number(0.0), None]);
            hold(&mut spec, "high", [text("1e-6*t"), number(0.0), None]);
            spec.run.schedule.steps = 4;
            spec.run.schedule.time_step = TimeStep::Fixed(0.25);
            let spec = with(&spec, method, Solver::Auto, tolerance);
            let started = |size: f64| {
                let mut sim = build(&spec, Options::default()).unwrap();
                let bent = |x: &[f64; 3]| {
                    let inside = (x[0] * (12.0 - x[0])).max(0.0);
                    [size * inside * x[1], size * inside * x[0].sin(), 0.0]
                };
                let u: Vec<_> = sim.vectors("reference").iter().map(bent).collect();
                sim.set_displacements(&u);
                sim.start(true);
                let first = sim.ledger().unwrap();
                (0..4).for_each(|_| sim.step().unwrap());
                let last = sim.ledger().unwrap();
                let said = sim.info().warnings.iter();
                let said = said.filter(|w| w.contains("not in equilibrium at the start"));
                (first, last, said.count())
            };
            let (first, last, said) = started(1e-7);
            let case = format!("{law:?} {method:?}: {last:?}");
            assert!(
                first.strain > 0.0 && last.residual().abs() < 1e-4 * first.strain,
                "{case}"
            );
            // it bears the pull in the end, and nothing else
            let lost =
                last.dissipated - (first.strain + last.work_boundary_conditions - last.strain);
            assert!(
                lost.abs() < 1e-4 * first.strain && said == 1,
                "{case} {said}"
            );
            let (_, rest, silent) = started(0.0);
            assert!(silent == 0 && rest.dissipated == 0.0, "{rest:?}");
            assert!((rest.strain / last.strain - 1.0).abs() < 1e-4, "{case}");
        }
    }
}

/// A notched plate whose bonds resist turning: families beside the notch are askew, and one solution is the same as the others.
#[test]
fn linear_solutions_of_torn_bodies_agree_with_newtons() {
    for law in [
        LawSpec::named(
            "bond_rotation",
            Parameters::numbers(&[("young", 2.0), ("poisson", 0.1)]),
        ),
        LawSpec::named(
            "pals",
            Parameters::numbers(&[("young", 2.0), ("poisson", 0.2)]),
        ),
    ] {
        let mut spec = block([11.0, 11.0, 0.0], 2, law.clone());
        spec.space.plane = Plane::Strain;
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.damage.precracks.push(PrecrackSpec {
            shape: CrackShape::Segment {
                from: [5.5, -1.0, 0.0],
                to: [5.8, 5.7, 0.0],
            },
            kind: CrackKind::Broken,
        });
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [number(1e-6), number(0.0), None]);
        let of = |method, solver| {
            let l = { solved(&with(&spec, method, solver, 1e-10)) }
                .ledger()
                .unwrap();
            let off = (l.strain / l.work_boundary_conditions - 1.0).abs();
            assert!(off < 1e-5, "{law:?} {method:?} {solver:?}: {l:?}");
            l.strain
        };
        let newton = of(Method::Newton, Solver::Direct);
        for solver in [Solver::Direct, Solver::ConjugateGradients] {
            for method in [Method::Linear, Method::Newton] {
                let off = of(method, solver) / newton - 1.0;
                assert!(off.abs() < 1e-5, "{law:?} {method:?} {solver:?}: {off:e}");
            }
        }
    }
}

/// A cantilever of rubber in plane strain, bent by a load at its end.
fn bent(load: f64, steps: u64) -> Spec {
    let law = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.4999,
    });
    let mut spec = block([24.0, 6.0, 0.0], 2, law);
    spec.space.plane = Plane::Strain;
    spec.bonds.horizon = Horizon::Ratio(3);
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    spec.loading.conditions.push(ConditionSpec {
        set: "high".into(),
        kind: ConditionKind::BodyForce([None, text(&format!("{load:e}*t")), None]),
    });
    spec.run.schedule.steps = steps;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0 / steps as f64);
    spec
}

/// The energy is that of the linear body, ½ uᵀKu, not that of the nonlinear law at its displacements.
#[test]
fn the_energy_of_linear_statics_closes_near_incompressibility() {
    let energies = |load: f64, method: Method, solver: Solver, steps: u64| {
        let mut sim = solved(&with(&bent(load, steps), method, solver, 1e-9));
        let l = sim.ledger().unwrap();
        let (density, volume) = (sim.scalars("energy_density"), sim.scalars("volume"));
        let sum: f64 = density.iter().zip(&volume).map(|(w, v)| w * v).sum();
        assert!((sum / l.strain - 1.0).abs() < 1e-12, "{sum} is not {l:?}");
        (l.strain, l.work_boundary_conditions)
    };
    for (solver, bound) in [(Solver::Direct, 1e-8), (Solver::ConjugateGradients, 1e-6)] {
        for steps in [1, 3] {
            let (strain, work) = energies(1e-3, Method::Linear, solver, steps);
            let off = (strain / work - 1.0).abs();
            println!("{solver:?}, {steps} increments: strain {strain:e} J, work {work:e} J");
            assert!(off < bound, "{solver:?}, {steps}: {strain} {work}");
        }
    }
    // linear: four times the energy of half the load
    let (half, _) = energies(5e-4, Method::Linear, Solver::Direct, 1);
    let (whole, _) = energies(1e-3, Method::Linear, Solver::Direct, 1);
    assert!((whole / half - 4.0).abs() < 1e-9, "{whole} {half}");
    // and the limit of Newton's
    let (linear, _) = energies(1e-8, Method::Linear, Solver::Direct, 1);
    let (newton, _) = energies(1e-8, Method::Newton, Solver::Direct, 1);
    assert!((newton / linear - 1.0).abs() < 1e-3, "{newton} {linear}");
}

/// Factors, gradients, Newton's steps, relaxation, modes.
#[test]
fn statics_has_the_same_bits_on_any_number_of_threads() {
    use Method::*;
    let mut all = vec![];
    for (method, solver) in [
        (Linear, Solver::Direct),
        (Linear, Solver::ConjugateGradients),
        (Newton, Solver::Direct),
        (Relaxation, Solver::Auto),
    ] {
        let law = LawSpec::Lps(Moduli {
            young: 1.0,
            poisson: 0.3,
        });
        let mut spec = with(&block([60.0, 40.0, 0.0], 2, law), method, solver, 1e-6);
        spec.bonds.horizon = Horizon::Ratio(3);
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [number(1e-3), number(2e-3), None]);
        all.push(spec);
    }
    for (n, spec) in all.iter().enumerate() {
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let mut sim = solved(spec);
                let mut bits = vec![];
                for field in [sim.displacements(), sim.vectors("force_density")] {
                    bits.extend(field.iter().flatten().map(|x| x.to_bits()));
                }
                let l = sim.ledger().unwrap();
                bits.extend([l.strain, l.work_boundary_conditions].map(f64::to_bits));
                if n == 0 {
                    for mode in sim.modes(3).unwrap() {
                        bits.push(mode.frequency.to_bits());
                        bits.extend(mode.shape.iter().flatten().map(|x| x.to_bits()));
                    }
                }
                bits
            })
        };
        let one = run(1);
        for threads in [2, 4] {
            assert!(run(threads) == one, "case {n}, {threads} threads");
        }
    }
}

#[test]
fn a_driven_rigid_body_pushes_from_where_it_is_told() {
    let mut spec = block([10.0, 0.0, 0.0], 1, SPRINGS);
    hold(&mut spec, "low", [number(0.0), None, None]);
    let end = |sim: &mut dyn Simulation| sim.displacements().last().unwrap()[0];
    // the stiffness of the chain at its end
    let mut pushed = spec.clone();
    pushed.loading.conditions.push(ConditionSpec {
        set: "high".into(),
        kind: ConditionKind::BodyForce([number(-1e-3), None, None]),
    });
    let stiffness = -1e-3 / end(&mut *solved(&pushed));
    let mut spec = with(&spec, Method::Relaxation, Solver::Auto, 1e-9);
    spec.run.schedule.steps = 4;
    spec.loading.rigid_bodies.push(RigidBodySpec::sphere(
        0.5,
        5.0,
        RigidBodyMotion::Kinematic([
            text("15 - 0.1*t").unwrap(),
            number(0.0).unwrap(),
            number(0.0).unwrap(),
        ]),
    ));
    let mut sim = solved(&spec);
    let u = end(&mut *sim);
    // the time is 4 at the end
    let deep = 0.4 + u;
    assert!(deep > 0.0 && u < -0.01, "{u}");
    let force = 0.5 * deep * deep;
    assert!((force / (-u * stiffness) - 1.0).abs() < 1e-6, "{force} {u}");
    // the work of the rigid_body is what the chain holds
    let ledger = sim.ledger().unwrap();
    assert!((ledger.work_rigid_bodies / ledger.strain - 1.0).abs() < 1e-6);
    assert!(ledger.residual().abs() < 1e-6 * ledger.strain);
}

/// Bonds of pairs of materials are springs in series: each is stretched by the force over its own stiffness.
#[test]
fn pairs_of_materials_are_springs_in_series() {
    let springs = |c: f64| LawSpec::Pmb(PmbStiffness::Micromodulus(c));
    let mut spec = block([20.0, 0.0, 0.0], 1, springs(1.0));
    spec.bonds.horizon = Horizon::Length(1.5);
    spec.bonds.family = FamilyChoice::List;
    let parts = [("left", "x < 10.5"), ("right", "x > 10.5")];
    for (name, of) in parts {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Where(Expression::parse(of, &[]).unwrap()),
        });
    }
    spec.materials = parts
        .map(|(name, _)| MaterialSpec {
            name: name.into(),
            set: name.into(),
            ..spec.materials[0].clone()
        })
        .to_vec();
    spec.interactions.pairs = [1.0, 3.0, 3.0, 2.0]
        .map(|c| PairSpec {
            horizon: 1.5,
            law: springs(c),
            critical_stretch: f64::INFINITY,
            alpha: 0.0,
        })
        .to_vec();
    hold(&mut spec, "low", [number(0.0), None, None]);
    hold(&mut spec, "high", [text("0.01*t"), None, None]);
    // 10 bonds of the left, one between both, 9 of the right
    let force = 0.01 / (10.0 + 1.0 / 3.0 + 4.5);
    let exact = |x: f64| match x > 10.5 {
        true => 0.01 - force * (20.0 - x) / 2.0,
        false => force * x,
    };
    let ways = [Method::Linear, Method::Newton, Method::Relaxation];
    for spec in ways.map(|method| with(&spec, method, Solver::Auto, 1e-12)) {
        let mut sim = solved(&spec);
        let snapshot = sim.snapshot(&[], false);
        for (x, u) in snapshot.reference.iter().zip(snapshot.displacement()) {
            assert!((u[0] - exact(x[0])).abs() < 1e-9, "{x:?}: {u:?}");
        }
        let l = sim.ledger().unwrap();
        assert!((l.strain / (0.005 * force) - 1.0).abs() < 1e-7, "{l:?}");
    }
    // unlike both ways round there is no energy, and no equilibrium of one
    spec.interactions.pairs[1].law = springs(4.0);
    let error = build(&spec, Options::default()).err().unwrap();
    assert_eq!(error.path, "pairs");
    assert!(error.message.contains("action is not reaction"), "{error}");
    spec.loading.conditions.clear();
    spec.run.schedule.time_step = TimeStep::Fraction(0.5);
    spec.run.schedule.stepper = Stepper::Verlet;
    assert!(build(&spec, Options::default()).is_ok());
}

/// Whatever the influence function, bonds of pairs that are all alike are those of one material: it is that of the horizon of the pair.
#[test]
fn alike_pairs_weigh_their_bonds_as_one_material() {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(2.0));
    let solid = LawSpec::Lps3d {
        bulk: 1.0,
        shear: 0.4,
    };
    let written = |text: &str| Influence::Formula(Formula::parse(text, &[]).unwrap());
    let directed = written("1 + 0.5*xi_x/r");
    for (law, influence, horizon) in [
        (&law, Influence::Linear, 2.3),
        (&law, Influence::Gaussian, 2.3),
        (&law, Influence::Linear, 1.6),
        (&solid, written("exp(-(r/delta)^2)"), 2.3),
        (&solid, written("exp(-(r/delta)^2)"), 1.6),
        (&solid, written("exp(-r)"), 1.6),
        (&law, directed, 1.6),
    ] {
        let mut one = block([12.0, 5.0, 0.0], 2, law.clone());
        one.bonds.horizon = Horizon::Length(horizon);
        one.bonds.family = FamilyChoice::List;
        one.bonds.influence = influence;
        one.run.schedule.stepper = Stepper::Verlet;
        one.run.schedule.time_step = TimeStep::Fixed(0.05);
        one.run.schedule.force_unstable = true;
        one.run.schedule.steps = 40;
        one.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [None, None, None],
            velocity: [text("0.02*sin(0.5*x)"), text("0.01*cos(0.4*x + y)"), None],
        }];
        let mut pairs = one.clone();
        pairs.bonds.horizon = Horizon::Length(2.3);
        pairs.interactions.pairs = vec![PairSpec {
            horizon,
            law: law.clone(),
            critical_stretch: f64::INFINITY,
            alpha: 0.0,
        }];
        let [a, b] = [&one, &pairs].map(|spec| {
            let mut sim = build(spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
            sim.start(true);
            for _ in 0..40 {
                sim.step().unwrap();
            }
            sim.displacements()
        });
        let most = a.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!(most > 1e-3);
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() < 1e-10 * most, "{influence:?}: {a} {b}");
        }
    }
}

/// Implicit steps move a body of pairs of materials that are all alike as one of its material.
#[test]
fn alike_pairs_move_implicitly_as_one_material() {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(2.0));
    let mut one = block([12.0, 5.0, 0.0], 2, law.clone());
    one.bonds.horizon = Horizon::Length(2.3);
    one.bonds.family = FamilyChoice::List;
    one.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    one.run.schedule.time_step = TimeStep::Fixed(0.3);
    one.run.schedule.steps = 20;
    one.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: [text("0.02*sin(0.5*x)"), text("0.01*cos(0.4*x + y)"), None],
    }];
    let mut pairs = one.clone();
    pairs.interactions.pairs = vec![PairSpec {
        horizon: 2.3,
        law,
        critical_stretch: f64::INFINITY,
        alpha: 0.0,
    }];
    let [a, b] = [one, pairs].map(|spec| solved(&spec).displacements());
    let most = a.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(most > 1e-3);
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() < 1e-7 * most, "{a} {b}");
    }
}
