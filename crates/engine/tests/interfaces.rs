//! Bodies with laws and horizons of their own, and bonds between them by a law of an interface.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

const PMB: LawSpec = LawSpec::Pmb(PmbStiffness::Young(100.0));

fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

fn block(d: usize, spacing: f64, low: [f64; 3], high: [f64; 3]) -> BodySpec {
    let flat = |x: [f64; 3]| std::array::from_fn(|a| if a < d { x[a] } else { 0.0 });
    BodySpec::Lattice {
        kind: [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1],
        spacing,
        origin: flat(low),
        region: Region::Block {
            low: flat(low),
            high: flat(high),
        },
        perturb: None,
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

fn material(set: &str, density: f64, law: LawSpec) -> MaterialSpec {
    MaterialSpec {
        name: set.into(),
        set: set.into(),
        density,
        law,
        fracture: None,
    }
}

fn glue(law: LawSpec, horizon: Horizon) -> InterfaceSpec {
    InterfaceSpec {
        name: "glue".into(),
        bodies: ["left".into(), "right".into()],
        law,
        horizon,
        influence: Influence::Constant,
        fracture: None,
    }
}

/// A bar of 12 by 4 by 4 points at most, and the same in two halves that are glued.
fn bars(d: usize, law: &LawSpec) -> [Spec; 2] {
    let common = |body: BodySpec| {
        let mut spec = Spec::new(d, body, 2.0, law.clone());
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.bonds.partial_volume_correction = true;
        spec.run.schedule.time_step = TimeStep::Fraction(0.5);
        spec
    };
    let whole = common(block(d, 0.5, [0.0; 3], [5.5, 1.5, 1.5]));
    let left = block(d, 0.5, [0.0; 3], [2.5, 1.5, 1.5]);
    let right = block(d, 0.5, [3.0, 0.0, 0.0], [5.5, 1.5, 1.5]);
    let pieces = vec![PieceSpec::new("left", left), PieceSpec::new("right", right)];
    let mut glued = common(BodySpec::Several(pieces));
    glued.sets = vec![within("left"), within("right")];
    glued.interactions.interfaces = vec![glue(law.clone(), Horizon::Ratio(3))];
    [whole, glued]
}

fn at(x: &[f64; 3]) -> [f64; 3] {
    [
        0.02 * (3.0 * x[0] + x[1]).sin(),
        0.03 * (2.0 * x[1] - x[0] * x[2]).cos(),
        0.01 * (x[0] * x[1] + x[2]).sin(),
    ]
}

/// Where each point of `a` is among those of `b`.
fn places(a: &mut dyn Simulation, b: &mut dyn Simulation) -> Vec<usize> {
    let b = b.vectors("reference");
    let near = |x: &[f64; 3], y: &[f64; 3]| (0..3).all(|k| (x[k] - y[k]).abs() < 1e-9);
    let place = |x: &[f64; 3]| b.iter().position(|y| near(x, y)).unwrap();
    a.vectors("reference").iter().map(place).collect()
}

fn largest(f: &[[f64; 3]]) -> f64 {
    f.iter().flatten().fold(0.0, |m, x| m.max(x.abs()))
}

/// A factor that grows along a bar, and one of bonds that cross a plane through both halves.
fn factors(d: usize) -> Vec<BondFactorSpec> {
    let shape = match d {
        1 => CrackShape::Point { x: 2.6 },
        _ => CrackShape::Segment {
            from: [1.1, -1.05, 0.0],
            to: [4.2, 3.03, 0.0],
        },
    };
    vec![
        BondFactorSpec::Field(Expression::parse("0.4 + 0.2*x + 0.1*y", &[]).unwrap()),
        BondFactorSpec::Crossing { shape, factor: 0.3 },
    ]
}

#[test]
fn two_halves_glued_are_the_whole_bar() {
    for d in 1..=3 {
        let laws = [PMB, LawSpec::Pmb(PmbStiffness::Micromodulus(7.0))];
        let each = laws
            .iter()
            .flat_map(|law| [(law, vec![]), (law, factors(d))]);
        // laws of the registry, one of which softens from a stretch of 0.05 on
        let young = || Parameters::numbers(&[("young", 100.0)]);
        let softening = young().with("onset", Parameter::Number(0.1));
        let softening = LawSpec::named("softening", softening);
        let registered = [LawSpec::named("thermoelastic", young()), softening];
        for (law, factors) in each.chain(registered.iter().map(|law| (law, vec![]))) {
            let [mut whole, mut glued] = bars(d, law).map(|mut spec| {
                spec.bonds.factors.clone_from(&factors);
                if law == &registered[1] {
                    let ends = Some(FractureSpec::new(Criterion::Stretch(0.5)));
                    spec.materials[0].fracture = ends;
                    for interface in &mut spec.interactions.interfaces {
                        interface.fracture = ends;
                    }
                }
                let sim = build(&spec, Options::default()).unwrap();
                let told = |w: &peridyne::quantity::Message| w.contains("no bond crosses");
                assert!(!sim.info().warnings.iter().any(told));
                sim
            });
            assert_eq!(whole.info().directed_bonds, glued.info().directed_bonds);
            assert_eq!(glued.fragments(), 1);
            let place = places(glued.as_mut(), whole.as_mut());
            let moved = |sim: &mut dyn Simulation| -> Vec<[f64; 3]> {
                let flat = |x: &[f64; 3]| {
                    let u = at(x);
                    std::array::from_fn(|a| if a < d { u[a] } else { 0.0 })
                };
                sim.vectors("reference").iter().map(flat).collect()
            };
            let (u, w) = (moved(whole.as_mut()), moved(glued.as_mut()));
            let (f, g) = (whole.forces_under(&u), glued.forces_under(&w));
            let size = largest(&f);
            for (g, n) in g.iter().zip(&place) {
                for a in 0..d {
                    assert!(
                        (g[a] - f[*n][a]).abs() < 1e-12 * size,
                        "{d}-D: {g:?} {:?}",
                        f[*n]
                    );
                }
            }
            // energies, stable steps, virials
            whole.set_displacements(&u);
            glued.set_displacements(&w);
            let energy = |sim: &mut dyn Simulation| sim.ledger().unwrap().strain;
            let (e, o) = (energy(whole.as_mut()), energy(glued.as_mut()));
            assert!((e - o).abs() < 1e-12 * e, "{e} {o}");
            let dt = whole.info().stable_step / glued.info().stable_step;
            assert!((dt - 1.0).abs() < 0.02, "{dt}");
            let (v, o) = (whole.virial(), glued.virial());
            let size = v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (v, o) in v.iter().zip(&o) {
                assert!((v - o).abs() < 1e-11 * size, "{v} {o}");
            }
            let (e, o) = (
                whole.scalars("energy_density"),
                glued.scalars("energy_density"),
            );
            for (o, n) in o.iter().zip(&place) {
                assert!((o - e[*n]).abs() < 1e-11 * e[*n].abs().max(1e-3));
            }
        }
    }
}

#[test]
fn glued_bodies_hang_in_equilibrium_like_the_whole() {
    let mut found = vec![];
    for solver in [Solver::Direct, Solver::ConjugateGradients] {
        for mut spec in bars(2, &PMB) {
            spec.sets.push(SetSpec {
                name: "wall".into(),
                members: Members::Where(text("x < 0.6").unwrap()),
            });
            spec.loading.conditions = vec![
                ConditionSpec {
                    set: "wall".into(),
                    kind: ConditionKind::Displacement([text("0"), text("0"), None]),
                },
                ConditionSpec {
                    set: "all".into(),
                    kind: ConditionKind::BodyForce([text("0.1*t"), text("-0.02*t"), None]),
                },
            ];
            spec.run.schedule.steps = 1;
            spec.run.schedule.time_step = TimeStep::Fixed(1.0);
            spec.run.schedule.stepper = Stepper::Statics(Statics {
                method: Method::Newton,
                solver,
                tolerance: 1e-11,
                ..Statics::default()
            });
            let mut sim = build(&spec, Options::default()).unwrap();
            sim.start(true);
            sim.step().unwrap();
            found.push(sim);
        }
    }
    let [whole, glued, ..] = &mut found[..] else {
        panic!("four were solved");
    };
    let place = places(glued.as_mut(), whole.as_mut());
    let whole = whole.displacements();
    let size = largest(&whole);
    assert!(size > 1e-3);
    for glued in [1, 3] {
        for (u, n) in found[glued].displacements().iter().zip(&place) {
            for a in 0..2 {
                assert!((u[a] - whole[*n][a]).abs() < 1e-7 * size);
            }
        }
    }
}

/// The glued bar, pulled apart; bodies bear ten times the stretch of the glue.
fn pulled() -> Spec {
    let [_, mut spec] = bars(2, &PMB);
    let breaks = |s: f64| {
        Some(FractureSpec {
            criterion: Criterion::Stretch(s),
            alpha: 0.0,
            rate: None,
            fatigue: None,
        })
    };
    spec.materials[0].fracture = breaks(0.05);
    spec.interactions.interfaces[0].fracture = breaks(0.005);
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    });
    for (set, v) in [("left", "-0.02*(3-x)"), ("right", "0.02*(x-2.5)")] {
        spec.loading.initial.push(InitialSpec {
            set: set.into(),
            displacement: [None, None, None],
            velocity: [text(v), None, None],
        });
    }
    spec.run.schedule.time_step = TimeStep::Fraction(0.05);
    spec
}

