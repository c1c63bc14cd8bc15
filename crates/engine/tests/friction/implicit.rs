//! Friction, cohesion and rigid bodies with mass in implicit steps: Coulomb's law, momentum and energy, and the way that explicit steps go.

use super::rigid::{
    HALF, layer, made, mass_and_momentum, of_both, on_an_incline, resting, rests, run, seen,
    tumbling,
};
use super::{glancing, mean_velocity, sliding, text};
use peridyne::run::Simulation;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::*;

/// The same by Newmark's method, in steps of so many of those of `spec`.
fn newmark(spec: &Spec, times: f64) -> Spec {
    let mut explicit = made(spec);
    run(explicit.as_mut(), 1);
    let mut spec = spec.clone();
    spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    spec.run.schedule.time_step = TimeStep::Fixed(times * explicit.time());
    spec
}

#[test]
fn a_block_slides_down_an_incline_by_coulombs_law_in_long_steps() {
    let (mu, tangent) = (0.3, 0.8);
    for times in [1.0, 8.0] {
        let spec = newmark(&on_an_incline(FrictionSpec::constant(mu), tangent), times);
        let mut sim = made(&spec);
        let velocity = vec![[0.5, 0.0, 0.0]; sim.velocities().len()];
        sim.set_velocities(&velocity);
        sim.start(true);
        let (mass, before) = mass_and_momentum(sim.as_mut());
        run(sim.as_mut(), (2000.0 / times) as usize);
        let (_, after) = mass_and_momentum(sim.as_mut());
        let weight = mass * 0.01;
        let rubbed = before[0] + tangent * weight * sim.time() - after[0];
        let pressed = after[1] - before[1] + weight * sim.time();
        let off = (rubbed / (mu * pressed) - 1.0).abs();
        let l = sim.ledger().unwrap();
        let dissipated = seen(sim.as_mut(), "energy")[1];
        println!("{times}: friction over μ N − 1: {off:.1e}, dissipated {dissipated}, {l:?}");
        assert!(off < 1e-3, "{off}");
        assert!(l.residual().abs() < 1e-3 * dissipated, "{l:?}");
    }
}

/// The trapezoidal rule keeps what contact sets vibrating in long steps, and points slip by it: by the method of Hilber, Hughes and Taylor.
#[test]
fn what_sticks_stays_in_long_steps() {
    let mut spec = newmark(&resting(), 8.0);
    spec.run.schedule.stepper = Stepper::Newmark(Newmark::hht(-0.2));
    rests(&spec);
}

/// A block on a plate of points, pressed by its weight.
#[test]
fn a_block_of_points_slides_by_coulombs_law_in_long_steps() {
    let mu = 0.3;
    let mut sim = made(&newmark(&sliding(FrictionSpec::constant(mu)), 4.0));
    while sim.time() < 60.0 {
        run(sim.as_mut(), 1);
    }
    let [vx, vy] = mean_velocity(sim.as_mut());
    let rubbed = (1.0 - vx) / (0.02 * sim.time() + vy);
    let l = sim.ledger().unwrap();
    println!("slowed by {rubbed} of the pressure, {l:?}");
    assert!((rubbed / mu - 1.0).abs() < 0.02, "{rubbed}");
    assert!(l.residual().abs() < 5e-3 * l.initial, "{l:?}");
}

/// Two free blocks that meet at an angle: momentum to the tolerance of the equations, and what explicit steps rub off.
#[test]
fn blocks_that_glance_keep_their_momentum() {
    let end = |spec: &Spec| {
        let mut sim = made(spec);
        let (_, before) = mass_and_momentum(sim.as_mut());
        while sim.time() < 8.0 {
            run(sim.as_mut(), 1);
        }
        let (_, after) = mass_and_momentum(sim.as_mut());
        let l = sim.ledger().unwrap();
        let size = before[0].abs() + before[1].abs();
        let drift = (0..2).map(|a| (after[a] - before[a]).abs() / size);
        (l, drift.fold(0.0, f64::max), mean_velocity(sim.as_mut()))
    };
    let (explicit, _, way) = end(&glancing());
    let (implicit, drift, gone) = end(&newmark(&glancing(), 2.0));
    println!("{explicit:?} {implicit:?} {drift:e} {way:?} {gone:?}");
    assert!(drift < 1e-9, "{drift:e}");
    assert!((implicit.dissipated / explicit.dissipated - 1.0).abs() < 0.05);
    assert!(implicit.residual().abs() < 5e-3 * implicit.initial);
    for a in 0..2 {
        assert!((way[a] - gone[a]).abs() < 0.02, "{way:?} {gone:?}");
    }
}

