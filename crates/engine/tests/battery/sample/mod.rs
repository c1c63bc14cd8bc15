//! Small bodies of every material on every lattice.

mod materials;

use crate::own_law::Stiffening;
use peridyne::error::BuildError;
use peridyne::expression::Expression;
use peridyne::law::material::bonds::Bonds;
use peridyne::run::{Options, Registry, Simulation, build_with};
use peridyne::space::Point;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

pub use materials::{Material, materials};

/// Cell edge of all samples; not 1, so that missing powers show.
pub const H: f64 = 0.5;
pub const RHO: f64 = 2.0;

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
            title: self.name(),
            space: SpaceSpec {
                dimension: d,
                plane,
                section: if d == 3 { 1.0 } else { 0.25 },
                ..SpaceSpec::default()
            },
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
            bonds: BondsSpec {
                horizon: Horizon::Ratio(ratio),
                partial_volume_correction: true,
                influence: self.material.influence,
                ..BondsSpec::default()
            },
            interactions: InteractionsSpec::default(),
            damage: DamageSpec::default(),
            loading: LoadingSpec::default(),
            run: RunSpec {
                schedule: Schedule {
                    time_step: TimeStep::Fraction(0.5),
                    force_unstable: true,
                    ..Schedule::default()
                },
                ..RunSpec::default()
            },
        }
    }

    /// The same in a periodic box of whole cells.
    pub fn periodic(&self) -> Spec {
        let mut spec = self.spec();
        for a in 0..self.d() {
            spec.space.periodic[a] =
                Some(H * self.place.kind.edges()[a] * self.place.cells[a] as f64);
        }
        spec
    }
}

/// Materials that break easily, with memory.
pub fn breaking(spec: &mut Spec, s00: f64) {
    for m in &mut spec.materials {
        // bonds that softened to nothing bear nothing beyond
        let softens = matches!(&m.law, LawSpec::Named(law) if law.name == "softening");
        m.fracture = Some(FractureSpec {
            criterion: Criterion::Stretch(s00),
            alpha: if softens { 0.0 } else { 0.25 },
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
    cohesion: None,
    conductance: None,
};

/// With the laws of the engine, and that of [`crate::own_law`].
pub fn build(spec: &Spec, options: Options) -> Result<Box<dyn Simulation>, BuildError> {
    build_with(
        spec,
        options,
        &Registry::standard().with::<Bonds<Stiffening, 1>>(),
    )
}

pub fn made(spec: &Spec) -> Box<dyn Simulation> {
    build(spec, Options::default()).unwrap()
}

/// Built without a look at the stable step; for bodies that do not move, with a step as good as any.
pub fn at_rest(spec: &Spec) -> Box<dyn Simulation> {
    let mut spec = spec.clone();
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
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
