//! Several bodies: bonds inside each, contact between them; loose points; the step that contact allows.

use peridyne::error::RunError;
use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

fn block(kind: LatticeKind, spacing: f64, low: [f64; 3], high: [f64; 3]) -> BodySpec {
    BodySpec::Lattice {
        kind,
        spacing,
        origin: low,
        region: Region::Block { low, high },
        perturb: None,
    }
}

fn piece(name: &str, body: BodySpec, bonded: bool) -> PieceSpec {
    PieceSpec {
        bonded,
        ..PieceSpec::new(name, body)
    }
}

fn within(name: &str) -> SetSpec {
    SetSpec {
        name: name.into(),
        members: Members::Within {
            body: name.into(),
            members: Box::new(Members::All),
        },
    }
}

fn material(set: &str, density: f64, young: f64) -> MaterialSpec {
    MaterialSpec {
        name: set.into(),
        set: set.into(),
        density,
        law: LawSpec::Pmb(PmbStiffness::Young(young)),
        fracture: None,
    }
}

const CONTACT: ContactSpec = ContactSpec {
    bonded: 0.9,
    free: 1.35,
    stiffness: ContactStiffness::Laws,
    friction: None,
    cohesion: None,
    conductance: None,
};

/// Until the materials are given.
const SPRINGS: LawSpec = LawSpec::Springs(PmbStiffness::Young(1.0));

/// A small square that flies into a larger, coarser one of another material.
fn collision(fraction: f64) -> Spec {
    let ball = block(LatticeKind::Square, 0.8, [3.1, 9.3, 0.0], [7.2, 12.6, 0.0]);
    let plate = block(LatticeKind::Square, 1.0, [0.0; 3], [11.0, 7.0, 0.0]);
    let pieces = vec![piece("ball", ball, true), piece("plate", plate, true)];
    let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, SPRINGS);
    spec.sets = vec![within("ball"), within("plate")];
    spec.materials = vec![material("ball", 2.0, 300.0), material("plate", 1.0, 100.0)];
    spec.bonds.horizon = Horizon::Length(2.5);
    spec.bonds.partial_volume_correction = true;
    spec.interactions.contact = Some(CONTACT);
    spec.loading.initial = vec![InitialSpec {
        set: "ball".into(),
        displacement: [None, None, None],
        velocity: [text("0.3"), text("-2"), None],
    }];
    spec.run.schedule.time_step = TimeStep::Fraction(fraction);
    spec
}

fn momentum(sim: &mut dyn Simulation) -> ([f64; 2], f64) {
    let (v, m) = (sim.velocities(), sim.scalars("volume"));
    let rho = sim.scalars("density");
    let mut p = [0.0; 2];
    let mut size = 0.0;
    for ((v, m), rho) in v.iter().zip(&m).zip(&rho) {
        for a in 0..2 {
            p[a] += v[a] * m * rho;
            size += (v[a] * m * rho).abs();
        }
    }
    (p, size)
}

#[test]
fn colliding_bodies_keep_momentum_and_energy() {
    let mut worst = vec![];
    for fraction in [0.2, 0.1] {
        let spec = collision(fraction);
        let mut sim = build(&spec, Options::default()).unwrap();
        assert_eq!(
            sim.info().bodies,
            [("ball".into(), 30), ("plate".into(), 96)]
        );
        assert_eq!(sim.info().family_kind, "stencil");
        sim.start(true);
        let (before, size) = momentum(sim.as_mut());
        let (mut touched, mut most) = (0.0f64, 0.0f64);
        let duration = 4.0;
        let initial = sim.ledger().unwrap().initial;
        while sim.time() < duration {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            touched = touched.max(l.contact);
            most = most.max(l.residual().abs() / initial);
        }
        let (after, _) = momentum(sim.as_mut());
        for a in 0..2 {
            assert!(
                (after[a] - before[a]).abs() < 1e-12 * size,
                "{before:?} {after:?}"
            );
        }
        assert!(touched > 1e-2 * initial, "they hardly touched: {touched}");
        assert_eq!(sim.fragments(), 2);
        assert!(sim.scalars("damage").iter().all(|d| *d == 0.0));
        worst.push(most);
    }
    // second order in the step, up to pairs that come and go
    assert!(worst[0] < 1e-2 && worst[1] < 0.4 * worst[0], "{worst:?}");
}

