//! Stress and strain against closed forms.

use crate::sample::*;
use peridyne::observe::Values;
use peridyne::run::Simulation;
use peridyne::space::Point;
use peridyne::spec::*;

fn symmetric(sim: &mut dyn Simulation, name: &str) -> Vec<[f64; 6]> {
    match sim.column(name).unwrap().values {
        Values::Symmetric(v) => v,
        other => panic!("{other:?}"),
    }
}

fn deformed(x: &[Point], f: &[[f64; 3]; 3]) -> Vec<Point> {
    let moved =
        |x: &Point| std::array::from_fn(|a| (0..3).map(|b| f[a][b] * x[b]).sum::<f64>() - x[a]);
    x.iter().map(moved).collect()
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// A rotation by 40° about z times a stretch, within the first `d` axes.
fn large(d: usize) -> [[f64; 3]; 3] {
    let stretch = [[1.1, 0.05, 0.0], [0.05, 0.93, 0.02], [0.0, 0.02, 1.04]];
    let (s, c) = 0.7f64.sin_cos();
    let turn = match d {
        1 => IDENTITY,
        _ => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    };
    std::array::from_fn(|a| {
        std::array::from_fn(|b| match a < d && b < d {
            true => (0..d).map(|k| turn[a][k] * stretch[k][b]).sum(),
            false => IDENTITY[a][b],
        })
    })
}

#[test]
fn strain_is_that_of_a_homogeneous_deformation_and_knows_no_rotation() {
    for d in 1..=3 {
        for law in [PMB, LPS] {
            let mut spec = block([9, 6, 4], d, 0.5, law.clone());
            spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
            let mut sim = made(&spec);
            let (x, f) = (sim.vectors("reference"), large(d));
            sim.set_displacements(&deformed(&x, &f));
            let green = PAIRS.map(|(m, n)| {
                let product: f64 = (0..3).map(|k| f[k][m] * f[k][n]).sum();
                0.5 * (product - IDENTITY[m][n])
            });
            for strain in symmetric(sim.as_mut(), "strain") {
                for (a, b) in strain.iter().zip(green) {
                    assert!((a - b).abs() < 1e-13, "{d}-D {law:?}: {strain:?} {green:?}");
                }
            }
            let Values::Tensors(gradients) = sim.column("displacement_gradient").unwrap().values
            else {
                panic!("a tensor")
            };
            for h in gradients {
                for (n, h) in h.iter().enumerate() {
                    let wanted = f[n / 3][n % 3] - IDENTITY[n / 3][n % 3];
                    assert!((h - wanted).abs() < 1e-13);
                }
            }
        }
    }
}

#[test]
fn points_whose_bonds_do_not_span_the_space_have_no_strain() {
    // a row of points in the plane
    let mut spec = block(
        [9, 0, 0],
        2,
        0.5,
        LawSpec::Pmb(PmbStiffness::Micromodulus(1.0)),
    );
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let mut sim = made(&spec);
    let x = sim.vectors("reference");
    sim.set_displacements(
        &x.iter()
            .map(|x| [0.1 * x[0], 0.3 * x[0], 0.0])
            .collect::<Vec<_>>(),
    );
    assert!(
        symmetric(sim.as_mut(), "strain")
            .iter()
            .flatten()
            .all(|e| *e == 0.0)
    );
    assert!(
        symmetric(sim.as_mut(), "stress")
            .iter()
            .flatten()
            .all(|s| s.is_finite())
    );
}

/// `σ : ε = 2 W` for small strains, and `σ = C ε`: the stress that the energies give by their differences.
#[test]
fn stress_is_the_slope_of_the_energy() {
    for d in 1..=3 {
        for law in [PMB, LPS] {
            // two horizons from every side: families of families are whole
            let n = [[30, 14, 14], [16, 15, 0], [10, 10, 10]][d - 1];
            let mut spec = block(n, d, 0.5, law.clone());
            spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
            let mut sim = made(&spec);
            let x = sim.vectors("reference");
            let reach = 2.0 * sim.info().horizon + 1e-9;
            let inner: Vec<usize> = (0..x.len())
                .filter(|i| {
                    (0..d).all(|a| x[*i][a] > reach && x[*i][a] < 0.5 * f64::from(n[a]) - reach)
                })
                .collect();
            assert!(!inner.is_empty());
            let small = 1e-7;
            let energy = |sim: &mut dyn Simulation, strain: [f64; 6]| {
                let mut full = [[0.0; 3]; 3];
                for ((m, n), e) in PAIRS.iter().zip(strain) {
                    (full[*m][*n], full[*n][*m]) = (e, e);
                }
                sim.energy_under_strain(full)[inner[0]]
            };
            let strain = [0.8, -0.3, 0.5, 0.4, -0.6, 0.2].map(|e| small * e);
            let mut f = IDENTITY;
            for ((m, n), e) in PAIRS.iter().zip(strain) {
                if *m < d && *n < d {
                    f[*m][*n] += e;
                    if m != n {
                        f[*n][*m] += e;
                    }
                }
            }
            sim.set_displacements(&deformed(&x, &f));
            let stress = symmetric(sim.as_mut(), "stress");
            for (k, (m, n)) in PAIRS.iter().enumerate() {
                if *m >= d || *n >= d {
                    assert!(inner.iter().all(|i| stress[*i][k] == 0.0));
                    continue;
                }
                let moved = |by: f64| {
                    let mut e = strain;
                    e[k] += by * small;
                    e
                };
                let difference =
                    energy(sim.as_mut(), moved(0.5)) - energy(sim.as_mut(), moved(-0.5));
                // a shear strain stands twice in the tensor
                let slope = difference / small / if m == n { 1.0 } else { 2.0 };
                for i in &inner {
                    let off = stress[*i][k] - slope;
                    assert!(
                        off.abs() < 3e-6 * small,
                        "{d}-D {law:?} {m}{n}: {} {slope}",
                        stress[*i][k]
                    );
                }
            }
        }
    }
}

/// The stress of a turned body is the turned stress, and nothing pulls in a body that was only turned.
#[test]
fn stress_turns_with_the_body() {
    for law in [PMB, LPS] {
        let mut spec = block([9, 8, 0], 2, 0.5, law.clone());
        spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
        let mut sim = made(&spec);
        let x = sim.vectors("reference");
        let (s, c) = 0.9f64.sin_cos();
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        sim.set_displacements(&deformed(&x, &turn));
        let peak = |all: &[[f64; 6]]| all.iter().flatten().fold(0.0f64, |m, s| m.max(s.abs()));
        assert!(peak(&symmetric(sim.as_mut(), "stress")) < 1e-14);
        let wavy: Vec<Point> = x
            .iter()
            .map(|x| [0.02 * (1.3 * x[1]).sin(), 0.01 * x[0] * x[1], 0.0])
            .collect();
        sim.set_displacements(&wavy);
        let before = symmetric(sim.as_mut(), "stress");
        let turned: Vec<Point> = x
            .iter()
            .zip(&wavy)
            .map(|(x, u)| {
                let y: Point = std::array::from_fn(|a| x[a] + u[a]);
                std::array::from_fn(|a| (0..3).map(|b| turn[a][b] * y[b]).sum::<f64>() - x[a])
            })
            .collect();
        sim.set_displacements(&turned);
        let after = symmetric(sim.as_mut(), "stress");
        let size = peak(&before);
        assert!(size > 1e-3);
        for (old, new) in before.iter().zip(&after) {
            let full = [[old[0], old[3]], [old[3], old[1]]];
            for (k, (m, n)) in [(0, (0, 0)), (1, (1, 1)), (3, (0, 1))] {
                let mut wanted = 0.0;
                for (p, row) in full.iter().enumerate() {
                    for (q, s) in row.iter().enumerate() {
                        wanted += turn[m][p] * s * turn[n][q];
                    }
                }
                assert!((new[k] - wanted).abs() < 1e-12 * size, "{new:?}");
            }
        }
    }
}

/// Half of the virial of every point adds up to that of the body.
#[test]
fn stresses_of_points_are_the_virial_of_the_body() {
    let mut spec = block([9, 8, 0], 2, 0.5, LPS);
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: 1.35,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: None,
        conductance: None,
    });
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let mut sim = made(&spec);
    let x = sim.vectors("reference");
    let wavy: Vec<Point> = x
        .iter()
        .map(|x| [-0.15 * x[0], 0.04 * x[0] * x[1], 0.0])
        .collect();
    sim.set_displacements(&wavy);
    let (virial, volume) = (sim.virial(), sim.scalars("volume"));
    let stress = symmetric(sim.as_mut(), "stress");
    for k in [0, 1, 3] {
        let sum: f64 = stress.iter().zip(&volume).map(|(s, v)| s[k] * v).sum();
        assert!(
            (sum + virial[k]).abs() < 1e-12 * virial[k].abs(),
            "{sum} {}",
            virial[k]
        );
    }
    assert!(
        sim.scalars("repulsion_energy_density")
            .iter()
            .any(|w| *w > 0.0)
    );
}
