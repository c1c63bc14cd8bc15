//! Broken bonds that become whole again.

use crate::sample::*;
use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn heals(spec: &mut Spec, below: &str) {
    spec.damage.healing = Some(HealingSpec {
        set: "all".into(),
        below: Expression::parse(below, &[]).unwrap(),
    });
}

fn laws() -> [(LawSpec, FamilyChoice); 4] {
    let pmb = || LawSpec::Pmb(PmbStiffness::Young(100.0));
    let lps = || {
        LawSpec::Lps(Moduli {
            young: 100.0,
            poisson: 0.2,
        })
    };
    [
        (pmb(), FamilyChoice::Stencil),
        (pmb(), FamilyChoice::List),
        (lps(), FamilyChoice::Stencil),
        (lps(), FamilyChoice::List),
    ]
}

fn general() -> Vec<(LawSpec, FamilyChoice)> {
    let solid = || Parameters::numbers(&[("young", 100.0), ("poisson", 0.2)]);
    let branches = Parameter::Rows(vec![vec![0.3, 2.0]]);
    let gradient = Parameter::Word("bond".into());
    let all = [
        ("thermoelastic", Parameters::numbers(&[("young", 100.0)])),
        ("thermoelastic_solid", solid()),
        ("pals", solid()),
        ("bond_rotation", solid()),
        ("correspondence", solid()),
        ("correspondence", solid().with("gradient", gradient)),
        (
            "softening",
            Parameters::numbers(&[("young", 100.0), ("onset", 0.9)]),
        ),
        ("hypoelastic", solid()),
        ("viscoelastic", solid().with("branches", branches)),
        (
            "elastic_plastic",
            solid().with("yield_stress", Parameter::Number(0.1)),
        ),
    ];
    let families = [FamilyChoice::Stencil, FamilyChoice::List];
    let each = all.into_iter().zip(families.into_iter().cycle());
    let law = |((name, keys), family)| (LawSpec::named(name, keys), family);
    each.map(law).collect()
}

/// Those whose points and bonds remember nothing, or only while they are whole.
fn elastic() -> Vec<(LawSpec, FamilyChoice)> {
    general().into_iter().take(7).collect()
}

/// A plate that swings, cut across by a broken crack or whole.
fn plate(law: LawSpec, family: FamilyChoice, cut: bool) -> Spec {
    let body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.5, 0.5, 0.0],
        region: Region::Block {
            low: [0.0; 3],
            high: [14.0, 7.0, 0.0],
        },
        perturb: None,
    };
    let mut spec = Spec::new(2, body, 1.0, law);
    spec.bonds.family = family;
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.space.periodic[1] = Some(7.0);
    if matches!(&spec.materials[0].law, LawSpec::Named(law) if law.name == "softening") {
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.5)));
    }
    if cut {
        spec.damage.precracks = vec![PrecrackSpec {
            shape: CrackShape::Segment {
                from: [7.0, -1.0, 0.0],
                to: [7.0, 8.0, 0.0],
            },
            kind: CrackKind::Broken,
        }];
    }
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: [Some(e("0.02*sin(0.3*x)")), Some(e("0.01*cos(0.2*x)")), None],
    }];
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    spec
}

fn started(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap_or_else(|e| panic!("{e}"));
    sim.start(true);
    sim
}

#[test]
fn a_crack_that_heals_at_once_was_never_there() {
    // bonds hold something at the end of the first step, where they heal
    let each = laws().into_iter().map(|law| (law, 1e-3));
    for ((law, family), part) in each.chain(general().into_iter().map(|law| (law, 5e-3))) {
        let mut healed = plate(law.clone(), family, true);
        heals(&mut healed, "0.1");
        let run = |spec: &Spec| {
            let mut sim = started(spec);
            let cut = sim.scalars("damage").iter().sum::<f64>();
            (0..200).for_each(|_| sim.step().unwrap());
            (sim, cut)
        };
        let (mut healed, cut) = run(&healed);
        let (mut whole, _) = run(&plate(law.clone(), family, false));
        assert!(cut > 1.0, "{cut}");
        assert_eq!(healed.scalars("damage").iter().sum::<f64>(), 0.0);
        assert_eq!(healed.fragments(), 1);
        assert_eq!(healed.displacements(), whole.displacements(), "{law:?}");
        let l = healed.ledger().unwrap();
        assert!(l.residual().abs() < part * l.initial, "{law:?}: {l:?}");
    }
}

