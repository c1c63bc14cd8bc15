//! Crystals of fans and of decks with a basis, against LAMMPS (`verify/phonons/many_body.py`) and against themselves by other ways.

use num_complex::Complex64;
use peridyne::expression::Expression;
use peridyne::law::many_body::stillinger_weber::StillingerWeber;
use peridyne::law::many_body::tersoff::Tersoff;
use peridyne::law::potential::cut::{Cut, Ends};
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::potential::mixture::Mixture;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use peridyne_theory::crystal::arrangement::{arrangement, bravais};
use peridyne_theory::crystal::{Atom, Crystal, CrystalError};
use peridyne_theory::lattice_dynamics::lattice_dynamics;
use peridyne_theory::upscale::card::{Card, card};
use peridyne_theory::upscale::{
    Keep, Rule, UpscaleError, crystal, equilibrium_spacing, lattice, upscale, upscale_keeping,
};
use std::f64::consts::TAU;

/// GPa in eV/Å³.
const GPA: f64 = 1.0 / 160.2176634;

/// Rows of a file of LAMMPS, with kinds for the elements.
fn rows(text: &str, width: usize, elements: &[&str]) -> Vec<Vec<f64>> {
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or(""));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    let kind = |w: &str| elements.iter().position(|e| *e == w).map(|n| n as f64);
    words
        .chunks(width + 3)
        .filter_map(|entry| {
            let mut row = entry[..3]
                .iter()
                .map(|w| kind(w))
                .collect::<Option<Vec<f64>>>()?;
            row.extend(entry[3..].iter().map(|w| w.parse::<f64>().unwrap()));
            Some(row)
        })
        .collect()
}

fn silicon() -> PotentialSpec {
    let text = include_str!("../../../verify/lammps/fans/Si.sw");
    PotentialSpec::of_entries::<StillingerWeber>(rows(text, 11, &["Si"])).unwrap()
}

fn tersoff(text: &str, elements: &[&str]) -> PotentialSpec {
    PotentialSpec::of_entries::<Tersoff>(rows(text, 14, elements)).unwrap()
}

/// A block of so many cells whose sets are materials with these masses and laws.
fn body(
    kind: LatticeKind,
    spacing: f64,
    cells: f64,
    made: &[(Members, f64, PotentialSpec)],
) -> Spec {
    let high = kind.edges().map(|e| spacing * (e * cells - 0.125));
    let region = Region::Block {
        low: [-0.1 * spacing; 3],
        high,
    };
    let lattice = BodySpec::Lattice {
        kind,
        spacing,
        origin: [0.0; 3],
        region,
        perturb: None,
    };
    let volume = kind.site_volume() * spacing.powi(kind.dimension() as i32);
    let law = LawSpec::Atoms(made[0].2.clone());
    let mut spec = Spec::new(kind.dimension(), lattice, made[0].1 / volume, law);
    if made.len() > 1 {
        spec.materials.clear();
        for (n, (members, mass, potential)) in made.iter().enumerate() {
            let name = format!("m{n}");
            spec.sets.push(SetSpec {
                name: name.clone(),
                members: members.clone(),
            });
            spec.materials.push(MaterialSpec {
                set: name.clone(),
                name,
                density: mass / volume,
                law: LawSpec::Atoms(potential.clone()),
                fracture: None,
            });
        }
    }
    spec
}

fn diamond(spacing: f64, mass: f64, potential: PotentialSpec) -> Spec {
    body(
        LatticeKind::Diamond,
        spacing,
        3.0,
        &[(Members::All, mass, potential)],
    )
}

/// Silicon carbide: the second four sites of diamond are the other element.
fn carbide(spacing: f64, masses: [f64; 2]) -> Spec {
    let text = include_str!("../../../verify/lammps/fans/SiC.tersoff");
    let potential = tersoff(text, &["Si", "C"]);
    let basis = |n: std::ops::Range<usize>| Members::Basis(n.collect());
    let made = [
        (basis(0..4), masses[0], potential.clone()),
        (basis(4..8), masses[1], potential),
    ];
    body(LatticeKind::Diamond, spacing, 3.0, &made)
}

