//! Sums: what they average to, brute force, images, threads, and what is not defined.

use crate::sample::*;
use peridyne::law::terms::{Near, Sites};
use peridyne_fields::average::Average;
use peridyne_fields::{Cell, Frame, Kernel, Method, Partition, Quantity, Shape, Targets, evaluate};

fn mean(values: &[f64], n: usize) -> Vec<f64> {
    let count = (values.len() / n) as f64;
    (0..n)
        .map(|c| values.iter().skip(c).step_by(n).sum::<f64>() / count)
        .collect()
}

/// On a grid of a periodic cell the rectangle rule is as exact as φ is smooth.
#[test]
fn averages_over_the_cell_are_totals_and_the_virial() {
    let frame = gas(1);
    let volume = frame.cell.volume();
    let method = method(Shape::Gaussian, 0.55);
    for sites in [&embedded() as &dyn Sites, &Triplets] {
        let fields = evaluate(&frame, sites, &Targets::Grid([10, 10, 11]), &method).unwrap();
        let of = |q: Quantity| mean(fields.get(q).unwrap(), q.components());
        let totals = &fields.totals;
        assert!(totals.complete);
        let close = |a: f64, b: f64, scale: f64| (a - b).abs() < 1e-8 * scale.abs();
        assert!(close(of(Quantity::Density)[0], totals.mass / volume, 1.0));
        assert!(close(
            of(Quantity::Energy)[0],
            (totals.kinetic + totals.energy) / volume,
            1.0
        ));
        for a in 0..3 {
            assert!(close(
                of(Quantity::Momentum)[a],
                totals.momentum[a] / volume,
                1.0
            ));
        }
        let rho = fields.get(Quantity::Density).unwrap();
        let v = fields.get(Quantity::Velocity).unwrap();
        let stress = of(Quantity::Stress);
        let potential = of(Quantity::StressPotential);
        let mut without = 0.0f64;
        for n in 0..9 {
            let flow: f64 = (0..rho.len())
                .map(|p| rho[p] * v[3 * p + n / 3] * v[3 * p + n % 3])
                .sum::<f64>()
                / rho.len() as f64;
            let virial = -(totals.flow[n] + totals.virial[n]) / volume;
            assert!(
                close(stress[n] - flow, virial, 1.0),
                "{n}: {} {virial}",
                stress[n] - flow
            );
            assert!(close(potential[n], -totals.virial[n] / volume, 1.0));
            without = without.max((stress[n] - virial).abs());
        }
        // without −ρ v⊗v it is not the virial
        assert!(without > 1e-2);
        for z in of(Quantity::Churning) {
            assert!(z.abs() < 1e-8);
        }
    }
}