/// Bonds that an absent crack took away were never there: beside them broken ones heal, and they do not.
#[test]
fn bonds_of_an_absent_crack_do_not_heal() {
    for (law, family) in laws().into_iter().chain(elastic()) {
        let run = |broken: bool, healing: bool| {
            let mut spec = plate(law.clone(), family, false);
            let crack = |x: f64, kind| PrecrackSpec {
                shape: CrackShape::Segment {
                    from: [x, -1.0, 0.0],
                    to: [x, 8.0, 0.0],
                },
                kind,
            };
            spec.damage.precracks = vec![crack(4.0, CrackKind::Excluded)];
            if broken {
                let other = crack(9.0, CrackKind::Broken);
                spec.damage.precracks.push(other);
            }
            if healing {
                heals(&mut spec, "0.1");
            }
            let mut sim = started(&spec);
            (0..200).for_each(|_| sim.step().unwrap());
            sim
        };
        let (mut absent, mut healed) = (run(false, false), run(true, true));
        assert_eq!(healed.displacements(), absent.displacements(), "{law:?}");
        assert_eq!(healed.displacements(), run(false, true).displacements());
        assert_eq!(healed.scalars("damage").iter().sum::<f64>(), 0.0);
        assert_eq!([healed.fragments(), absent.fragments()], [2; 2]);
        let l = healed.ledger().unwrap();
        assert!(l.residual().abs() < 5e-3 * l.initial, "{law:?}: {l:?}");
    }
}

/// What healed bonds hold is taken from what is released; only those of the set heal, and only from their time on.
#[test]
fn what_heals_under_strain_is_accounted_for() {
    // those whose bonds hold energy one by one
    let branches = Parameter::Rows(vec![vec![0.3, 2.0]]);
    let relaxes = Parameters::numbers(&[("young", 100.0), ("poisson", 0.2)]);
    let relaxes = LawSpec::named("viscoelastic", relaxes.with("branches", branches));
    let more = [elastic()[0].clone(), (relaxes, FamilyChoice::List)];
    for (law, family) in laws().into_iter().chain(more) {
        let mut spec = plate(law, family, true);
        spec.sets = vec![SetSpec {
            name: "upper".into(),
            members: Members::Region(Region::HalfSpace {
                point: [0.0, 3.6, 0.0],
                normal: [0.0, -1.0, 0.0],
            }),
        }];
        heals(&mut spec, "t > 3 ? 0.5 : 0");
        spec.run.schedule.time_step = TimeStep::Fraction(0.05);
        spec.damage.healing.as_mut().unwrap().set = "upper".into();
        let mut sim = started(&spec);
        let (scale, at_first) = (sim.ledger().unwrap().initial, sim.scalars("damage"));
        let mut released = [0.0; 2];
        while sim.time() < 6.0 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            // forces jump where bonds heal, which the ledger sees to first order in the step (0.5, 0.25 and 0.13 % of what they hold at 0.1, 0.05 and 0.025 of the stable one)
            let all = scale + l.released.abs();
            assert!(l.residual().abs() < 4e-3 * all, "{}: {l:?}", sim.time());
            released[usize::from(sim.time() > 3.0)] = l.released;
            if sim.time() < 3.0 {
                assert_eq!(sim.scalars("damage"), at_first);
            }
        }
        assert_eq!(released[0], 0.0);
        println!("{:e} of {scale:e}", released[1]);
        assert!(released[1] < -1e-4 * scale, "{released:?} {scale}");
        let x = sim.vectors("reference");
        for (x, (now, then)) in x.iter().zip(sim.scalars("damage").iter().zip(&at_first)) {
            // periodic across: every point has bonds to the lower half, which stay broken
            assert!(now <= then);
            assert_eq!(
                x[1] < 3.6 && *then > 0.0,
                now == then && *then > 0.0,
                "{x:?}"
            );
        }
    }
}

