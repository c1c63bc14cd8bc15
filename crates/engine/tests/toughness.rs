//! Toughness of places and times: factors of the critical stretch, and sets that never fail, on lattices, clouds and laws of any kind.

use peridyne::error::{BuildError, RunError};
use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn text(e: &str) -> Expression {
    Expression::parse(e, &[]).unwrap()
}

fn rows(low: f64, high: f64) -> Members {
    Members::Region(Region::Block {
        low: [low, f64::NEG_INFINITY, f64::NEG_INFINITY],
        high: [high, f64::INFINITY, f64::INFINITY],
    })
}

/// A plate of 13 × 6 points whose ends are pulled apart, of a law that bears a stretch of 0.02; on a lattice or as a cloud.
fn plate(law: LawSpec, family: FamilyChoice) -> Spec {
    let body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: [12.0, 5.0, 0.0],
        },
        perturb: None,
    };
    let mut spec = Spec::new(2, body, 1.0, law);
    spec.space.plane = Plane::Strain;
    spec.bonds.family = family;
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Stretch(0.02),
        alpha: 0.0,
        rate: None,
        fatigue: None,
    });
    spec.sets = [
        ("left", rows(-0.5, 1.5)),
        ("right", rows(10.5, 12.5)),
        ("middle", rows(5.5, 7.5)),
    ]
    .map(|(name, members)| SetSpec {
        name: name.into(),
        members,
    })
    .to_vec();
    for (set, v) in [("left", "-0.02"), ("right", "0.02")] {
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Velocity([Some(text(v)), None, None]),
        });
    }
    spec.run.schedule.time_step = TimeStep::Fraction(0.3);
    spec
}

fn toughness(set: &str, factor: ToughnessFactor) -> ToughnessSpec {
    ToughnessSpec {
        set: set.into(),
        factor,
    }
}

fn started(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

/// Laws and families that break bonds by themselves: the hot loop of lattices, lists, and laws of `law/material` on both.
fn all() -> Vec<(LawSpec, FamilyChoice)> {
    let elastic = Parameters::numbers(&[("young", 1.0), ("poisson", 0.25)]);
    let laws = [
        LawSpec::Pmb(PmbStiffness::Young(1.0)),
        LawSpec::Lps(Moduli {
            young: 1.0,
            poisson: 0.2,
        }),
        LawSpec::named("correspondence", elastic),
    ];
    let families = [FamilyChoice::Stencil, FamilyChoice::List];
    laws.iter()
        .flat_map(|law| families.map(|f| (law.clone(), f)))
        .collect()
}

/// Ids of the ends of bonds that are broken.
fn broken(sim: &mut dyn Simulation, whole: &[(u32, u32)]) -> Vec<(u32, u32)> {
    let now = sim.snapshot(&[], true).bonds.unwrap();
    whole.iter().filter(|b| !now.contains(b)).copied().collect()
}

/// Loose points of a body of one material: what is in the set keeps every bond, all else tears.
#[test]
fn bonds_of_a_set_that_never_fails_hold() {
    for (law, family) in all() {
        let run = |spared: bool| {
            let mut spec = plate(law.clone(), family);
            if spared {
                spec.damage.toughness = vec![toughness("middle", ToughnessFactor::NoFailure)];
            }
            let mut sim = started(&spec);
            let whole = sim.snapshot(&[], true).bonds.unwrap();
            while sim.time() < 60.0 {
                sim.step().unwrap();
            }
            let middle = sim.members("middle").unwrap();
            let of = |b: &(u32, u32)| middle.contains(&b.0) || middle.contains(&b.1);
            let lost = broken(sim.as_mut(), &whole);
            (
                lost.iter().filter(|b| of(b)).count(),
                lost.len(),
                sim.broken(),
            )
        };
        let (spared, torn, counted) = run(true);
        assert_eq!(spared, 0, "{law:?} {family:?}");
        assert!(torn > 20, "{law:?} {family:?}: {torn}");
        assert_eq!(counted, 2 * torn as u64, "{law:?} {family:?}");
        // without it the whole plate may tear, its middle too
        assert!(run(false).0 > 0, "{law:?} {family:?}");
    }
}

/// A factor of 1 changes no bit, one of the energy is that of the stretch squared, and a factor of everything is another critical stretch.
#[test]
fn factors_are_those_of_the_critical_stretch() {
    for (law, family) in all() {
        let state = |change: &dyn Fn(&mut Spec)| {
            let mut spec = plate(law.clone(), family);
            change(&mut spec);
            let mut sim = started(&spec);
            while sim.time() < 30.0 {
                sim.step().unwrap();
            }
            (sim.broken(), sim.displacements())
        };
        let with = |factor: ToughnessFactor| {
            state(&|s: &mut Spec| s.damage.toughness = vec![toughness("all", factor.clone())])
        };
        let plain = state(&|_| {});
        assert!(plain.0 > 0, "{law:?} {family:?}");
        assert_eq!(
            with(ToughnessFactor::Stretch(text("1"))),
            plain,
            "{law:?} {family:?}"
        );
        // 0.02 × 1.5 = 0.03, and so to the bit
        let stronger = state(&|s: &mut Spec| {
            s.materials[0].fracture = Some(FractureSpec {
                criterion: Criterion::Stretch(0.02 * 1.5),
                alpha: 0.0,
                rate: None,
                fatigue: None,
            });
        });
        assert_ne!(stronger.0, plain.0, "{law:?} {family:?}");
        assert_eq!(
            with(ToughnessFactor::Stretch(text("1.5"))),
            stronger,
            "{law:?} {family:?}"
        );
        assert_eq!(
            with(ToughnessFactor::Energy(text("1.5^2"))),
            stronger,
            "{law:?} {family:?}"
        );
        // two factors are multiplied
        let two = state(&|s: &mut Spec| {
            s.damage.toughness = vec![
                toughness("all", ToughnessFactor::Stretch(text("3"))),
                toughness("all", ToughnessFactor::Stretch(text("0.5"))),
            ];
        });
        assert_eq!(two.0, stronger.0, "{law:?} {family:?}");
    }
}

/// A chain of two points that part with a constant speed breaks when its stretch is that of the time: s(t) = 2vt, s0 = 0.5 (1 − t).
#[test]
fn a_bond_breaks_at_the_stretch_of_its_time() {
    let body = BodySpec::Cloud(Cloud {
        position: vec![[0.0; 3], [1.0, 0.0, 0.0]],
        volume: vec![1.0; 2],
        spacing: Some(1.0),
        ..Cloud::default()
    });
    let mut spec = Spec::new(1, body, 1.0, LawSpec::Pmb(PmbStiffness::Young(1e-9)));
    spec.bonds.horizon = Horizon::Length(1.5);
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Stretch(0.5),
        alpha: 0.0,
        rate: None,
        fatigue: None,
    });
    spec.damage.toughness = vec![toughness("all", ToughnessFactor::Stretch(text("1 - t")))];
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: [Some(text("x > 0.5 ? 0.25 : -0.25")), None, None],
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let mut sim = started(&spec);
    while sim.broken() == 0 {
        sim.step().unwrap();
        assert!(sim.time() < 0.9);
    }
    // 0.5 t = 0.5 (1 − t)
    assert!((sim.time() - 0.5).abs() < 1.5e-3, "{}", sim.time());
}

