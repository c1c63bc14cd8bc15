//! Churning: nothing for pairs and, with the site partition, embedded atoms; nothing in sum for any potential; little for wide functions.

use crate::sample::*;
use peridyne::law::terms::Sites;
use peridyne_fields::{Fields, Frame, Method, Partition, Quantity, Shape, Targets, evaluate};
use std::sync::Arc;

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn at(frame: &Frame, sites: &dyn Sites, method: &Method) -> Fields {
    let points = Targets::line([-0.5; 3], [1.0, 0.7, 0.9], 12);
    evaluate(frame, sites, &points, method).unwrap()
}

#[test]
fn pairs_and_embedded_atoms_do_not_churn_with_the_site_partition() {
    for sites in [&pairs() as &dyn Sites, &embedded()] {
        let fields = at(&gas(1), sites, &method(Shape::Polynomial(3), 1.5));
        assert!(largest(fields.get(Quantity::StressPotential).unwrap()) > 0.1);
        let churning = fields.get(Quantity::Churning).unwrap();
        assert!(churning.iter().all(|z| *z == 0.0), "{churning:?}");
        assert!(
            fields
                .get(Quantity::HeatChurning)
                .unwrap()
                .iter()
                .all(|q| *q == 0.0)
        );
    }
    let equal = Method {
        partition: Partition::Equal,
        ..method(Shape::Polynomial(3), 1.5)
    };
    let pair = at(&gas(1), &pairs(), &equal);
    assert!(
        pair.get(Quantity::Churning)
            .unwrap()
            .iter()
            .all(|z| *z == 0.0)
    );
    // triplets neither, with pair forces from the star of the centre
    let star = Method {
        pair_force: peridyne_fields::PairForce::Differences,
        ..method(Shape::Polynomial(3), 1.5)
    };
    let fields = at(&gas(1), &Triplets, &star);
    let (size, churning) = (
        largest(fields.get(Quantity::StressPotential).unwrap()),
        largest(fields.get(Quantity::Churning).unwrap()),
    );
    assert!(churning < 1e-13 * size, "{churning:e} {size:e}");
    // embedded atoms in equal parts do
    let fields = at(&gas(1), &embedded(), &equal);
    assert!(largest(fields.get(Quantity::Churning).unwrap()) > 1e-3);
}

/// `∫z = 0` for K particles, any partition; and where it is not small.
#[test]
fn churning_is_nothing_in_sum() {
    let weights = Partition::Weights(Arc::new(|term, out| {
        let n = term.particles.len();
        let all: f64 = (1..=n).map(|k| k as f64).sum();
        out.clear();
        out.extend((1..=n).map(|k| k as f64 / all));
    }));
    for count in 3..=8 {
        for partition in [
            Partition::Site,
            Partition::Equal,
            Partition::Centre(-0.7),
            weights.clone(),
        ] {
            let sites = Cluster {
                count,
                seed: 40 + count as u64,
            };
            let method = Method {
                partition: partition.clone(),
                ..method(Shape::Gaussian, 0.4)
            };
            let fields = at(&cluster(count, 2), &sites, &method);
            let size = largest(&fields.totals.virial);
            let sum = largest(&fields.totals.churning);
            assert!(
                size > 0.1 && sum < 1e-12 * size,
                "{count} {partition:?}: {sum:e} {size:e}"
            );
            let here = largest(fields.get(Quantity::Churning).unwrap());
            let stress = largest(fields.get(Quantity::StressPotential).unwrap());
            assert!(
                here > 1e-2 * stress,
                "{count} {partition:?}: {here:e} {stress:e}"
            );
        }
    }
}

/// z over φ falls as s⁻² at a fixed point when φ widens; stress over φ does not.
#[test]
fn churning_falls_as_the_square_of_the_width() {
    for count in 3..=8 {
        let sites = Cluster { count, seed: 7 };
        let frame = cluster(count, 4);
        let size = |width: f64| {
            let method = Method {
                partition: Partition::Equal,
                ..method(Shape::Gaussian, width)
            };
            let fields = at(&frame, &sites, &method);
            let phi = method.kernel.value([0.0; 3]);
            [Quantity::Churning, Quantity::StressPotential]
                .map(|q| largest(fields.get(q).unwrap()) / phi)
        };
        let [near, far] = [size(20.0), size(40.0)];
        let order = [0, 1].map(|k| (near[k] / far[k]).log2());
        assert!((order[0] - 2.0).abs() < 0.05, "{count}: {order:?}");
        assert!(order[1].abs() < 0.05, "{count}: {order:?}");
    }
}