/// Whoever moves the points, and whatever bonds bear where.
#[test]
fn torn_and_closed_again_it_is_whole() {
    let explicit = |_: &mut Spec| {};
    let implicit =
        |spec: &mut Spec| spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    let tougher = |spec: &mut Spec| {
        spec.damage.toughness = vec![ToughnessSpec {
            set: "all".into(),
            factor: ToughnessFactor::Stretch(e("1.5 + 0.1*sin(x)")),
        }];
    };
    let own = |spec: &mut Spec| {
        spec.bonds.horizon = Horizon::Length(2.4);
        spec.bonds.variable_horizon = Some(e("2.4 - 0.03*x"));
        spec.bonds.calibration = Calibration::Continuum;
        spec.bonds.partial_volume_correction = true;
    };
    // as much as a stretch of about a tenth takes: bonds that still knew it would break again
    let work = |spec: &mut Spec| {
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::BondEnergy(1.0)));
    };
    for (law, family) in laws() {
        let plain = matches!(law, LawSpec::Pmb(_)) && family == FamilyChoice::List;
        closes(&law, family, &explicit);
        closes(&law, family, &implicit);
        closes(&law, family, &tougher);
        closes(&law, family, &work);
        if plain {
            closes(&law, family, &own);
        }
    }
}

/// What is whole again answers as what was never torn: no weights of families, integrities or greatest stretches are left.
#[test]
fn torn_and_closed_again_it_is_new() {
    for (law, family) in elastic() {
        let mut closed = closes(&law, family, &|_| {});
        let mut new = plate(law.clone(), family, false);
        new.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.1)));
        let mut new = started(&new);
        let place = new.vectors("reference");
        let wave = |x: &[f64; 3]| [0.01 * x[0].sin(), 0.01 * (0.5 * x[0]).cos(), 0.0];
        let u: Vec<[f64; 3]> = place.iter().map(wave).collect();
        let (f, g) = (closed.forces_under(&u), new.forces_under(&u));
        let most = g.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
        assert!(most > 1e-2, "{most}");
        for (f, g) in f.iter().flatten().zip(g.iter().flatten()) {
            assert!((f - g).abs() < 1e-12 * most, "{law:?}: {f} {g}");
        }
    }
}

fn closes(law: &LawSpec, family: FamilyChoice, change: &dyn Fn(&mut Spec)) -> Box<dyn Simulation> {
    let mut spec = plate(law.clone(), family, false);
    spec.loading.initial = vec![];
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.1)));
    heals(&mut spec, "1e-3");
    // all points told: apart by two spacings and back
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement([
            Some(e("x > 7 ? 2*sin(pi*t/100)^2 : 0")),
            Some(e("0")),
            None,
        ]),
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.1);
    change(&mut spec);
    let mut sim = started(&spec);
    let mut most = 0.0f64;
    while sim.time() < 100.0 {
        (0..50).for_each(|_| sim.step().unwrap());
        most = sim.scalars("damage").into_iter().fold(most, f64::max);
    }
    assert!(most > 0.3, "{most}");
    assert!(sim.broken() > 100);
    let strain = sim.ledger().unwrap().strain;
    assert!(strain.abs() < 1e-9, "{law:?}: {strain}");
    assert_eq!(sim.scalars("damage").iter().sum::<f64>(), 0.0, "{law:?}");
    sim
}

#[test]
fn healing_that_cannot_be_is_refused() {
    let (law, family) = laws()[0].clone();
    let (flows, _) = general().pop().unwrap();
    let refused = |spec: &Spec| match build(spec, Options::default()) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("built"),
    };
    let mut spec = plate(law, family, false);
    heals(&mut spec, "1e-3");
    assert!(refused(&spec).contains("nothing of this body breaks"));
    spec.materials[0].law = flows;
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::PlasticStrain(0.1)));
    assert!(refused(&spec).contains("would break at once"));
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.1)));
    heals(&mut spec, "x");
    assert!(refused(&spec).contains("depends on the place"));
}

