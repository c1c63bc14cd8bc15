//! Implicit steps with fracture, contact and rigid_bodies: as explicit ones do where both can, and with the ledger closed.

use super::*;

const CONTACT: ContactSpec = ContactSpec {
    bonded: 0.9,
    free: 1.35,
    stiffness: ContactStiffness::Laws,
    friction: None,
    cohesion: None,
    conductance: None,
};

/// A notched plate, pulled apart.
fn notched(law: LawSpec) -> Spec {
    let mut spec = block([24.0, 16.0, 0.0], 2, law, 2);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.02)));
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [12.5, -1.0, 0.0],
            to: [12.5, 5.5, 0.0],
        },
        kind: CrackKind::Broken,
    });
    for (set, way) in [("low", "-"), ("high", "")] {
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Velocity([text(&format!("{way}0.004")), None, None]),
        });
    }
    spec
}

#[test]
fn bonds_break_at_the_end_of_a_step_as_explicit_ones_do() {
    for law in [LawSpec::Pmb(PmbStiffness::Young(1.0)), LPS] {
        let run = |stepper: Stepper, fraction: f64, duration: f64| {
            let mut spec = notched(law.clone());
            spec.run.schedule.stepper = stepper;
            spec.run.schedule.time_step = TimeStep::Fraction(fraction);
            let mut sim = built(&spec);
            let mut first = None;
            while sim.time() < duration {
                sim.step().unwrap();
                if sim.broken() > 0 && first.is_none() {
                    first = Some(sim.time());
                }
            }
            let l = sim.ledger().unwrap();
            (sim.broken() as f64, first.unwrap(), l)
        };
        let (explicit, begins, _) = run(Stepper::Verlet, 0.5, 80.0);
        let (implicit, begun, l) = run(Stepper::Newmark(Newmark::hht(-0.05)), 0.5, 80.0);
        let worked = l.work_boundary_conditions.abs();
        println!("{law:?}: {explicit} and {implicit} broken, from {begins} and {begun} on; {l:?}");
        assert!(explicit > 20.0, "{law:?}: {explicit}");
        assert!(
            (implicit / explicit - 1.0).abs() < 0.1,
            "{law:?}: {implicit} {explicit}"
        );
        assert!(
            (begun / begins - 1.0).abs() < 0.05,
            "{law:?}: {begun} {begins}"
        );
        assert!(l.released > 0.0);
        assert!(l.residual().abs() < 1e-3 * worked, "{law:?}: {l:?}");
        // ten times as long: with the balance closed, until a torn piece of the other law turns over within a step, which is said
        if law == LawSpec::Pmb(PmbStiffness::Young(1.0)) {
            let (broken, _, l) = run(Stepper::Newmark(Newmark::hht(-0.05)), 5.0, 120.0);
            assert!(broken > 20.0);
            assert!(
                l.residual().abs() < 1e-2 * l.work_boundary_conditions.abs(),
                "{law:?}: {l:?}"
            );
        }
    }
}

/// What bonds remember of the steps before counts at the ends of implicit steps as it does in explicit ones.
#[test]
fn bonds_that_remember_break_at_the_end_of_a_step_as_explicit_ones_do() {
    let rate = RateSpec {
        coefficient: 0.2,
        reference: 1e-4,
    };
    let of = |criterion: Criterion| FractureSpec::new(criterion);
    let faster = FractureSpec {
        rate: Some(rate),
        ..of(Criterion::Stretch(0.02))
    };
    let young = LawSpec::Pmb(PmbStiffness::Young(1.0));
    for (law, fracture) in [
        (young.clone(), of(Criterion::BondEnergy(5e-4))),
        (LPS, of(Criterion::VonMises(0.02))),
        (young.clone(), faster),
    ] {
        let run = |stepper: Stepper| {
            let mut spec = notched(law.clone());
            spec.materials[0].fracture = Some(fracture);
            spec.run.schedule.stepper = stepper;
            spec.run.schedule.time_step = TimeStep::Fraction(0.1);
            let mut sim = built(&spec);
            let mut first = None;
            while sim.time() < 80.0 {
                sim.step().unwrap();
                if sim.broken() > 0 && first.is_none() {
                    first = Some(sim.time());
                }
            }
            let l = sim.ledger().unwrap();
            (sim.broken() as f64, first.unwrap(), l)
        };
        let (explicit, begins, _) = run(Stepper::Verlet);
        let (implicit, begun, l) = run(Stepper::Newmark(Newmark::hht(-0.05)));
        println!(
            "{fracture:?}: {explicit} and {implicit} broken, from {begins} and {begun} on; {l:?}"
        );
        assert!(explicit > 20.0, "{fracture:?}: {explicit}");
        assert!((implicit / explicit - 1.0).abs() < 0.1, "{fracture:?}");
        assert!((begun / begins - 1.0).abs() < 0.02, "{fracture:?}");
        assert!(
            l.residual().abs() < 1e-3 * l.work_boundary_conditions.abs(),
            "{l:?}"
        );
    }
}

