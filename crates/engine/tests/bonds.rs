//! Factors of bonds: heterogeneous bodies and weak planes against closed forms.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

const ONE: PmbStiffness = PmbStiffness::Micromodulus(1.0);

fn text(e: &str) -> Expression {
    Expression::parse(e, &[]).unwrap()
}

/// A block of `size` spacings of 1.
fn block(kind: LatticeKind, size: [f64; 3], law: LawSpec) -> Spec {
    let d = kind.dimension();
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
    Spec::new(d, body, 1.0, law)
}

/// A chain of 100 springs between the ends 0 and 0.5.
fn stretched(bonds: Vec<BondFactorSpec>, rule: BondMixing) -> Box<dyn Simulation> {
    let mut spec = block(LatticeKind::Chain, [100.0; 3], LawSpec::Springs(ONE));
    spec.bonds.factors = bonds;
    spec.interactions.interface = rule;
    for (set, place, u) in [("low", "x < 0.5", "0"), ("high", "x > 99.5", "0.5")] {
        spec.sets.push(SetSpec {
            name: set.into(),
            members: Members::Where(text(place)),
        });
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([Some(text(u)), None, None]),
        });
    }
    spec.run.schedule.steps = 1;
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec.run.schedule.stepper = Stepper::Statics(Statics::default());
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    sim
}

/// Springs in series share the force: each is longer by the inverse of its factor.
fn in_series(sim: &mut dyn Simulation, factor: impl Fn(usize) -> f64) {
    let whole: f64 = (0..100).map(|k| 1.0 / factor(k)).sum();
    let u = sim.displacements();
    let mut exact = 0.0;
    for (k, u) in u.iter().enumerate() {
        assert!((u[0] - exact).abs() < 1e-13, "{u:?} at {k}");
        if k < 100 {
            exact += 0.5 / (whole * factor(k));
        }
    }
}

#[test]
fn a_field_is_averaged_over_the_ends_of_a_bond() {
    let at = |k: usize| 1.0 + k as f64 / 25.0;
    let field = || vec![BondFactorSpec::Field(text("1 + x/25"))];
    in_series(&mut *stretched(field(), BondMixing::Arithmetic), |k| {
        0.5 * (at(k) + at(k + 1))
    });
    in_series(&mut *stretched(field(), BondMixing::Harmonic), |k| {
        2.0 / (1.0 / at(k) + 1.0 / at(k + 1))
    });
    in_series(&mut *stretched(field(), BondMixing::Minimum), at);
}

#[test]
fn factors_multiply_and_a_weak_plane_opens() {
    let bonds = vec![
        BondFactorSpec::Crossing {
            shape: CrackShape::Point { x: 50.5 },
            factor: 0.1,
        },
        BondFactorSpec::Field(text("x < 30 ? 2 : 1")),
        BondFactorSpec::Crossing {
            shape: CrackShape::Point { x: 20.25 },
            factor: 0.25,
        },
    ];
    let mut sim = stretched(bonds, BondMixing::Minimum);
    in_series(&mut *sim, |k| match k {
        20 => 0.5,
        50 => 0.1,
        k if k < 29 => 2.0,
        _ => 1.0,
    });
}

/// Displacements after some steps of a bump, and energies.
fn moved(spec: &Spec) -> (Vec<[f64; 3]>, f64, f64) {
    let mut spec = spec.clone();
    let bump = "0.01*exp(-((x-4)^2 + (y-4)^2 + (z-4)^2)/4)";
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: std::array::from_fn(|_| Some(text(bump))),
        velocity: [None, None, None],
    }];
    let unused = &mut spec.loading.initial[0].displacement[spec.space.dimension..];
    unused.iter_mut().for_each(|c| *c = None);
    spec.run.schedule.time_step = TimeStep::Fixed(0.05);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    for _ in 0..20 {
        sim.step().unwrap();
    }
    let energy = sim.ledger().unwrap();
    (sim.displacements(), energy.strain, energy.kinetic)
}

#[test]
fn a_factor_of_two_is_a_law_twice_as_stiff() {
    use LatticeKind::*;
    for kind in [Chain, Square, Triangular, Cubic, Bcc, Fcc, Diamond] {
        for law in [LawSpec::Pmb, LawSpec::Springs] {
            let mut stiff = block(kind, [9.0; 3], law(PmbStiffness::Micromodulus(2.0)));
            stiff.bonds.horizon = Horizon::Length(1.5);
            let mut scaled = stiff.clone();
            scaled.materials[0].law = law(ONE);
            scaled.bonds.factors = vec![BondFactorSpec::Field(text("2"))];
            assert_eq!(moved(&scaled), moved(&stiff), "{kind:?}");
        }
    }
}