/// One body among several is the body itself, bit by bit, as a lattice and as a list; threads do not show.
#[test]
fn one_of_several_is_the_body_itself() {
    let of = |body: BodySpec, family| {
        let mut spec = Spec::new(
            3,
            body,
            2.0,
            LawSpec::Lps(Moduli {
                young: 5.0,
                poisson: 0.3,
            }),
        );
        spec.materials[0].fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(0.02),
            alpha: 0.25,
            rate: None,
            fatigue: None,
        });
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.interactions.contact = Some(CONTACT);
        spec.bonds.family = family;
        spec.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [text("0.01*x"), text("0.02*sin(x+y)"), text("-0.3*z*(z>2)")],
            velocity: [text("0.1*y"), None, text("0.2*(x>3) - 0.1")],
        }];
        spec
    };
    let lattice = block(LatticeKind::Cubic, 1.0, [0.0; 3], [6.0, 4.0, 4.0]);
    for family in [FamilyChoice::Stencil, FamilyChoice::List] {
        let several = BodySpec::Several(vec![piece("a", lattice.clone(), true)]);
        let run = |body, threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                let mut sim = build(&of(body, family), Options::default()).unwrap();
                sim.start(true);
                for _ in 0..20 {
                    sim.step().unwrap();
                }
                let energy = sim.ledger().unwrap();
                (
                    sim.displacements(),
                    sim.scalars("damage"),
                    energy.strain,
                    sim.broken(),
                )
            })
        };
        let alone = run(lattice.clone(), 1);
        assert!(alone.3 > 0, "nothing broke");
        for threads in [1, 2, 4] {
            assert!(
                run(several.clone(), threads) == alone,
                "{family:?}, {threads} threads"
            );
        }
    }
}

#[test]
fn bodies_a_spacing_apart_are_not_bonded() {
    let upper = |gap: f64| {
        block(
            LatticeKind::Square,
            1.0,
            [0.0, 4.0 + gap, 0.0],
            [5.0, 8.0 + gap, 0.0],
        )
    };
    let lower = block(LatticeKind::Square, 1.0, [0.0; 3], [5.0, 4.0, 0.0]);
    let several = |gap: f64| {
        let pieces = vec![
            piece("low", lower.clone(), true),
            piece("high", upper(gap), true),
        ];
        let mut spec = Spec::new(
            2,
            BodySpec::Several(pieces),
            1.0,
            material("all", 1.0, 1.0).law,
        );
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.interactions.contact = Some(CONTACT);
        spec
    };
    let sim = build(&several(2.0), Options::default()).unwrap();
    assert_eq!(sim.fragments(), 2);
    let gap = sim.info().gaps[0];
    assert_eq!((gap.bodies, gap.distance), ([0, 1], 2.0));
    assert!((gap.contact - 1.35).abs() < 1e-12);
    // faces of both regions go through points, which is said of each and is all that is said
    let told = |w: &peridyne::quantity::Message| w.to_string().contains("than its region");
    assert!(
        sim.info().warnings.iter().all(told),
        "{:?}",
        sim.info().warnings
    );
    // lift the upper one: nothing pulls
    let mut sim = build(&several(2.0), Options::default()).unwrap();
    let lift: Vec<_> = sim
        .vectors("reference")
        .iter()
        .map(|x| [0.0, if x[1] > 5.0 { 0.3 } else { 0.0 }, 0.0])
        .collect();
    assert!(sim.forces_under(&lift).iter().flatten().all(|f| *f == 0.0));
    for (gap, what) in [
        (1.0, "nearer than the distance of contact"),
        (0.5, "overlap"),
    ] {
        let sim = build(&several(gap), Options::default()).unwrap();
        assert!(
            sim.info().warnings.iter().any(|w| w.contains(what)),
            "{:?}",
            sim.info().warnings
        );
    }
    // the same points as one body: joined, and told
    let region = Region::Difference(
        Box::new(Region::Block {
            low: [0.0; 3],
            high: [5.0, 10.0, 0.0],
        }),
        vec![Region::Block {
            low: [-1.0, 4.5, 0.0],
            high: [6.0, 5.5, 0.0],
        }],
    );
    let body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        region,
        perturb: None,
    };
    let mut spec = several(2.0);
    spec.body = body;
    let sim = build(&spec, Options::default()).unwrap();
    assert_eq!(sim.fragments(), 1);
    let told = &sim.info().warnings[0];
    assert!(
        told.contains("separate pieces") && told.contains("2.00 spacings"),
        "{told}"
    );
}