#[test]
fn a_weaker_interface_breaks_first_and_the_energy_balances() {
    let mut spec = pulled();
    // no faster than what breaks the glue alone
    for i in &mut spec.loading.initial {
        let v = i.velocity[0]
            .as_ref()
            .unwrap()
            .source()
            .replace("0.02", "0.08");
        i.velocity[0] = text(&v);
    }
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let initial = sim.ledger().unwrap().initial;
    let bonds = sim.info().directed_bonds;
    while sim.time() < 3.0 {
        sim.step().unwrap();
    }
    assert_eq!(sim.fragments(), 2, "{} broken", sim.broken());
    let l = sim.ledger().unwrap();
    assert!(l.released > 0.01 * initial, "{l:?}");
    assert!(l.residual().abs() < 0.01 * initial, "{l:?}");
    // broken are the bonds of the interface, all of them
    let [_, free] = bars(2, &PMB);
    let mut apart = free.clone();
    apart.interactions.interfaces.clear();
    let own = build(&apart, Options::default()).unwrap();
    assert_eq!(sim.broken(), bonds - own.info().directed_bonds);
    // their volume over that of all
    let joined = build(&free, Options::default()).unwrap();
    let (all, own) = (joined.families(), own.families());
    for (n, damage) in sim.scalars("damage").iter().enumerate() {
        let expected = 1.0 - own.volume[n] / all.volume[n];
        assert!(
            (damage - expected).abs() < 1e-12,
            "{n}: {damage}, not {expected}"
        );
    }
    assert!(sim.scalars("damage").iter().any(|d| *d > 0.2));
}

