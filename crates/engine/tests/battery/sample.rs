//! Small bodies of every material on every lattice.

use crate::own_law::Stiffening;
use peridyne::error::BuildError;
use peridyne::expression::Expression;
use peridyne::law::material::bonds::Bonds;
use peridyne::run::{Options, Shelf, Simulation, build_with};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

/// Cell edge of all samples; not 1, so that missing powers show.
pub const H: f64 = 0.5;
pub const RHO: f64 = 2.0;

/// What a body is made of: its materials (the second on the upper half along x) and its influence function.
#[derive(Debug, Clone)]
pub struct Material {
    pub name: &'static str,
    pub laws: Vec<LawSpec>,
    pub influence: Influence,
    /// Where it can be: dimension and plane state.
    pub lives: fn(usize, Plane) -> bool,
    /// Of materials that cannot be without.
    pub fracture: Option<f64>,
    /// Is its energy a potential? Laws of rates have the work that was done.
    pub potential: bool,
}

/// The table of materials: a line here buys all batteries.
pub fn materials() -> Vec<Material> {
    let one = |name, law, influence| Material {
        name,
        laws: vec![law],
        influence,
        lives: |_, _| true,
        fracture: None,
        potential: true,
    };
    let two = |name, a, b, influence| Material {
        name,
        laws: vec![a, b],
        influence,
        lives: |_, _| true,
        fracture: None,
        potential: true,
    };
    let elastic =
        |young: f64, poisson: f64| Parameters::numbers(&[("young", young), ("poisson", poisson)]);
    let plastic = |yield_stress: f64, hardening: f64| {
        let more = elastic(3.0, 0.3)
            .with("yield_stress", Parameter::Number(yield_stress))
            .with("hardening", Parameter::Number(hardening));
        LawSpec::named("elastic_plastic", more)
    };
    let relaxing = |part: f64| {
        let rows = vec![vec![part, 0.7], vec![0.2, 3.0]];
        LawSpec::named(
            "viscoelastic",
            elastic(3.0, 0.2).with("branches", Parameter::Rows(rows)),
        )
    };
    let correspondence = |young, stress: &str| {
        LawSpec::named(
            "correspondence",
            elastic(young, 0.3).with("stress", Parameter::Word(stress.into())),
        )
    };
    let flowing = |yield_stress: f64, hardening: f64, friction: f64| {
        let more = elastic(3.0, 0.3)
            .with("yield_stress", Parameter::Number(yield_stress))
            .with("hardening", Parameter::Number(hardening))
            .with("friction", Parameter::Number(friction))
            .with("dilatancy", Parameter::Number(0.5 * friction));
        LawSpec::named("hypoelastic_plastic", more)
    };
    let shocked = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            let parameters = &mut law.parameters;
            parameters.set("equation_of_state", Parameter::Word("mie_gruneisen".into()));
            // 2s − Γ/2 = 1: at rest pressure has no corner in its curvature either, which tangents by differences would see
            parameters.set("hugoniot_slope", Parameter::Number(1.0));
            parameters.set("gruneisen", Parameter::Number(2.0));
            LawSpec::Named(law)
        }
        law => law,
    };
    let of_energy = |text: &str| {
        let energy = Expression::of(&["I1", "I2", "J"], text, &[]).unwrap();
        LawSpec::named(
            "hyperelastic",
            Parameters::default().with("energy", Parameter::Formula(energy)),
        )
    };
    let of_bonds = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            law.parameters
                .set("gradient", Parameter::Word("bond".into()));
            LawSpec::Named(law)
        }
        law => law,
    };
    let ply = |young: f64, fibre: [f64; 3]| {
        let list = |x: [f64; 3]| Parameter::List(x.to_vec());
        let all = Parameters::default()
            .with("young", list([young, 0.3 * young, 0.2 * young]))
            .with("poisson", list([0.3, 0.25, 0.4]))
            .with("shear", list([0.2 * young, 0.15 * young, 0.1 * young]))
            .with("fibre", list(fibre));
        LawSpec::named("anisotropic", all)
    };
    let bent = |law: LawSpec| match law {
        LawSpec::Named(mut law) => {
            let fibre = ["1", "sin(3*x) + y", "0"].map(e);
            law.parameters.set("fibre", Parameter::Direction(fibre));
            LawSpec::Named(law)
        }
        law => law,
    };
    let softening = |young: f64| {
        let all = Parameters::numbers(&[("young", young), ("onset", 0.1)]);
        LawSpec::named("softening", all)
    };
    let stiffening = |young: f64, cubic: f64| {
        let all = Parameters::numbers(&[("young", young), ("cubic", cubic)]);
        LawSpec::named("stiffening", all)
    };
    let lps = |young, poisson| LawSpec::Lps(Moduli { young, poisson });
    let young = |e| LawSpec::Pmb(PmbStiffness::Young(e));
    vec![
        one("pmb", young(3.0), Influence::Constant),
        one(
            "pmb conical",
            LawSpec::Pmb(PmbStiffness::Bulk(2.0)),
            Influence::Conical,
        ),
        two("pmb mixed", young(3.0), young(1.0), Influence::Gaussian),
        one("lps", lps(3.0, 0.2), Influence::Inverse),
        one("lps auxetic", lps(3.0, -0.2), Influence::Constant),
        two(
            "lps mixed",
            lps(3.0, 0.2),
            lps(1.0, 0.4),
            Influence::Gaussian,
        ),
        one(
            "lps as typed",
            LawSpec::LpsAsTyped {
                bulk: 2.0,
                shear: 1.0,
            },
            Influence::Inverse,
        ),
        one(
            "eam-like",
            LawSpec::EamLike {
                pair: 20.0,
                volume: 1.0,
            },
            Influence::CubicSpline,
        ),
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            ..one("elastic-plastic", plastic(0.2, 0.3), Influence::Inverse)
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            ..two(
                "plastic mixed",
                plastic(0.3, 0.0),
                plastic(0.2, 1.0),
                Influence::Gaussian,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "position-aware",
                LawSpec::named("position_aware", elastic(3.0, 0.2)),
                LawSpec::named("position_aware", elastic(1.0, 0.4)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..one(
                "bond rotation",
                LawSpec::named("bond_rotation", elastic(3.0, 0.1)),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "bond rotation mixed",
                LawSpec::named("bond_rotation", elastic(3.0, 0.2)),
                LawSpec::named("bond_rotation", elastic(1.0, -0.3)),
                Influence::Conical,
            )
        },
        one("viscoelastic", relaxing(0.5), Influence::Conical),
        two(
            "viscoelastic mixed",
            relaxing(0.5),
            relaxing(0.1),
            Influence::Inverse,
        ),
        Material {
            lives: |d, _| d > 1,
            ..one(
                "correspondence",
                correspondence(3.0, "linear"),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "neo-hookean mixed",
                correspondence(3.0, "neo_hookean"),
                correspondence(1.0, "neo_hookean"),
                Influence::Conical,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            potential: false,
            ..one(
                "hypoelastic",
                LawSpec::named("hypoelastic", elastic(3.0, 0.3)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            ..two(
                "mooney-rivlin mixed",
                correspondence(3.0, "mooney_rivlin"),
                correspondence(1.0, "mooney_rivlin"),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            ..two(
                "of written energies",
                of_energy("0.6*(I1*J^(-2/3) - 3) + 0.2*(I1*J^(-2/3) - 3)^2 + 1.2*(J - 1)^2"),
                of_energy("0.2*(I1 - 3 - 2*ln(J)) + 0.1*(I2 - 3 - 4*ln(J)) + 0.3*ln(J)^2"),
                Influence::Conical,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            potential: false,
            ..two(
                "metal and soil",
                flowing(0.06, 0.3, 0.0),
                flowing(0.08, 0.1, 0.3),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            potential: false,
            ..one(
                "metal under impact",
                shocked(flowing(0.06, 0.3, 0.0)),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "bonds of rubber",
                of_bonds(correspondence(3.0, "neo_hookean")),
                of_bonds(correspondence(1.0, "neo_hookean")),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, plane| d == 3 || (d == 2 && plane == Plane::Strain),
            potential: false,
            ..one(
                "bonds of metal",
                of_bonds(flowing(0.06, 0.3, 0.0)),
                Influence::Constant,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "plies",
                ply(3.0, [1.0, 2.0, 0.0]),
                ply(2.0, [2.0, -1.0, 0.0]),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..two(
                "wound",
                bent(of_bonds(ply(3.0, [1.0, 0.0, 0.0]))),
                of_bonds(ply(2.0, [2.0, -1.0, 0.0])),
                Influence::Inverse,
            )
        },
        Material {
            lives: |d, _| d > 1,
            ..one(
                "bonds of a ply",
                of_bonds(ply(3.0, [1.0, 2.0, 0.0])),
                Influence::Constant,
            )
        },
        Material {
            fracture: Some(3.0),
            ..one("softening", softening(3.0), Influence::Constant)
        },
        one(
            "thermoelastic",
            LawSpec::named("thermoelastic", Parameters::numbers(&[("young", 3.0)])),
            Influence::Constant,
        ),
        two(
            "thermoelastic solids",
            LawSpec::named("thermoelastic_solid", elastic(3.0, 0.2)),
            LawSpec::named("thermoelastic_solid", elastic(1.0, 0.4)),
            Influence::Inverse,
        ),
        two(
            "a user's, mixed",
            stiffening(3.0, 4.0),
            stiffening(1.0, 0.0),
            Influence::Inverse,
        ),
        Material {
            fracture: Some(3.0),
            ..two(
                "softening mixed",
                softening(3.0),
                softening(1.0),
                Influence::Gaussian,
            )
        },
    ]
}

/// A lattice with a small family and a plane state.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub kind: LatticeKind,
    pub plane: Plane,
    pub ratio: u32,
    pub cells: [usize; 3],
}

/// Every lattice; both plane states.
pub fn places() -> Vec<Place> {
    let place = |kind, plane, ratio, cells| Place {
        kind,
        plane,
        ratio,
        cells,
    };
    use LatticeKind::*;
    vec![
        place(Chain, Plane::Stress, 3, [21, 1, 1]),
        place(Square, Plane::Stress, 3, [7, 6, 1]),
        place(Square, Plane::Strain, 2, [6, 7, 1]),
        place(Triangular, Plane::Strain, 3, [7, 4, 1]),
        place(Triangular, Plane::Stress, 2, [7, 4, 1]),
        place(Cubic, Plane::Stress, 3, [5, 4, 4]),
        place(Bcc, Plane::Stress, 2, [4, 3, 4]),
        place(Fcc, Plane::Stress, 1, [3, 4, 3]),
        place(Diamond, Plane::Stress, 1, [3, 2, 2]),
    ]
}

/// A material somewhere.
#[derive(Debug, Clone)]
pub struct Case {
    pub material: Material,
    pub place: Place,
}

/// All materials on all lattices.
pub fn cases() -> Vec<Case> {
    let mut all = vec![];
    for place in places() {
        let lives = |m: &Material| (m.lives)(place.kind.dimension(), place.plane);
        for material in materials().into_iter().filter(lives) {
            all.push(Case { material, place });
        }
    }
    all
}

impl Material {
    /// Has it the constants of an isotropic solid?
    pub fn is_isotropic(&self) -> bool {
        let plies = |law: &LawSpec| matches!(law, LawSpec::Named(law) if law.name == "anisotropic");
        !self.laws.iter().any(plies)
    }
}

impl Case {
    pub fn of(name: &str, place: Place) -> Case {
        let material = materials().into_iter().find(|m| m.name == name).unwrap();
        Case { material, place }
    }

    pub fn name(&self) -> String {
        format!("{} on {:?}", self.material.name, self.place)
    }

    /// Number of dimensions.
    pub fn d(&self) -> usize {
        self.place.kind.dimension()
    }

    /// A quiet body that never breaks.
    pub fn spec(&self) -> Spec {
        let Place {
            kind,
            plane,
            ratio,
            cells,
        } = self.place;
        let mut quarters = vec![];
        for z in 0..cells[2] as i32 {
            for y in 0..cells[1] as i32 {
                for x in 0..cells[0] as i32 {
                    for b in kind.basis() {
                        quarters.push([4 * x + b[0], 4 * y + b[1], 4 * z + b[2]]);
                    }
                }
            }
        }
        let d = kind.dimension();
        let middle = 0.5 * H * cells[0] as f64 - 0.1 * H;
        let half = |sign: f64| {
            Members::Region(Region::HalfSpace {
                point: [middle, 0.0, 0.0],
                normal: [sign, 0.0, 0.0],
            })
        };
        let two = self.material.laws.len() == 2;
        let sets = if two {
            vec![("left", half(1.0)), ("right", half(-1.0))]
        } else {
            vec![]
        };
        Spec {
            bonded: None,
            boltzmann: 1.0,
            thermal: None,
            fields: None,
            probes: vec![],
            title: self.name(),
            dimension: d,
            plane,
            section: if d == 3 { 1.0 } else { 0.25 },
            body: BodySpec::Sites {
                kind,
                spacing: H,
                origin: [0.0; 3],
                quarters,
                volume: None,
            },
            sets: sets
                .into_iter()
                .map(|(name, members)| SetSpec {
                    name: name.into(),
                    members,
                })
                .collect(),
            materials: self
                .material
                .laws
                .iter()
                .zip(["left", "right"])
                .map(|(law, set)| MaterialSpec {
                    name: set.into(),
                    set: if two { set } else { "all" }.into(),
                    density: if set == "left" { RHO } else { 1.5 * RHO },
                    law: law.clone(),
                    fracture: self.material.fracture.map(|s| FractureSpec {
                        criterion: Criterion::Stretch(s),
                        alpha: 0.0,
                        rate: None,
                        fatigue: None,
                    }),
                })
                .collect(),
            interface: InterfaceRule::Series,
            interfaces: vec![],
            pairs: vec![],
            potentials: vec![],
            mixing: None,
            toughness: vec![],
            release: Release::AtOnce,
            horizon: Horizon::Ratio(ratio),
            volume_scaling: true,
            calibration: Calibration::Discrete,
            influence: self.material.influence,
            periodic: [None; 3],
            surface: None,
            bonds: vec![],
            precracks: vec![],
            contact: None,
            initial: vec![],
            conditions: vec![],
            indenters: vec![],
            transfers: vec![],
            family: FamilyChoice::Auto,
            preload: None,
            own_horizon: None,
            schedule: Schedule {
                steps: 0,
                time_step: TimeStep::Fraction(0.5),
                force_unstable: true,
                stepper: Stepper::Verlet,
            },
        }
    }

    /// The same in a periodic box of whole cells.
    pub fn periodic(&self) -> Spec {
        let mut spec = self.spec();
        for a in 0..self.d() {
            spec.periodic[a] = Some(H * self.place.kind.edges()[a] * self.place.cells[a] as f64);
        }
        spec
    }
}

/// Materials that break easily, with memory.
pub fn breaking(spec: &mut Spec, s00: f64) {
    for m in &mut spec.materials {
        m.fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(s00),
            alpha: 0.25,
            rate: None,
            fatigue: None,
        });
    }
}

pub const CONTACT: ContactSpec = ContactSpec {
    bonded: 0.9,
    free: 1.35,
    stiffness: ContactStiffness::Laws,
    friction: None,
};

/// With the laws of the engine, and that of [`crate::own_law`].
pub fn build(spec: &Spec, options: Options) -> Result<Box<dyn Simulation>, BuildError> {
    build_with(
        spec,
        options,
        &Shelf::standard().with::<Bonds<Stiffening, 1>>(),
    )
}

pub fn made(spec: &Spec) -> Box<dyn Simulation> {
    build(spec, Options::default()).unwrap()
}

/// Built without a look at the stable step; for bodies that do not move, with a step as good as any.
pub fn at_rest(spec: &Spec) -> Box<dyn Simulation> {
    let mut spec = spec.clone();
    spec.schedule.time_step = TimeStep::Fixed(1e-3);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(&spec, options).unwrap()
}

pub fn e(source: &str) -> Expression {
    Expression::parse(source, &[]).unwrap()
}

/// Numbers in ±1, the same every time (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// `n` vectors in the first `d` axes.
    pub fn vectors(&mut self, n: usize, d: usize, amplitude: f64) -> Vec<Point> {
        (0..n)
            .map(|_| std::array::from_fn(|a| if a < d { amplitude * self.next() } else { 0.0 }))
            .collect()
    }
}

/// A rotation by a large angle (a reflection on the line).
pub fn rotation(d: usize) -> [[f64; 3]; 3] {
    let (s, c) = 2.3f64.sin_cos();
    match d {
        1 => [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        2 => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
        _ => {
            // Rodrigues about an axis that is no lattice direction
            let n = {
                let n: [f64; 3] = [0.3, -0.5, 0.9];
                let l = dot(&n, &n).sqrt();
                n.map(|c| c / l)
            };
            let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
            std::array::from_fn(|a| {
                std::array::from_fn(|b| {
                    (a == b) as u8 as f64 * c + s * cross[a][b] + (1.0 - c) * n[a] * n[b]
                })
            })
        }
    }
}

pub fn times(m: &[[f64; 3]; 3], x: &Point) -> Point {
    std::array::from_fn(|a| dot(&m[a], x))
}

pub fn dot(a: &Point, b: &Point) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// Largest component.
pub fn largest(v: &[Point]) -> f64 {
    v.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()))
}

/// Largest difference of components.
pub fn distance(a: &[Point], b: &[Point]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences: Vec<Point> = a
        .iter()
        .zip(b)
        .map(|(a, b)| std::array::from_fn(|k| a[k] - b[k]))
        .collect();
    // not a number must not hide
    assert!(differences.iter().flatten().all(|c| c.is_finite()));
    largest(&differences)
}

/// Move some steps.
pub fn steps(sim: &mut dyn Simulation, n: usize) {
    for _ in 0..n {
        sim.step().unwrap();
    }
}
