//! A law, an observable and a force of one's own, in every dimension, on lattices and clouds; all else is the engine's.
#![forbid(unsafe_code)]

use peridyne::columns::{Declaration, Dimension, Shape};
use peridyne::law::descriptor::{Bounds, Descriptor, Key, number};
use peridyne::law::material::bonds::{BondLaw, Bonds};
use peridyne::law::number::Number;
use peridyne::observe::{Observable, State, Values};
use peridyne::run::{Options, Registry, build_with};
use peridyne::space::{lattice::LatticeKind, region::Region};
use peridyne::spec::*;

/// Bonds that stiffen, `T = ½ c ω (s + b s³)`.
pub struct Stiffening;

impl BondLaw<1> for Stiffening {
    const NUMBERS: [Key; 1] =
        [number("cubic", Dimension::NUMBER, Bounds::NOT_NEGATIVE, "b").or(0.0)];
    fn descriptor() -> Descriptor {
        Descriptor::new("stiffening", "Bonds that stiffen, T = ½ c ω (s + b s³).")
    }
    fn tension<N: Number>([b]: [N; 1], s: N) -> N {
        (b * s * s).fma(s, s)
    }
    fn energy<N: Number>([b]: [N; 1], s: N) -> N {
        let half = N::constant(0.5);
        half * s * s * (half * b * s).fma(s, N::constant(1.0))
    }
}

const DOC: &str = "Distance from where the point was.";
static DISTANCE: Observable = Observable::new(
    Declaration::of_points("distance", Shape::Scalar, Dimension::LENGTH, DOC).derived(),
    |state: &mut dyn State| {
        let size = |n| {
            state
                .displacement(n)
                .iter()
                .map(|c| c * c)
                .sum::<f64>()
                .sqrt()
        };
        Some(Values::Scalars((0..state.points()).map(size).collect()))
    },
);

pub fn main() {
    let numbers = Parameters::numbers(&[("young", 1.0), ("cubic", 10.0)]);
    let law = LawSpec::named("stiffening", numbers);
    let plate = Region::Block {
        low: [0.0; 3],
        high: [8.0, 8.0, 0.0],
    };
    let mut spec = Spec::new(
        2,
        BodySpec::lattice(LatticeKind::Square, 1.0, plate),
        1.0,
        law,
    );
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.run.schedule.time_step = TimeStep::Fraction(0.05);
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::force("foundation", Parameters::default()),
    }];
    let registry = Registry::standard()
        .with::<Bonds<Stiffening, 1>>()
        .with_observable(&DISTANCE)
        .with_force_of("foundation", |at| at.displacement.map(|u| -1e-3 * u));
    let mut sim = build_with(&spec, Options::default(), &registry).expect("a body of this law");
    let stretched = sim.vectors("reference").into_iter();
    sim.set_displacements(
        &stretched
            .map(|x| [0.05 * x[0], 0.0, 0.0])
            .collect::<Vec<_>>(),
    );
    sim.start(true);
    for _ in 0..200 {
        sim.step().expect("a step");
    }
    let energies = sim.ledger().expect("energies");
    let missing = energies.residual() / energies.initial;
    let farthest = sim.scalars("distance").into_iter().fold(0.0, f64::max);
    println!("{missing:.1e} of the energy is missing, farthest {farthest:.3}");
    assert!(missing.abs() < 1e-3 && energies.work_boundary_conditions != 0.0 && farthest > 0.0);
}
