//! Small motions give the Hessian; a chain in the canonical ensemble has a closed form; errors are those of the noise.

use super::{Frames, Options, Thermal, ThermalError, thermal};
use crate::lattice_dynamics::{TERMS, lattice_dynamics};
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::law::potential::mei::EamForm;
use peridyne::run::{Options as Build, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::{BodySpec, End, LawSpec, LinearBody, PotentialSpec, Spec, TimeStep};

/// Evenly in ±1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum::<f64>() / 2.0
    }
}

fn lennard_jones(cutoff: f64) -> PotentialSpec {
    let form = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    PotentialSpec::of(form).ended(cutoff, End::ShiftedForce)
}

/// The copper-like constants of seleson2014, Table 1, nearest distance 1, cut off at 1.95.
pub(crate) fn embedded() -> PotentialSpec {
    PotentialSpec::of(EamForm {
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
        shells: vec![
            (12.0, 1.0),
            (6.0, 2.0f64.sqrt()),
            (24.0, 3.0f64.sqrt()),
            (12.0, 2.0),
        ],
        nearest: 1.0,
        shell_scale: 1.0,
    })
}

/// A periodic face-centred crystal of unit masses.
pub(crate) fn fcc(potential: PotentialSpec, a: f64, cells: i32) -> Spec {
    let long = f64::from(cells) * a;
    let region = Region::Block {
        low: [-0.1 * a; 3],
        high: [long - 0.2 * a; 3],
    };
    let lattice = BodySpec::lattice(LatticeKind::Fcc, a, region);
    let mut spec = Spec::new(3, lattice, 4.0 / a.powi(3), LawSpec::Atoms(potential));
    spec.space.periodic = [Some(long); 3];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec
}

pub(crate) fn model(spec: &Spec) -> Box<dyn Simulation> {
    let options = Build {
        trust_time_step: true,
        ..Build::default()
    };
    build(spec, options).unwrap()
}

/// Pairs of frames with opposite displacements, whose forces of even order cancel in the fit: the rest is of third order.
fn small_motions<const D: usize>(
    spec: &Spec,
    pairs: usize,
    size: f64,
    symmetry: bool,
) -> (Thermal<D>, LinearBody<D>) {
    let mut sim = model(spec);
    let hessian = sim.linear_body().of::<D>().unwrap();
    let n = hessian.points();
    let mut random = Random(7);
    let (mut displacement, mut force) = (vec![], vec![]);
    for _ in 0..pairs {
        let u: Vec<[f64; 3]> = (0..n)
            .map(|_| std::array::from_fn(|a| if a < D { size * random.next() } else { 0.0 }))
            .collect();
        for sign in [1.0, -1.0] {
            let u: Vec<[f64; 3]> = u.iter().map(|u| u.map(|c| sign * c)).collect();
            let f = sim.forces_under(&u);
            let f = f.iter().zip(&hessian.volume);
            force.push(
                f.map(|(f, v)| std::array::from_fn(|a| f[a] * v))
                    .collect::<Vec<[f64; D]>>(),
            );
            displacement.push(
                u.iter()
                    .map(|u| std::array::from_fn(|a| u[a]))
                    .collect::<Vec<[f64; D]>>(),
            );
        }
    }
    let frames = Frames {
        sites: &hessian,
        kind: &vec![0; n],
        displacement: &displacement,
        force: &force,
        virial: None,
    };
    let options = Options {
        radius: hessian.range() * (1.0 + 1e-6),
        symmetry,
    };
    (thermal(&frames, &options).unwrap(), hessian)
}

/// Largest difference of two bodies' blocks over the largest block.
fn apart<const D: usize>(found: &LinearBody<D>, expected: &LinearBody<D>) -> f64 {
    let (mut off, mut size) = (0.0f64, 0.0f64);
    for i in 0..expected.points() {
        let both = [found, expected].map(|b| b.row(i).0.to_vec()).concat();
        for j in both {
            let [x, y] = [found, expected].map(|b| {
                let none = [[0.0; D]; D];
                *b.micromodulus(i, j as usize).unwrap_or(&none)
            });
            for (x, y) in x.as_flattened().iter().zip(y.as_flattened()) {
                off = off.max((x - y).abs());
                size = size.max(y.abs());
            }
        }
    }
    off / size
}

#[test]
fn small_motions_of_pairs_give_the_hessian() {
    // under pressure: C, B and A differ
    let spec = fcc(lennard_jones(2.0), 1.5, 3);
    let exact = lattice_dynamics(&spec, 1e-3, TERMS).unwrap();
    let exact = exact.stress_strain.unwrap().cubic(1e-9).unwrap();
    for (symmetry, constants, pairs) in [(true, 9, 1), (false, 9 * 21, 4)] {
        let (found, hessian) = small_motions::<3>(&spec, pairs, 1e-6, symmetry);
        assert_eq!(found.constants, constants);
        assert_eq!(found.symmetries, if symmetry { 48 } else { 1 });
        let off = apart(&found.body, &hessian);
        assert!(off < 1e-8, "{off}");
        // what is left is of second order, and even
        assert!(found.residual < 1e-4, "{}", found.residual);
        assert!(found.body.soundness().asymmetry < 1e-12);
        let cubic = found.elastic.unwrap().cubic.unwrap();
        for (x, y) in [
            (cubic.c11, exact.c11),
            (cubic.c12, exact.c12),
            (cubic.c44, exact.c44),
        ] {
            assert!((x / y - 1.0).abs() < 1e-7, "{cubic:?} {exact:?}");
        }
    }
}

