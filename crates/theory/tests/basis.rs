//! Waves of crystals with a basis of unlike atoms, against the forces of the engine under small displacements.

use num_complex::Complex64;
use peridyne::expression::Expression;
use peridyne::law::potential::Potential;
use peridyne::law::potential::cut::{Cut, Ends};
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::potential::mixture::Mixture;
use peridyne::law::potential::no_potential::NoPotential;
use peridyne::law::potential::tabulated::{Eam, Tabulated};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use peridyne_theory::crystal::Atom;
use peridyne_theory::crystal::Crystal;
use peridyne_theory::dispersion::hermitian::{Matrix, eigen};
use peridyne_theory::upscale::{self, Rule};

const CELLS: usize = 4;

/// A cubic cell with these sites (fractions of its edge) of two kinds, and its waves by both ways.
fn check<P: Potential>(
    name: &str,
    edge: f64,
    sites: &[([f64; 3], usize)],
    mixture: &Mixture<P>,
    own: [PotentialSpec; 2],
    across: Option<PotentialSpec>,
) {
    let masses = [1.3, 4.1];
    let atoms: Vec<Atom<3>> = { sites.iter() }
        .map(|(place, kind)| Atom {
            place: place.map(|c| c * edge),
            kind: *kind,
            mass: masses[*kind],
        })
        .collect();
    let cell = std::array::from_fn(|a| std::array::from_fn(|b| if a == b { edge } else { 0.0 }));
    let (crystal, energy) = Crystal::<3>::of_mixture(mixture, cell, &atoms).unwrap();
    assert!(crystal.residual() < 1e-11, "{name}: {}", crystal.residual());

    let (mut position, mut mark, mut at_cell) = (vec![], vec![], vec![]);
    for n in 0..CELLS.pow(3) {
        let c = [n % CELLS, n / CELLS % CELLS, n / CELLS / CELLS];
        for atom in &atoms {
            position.push(std::array::from_fn(|a| atom.place[a] + c[a] as f64 * edge));
            mark.push(atom.kind as i32);
            at_cell.push(c);
        }
    }
    let n = position.len();
    let cloud = Cloud {
        volume: vec![1.0; n],
        position,
        mark,
        ..Cloud::default()
    };
    let mut spec = Spec::new(
        3,
        BodySpec::Cloud(cloud),
        1.0,
        LawSpec::Atoms(own[0].clone()),
    );
    spec.space.periodic = [Some(edge * CELLS as f64); 3];
    spec.materials.clear();
    for (kind, potential) in own.into_iter().enumerate() {
        let name = ["light", "heavy"][kind].to_string();
        spec.sets.push(SetSpec {
            name: name.clone(),
            members: Members::Mark(kind as i32),
        });
        spec.materials.push(MaterialSpec {
            set: name.clone(),
            name,
            density: masses[kind],
            law: LawSpec::Atoms(potential),
            fracture: None,
        });
    }
    spec.interactions.potentials = across
        .into_iter()
        .map(|potential| ActingSpec {
            potential,
            on: Acting::Between([0, 1]),
        })
        .collect();
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut sim = build(&spec, options).unwrap_or_else(|e| panic!("{name}: {e}"));
    sim.start(true);
    let found = sim.ledger().unwrap().strain / CELLS.pow(3) as f64;
    assert!(
        (found - energy).abs() < 1e-11 * energy.abs(),
        "{name}: {found} {energy}"
    );

    // force constants by fourth-order differences
    let (s, h) = (atoms.len(), 1e-4);
    let mut constants = vec![];
    for t in 0..s {
        for b in 0..3 {
            let mut at = |x: f64| {
                let mut u = vec![[0.0; 3]; n];
                u[t][b] = x;
                sim.forces_under(&u)
            };
            let far = [2.0, 1.0, -1.0, -2.0].map(|x| at(x * h));
            let slope = |i: usize, a: usize| {
                (8.0 * (far[1][i][a] - far[2][i][a]) - (far[0][i][a] - far[3][i][a])) / (12.0 * h)
            };
            let column: Vec<[f64; 3]> = (0..n)
                .map(|i| std::array::from_fn(|a| -slope(i, a)))
                .collect();
            constants.push(column);
        }
    }
    for wave in [
        [0, 0, 0],
        [1, 0, 0],
        [2, 0, 0],
        [1, 1, 0],
        [1, 2, 3],
        [2, 2, 2],
    ] {
        let mut matrix = Matrix::zero(3 * s);
        for (column, values) in constants.iter().enumerate() {
            for (i, value) in values.iter().enumerate() {
                let turns: usize = (0..3).map(|a| wave[a] * at_cell[i][a]).sum();
                let phase = std::f64::consts::TAU * turns as f64 / CELLS as f64;
                let factor = Complex64::from_polar(1.0, phase);
                let mass = (atoms[i % s].mass * atoms[column / 3].mass).sqrt();
                for a in 0..3 {
                    matrix.add(3 * (i % s) + a, column, factor * (value[a] / mass));
                }
            }
        }
        let by_forces = eigen(&matrix).0;
        let k = wave.map(|w| std::f64::consts::TAU * w as f64 / (CELLS as f64 * edge));
        let waves = crystal.squares(k);
        let most = waves.iter().fold(0.0f64, |m, w| m.max(w.abs()));
        for (x, y) in by_forces.iter().zip(&waves) {
            assert!((x - y).abs() < 1e-6 * most, "{name}, {wave:?}: {x} {y}");
        }
        if wave == [0, 0, 0] {
            // three waves move the whole crystal, all others its atoms against each other
            let still = waves.iter().filter(|w| w.abs() < 1e-11 * most).count();
            assert_eq!(still, 3, "{name}: acoustic {waves:?}");
            let others = waves.iter().filter(|w| w.abs() > 1e-3 * most).count();
            assert_eq!(others, waves.len() - 3, "{name}: optical {waves:?}");
        }
    }
}