#[test]
fn an_interface_has_the_same_bits_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new();
        let pool = pool.num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut sim = build(&pulled(), Options::default()).unwrap();
            sim.start(true);
            for _ in 0..200 {
                sim.step().unwrap();
            }
            (sim.velocities(), sim.broken())
        })
    };
    assert_eq!(run(1), run(3));
}

/// A fine ball of one law flies into a coarse plate of another.
fn unlike() -> Spec {
    let ball = block(2, 0.6, [3.1, 8.7, 0.0], [7.4, 12.4, 0.0]);
    let plate = block(2, 1.0, [0.0; 3], [11.0, 7.0, 0.0]);
    let pieces = vec![
        PieceSpec {
            horizon: Some(Horizon::Ratio(2)),
            influence: Some(Influence::Inverse),
            ..PieceSpec::new("ball", ball)
        },
        PieceSpec {
            family: Some(FamilyChoice::List),
            ..PieceSpec::new("plate", plate)
        },
    ];
    let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, PMB);
    spec.sets = vec![within("ball"), within("plate")];
    let solid = LawSpec::Lps(Moduli {
        young: 300.0,
        poisson: 0.2,
    });
    spec.materials = vec![material("ball", 2.0, solid), material("plate", 1.0, PMB)];
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.bonds.partial_volume_correction = true;
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    });
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    spec
}

