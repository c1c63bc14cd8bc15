//! One of several bodies that touch nothing is that body alone, bit by bit, whatever the others are; what they share is counted once.

use peridyne::expression::Expression;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

const PMB: LawSpec = LawSpec::Pmb(PmbStiffness::Young(1.0));
const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 1.0,
    poisson: 0.3,
});

fn text(e: &str) -> Expression {
    Expression::parse(e, &[]).unwrap()
}

fn written(e: &str) -> Influence {
    Influence::Formula(Formula::parse(e, &[]).unwrap())
}

/// So many spacings of 1, of a body whose lower corner is at (`x`, 0).
fn block(size: &[f64], x: f64) -> BodySpec {
    let kind = [LatticeKind::Chain, LatticeKind::Square][size.len() - 1];
    let low = [x, 0.0, 0.0];
    let high = std::array::from_fn(|a| low[a] + size.get(a).map_or(0.0, |n| n - 1.0));
    BodySpec::Lattice {
        kind,
        spacing: 1.0,
        origin: low,
        region: Region::Block { low, high },
        perturb: None,
    }
}

/// A body of one material, which has its name; a material, too, of points where an expression is not 0.
struct Part {
    piece: PieceSpec,
    materials: Vec<(MaterialSpec, &'static str)>,
}

fn part(name: &str, body: BodySpec, law: LawSpec) -> Part {
    let material = MaterialSpec {
        name: name.into(),
        set: name.into(),
        density: 1.0,
        law,
        fracture: None,
    };
    Part {
        piece: PieceSpec {
            horizon: Some(Horizon::Ratio(3)),
            ..PieceSpec::new(name, body)
        },
        materials: vec![(material, "1")],
    }
}

/// Bodies that move as a bent and stretched place of all does.
fn together(d: usize, parts: Vec<Part>) -> Spec {
    let pieces: Vec<PieceSpec> = parts.iter().map(|p| p.piece.clone()).collect();
    let mut spec = Spec::new(d, BodySpec::Several(pieces), 1.0, PMB);
    spec.bonds.partial_volume_correction = true;
    spec.bonds.calibration = Calibration::Continuum;
    spec.materials.clear();
    for part in parts {
        for (material, place) in part.materials {
            spec.sets.push(SetSpec {
                name: material.set.clone(),
                members: Members::Within {
                    body: part.piece.name.clone(),
                    members: Box::new(Members::Where(text(place))),
                },
            });
            spec.materials.push(material);
        }
    }
    let moves = ["0.02*sin(0.7*x)*cos(0.4*y)", "0.01*sin(0.5*x + 0.9*y)"];
    let along = |a: usize| (a < d).then(|| text(moves[a]));
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [along(0), along(1), None],
        velocity: [Some(text("0.03*sin(0.4*x)")), None, None],
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.1);
    spec.run.schedule.force_unstable = true;
    spec
}

/// One of these bodies alone.
fn alone(spec: &Spec, n: usize) -> Spec {
    let piece = &spec.body.pieces()[n];
    let mut own = spec.alone(piece);
    let inner = |s: &SetSpec| match &s.members {
        Members::Within { body, members } if *body == piece.name => Some(SetSpec {
            name: s.name.clone(),
            members: (**members).clone(),
        }),
        _ => None,
    };
    own.sets = spec.sets.iter().filter_map(inner).collect();
    let sets: Vec<String> = own.sets.iter().map(|s| s.name.clone()).collect();
    let has = |set: &str| set == "all" || sets.iter().any(|s| s == set);
    let (all, count) = (&spec.materials, spec.materials.len());
    let materials: Vec<usize> = (0..count).filter(|m| has(&all[*m].set)).collect();
    own.materials = materials.iter().map(|m| all[*m].clone()).collect();
    if !spec.interactions.pairs.is_empty() {
        let rows = materials.iter().map(|a| a * count);
        let pairs = rows.flat_map(|row| materials.iter().map(move |b| row + b));
        let pairs = pairs.map(|n| spec.interactions.pairs[n].clone());
        own.interactions.pairs = pairs.collect();
    }
    own.loading.conditions.retain(|c| has(&c.set));
    own.damage.toughness.retain(|t| has(&t.set));
    own
}

