//! Fans on diamond lattices: forces, virial and tangents are derivatives of one energy, and nothing shows who computed them.

use super::sample::{Noise, crystal, many_body};
use super::tangents;
use peridyne::execute::simd::Simd;
use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::spec::*;

fn noise(sim: &dyn Simulation, amplitude: f64) -> Vec<[f64; 3]> {
    let mut noise = Noise(7);
    let points = 0..sim.info().points;
    points
        .map(|_| std::array::from_fn(|_| amplitude * noise.next()))
        .collect()
}

fn energy(sim: &mut dyn Simulation, u: &[[f64; 3]]) -> f64 {
    sim.set_displacements(u);
    sim.start(true);
    sim.ledger().unwrap().strain
}

/// Of fourth order.
fn slope(h: f64, at: &mut dyn FnMut(f64) -> f64) -> f64 {
    (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
}

#[test]
fn force_is_the_derivative_of_energy() {
    for (name, potential, edge, kinds) in many_body() {
        for periodic in [false, true] {
            let spec = crystal(&potential, edge, kinds, 2, periodic);
            let mut sim =
                build(&spec, Options::default()).unwrap_or_else(|e| panic!("{name}: {e}"));
            let u = noise(sim.as_ref(), 0.4);
            energy(sim.as_mut(), &u);
            let (f, v) = (sim.vectors("force_density"), sim.scalars("volume"));
            let size = f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs())) * v[0];
            assert!(size > 0.1);
            for a in 0..3 {
                let total: f64 = f.iter().zip(&v).map(|(f, v)| f[a] * v).sum();
                assert!(total.abs() < 1e-12 * size, "{name}: momentum {total}");
            }
            // energies of points add up
            let of_points = sim.scalars("energy_density");
            let sum: f64 = of_points.iter().zip(&v).map(|(e, v)| e * v).sum();
            let whole = sim.ledger().unwrap().strain;
            assert!((sum - whole).abs() < 1e-12 * whole.abs());
            for i in [0, f.len() / 2, f.len() - 1] {
                for a in 0..3 {
                    let found = slope(1e-4, &mut |h| {
                        let mut w = u.clone();
                        w[i][a] += h;
                        energy(sim.as_mut(), &w)
                    });
                    assert!(
                        (found + f[i][a] * v[i]).abs() < 1e-8 * size,
                        "{name}, periodic {periodic}: atom {i}: −{found} is not {}",
                        f[i][a] * v[i]
                    );
                }
            }
        }
    }
}

#[test]
fn the_virial_is_the_derivative_with_respect_to_strain() {
    for (name, potential, edge, kinds) in many_body() {
        let spec = crystal(&potential, edge, kinds, 2, false);
        let mut sim = build(&spec, Options::default()).unwrap();
        let u = noise(sim.as_ref(), 0.3);
        energy(sim.as_mut(), &u);
        let virial = sim.virial();
        let x = sim.vectors("reference");
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        for (n, (a, b)) in pairs.into_iter().enumerate() {
            let found = slope(1e-5, &mut |h| {
                let mut w = u.clone();
                for (w, x) in w.iter_mut().zip(&x) {
                    w[a] += h * (x[b] + w[b]);
                }
                energy(sim.as_mut(), &w)
            });
            let size = virial.iter().fold(1.0f64, |m, x| m.max(x.abs()));
            assert!(
                (found + virial[n]).abs() < 1e-7 * size,
                "{name} {n}: {found} {}",
                virial[n]
            );
        }
    }
}

#[test]
fn linear_bodies_are_derivatives_of_forces() {
    for (name, potential, edge, kinds) in many_body() {
        for periodic in [false, true] {
            tangents::check::<3>(name, &crystal(&potential, edge, kinds, 2, periodic));
        }
    }
}

#[test]
fn silicon_with_a_vacancy_relaxes() {
    let (_, potential, edge, _) = many_body().remove(0);
    let mut spec = crystal(&potential, edge, 1, 3, true);
    let BodySpec::Cloud(cloud) = &mut spec.body else {
        panic!("no cloud")
    };
    cloud.position.remove(100);
    cloud.volume.remove(100);
    cloud.mark.remove(100);
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    let mut model = build(&spec, options).unwrap();
    let sites = model.displacements();
    let largest = |f: &[[f64; 3]]| f.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let before = largest(&model.forces_under(&sites));
    model.relax(1e-10).unwrap();
    let u = model.displacements();
    let after = largest(&model.forces_under(&u));
    assert!(after < 1e-9 * before && before > 0.0, "{before} to {after}");
}

#[test]
fn all_instruction_sets_and_thread_counts_give_the_same_bits() {
    for (name, potential, edge, kinds) in many_body() {
        // several blocks, and a path long enough for new lists
        let mut spec = crystal(&potential, edge, kinds, 4, true);
        spec.loading.thermal = Some(ThermalSpec {
            energy: Expression::constant(20.0),
            seed: 5,
        });
        let mut runs = vec![];
        for simd in Simd::available() {
            for threads in [1, 3] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                runs.push(pool.unwrap().install(|| {
                    let options = Options {
                        simd: Some(simd),
                        ..Options::default()
                    };
                    let mut sim = build(&spec, options).unwrap();
                    sim.start(true);
                    for _ in 0..40 {
                        sim.step().unwrap();
                    }
                    (sim.displacements(), sim.scalars("energy_density"))
                }));
            }
        }
        assert!(runs.iter().all(|r| *r == runs[0]), "{name}");
    }
}

#[test]
fn energy_is_exchanged_and_does_not_drift() {
    for (name, potential, edge, kinds) in many_body() {
        let mut spec = crystal(&potential, edge, kinds, 2, true);
        spec.loading.thermal = Some(ThermalSpec {
            energy: Expression::constant(0.05),
            seed: 5,
        });
        let mut drift = [0.0; 2];
        for (drift, halved) in drift.iter_mut().zip([false, true]) {
            let dt = if halved { 0.01 } else { 0.02 };
            spec.run.schedule.time_step = TimeStep::Fixed(dt);
            let mut sim = build(&spec, Options::default()).unwrap();
            sim.start(true);
            let total = |sim: &mut dyn Simulation| {
                let l = sim.ledger().unwrap();
                [l.strain + l.kinetic, l.kinetic]
            };
            let [first, kinetic] = total(sim.as_mut());
            for _ in 0..(4.0 / dt) as usize {
                sim.step().unwrap();
            }
            let [last, left] = total(sim.as_mut());
            // crystals give half of it away; that of two kinds is made under pressure, and takes some
            assert!(
                (left - kinetic).abs() > 0.1 * kinetic,
                "{name}: {left} of {kinetic}"
            );
            *drift = (last - first).abs() / kinetic.max(left);
        }
        assert!(
            drift[0] < 2e-2 && drift[1] < 0.5 * drift[0] + 1e-4,
            "{name}: {drift:?}"
        );
    }
}
