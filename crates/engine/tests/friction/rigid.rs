//! Rigid bodies: sliding by Coulomb's law, momentum and energy of what bounces and tumbles, pulling off.

use super::{square, text};
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::space::rigid::RigidShape;
use peridyne::space::triangles::{Solid, Triangles};
use peridyne::spec::*;
use std::f64::consts::PI;
use std::sync::Arc;

pub(super) fn made(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

pub(super) fn run(sim: &mut dyn Simulation, steps: usize) {
    (0..steps).for_each(|_| sim.step().unwrap());
}

fn probe(spec: &mut Spec, rigid_body: &str) {
    spec.run.probes.push(ProbeSpec {
        name: "p".into(),
        set: "all".into(),
        measure: Measure::RigidBody {
            rigid_body: rigid_body.into(),
            of: None,
        },
    });
}

/// Numbers of the probe by the name of their column.
pub(super) fn seen(sim: &mut dyn Simulation, what: &str) -> Vec<f64> {
    let columns = sim.probe_columns();
    let values = sim.measure();
    let of = columns.iter().zip(values);
    let found = of.filter(|(c, _)| c.name.starts_with(&format!("p_{what}_")));
    let found: Vec<f64> = found.map(|(_, v)| v).collect();
    assert!(!found.is_empty(), "{what}");
    found
}

fn constants(x: [f64; 3]) -> [peridyne::expression::Expression; 3] {
    x.map(peridyne::expression::Expression::constant)
}

pub(super) fn mass_and_momentum(sim: &mut dyn Simulation) -> (f64, Point) {
    let (volume, density) = (sim.scalars("volume"), sim.scalars("density"));
    let (mut mass, mut sum) = (0.0, [0.0; 3]);
    for (i, v) in sim.velocities().iter().enumerate() {
        let m = volume[i] * density[i];
        mass += m;
        for a in 0..3 {
            sum[a] += m * v[a];
        }
    }
    (mass, sum)
}

/// A block of points on a rigid incline: seen along it, gravity is (g sin α, −g cos α).
pub(super) fn on_an_incline(friction: FrictionSpec, tangent: f64) -> Spec {
    let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
    let mut spec = Spec::new(2, square(1.0, [0.0; 3], [5.0, 2.0, 0.0]), 1.0, law);
    spec.bonds.horizon = Horizon::Length(2.5);
    let pull = |g: f64| text(&format!("{g}"));
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::BodyForce([pull(0.01 * tangent), pull(-0.01), None]),
    }];
    // the lowest points are as deep as their columns press them: K g² = 3 · 0.01
    let shape = RigidShape::Box {
        half: [3.0, 400.0, 1.0],
    };
    let depth = (0.03f64 / 20.0).sqrt();
    let center = [0.0, depth - 3.0, 0.0];
    let mut plane = RigidBodySpec::new(20.0, shape, RigidBodyMotion::Kinematic(constants(center)));
    // an edge of 800 lies along x
    plane.turn = Some(TurnSpec {
        axis: [0.0, 0.0, 1.0],
        angle: text("pi/2").unwrap(),
    });
    plane.name = "plane".into();
    plane.friction = Some(friction);
    spec.loading.rigid_bodies = vec![plane];
    probe(&mut spec, "plane");
    spec
}