const CAESIUM_CHLORIDE: [([f64; 3], usize); 2] = [([0.0; 3], 0), ([0.5; 3], 1)];

const ROCK_SALT: [([f64; 3], usize); 8] = [
    ([0.0, 0.0, 0.0], 0),
    ([0.5, 0.5, 0.0], 0),
    ([0.5, 0.0, 0.5], 0),
    ([0.0, 0.5, 0.5], 0),
    ([0.5, 0.0, 0.0], 1),
    ([0.0, 0.5, 0.0], 1),
    ([0.0, 0.0, 0.5], 1),
    ([0.5, 0.5, 0.5], 1),
];

#[test]
fn rock_salt_of_pairs() {
    let constants = |i: usize, j: usize| match i + j {
        0 => (0.2, 1.15),
        1 => (1.4, 0.9),
        _ => (0.3, 1.2),
    };
    let ends = Ends {
        cutoff: 1.9,
        end: End::ShiftedForce,
    };
    let lj = |i, j| {
        let (epsilon, sigma) = constants(i, j);
        LennardJones { epsilon, sigma }
    };
    let mixture = Mixture::new(2, |i, j| Some(Cut::new(lj(i, j), ends)));
    let named = |i, j| PotentialSpec::of(lj(i, j)).ended(ends.cutoff, ends.end);
    let own = [named(0, 0), named(1, 1)];
    check(
        "rock salt",
        2.0,
        &ROCK_SALT,
        &mixture,
        own,
        Some(named(0, 1)),
    );
}