/// Two bars of several points that meet: momentum to round-off, energy to the error of the step, and velocities as explicit steps
/// have them.
#[test]
fn bodies_that_collide_keep_momentum_and_energy() {
    let square = |low: [f64; 3], high: [f64; 3]| BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: low,
        region: Region::Block { low, high },
        perturb: None,
    };
    let run = |stepper: Stepper, fraction: f64| {
        let ball = square([2.3, 5.2, 0.0], [4.3, 7.2, 0.0]);
        let plate = square([0.0; 3], [8.0, 4.0, 0.0]);
        let pieces = vec![PieceSpec::new("ball", ball), PieceSpec::new("plate", plate)];
        let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
        let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, law);
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.sets = vec![SetSpec {
            name: "ball".into(),
            members: Members::Within {
                body: "ball".into(),
                members: Box::new(Members::All),
            },
        }];
        spec.interactions.contact = Some(CONTACT);
        spec.loading.initial.push(InitialSpec {
            set: "ball".into(),
            displacement: [None, None, None],
            velocity: [None, text("-1"), None],
        });
        spec.run.schedule.stepper = stepper;
        spec.run.schedule.time_step = TimeStep::Fraction(fraction);
        let mut sim = built(&spec);
        let mut touched = 0.0f64;
        while sim.time() < 2.5 {
            sim.step().unwrap();
            touched = touched.max(sim.ledger().unwrap().contact);
        }
        let l = sim.ledger().unwrap();
        let members = sim.members("ball").unwrap();
        let ball: Vec<usize> = members.iter().map(|i| *i as usize).collect();
        let v = sim.velocities();
        let rebound = ball.iter().map(|i| v[*i][1]).sum::<f64>() / ball.len() as f64;
        let all: f64 = v.iter().map(|v| v[1]).sum();
        (
            rebound,
            all + ball.len() as f64,
            touched / l.initial,
            l.residual() / l.initial,
        )
    };
    let (explicit, ..) = run(Stepper::Verlet, 0.05);
    let (implicit, momentum, touched, off) = run(Stepper::Newmark(Newmark::default()), 0.1);
    println!(
        "{explicit} {implicit}, contact held {touched}, momentum {momentum:e}, energy {off:e}"
    );
    assert!(touched > 0.05, "{touched}");
    assert!(explicit > -0.5, "{explicit}");
    assert!((implicit - explicit).abs() < 0.02, "{implicit} {explicit}");
    assert!(momentum.abs() < 1e-9, "{momentum}");
    assert!(off.abs() < 2e-2, "{off}");
}

/// A ball pressed into a block slowly: implicit steps of many explicit ones go the way of statics.
#[test]
fn a_ball_that_is_pressed_in_does_the_work_that_the_block_holds() {
    let run = |stepper: Stepper, step: f64| {
        let mut spec = block([12.0, 6.0, 0.0], 2, LPS, 2);
        spec.sets.push(SetSpec {
            name: "bottom".into(),
            members: Members::Region(Region::HalfSpace {
                point: [0.0, 0.1, 0.0],
                normal: [0.0, 1.0, 0.0],
            }),
        });
        spec.loading.conditions.push(ConditionSpec {
            set: "bottom".into(),
            kind: ConditionKind::Displacement([text("0"), text("0"), None]),
        });
        let center = ["6", "10.5 - 0.005*t", "0"].map(|e| text(e).unwrap());
        let motion = RigidBodyMotion::Kinematic(center);
        spec.loading
            .rigid_bodies
            .push(RigidBodySpec::sphere(2.0, 4.0, motion));
        spec.run.schedule.stepper = stepper;
        spec.run.schedule.time_step = TimeStep::Fixed(step);
        let mut sim = built(&spec);
        while sim.time() < 200.0 - 1e-9 {
            sim.step().unwrap();
        }
        let u = sim.displacements();
        (u, sim.ledger().unwrap())
    };
    let (far, l) = run(Stepper::Newmark(Newmark::hht(-0.1)), 5.0);
    assert!(
        l.work_rigid_bodies > 0.0 && l.work_rigid_bodies > 0.9 * l.strain,
        "{l:?}"
    );
    assert!(l.residual().abs() < 0.02 * l.work_rigid_bodies, "{l:?}");
    let (near, _) = run(Stepper::Verlet, 0.25);
    let most = near.iter().map(|u| u[1].abs()).fold(0.0, f64::max);
    assert!(most > 0.1, "{most}");
    for (a, b) in far.iter().zip(&near) {
        assert!((a[1] - b[1]).abs() < 0.05 * most, "{a:?} {b:?}");
    }
}