/// Waves, pressure and elastic constants of LAMMPS.
fn as_lammps(csv: &str, spec: impl Fn(f64, [f64; 2]) -> Spec) -> Crystal<3> {
    let number = |l: &str| -> Vec<f64> { l.split(',').map(|x| x.parse().unwrap()).collect() };
    let mut lines = csv.lines().skip(1).map(number);
    let first = lines.next().unwrap();
    let edge = first[0];
    let (found, reference) = crystal::<3>(&spec(edge, [first[1], first[2]])).unwrap();
    assert_eq!(found.basis.len(), 2);
    assert!(found.residual() < 1e-12, "{}", found.residual());
    let bar = 1e-4 * GPA;
    let pressure = reference.unwrap().pressure;
    assert!(
        (pressure / bar - first[3]).abs() < 1e-3,
        "{} {}",
        pressure / bar,
        first[3]
    );
    let relaxed = found.stress_strain().unwrap().cubic(1e-9).unwrap();
    let mut rigid = found.rigid_elastic_constants();
    for (a, b) in [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 5)] {
        // B of C under a pressure P
        rigid.c[a][b] -= pressure;
    }
    let rigid = [rigid.c[0][0], rigid.c[0][1] + pressure, rigid.c[3][3]];
    let all = [relaxed.c11, relaxed.c12, relaxed.c44]
        .into_iter()
        .chain(rigid);
    for (x, y) in all.zip(&first[4..10]) {
        assert!((x / GPA / y - 1.0).abs() < 1e-5, "{} {y}", x / GPA);
    }
    let mut most = 0.0f64;
    for line in lines {
        let k: [f64; 3] = std::array::from_fn(|a| TAU / edge * line[a]);
        let waves = found.squares(k);
        most = waves.iter().fold(most, |m, w| m.max(*w));
        assert_eq!(waves.len(), 6);
        for (x, y) in waves.iter().zip(&line[3..]) {
            assert!((x - y).abs() < 1e-6 * most, "{k:?}: {x} {y}");
        }
    }
    assert!(most > 1.0);
    found
}

#[test]
fn silicon_of_stillinger_and_weber() {
    let csv = include_str!("../../../verify/phonons/sw_silicon.csv");
    let found = as_lammps(csv, |edge, [mass, _]| diamond(edge, mass, silicon()));
    // Cowley 1988, in GPa
    let c = found.elastic_constants().unwrap().cubic(1e-9).unwrap();
    for (x, y) in [(c.c11, 151.4), (c.c12, 76.4), (c.c44, 56.4)] {
        assert!((x / GPA - y).abs() < 0.06, "{} {y}", x / GPA);
    }
    // all waves of the zone oscillate, and the bound is one
    assert_eq!(found.instability(6), None);
    assert!(found.bound() <= found.largest(6).time_step());
}

#[test]
fn silicon_of_tersoff() {
    let csv = include_str!("../../../verify/phonons/tersoff_silicon.csv");
    let text = include_str!("../../../verify/lammps/fans/Si.tersoff");
    as_lammps(csv, |edge, [mass, _]| {
        diamond(edge, mass, tersoff(text, &["Si"]))
    });
}

#[test]
fn silicon_carbide_of_a_deck_of_two_materials() {
    let csv = include_str!("../../../verify/phonons/tersoff_carbide.csv");
    as_lammps(csv, carbide);
}