/// The formulas of the chapter, atom by atom and pair by pair, in free space.
#[test]
fn sums_are_those_of_the_book() {
    let frame = cluster(6, 3);
    let sites = Cluster { count: 6, seed: 12 };
    let k = 6;
    let velocity = frame.velocity.clone().unwrap();
    // the one term
    let mut place = vec![0usize];
    place.extend(1..k);
    let near: Vec<Near> = (1..k)
        .map(|i| Near {
            kind: frame.kind[i],
            y: std::array::from_fn(|a| frame.position[i][a] - frame.position[0][a]),
        })
        .collect();
    let mut g = vec![vec![0.0; k]; k];
    let mut energy = 0.0;
    sites.terms(0, &near, &mut |t| {
        energy += t.energy;
        for &(a, b, pull) in &t.pulls {
            g[a as usize][b as usize] = pull;
            g[b as usize][a as usize] = pull;
        }
    });
    let x = &frame.position;
    let between = |j: usize, l: usize| -> [f64; 3] { std::array::from_fn(|a| x[j][a] - x[l][a]) };
    // ∂U/∂x_l
    let gradient: Vec<[f64; 3]> = (0..k)
        .map(|l| std::array::from_fn(|a| (0..k).map(|p| g[l][p] * between(l, p)[a]).sum()))
        .collect();
    for partition in [Partition::Site, Partition::Equal, Partition::Centre(0.3)] {
        let weight = |j: usize| match partition {
            Partition::Site => f64::from(j == 0),
            Partition::Equal => 1.0 / k as f64,
            _ if j == 0 => 0.3,
            _ => 0.7 / (k - 1) as f64,
        };
        let method = Method {
            partition: partition.clone(),
            ..method(Shape::CubicSpline, 2.1)
        };
        let point = [0.2, -0.3, 0.4];
        let fields = evaluate(&frame, &sites, &Targets::Points(vec![point]), &method).unwrap();
        let phi: Vec<f64> = (0..k)
            .map(|j| {
                method
                    .kernel
                    .value(std::array::from_fn(|a| point[a] - x[j][a]))
            })
            .collect();
        let beta = |j: usize, l: usize| {
            let d = std::array::from_fn(|a| point[a] - x[l][a]);
            method.kernel.bond(d, between(j, l))
        };
        let rho: f64 = (0..k).map(|j| frame.mass[j] * phi[j]).sum();
        let v: [f64; 3] = std::array::from_fn(|a| {
            (0..k)
                .map(|j| frame.mass[j] * velocity[j][a] * phi[j])
                .sum::<f64>()
                / rho
        });
        let u: Vec<[f64; 3]> = (0..k)
            .map(|j| std::array::from_fn(|a| velocity[j][a] - v[a]))
            .collect();
        let square = |w: [f64; 3]| w.iter().map(|c| c * c).sum::<f64>();
        let close = |q: Quantity, expected: &[f64]| {
            let own = fields.get(q).unwrap();
            let size = expected.iter().fold(1e-3f64, |m, x| m.max(x.abs()));
            for (a, b) in own.iter().zip(expected) {
                assert!((a - b).abs() < 1e-12 * size, "{q:?}: {own:?} {expected:?}");
            }
        };
        close(Quantity::Density, &[rho]);
        close(Quantity::Velocity, &v);
        let of = |f: &dyn Fn(usize) -> f64| (0..k).map(f).sum::<f64>();
        close(
            Quantity::Energy,
            &[of(&|j| {
                (0.5 * frame.mass[j] * square(velocity[j]) + weight(j) * energy) * phi[j]
            })],
        );
        close(
            Quantity::InternalEnergy,
            &[of(&|j| {
                (0.5 * frame.mass[j] * square(u[j]) + weight(j) * energy) * phi[j]
            })],
        );
        close(
            Quantity::Temperature,
            &[of(&|j| frame.mass[j] * square(u[j]) * phi[j]) / (3.0 * phi.iter().sum::<f64>())],
        );
        let kinetic: Vec<f64> = (0..9)
            .map(|n| -of(&|j| frame.mass[j] * u[j][n / 3] * u[j][n % 3] * phi[j]))
            .collect();
        close(Quantity::StressKinetic, &kinetic);
        let (mut stress, mut flow, mut heat) = (vec![0.0; 9], vec![0.0; 9], vec![0.0; 3]);
        for j in 0..k {
            for l in (0..k).filter(|l| *l != j) {
                let (d, b) = (between(j, l), beta(j, l));
                for n in 0..9 {
                    stress[n] += 0.5 * g[j][l] * d[n / 3] * d[n % 3] * b;
                    flow[n] += weight(j) * gradient[l][n % 3] * d[n / 3] * b;
                }
                let work: f64 = (0..3).map(|a| u[l][a] * weight(j) * gradient[l][a]).sum();
                for a in 0..3 {
                    heat[a] += work * d[a] * b;
                }
            }
        }
        close(Quantity::StressPotential, &stress);
        let z: Vec<f64> = (0..9).map(|n| stress[n] + flow[n]).collect();
        close(Quantity::Churning, &z);
        close(Quantity::HeatPotential, &heat);
        let carried: Vec<f64> = (0..3)
            .map(|a| {
                of(&|j| {
                    u[j][a] * (0.5 * frame.mass[j] * square(u[j]) + weight(j) * energy) * phi[j]
                })
            })
            .collect();
        close(Quantity::HeatKinetic, &carried);
        let churned: Vec<f64> = (0..3)
            .map(|a| (0..3).map(|b| v[b] * z[3 * a + b]).sum())
            .collect();
        close(Quantity::HeatChurning, &churned);
    }
}