/// The divergence of z is 0 at every point (4.0.119), so that its heat flux is a source `z:∇v`.
#[test]
fn churning_has_no_divergence_and_its_flux_is_a_source() {
    let frame = gas(7);
    let method = method(Shape::Polynomial(5), 1.6);
    let h = 0.01;
    let x = [0.4, 1.5, 0.9];
    let mut points = vec![x];
    for a in 0..3 {
        for n in [1.0, -1.0, 2.0, -2.0] {
            let mut y = x;
            y[a] += n * h;
            points.push(y);
        }
    }
    let fields = evaluate(&frame, &Triplets, &Targets::Points(points), &method).unwrap();
    let slope = |values: &[f64], n: usize, c: usize, a: usize| {
        let of = |k: usize| values[(1 + 4 * a + k) * n + c];
        (8.0 * (of(0) - of(1)) - (of(2) - of(3))) / (12.0 * h)
    };
    let z = fields.get(Quantity::Churning).unwrap();
    let scale = largest(z) / 1.6;
    assert!(scale > 1e-2);
    for b in 0..3 {
        let divergence: f64 = (0..3).map(|a| slope(z, 9, 3 * a + b, a)).sum();
        assert!(divergence.abs() < 1e-5 * scale, "{divergence:e} {scale:e}");
    }
    let q = fields.get(Quantity::HeatChurning).unwrap();
    let divergence: f64 = (0..3).map(|a| slope(q, 3, a, a)).sum();
    let source = fields.get(Quantity::ChurningSource).unwrap()[0];
    assert!(source.abs() > 1e-3 * scale);
    assert!(
        (divergence - source).abs() < 1e-4 * source.abs(),
        "{divergence} {source}"
    );
}

/// A perfect diamond lattice: every angle is the ideal one, and nothing is not a number.
#[test]
fn a_diamond_lattice_has_fields() {
    let quarter = [
        [0, 0, 0],
        [2, 2, 0],
        [2, 0, 2],
        [0, 2, 2],
        [1, 1, 1],
        [3, 3, 1],
        [3, 1, 3],
        [1, 3, 3],
    ];
    let edge = 2.6;
    let n = 2;
    let mut position = vec![];
    for i in 0..n * n * n {
        let cell = [i / (n * n), i / n % n, i % n];
        for q in quarter {
            position.push(std::array::from_fn(|a| {
                edge * (cell[a] as f64 + 0.25 * f64::from(q[a]))
            }));
        }
    }
    let count = position.len();
    let side = edge * n as f64;
    let frame = Frame {
        cell: peridyne_fields::Cell::orthogonal([0.0; 3], [side; 3], [true; 3]).unwrap(),
        position,
        velocity: Some(vec![[0.3, 0.0, 0.0]; count]),
        mass: vec![1.0; count],
        kind: vec![0; count],
        time: None,
    };
    let fields = evaluate(
        &frame,
        &Triplets,
        &Targets::Grid([6; 3]),
        &Method {
            coordinate: true,
            ..method(Shape::Polynomial(3), 2.0)
        },
    )
    .unwrap();
    for quantity in Quantity::ALL {
        let values = fields.get(quantity).unwrap();
        assert!(values.iter().all(|x| x.is_finite()), "{quantity:?}");
    }
    // cubic: no shear on average
    let mean: Vec<f64> = (0..9)
        .map(|c| {
            fields
                .get(Quantity::Stress)
                .unwrap()
                .iter()
                .skip(c)
                .step_by(9)
                .sum::<f64>()
                / 216.0
        })
        .collect();
    assert!(
        (mean[0] - mean[4]).abs() < 1e-12 && mean[1].abs() < 1e-12,
        "{mean:?}"
    );
    assert!(mean[0].abs() > 1e-3);
}