#[test]
fn series_and_slopes_are_those_of_the_matrix() {
    let (found, _) = crystal::<3>(&diamond(5.431, 1.0, silicon())).unwrap();
    let n = [2.0 / 3.0, 1.0 / 3.0, -2.0 / 3.0];
    let k = 0.3f64;
    let wave = n.map(|x| x * k);
    let exact = found.dynamical_matrix(wave);
    let series = found.dynamical_series(n, 24);
    let h = 1e-4;
    for i in 0..6 {
        for j in 0..6 {
            let sum: Complex64 = series
                .iter()
                .enumerate()
                .map(|(q, m)| m.get(i, j) * k.powi(q as i32))
                .sum();
            assert!((sum - exact.get(i, j)).norm() < 1e-10, "{i} {j}");
            for axis in 0..3 {
                let at = |s: f64| {
                    let mut moved = wave;
                    moved[axis] += s * h;
                    found.dynamical_matrix(moved).get(i, j)
                };
                let far = at(2.0) - at(-2.0);
                let slope = (8.0 * (at(1.0) - at(-1.0)) - far) / (12.0 * h);
                let own = found.dynamical_slope(wave, axis).get(i, j);
                assert!((slope - own).norm() < 1e-8, "{i} {j} {axis}: {slope} {own}");
            }
        }
    }
    // long waves are those of the relaxed constants
    for n in [[1.0, 0.0, 0.0], n] {
        let small = 1e-3;
        let speeds = found.sound(n).unwrap();
        for (w, c) in found.squares(n.map(|x| x * small)).iter().zip(speeds) {
            assert!((w / (small * small) / c - 1.0).abs() < 1e-5, "{w} {c}");
        }
    }
}

#[test]
fn a_turned_crystal_has_the_same_waves() {
    let (found, _) = crystal::<3>(&diamond(5.431, 1.0, silicon())).unwrap();
    let (c, s) = (0.8, 0.6);
    let r = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    let turned = found.rotated(r);
    let k = [0.3, -0.2, 0.7];
    let there = std::array::from_fn(|i| (0..3).map(|j| r[i][j] * k[j]).sum());
    for (x, y) in found.squares(k).iter().zip(turned.squares(there)) {
        assert!((x - y).abs() < 1e-12, "{x} {y}");
    }
}

#[test]
fn silicon_rests_where_its_constants_say() {
    let mut spec = diamond(1.0, 1.0, silicon());
    // Stillinger & Weber 1985: the nearest distance of the crystal is 2^(1/6) σ
    let edge = 2f64.powf(1.0 / 6.0) * 2.0951 * 4.0 / 3f64.sqrt();
    let found = equilibrium_spacing(&spec).unwrap();
    assert!((found / edge - 1.0).abs() < 1e-4, "{found} {edge}");
    spec = diamond(found, 1.0, silicon());
    let reference = crystal::<3>(&spec).unwrap().1.unwrap();
    assert!(reference.pressure.abs() < 1e-12);
    assert!(
        (reference.energy + 2.0 * 2.1683).abs() < 1e-4,
        "{}",
        reference.energy
    );
}

/// Upscaled twice: the same constants and density, half of all frequencies at half of all wave vectors.
fn twice_as_large(spec: &Spec) -> Card {
    let (coarse, rule) = upscale(spec, 2).unwrap();
    assert_eq!(rule, Rule::Shells);
    let ((a, ra), (b, rb)) = (crystal::<3>(spec).unwrap(), crystal::<3>(&coarse).unwrap());
    assert_eq!(a.basis.len(), b.basis.len());
    assert!((b.density() / a.density() - 1.0).abs() < 1e-12);
    let pressures = [ra, rb].map(|r| r.unwrap().pressure);
    let size = a.elastic_constants().unwrap().c[0][0];
    assert!((pressures[0] - pressures[1]).abs() < 1e-12 * size);
    let (fine, large) = (
        a.elastic_constants().unwrap(),
        b.elastic_constants().unwrap(),
    );
    for (x, y) in fine.c.iter().flatten().zip(large.c.iter().flatten()) {
        assert!((x - y).abs() < 1e-10 * size, "{x} {y}");
    }
    let k = [0.31, -0.12, 0.54];
    let most = a.squares(k).into_iter().fold(0.0, f64::max);
    for (x, y) in a.squares(k).iter().zip(b.squares(k.map(|k| 0.5 * k))) {
        assert!((x - 4.0 * y).abs() < 1e-11 * most, "{x} {y}");
    }
    let card = card(spec, &coarse, 2, rule).unwrap();
    assert!(
        card.notes.iter().any(|n| n.contains("are lost")),
        "{:?}",
        card.notes
    );
    assert!(!card.energies.is_empty());
    for row in &card.energies {
        let scale = row.fine.abs().max(1e-6 * size);
        assert!((row.fine - row.coarse).abs() < 1e-9 * scale, "{row:?}");
    }
    card
}

