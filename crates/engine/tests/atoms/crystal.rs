//! Every potential in 1, 2 and 3 dimensions, on fixed and on current neighbours.

use crate::sample::*;
use peridyne::execute::simd::Simd;
use peridyne::expression::Expression;
use peridyne::run::{Options, Seen, Simulation, Watched, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

const KINDS: [(LatticeKind, usize); 3] = [
    (LatticeKind::Chain, 9),
    (LatticeKind::Triangular, 5),
    (LatticeKind::Fcc, 3),
];

fn shaken(sim: &mut dyn Simulation, amplitude: f64) -> Vec<[f64; 3]> {
    let mut noise = Noise(7);
    let d = sim.info().dimension;
    let u: Vec<[f64; 3]> = (0..sim.info().points)
        .map(|_| std::array::from_fn(|a| if a < d { amplitude * noise.next() } else { 0.0 }))
        .collect();
    sim.set_displacements(&u);
    u
}

fn energy(sim: &mut dyn Simulation, u: &[[f64; 3]]) -> f64 {
    sim.set_displacements(u);
    sim.start(true);
    sim.ledger().unwrap().strain
}

#[test]
fn force_is_the_derivative_of_energy() {
    for (name, potential) in potentials() {
        for (kind, cells) in KINDS {
            for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
                for periodic in [false, true] {
                    // two cut-offs must fit
                    let cells = if periodic {
                        cells.max(if kind == LatticeKind::Fcc { 3 } else { 5 })
                    } else {
                        cells
                    };
                    let spec = atoms(kind, cells, &potential, family, periodic);
                    let mut sim = build(&spec, Options::default())
                        .unwrap_or_else(|e| panic!("{name}, {kind:?}: {e}"));
                    let d = sim.info().dimension;
                    let u = shaken(sim.as_mut(), 0.06);
                    sim.start(true);
                    let (f, v) = (sim.vectors("force_density"), sim.scalars("volume"));
                    let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
                    let total: [f64; 3] =
                        std::array::from_fn(|a| f.iter().zip(&v).map(|(f, v)| f[a] * v).sum());
                    for t in total {
                        assert!(
                            t.abs() < 1e-11 * size,
                            "{name}, {kind:?}, {family:?}: momentum {t}"
                        );
                    }
                    for i in [0, f.len() / 2, f.len() - 1] {
                        for a in 0..d {
                            let h = 1e-5;
                            let mut at = |s: f64| {
                                let mut w = u.clone();
                                w[i][a] += s * h;
                                energy(sim.as_mut(), &w)
                            };
                            // fourth order
                            let slope =
                                (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                            assert!(
                                (slope + f[i][a] * v[i]).abs() < 1e-7 * size.max(1.0),
                                "{name}, {kind:?}, {family:?}, periodic {periodic}: atom {i}: −{slope} is not {}",
                                f[i][a] * v[i]
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn fixed_and_current_neighbours_say_the_same_near_the_lattice() {
    for (name, potential) in potentials() {
        for (kind, cells) in KINDS {
            for periodic in [false, true] {
                let mut sims = [FamilyChoice::Stencil, FamilyChoice::Neighbours].map(|family| {
                    let spec = atoms(kind, cells.max(5), &potential, family, periodic);
                    build(&spec, Options::default()).unwrap()
                });
                let [a, b] = sims.each_mut().map(|sim| {
                    shaken(sim.as_mut(), 0.02);
                    sim.start(true);
                    let energies = sim.scalars("energy_density");
                    (sim.vectors("force_density"), energies, sim.virial())
                });
                let scale = a.0.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
                for (x, y) in a.0.iter().flatten().zip(b.0.iter().flatten()) {
                    assert!((x - y).abs() < 1e-11 * scale, "{name}, {kind:?}: {x} {y}");
                }
                for (x, y) in a.1.iter().zip(&b.1) {
                    assert!(
                        (x - y).abs() < 1e-11 * x.abs().max(1.0),
                        "{name}, {kind:?}: {x} {y}"
                    );
                }
                for (x, y) in a.2.iter().zip(&b.2) {
                    assert!(
                        (x - y).abs() < 1e-10 * scale * a.0.len() as f64,
                        "{name}, {kind:?}: {x} {y}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_virial_is_the_derivative_with_respect_to_strain() {
    for (name, potential) in potentials() {
        for (kind, cells) in KINDS {
            let spec = atoms(kind, cells, &potential, FamilyChoice::Neighbours, false);
            let mut sim = build(&spec, Options::default()).unwrap();
            let u = shaken(sim.as_mut(), 0.05);
            let x = sim.vectors("reference");
            let d = sim.info().dimension;
            sim.start(true);
            let virial = sim.virial();
            for (n, (a, b)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
                .into_iter()
                .enumerate()
            {
                if b >= d {
                    continue;
                }
                let h = 1e-5;
                let mut at = |s: f64| {
                    let w: Vec<[f64; 3]> = u
                        .iter()
                        .zip(&x)
                        .map(|(u, x)| {
                            let mut w = *u;
                            w[a] += s * h * (x[b] + u[b]);
                            w
                        })
                        .collect();
                    energy(sim.as_mut(), &w)
                };
                let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                assert!(
                    (slope + virial[n]).abs() < 1e-6 * (1.0 + slope.abs()),
                    "{name}, {kind:?}, component {n}: {slope} and {}",
                    virial[n]
                );
            }
        }
    }
}

/// Smooth ends conserve energy to the order of the step, whatever the family.
#[test]
fn energy_is_exchanged_and_does_not_drift() {
    for (name, potential) in potentials() {
        if !name.contains("smooth") && !name.contains("eam") {
            continue;
        }
        for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
            let mut error = vec![];
            for halving in 0..2 {
                let mut spec = atoms(LatticeKind::Fcc, 4, &potential, family, true);
                spec.loading.thermal = Some(ThermalSpec {
                    energy: Expression::constant(0.02),
                    seed: 3,
                });
                let dt = 4e-3 / (1 << halving) as f64;
                spec.run.schedule.time_step = TimeStep::Fixed(dt);
                let mut sim = build(&spec, Options::default()).unwrap();
                sim.start(true);
                let first = sim.ledger().unwrap();
                let (mut most, mut least_kinetic) = (0.0f64, f64::INFINITY);
                for _ in 0..(200 << halving) {
                    sim.step().unwrap();
                    let now = sim.ledger().unwrap();
                    most = most.max(now.residual().abs());
                    least_kinetic = least_kinetic.min(now.kinetic);
                }
                assert!(
                    least_kinetic < 0.8 * first.kinetic,
                    "{name}: nothing was exchanged"
                );
                error.push(most / first.kinetic);
            }
            assert!(error[0] < 0.02, "{name}, {family:?}: {error:?}");
            assert!(
                error[0] / error[1] > 3.0,
                "{name}, {family:?}: not of second order: {error:?}"
            );
        }
    }
}

/// Energies seen along with forces are those of a look from outside, near the list's own positions and far from them.
#[test]
fn watched_energies_are_the_observed_ones() {
    for (name, potential) in potentials() {
        for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
            let spec = atoms(LatticeKind::Fcc, 3, &potential, family, true);
            let mut sim = build(&spec, Options::default()).unwrap();
            let u = shaken(sim.as_mut(), 0.06);
            let fresh = sim.scalars("energy_density");
            sim.watch(Watched::Energies);
            sim.start(true);
            let Some(Seen::Energies(seen)) = sim.watched(Watched::Energies) else {
                panic!("{name}, {family:?}");
            };
            let seen = seen.strain;
            assert_eq!(seen, sim.scalars("energy_density"), "{name}, {family:?}");
            let scale = seen.iter().fold(0.0f64, |m, e| m.max(e.abs()));
            for (x, y) in seen.iter().zip(&fresh) {
                assert!((x - y).abs() < 1e-12 * scale, "{name}, {family:?}");
            }
            // far away and back: what was looked at leaves no trace
            let far: Vec<_> = u.iter().map(|u| [u[0] + 0.4, -3.0 * u[1], u[2]]).collect();
            sim.set_displacements(&far);
            assert_ne!(sim.scalars("energy_density"), seen, "{name}, {family:?}");
            sim.set_displacements(&u);
            assert_eq!(sim.scalars("energy_density"), seen, "{name}, {family:?}");
        }
    }
}

#[test]
fn all_instruction_sets_and_thread_counts_give_the_same_bits() {
    for (name, potential) in potentials() {
        for (kind, cells) in KINDS {
            for family in [FamilyChoice::Stencil, FamilyChoice::Neighbours] {
                let mut spec = atoms(kind, 2 * cells, &potential, family, true);
                spec.loading.thermal = Some(ThermalSpec {
                    energy: Expression::constant(0.3),
                    seed: 5,
                });
                spec.run.schedule.time_step = TimeStep::Fixed(2e-3);
                let mut runs = vec![];
                for simd in Simd::available() {
                    for threads in [1, 3] {
                        let pool = rayon::ThreadPoolBuilder::new()
                            .num_threads(threads)
                            .build()
                            .unwrap();
                        runs.push(pool.install(|| {
                            let options = Options {
                                simd: Some(simd),
                                ..Options::default()
                            };
                            let mut sim = build(&spec, options).unwrap();
                            sim.start(true);
                            for _ in 0..25 {
                                sim.step().unwrap();
                            }
                            (sim.displacements(), sim.scalars("energy_density"))
                        }));
                    }
                }
                assert!(
                    runs.iter().all(|r| *r == runs[0]),
                    "{name}, {kind:?}, {family:?}"
                );
            }
        }
    }
}

#[test]
fn velocities_have_their_temperature_and_no_momentum() {
    let (_, potential) = potentials().remove(0);
    let mut spec = atoms(
        LatticeKind::Fcc,
        4,
        &potential,
        FamilyChoice::Neighbours,
        true,
    );
    spec.loading.thermal = Some(ThermalSpec {
        energy: Expression::constant(0.7),
        seed: 11,
    });
    let mut sim = build(&spec, Options::default()).unwrap();
    let v = sim.velocities();
    let mass = sim.scalars("volume")[0] * sim.scalars("density")[0];
    let n = v.len() as f64;
    let kinetic: f64 = v.iter().flatten().map(|v| 0.5 * mass * v * v).sum();
    assert!((kinetic / (1.5 * (n - 1.0) * 0.7) - 1.0).abs() < 1e-12);
    for a in 0..3 {
        assert!(v.iter().map(|v| v[a]).sum::<f64>().abs() < 1e-11);
    }
    // a normal distribution has a fourth moment of 3
    let s2 = v.iter().flatten().map(|v| v * v).sum::<f64>() / (3.0 * n);
    let s4 = v.iter().flatten().map(|v| v.powi(4)).sum::<f64>() / (3.0 * n);
    assert!((s4 / (s2 * s2) - 3.0).abs() < 0.6, "{}", s4 / (s2 * s2));
    spec.loading.thermal = Some(ThermalSpec {
        energy: Expression::constant(0.7),
        seed: 12,
    });
    assert_ne!(build(&spec, Options::default()).unwrap().velocities(), v);
}

#[test]
fn a_cut_off_beyond_half_the_box_is_refused() {
    let (_, potential) = potentials().remove(0);
    let spec = atoms(
        LatticeKind::Fcc,
        2,
        &potential,
        FamilyChoice::Neighbours,
        true,
    );
    let error = build(&spec, Options::default()).err().unwrap();
    assert!(error.message.contains("beyond half the period"), "{error}");
}