#[test]
fn bodies_of_unlike_laws_and_horizons_are_what_each_is_alone() {
    let spec = unlike();
    let BodySpec::Several(pieces) = &spec.body else {
        panic!("there are two");
    };
    let mut both = build(&spec, Options::default()).unwrap();
    assert_eq!(both.info().family_kind, "stencil and list");
    let u: Vec<[f64; 3]> = both.vectors("reference").iter().map(at).collect();
    let u: Vec<[f64; 3]> = u.iter().map(|u| [u[0], u[1], 0.0]).collect();
    let f = both.forces_under(&u);
    let mut first = 0;
    let mut steps = vec![];
    for (piece, m) in pieces.iter().zip(&spec.materials) {
        let mut alone = Spec {
            body: piece.body.clone(),
            sets: vec![],
            ..spec.clone()
        };
        let bonds = &mut alone.bonds;
        bonds.horizon = piece.horizon.unwrap_or(bonds.horizon);
        bonds.influence = piece.influence.unwrap_or(bonds.influence);
        bonds.family = piece.family.unwrap_or(bonds.family);
        alone.materials = vec![MaterialSpec {
            set: "all".into(),
            ..m.clone()
        }];
        let mut sim = build(&alone, Options::default()).unwrap();
        let n = sim.info().points as usize;
        let own = sim.forces_under(&u[first..first + n]);
        assert_eq!(own, f[first..first + n], "{}", piece.name);
        assert!(largest(&own) > 0.0);
        steps.push(sim.info().stable_step);
        first += n;
    }
    let [ball, plate] = [steps[0], steps[1]];
    assert!((ball / plate - 1.0).abs() > 0.1, "{ball} {plate}");
    let stable = both.info().stable_step;
    assert!(stable <= 1.02 * ball.min(plate), "{stable} {ball} {plate}");
}

#[test]
fn unlike_bodies_collide_with_momentum_and_energy() {
    let mut spec = unlike();
    spec.loading.initial = vec![InitialSpec {
        set: "ball".into(),
        displacement: [None, None, None],
        velocity: [text("0.3"), text("-2"), None],
    }];
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let momentum = |sim: &mut dyn Simulation| {
        let (v, m) = (sim.velocities(), sim.scalars("volume"));
        let rho = sim.scalars("density");
        let of = |a: usize| (0..m.len()).map(|i| v[i][a] * m[i] * rho[i]).sum::<f64>();
        [of(0), of(1)]
    };
    let before = momentum(sim.as_mut());
    let initial = sim.ledger().unwrap().initial;
    let mut touched = 0.0f64;
    while sim.time() < 3.0 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        touched = touched.max(l.contact);
        assert!(l.residual().abs() < 3e-3 * initial, "{l:?}");
    }
    assert!(touched > 1e-3 * initial);
    let after = momentum(sim.as_mut());
    for a in 0..2 {
        assert!((after[a] - before[a]).abs() < 1e-11 * before[1].abs());
    }
}