#[test]
fn coarse_crystals_with_a_basis_are_larger_and_heavier() {
    let mut spec = diamond(5.431, 28.0855, silicon());
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let found = twice_as_large(&spec);
    // silicon against itself: the energy of a small strain is that of the constants with sites held
    let row = found
        .energies
        .iter()
        .find(|r| r.mode == "isotropic" && r.strain == 0.005);
    let c = crystal::<3>(&spec).unwrap().0.rigid_elastic_constants().c;
    let quadratic = 0.5 * 3.0 * (c[0][0] + 2.0 * c[0][1]) * 0.005f64.powi(2);
    assert!((row.unwrap().fine / quadratic - 1.0).abs() < 0.05);
    // sublattices by sites grow with the cell
    let basis = |n: &[usize]| Members::Basis(n.to_vec());
    twice_as_large(&salt(
        LatticeKind::Bcc,
        1.0,
        8.0,
        [basis(&[0]), basis(&[1])],
    ));
    // expressions do not
    let pairs = "floor(0.5*x) - 2*floor(0.25*x)";
    let members = ["< 0.5", "> 0.5"].map(|is| text(&format!("{pairs} {is}")));
    let spec = salt(LatticeKind::Cubic, 1.0, 8.0, members);
    assert_eq!(arrangement::<3>(&spec).unwrap().sites.len(), 4);
    assert_eq!(
        upscale(&spec, 2).unwrap_err(),
        UpscaleError::OtherArrangement
    );
    let reach = upscale_keeping(&spec, 2, Some(Keep::Reach)).unwrap_err();
    assert_eq!(reach, UpscaleError::NoReach);
}

fn lj(i: usize, j: usize) -> LennardJones {
    let (epsilon, sigma) = [(0.2, 1.15), (1.4, 0.9), (0.3, 1.2)][i + j];
    LennardJones { epsilon, sigma }
}

const END: f64 = 1.9;

fn salt(kind: LatticeKind, spacing: f64, cells: f64, members: [Members; 2]) -> Spec {
    let ended = |i, j| PotentialSpec::of(lj(i, j)).ended(END, End::ShiftedForce);
    let [a, b] = members;
    let mut spec = body(
        kind,
        spacing,
        cells,
        &[(a, 1.3, ended(0, 0)), (b, 4.1, ended(1, 1))],
    );
    spec.interactions.potentials = vec![ActingSpec {
        potential: ended(0, 1),
        on: Acting::Between([0, 1]),
    }];
    spec
}

fn text(of: &str) -> Members {
    Members::Where(Expression::parse(of, &[]).unwrap())
}

/// A cubic lattice of half the edge, alternating: the cell is that of fcc with two atoms.
#[test]
fn rock_salt_of_an_expression() {
    let odd = "floor(x + 0.5) + floor(y + 0.5) + floor(z + 0.5) - 2*floor(0.5*(floor(x + 0.5) + floor(y + 0.5) + floor(z + 0.5)))";
    let members = [text(&format!("{odd} < 0.5")), text(&format!("{odd} > 0.5"))];
    let spec = salt(LatticeKind::Cubic, 1.0, 6.0, members);
    let found = arrangement::<3>(&spec).unwrap();
    assert_eq!(found.sites.len(), 2);
    let (kind, edge) = bravais(&found.cell).unwrap();
    assert_eq!(kind, LatticeKind::Fcc);
    assert!((edge - 2.0).abs() < 1e-12);
    // its waves are among those of the cubic cell of eight
    let mixture = Mixture::new(2, |i, j| {
        let ends = Ends {
            cutoff: END,
            end: End::ShiftedForce,
        };
        Some(Cut::new(lj(i, j), ends))
    });
    let atoms: Vec<Atom<3>> = (0..8)
        .map(|n| {
            let at = [n % 2, n / 2 % 2, n / 4];
            let kind = at.iter().sum::<usize>() % 2;
            Atom {
                place: at.map(|x| x as f64),
                kind,
                mass: [1.3, 4.1][kind],
            }
        })
        .collect();
    let cell = std::array::from_fn(|a| std::array::from_fn(|b| if a == b { 2.0 } else { 0.0 }));
    let (eight, energy) = Crystal::<3>::of_mixture(&mixture, cell, &atoms).unwrap();
    let (two, reference) = crystal::<3>(&spec).unwrap();
    assert!((reference.unwrap().energy - energy / 8.0).abs() < 1e-12);
    for k in [[0.0; 3], [0.4, 0.1, -0.7], [1.0, 0.5, 0.2]] {
        let all = eight.squares(k);
        for w in two.squares(k) {
            assert!(
                all.iter().any(|x| (x - w).abs() < 1e-9 * all[23]),
                "{k:?}: {w}"
            );
        }
    }
    let dynamics = lattice_dynamics(&spec, 1e-3, 2).unwrap();
    assert_eq!(dynamics.sites, 2);
    let names: Vec<&str> = dynamics
        .directions
        .iter()
        .map(|d| d.name.as_str())
        .collect();
    assert_eq!(names, ["Γ–X", "Γ–K", "Γ–L"]);
    assert_eq!(dynamics.path[0].branches.len(), 6);
}