/// Embedded atoms reach twice their cut-off.
#[test]
fn small_motions_of_embedded_atoms_give_the_hessian() {
    let spec = fcc(embedded(), 2.0f64.sqrt(), 6);
    let (found, hessian) = small_motions::<3>(&spec, 1, 1e-6, true);
    assert!(hessian.range() > 3.0);
    let off = apart(&found.body, &hessian);
    assert!(off < 1e-8, "{off}");
}

/// A vacancy: atoms near it have their own blocks.
#[test]
fn small_motions_about_a_vacancy_give_the_hessian() {
    let (a, cells, rows) = (1.1, 8, 8);
    let period = [f64::from(cells) * a, f64::from(rows) * a * 0.75f64.sqrt()];
    let region = Region::Difference(
        Box::new(Region::Block {
            low: [-0.1 * a, -0.1 * a, 0.0],
            high: [period[0] - 0.1 * a, period[1] - 0.1 * a, 0.0],
        }),
        vec![Region::Sphere {
            center: [4.0 * a, 4.0 * a * 0.75f64.sqrt(), 0.0],
            radius: 0.3 * a,
        }],
    );
    let lattice = BodySpec::lattice(LatticeKind::Triangular, a, region);
    let mut spec = Spec::new(2, lattice, 1.0, LawSpec::Atoms(lennard_jones(2.0)));
    spec.space.periodic = [Some(period[0]), Some(period[1]), None];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let (found, hessian) = small_motions::<2>(&spec, 40, 1e-6, true);
    assert_eq!(hessian.points(), 63);
    // twelve neighbours, and all others
    assert_eq!((found.classes, found.symmetries), (13, 1));
    let off = apart(&found.body, &hessian);
    assert!(off < 1e-8, "{off}");
    assert!(found.elastic.is_err());
    // larger ones are not linear, and yet there is an energy: sums of an atom's blocks are symmetric, so that nothing meets translations
    let (found, _) = small_motions::<2>(&spec, 40, 0.03, true);
    assert!(found.residual > 0.1, "{}", found.residual);
    for i in 0..found.body.points() {
        let blocks = found.body.row(i).1;
        let odd: f64 = blocks.iter().map(|b| b[0][1] - b[1][0]).sum();
        let size: f64 = blocks.iter().map(|b| (b[0][1] - b[1][0]).abs()).sum();
        assert!(
            odd.abs() < 1e-9 * blocks[0][0][0].abs().max(size),
            "{odd} {size}"
        );
    }
}

/// Depth 1, nearest 1: energy, and its first and second derivatives.
fn morse(r: f64) -> [f64; 3] {
    let alpha = 3.0;
    let e = (-alpha * (r - 1.0)).exp();
    [
        (1.0 - e).powi(2),
        2.0 * alpha * e * (1.0 - e),
        2.0 * alpha * alpha * e * (2.0 * e - 1.0),
    ]
}

