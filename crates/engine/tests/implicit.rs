//! Newmark's method against closed forms, the explicit integrator, statics, and Peridigm's stored numbers.

#[path = "implicit/breaking.rs"]
mod breaking;
#[path = "implicit/given.rs"]
mod given;
#[path = "implicit/hht.rs"]
mod hht;

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use std::f64::consts::PI;

const SPRINGS: LawSpec = LawSpec::Springs(PmbStiffness::Micromodulus(1.0));
const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 1.0,
    poisson: 0.3,
});

fn text(e: &str) -> Option<Expression> {
    Some(Expression::parse(e, &[]).unwrap())
}

/// A block of unit spacings from 0 to `size`, its low and high ends along x as sets.
fn block(size: [f64; 3], d: usize, law: LawSpec, ratio: u32) -> Spec {
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
    spec.bonds.horizon = Horizon::Ratio(ratio);
    let end = |name: &str, sign: f64, x: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        }),
    };
    spec.sets = vec![end("low", 1.0, 0.1), end("high", -1.0, size[0] - 0.1)];
    spec
}

fn newmark(spec: &mut Spec, step: f64) {
    spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
    spec.run.schedule.time_step = TimeStep::Fixed(step);
}

fn built(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

fn start(spec: &mut Spec, displacement: &str, velocity: [&str; 2]) {
    spec.loading.initial.push(InitialSpec {
        set: "all".into(),
        displacement: [text(displacement), None, None],
        velocity: [text(velocity[0]), text(velocity[1]), None],
    });
}

/// Free chain of 20 unit springs and masses in its third mode, `ω = 2 sin(3π/40)`.
fn mode(step: f64) -> (Box<dyn Simulation>, f64) {
    let mut spec = block([19.0, 0.0, 0.0], 1, SPRINGS, 1);
    start(&mut spec, "0.01*cos(3*pi*(x+0.5)/20)", ["0", "0"]);
    newmark(&mut spec, step);
    (built(&spec), 2.0 * (3.0 * PI / 40.0).sin())
}

#[test]
fn a_mode_of_a_free_bar_moves_as_the_method_says_and_to_second_order() {
    let mut errors = vec![];
    for steps in [160, 320, 640] {
        let duration = 20.0;
        let dt = duration / f64::from(steps);
        let (mut sim, omega) = mode(dt);
        // the trapezoidal rule turns a mode by 2 atan(ωΔt/2) per step
        let turn = 2.0 * (0.5 * omega * dt).atan();
        for n in 1..=steps {
            sim.step().unwrap();
            let amplitude = 0.01 * (f64::from(n) * turn).cos();
            for (x, u) in sim.vectors("reference").iter().zip(sim.displacements()) {
                let exact = amplitude * (3.0 * PI * (x[0] + 0.5) / 20.0).cos();
                assert!((u[0] - exact).abs() < 1e-13, "step {n}: {u:?}, not {exact}");
            }
        }
        assert!((sim.time() - duration).abs() < 1e-12);
        let u = sim.displacements()[0][0] / (3.0 * PI * 0.5 / 20.0).cos();
        errors.push((u / 0.01 - (omega * duration).cos()).abs());
    }
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (order - 2.0).abs() < 0.05,
            "order {order}, errors {errors:?}"
        );
    }
}

#[test]
fn a_linear_body_keeps_its_energy_to_round_off_at_any_step() {
    for solver in [Solver::Direct, Solver::ConjugateGradients] {
        let mut spec = block([11.0, 6.0, 0.0], 2, SPRINGS, 2);
        let v = "0.01*sin(3*x+y)";
        start(&mut spec, "0.02*sin(2*x*y)", [v, "0.02*cos(x-2*y)"]);
        spec.run.schedule.stepper = Stepper::Newmark(Newmark {
            solver,
            tolerance: 1e-13,
            ..Newmark::default()
        });
        spec.run.schedule.time_step = TimeStep::Fraction(12.5);
        let mut sim = built(&spec);
        assert!(sim.info().time_step > 12.0 * sim.info().stable_step);
        let first = sim.ledger().unwrap();
        let energy = first.kinetic + first.strain;
        assert!(first.kinetic > 0.1 * energy && first.strain > 0.1 * energy);
        let mut exchanged = 0.0f64;
        for _ in 0..200 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            exchanged = exchanged.max((l.kinetic - first.kinetic).abs() / energy);
            let off = (l.kinetic + l.strain - energy).abs() / energy;
            assert!(off < 1e-12, "{off} at {}", sim.step_number());
        }
        assert!(exchanged > 0.05);
    }
}