#[test]
fn a_block_slides_down_an_incline_by_coulombs_law() {
    let (mu, tangent) = (0.3, 0.8);
    let mut sim = made(&on_an_incline(FrictionSpec::constant(mu), tangent));
    // friction has its size from the first step on where sliding is faster than what it stops in one
    let velocity = vec![[0.5, 0.0, 0.0]; sim.velocities().len()];
    sim.set_velocities(&velocity);
    sim.start(true);
    let (mass, before) = mass_and_momentum(sim.as_mut());
    run(sim.as_mut(), 2000);
    let (_, after) = mass_and_momentum(sim.as_mut());
    let time = sim.time();
    let weight = mass * 0.01;
    // what friction took in all, and what pressed in all
    let rubbed = before[0] + tangent * weight * time - after[0];
    let pressed = after[1] - before[1] + weight * time;
    assert!(
        pressed > 0.9 * weight * time && time > 50.0,
        "{pressed} {time}"
    );
    let off = (rubbed / (mu * pressed) - 1.0).abs();
    // and so a = g (sin α − μ cos α), but for how fast the block still bounces
    let speed = (after[0] - before[0]) / mass;
    let exact = 0.01 * (tangent - mu) * time;
    println!(
        "friction over μ N − 1: {off:.1e}; speed over the closed form − 1: {:.1e}",
        speed / exact - 1.0
    );
    // where a point comes out of the plane and goes in again its spring grows with the path; a bound set after the fact
    assert!(off < 1e-3, "{off}");
    assert!((speed / exact - 1.0).abs() < 5e-3, "{speed} {exact}");
    // what friction took is the work of the plane on the block but for the push along the normal, which comes back
    let [_, dissipated] = seen(sim.as_mut(), "energy")[..] else {
        panic!()
    };
    let l = sim.ledger().unwrap();
    assert!(l.residual().abs() < 1e-6 * dissipated, "{l:?}");
    assert!(
        (l.work_rigid_bodies + dissipated).abs() < 1e-2 * dissipated,
        "{l:?} {dissipated}"
    );
}

/// A block below the angle of friction, which is damped until it rests at 100.
pub(super) fn resting() -> Spec {
    let mut spec = on_an_incline(FrictionSpec::constant(0.9), 0.3);
    // what bounces would slip a little at every bounce
    spec.loading.conditions.push(ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Damping(text("t < 100 ? 0.2 : 0").unwrap()),
    });
    spec
}

/// It goes as far as its springs give way, and creeps by less than a hundredth of that in 200.
pub(super) fn rests(spec: &Spec) {
    let mut sim = made(spec);
    let mean = |sim: &mut dyn Simulation| {
        let u = sim.displacements();
        u.iter().map(|u| u[0]).sum::<f64>() / u.len() as f64
    };
    while sim.time() < 100.0 {
        run(sim.as_mut(), 1);
    }
    let settled = mean(sim.as_mut());
    while sim.time() < 300.0 {
        run(sim.as_mut(), 1);
    }
    let crept = mean(sim.as_mut()) - settled;
    // the spring along the plane holds 0.3 of what presses: ξ = 0.3 g/(2 κ/K); the block leans besides
    let depth = (0.03f64 / 20.0).sqrt();
    let held = 0.3 * depth / (2.0 * 2.0 / 7.0);
    println!("spring {held:.3e}, went {settled:.3e}, crept {crept:.1e}");
    assert!(settled > held && settled < 4.0 * held);
    // without friction it would have 0.5 · 0.3 g t² = 60
    assert!(crept.abs() < 1e-2 * held, "{crept}");
}

#[test]
fn a_block_below_the_angle_of_friction_stays() {
    rests(&resting());
}