fn after(spec: &Spec, steps: u64) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    for _ in 0..steps {
        sim.step().unwrap();
    }
    sim
}

/// Every body is the one that it is alone; bonds that broke in each.
fn same_as_alone(spec: &Spec, steps: u64) -> Vec<u64> {
    let mut all = after(spec, steps);
    let (u, damage) = (all.displacements(), all.scalars("damage"));
    let mut first = 0;
    let pieces = 0..spec.body.pieces().len();
    let broken = pieces.map(|n| {
        let mut own = after(&alone(spec, n), steps);
        let moved = own.displacements();
        let last = first + moved.len();
        let still = moved.iter().flatten().all(|x| *x == 0.0);
        assert!(!still, "body {n} did not move");
        assert!(u[first..last] == moved, "displacements of body {n}");
        assert!(
            damage[first..last] == own.scalars("damage"),
            "damage of body {n}"
        );
        first = last;
        own.broken()
    });
    let broken: Vec<u64> = broken.collect();
    assert_eq!(first, u.len());
    assert_eq!(all.broken(), broken.iter().sum::<u64>());
    broken
}

/// Bodies with horizons of their own points, of every influence function, and one without.
fn graded() -> Spec {
    let own = |name: &str, x: f64, law: LawSpec, influence: Influence| {
        let mut part = part(name, block(&[12.0, 6.0], x), law);
        part.piece.horizon = Some(Horizon::Length(3.6));
        part.piece.family = Some(FamilyChoice::List);
        part.piece.influence = Some(influence);
        let grows = format!("2.05 + 1.5*clamp((x - {x} - 2)/6, 0, 1)");
        part.piece.variable_horizon = Some(text(&grows));
        part
    };
    let mut plain = part("plain", block(&[9.0, 5.0], 60.0), LPS);
    plain.piece.influence = Some(Influence::Inverse);
    together(
        2,
        vec![
            own("bonds", 0.0, PMB, Influence::Linear),
            own(
                "families",
                30.0,
                LPS,
                written("(1 + 0.3*xi_x/r)*exp(-r/delta)"),
            ),
            plain,
            own("last", 90.0, PMB, Influence::Constant),
        ],
    )
}

#[test]
fn bodies_of_graded_horizons_are_those_alone() {
    let mut spec = graded();
    same_as_alone(&spec, 12);
    // of one of them what bonds bear follows the horizon of each point, and one breaks by work
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Energy(2e-3)));
    spec.materials[1].fracture = Some(FractureSpec::new(Criterion::VonMises(0.05)));
    spec.materials[2].fracture = Some(FractureSpec::new(Criterion::BondEnergy(2e-3)));
    spec.loading.initial[0].velocity[0] = Some(text("0.5*sin(0.4*x)"));
    let broken = same_as_alone(&spec, 12);
    assert!(broken[..3].iter().all(|n| *n > 0), "{broken:?}");
}

/// Bodies whose points have contact of the stiffness of their own horizons fly into each other: momentum and energy stay.
#[test]
fn graded_bodies_collide() {
    let mut worst = vec![];
    for fraction in [0.2, 0.1] {
        let mut spec = graded();
        let BodySpec::Several(pieces) = &mut spec.body else {
            unreachable!()
        };
        pieces.truncate(3);
        spec.materials.truncate(3);
        spec.sets.truncate(3);
        // the first flies into the second, which stands a little beside it
        let BodySpec::Lattice { region, origin, .. } = &mut pieces[1].body else {
            unreachable!()
        };
        let low = [13.2, 0.3, 0.0];
        (*origin, *region) = (
            low,
            Region::Block {
                low,
                high: [24.2, 5.3, 0.0],
            },
        );
        pieces[1].variable_horizon = Some(text("2.05 + 0.1*(x - 13.2)"));
        spec.interactions.contact = Some(ContactSpec {
            bonded: 0.9,
            free: 1.35,
            stiffness: ContactStiffness::Laws,
            friction: None,
            cohesion: None,
            conductance: None,
        });
        spec.loading.initial = vec![InitialSpec {
            set: "bonds".into(),
            displacement: [None, None, None],
            velocity: [Some(text("0.2")), None, None],
        }];
        spec.run.schedule.time_step = TimeStep::Fraction(fraction);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let momentum = |sim: &mut dyn Simulation| {
            let v = sim.velocities();
            v.iter().fold([0.0; 2], |[x, y], v| [x + v[0], y + v[1]])
        };
        let before = momentum(sim.as_mut());
        let initial = sim.ledger().unwrap().initial;
        let (mut touched, mut most) = (0.0f64, 0.0f64);
        while sim.time() < 30.0 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            touched = touched.max(l.contact / initial);
            most = most.max(l.residual().abs() / initial);
        }
        let after = momentum(sim.as_mut());
        for a in 0..2 {
            assert!(
                (after[a] - before[a]).abs() < 1e-11 * before[0],
                "{before:?} {after:?}"
            );
        }
        assert!(touched > 1e-3, "they hardly touched: {touched:e}");
        worst.push(most);
    }
    // second order in the step, up to pairs that come and go
    assert!(worst[0] < 3e-2 && worst[1] < 0.6 * worst[0], "{worst:?}");
}