#[test]
fn random_toughness_has_the_same_bits_on_any_number_of_threads() {
    let run = |threads: usize, (law, family): (LawSpec, FamilyChoice)| {
        let pool = rayon::ThreadPoolBuilder::new();
        let pool = pool.num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut spec = plate(law, family);
            let noise = text("(0.7 + 0.6*random(x, y, 3)) * (1 + 0.01*t)");
            spec.damage.toughness = vec![toughness("all", ToughnessFactor::Energy(noise))];
            let mut sim = started(&spec);
            while sim.time() < 40.0 {
                sim.step().unwrap();
            }
            (sim.broken(), sim.displacements())
        })
    };
    for what in all() {
        let one = run(1, what.clone());
        assert!(one.0 > 0, "{what:?}");
        assert_eq!(one, run(3, what));
    }
}

/// What failed by its own damage is spared, too; and statics spares as motion does.
#[test]
fn statics_spares_sets() {
    let mut spec = plate(
        LawSpec::Pmb(PmbStiffness::Young(1.0)),
        FamilyChoice::Stencil,
    );
    spec.loading.conditions.clear();
    for (set, u) in [("left", "-0.03*t"), ("right", "0.03*t")] {
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([Some(text(u)), Some(text("0")), None]),
        });
    }
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.stepper = Stepper::Statics(Statics::default());
    let mut torn = vec![];
    for spared in [vec![], vec!["left", "right", "middle"]] {
        let mut spec = spec.clone();
        let never = |set: &&str| toughness(set, ToughnessFactor::NoFailure);
        spec.damage.toughness = spared.iter().map(never).collect();
        let mut sim = started(&spec);
        // until the plate is torn in two, which statics refuses
        for _ in 0..6 {
            if sim.step().is_err() {
                break;
            }
        }
        let damage = sim.scalars("damage");
        let middle = sim.members("middle").unwrap();
        let of_middle = middle.iter().map(|i| damage[*i as usize]);
        torn.push((of_middle.fold(0.0, f64::max), sim.broken()));
    }
    assert_eq!(torn[1].0, 0.0, "{torn:?}");
    assert!(torn[0].1 > 0 && torn[1].1 > 0, "{torn:?}");
}