/// Loose points fall onto a plate that is held: contact only, energy closes.
#[test]
fn powder_bounces_on_a_plate() {
    let powder = block(LatticeKind::Square, 1.0, [1.3, 4.6, 0.0], [6.4, 7.7, 0.0]);
    let plate = block(LatticeKind::Square, 1.0, [0.0; 3], [9.0, 3.0, 0.0]);
    let stone = block(LatticeKind::Square, 1.0, [4.0, 9.0, 0.0], [4.0, 9.0, 0.0]);
    let pieces = vec![
        piece("powder", powder, false),
        piece("plate", plate, true),
        piece("stone", stone, true),
    ];
    let mut spec = Spec::new(
        2,
        BodySpec::Several(pieces),
        1.0,
        material("all", 1.0, 100.0).law,
    );
    spec.sets = vec![within("powder"), within("stone")];
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.interactions.contact = Some(CONTACT);
    let fall = |set: &str, v: &str| InitialSpec {
        set: set.into(),
        displacement: [None, None, None],
        velocity: [None, text(v), None],
    };
    spec.loading.initial = vec![fall("powder", "-1"), fall("stone", "-3")];
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    let mut sim = build(&spec, Options::default()).unwrap();
    assert_eq!(sim.families().size[0], 0);
    assert_eq!(sim.fragments(), 24 + 1 + 1);
    sim.start(true);
    let (before, size) = momentum(sim.as_mut());
    let initial = sim.ledger().unwrap().initial;
    let (mut touched, mut most) = (0.0f64, 0.0f64);
    while sim.time() < 4.0 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        touched = touched.max(l.contact);
        most = most.max(l.residual().abs() / initial);
    }
    let (after, _) = momentum(sim.as_mut());
    assert!((after[1] - before[1]).abs() < 1e-12 * size);
    assert!(touched > 1e-2 * initial && most < 1e-2, "{touched} {most}");
    // the powder was turned round
    let v = sim.velocities();
    assert!(v[..24].iter().map(|v| v[1]).sum::<f64>() > -24.0 + 1.0);
}

/// A chain of loose points under pressure between two that are held: the highest frequency is 2√(KV/ρ).
#[test]
fn the_step_of_contact_is_that_of_a_chain_in_touch() {
    let chain = |fraction: f64| {
        let pieces = vec![piece(
            "powder",
            block(LatticeKind::Chain, 1.0, [0.0; 3], [40.0, 0.0, 0.0]),
            false,
        )];
        let mut spec = Spec::new(
            1,
            BodySpec::Several(pieces),
            3.0,
            material("all", 3.0, 1.0).law,
        );
        spec.interactions.contact = Some(ContactSpec {
            stiffness: ContactStiffness::Same(7.0),
            ..CONTACT
        });
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.sets = vec![SetSpec {
            name: "ends".into(),
            members: Members::Where(text("x < 0.5 || x > 39.5").unwrap()),
        }];
        spec.loading.conditions = vec![ConditionSpec {
            set: "ends".into(),
            kind: ConditionKind::Displacement([text("-0.2*x"), None, None]),
        }];
        spec.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [
                text("-0.2*x + 1e-6*(random(x, 0, 0) - 0.5)*(x > 0.5)*(x < 39.5)"),
                None,
                None,
            ],
            velocity: [None, None, None],
        }];
        spec.run.schedule.time_step = TimeStep::Fraction(fraction);
        spec.run.schedule.force_unstable = true;
        build(&spec, Options::default()).unwrap()
    };
    let limit = 2.0 / (4.0f64 * 7.0 / 3.0).sqrt();
    assert!((chain(0.8).info().stable_step / limit - 1.0).abs() < 1e-12);
    for (fraction, stable) in [(0.99, true), (1.02, false)] {
        let mut sim = chain(fraction);
        sim.start(true);
        let start = sim.displacements();
        for _ in 0..2000 {
            if sim.step().is_err() {
                break;
            }
        }
        let moved = sim
            .displacements()
            .iter()
            .zip(&start)
            .map(|(a, b)| (a[0] - b[0]).abs())
            .fold(0.0, f64::max);
        assert_eq!(moved < 1e-3, stable, "{fraction}: {moved}");
    }
}

