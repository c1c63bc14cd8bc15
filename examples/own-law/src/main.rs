//! A law of one's own: bonds that stiffen, `T = ½ c ω (s + b s³)` along the bond, in every dimension, on lattices and clouds.
#![forbid(unsafe_code)]

use peridyne::columns::Dimension;
use peridyne::law::descriptor::{Bounds, Descriptor, Given, Memory, Shelved, number};
use peridyne::law::material::{Along, Bond, End, Material};
use peridyne::law::number::Number;
use peridyne::run::{Options, Shelf, build_with};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

struct Stiffening([f64; 2]);

impl<const D: usize> Material<D> for Stiffening {
    type Constants<N: Number> = [N; 2];
    type Form<N: Number> = [N; 0];
    type Sum<N: Number> = [N; 0];
    type Point<N: Number> = [N; 0];
    type Past<N: Number> = [N; 0];
    type Memory<N: Number> = [N; 0];
    type State<N: Number> = Along<N>;
    const PASSES: usize = 0;

    fn constants(&self, _: usize, _: f64) -> [f64; 2] {
        self.0
    }
    fn answer<N: Number>(&self, bond: &Bond<N, D>, end: &End<[N; 2], [N; 0], [N; 0]>) -> Along<N> {
        let ([c, b], s) = (*end.constants, bond.stretch);
        Along(c * bond.omega * (b * s * s).fma(s, s) * bond.inv_current)
    }
    fn energy<N: Number>(&self, bond: &Bond<N, D>, end: &End<[N; 2], [N; 0], [N; 0]>) -> N {
        let ([c, b], s) = (*end.constants, bond.stretch);
        let half = N::constant(0.5);
        c * bond.omega * bond.length * half * s * s * (half * b * s).fma(s, N::constant(1.0))
    }
}

impl Shelved for Stiffening {
    fn descriptor() -> Descriptor {
        Descriptor {
            name: "stiffening".into(),
            doc: "Bonds that stiffen, T = ½ c ω (s + b s³).".into(),
            source: "this file".into(),
            example: "{ young = \"1 GPa\", cubic = 10 }".into(),
            influence: Influence::Constant,
            memory: Memory::Nothing,
            keys: vec![
                number(
                    "young",
                    Dimension::PRESSURE,
                    Bounds::POSITIVE,
                    "Young's modulus at rest.",
                ),
                number("cubic", Dimension::NUMBER, Bounds::NOT_NEGATIVE, "b").or(0.0),
            ],
        }
    }
    fn linear(p: &Parameters) -> Result<LawSpec, String> {
        let young = p.number("young").ok_or("young is missing")?;
        Ok(LawSpec::Pmb(PmbStiffness::Young(young)))
    }
    fn make(_: usize, _: Plane, all: &[Given]) -> Result<Self, (usize, String)> {
        let [one] = all else {
            return Err((1, "one material at a time".into()));
        };
        let c = one.micromodulus.ok_or((0, "no micromodulus".to_string()))?;
        Ok(Stiffening([
            0.5 * c,
            one.parameters.number("cubic").unwrap_or(0.0),
        ]))
    }
}

pub fn main() {
    let quarters = (0..64).map(|n| [4 * (n % 8), 4 * (n / 8), 0]).collect();
    let body = BodySpec::Sites {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let law = LawSpec::named(
        "stiffening",
        Parameters::numbers(&[("young", 1.0), ("cubic", 10.0)]),
    );
    let mut spec = Spec::new(2, body, 1.0, law);
    spec.horizon = Horizon::Ratio(3);
    spec.schedule.time_step = TimeStep::Fraction(0.05);
    let shelf = Shelf::standard().with::<Stiffening>();
    let mut sim = build_with(&spec, Options::default(), &shelf).expect("a body of this law");
    let stretched: Vec<[f64; 3]> = (0..64)
        .map(|n| [0.05 * f64::from(n % 8), 0.0, 0.0])
        .collect();
    sim.set_displacements(&stretched);
    sim.start(true);
    let before = sim.ledger().expect("energies");
    for _ in 0..200 {
        sim.step().expect("a step");
    }
    let after = sim.ledger().expect("energies");
    let kept = (after.kinetic + after.strain) / (before.kinetic + before.strain);
    println!(
        "kinetic {:.4e}, strain {:.4e}, energy kept to {:.1e}",
        after.kinetic,
        after.strain,
        kept - 1.0
    );
    assert!((kept - 1.0).abs() < 1e-3);
}
