//! Motion and forces that a program gives a model whose steps are solved for, against those of a spec.

use super::{LPS, block, newmark, text};
use peridyne::boundary_condition::constraint::Kind;
use peridyne::boundary_condition::external::ExternalValues;
use peridyne::boundary_condition::point_force::{LocalForce, PointForce, Seen, Stiffness};
use peridyne::run::{Given, Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::*;
use std::sync::{Arc, Mutex};

#[derive(Debug)]
struct Pulled;

impl ExternalValues for Pulled {
    fn at(&self, _: usize, _: usize, t: f64) -> f64 {
        0.01 * t * t
    }
}

fn condition(set: &str, kind: ConditionKind) -> ConditionSpec {
    ConditionSpec {
        set: set.into(),
        kind,
    }
}

/// A plate that is held at its low end.
fn plate() -> Spec {
    let mut spec = block([9.0, 4.0, 0.0], 2, LPS, 2);
    let held = [text("0"), text("0"), None];
    spec.loading
        .conditions
        .push(condition("low", ConditionKind::Displacement(held)));
    spec
}

fn pulled(mut spec: Spec) -> Spec {
    let pulled = [text("0.01*t^2"), None, None];
    spec.loading
        .conditions
        .push(condition("high", ConditionKind::Displacement(pulled)));
    spec
}

fn model(spec: &Spec) -> Box<dyn Simulation> {
    build(spec, Options::default()).unwrap()
}

fn given(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = model(spec);
    let high = sim.members("high").unwrap();
    let on = [true, false, false];
    let pulled = Given::Motion(Kind::Displacement, on, Arc::new(Pulled));
    sim.give(&high, pulled).unwrap();
    sim
}

/// Of all steps: displacements and work.
fn steps(mut sim: Box<dyn Simulation>, count: u64) -> Vec<(Vec<Point>, f64)> {
    sim.start(true);
    let each = (0..count).map(|_| {
        sim.step().unwrap();
        let ledger = sim.ledger().unwrap();
        (sim.displacements(), ledger.work_boundary_conditions)
    });
    each.collect()
}

fn agree(a: &[(Vec<Point>, f64)], b: &[(Vec<Point>, f64)], by: f64) {
    for ((u, work), (other, theirs)) in a.iter().zip(b) {
        let most = u.as_flattened().iter().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!(most > 0.0 && *work != 0.0);
        for (x, y) in u.as_flattened().iter().zip(other.as_flattened()) {
            assert!((x - y).abs() <= by * most, "{x}, {y}");
        }
        assert!((work - theirs).abs() <= by * work.abs(), "{work}, {theirs}");
    }
}

#[test]
fn motion_that_a_program_gives_implicit_steps_is_that_of_a_spec() {
    for alpha in [0.0, -0.1] {
        let with = |mut spec: Spec| {
            newmark(&mut spec, 0.7);
            spec.run.schedule.stepper = Stepper::Newmark(Newmark::hht(alpha));
            spec
        };
        let written = steps(model(&with(pulled(plate()))), 12);
        agree(&steps(given(&with(plate())), 12), &written, 1e-12);
    }
}

#[test]
fn motion_that_a_program_gives_statics_is_that_of_a_spec() {
    for method in [Method::Linear, Method::Newton] {
        let with = |mut spec: Spec| {
            spec.run.schedule.stepper = Stepper::Statics(Statics {
                method,
                ..Statics::default()
            });
            spec.run.schedule.time_step = TimeStep::Fixed(0.25);
            spec.run.schedule.steps = 4;
            spec
        };
        let written = steps(model(&with(pulled(plate()))), 4);
        agree(&steps(given(&with(plate())), 4), &written, 1e-12);
        let mut sim = given(&with(plate()));
        let high = sim.members("high").unwrap();
        let refused = |sim: &mut Box<dyn Simulation>, kind, on| {
            let given = sim.give(&high, Given::Motion(kind, on, Arc::new(Pulled)));
            given.unwrap_err().to_string()
        };
        let twice = refused(&mut sim, Kind::Displacement, [true, false, false]);
        assert!(twice.contains("held along x already"), "{twice}");
        let fast = refused(&mut sim, Kind::Velocity, [false, true, false]);
        assert!(fast.contains("moves its points on"), "{fast}");
        // nothing of what was refused stays
        agree(&steps(sim, 4), &written, 1e-12);
    }
}

/// A spring of every point to where it was, which looks at all at once.
#[derive(Debug, Default)]
struct Springs(Mutex<Vec<Point>>);

const STIFFNESS: f64 = 3.0;

impl PointForce for Springs {
    fn memory(&self) -> usize {
        0
    }
    fn look(&self, all: &[Seen]) {
        *self.0.lock().unwrap() = all.iter().map(|s| s.displacement).collect();
    }
    fn looks(&self) -> bool {
        true
    }
    fn force(&self, k: usize, at: &Seen, _: &mut [f64]) -> LocalForce {
        let u = self.0.lock().unwrap()[k];
        assert_eq!(u, at.displacement);
        let mut stiffness = [[0.0; 3]; 3];
        (0..3).for_each(|a| stiffness[a][a] = STIFFNESS);
        LocalForce {
            force: u.map(|u| -STIFFNESS * u),
            stiffness,
        }
    }
    fn stiffness(&self) -> Stiffness {
        Stiffness::Known
    }
    fn viscosity(&self, _: usize) -> f64 {
        0.0
    }
}

#[test]
fn a_force_that_a_program_gives_is_part_of_what_is_solved_for() {
    let mut spec = block([9.0, 4.0, 0.0], 2, LPS, 2);
    super::start(&mut spec, "0.01", ["0", "0"]);
    let dt = 2.0;
    newmark(&mut spec, dt);
    let mut sim = model(&spec);
    let all = sim.members("all").unwrap();
    sim.give(&all, Given::Force(Arc::new(Springs::default())))
        .unwrap();
    sim.start(true);
    // all points swing alike, as the trapezoidal rule says
    let turn = 2.0 * (0.5 * STIFFNESS.sqrt() * dt).atan();
    for n in 1..=10 {
        sim.step().unwrap();
        let exact = 0.01 * (f64::from(n) * turn).cos();
        for u in sim.displacements() {
            assert!((u[0] - exact).abs() < 1e-12, "step {n}: {u:?}, not {exact}");
        }
    }
    // what a linear solution has not
    let mut spec = pulled(plate());
    spec.run.schedule.stepper = Stepper::Statics(Statics::default());
    spec.run.schedule.time_step = TimeStep::Fixed(0.25);
    spec.run.schedule.steps = 4;
    let mut sim = model(&spec);
    let refused = sim.give(&all, Given::Force(Arc::new(Springs::default())));
    let refused = refused.unwrap_err();
    assert!(
        refused.to_string().contains("slopes of bonds alone"),
        "{refused}"
    );
    agree(&steps(sim, 4), &steps(model(&spec), 4), 0.0);
}