/// In implicit steps, too: what heals at rest moves as what was never cut.
#[test]
fn what_heals_at_the_end_of_an_implicit_step_pulls_in_the_next() {
    for (law, family) in laws() {
        let run = |cut: bool| {
            let mut spec = plate(law.clone(), family, cut);
            spec.loading.initial = vec![];
            // nothing moves in the first step, at whose end bonds heal
            spec.loading.conditions = vec![ConditionSpec {
                set: "all".into(),
                kind: ConditionKind::BodyForce([
                    Some(e("t > 0.3 ? 0.01*sin(0.3*x) : 0")),
                    None,
                    None,
                ]),
            }];
            if cut {
                heals(&mut spec, "0.1");
            }
            spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
            spec.run.schedule.time_step = TimeStep::Fixed(0.2);
            let mut sim = started(&spec);
            (0..30).for_each(|_| sim.step().unwrap());
            assert_eq!(sim.scalars("damage").iter().sum::<f64>(), 0.0);
            let l = sim.ledger().unwrap();
            assert!(
                l.strain > 0.0 && l.residual().abs() < 1e-2 * l.work_boundary_conditions,
                "{l:?}"
            );
            sim.displacements()
        };
        let (healed, whole) = (run(true), run(false));
        let most = whole.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
        for (a, b) in healed.iter().flatten().zip(whole.iter().flatten()) {
            assert!((a - b).abs() < 1e-6 * most, "{a} {b}");
        }
    }
}

/// After statics, too: what heals as motion begins moves as what was never cut.
#[test]
fn what_heals_after_statics_moves_as_what_was_never_cut() {
    for (law, family) in laws() {
        let run = |cut: bool| {
            let mut spec = plate(law.clone(), family, cut);
            if cut {
                heals(&mut spec, "0.1");
            }
            spec.sets = vec![SetSpec {
                name: "ends".into(),
                members: Members::Where(e("abs(x - 7) > 4")),
            }];
            spec.run.preload = Some(PreloadSpec {
                statics: Statics {
                    method: Method::Newton,
                    ..Statics::default()
                },
                increments: 1,
                duration: None,
                conditions: vec![ConditionSpec {
                    set: "ends".into(),
                    kind: ConditionKind::Displacement([Some(e("0")), Some(e("0")), None]),
                }],
                rigid_bodies: vec![],
                cuts: vec![],
            });
            let mut sim = started(&spec);
            (0..200).for_each(|_| sim.step().unwrap());
            assert_eq!(sim.scalars("damage").iter().sum::<f64>(), 0.0);
            sim.displacements()
        };
        let (healed, whole) = (run(true), run(false));
        let most = whole.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
        assert!(most > 1e-3, "{most}");
        for (a, b) in healed.iter().flatten().zip(whole.iter().flatten()) {
            assert!((a - b).abs() < 1e-9 * most, "{a} {b}");
        }
    }
}

/// The only bond of two points, which heals: its ends had nobody left, and bear no more than at first.
#[test]
fn the_last_bond_of_two_points_breaks_again() {
    for (law, family) in laws() {
        let body = BodySpec::Lattice {
            kind: LatticeKind::Square,
            spacing: 1.0,
            origin: [0.0; 3],
            region: Region::Block {
                low: [0.0; 3],
                high: [1.0, 0.0, 0.0],
            },
            perturb: None,
        };
        let mut spec = Spec::new(2, body, 1.0, law);
        spec.bonds.family = family;
        spec.bonds.horizon = Horizon::Ratio(1);
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.1)));
        heals(&mut spec, "0.02");
        spec.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Displacement([
                Some(e("x > 0.5 ? 0.4*sin(pi*t)^2 : 0")),
                Some(e("0")),
                None,
            ]),
        }];
        spec.run.schedule.time_step = TimeStep::Fixed(0.01);
        let mut sim = started(&spec);
        let mut pieces = vec![];
        for _ in 0..4 {
            (0..50).for_each(|_| sim.step().unwrap());
            pieces.push(sim.fragments());
        }
        assert_eq!(pieces, [2, 1, 2, 1], "{family:?}");
    }
}