/// A body of two materials with constants of their own with each other, beside one of a third.
#[test]
fn bodies_of_pairs_are_those_alone() {
    let springs = |c: f64| LawSpec::Pmb(PmbStiffness::Micromodulus(c));
    let mut first = part("soft", block(&[10.0, 5.0], 0.0), springs(1.0));
    let hard = MaterialSpec {
        name: "hard".into(),
        set: "hard".into(),
        ..first.materials[0].0.clone()
    };
    first.materials[0].1 = "x < 4.5";
    first.materials.push((hard, "x > 4.5"));
    let second = part("other", block(&[8.0, 4.0], 40.0), springs(1.0));
    let mut spec = together(2, vec![first, second]);
    let stiffness = [[0.03, 0.02, 9.0], [0.02, 0.07, 9.0], [9.0, 9.0, 0.05]];
    let pairs = stiffness.as_flattened().iter().map(|c| PairSpec {
        horizon: 3.0,
        law: springs(*c),
        critical_stretch: 0.06,
        alpha: 0.25,
    });
    spec.interactions.pairs = pairs.collect();
    for influence in [Influence::Constant, Influence::Gaussian] {
        for piece in [0, 1] {
            if let BodySpec::Several(pieces) = &mut spec.body {
                pieces[piece].influence = Some(influence);
            }
        }
        same_as_alone(&spec, 10);
    }
}

/// A pair has the influence function of its own horizon: bonds of a pair of materials are those of a body of that horizon and stiffness.
#[test]
fn pairs_weigh_by_their_variable_horizons() {
    for influence in [
        Influence::Linear,
        Influence::Gaussian,
        Influence::CubicSpline,
        written("exp(-r/delta)*(1 - 0.5*r/delta)"),
    ] {
        let spec = |horizon: f64, pairs: Vec<PairSpec>| {
            let law = LawSpec::Pmb(PmbStiffness::Micromodulus(0.1));
            let mut spec = Spec::new(2, block(&[9.0, 7.0], 0.0), 1.0, law);
            spec.bonds.horizon = Horizon::Length(horizon);
            spec.bonds.family = FamilyChoice::List;
            spec.bonds.partial_volume_correction = true;
            spec.bonds.influence = influence;
            spec.interactions.pairs = pairs;
            build(&spec, Options::default()).unwrap()
        };
        let pair = PairSpec {
            horizon: 2.45,
            law: LawSpec::Pmb(PmbStiffness::Micromodulus(0.1)),
            critical_stretch: f64::INFINITY,
            alpha: 0.0,
        };
        let (mut one, mut of_pairs) = (spec(2.45, vec![]), spec(3.7, vec![pair]));
        let u: Vec<[f64; 3]> = (one.vectors("reference").iter())
            .map(|x| [0.02 * (x[0] - x[1]).sin(), 0.01 * x[0] * x[1], 0.0])
            .collect();
        let (f, g) = (one.forces_under(&u), of_pairs.forces_under(&u));
        let most = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        for (f, g) in f.iter().flatten().zip(g.iter().flatten()) {
            assert!((f - g).abs() < 1e-13 * most, "{influence:?}: {f:e} {g:e}");
        }
    }
}

