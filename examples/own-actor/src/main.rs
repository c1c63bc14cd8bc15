//! A force of one's own that remembers, and has a tangent: a foundation of elastic–plastic springs, in explicit steps, implicit steps and
//! increments of statics.
#![forbid(unsafe_code)]

use peridyne::boundary_condition::point_force::{
    Described, LocalForce, Placed, PointForce, Seen, Stiffness,
};
use peridyne::columns::Dimension;
use peridyne::expression::Expression;
use peridyne::law::descriptor::{Bounds, Descriptor, Wrong};
use peridyne::run::{Options, Registry, Simulation, build_with};
use peridyne::space::{lattice::LatticeKind, region::Region};
use peridyne::spec::*;

/// `f = −k (u − p)` along x; the spring slips where that would be more than the strength, and p is what it slipped by.
#[derive(Debug)]
pub struct Foundation {
    /// k (force / volume / length)
    stiffness: f64,
    /// (force / volume)
    strength: f64,
}

impl PointForce for Foundation {
    fn memory(&self) -> usize {
        1
    }
    fn force(&self, _: usize, at: &Seen, slipped: &mut [f64]) -> LocalForce {
        let (k, u) = (self.stiffness, at.displacement[0]);
        let trial = k * (u - slipped[0]);
        let held = trial.clamp(-self.strength, self.strength);
        slipped[0] = u - held / k;
        let mut force = LocalForce {
            force: [-held, 0.0, 0.0],
            stiffness: [[0.0; 3]; 3],
        };
        if held == trial {
            force.stiffness[0][0] = k;
        }
        force
    }
    fn stiffness(&self) -> Stiffness {
        Stiffness::Known
    }
    fn viscosity(&self, _: usize) -> f64 {
        0.0
    }
}

impl Described for Foundation {
    const NAME: &'static str = "foundation";
    fn descriptor() -> Descriptor {
        let stiffness = Dimension([-3, 1, -2, 0]);
        Descriptor::new(
            Self::NAME,
            "Springs that hold every point at its place along x, and slip.",
        )
        .number("stiffness", stiffness, Bounds::POSITIVE, "k.")
        .number(
            "strength",
            Dimension::FORCE_DENSITY,
            Bounds::POSITIVE,
            "Where they slip.",
        )
    }
    fn new(parameters: &Parameters, _: &Placed) -> Result<Self, Wrong> {
        let numbers = parameters.all(["stiffness", "strength"]);
        let [stiffness, strength] = numbers.map_err(|message| (String::new(), message))?;
        Ok(Foundation {
            stiffness,
            strength,
        })
    }
}

const BARS: f64 = 40.0;

/// A bar on the foundation, pulled at its end by what grows from 0 to 1 and falls to 0 again in `end`.
pub fn bar(stepper: Stepper, steps: u64, end: f64) -> Box<dyn Simulation> {
    let bar = Region::Block {
        low: [0.0; 3],
        high: [BARS - 1.0, 0.0, 0.0],
    };
    let body = BodySpec::lattice(LatticeKind::Chain, 1.0, bar);
    let mut spec = Spec::new(
        1,
        body,
        1.0,
        LawSpec::Springs(PmbStiffness::Micromodulus(1.0)),
    );
    let last = Region::HalfSpace {
        point: [BARS - 1.5, 0.0, 0.0],
        normal: [-1.0, 0.0, 0.0],
    };
    spec.sets = vec![SetSpec {
        name: "end".into(),
        members: Members::Region(last),
    }];
    let pull = format!("0.1*(1 - abs(1 - 2*t/{end}))");
    let pull = Expression::parse(&pull, &[]).expect("an expression");
    let held = Parameters::numbers(&[("stiffness", 0.05), ("strength", 0.001)]);
    let condition = |set: &str, kind| ConditionSpec {
        set: set.into(),
        kind,
    };
    spec.loading.conditions = vec![
        condition("all", ConditionKind::force("foundation", held)),
        condition("end", ConditionKind::Displacement([Some(pull), None, None])),
    ];
    spec.run.schedule.stepper = stepper;
    spec.run.schedule.time_step = TimeStep::Fixed(end / steps as f64);
    spec.run.schedule.steps = steps;
    let registry = Registry::standard().with_force::<Foundation>();
    build_with(&spec, Options::default(), &registry).expect("a bar")
}

/// The same at the end.
pub fn pulled(stepper: Stepper, steps: u64, end: f64) -> Box<dyn Simulation> {
    let mut sim = bar(stepper, steps, end);
    sim.start(true);
    for _ in 0..steps {
        sim.step().expect("a step");
    }
    sim
}

pub fn main() {
    let newton = Statics {
        method: Method::Newton,
        ..Statics::default()
    };
    let slowly = pulled(Stepper::Statics(newton), 40, 1.0);
    let implicit = pulled(Stepper::Newmark(Newmark::default()), 4000, 20_000.0);
    let explicit = pulled(Stepper::Verlet, 100_000, 20_000.0);
    let of = |mut sim: Box<dyn Simulation>| -> Vec<f64> {
        sim.displacements().iter().map(|u| u[0]).collect()
    };
    let [slowly, implicit, explicit] = [slowly, implicit, explicit].map(of);
    let left = slowly[35];
    let apart = |a: &[f64], b: &[f64]| {
        let each = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        each.fold(0.0, f64::max)
    };
    println!(
        "the springs slipped and hold the bar {left:.5} from where it was; implicit steps differ by {:.1e}, explicit ones by {:.1e}",
        apart(&slowly, &implicit),
        apart(&slowly, &explicit)
    );
    // as forty masses, springs and sliders come out by NumPy
    assert!((left - 0.00986326).abs() < 1e-7);
    assert!(apart(&slowly, &implicit) < 2e-3 && apart(&slowly, &explicit) < 2e-3);
}