/// A cell smaller than the reach and than φ, against copies of it in a cell that is not.
#[test]
fn small_cells_are_their_own_neighbours() {
    let mut random = Random(3);
    let edges = [[1.3, 0.0, 0.0], [0.2, 1.25, 0.0], [-0.15, 0.1, 1.4]];
    let cell = Cell::new([0.0; 3], edges, [true; 3]).unwrap();
    let velocity: Vec<_> = (0..2).map(|_| random.vector()).collect();
    let position = vec![[0.1, 0.1, 0.1], [0.7, 0.8, 0.75]];
    let small = Frame {
        cell,
        position,
        velocity: Some(velocity),
        mass: vec![1.0, 1.3],
        kind: vec![0; 2],
        time: None,
    };
    let n = 4;
    let mut large = Frame {
        cell: Cell::new(
            [0.0; 3],
            edges.map(|e| e.map(|c| c * f64::from(n))),
            [true; 3],
        )
        .unwrap(),
        position: vec![],
        velocity: Some(vec![]),
        mass: vec![],
        kind: vec![],
        time: None,
    };
    for i in 0..n * n * n {
        let shift = small.cell.shift([i / (n * n), i / n % n, i % n]);
        for k in 0..2 {
            large
                .position
                .push(std::array::from_fn(|a| small.position[k][a] + shift[a]));
            large
                .velocity
                .as_mut()
                .unwrap()
                .push(small.velocity.as_ref().unwrap()[k]);
            large.mass.push(small.mass[k]);
            large.kind.push(0);
        }
    }
    for shape in [Shape::Polynomial(3), Shape::Gaussian, Shape::Cell] {
        let width = if shape == Shape::Gaussian { 0.5 } else { 1.7 };
        for partition in [Partition::Site, Partition::Equal] {
            let method = Method {
                partition,
                ..method(shape, width)
            };
            let targets = Targets::Points(vec![[0.3, 0.2, 0.1], [-4.0, 0.9, 2.0]]);
            let [a, b] =
                [&small, &large].map(|f| evaluate(f, &Triplets, &targets, &method).unwrap());
            let places = |q: &Quantity| Quantity::PLACES.contains(q);
            for q in Quantity::ALL.into_iter().filter(|q| !places(q)) {
                let (a, b) = (a.get(q).unwrap(), b.get(q).unwrap());
                let size = b.iter().fold(1.0f64, |m, x| m.max(x.abs()));
                for (x, y) in a.iter().zip(b) {
                    assert!((x - y).abs() < 1e-11 * size, "{shape:?} {q:?}: {a:?} {b:?}");
                }
            }
        }
    }
}

/// Grids, lists of their points, and any number of threads say the same; of threads to the last bit.
#[test]
fn threads_and_ways_to_ask_do_not_show() {
    let frame = gas(2);
    let method = Method {
        coordinate: true,
        ..method(Shape::QuarticSpline, 1.4)
    };
    let grid = Targets::Grid([5, 6, 7]);
    let run = |threads: usize, targets: &Targets| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| evaluate(&frame, &Triplets, targets, &method).unwrap())
    };
    let [one, three] = [1, 3].map(|t| run(t, &grid));
    assert_eq!(one, three);
    let list = run(2, &Targets::Points(grid.positions(&frame.cell)));
    for q in Quantity::ALL {
        let (a, b) = (one.get(q).unwrap(), list.get(q).unwrap());
        let size = a.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        assert!(
            a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-12 * size),
            "{q:?}"
        );
    }
}

#[test]
fn parts_of_the_potential_add_up() {
    let frame = gas(3);
    let method = Method {
        by_part: true,
        ..method(Shape::Polynomial(3), 1.5)
    };
    let fields = evaluate(&frame, &Triplets, &Targets::Grid([4; 3]), &method).unwrap();
    assert_eq!(
        fields.parts.iter().map(|p| &*p.name).collect::<Vec<_>>(),
        ["pair", "triplet"]
    );
    let whole = Method {
        by_part: false,
        ..method
    };
    let all = evaluate(&frame, &Triplets, &Targets::Grid([4; 3]), &whole).unwrap();
    for (q, of) in [
        (
            Quantity::StressPotential,
            fields.parts.iter().map(|p| &p.stress).collect::<Vec<_>>(),
        ),
        (
            Quantity::Churning,
            fields.parts.iter().map(|p| &p.churning).collect(),
        ),
        (
            Quantity::HeatPotential,
            fields.parts.iter().map(|p| &p.heat).collect(),
        ),
        (
            Quantity::PotentialEnergy,
            fields.parts.iter().map(|p| &p.energy).collect(),
        ),
    ] {
        for (n, value) in all.get(q).unwrap().iter().enumerate() {
            assert!((of[0][n] + of[1][n] - value).abs() < 1e-11, "{q:?}");
        }
    }
    assert!(fields.parts[0].churning.iter().all(|z| *z == 0.0));
}