/// Factors of a chain whose outer points hold half of their cells.
fn chain_ends(points: usize, factor: f64) -> SurfaceFactors {
    let of = |to: i32| {
        let factor = SurfaceFactor {
            pair: factor,
            ..SurfaceFactor::ONE
        };
        vec![([to, 0, 0], factor)]
    };
    let mut row = vec![0; points];
    (row[0], row[1], row[points - 2], row[points - 1]) = (1, 2, 3, 4);
    SurfaceFactors {
        method: SurfaceMethod::Exact,
        row,
        rows: vec![vec![], of(1), of(-1), of(1), of(-1)],
        part: vec![1.0, 0.5, 1.0, 1.0, 0.5],
        warning: None,
    }
}

#[test]
fn every_body_has_the_factors_of_its_own_surface() {
    let mut bars = vec![
        part("first", block(&[12.0], 0.0), PMB),
        part("second", block(&[9.0], 40.0), PMB),
        part("whole", block(&[7.0], 70.0), PMB),
    ];
    bars[0].piece.surface = Some(chain_ends(12, 1.5));
    bars[1].piece.surface = Some(chain_ends(9, 0.75));
    let mut spec = together(1, bars);
    same_as_alone(&spec, 20);
    let sim = build(&spec, Options::default()).unwrap();
    // two halves of a cell are missing in each
    assert_eq!(sim.info().volume, 11.0 + 8.0 + 7.0);
    // factors belong to the points of one body
    spec.bonds.surface = Some(chain_ends(12, 1.5));
    let error = build(&spec, Options::default()).err().unwrap();
    assert_eq!(error.path, "surface");
    assert!(error.message.contains("one lattice"), "{error}");
}

/// One body breaks by the work on its bonds, another by their stretch, a third never: factors are of what each bears.
#[test]
fn factors_of_toughness_are_of_what_each_body_bears() {
    let bar = |name: &str, x: f64, law: LawSpec, fracture: Option<Criterion>| {
        let mut part = part(name, block(&[16.0, 4.0], x), law);
        part.materials[0].0.fracture = fracture.map(FractureSpec::new);
        part
    };
    let mut spec = together(
        2,
        vec![
            bar("work", 0.0, LPS, Some(Criterion::BondEnergy(2e-3))),
            bar("stretch", 40.0, LPS, Some(Criterion::Stretch(0.02))),
            bar("tough", 80.0, PMB, None),
        ],
    );
    spec.loading.initial[0].velocity[0] = Some(text("0.5*sin(0.4*x)"));
    let without = same_as_alone(&spec, 12);
    for (set, energy) in [("work", "9"), ("stretch", "25 + 0.1*x")] {
        spec.damage.toughness.push(ToughnessSpec {
            set: set.into(),
            factor: ToughnessFactor::Energy(text(energy)),
        });
    }
    let with = same_as_alone(&spec, 12);
    for n in 0..2 {
        assert!(
            without[n] > 0 && with[n] < without[n],
            "{without:?} {with:?}"
        );
    }
    assert_eq!(with[2], 0);
}

/// Bars under uniform strains wear at `a r^m` a cycle: the first increment ends when the first bond of any of them is worn out, the second, of bars
/// that are as long, when the next one is.
#[test]
fn cycles_of_load_are_counted_once() {
    let (a, m, ratio) = (3e4, 2.5, 0.2);
    let fatigue = FatigueSpec {
        nucleation: Some([a, m]),
        limit: 0.0,
        growth: None,
        crack: 0.35,
    };
    let strains = [("slow", 0.0, 3e-3), ("fast", 50.0, 4e-3)];
    let bars = strains.map(|(name, x, _)| {
        let mut part = part(name, block(&[20.0], x), PMB);
        part.materials[0].0.fracture = Some(FractureSpec {
            fatigue: Some(fatigue),
            ..FractureSpec::new(Criterion::Stretch(1.0))
        });
        part
    });
    let mut spec = together(1, bars.into());
    spec.loading.initial.clear();
    for (name, x, strain) in strains {
        let ends = format!("{name} ends");
        spec.sets.push(SetSpec {
            name: ends.clone(),
            members: Members::Within {
                body: name.into(),
                members: Box::new(Members::Where(text(&format!("abs(x - {x} - 9.5) > 6.9")))),
            },
        });
        spec.loading.conditions.push(ConditionSpec {
            set: ends,
            kind: ConditionKind::Displacement([
                Some(text(&format!("{strain}*(x - {x})"))),
                None,
                None,
            ]),
        });
    }
    spec.run.schedule.steps = 3;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        cycles: Some(Cycles {
            load_ratio: ratio,
            bonds: 1,
            most: f64::INFINITY,
        }),
        ..Statics::default()
    });
    let life = |strain: f64| 1.0 / (a * ((1.0 - ratio) * strain).powf(m));
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    for strain in [4e-3, 3e-3] {
        sim.step().unwrap();
        let cycles = sim.cycles().unwrap();
        assert!((cycles / life(strain) - 1.0).abs() < 1e-8, "{cycles:e}");
        // all bonds of a bar bear the same
        let damage = sim.scalars("damage");
        let worn = [&damage[..20], &damage[20..]].map(|d| d.iter().all(|x| *x == 1.0));
        assert_eq!(worn, [strain < 3.5e-3, true]);
    }
    // those that touch do not answer in proportion
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    });
    let error = build(&spec, Options::default()).err().unwrap();
    assert!(
        error.message.contains("proportional to the load"),
        "{error}"
    );
}