/// Bonds of a chain under the pressure p are independent, with the density exp(−(w + p r)/kT): the stiffness of its free energy is kT/⟨(r − ⟨r⟩)²⟩ a bond
/// (Takahashi 1942), and the mean Hessian is ⟨w″⟩.
#[test]
fn a_chain_at_a_temperature_is_as_stiff_as_its_free_energy() {
    let (heat, pressure) = (0.2, 0.5);
    let (steps, low, high) = (20_000, 0.5, 3.5);
    let at = |k: usize| low + (high - low) * (k as f64 + 0.5) / steps as f64;
    let weight: Vec<f64> = (0..steps)
        .map(|k| (-(morse(at(k))[0] + pressure * at(k)) / heat).exp())
        .collect();
    let total: f64 = weight.iter().sum();
    let mean = |of: &dyn Fn(f64) -> f64| -> f64 {
        let each = weight.iter().enumerate().map(|(k, w)| w * of(at(k)));
        each.sum::<f64>() / total
    };
    let length = mean(&|r| r);
    let exact = heat / mean(&|r| (r - length).powi(2));
    let hessian = mean(&|r| morse(r)[2]);
    // the test could not tell them apart otherwise
    assert!(hessian > 1.3 * exact, "{hessian} {exact}");
    let mut below = vec![];
    let mut sum = 0.0;
    for w in &weight {
        sum += w / total;
        below.push(sum);
    }
    let (atoms, count) = (100, 400);
    let mut random = Random(3);
    let (mut displacement, mut force) = (vec![], vec![]);
    for _ in 0..count {
        let bonds: Vec<f64> = (1..atoms)
            .map(|_| {
                let part = 0.5 * (1.0 + random.next());
                at(below.partition_point(|b| *b < part).min(steps - 1))
            })
            .collect();
        let mut u = vec![[0.0]];
        for r in &bonds {
            u.push([u.last().unwrap()[0] + r - length]);
        }
        let pull = |k: usize| bonds.get(k).map_or(0.0, |r| morse(*r)[1]);
        let f = (0..atoms).map(|i| [pull(i) - if i > 0 { pull(i - 1) } else { 0.0 }]);
        force.push(f.collect::<Vec<[f64; 1]>>());
        displacement.push(u);
    }
    let sites = LinearBody {
        position: (0..atoms).map(|i| [i as f64 * length]).collect(),
        volume: vec![1.0; atoms],
        density: vec![1.0; atoms],
        ..LinearBody::nothing()
    };
    let frames = Frames {
        sites: &sites,
        kind: &vec![0; atoms],
        displacement: &displacement,
        force: &force,
        virial: None,
    };
    let options = Options {
        radius: 1.5 * length,
        symmetry: true,
    };
    let found = thermal(&frames, &options).unwrap();
    let k = found.body.micromodulus(50, 51).unwrap()[0][0];
    // equations say each bond twice; what the fit leaves is noise: four standard errors
    let error = found.residual / ((atoms * count) as f64).sqrt() * 4.0;
    assert!(error < 0.03, "{error}");
    assert!((k / exact - 1.0).abs() < error, "{k} {exact} {error}");
    // (2/NF)^½ = 0.7 %, four times
    assert!((found.temperature / heat - 1.0).abs() < 0.03, "{found:?}");
    assert_eq!(
        found.elastic,
        Err(
            "its atoms do not all have the same surroundings, so that they do not just follow a strain"
        )
    );
}

/// Springs of stiffness k and noise of known size: variance of the least-squares constant `σ²/Σ x²`.
#[test]
fn errors_are_those_of_the_noise() {
    let (atoms, count, k, noise) = (40usize, 200, 3.0, 0.5);
    let sites = LinearBody {
        position: (0..atoms).map(|i| [i as f64]).collect(),
        volume: vec![1.0; atoms],
        density: vec![1.0; atoms],
        period: [Some(atoms as f64)],
        ..LinearBody::nothing()
    };
    let mut random = Random(11);
    let (mut displacement, mut force, mut squares) = (vec![], vec![], 0.0);
    for _ in 0..count {
        let u: Vec<[f64; 1]> = (0..atoms).map(|_| [random.normal()]).collect();
        let f: Vec<[f64; 1]> = (0..atoms)
            .map(|i| {
                let [x, y, z] = [atoms - 1, 0, 1].map(|d| u[(i + d) % atoms][0]);
                squares += (x + z - 2.0 * y).powi(2);
                [k * (x + z - 2.0 * y) + noise * random.normal()]
            })
            .collect();
        displacement.push(u);
        force.push(f);
    }
    let frames = Frames {
        sites: &sites,
        kind: &vec![0; atoms],
        displacement: &displacement,
        force: &force,
        virial: None,
    };
    let options = Options {
        radius: 1.0,
        symmetry: true,
    };
    let elastic = thermal(&frames, &options).unwrap().elastic.unwrap();
    let (found, error) = (elastic.stiffness.c[0][0], elastic.error.unwrap()[0][0]);
    let exact = noise / f64::sqrt(squares);
    assert!((found - k).abs() < 4.0 * exact, "{found}");
    // of 20 blocks: 1/√38 = 16 %, three times
    assert!((error / exact - 1.0).abs() < 0.5, "{error} {exact}");
}

#[test]
fn what_cannot_be_fitted_is_told() {
    let sites = LinearBody {
        position: (0..9).map(|i| [f64::from(i)]).collect(),
        volume: vec![1.0; 9],
        density: vec![1.0; 9],
        period: [Some(9.0)],
        ..LinearBody::nothing()
    };
    let still = vec![vec![[0.0]; 9]; 8];
    let of = |frames: usize, radius: f64| {
        let options = Options {
            radius,
            symmetry: true,
        };
        let frames = Frames {
            sites: &sites,
            kind: &[0; 9],
            displacement: &still[..frames],
            force: &still[..frames],
            virial: None,
        };
        thermal(&frames, &options).unwrap_err()
    };
    for (found, expected) in [
        (of(8, 4.6), "do not fit into a period of 9"),
        (of(8, -1.0), "must be a positive number"),
        (of(8, 0.5), "give a longer radius"),
        (of(1, 2.0), "the fit needs at least 2"),
        (of(8, 2.0), "do not determine all constants"),
    ] {
        let told = found.message().to_string();
        assert!(told.contains(expected), "{told}");
        assert!(found.to_string().contains(expected), "{found}");
    }
    assert!(matches!(of(8, 4.6), ThermalError::Box { .. }));
}