/// Bonds of a list have the factors that they have in a stencil, through periodic faces, too; so have they where points have horizons of their own.
#[test]
fn a_list_scales_its_bonds_as_a_stencil_does() {
    let law = LawSpec::Pmb(PmbStiffness::Young(1.0));
    let mut spec = block(LatticeKind::Square, [9.0; 3], law);
    spec.bonds.horizon = Horizon::Length(2.3);
    spec.bonds.partial_volume_correction = true;
    spec.bonds.calibration = Calibration::Continuum;
    spec.space.periodic = [Some(10.0), None, None];
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.004)));
    let across = |x: f64| BondFactorSpec::Crossing {
        shape: CrackShape::Segment {
            from: [x, -1.03, 0.0],
            to: [x + 0.31, 12.0, 0.0],
        },
        factor: 0.4,
    };
    spec.bonds.factors = vec![
        BondFactorSpec::Field(text("1 + 0.5*sin(pi/5*x) + 0.1*y")),
        across(9.37),
        across(4.4),
    ];
    let mut list = spec.clone();
    list.bonds.family = FamilyChoice::List;
    let mut own = list.clone();
    own.bonds.variable_horizon = Some(text("2.3"));
    let (u, strain, kinetic) = moved(&spec);
    let largest = u.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    for spec in [list, own] {
        let (v, s, k) = moved(&spec);
        for (u, v) in u.iter().flatten().zip(v.iter().flatten()) {
            assert!((u - v).abs() < 1e-11 * largest, "{u:e} {v:e}");
        }
        assert!((s / strain - 1.0).abs() < 1e-10 && (k / kinetic - 1.0).abs() < 1e-10);
    }
}

#[test]
fn a_periodic_field_moves_with_the_body() {
    let shifted = |cells: i32| {
        let mut spec = block(LatticeKind::Square, [15.0, 7.0, 0.0], LawSpec::Springs(ONE));
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.space.periodic = [Some(16.0), None, None];
        let place = format!("(x - {cells} + 32)");
        // a random factor per point, by a whole number that the shift keeps
        let wrapped = format!("({place}) - 16*floor(({place})/16)");
        let field = format!("1 + random({wrapped} + 0.5, y + 0.5, 0)");
        spec.bonds.factors = vec![BondFactorSpec::Field(text(&field))];
        let u = format!("0.01*sin(pi/8*(x - {cells}) + y)");
        spec.loading.initial = vec![InitialSpec {
            set: "all".into(),
            displacement: [None, Some(text(&u)), None],
            velocity: [None, None, None],
        }];
        spec.run.schedule.time_step = TimeStep::Fixed(0.05);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        for _ in 0..50 {
            sim.step().unwrap();
        }
        let momentum: [f64; 2] =
            std::array::from_fn(|a| sim.velocities().iter().map(|v| v[a]).sum());
        assert!(momentum.iter().all(|p| p.abs() < 1e-15), "{momentum:?}");
        let at: Vec<([f64; 3], [f64; 3])> = sim
            .vectors("reference")
            .into_iter()
            .zip(sim.displacements())
            .collect();
        at
    };
    let (here, there) = (shifted(0), shifted(5));
    let mut largest = 0.0f64;
    for (x, u) in &here {
        let to = [(x[0] + 5.0) % 16.0, x[1], 0.0];
        let (_, moved) = there.iter().find(|(y, _)| *y == to).unwrap();
        largest = largest.max(u[1].abs());
        assert!((0..2).all(|a| (u[a] - moved[a]).abs() < 1e-15));
    }
    assert!(largest > 1e-3);
}

#[test]
fn wrong_factors_are_refused() {
    let refused = |law: LawSpec, factor: BondFactorSpec| {
        let mut spec = block(LatticeKind::Square, [9.0; 3], law);
        spec.bonds.factors = vec![factor];
        build(&spec, Options::default()).err().unwrap()
    };
    let negative = refused(
        LawSpec::Springs(ONE),
        BondFactorSpec::Field(text("1 - x/4")),
    );
    assert_eq!(negative.path, "bonds[0]");
    assert!(
        negative.message.contains("is -0.25 at [5.0, 0.0]"),
        "{negative:?}"
    );
    let lps = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.2,
    });
    assert!(
        refused(lps, BondFactorSpec::Field(text("2")))
            .message
            .contains("bond-based")
    );
    let mut spec = block(LatticeKind::Square, [9.0; 3], LawSpec::Springs(ONE));
    spec.bonds.factors = vec![BondFactorSpec::Crossing {
        shape: CrackShape::Segment {
            from: [20.0, 0.0, 0.0],
            to: [20.0, 9.0, 0.0],
        },
        factor: 0.5,
    }];
    let sim = build(&spec, Options::default()).unwrap();
    assert!(
        sim.info()
            .warnings
            .iter()
            .any(|w| w.contains("no bond crosses"))
    );
}
