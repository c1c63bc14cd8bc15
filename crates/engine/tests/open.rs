//! What a program brings along beside laws: potentials, observables, forces.

use peridyne::columns::{Declaration, Dimension, Shape};
use peridyne::error::BuildErrorKind;
use peridyne::law::descriptor::{Bounds, Descriptor, Wrong};
use peridyne::law::number::Number;
use peridyne::law::potential::cut::{self, Cut, Ends};
use peridyne::law::potential::{Described, Potential};
use peridyne::observe::{Observable, Values};
use peridyne::run::{Options, Registry, Simulation, build, build_with};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

/// `φ = −A e^(−r²/w²)`, which the engine does not have.
struct Gaussian {
    depth: f64,
    width: f64,
}

#[derive(Clone)]
struct Well([f64; 2]);

impl Potential for Well {
    fn pair<N: Number>(&self, q: N) -> N {
        q.times(-1.0 / (self.0[1] * self.0[1]))
            .exp()
            .times(-self.0[0])
    }
}

impl Described for Gaussian {
    const NAME: &'static str = "gaussian";
    type Made = Cut<Well>;
    fn descriptor() -> Descriptor {
        Descriptor::new(Self::NAME, "−A e^(−r²/w²)")
            .number("depth", Dimension::ENERGY, Bounds::POSITIVE, "A")
            .number("width", Dimension::LENGTH, Bounds::POSITIVE, "w")
            .keys(&cut::KEYS)
    }
    fn read(p: &Parameters) -> Result<Self, Wrong> {
        let [depth, width] = cut::numbers(p, ["depth", "width"])?;
        Ok(Gaussian { depth, width })
    }
    fn parameters(&self) -> Parameters {
        Parameters::numbers(&[("depth", self.depth), ("width", self.width)])
    }
    fn made(self, ends: Ends) -> Cut<Well> {
        Cut::new(Well([self.depth, self.width]), ends)
    }
}

fn square(cells: f64, law: LawSpec) -> Spec {
    let plate = Region::Block {
        low: [0.0; 3],
        high: [cells, cells, 0.0],
    };
    let body = BodySpec::lattice(LatticeKind::Square, 1.0, plate);
    let mut spec = Spec::new(2, body, 1.5, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec.run.schedule.force_unstable = true;
    spec
}

fn solid() -> Spec {
    square(6.0, LawSpec::Pmb(PmbStiffness::Young(1.0)))
}

#[test]
fn a_potential_from_outside_runs_on_fixed_and_current_neighbours() {
    let registry = Registry::standard().with_potential::<Gaussian>();
    let (depth, width) = (1.3, 0.8);
    let ended = PotentialSpec::of(Gaussian { depth, width }).ended(2.2, End::Truncated);
    let numbers = [("depth", depth), ("width", width), ("cutoff", 2.2)];
    let named = LawSpec::named("gaussian", Parameters::numbers(&numbers));
    for law in [LawSpec::Atoms(ended), named] {
        for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
            let mut spec = square(4.0, law.clone());
            spec.bonds.family = family;
            assert!(
                build(&spec, Options::default()).is_err(),
                "the engine knows it"
            );
            let mut sim = build_with(&spec, Options::default(), &registry).unwrap();
            sim.start(true);
            // all pairs of the 25 atoms up to 2.2
            let mut sum = 0.0;
            let reference = sim.vectors("reference");
            for (n, x) in reference.iter().enumerate() {
                for y in &reference[..n] {
                    let r2: f64 = (0..2).map(|a| (x[a] - y[a]).powi(2)).sum();
                    let within = match family {
                        // whole spacings: the horizon of two
                        FamilyChoice::Stencil => r2 <= 4.0 + 1e-9,
                        _ => r2 < 2.2 * 2.2,
                    };
                    sum -= if within {
                        depth * (-r2 / (width * width)).exp()
                    } else {
                        0.0
                    };
                }
            }
            let found = sim.ledger().unwrap().strain;
            assert!(
                (found / sum - 1.0).abs() < 1e-12,
                "{family:?}: {found} {sum}"
            );
            for _ in 0..200 {
                sim.step().unwrap();
            }
            let energies = sim.ledger().unwrap();
            assert!(energies.kinetic > 1e-4, "{energies:?}");
            assert!(
                energies.residual().abs() < 1e-4 * energies.kinetic,
                "{energies:?}"
            );
        }
    }
}

#[test]
fn a_potential_without_a_shelf_has_no_place() {
    let spec = square(4.0, LawSpec::named("gaussian", Parameters::default()));
    let error = build(&spec, Options::default()).err().unwrap();
    let name = "gaussian".to_string();
    assert_eq!(error.kind, BuildErrorKind::Unknown { name });
    // and on it, it must have its constants
    let registry = Registry::standard().with_potential::<Gaussian>();
    let error = build_with(&spec, Options::default(), &registry)
        .err()
        .unwrap();
    assert!(error.message.contains("needs `depth`"), "{error}");
}

/// A foundation of springs and a force in time, whose work is known.
fn founded(registry: &Registry) -> Box<dyn Simulation> {
    let mut spec = solid();
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::force("foundation", Parameters::default()),
    }];
    build_with(&spec, Options::default(), registry).unwrap()
}