/// A chain of the micromodulus `k` between nearest neighbours.
fn micromoduli(points: usize, x: f64, k: f64) -> LawSpec {
    let near = |i: usize| [i.checked_sub(1), (i + 1 < points).then_some(i + 1)];
    let all: Vec<usize> = (0..points).flat_map(near).flatten().collect();
    let count = |i: usize| near(i).into_iter().flatten().count();
    let mut start = vec![0];
    (0..points).for_each(|i| start.push(start[i] + count(i)));
    let body = LinearBody::<1> {
        position: (0..points).map(|i| [x + i as f64]).collect(),
        volume: vec![1.0; points],
        density: vec![1.0; points],
        period: [None],
        start,
        block: vec![[[k]]; all.len()],
        partner: all.into_iter().map(|j| j as u32).collect(),
        load_map: None,
        mass: None,
    };
    LawSpec::Micromoduli(std::sync::Arc::new(AnyLinearBody::new(body).unwrap()))
}

/// Springs and given micromoduli stand beside bodies that break.
#[test]
fn linear_bodies_stand_beside_others() {
    let cloud = BodySpec::Cloud(Cloud {
        position: (0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect(),
        volume: vec![1.0; 10],
        spacing: Some(1.0),
        ..Cloud::default()
    });
    let mut given = part("given", cloud, micromoduli(10, 0.0, 0.7));
    given.piece.horizon = Some(Horizon::Length(1.5));
    let springs = LawSpec::Springs(PmbStiffness::Young(1.0));
    let mut breaking = part("breaking", block(&[14.0], 60.0), PMB);
    breaking.materials[0].0.fracture = Some(FractureSpec::new(Criterion::Stretch(0.05)));
    let parts = vec![
        given,
        part("springs", block(&[11.0], 30.0), springs),
        breaking,
    ];
    let mut spec = together(1, parts);
    spec.loading.initial[0].velocity[0] = Some(text("0.5*sin(0.4*x)"));
    let broken = same_as_alone(&spec, 15);
    assert!(broken[2] > 0, "{broken:?}");
    // what is cut goes through all bodies
    spec.damage.precracks = vec![PrecrackSpec {
        shape: CrackShape::Point { x: 66.5 },
        kind: CrackKind::Broken,
    }];
    let error = build(&spec, Options::default()).err().unwrap();
    assert!(error.message.contains("no bonds that break"), "{error}");
}

/// Atoms beside a continuum would meet it by contact or an interface, and no stiffness of either follows from a potential.
#[test]
fn atoms_beside_other_bodies_are_refused() {
    let potential = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    let atoms = LawSpec::Atoms(PotentialSpec::of(potential).ended(2.5, End::Shifted));
    let parts = vec![
        part("atoms", block(&[6.0, 6.0], 0.0), atoms),
        part("solid", block(&[6.0, 6.0], 30.0), PMB),
    ];
    let spec = together(2, parts);
    let error = build(&spec, Options::default()).err().unwrap();
    assert_eq!(error.path, "materials[0].law");
    assert!(error.message.contains("meet by these alone"), "{error}");
}