/// A box and a ball with mass are thrown at a cube of points: momentum of both to the tolerance of the equations, and the places and turns of
/// explicit steps, to which implicit ones come at second order, with friction at first.
#[test]
fn bodies_with_mass_go_the_way_of_explicit_steps() {
    for friction in [None, Some(FrictionSpec::constant(0.4))] {
        let place = |sim: &mut dyn Simulation| {
            ["center", "rotation", "velocity", "angular_velocity"]
                .map(|q| seen(sim, q))
                .concat()
        };
        let thrown = |dt: f64| {
            let mut spec = tumbling(RigidShape::Sphere { radius: 2.0 }, friction.clone(), dt);
            let RigidBodyMotion::Free(free) = &mut spec.loading.rigid_bodies[0].motion else {
                panic!()
            };
            (free.center, free.velocity) = ([2.2, 2.6, 4.6], [0.15, 0.1, -0.3]);
            free.spin = [0.03, -0.4, 0.1];
            spec
        };
        let mut explicit = made(&thrown(0.005));
        run(explicit.as_mut(), 4000);
        let exact = place(explicit.as_mut());
        let off = |dt: f64, steps: usize| {
            let mut spec = thrown(dt);
            spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
            let mut sim = made(&spec);
            let (_, before) = mass_and_momentum(sim.as_mut());
            let start = seen(sim.as_mut(), "velocity");
            run(sim.as_mut(), steps);
            assert_eq!(seen(sim.as_mut(), "force"), [0.0; 3], "it has left");
            let (_, after) = mass_and_momentum(sim.as_mut());
            let end = seen(sim.as_mut(), "velocity");
            for a in 0..3 {
                let drift = after[a] - before[a] + 30.0 * (end[a] - start[a]);
                assert!(drift.abs() < 1e-8, "{a}: {drift:e}");
            }
            let all = place(sim.as_mut()).into_iter().zip(&exact);
            all.map(|(x, y)| (x - y).abs()).fold(0.0f64, f64::max)
        };
        let (coarse, fine) = (off(0.16, 125), off(0.08, 250));
        println!(
            "friction {}: off {coarse:.1e}, {fine:.1e}",
            friction.is_some()
        );
        // what begins and ceases to slip does so at one step or the next; bounds with friction after the fact
        let order = if friction.is_some() { 1.5 } else { 3.5 };
        assert!(fine < 0.01 && coarse / fine > order, "{coarse} {fine}");
    }
}

/// A box tumbles over the cube in steps of four explicit ones: momentum as above, angular momentum and energy to the error of the step.
#[test]
fn a_box_tumbles_in_long_steps() {
    let [direct, iterative] = [Solver::Direct, Solver::ConjugateGradients].map(tumbled);
    for (x, y) in direct.iter().zip(&iterative) {
        assert!((x - y).abs() < 1e-6, "{direct:?} {iterative:?}");
    }
}

fn tumbled(solver: Solver) -> Vec<f64> {
    let friction = Some(FrictionSpec::constant(0.4));
    let mut spec = tumbling(RigidShape::Box { half: HALF }, friction, 0.08);
    spec.run.schedule.stepper = Stepper::Newmark(Newmark {
        solver,
        ..Newmark::default()
    });
    let mut sim = made(&spec);
    let (before, _) = of_both(sim.as_mut());
    let energy = |sim: &mut dyn Simulation| {
        let l = sim.ledger().unwrap();
        let rigid = seen(sim, "energy");
        l.kinetic + l.strain + rigid[0] + rigid[1]
    };
    let start = energy(sim.as_mut());
    run(sim.as_mut(), 250);
    let (after, size) = of_both(sim.as_mut());
    let end = energy(sim.as_mut());
    let worst = |k: std::ops::Range<usize>| {
        k.map(|k| (after[k] - before[k]).abs() / size)
            .fold(0.0f64, f64::max)
    };
    let (straight, turned) = (worst(0..3), worst(3..6));
    println!(
        "momentum {straight:.1e}, angular {turned:.1e}, energy {:.1e}",
        end / start - 1.0
    );
    assert!(straight < 1e-9 && turned < 1e-3, "{straight} {turned}");
    assert!((end / start - 1.0).abs() < 0.02, "{start} {end}");
    ["center", "rotation", "velocity", "angular_velocity"]
        .map(|q| seen(sim.as_mut(), q))
        .concat()
}