#[test]
fn a_force_from_outside_acts_and_keeps_its_account() {
    let stiffness = 0.4;
    let registry = Registry::standard().with_force_of("foundation", move |at| {
        [
            -stiffness * at.displacement[0],
            -stiffness * at.displacement[1],
            0.0,
        ]
    });
    let mut sim = founded(&registry);
    // all points beside their places: the body swings on its foundation as a whole, ω² = stiffness / density
    let n = sim.vectors("reference").len();
    sim.set_displacements(&vec![[0.01, 0.0, 0.0]; n]);
    sim.start(true);
    let steps = 1000;
    for _ in 0..steps {
        sim.step().unwrap();
    }
    let expected = 0.01 * ((stiffness / 1.5f64).sqrt() * steps as f64 * 1e-3).cos();
    for u in sim.displacements() {
        assert!(
            (u[0] - expected).abs() < 1e-8 && u[1].abs() < 1e-12,
            "{u:?} {expected}"
        );
    }
    // ½ k (u0² − u²) per volume of each point
    let work = 0.5 * stiffness * (0.01f64.powi(2) - expected.powi(2)) * n as f64;
    let energies = sim.ledger().unwrap();
    assert!(
        (energies.work_boundary_conditions / work - 1.0).abs() < 1e-5,
        "{energies:?} {work}"
    );
    assert!(
        (energies.kinetic / work - 1.0).abs() < 1e-5,
        "{energies:?} {work}"
    );
}

#[test]
fn a_force_from_outside_sees_place_motion_and_time() {
    let registry = Registry::standard().with_force_of("foundation", |at| {
        assert_eq!(at.density, 1.5);
        assert_eq!(at.reference[2], 0.0);
        [at.time, at.reference[1], -at.velocity[0]]
    });
    let mut sim = founded(&registry);
    sim.start(true);
    for _ in 0..3 {
        sim.step().unwrap();
    }
    let force = sim.vectors("force_density");
    let reference = sim.vectors("reference");
    let t = sim.time();
    // the bonds have hardly moved yet
    for (f, x) in force.iter().zip(&reference) {
        assert!(
            (f[0] - t).abs() < 1e-4 && (f[1] - x[1]).abs() < 1e-4,
            "{f:?} {x:?}"
        );
    }
}

#[test]
fn forces_from_outside_are_refused_where_they_cannot_be() {
    let mut spec = solid();
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::force("wind", Parameters::default()),
    }];
    let error = build(&spec, Options::default()).err().unwrap();
    let name = "wind".to_string();
    assert_eq!(error.kind, BuildErrorKind::Unknown { name });
    assert_eq!(error.path, "conditions[0]");
    let registry = Registry::standard().with_force_of("wind", |_| [1.0, 0.0, 0.0]);
    let clamped = |a: usize| {
        let zero = peridyne::expression::Expression::constant(0.0);
        let mut value = [None, None, None];
        value[a] = Some(zero);
        ConditionSpec {
            set: "left".into(),
            kind: ConditionKind::Displacement(value),
        }
    };
    spec.sets = vec![SetSpec {
        name: "left".into(),
        members: Members::Region(Region::Block {
            low: [-1.0; 3],
            high: [1.5, 9.0, 1.0],
        }),
    }];
    spec.loading.conditions.extend([clamped(0), clamped(1)]);
    spec.run.schedule.steps = 1;
    for stepper in [
        Stepper::Statics(Statics::default()),
        Stepper::Newmark(Newmark::default()),
    ] {
        spec.run.schedule.stepper = stepper;
        let built = build_with(&spec, Options::default(), &registry);
        let error = match built {
            Err(error) => error.to_string(),
            Ok(mut sim) => {
                sim.start(true);
                sim.step().expect_err("it has no tangent").to_string()
            }
        };
        assert!(error.contains("a force of the program"), "{error}");
    }
}

static SQUARE: Observable = Observable::new(
    Declaration::of_points("square", Shape::Scalar, Dimension::AREA, "u²").derived(),
    |state| {
        let of = |n| state.displacement(n).iter().map(|c| c * c).sum();
        Some(Values::Scalars((0..state.points()).map(of).collect()))
    },
);

#[test]
fn an_observable_from_outside_is_a_column_like_others() {
    let registry = Registry::standard().with_observable(&SQUARE);
    let mut spec = solid();
    spec.run.fields = Some(vec!["square".into()]);
    spec.run.probes = vec![ProbeSpec {
        name: "most".into(),
        set: "all".into(),
        measure: Measure::Over {
            fold: Fold::Max,
            of: "square".into(),
            part: Part::All,
        },
    }];
    assert!(
        build(&spec, Options::default()).is_err(),
        "the engine has it"
    );
    let mut sim = build_with(&spec, Options::default(), &registry).unwrap();
    assert!(sim.columns().iter().any(|c| c.name == "square"));
    let n = sim.vectors("reference").len();
    sim.set_displacements(&vec![[3.0, 4.0, 0.0]; n]);
    assert_eq!(sim.scalars("square"), vec![25.0; n]);
    assert_eq!(sim.measure(), [25.0]);
    let snapshot = sim.snapshot(&["square"], false);
    assert!(snapshot.columns.iter().any(|c| c.name() == "square"));
}