/// Two elements whose densities depend on both ends.
fn tables() -> [TableSpec; 2] {
    let (n, cutoff) = (2000, 2.3);
    let step = cutoff / (n - 1) as f64;
    let fade = |r: f64| (1.0 - (r / cutoff).powi(2)).powi(4);
    let table = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..n)
            .map(|m| f(step * m as f64) * fade(step * m as f64))
            .collect()
    };
    let pair = |a: f64| table(&|r| a * (-5.0 * (r - 1.0)).exp() * r);
    let density = |b: f64, decay: f64| table(&|r| b * (-decay * (r - 1.0)).exp());
    let one = |name: &str, other: &str, [a, own, from, c]: [f64; 4]| TableSpec {
        density_step: 0.005,
        embedding: (0..n).map(|m| -c * (0.005 * m as f64).sqrt()).collect(),
        step,
        density: density(own, 2.0),
        pair: pair(a),
        cutoff,
        element: name.into(),
        partners: vec![PartnerTable {
            element: other.into(),
            density: density(from, 2.5),
            pair: pair(1.1),
        }],
    };
    [
        one("Aa", "Bb", [1.0, 0.2, 0.35, 1.3]),
        one("Bb", "Aa", [0.9, 0.3, 0.15, 0.8]),
    ]
}

#[test]
fn caesium_chloride_of_an_alloy() {
    let tables = tables();
    let mixture = Mixture::new(2, |i, j| match i == j {
        true => Some(Tabulated::new(&tables[i])),
        false => Tabulated::between(&tables[i], &tables[j]),
    });
    let own = tables.clone().map(|t| PotentialSpec::of(Eam::new(t)));
    check("alloy", 1.25, &CAESIUM_CHLORIDE, &mixture, own, None);
}

/// Two kinds of atoms in turn on a chain whose neighbours stay neighbours.
fn diatomic(masses: [f64; 2], potentials: [PotentialSpec; 2], across: PotentialSpec) -> Spec {
    let low_high = Region::Block {
        low: [-0.1, 0.0, 0.0],
        high: [23.9, 0.0, 0.0],
    };
    let body = BodySpec::lattice(LatticeKind::Chain, 1.0, low_high);
    let mut spec = Spec::new(1, body, 1.0, LawSpec::Atoms(potentials[0].clone()));
    spec.space.periodic[0] = Some(24.0);
    spec.materials.clear();
    for (n, (density, potential)) in masses.into_iter().zip(potentials).enumerate() {
        let name = ["light", "heavy"][n].to_string();
        let of = format!("cos(3.14159265358979*x) {} 0", [">", "<"][n]);
        spec.sets.push(SetSpec {
            name: name.clone(),
            members: Members::Where(Expression::parse(&of, &[]).unwrap()),
        });
        spec.materials.push(MaterialSpec {
            set: name.clone(),
            name,
            density,
            law: LawSpec::Atoms(potential),
            fracture: None,
        });
    }
    spec.interactions.potentials = vec![ActingSpec {
        potential: across,
        on: Acting::Between([0, 1]),
    }];
    spec.bonds.family = FamilyChoice::Stencil;
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec
}

/// `φ″(1)/ε` of Lennard-Jones whose minimum is at 1.
const STIFFNESS: f64 = 72.0;

fn argon(epsilon: f64, rest: f64) -> PotentialSpec {
    let sigma = rest / 2f64.powf(1.0 / 6.0);
    PotentialSpec::of(LennardJones { epsilon, sigma })
}