#[test]
fn what_joins_nothing_is_refused() {
    let [_, glued] = bars(2, &PMB);
    let refused = |change: &dyn Fn(&mut Spec), what: &str| {
        let mut spec = glued.clone();
        change(&mut spec);
        let error = build(&spec, Options::default()).err().expect(what);
        assert!(error.message.contains(what), "{error}");
        assert!(error.path.starts_with("interface"), "{}", error.path);
    };
    let solid = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.2,
    });
    refused(
        &|s| s.interactions.interfaces[0].law = solid.clone(),
        "acts through its points",
    );
    refused(
        &|s| s.interactions.interfaces[0].bodies[1] = "cat".into(),
        "there is no body `cat`",
    );
    refused(
        &|s| s.interactions.interfaces[0].bodies[1] = "left".into(),
        "joins a body with itself",
    );
    refused(
        &|s| {
            s.interactions
                .interfaces
                .push(s.interactions.interfaces[0].clone())
        },
        "two interfaces join",
    );
    let far = |s: &mut Spec| {
        let BodySpec::Several(pieces) = &mut s.body else {
            return;
        };
        pieces[1].body = block(2, 0.5, [9.0, 0.0, 0.0], [11.5, 1.5, 1.5]);
    };
    refused(&far, "no point of `left` is within");
    // of one body there is nothing to join
    let [mut whole, _] = bars(2, &PMB);
    whole.interactions.interfaces = glued.interactions.interfaces.clone();
    assert!(build(&whole, Options::default()).is_err());
}

/// Bonds that break in turn: those of the glue at the stretch of the glue, whatever the halves bear.
#[test]
fn glue_breaks_in_turn_at_its_own_stretch() {
    let end = |set: &str, low: f64, high: f64| SetSpec {
        name: set.into(),
        members: Members::Within {
            body: set.into(),
            members: Box::new(Members::Region(Region::Block {
                low: [low, -1.0, -1.0],
                high: [high, 2.0, 1.0],
            })),
        },
    };
    let held = |set: &str, x: &str| ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement([text(x), text("0"), None]),
    };
    let [_, mut spec] = bars(2, &PMB);
    spec.sets = vec![end("left", -0.1, 0.1), end("right", 5.4, 5.6)];
    spec.loading.conditions = vec![held("left", "0"), held("right", "t")];
    spec.interactions.interfaces[0].fracture = Some(FractureSpec::new(Criterion::Stretch(1e-3)));
    spec.run.schedule.steps = 3;
    // an increment of load
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    let statics = |control: Control| {
        Stepper::Statics(Statics {
            control,
            ..Statics::default()
        })
    };
    let first = |halves: Option<f64>, glue: Option<f64>| {
        let mut spec = spec.clone();
        let at = |s: f64| FractureSpec::new(Criterion::Stretch(s));
        spec.materials[0].fracture = halves.map(at);
        spec.interactions.interfaces[0].fracture = glue.map(at);
        spec.run.schedule.stepper = statics(Control::SequentiallyLinear);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        sim.step().unwrap();
        let t = sim.time();
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        assert!(
            l.residual().abs() < 1e-9 * l.work_boundary_conditions.abs(),
            "{l:?}"
        );
        assert!(sim.broken() > 0 && l.released > 0.0);
        t
    };
    let t = first(None, Some(1e-3));
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * b;
    // tougher halves do not matter, weaker glue breaks so much earlier, and halves break where glue does not
    assert!(near(first(Some(1.0), Some(1e-3)), t));
    assert!(near(first(None, Some(5e-4)), 0.5 * t));
    let halves = first(Some(1e-3), None);
    assert!(near(first(Some(1e-3), Some(1.0)), halves));
    // the load at which it breaks where the load is given
    for (part, breaks) in [(0.99, false), (1.01, true)] {
        let mut told = spec.clone();
        told.loading.conditions[1] = held("right", &format!("{:e}*t", part * t));
        told.run.schedule.steps = 1;
        told.run.schedule.stepper = statics(Control::Load);
        let mut sim = build(&told, Options::default()).unwrap();
        sim.start(true);
        let _ = sim.step();
        assert_eq!(sim.broken() > 0, breaks, "{part}: {}", sim.broken());
    }
}

