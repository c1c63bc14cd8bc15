//! Bodies of unit conductivity, density and capacity.

use peridyne::expression::Expression;
use peridyne::observe::Values;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

pub const SPRINGS: LawSpec = LawSpec::Pmb(PmbStiffness::Micromodulus(1.0));
pub const EXPLICIT: DiffusionMethod = DiffusionMethod::Explicit { safety: 0.9 };
pub const STEADY: DiffusionMethod = DiffusionMethod::Steady { tolerance: 1e-13 };
pub const EULER: DiffusionMethod = DiffusionMethod::Implicit {
    theta: 1.0,
    tolerance: 1e-13,
};
pub const CRANK_NICOLSON: DiffusionMethod = DiffusionMethod::Implicit {
    theta: 0.5,
    tolerance: 1e-13,
};

pub fn text(e: &str) -> Expression {
    Expression::parse(e, &[]).unwrap()
}

/// Points at the middles of cells of this spacing from `low` to `high`.
pub fn cells(d: usize, h: f64, low: [f64; 3], high: [f64; 3]) -> BodySpec {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let only = |x: [f64; 3]| std::array::from_fn(|a| if a < d { x[a] } else { 0.0 });
    BodySpec::Lattice {
        kind,
        spacing: h,
        origin: only([0.5 * h; 3]),
        region: Region::Block {
            low: only(low),
            high: only(high),
        },
        perturb: None,
    }
}

pub fn heat(method: DiffusionMethod) -> DiffusionSpec {
    DiffusionSpec {
        quantity: Quantity::Heat,
        method,
        reference: 0.0,
        across_broken: false,
        deformation: false,
        materials: vec![DiffusionMaterial {
            conductivity: 1.0,
            capacity: 1.0,
            expansion: 0.0,
        }],
        initial: vec![],
        conditions: vec![],
    }
}

/// Nothing moves; steps of `dt`.
pub fn still(d: usize, body: BodySpec, horizon: u32, dt: f64, heat: DiffusionSpec) -> Spec {
    let mut spec = Spec::new(d, body, 1.0, SPRINGS);
    spec.bonds.horizon = Horizon::Ratio(horizon);
    spec.run.schedule.stepper = Stepper::Still;
    spec.run.schedule.time_step = TimeStep::Fixed(dt);
    spec.interactions.diffusions = vec![heat];
    spec
}

/// Points beyond a place along x.
pub fn beyond(name: &str, x: f64, sign: f64) -> SetSpec {
    SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [-sign, 0.0, 0.0],
        }),
    }
}

pub fn on(set: &str, kind: DiffusionKind) -> DiffusionCondition {
    DiffusionCondition {
        set: set.into(),
        kind,
    }
}

pub fn built(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

pub fn run(sim: &mut dyn Simulation, steps: u64) {
    for _ in 0..steps {
        sim.step().unwrap();
    }
}

pub fn scalars(sim: &mut dyn Simulation, name: &str) -> Vec<f64> {
    match sim.column(name).unwrap().values {
        Values::Scalars(values) => values,
        other => panic!("{other:?}"),
    }
}

pub fn temperature(sim: &mut dyn Simulation) -> Vec<f64> {
    scalars(sim, "temperature")
}

/// Reference x of every point.
pub fn places(sim: &mut dyn Simulation) -> Vec<f64> {
    let snapshot = sim.snapshot(&[], false);
    snapshot.reference.iter().map(|x| x[0]).collect()
}

/// Largest difference of a temperature from a function of x, over points from `low` to `high`.
pub fn off(sim: &mut dyn Simulation, [low, high]: [f64; 2], exact: impl Fn(f64) -> f64) -> f64 {
    let (x, t) = (places(sim), temperature(sim));
    let each = x.iter().zip(&t).filter(|(x, _)| (low..high).contains(*x));
    each.map(|(x, t)| (t - exact(*x)).abs()).fold(0.0, f64::max)
}
