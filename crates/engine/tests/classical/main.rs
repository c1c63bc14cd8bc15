//! Answers of classical mechanics that laws with memory or tensors must give.

mod compact;
mod plastic;
mod relaxing;
mod section;
mod shock;
mod wound;

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

fn e(text: &str) -> Expression {
    Expression::parse(text, &[]).unwrap()
}

/// A block of sites of a lattice whose spacing is 1, its middle at the origin.
fn block(kind: LatticeKind, sites: [i32; 3], ratio: u32, law: LawSpec) -> Spec {
    let mut quarters = vec![];
    for z in 0..sites[2] {
        for y in 0..sites[1] {
            for x in 0..sites[0] {
                quarters.push([4 * x, 4 * y, 4 * z]);
            }
        }
    }
    let body = BodySpec::Sites {
        kind,
        spacing: 1.0,
        origin: sites.map(|n| -0.5 * f64::from(n - 1)),
        quarters,
        volume: None,
    };
    let mut spec = Spec::new(kind.dimension(), body, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(ratio);
    spec.bonds.influence = Influence::Inverse;
    spec.bonds.partial_volume_correction = true;
    spec
}

/// All points follow expressions of the place in the reference and time, a step is one unit of time.
fn led(spec: &mut Spec, u: [&str; 3]) -> Box<dyn Simulation> {
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement(u.map(|u| Some(e(u)))),
    }];
    spec.run.schedule.time_step = TimeStep::Fixed(1.0);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut sim = build(spec, options).unwrap();
    sim.start(true);
    sim
}

/// A component of the stress of the point in the middle.
fn stress(sim: &mut dyn Simulation, component: &str) -> f64 {
    let n = sim.info().points as usize;
    let column = sim.column("stress").unwrap();
    let names = column.declaration.shape.components();
    let place = names.iter().position(|c| *c == component).unwrap();
    column.values.at(n / 2, place)
}