/// A block whose upper row is pressed down and dragged to and fro on a rigid plane, in equilibrium at every increment.
#[test]
fn dragging_to_and_fro_takes_the_area_of_the_loop() {
    let mu = 0.3;
    let mut spec = on_an_incline(FrictionSpec::constant(mu), 0.0);
    let (press, far) = (10.0, 20.0);
    let count = press + 5.0 * far;
    spec.sets.push(SetSpec {
        name: "top".into(),
        members: Members::Region(Region::HalfSpace {
            point: [0.0, 1.9, 0.0],
            normal: [0.0, -1.0, 0.0],
        }),
    });
    let way = format!(
        "0.1*({count}*t < {press} ? 0 : {count}*t < {up} ? ({count}*t - {press})/{far} : {count}*t < {down} ? 1 - ({count}*t - {up})/{far} : ({count}*t - {down})/{far} - 1)",
        up = press + far,
        down = press + 3.0 * far
    );
    let down = format!("-0.05*min({count}*t/{press}, 1)");
    spec.loading.conditions = vec![ConditionSpec {
        set: "top".into(),
        kind: ConditionKind::Displacement([text(&way), text(&down), None]),
    }];
    spec.loading.rigid_bodies[0].stiffness = 2e4;
    spec.loading.rigid_bodies[0].motion = RigidBodyMotion::Kinematic(constants([0.0, -3.0, 0.0]));
    spec.run.schedule = Schedule {
        steps: count as u64,
        time_step: TimeStep::Fixed(1.0 / count),
        force_unstable: false,
        stepper: Stepper::Statics(Statics {
            method: Method::Relaxation,
            tolerance: 1e-8,
            ..Statics::default()
        }),
    };
    let mut sim = made(&spec);
    let mut rows = vec![];
    for _ in 0..count as usize {
        run(sim.as_mut(), 1);
        let force = seen(sim.as_mut(), "force");
        let taken = seen(sim.as_mut(), "energy")[1];
        let top = sim.members("top").unwrap()[0] as usize;
        rows.push([sim.displacements()[top][0], force[0], force[1], taken]);
    }
    let [first, back, last] = [press + far, press + 3.0 * far, count].map(|n| n as usize - 1);
    // the whole block slides: Coulomb's law, one way and the other
    for (row, way) in [(first, 1.0), (back, -1.0), (last, 1.0)] {
        let [_, along, across, _] = rows[row];
        let off = (along / across).abs() / mu - 1.0;
        assert!(
            along * way > 0.0 && off.abs() < 1e-6,
            "{:?} {off}",
            rows[row]
        );
    }
    // in between it sticks, and turns round at no force
    let least = rows[first..back].iter().map(|r| (r[1] / r[2]).abs());
    assert!(least.fold(f64::INFINITY, f64::min) < 0.1 * mu);
    let area: f64 = rows[first..=last]
        .windows(2)
        .map(|w| 0.5 * (w[0][1] + w[1][1]) * (w[1][0] - w[0][0]))
        .sum();
    let taken = rows[last][3] - rows[first][3];
    println!("area of the loop {area:.4e}, taken {taken:.4e}");
    assert!(
        taken > 0.0 && (area / taken - 1.0).abs() < 1e-2,
        "{area} {taken}"
    );
    let l = sim.ledger().unwrap();
    assert!(l.residual().abs() < 1e-2 * taken, "{l:?}");
}

/// A cube of springs, and a rigid body thrown at one of its corners.
pub(super) fn tumbling(shape: RigidShape, friction: Option<FrictionSpec>, dt: f64) -> Spec {
    let cube = BodySpec::Lattice {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: [5.0, 5.0, 2.0],
        },
        perturb: None,
    };
    let law = LawSpec::Pmb(PmbStiffness::Young(20.0));
    let mut spec = Spec::new(3, cube, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    let mut free = FreeSpec::new(30.0, [2.2, 2.6, 5.1], [0.05, 0.1, -0.3]);
    free.spin = [0.03, -0.04, 0.1];
    let mut body = RigidBodySpec::new(8.0, shape, RigidBodyMotion::Free(free));
    body.turn = Some(TurnSpec {
        axis: [0.6, 0.0, 0.8],
        angle: text("0.7").unwrap(),
    });
    body.name = "box".into();
    body.friction = friction;
    spec.loading.rigid_bodies = vec![body];
    spec.run.schedule.time_step = TimeStep::Fixed(dt);
    probe(&mut spec, "box");
    spec
}

pub(super) const HALF: Point = [1.0, 1.5, 2.0];