/// Steel on epoxy, everything by default: a soft, light body is not hit with the stiffness of a hard, heavy one.
#[test]
fn steel_on_epoxy_runs_at_the_default_step() {
    let mut spec = steel_on_epoxy();
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let initial = sim.ledger().unwrap().initial;
    let (mut most, mut touched) = (0.0f64, 0.0f64);
    for _ in 0..1500 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        most = most.max(l.residual().abs() / initial);
        touched = touched.max(l.contact / initial);
    }
    assert!(touched > 1e-4 && most < 0.05, "{touched} {most}");
    // contact as stiff as the steel, at the step of the bonds: refused to be trusted, and named when it dies
    spec.interactions.contact = Some(ContactSpec {
        stiffness: ContactStiffness::Same(1e26),
        ..CONTACT
    });
    let free = sim.info().time_step;
    let limited = build(&spec, Options::default()).unwrap().info().clone();
    // six neighbours, two for an axis: λ = 2 · 2 K V / ρ of the lighter one
    let lambda: f64 = 4.0 * 1e26 * 1e-9 / 1200.0;
    let expected = 0.8 * 2.0 / lambda.sqrt();
    assert!(
        (limited.time_step / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        limited.time_step
    );
    spec.run.schedule.time_step = TimeStep::Fixed(free);
    let mut sim = build(&spec, Options::default()).unwrap();
    let told = &sim.info().warnings;
    assert!(
        told.iter().any(|w| w.contains("of contact between")),
        "{told:?}"
    );
    sim.start(true);
    let error = (0..3000).find_map(|_| sim.step().and_then(|()| sim.ledger().map(drop)).err());
    let error = error.expect("it cannot be stable");
    assert!(matches!(
        error,
        RunError::Unstable { .. } | RunError::TooFast { .. }
    ));
    assert!(
        error.to_string().contains("contact is the cause"),
        "{error}"
    );
}

fn steel_on_epoxy() -> Spec {
    let h = 1e-3;
    let ball = block(
        LatticeKind::Cubic,
        h,
        [3e-3, 3e-3, 4.5e-3],
        [6e-3, 6e-3, 7.5e-3],
    );
    let plate = block(LatticeKind::Cubic, h, [0.0; 3], [9e-3, 9e-3, 3e-3]);
    let pieces = vec![piece("steel", ball, true), piece("epoxy", plate, true)];
    let mut spec = Spec::new(3, BodySpec::Several(pieces), 1.0, SPRINGS);
    spec.sets = vec![within("steel"), within("epoxy")];
    spec.materials = vec![
        material("steel", 7800.0, 200e9),
        material("epoxy", 1200.0, 3e9),
    ];
    for (m, s) in spec.materials.iter_mut().zip([0.01, 0.02]) {
        m.fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(s),
            alpha: 0.0,
            rate: None,
            fatigue: None,
        });
    }
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.bonds.partial_volume_correction = true;
    spec.interactions.contact = Some(CONTACT);
    spec.loading.initial = vec![InitialSpec {
        set: "steel".into(),
        displacement: [None, None, None],
        velocity: [None, None, text("-100")],
    }];
    spec
}

#[test]
fn what_several_bodies_cannot_have_is_refused() {
    let refused = |change: &dyn Fn(&mut Spec), what: &str| {
        let mut spec = collision(0.5);
        change(&mut spec);
        let error = build(&spec, Options::default()).err().expect(what);
        assert!(error.message.contains(what), "{error}");
    };
    let linear = |s: &mut Spec| s.materials.iter_mut().for_each(|m| m.law = SPRINGS);
    refused(&linear, "no contact of their own");
    // of one body, where each may have its own
    refused(
        &|s| {
            let half = Members::Where(text("x > 5").unwrap());
            s.sets.push(SetSpec {
                name: "half".into(),
                members: Members::Within {
                    body: "plate".into(),
                    members: Box::new(half.clone()),
                },
            });
            s.sets[1].members = Members::Within {
                body: "plate".into(),
                members: Box::new(Members::Where(text("x <= 5").unwrap())),
            };
            let law = LawSpec::EamLike {
                pair: 1.0,
                volume: 1.0,
            };
            s.materials.push(MaterialSpec {
                law,
                ..material("half", 1.0, 1.0)
            });
        },
        "different kinds of law in one body",
    );
    refused(
        &|s| {
            s.sets[0].members = Members::Within {
                body: "cat".into(),
                members: Box::new(Members::All),
            }
        },
        "`cat`, which does not exist",
    );
}