/// Born and von Kármán 1912: `M m ω⁴ − 2 K (M + m) ω² + 2 K² (1 − cos 2ka) = 0` of springs K between unlike neighbours a apart.
#[test]
fn a_chain_of_two_kinds_on_fixed_neighbours() {
    let nothing = PotentialSpec::of(NoPotential);
    let (m, big, k) = (1.3, 4.1, 0.7 * STIFFNESS);
    let spec = diatomic([m, big], [nothing.clone(), nothing], argon(0.7, 1.0));
    let (crystal, reference) = upscale::crystal::<1>(&spec).unwrap();
    assert!((reference.unwrap().energy + 0.7).abs() < 1e-12);
    assert_eq!(crystal.basis.len(), 2);
    for wave in [0.0f64, 0.1, 0.7, 1.2, 1.5] {
        let sum = k * (1.0 / m + 1.0 / big);
        let root = (sum * sum - 2.0 * k * k / (m * big) * (1.0 - (2.0 * wave).cos())).sqrt();
        for (found, exact) in crystal.squares([wave]).iter().zip([sum - root, sum + root]) {
            assert!(
                (found - exact).abs() < 1e-12 * sum,
                "{wave}: {found} {exact}"
            );
        }
    }
    // second neighbours, of one kind each, are part of the model, whatever their distance is later
    let spec = diatomic(
        [m, big],
        [argon(0.3, 2.1), argon(0.5, 1.9)],
        argon(0.7, 1.0),
    );
    let (crystal, _) = upscale::crystal::<1>(&spec).unwrap();
    assert_eq!(crystal.bonds.len(), 8);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut sim = build(&spec, options).unwrap();
    sim.start(true);
    // force constants of the engine
    let (h, masses) = (1e-5, [m, big]);
    for wave in [0.3, 1.1] {
        let mut matrix = Matrix::zero(2);
        for from in 0..2 {
            let mut at = |x: f64| {
                let mut u = vec![[0.0; 3]; 24];
                u[from][0] = x;
                sim.forces_under(&u)
            };
            let far = [2.0, 1.0, -1.0, -2.0].map(|x| at(x * h));
            for i in 0..24 {
                let slope = (8.0 * (far[1][i][0] - far[2][i][0]) - (far[0][i][0] - far[3][i][0]))
                    / (12.0 * h);
                let apart = (i as f64 - from as f64 + 12.0).rem_euclid(24.0) - 12.0;
                let factor = Complex64::from_polar(1.0, -wave * apart);
                let mass = (masses[i % 2] * masses[from]).sqrt();
                matrix.add(i % 2, from, factor * (-slope / mass));
            }
        }
        for (x, y) in eigen(&matrix).0.iter().zip(crystal.squares([wave])) {
            assert!((x - y).abs() < 1e-8 * y.abs().max(1.0), "{wave}: {x} {y}");
        }
    }
    let stretches = peridyne_theory::gradient::nonlinear::of_spec(&spec, &[1.0], 2);
    assert_eq!(
        stretches.unwrap().len(),
        0,
        "the equation is that of one kind"
    );
    // kinds by an expression do not lie there as they lie here
    assert!(upscale::upscale(&spec, 2).is_err());
}

/// The coarse model of fixed neighbours has half the frequencies at half the wave vector.
#[test]
fn fixed_neighbours_of_two_kinds_have_a_coarse_model() {
    let mut spec = diatomic(
        [1.3, 4.1],
        [argon(0.3, 1.1), argon(0.5, 0.9)],
        argon(0.7, 1.0),
    );
    let cells = Region::Block {
        low: [-0.1; 3],
        high: [7.9; 3],
    };
    spec.space.dimension = 3;
    spec.body = BodySpec::lattice(LatticeKind::Bcc, 1.0, cells);
    spec.space.periodic = [Some(8.0); 3];
    spec.bonds.horizon = Horizon::Length(1.2);
    for (n, set) in spec.sets.iter_mut().enumerate() {
        set.members = Members::Basis(vec![n]);
    }
    let (fine, _) = upscale::crystal::<3>(&spec).unwrap();
    // eight unlike and six like neighbours of both
    assert_eq!(fine.bonds.len(), 28);
    let (coarse, rule) = upscale::upscale(&spec, 2).unwrap();
    assert_eq!(
        (rule, coarse.bonds.family),
        (Rule::Shells, FamilyChoice::Stencil)
    );
    let (large, _) = upscale::crystal::<3>(&coarse).unwrap();
    for wave in [[0.2, 0.0, 0.0], [0.9, 0.4, 2.1]] {
        let half = large.squares(wave.map(|k| 0.5 * k));
        for (x, y) in fine.squares(wave).iter().zip(half) {
            assert!(
                (0.25 * x - y).abs() < 1e-10 * x.abs().max(1.0),
                "{wave:?}: {x} {y}"
            );
        }
    }
}