/// Of points and the rigid box together: momentum, angular momentum about the origin.
pub(super) fn of_both(sim: &mut dyn Simulation) -> ([f64; 6], f64) {
    let cross = |a: &[f64], b: &[f64]| -> Point {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let (volume, density) = (sim.scalars("volume"), sim.scalars("density"));
    let (x, v) = (sim.vectors("position"), sim.velocities());
    let [c, w, turn, spin] =
        ["center", "velocity", "rotation", "angular_velocity"].map(|q| seen(sim, q));
    let mass = 30.0;
    let mut sum = [0.0; 6];
    let mut size = 0.0;
    let mut add = |m: f64, x: &[f64], v: &[f64]| {
        let l = cross(x, v);
        for a in 0..3 {
            sum[a] += m * v[a];
            sum[3 + a] += m * l[a];
            size += (m * l[a]).abs();
        }
    };
    for i in 0..x.len() {
        add(volume[i] * density[i], &x[i], &v[i]);
    }
    add(mass, &c, &w);
    // L = R I Rᵀ ω, R by Rodrigues' formula
    let angle = turn.iter().map(|c| c * c).sum::<f64>().sqrt();
    let n: Vec<f64> = turn.iter().map(|c| c / angle).collect();
    let rotated = |x: &[f64], angle: f64| -> Point {
        let (s, c) = angle.sin_cos();
        let (around, along) = (cross(&n, x), (0..3).map(|a| n[a] * x[a]).sum::<f64>());
        std::array::from_fn(|a| c * x[a] + s * around[a] + (1.0 - c) * along * n[a])
    };
    let mut about = rotated(&spin, -angle);
    for (a, l) in about.iter_mut().enumerate() {
        let (p, q) = (HALF[(a + 1) % 3], HALF[(a + 2) % 3]);
        *l *= mass * (p * p + q * q) / 3.0;
    }
    let about = rotated(&about, angle);
    for a in 0..3 {
        sum[3 + a] += about[a];
    }
    (sum, size)
}

fn box_of_triangles() -> RigidShape {
    let at = |n: usize| -> Point {
        std::array::from_fn(|a| if n >> a & 1 == 1 { HALF[a] } else { -HALF[a] })
    };
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |f: &[usize; 4]| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]];
    let all: Vec<[Point; 3]> = faces.iter().flat_map(halves).map(|t| t.map(at)).collect();
    let solid = Solid::new(Triangles::new(&all).unwrap()).unwrap();
    RigidShape::Solid(Arc::new(solid))
}

#[test]
fn a_tumbling_box_keeps_what_both_have_and_loses_what_friction_takes() {
    for friction in [None, Some(FrictionSpec::constant(0.4))] {
        for (dt, steps) in [(0.02, 1000), (0.01, 2000)] {
            let spec = tumbling(RigidShape::Box { half: HALF }, friction.clone(), dt);
            let mut sim = made(&spec);
            let (before, _) = of_both(sim.as_mut());
            let energy = |sim: &mut dyn Simulation| {
                let l = sim.ledger().unwrap();
                let rigid = seen(sim, "energy");
                l.kinetic + l.strain + rigid[0] + rigid[1]
            };
            let start = energy(sim.as_mut());
            run(sim.as_mut(), steps);
            let (after, size) = of_both(sim.as_mut());
            assert_eq!(seen(sim.as_mut(), "force"), [0.0; 3], "it has left");
            let moved = seen(sim.as_mut(), "velocity")[2];
            assert!(moved > -0.2, "it was turned back: {moved}");
            for (a, b) in before.iter().zip(after) {
                assert!((a - b).abs() < 1e-12 * size, "{before:?} {after:?}");
            }
            let (lost, end) = (seen(sim.as_mut(), "energy")[1], energy(sim.as_mut()));
            assert_eq!(lost > 1e-3 * start, friction.is_some(), "{lost}");
            // the nearest face of a box changes from place to place, and forces turn there: no order, and a bound set after the fact
            assert!((end / start - 1.0).abs() < 5e-3, "{start} {end}");
            let l = sim.ledger().unwrap();
            assert!(
                l.residual().abs() < 1e-3 * l.work_rigid_bodies.abs(),
                "{l:?}"
            );
        }
    }
}