/// The state of a solid that is bent and thrown, after `duration`.
fn thrown(law: LawSpec, stepper: Stepper, steps: u64, duration: f64) -> (Vec<[f64; 3]>, f64) {
    let mut spec = block([7.0, 3.0, 0.0], 2, law, 2);
    start(&mut spec, "0", ["0.02*sin(x)", "0.03*cos(0.5*x)"]);
    spec.run.schedule.stepper = stepper;
    spec.run.schedule.time_step = TimeStep::Fixed(duration / steps as f64);
    let mut sim = built(&spec);
    let initial = sim.ledger().unwrap().initial;
    for _ in 0..steps {
        sim.step().unwrap();
    }
    let off = sim.ledger().unwrap().residual().abs() / initial;
    (sim.displacements(), off)
}

#[test]
fn small_steps_go_the_same_way_as_explicit_ones() {
    for law in [LPS, LawSpec::Pmb(PmbStiffness::Young(1.0))] {
        let implicit = Stepper::Newmark(Newmark::default());
        let apart = |steps| {
            let (u, off) = thrown(law.clone(), implicit, steps, 8.0);
            let (w, _) = thrown(law.clone(), Stepper::Verlet, 4 * steps, 8.0);
            let far = |u: &[f64; 3]| u[0].hypot(u[1]);
            let largest = w.iter().map(far).fold(0.0, f64::max);
            let each = u.iter().zip(&w);
            let d = each.map(|(u, w)| (u[0] - w[0]).hypot(u[1] - w[1]));
            (d.fold(0.0, f64::max) / largest, off)
        };
        let [(first, _), (second, off)] = [100, 200].map(apart);
        assert!(second < 1e-2, "{law:?}: {second}");
        let order = (first / second).log2();
        assert!((order - 2.0).abs() < 0.1, "{law:?}: order {order}");
        // the trapezoidal rule keeps the energy of nonlinear laws to second order
        assert!(off < 1e-4, "{law:?}: {off}");
    }
}

#[test]
fn work_damping_and_prescribed_motion_balance() {
    let mut spec = block([14.0, 4.0, 0.0], 2, SPRINGS, 2);
    let mut condition = |set: &str, kind| {
        spec.loading.conditions.push(ConditionSpec {
            set: set.into(),
            kind,
        })
    };
    let still = ConditionKind::Displacement([text("0"), text("0"), None]);
    condition("low", still);
    let pull = ConditionKind::Velocity([text("0.01*sin(t)"), None, None]);
    condition("high", pull);
    let load = ConditionKind::BodyForce([None, text("1e-3*cos(0.3*t)*x"), None]);
    condition("all", load);
    condition("all", ConditionKind::Damping(text("0.05").unwrap()));
    newmark(&mut spec, 2.0);
    let mut sim = built(&spec);
    for _ in 0..100 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        let moved = l.work_boundary_conditions.abs() + l.dissipated + l.kinetic + l.strain;
        assert!(l.residual().abs() < 1e-12 * moved.max(1e-6), "{l:?}");
    }
    let l = sim.ledger().unwrap();
    assert!(l.dissipated > 0.0 && l.work_boundary_conditions > 0.0);
    // where the moved end is: the integral of its velocity by the middles of steps
    let told: f64 = (0..100)
        .map(|n| 2.0 * 0.01 * (2.0 * f64::from(n) + 1.0).sin())
        .sum();
    let end = sim.members("high").unwrap()[0] as usize;
    assert!((sim.displacements()[end][0] - told).abs() < 1e-14);
}