/// Without an area, each point has a face of its own body's lattice.
#[test]
fn traction_takes_the_faces_of_the_body_it_acts_on() {
    let mut spec = collision(0.5);
    spec.sets.push(SetSpec {
        name: "foot".into(),
        members: Members::Within {
            body: "plate".into(),
            members: Box::new(Members::Where(text("y < 0.5").unwrap())),
        },
    });
    spec.loading.conditions = vec![ConditionSpec {
        set: "foot".into(),
        kind: ConditionKind::Traction {
            value: [text("7"), None, None],
            area: None,
        },
    }];
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let total: f64 = (sim.vectors("force_density").iter())
        .zip(sim.scalars("volume"))
        .map(|(f, v)| f[0] * v)
        .sum();
    // twelve points, a spacing of 1 each
    assert!((total - 7.0 * 12.0).abs() < 1e-9, "{total}");
}

/// Two bars under unlike strains, which do not touch: the cycles that pass are those of the bonds that end first, in whichever body, `1/(A (ε − ε∞)^m)`,
/// and so many wear the other.
#[test]
fn cycles_pass_for_all_bodies_until_the_first_bond_is_worn_out() {
    let (a, m, limit, ratio) = (1e6, 3.0, 1e-3, 0.25);
    let lasts = |strain: f64| 1.0 / (a * ((1.0 - ratio) * strain - limit).powf(m));
    for strains in [[4e-3, 2e-3], [2e-3, 4e-3]] {
        let bar = |at: f64| {
            block(
                LatticeKind::Chain,
                1.0,
                [at, 0.0, 0.0],
                [at + 19.0, 0.0, 0.0],
            )
        };
        let pieces = vec![piece("one", bar(0.0), true), piece("two", bar(100.0), true)];
        let mut spec = Spec::new(1, BodySpec::Several(pieces), 1.0, SPRINGS);
        spec.bonds.horizon = Horizon::Length(2.2);
        spec.sets = vec![within("one"), within("two")];
        for ((name, at), strain) in [("one", 0.0), ("two", 100.0)].into_iter().zip(strains) {
            let mut worn = material(name, 1.0, 1.0);
            worn.fracture = Some(FractureSpec {
                fatigue: Some(FatigueSpec {
                    nucleation: Some([a, m]),
                    limit,
                    growth: None,
                    crack: 0.35,
                }),
                ..FractureSpec::new(Criterion::Stretch(1.0))
            });
            spec.materials.retain(|m| m.name != "all");
            spec.materials.push(worn);
            let ends = format!("abs(x - {at} - 9.5) > 6.9 && abs(x - {at} - 9.5) < 10");
            spec.sets.push(SetSpec {
                name: format!("ends of {name}"),
                members: Members::Where(text(&ends).unwrap()),
            });
            let u = text(&format!("{strain}*(x - {at})"));
            spec.loading.conditions.push(ConditionSpec {
                set: format!("ends of {name}"),
                kind: ConditionKind::Displacement([u, None, None]),
            });
        }
        spec.run.schedule.steps = 2;
        spec.run.schedule.time_step = TimeStep::Fixed(1.0);
        let cycles = Cycles {
            load_ratio: ratio,
            bonds: 1,
            most: f64::INFINITY,
        };
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            method: Method::Newton,
            cycles: Some(cycles),
            ..Statics::default()
        });
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        sim.step().unwrap();
        sim.step().unwrap();
        let (passed, other) = (lasts(4e-3), lasts(2e-3));
        let found = sim.cycles().unwrap();
        assert!((found / passed - 1.0).abs() < 1e-9, "{found} {passed}");
        // two spacings far: 19 and 18 bonds in each bar, from both ends
        assert_eq!(sim.broken(), 2 * 37);
        let mut lives = sim.scalars("remaining_life");
        lives.sort_by(f64::total_cmp);
        assert_eq!(lives.len(), 4 * 37);
        let (ended, left) = lives.split_at(2 * 37);
        assert!(ended.iter().all(|life| *life == 0.0));
        let exact = 1.0 - passed / other;
        assert!(
            left.iter().all(|life| (life - exact).abs() < 1e-8),
            "{left:?} {exact}"
        );
        // where they touch, a part of the load is not that part of what it does
        spec.interactions.contact = Some(CONTACT);
        let error = build(&spec, Options::default()).err().unwrap();
        assert_eq!(error.path, "statics.cycles");
        assert!(error.message.contains("contact forces"), "{error}");
    }
}