#[test]
fn a_rubbing_ball_keeps_energy_at_second_order() {
    for friction in [None, Some(FrictionSpec::constant(0.4))] {
        let off = |dt: f64, steps: usize| {
            let mut spec = tumbling(RigidShape::Sphere { radius: 2.0 }, friction.clone(), dt);
            let RigidBodyMotion::Free(free) = &mut spec.loading.rigid_bodies[0].motion else {
                panic!()
            };
            (free.center, free.velocity) = ([2.2, 2.6, 4.6], [0.15, 0.1, -0.3]);
            free.spin = [0.03, -0.4, 0.1];
            let mut sim = made(&spec);
            let energy = |sim: &mut dyn Simulation| {
                let l = sim.ledger().unwrap();
                let rigid = seen(sim, "energy");
                l.kinetic + l.strain + rigid[0] + rigid[1]
            };
            let start = energy(sim.as_mut());
            run(sim.as_mut(), steps);
            assert_eq!(seen(sim.as_mut(), "force"), [0.0; 3], "it has left");
            assert_eq!(
                seen(sim.as_mut(), "energy")[1] > 0.1 * start,
                friction.is_some()
            );
            (energy(sim.as_mut()) / start - 1.0).abs()
        };
        let (coarse, fine) = (off(0.04, 500), off(0.02, 1000));
        println!(
            "friction {}: energy of all {coarse:.1e} {fine:.1e}",
            friction.is_some()
        );
        assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }
}

#[test]
fn a_box_of_triangles_tumbles_as_the_box() {
    let end = |shape: RigidShape| {
        let mut sim = made(&tumbling(shape, Some(FrictionSpec::constant(0.4)), 0.02));
        run(sim.as_mut(), 500);
        ["center", "rotation", "angular_velocity"]
            .map(|q| seen(sim.as_mut(), q))
            .concat()
    };
    let (exact, made) = (end(RigidShape::Box { half: HALF }), end(box_of_triangles()));
    for (a, b) in exact.iter().zip(&made) {
        assert!((a - b).abs() < 1e-9, "{exact:?} {made:?}");
    }
}

#[test]
fn what_touches_hard_is_stepped_in_parts() {
    let mut spec = tumbling(RigidShape::Box { half: HALF }, None, 0.02);
    spec.run.schedule.time_step = TimeStep::Auto;
    spec.loading.rigid_bodies[0].stiffness = 4000.0;
    let mut sim = made(&spec);
    while sim.time() < 20.0 {
        sim.step().unwrap();
    }
    let l = sim.ledger().unwrap();
    println!(
        "parts {}, residual over work {:.1e}",
        sim.info().parts,
        l.residual() / l.work_rigid_bodies
    );
    assert!(sim.info().parts > 1);
    // stable, not exact: a hard blow makes waves of which eight tenths of the stable step know little; a bound set after the fact
    assert!(
        l.residual().abs() < 0.2 * l.work_rigid_bodies.abs(),
        "{l:?}"
    );
}