#[test]
fn a_damped_body_comes_to_rest_in_equilibrium() {
    let mut spec = block([10.0, 3.0, 0.0], 2, LPS, 2);
    spec.loading.conditions = vec![
        ConditionSpec {
            set: "low".into(),
            kind: ConditionKind::Displacement([text("0"), text("0"), None]),
        },
        ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::BodyForce([None, text("-6e-4"), None]),
        },
    ];
    let mut at_rest = spec.clone();
    at_rest.run.schedule.steps = 1;
    at_rest.run.schedule.time_step = TimeStep::Fixed(1.0);
    at_rest.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-12,
        ..Statics::default()
    });
    let mut sim = built(&at_rest);
    sim.step().unwrap();
    let equilibrium = sim.displacements();
    spec.loading.conditions.push(ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Damping(text("0.03").unwrap()),
    });
    newmark(&mut spec, 5.0);
    // the trapezoidal rule hardly damps modes that are fast beside the step; this one does
    spec.run.schedule.stepper = Stepper::Newmark(Newmark {
        beta: 0.3025,
        gamma: 0.6,
        ..Newmark::default()
    });
    let mut sim = built(&spec);
    for _ in 0..1000 {
        sim.step().unwrap();
    }
    let deepest = equilibrium.iter().map(|u| u[1].abs()).fold(0.0, f64::max);
    assert!(deepest > 0.5, "bent far: {deepest}");
    for (u, w) in sim.displacements().iter().zip(&equilibrium) {
        let apart = (u[0] - w[0]).hypot(u[1] - w[1]);
        assert!(apart < 1e-8 * deepest, "{u:?} {w:?}");
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new();
        let pool = pool.num_threads(threads).build().unwrap();
        pool.install(|| thrown(LPS, Stepper::Newmark(Newmark::default()), 20, 20.0))
    };
    let (one, three) = (run(1), run(3));
    assert_eq!(one, three);
}

#[test]
fn what_has_no_tangent_is_refused() {
    let mut spec = block(
        [5.0, 5.0, 0.0],
        2,
        LawSpec::Pmb(PmbStiffness::Young(1.0)),
        2,
    );
    newmark(&mut spec, 1.0);
    let said = |spec: &Spec| build(spec, Options::default()).err().unwrap();
    let mut late = spec.clone();
    late.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Stretch(0.1),
        alpha: 0.0,
        rate: None,
        fatigue: None,
    });
    assert!(build(&late, Options::default()).is_ok());
    late.damage.breakage = Breakage::AfterForce;
    assert_eq!(said(&late).path, "materials[0].fracture");
    let mut touching = spec.clone();
    touching.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    });
    assert!(build(&touching, Options::default()).is_ok());
    let mut free = spec.clone();
    let motion = RigidBodyMotion::Free(FreeSpec::new(1.0, [0.0, 9.0, 0.0], [0.0; 3]));
    free.loading
        .rigid_bodies
        .push(RigidBodySpec::sphere(1.0, 1.0, motion));
    assert!(build(&free, Options::default()).is_ok());
    free.loading.conditions.push(ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement([text("0"), text("0"), None]),
    });
    assert_eq!(said(&free).path, "rigid_bodies");
    for alpha in [-0.4, 0.1, f64::NAN] {
        let mut wrong = spec.clone();
        wrong.run.schedule.stepper = Stepper::Newmark(Newmark::hht(alpha));
        assert_eq!(said(&wrong).path, "schedule.alpha", "{alpha}");
    }
    let mut wrong = spec.clone();
    wrong.run.schedule.stepper = Stepper::Newmark(Newmark {
        alpha: -0.1,
        ..Newmark::default()
    });
    assert_eq!(said(&wrong).path, "schedule.alpha");
    let mut auto = spec.clone();
    auto.run.schedule.time_step = TimeStep::Auto;
    assert_eq!(said(&auto).path, "schedule.time_step");
    for (beta, gamma, path) in [
        (0.0, 0.5, "schedule.beta"),
        (0.2, 0.5, "schedule.beta"),
        (0.25, 0.4, "schedule.gamma"),
        (f64::NAN, 0.5, "schedule.beta"),
    ] {
        let mut wrong = spec.clone();
        wrong.run.schedule.stepper = Stepper::Newmark(Newmark {
            beta,
            gamma,
            ..Newmark::default()
        });
        assert_eq!(said(&wrong).path, path, "{beta} {gamma}");
    }
}

