//! Fibres that follow the place.

mod axes;
mod ring;

use super::e;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::*;
use std::sync::Arc;

const YOUNG: [f64; 3] = [4.0, 1.0, 0.8];
const POISSON: [f64; 3] = [0.3, 0.25, 0.4];
const SHEAR: [f64; 3] = [0.5, 0.4, 0.35];

/// With these axes 1 and 3.
fn ply(fibre: Parameter, normal: Parameter, bonds: bool) -> LawSpec {
    let list = |x: [f64; 3]| Parameter::List(x.to_vec());
    let all = Parameters::default()
        .with("young", list(YOUNG))
        .with("poisson", list(POISSON))
        .with("shear", list(SHEAR))
        .with("fibre", fibre)
        .with("normal", normal);
    LawSpec::named(
        "anisotropic",
        match bonds {
            true => all.with("gradient", Parameter::Word("bond".into())),
            false => all,
        },
    )
}

fn given(x: Point) -> Parameter {
    Parameter::List(x.to_vec())
}

fn of_place(text: [&str; 3]) -> Parameter {
    Parameter::Direction(text.map(e))
}

const UP: Point = [0.0, 0.0, 1.0];

/// Wound about the axis.
fn hoops(bonds: bool) -> LawSpec {
    ply(of_place(["-y", "x", "0"]), given(UP), bonds)
}

fn cloud(d: usize, position: Vec<Point>, volume: Vec<f64>, horizon: f64, law: LawSpec) -> Spec {
    let body = BodySpec::Cloud(Cloud {
        position,
        volume,
        spacing: Some(horizon / 2.01),
        ..Cloud::default()
    });
    let mut spec = Spec::new(d, body, 2.0, law);
    spec.space.plane = Plane::Stress;
    spec.bonds.horizon = Horizon::Length(horizon);
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    spec
}

fn made(spec: &Spec) -> Box<dyn Simulation> {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(spec, options).unwrap()
}

fn set(name: &str, ids: impl Iterator<Item = usize>) -> SetSpec {
    let ids: Vec<u32> = ids.map(|i| i as u32).collect();
    SetSpec {
        name: name.into(),
        members: Members::Points(Arc::from(ids)),
    }
}

/// At rest under its conditions, about the reference.
fn solved(spec: &mut Spec) -> Box<dyn Simulation> {
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        tolerance: 1e-10,
        ..Statics::default()
    });
    let mut sim = made(spec);
    sim.start(true);
    sim.step().unwrap();
    sim
}