/// A held layer of points of spacing 1 below z = 0.
pub(super) fn layer(edge: f64, body: RigidBodySpec) -> Spec {
    let plate = BodySpec::Lattice {
        kind: LatticeKind::Cubic,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Block {
            low: [-edge, -edge, 0.0],
            high: [edge, edge, 0.0],
        },
        perturb: None,
    };
    let mut spec = Spec::new(3, plate, 1.0, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Length(1.5);
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement([text("0"), text("0"), text("0")]),
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(0.005);
    spec.loading.rigid_bodies = vec![RigidBodySpec {
        name: "head".into(),
        ..body
    }];
    probe(&mut spec, "head");
    spec
}

#[test]
fn pulling_a_flat_face_off_takes_the_work_of_adhesion() {
    let cohesion = CohesionSpec {
        energy: 0.9,
        strength: 2.0,
    };
    assert!((cohesion.range() - 0.8).abs() < 1e-15);
    let rises = |z: &str| {
        RigidBodyMotion::Kinematic([text("0").unwrap(), text("0").unwrap(), text(z).unwrap()])
    };
    // solid above: its normal points down once it is turned
    let normal = [0.0, 0.0, 1.0];
    let mut plane = RigidBodySpec::new(10.0, RigidShape::Plane { normal }, rises("t"));
    plane.turn = Some(TurnSpec {
        axis: [1.0, 0.0, 0.0],
        angle: text("pi").unwrap(),
    });
    plane.cohesion = Some(cohesion);
    let mut sim = made(&layer(3.0, plane));
    let (mut work, mut most, mut before) = (0.0, 0.0f64, seen(sim.as_mut(), "force")[2]);
    for _ in 0..200 {
        run(sim.as_mut(), 1);
        let now = seen(sim.as_mut(), "force")[2];
        work -= 0.5 * 0.005 * (before + now);
        most = most.max(-now);
        before = now;
    }
    let area = 49.0;
    assert!((work / (0.9 * area) - 1.0).abs() < 1e-4, "{}", work / area);
    assert!((most / (2.0 * area) - 1.0).abs() < 1e-4, "{}", most / area);
    assert_eq!(before, 0.0);
}

#[test]
fn a_sphere_is_pulled_off_by_bradleys_force() {
    let (radius, w) = (400.0, 0.9);
    let motion = RigidBodyMotion::Kinematic([
        text("0.3").unwrap(),
        text("0.2").unwrap(),
        text("400 - 0.05 + 0.5*t").unwrap(),
    ]);
    let mut ball = RigidBodySpec::sphere(1e-3, radius, motion);
    ball.cohesion = Some(CohesionSpec {
        energy: w,
        strength: 2.0,
    });
    let mut sim = made(&layer(32.0, ball));
    let mut most = 0.0f64;
    for _ in 0..200 {
        run(sim.as_mut(), 1);
        most = most.max(-seen(sim.as_mut(), "force")[2]);
    }
    let exact = 2.0 * PI * radius * w;
    println!("pull-off force over 2πRw − 1: {:.1e}", most / exact - 1.0);
    assert!((most / exact - 1.0).abs() < 1e-2, "{}", most / exact);
}

#[test]
fn what_rigid_bodies_cannot_be_is_refused() {
    let refused = |change: &dyn Fn(&mut Spec), said: &str| {
        let mut spec = tumbling(RigidShape::Box { half: HALF }, None, 0.02);
        change(&mut spec);
        let error = build(&spec, Options::default())
            .err()
            .map(|e| e.to_string());
        assert!(
            error.as_ref().is_some_and(|e| e.contains(said)),
            "{said}: {error:?}"
        );
    };
    refused(
        &|s| {
            s.loading.rigid_bodies[0].shape = RigidShape::Plane {
                normal: [0.0, 0.0, 1.0],
            }
        },
        "an infinite plane has no mass",
    );
    refused(
        &|s| {
            s.run.probes[0].measure = Measure::RigidBody {
                rigid_body: "ball".into(),
                of: None,
            }
        },
        "no rigid body `ball`",
    );
    refused(
        &|s| {
            s.loading
                .rigid_bodies
                .push(s.loading.rigid_bodies[0].clone())
        },
        "two rigid bodies",
    );
    refused(
        &|s| {
            if let RigidBodyMotion::Free(free) = &mut s.loading.rigid_bodies[0].motion {
                free.inertia = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0]]);
            }
        },
        "principal moments",
    );
    refused(
        &|s| {
            s.space.periodic = [Some(6.0), None, None];
            s.loading.rigid_bodies[0].shape = RigidShape::Box {
                half: [1.0, 1.5, 4.0],
            };
        },
        "more than half of the period",
    );
    refused(
        &|s| {
            s.loading.rigid_bodies[0].cohesion = Some(CohesionSpec {
                energy: 1.0,
                strength: 1.0,
            })
        },
        "more than the spacing",
    );
}