/// Where nothing is there is no velocity, and no temperature; a frame without velocities has no momentum.
#[test]
fn what_is_not_defined_is_said() {
    let mut frame = cluster(3, 1);
    let sites = Cluster { count: 3, seed: 1 };
    let targets = Targets::Points(vec![frame.position[0], [40.0, 0.0, 0.0]]);
    let method = Method {
        coordinate: true,
        ..method(Shape::Polynomial(3), 1.0)
    };
    let fields = evaluate(&frame, &sites, &targets, &method).unwrap();
    for q in Quantity::ALL {
        let values = fields.get(q).unwrap();
        let n = q.components();
        assert!(values[..n].iter().all(|x| x.is_finite()), "{q:?}");
        let far = &values[n..];
        let defined = matches!(
            q,
            Quantity::Density
                | Quantity::Momentum
                | Quantity::Energy
                | Quantity::PotentialEnergy
                | Quantity::StressPotential
                | Quantity::Churning
        );
        assert!(
            far.iter()
                .all(|x| if defined { *x == 0.0 } else { x.is_nan() }),
            "{q:?} {far:?}"
        );
    }
    frame.velocity = None;
    let fields = evaluate(&frame, &sites, &targets, &method).unwrap();
    for q in Quantity::ALL {
        assert_eq!(fields.get(q).is_none(), q.moves(), "{q:?}");
    }
    // those of places where they are asked for
    let method = Method {
        coordinate: false,
        ..method
    };
    let fields = evaluate(&cluster(3, 1), &sites, &targets, &method).unwrap();
    for q in Quantity::ALL {
        let own = Quantity::PLACES.contains(&q);
        assert_eq!(fields.get(q).is_none(), own, "{q:?}");
    }
}

#[test]
fn means_and_errors_over_frames() {
    let method = method(Shape::Polynomial(3), 1.5);
    let targets = Targets::Grid([2; 3]);
    let mut average = Average::default();
    let all: Vec<_> = (1..5)
        .map(|seed| evaluate(&gas(seed), &pairs(), &targets, &method).unwrap())
        .collect();
    all.iter().for_each(|f| average.add(f));
    let values: Vec<f64> = all
        .iter()
        .map(|f| f.get(Quantity::Density).unwrap()[3])
        .collect();
    let mean = values.iter().sum::<f64>() / 4.0;
    let error = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 12.0).sqrt();
    assert!((average.mean(Quantity::Density).unwrap()[3] - mean).abs() < 1e-14);
    assert!((average.error(Quantity::Density).unwrap()[3] - error).abs() < 1e-14);
    assert_eq!(average.frames(), 4);
}

#[test]
fn frames_that_make_no_sense_are_refused() {
    let good = gas(1);
    let method = method(Shape::Polynomial(3), 1.5);
    let refused = |frame: &Frame, targets: &Targets, part: &str| {
        let error = evaluate(frame, &pairs(), targets, &method)
            .unwrap_err()
            .to_string();
        assert!(error.contains(part), "{error}");
    };
    let grid = Targets::Grid([2; 3]);
    let mut frame = good.clone();
    frame.position[1] = frame.position[0];
    refused(&frame, &grid, "coincide");
    let mut frame = good.clone();
    frame.position[4][1] = f64::NAN;
    refused(&frame, &grid, "particle 5");
    let mut frame = good.clone();
    frame.mass[0] = 0.0;
    refused(&frame, &grid, "mass");
    let mut frame = good.clone();
    frame.velocity.as_mut().unwrap().pop();
    refused(&frame, &grid, "one of each");
    refused(&good, &Targets::Grid([2, 0, 2]), "0 points along y");
    refused(&good, &Targets::Points(vec![[f64::NAN; 3]]), "point 1");
    let extents = Cell::orthogonal([0.0; 3], [4.0; 3], [true; 3]).unwrap();
    let kernel = Kernel::averaged(
        Shape::Gaussian,
        1.0,
        extents.extents([true, false, false]).unwrap(),
    );
    let flat = Method::new(kernel.unwrap());
    let error = evaluate(&good, &pairs(), &Targets::Grid([2; 3]), &flat).unwrap_err();
    assert!(error.to_string().contains("averaged"), "{error}");
}
