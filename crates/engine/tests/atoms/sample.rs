//! Potentials and bodies that the tests share.

use peridyne::law::many_body::stillinger_weber::StillingerWeber;
use peridyne::law::many_body::tersoff::Tersoff;
use peridyne::law::potential::Potential;
use peridyne::law::potential::born_mayer::BornMayer;
use peridyne::law::potential::buckingham::Buckingham;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::potential::mei::{EamForm, Mei};
use peridyne::law::potential::morse::Morse;
use peridyne::law::potential::tabulated::Eam;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// The copper-like constants of seleson2014 Table 1, with lengths in nearest distances `h` and shells of `kind`.
pub fn mei(h: f64, shells: Vec<(f64, f64)>) -> EamForm {
    EamForm {
        cohesive: 3.54,
        pair: 0.1217,
        alpha: 5.082,
        beta: 5.85,
        gamma: 6.82054,
        lambda: 12.06,
        density: [0.14095, -1.93222, 9.60043, -21.23718, 20.18581, -5.81656],
        density_scale: 1.0 / 12.0,
        pair_length: 1.0,
        density_length: 1.0,
        near: 1.7,
        cutoff: 1.95,
        shells,
        nearest: h,
        shell_scale: 1.0,
    }
}

pub const FCC_SHELLS: [(f64, f64); 4] = [
    (12.0, 1.0),
    (6.0, std::f64::consts::SQRT_2),
    (24.0, 1.7320508075688772),
    (12.0, 2.0),
];

/// Every form and every end, all with the cut-off 1.95 and a least energy near the distance 1.
pub fn potentials() -> Vec<(String, PotentialSpec)> {
    let cutoff = 1.95;
    let pairs = [
        (
            "born_mayer",
            PotentialSpec::of(BornMayer {
                strength: 0.56,
                sigma: 1.0,
                range: 0.09,
                dispersion: 1.1,
                eighth: 0.05,
            }),
        ),
        (
            "lj",
            PotentialSpec::of(LennardJones {
                epsilon: 1.2,
                sigma: 0.9,
            }),
        ),
        (
            "morse",
            PotentialSpec::of(Morse {
                depth: 0.7,
                alpha: 4.0,
                distance: 1.02,
            }),
        ),
        (
            "buckingham",
            PotentialSpec::of(Buckingham {
                strength: 4e4,
                range: 0.09,
                dispersion: 1.1,
            }),
        ),
    ];
    let ends = [
        ("truncated", End::Truncated),
        ("shifted", End::Shifted),
        ("shifted force", End::ShiftedForce),
        ("smooth", End::Smooth(1.6)),
    ];
    let mut all = vec![];
    for (name, form) in pairs {
        for (end_name, end) in ends {
            all.push((
                format!("{name}, {end_name}"),
                form.clone().ended(cutoff, end),
            ));
        }
    }
    let constants = mei(1.0, FCC_SHELLS.to_vec());
    let closed = Mei::new(constants.clone());
    let (n, dr, drho) = (800, 1.95 / 799.0, 3.0 / 799.0);
    let sample = |f: &dyn Fn(f64) -> f64, step: f64| -> Vec<f64> {
        (0..n).map(|m| f(step * (m as f64).max(40.0))).collect()
    };
    let table = TableSpec {
        density_step: drho,
        embedding: sample(&|rho| closed.embedding(rho), drho),
        step: dr,
        density: sample(&|r| closed.density(r * r), dr),
        pair: sample(&|r| r * closed.pair(r * r), dr),
        cutoff: 1.95,
        element: "X".into(),
        partners: vec![],
    };
    for (name, form) in [
        ("closed form", PotentialSpec::of(constants)),
        ("table", PotentialSpec::of(Eam::new(table))),
    ] {
        all.push((format!("eam, {name}"), form));
    }
    all
}

/// A lattice block of `cells` with nearest distance `nearest`.
pub fn block(kind: LatticeKind, nearest: f64, cells: usize) -> BodySpec {
    let d = kind.dimension();
    let mut quarters = vec![];
    for i in 0..cells.pow(d as u32) {
        let cell: [usize; 3] = std::array::from_fn(|a| {
            if a < d {
                i / cells.pow(a as u32) % cells
            } else {
                0
            }
        });
        for b in kind.basis() {
            quarters.push(std::array::from_fn(|a| 4 * cell[a] as i32 + b[a]));
        }
    }
    BodySpec::Sites {
        kind,
        spacing: nearest / kind.nearest(),
        origin: [0.0; 3],
        quarters,
        volume: None,
    }
}

/// Atoms on that block.
pub fn atoms(
    kind: LatticeKind,
    cells: usize,
    potential: &PotentialSpec,
    family: FamilyChoice,
    periodic: bool,
) -> Spec {
    let d = kind.dimension();
    let mut spec = Spec::new(
        d,
        block(kind, 1.02, cells),
        1.3,
        LawSpec::Atoms(potential.clone()),
    );
    let a = 1.02 / kind.nearest();
    spec.bonds.family = family;
    // neighbours of the lattice that the cut-off leaves, and some more
    spec.bonds.horizon = Horizon::Length(2.3);
    if periodic {
        spec.space.periodic =
            std::array::from_fn(|x| (x < d).then_some(a * kind.edges()[x] * cells as f64));
    }
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec.run.schedule.force_unstable = true;
    spec
}