/// A chain of 20 springs of the length 1, of which one is glue, and what its end is told.
fn chain(law: &LawSpec, told: &str) -> Spec {
    let half = |low: f64, high: f64| block(1, 1.0, [low, 0.0, 0.0], [high, 0.0, 0.0]);
    let pieces = vec![
        PieceSpec::new("left", half(0.0, 9.0)),
        PieceSpec::new("right", half(10.0, 20.0)),
    ];
    let mut spec = Spec::new(1, BodySpec::Several(pieces), 1.0, law.clone());
    spec.bonds.horizon = Horizon::Ratio(1);
    spec.interactions.interfaces = vec![glue(law.clone(), Horizon::Ratio(1))];
    for (name, at, u) in [("low", "x < 0.1", "0"), ("high", "x > 19.9", told)] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Where(Expression::parse(at, &[]).unwrap()),
        });
        spec.loading.conditions.push(ConditionSpec {
            set: name.into(),
            kind: ConditionKind::Displacement([text(u), None, None]),
        });
    }
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec
}

/// A bond of the length 1 takes `w = ½ c s²`, and glue of such bonds that of one: the chain bears `s = √(2 G/c)` of its 20 springs.
#[test]
fn glue_breaks_in_turn_by_its_work() {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(2.0));
    let mut spec = chain(&law, "3*t");
    let fracture = FractureSpec::new(Criterion::BondEnergy(1e-4));
    spec.interactions.interfaces[0].fracture = Some(fracture);
    spec.run.schedule.steps = 1;
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        control: Control::SequentiallyLinear,
        ..Statics::default()
    });
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    assert!((sim.time() - 0.2 / 3.0).abs() < 1e-12, "{}", sim.time());
    let l = sim.ledger().unwrap();
    assert!((l.strain - 20.0 * 1e-4).abs() < 1e-13, "{l:?}");
}

/// A half that breaks at a stretch of 1 % beside one that never does: the chain of 20 springs bears 20 times that.
#[test]
fn halves_break_in_turn_beside_halves_that_do_not() {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(2.0));
    let mut spec = chain(&law, "3*t");
    spec.materials = ["left", "right"]
        .map(|n| material(n, 1.0, law.clone()))
        .into();
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.01)));
    spec.sets.extend(["left", "right"].map(within));
    spec.run.schedule.steps = 1;
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        control: Control::SequentiallyLinear,
        ..Statics::default()
    });
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    assert!((sim.time() - 0.2 / 3.0).abs() < 1e-12, "{}", sim.time());
}

/// The one bond of the glue of a chain that is pulled to a hundredth of its length wears by `a ((1 − R) s)^m` a cycle, and is broken in the second increment.
#[test]
fn glue_wears_in_cycles() {
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(2.0));
    let mut spec = chain(&law, "0.2");
    spec.interactions.interfaces[0].fracture = Some(FractureSpec {
        fatigue: Some(FatigueSpec {
            nucleation: Some([1e3, 2.0]),
            limit: 0.0,
            growth: None,
            crack: 0.35,
        }),
        ..FractureSpec::new(Criterion::Stretch(0.5))
    });
    spec.run.schedule.steps = 2;
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-11,
        cycles: Some(Cycles {
            load_ratio: 0.1,
            bonds: 1,
            most: f64::INFINITY,
        }),
        ..Statics::default()
    });
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    (0..2).for_each(|_| sim.step().unwrap());
    let exact = 1.0 / (1e3 * 0.009f64.powi(2));
    let found = sim.cycles().unwrap();
    assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
    assert_eq!((sim.broken(), sim.fragments()), (2, 2));
}