/// Peridigm (BSD 3-clause, Copyright 2011-2020 Sandia Corporation), test/verification at commit 82c6ad8f: two points of volume
/// 2 at x = ∓1, K = 130 GPa, G = 78 GPa, ρ = 7800, influence 1, full volumes; β = ¼, γ = ½, five steps of 1e-5.
fn peridigm(initial: [f64; 2]) -> Spec {
    let cloud = Cloud {
        position: vec![[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        volume: vec![2.0; 2],
        spacing: Some(2.0),
        ..Cloud::default()
    };
    let solid = LawSpec::Lps(Moduli::from_bulk_shear(130e9, 78e9));
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), 7800.0, solid);
    spec.bonds.horizon = Horizon::Length(2.5);
    spec.sets = [("low", 0), ("high", 1)]
        .map(|(name, id)| SetSpec {
            name: name.into(),
            members: Members::Points(vec![id].into()),
        })
        .into();
    for (set, v) in ["low", "high"].iter().zip(initial) {
        spec.loading.initial.push(InitialSpec {
            set: (*set).into(),
            displacement: [None, None, None],
            velocity: [text(&format!("{v:?}")), None, None],
        });
    }
    newmark(&mut spec, 1e-5);
    spec
}

/// Displacement, velocity and force density of the second point after each step; its tolerance of displacements is 1e-6,
/// that of its own solution relative 3e-9.
fn met(spec: &Spec, gold: &[[f64; 3]]) {
    let mut sim = built(spec);
    for (n, [u, v, f]) in gold.iter().enumerate() {
        sim.step().unwrap();
        let found = [
            sim.displacements()[1][0],
            sim.velocities()[1][0],
            sim.vectors("force_density")[1][0],
        ];
        assert!((found[0] - u).abs() < 1e-6);
        for (found, gold) in found.iter().zip([u, v, f]) {
            let off = (found / gold - 1.0).abs();
            assert!(off < 1e-8, "step {}: {found} is not {gold}", n + 1);
        }
    }
}

#[test]
fn peridigm_compression_implicit_2x1x1() {
    let gold = [
        [
            -9.962640101552699e-06,
            -0.9925280203105397,
            11656288.91882209,
        ],
        [
            -1.9776398914121152e-05,
            -0.9702237422031509,
            23138386.729556482,
        ],
        [
            -2.92946200246566e-05,
            -0.9334204799039384,
            34274705.42884725,
        ],
        [
            -3.837506352352488e-05,
            -0.8826682198697171,
            44898824.322558984,
        ],
        [
            -4.6882031622905306e-05,
            -0.8187254000063687,
            54851976.99885425,
        ],
    ];
    met(&peridigm([1.0, -1.0]), &gold);
}

#[test]
fn peridigm_compression_implicit_essential_bc_2x1x1() {
    let gold = [
        [
            0.00017716781035330417,
            36.433562070660834,
            58396356830.94326,
        ],
        [0.0009144566352199129, 111.0242029026609, 57965042868.396255],
        [0.002393496252577403, 184.78372056883717, 57099804692.24231],
        [0.004603214625365219, 257.1599539887259, 55807119444.1613],
        [0.0075270698817972515, 327.6110972976805, 54096664119.14863],
    ];
    let mut spec = peridigm([0.0, -1.0]);
    // its first acceleration is 0, though its first point is already displaced: the force at the start is not evaluated. That
    // is a body at rest whose end is displaced just after the start.
    spec.loading.conditions.push(ConditionSpec {
        set: "low".into(),
        kind: ConditionKind::Displacement([text("0.1*(t>0)"), text("0"), text("0")]),
    });
    met(&spec, &gold);
}