/// Stillinger & Weber 1985, in eV and Å.
const SILICON: [(&str, f64); 10] = [
    ("epsilon", 2.1683),
    ("sigma", 2.0951),
    ("a", 1.80),
    ("lambda", 21.0),
    ("gamma", 1.20),
    ("cos_theta0", -0.333333333333),
    ("A", 7.049556277),
    ("B", 0.6022245584),
    ("p", 4.0),
    ("q", 0.0),
];
/// m, γ, λ₃, c, d, cos θ₀, n, β, λ₂, B, R, D, λ₁, A of Si and C (Tersoff 1988, 1989); two kinds in all triples, one with a λ₃ and one with
/// a cut-off of its own.
const SI: [f64; 14] = [
    3.0, 1.0, 1.3258, 4.8381, 2.0417, 0.0, 22.956, 0.33675, 1.3258, 95.373, 3.0, 0.2, 3.2394,
    3264.7,
];
const CARBON: [f64; 14] = [
    3.0, 1.0, 0.0, 38049.0, 4.3484, -0.57058, 0.72751, 1.5724e-7, 2.2119, 346.7, 1.95, 0.15,
    3.4879, 1393.6,
];
const MIXED: [f64; 14] = [
    1.0, 1.0, 0.4, 38049.0, 4.3484, -0.57058, 0.72751, 1.5724e-7, 1.97205, 395.126, 2.36, 0.15,
    2.9839, 1597.3111,
];

fn two_kinds() -> PotentialSpec {
    let mut rows = vec![];
    for n in 0..8 {
        let [i, j, k] = [n / 4, n / 2 % 2, n % 2];
        let mut constants = match (i, j) {
            (0, 0) => SI,
            (1, 1) => CARBON,
            _ => MIXED,
        };
        if j != k {
            constants[10] = 2.5;
        }
        let mut row = vec![i as f64, j as f64, k as f64];
        row.extend(constants);
        rows.push(row);
    }
    PotentialSpec::of_entries::<Tersoff>(rows).unwrap()
}

/// Name, potential, edge of the lattice and number of kinds.
pub fn many_body() -> Vec<(&'static str, PotentialSpec, f64, usize)> {
    let weber = PotentialSpec::of_many_body::<StillingerWeber>(&SILICON).unwrap();
    let mut powers = SILICON;
    powers[8].1 = 4.2;
    powers[9].1 = 0.1;
    let powers = PotentialSpec::of_many_body::<StillingerWeber>(&powers).unwrap();
    let row = [&[0.0; 3][..], &SI].concat();
    let tersoff = PotentialSpec::of_entries::<Tersoff>(vec![row]).unwrap();
    vec![
        ("stillinger_weber", weber, 5.431, 1),
        ("any powers", powers, 5.431, 1),
        ("tersoff", tersoff, 5.432, 1),
        ("two kinds", two_kinds(), 4.8, 2),
    ]
}

/// Atoms on so many cells; of two kinds, every other plane is of the second.
pub fn crystal(
    potential: &PotentialSpec,
    edge: f64,
    kinds: usize,
    cells: i32,
    periodic: bool,
) -> Spec {
    let mut position = vec![];
    let mut mark = vec![];
    for n in 0..cells.pow(3) {
        let cell = [n % cells, n / cells % cells, n / cells / cells];
        for (s, site) in LatticeKind::Diamond.basis().iter().enumerate() {
            let at = |a: usize| edge * (f64::from(cell[a]) + 0.25 * f64::from(site[a]));
            position.push(std::array::from_fn(at));
            mark.push(if kinds == 2 && s % 4 == 0 { 2 } else { 1 });
        }
    }
    let volume = vec![edge.powi(3) / 8.0; position.len()];
    let cloud = Cloud {
        position,
        volume,
        mark,
        ..Cloud::default()
    };
    let law = LawSpec::Atoms(potential.clone());
    let mut spec = Spec::new(3, BodySpec::Cloud(cloud), 1.0, law);
    let first = spec.materials[0].clone();
    if kinds == 2 {
        spec.materials.clear();
        for (mark, name, density) in [(1, "one", 1.0), (2, "two", 0.4)] {
            spec.sets.push(SetSpec {
                name: name.into(),
                members: Members::Mark(mark),
            });
            let mut material = first.clone();
            material.name = name.into();
            material.set = name.into();
            material.density = density;
            spec.materials.push(material);
        }
    }
    if periodic {
        spec.space.periodic = [Some(edge * f64::from(cells)); 3];
    }
    spec.run.schedule.time_step = TimeStep::Fixed(2e-3);
    spec.run.schedule.force_unstable = true;
    spec
}

/// A fixed sequence of numbers in ±½.
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }
}
