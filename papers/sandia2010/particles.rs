//! States and potentials of the experiments on particles.

use peridyne::law::number::Number;
use peridyne::law::potential::Potential;
use peridyne::law::terms::{OfSites, Sites};
use peridyne::run::Registry;
use peridyne::spec::{Parameter, Parameters, PotentialSpec};
use peridyne_fields::specimen::Random;
use peridyne_fields::{Cell, FieldsError, Frame, Kernel, Method, Shape};

use crate::Failure;

pub type Vector = [f64; 3];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

pub fn less(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn times(s: f64, a: Vector) -> Vector {
    a.map(|c| s * c)
}

pub fn size(of: &[f64]) -> f64 {
    crate::measure::largest(of.iter().map(|x| x.abs()))
}

pub fn failed(error: FieldsError) -> Failure {
    Failure::new(error.to_string())
}

/// A method with a localization function.
pub fn method(shape: Shape, width: f64) -> Result<Method, Failure> {
    Ok(Method::new(Kernel::new(shape, width).map_err(failed)?))
}

fn of_shelf(name: &str, parameters: Parameters) -> Result<Box<dyn Sites>, Failure> {
    let spec = PotentialSpec {
        name: name.into(),
        parameters,
        reach: f64::INFINITY,
    };
    let registry = Registry::standard();
    registry
        .sites(&spec)
        .map_err(|e| Failure::new(e.to_string()))
}

/// ε = 1, σ = 1, smooth to the third derivative where it ends.
pub fn lennard_jones() -> Result<Box<dyn Sites>, Failure> {
    let numbers = [
        ("epsilon", 1.0),
        ("sigma", 1.0),
        ("cutoff", 2.2),
        ("smooth_from", 1.2),
    ];
    let end = Parameter::Word("smooth".into());
    of_shelf(
        "lennard_jones",
        Parameters::numbers(&numbers).with("end", end),
    )
}

/// Silicon in units of ε and σ: Stillinger and Weber (1985).
pub const SILICON: [(&str, f64); 10] = [
    ("epsilon", 1.0),
    ("sigma", 1.0),
    ("a", 1.80),
    ("lambda", 21.0),
    ("gamma", 1.20),
    ("cos_theta0", -1.0 / 3.0),
    ("A", 7.049556277),
    ("B", 0.6022245584),
    ("p", 4.0),
    ("q", 0.0),
];

pub fn silicon() -> Result<Box<dyn Sites>, Failure> {
    of_shelf("stillinger_weber", Parameters::numbers(&SILICON))
}

/// The square-root model of Finnis and Sinclair: `φ = (c − r)⁴`, `f = (d − r)⁴`, `F = −√ρ`, all smooth.
#[derive(Clone)]
pub struct SquareRoot;

impl SquareRoot {
    const PAIR: f64 = 1.9;
    const DENSITY: f64 = 2.1;

    fn fourth<N: Number>(q: N, end: f64) -> N {
        q.sqrt().times(-1.0).plus(end).power(4)
    }
}

impl Potential for SquareRoot {
    const EMBEDDED: bool = true;

    fn cutoff(&self) -> f64 {
        Self::DENSITY
    }

    fn pair<N: Number>(&self, q: N) -> N {
        q.below(
            Self::PAIR * Self::PAIR,
            Self::fourth(q, Self::PAIR),
            N::constant(0.0),
        )
    }

    fn density<N: Number>(&self, q: N) -> N {
        Self::fourth(q, Self::DENSITY)
    }

    fn embedding<N: Number>(&self, density: N) -> N {
        density.sqrt().times(-1.0)
    }
}

pub fn square_root() -> OfSites<SquareRoot> {
    OfSites(SquareRoot)
}

/// Sites of a face-centred cube, and those of a diamond lattice, in quarters of the edge.
pub const FCC: [[u8; 3]; 4] = [[0, 0, 0], [2, 2, 0], [2, 0, 2], [0, 2, 2]];
pub const DIAMOND: [[u8; 3]; 8] = [
    [0, 0, 0],
    [2, 2, 0],
    [2, 0, 2],
    [0, 2, 2],
    [1, 1, 1],
    [3, 3, 1],
    [3, 1, 3],
    [1, 3, 3],
];

/// A periodic crystal of cubes with this edge; atoms are moved by up to `off`, and have velocities about a drift.
pub fn crystal(sites: &[[u8; 3]], cells: usize, edge: f64, off: f64) -> Result<Frame, Failure> {
    let mut random = Random(21);
    let mut position = vec![];
    for i in 0..cells.pow(3) {
        let cell = [i / (cells * cells), i / cells % cells, i % cells];
        for site in sites {
            let r = random.vector();
            position.push(std::array::from_fn(|a| {
                edge * (cell[a] as f64 + 0.25 * f64::from(site[a])) + off * r[a]
            }));
        }
    }
    let count = position.len();
    let velocity = |random: &mut Random| plus(random.vector(), [0.7, -0.4, 0.2]);
    Ok(Frame {
        cell: Cell::orthogonal([0.0; 3], [edge * cells as f64; 3], [true; 3]).map_err(failed)?,
        position,
        velocity: Some((0..count).map(|_| velocity(&mut random)).collect()),
        mass: (0..count).map(|_| 1.0 + 0.3 * random.signed()).collect(),
        kind: vec![0; count],
        time: None,
    })
}