/// Factors of bodies that break by their stretch and by the work on their bonds are those of each alone.
#[test]
fn bodies_of_unlike_criteria_have_factors_of_their_own() {
    let law = LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 1.0)]));
    let alone = |y: f64, criterion: Criterion| {
        let mut spec = plate(law.clone(), FamilyChoice::Auto);
        let BodySpec::Lattice { region, .. } = &mut spec.body else {
            panic!("a plate lies on a lattice");
        };
        *region = Region::Block {
            low: [0.0, y, 0.0],
            high: [12.0, y + 5.0, 0.0],
        };
        spec.materials[0].fracture = Some(FractureSpec::new(criterion));
        spec.damage.toughness = vec![
            toughness("middle", ToughnessFactor::Stretch(text("0.8"))),
            toughness("left", ToughnessFactor::Energy(text("1.5"))),
            toughness("right", ToughnessFactor::NoFailure),
        ];
        spec.run.schedule.time_step = TimeStep::Fixed(0.2);
        spec
    };
    let parts = [
        ("low", alone(0.0, Criterion::Stretch(0.02))),
        ("high", alone(100.0, Criterion::BondEnergy(1e-3))),
    ];
    let mut both = parts[0].1.clone();
    both.materials.clear();
    let mut pieces = vec![];
    for (name, part) in &parts {
        pieces.push(PieceSpec::new(*name, part.body.clone()));
        both.sets.push(SetSpec {
            name: (*name).into(),
            members: Members::Within {
                body: (*name).into(),
                members: Box::new(Members::All),
            },
        });
        both.materials.push(MaterialSpec {
            name: (*name).into(),
            set: (*name).into(),
            ..part.materials[0].clone()
        });
    }
    both.body = BodySpec::Several(pieces);
    let run = |spec: &Spec| {
        let mut sim = started(spec);
        for _ in 0..200 {
            sim.step().unwrap();
        }
        (sim.broken(), sim.displacements())
    };
    let [low, high] = [0, 1].map(|n: usize| run(&parts[n].1));
    assert!(low.0 > 0 && high.0 > 0, "{} {}", low.0, high.0);
    let (broken, u) = run(&both);
    assert_eq!(broken, low.0 + high.0);
    for (a, b) in low.1.iter().chain(&high.1).zip(&u) {
        for k in 0..2 {
            assert!((a[k] - b[k]).abs() < 1e-9, "{a:?} {b:?}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |change: &dyn Fn(&mut Spec)| -> BuildError {
        let mut spec = plate(LawSpec::Pmb(PmbStiffness::Young(1.0)), FamilyChoice::Auto);
        spec.damage.toughness = vec![toughness("all", ToughnessFactor::Stretch(text("2")))];
        change(&mut spec);
        build(&spec, Options::default())
            .err()
            .expect("it was built")
    };
    let told = |change: &dyn Fn(&mut Spec), says: &str| {
        let error = refused(change);
        assert!(error.message.contains(says), "{}", error.message);
    };
    told(
        &|s| s.materials[0].fracture = None,
        "no material of this body breaks",
    );
    told(
        &|s| s.damage.toughness[0].set = "nowhere".into(),
        "there is no set `nowhere`",
    );
    told(
        &|s| s.damage.toughness[0].factor = ToughnessFactor::Stretch(text("x - 3")),
        "the factor is -3",
    );
    told(
        &|s| s.damage.toughness[0].factor = ToughnessFactor::Energy(text("sqrt(x - 3)")),
        "expected a positive number",
    );
    told(
        &|s| {
            if let Some(f) = &mut s.materials[0].fracture {
                f.alpha = 0.25;
            }
        },
        "alpha",
    );
    told(
        &|s| {
            let all = Parameters::numbers(&[("young", 1.0), ("onset", 0.1)]);
            s.materials[0].law = LawSpec::named("softening", all);
        },
        "among its constants",
    );
    // a factor that ends stops the run before the step, and says where
    let mut spec = plate(LawSpec::Pmb(PmbStiffness::Young(1.0)), FamilyChoice::Auto);
    spec.damage.toughness = vec![toughness("all", ToughnessFactor::Stretch(text("5 - t")))];
    let mut sim = started(&spec);
    let error = loop {
        match sim.step() {
            Ok(()) => assert!(sim.time() < 5.0),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, RunError::Toughness { .. }), "{error}");
    assert!(sim.displacements().iter().flatten().all(|x| x.is_finite()));
}