/// A ball bounces off points that are held, beside some that are free and never move: it comes back as fast as it came, by both kinds of solver.
#[test]
fn a_ball_bounces_off_held_points() {
    for solver in [Solver::Direct, Solver::ConjugateGradients] {
        let mut spec = tumbling(RigidShape::Sphere { radius: 2.0 }, None, 0.04);
        let RigidBodyMotion::Free(free) = &mut spec.loading.rigid_bodies[0].motion else {
            panic!()
        };
        (free.center, free.velocity) = ([2.5, 2.5, 4.6], [0.0, 0.0, -0.3]);
        free.spin = [0.0; 3];
        spec.sets = vec![SetSpec {
            name: "held".into(),
            members: Members::Where(text("x > 0.5 || z < 1.5").unwrap()),
        }];
        spec.loading.conditions = vec![ConditionSpec {
            set: "held".into(),
            kind: ConditionKind::Displacement([text("0"), text("0"), text("0")]),
        }];
        spec.run.schedule.stepper = Stepper::Newmark(Newmark {
            solver,
            ..Newmark::default()
        });
        let mut sim = made(&spec);
        run(sim.as_mut(), 500);
        assert_eq!(seen(sim.as_mut(), "force"), [0.0; 3], "it has left");
        let back = seen(sim.as_mut(), "velocity")[2];
        println!("{solver:?}: back at {back}");
        assert!((back / 0.3 - 1.0).abs() < 1e-3, "{back}");
        assert!(sim.displacements().iter().flatten().all(|u| *u == 0.0));
    }
}

/// A head that holds points by cohesion is drawn off, in implicit steps: they follow it as in explicit ones, and let go.
#[test]
fn a_head_with_cohesion_draws_points_along() {
    let rises = |z: &str| {
        RigidBodyMotion::Kinematic([text("0").unwrap(), text("0").unwrap(), text(z).unwrap()])
    };
    let drawn = |stepper: Stepper, dt: f64| {
        let normal = [0.0, 0.0, 1.0];
        let mut plane = RigidBodySpec::new(10.0, RigidShape::Plane { normal }, rises("0.05*t"));
        plane.turn = Some(TurnSpec {
            axis: [1.0, 0.0, 0.0],
            angle: text("pi").unwrap(),
        });
        plane.cohesion = Some(CohesionSpec {
            energy: 0.09,
            strength: 0.2,
        });
        let mut spec = layer(3.0, plane);
        // held by the rim alone
        spec.sets = vec![SetSpec {
            name: "rim".into(),
            members: Members::Where(text("max(abs(x), abs(y)) > 2.5").unwrap()),
        }];
        spec.loading.conditions[0].set = "rim".into();
        spec.materials[0].law = LawSpec::Pmb(PmbStiffness::Young(4.0));
        spec.run.schedule.stepper = stepper;
        spec.run.schedule.time_step = TimeStep::Fixed(dt);
        let mut sim = made(&spec);
        let mut most = 0.0f64;
        while sim.time() < 30.0 {
            run(sim.as_mut(), 1);
            let u = sim.displacements();
            most = u.iter().map(|u| u[2]).fold(most, f64::max);
        }
        assert_eq!(seen(sim.as_mut(), "force"), [0.0; 3], "it has let go");
        (most, sim.ledger().unwrap())
    };
    let (explicit, _) = drawn(Stepper::Verlet, 0.02);
    let (implicit, l) = drawn(Stepper::Newmark(Newmark::default()), 0.1);
    println!("drawn up by {explicit} and {implicit}, {l:?}");
    assert!(explicit > 0.05, "{explicit}");
    assert!(
        (implicit / explicit - 1.0).abs() < 0.02,
        "{implicit} {explicit}"
    );
    assert!(
        l.residual().abs() < 1e-2 * l.work_rigid_bodies.abs(),
        "{l:?}"
    );
}