/// What glue breaks by beside its stretch: by work, and later where it is pulled fast.
#[test]
fn glue_breaks_by_work_and_rate() {
    let broken = |fracture: FractureSpec| {
        let mut spec = pulled();
        spec.materials[0].fracture = None;
        spec.interactions.interfaces[0].fracture = Some(fracture);
        for (i, v) in spec
            .loading
            .initial
            .iter_mut()
            .zip(["-0.08*(3-x)", "0.08*(x-2.5)"])
        {
            i.velocity[0] = text(v);
        }
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let first = sim.ledger().unwrap().initial;
        let mut when = None;
        while sim.time() < 3.0 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            assert!(l.residual().abs() < 0.02 * first, "{fracture:?}: {l:?}");
            if sim.broken() > 0 {
                when.get_or_insert(sim.time());
            }
        }
        when
    };
    let by = |criterion: Criterion| FractureSpec::new(criterion);
    let plain = broken(by(Criterion::Stretch(0.005))).expect("it breaks");
    // the reference is a hundredth of how fast bonds are stretched: they bear 1 + 0.1 ln 100 = 1.46 times as much
    let fast = FractureSpec {
        rate: Some(RateSpec {
            coefficient: 0.1,
            reference: 8e-4,
        }),
        ..by(Criterion::Stretch(0.005))
    };
    let late = broken(fast).is_none_or(|when| when > plain);
    assert!(late, "{plain}");
    assert!(broken(by(Criterion::BondEnergy(1e-9))).is_some());
    assert!(broken(by(Criterion::BondEnergy(1e9))).is_none());
}

/// Bonds of an interface heal like all others: cut and healed at once, it was never cut.
#[test]
fn an_interface_heals() {
    for d in 2..=3 {
        let [_, glued] = bars(d, &PMB);
        let run = |cut: bool| {
            let mut spec = glued.clone();
            spec.loading.initial = vec![InitialSpec {
                set: "all".into(),
                displacement: [None, None, None],
                velocity: [text("0.02*sin(x)"), text("0.01*cos(x + y)"), None],
            }];
            if cut {
                spec.damage.precracks = vec![PrecrackSpec {
                    shape: CrackShape::Segment {
                        from: [2.75, -1.0, 0.0],
                        to: [2.75, 3.0, 0.0],
                    },
                    kind: CrackKind::Broken,
                }];
                spec.damage.healing = Some(HealingSpec {
                    set: "all".into(),
                    below: Expression::parse("0.1", &[]).unwrap(),
                });
            }
            let mut sim = build(&spec, Options::default()).unwrap();
            sim.start(true);
            let cut = sim.info().cut;
            (0..40).for_each(|_| sim.step().unwrap());
            (cut, sim.fragments(), sim.displacements())
        };
        let ((cut, one, healed), (none, _, whole)) = (run(true), run(false));
        assert!(cut > 0 && none == 0 && one == 1, "{cut} {none} {one}");
        assert_eq!(healed, whole);
    }
}

/// Glue that lets go and is pressed together again holds as before, whatever it breaks by, and where nothing else breaks.
#[test]
fn glue_that_came_apart_heals() {
    for criterion in [Criterion::Stretch(0.01), Criterion::BondEnergy(1e-3)] {
        let [_, mut spec] = bars(2, &PMB);
        spec.interactions.interfaces[0].fracture = Some(FractureSpec::new(criterion));
        spec.damage.healing = Some(HealingSpec {
            set: "all".into(),
            below: Expression::parse("1e-3", &[]).unwrap(),
        });
        spec.loading.conditions = vec![ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Displacement([
                text("x > 2.75 ? 2*sin(pi*t/10)^2 : 0"),
                text("0"),
                None,
            ]),
        }];
        spec.run.schedule.time_step = TimeStep::Fixed(0.01);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        (0..500).for_each(|_| sim.step().unwrap());
        assert_eq!(sim.fragments(), 2, "{criterion:?}");
        (0..500).for_each(|_| sim.step().unwrap());
        assert_eq!(sim.fragments(), 1, "{criterion:?}");
        assert_eq!(sim.scalars("damage").iter().sum::<f64>(), 0.0);
        let strain = sim.ledger().unwrap().strain;
        assert!(strain.abs() < 1e-9, "{criterion:?}: {strain}");
    }
}