#[test]
fn cells_of_decorated_lattices() {
    let basis = |n: &[usize]| Members::Basis(n.to_vec());
    let cell = |kind, members| {
        let found = arrangement::<3>(&salt(kind, 1.0, 4.0, members)).unwrap();
        let (kind, edge) = bravais(&found.cell).unwrap();
        let of = |m: usize| found.sites.iter().filter(|(_, k)| *k == m).count();
        (kind, (edge * 1e9).round() / 1e9, [of(0), of(1)])
    };
    let b2 = cell(LatticeKind::Bcc, [basis(&[0]), basis(&[1])]);
    assert_eq!(b2, (LatticeKind::Cubic, 1.0, [1, 1]));
    let l12 = cell(LatticeKind::Fcc, [basis(&[0]), basis(&[1, 2, 3])]);
    assert_eq!(l12, (LatticeKind::Cubic, 1.0, [1, 3]));
    let blende = cell(
        LatticeKind::Diamond,
        [basis(&[0, 1, 2, 3]), basis(&[4, 5, 6, 7])],
    );
    assert_eq!(blende, (LatticeKind::Fcc, 1.0, [1, 1]));
    // L1_0 is tetragonal: its cell is none of the lattices
    let members = [basis(&[0, 3]), basis(&[1, 2])];
    let spec = salt(LatticeKind::Fcc, 1.0, 4.0, members);
    let found = arrangement::<3>(&spec).unwrap();
    assert_eq!((found.sites.len(), bravais(&found.cell)), (2, None));
    let dynamics = lattice_dynamics(&spec, 1e-3, 2).unwrap();
    assert_eq!(dynamics.directions.len(), 4);
    // periodic bodies know what lies beyond their faces
    let mut small = salt(LatticeKind::Bcc, 1.0, 2.0, [basis(&[0]), basis(&[1])]);
    small.space.periodic = [Some(2.0); 3];
    assert_eq!(arrangement::<3>(&small).unwrap().sites.len(), 2);
}

#[test]
fn what_does_not_repeat_has_no_waves() {
    let drawn = SetSpec {
        name: "m0".into(),
        members: Members::Random { part: 0.5, seed: 3 },
    };
    let others = Members::Outside(vec!["m0".into()]);
    let mut spec = salt(LatticeKind::Bcc, 1.0, 5.0, [Members::All, others]);
    spec.sets[0] = drawn;
    let error = lattice_dynamics(&spec, 1e-3, 2).unwrap_err();
    assert_eq!(error, UpscaleError::Crystal(CrystalError::NotPeriodic));
    // fixed neighbours know pairs of one kind
    let mut fixed = diamond(5.431, 1.0, silicon());
    fixed.bonds.family = FamilyChoice::Stencil;
    let error = crystal::<3>(&fixed).unwrap_err();
    assert_eq!(error, UpscaleError::Crystal(CrystalError::FixedNeighbours));
    assert!(lattice(&fixed).is_ok());
}
