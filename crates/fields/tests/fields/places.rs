//! The material coordinate, its flux and angular momentum, against loops over all particles; and all fields in a frame that moves.

use crate::sample::*;
use peridyne_fields::residuals::of_frame;
use peridyne_fields::{
    Fields, Frame, Kernel, Method, Partition, Quantity, Shape, Targets, evaluate,
};

fn asked(shape: Shape, width: f64) -> Method {
    Method {
        coordinate: true,
        ..method(shape, width)
    }
}

fn at(fields: &Fields, q: Quantity, p: usize) -> &[f64] {
    &fields.get(q).unwrap()[p * q.components()..][..q.components()]
}

/// Σ m x φ and the rest, image by image.
#[test]
fn sums_of_places_are_those_of_all_images() {
    let frame = gas(3);
    let method = asked(Shape::Polynomial(3), 1.7);
    let points = vec![[0.1, 0.7, 4.6], [3.3, 1.0, 0.2], [2.0, 2.5, 2.9]];
    let targets = Targets::Points(points.clone());
    let fields = evaluate(&frame, &pairs(), &targets, &method).unwrap();
    let velocity = frame.velocity.as_ref().unwrap();
    let images: Vec<[i32; 3]> = (0..125)
        .map(|n| [n / 25 - 2, n / 5 % 5 - 2, n % 5 - 2])
        .collect();
    for (p, x) in points.iter().enumerate() {
        // of each image with a part: m φ, where, how fast
        let mut near = vec![];
        for (n, place) in frame.position.iter().enumerate() {
            for image in &images {
                let shift = frame.cell.shift(*image);
                let at: [f64; 3] = std::array::from_fn(|a| place[a] + shift[a]);
                let d = std::array::from_fn(|a| x[a] - at[a]);
                let part = frame.mass[n] * method.kernel.value(d);
                if part > 0.0 {
                    near.push((part, at, velocity[n]));
                }
            }
        }
        let rho: f64 = near.iter().map(|n| n.0).sum();
        let mean = |of: &dyn Fn(&[[f64; 3]; 2]) -> f64| -> f64 {
            near.iter().map(|(m, x, v)| m * of(&[*x, *v])).sum::<f64>() / rho
        };
        let y: [f64; 3] = std::array::from_fn(|a| mean(&|of| of[0][a]));
        let v: [f64; 3] = std::array::from_fn(|a| mean(&|of| of[1][a]));
        for c in 0..3 {
            let (a, b) = ((c + 1) % 3, (c + 2) % 3);
            let l = rho * (y[a] * v[b] - y[b] * v[a]);
            assert!((at(&fields, Quantity::Coordinate, p)[c] - y[c]).abs() < 1e-12);
            assert!((at(&fields, Quantity::AngularMomentum, p)[c] - l).abs() < 1e-11);
        }
        for n in 0..9 {
            let (a, b) = (n / 3, n % 3);
            let flux = rho * mean(&|of| (of[1][a] - v[a]) * (of[0][b] - y[b]));
            let own = at(&fields, Quantity::CoordinateFlux, p)[n];
            assert!((own - flux).abs() < 1e-12, "{own} {flux}");
            assert!(flux.abs() > 1e-6);
        }
    }
}

/// A mean over an axis has no place along it; what needs none is there, and balances.
#[test]
fn averaged_axes_have_no_place() {
    let frame = gas(4);
    let extents = frame.cell.extents([true, false, false]).unwrap();
    let method = Method {
        coordinate: true,
        ..Method::new(Kernel::averaged(Shape::Polynomial(5), 1.6, extents).unwrap())
    };
    let points = [[1.0, 2.0, 0.7], [0.0, 1.5, 3.0]];
    let targets = Targets::Points(points.to_vec());
    let fields = evaluate(&frame, &pairs(), &targets, &method).unwrap();
    let finite = |q| -> Vec<bool> { at(&fields, q, 0).iter().map(|x| x.is_finite()).collect() };
    assert_eq!(finite(Quantity::Coordinate), [false, true, true]);
    assert_eq!(finite(Quantity::AngularMomentum), [true, false, false]);
    let found = of_frame(&frame, &pairs(), &method, &points, 0.02).unwrap();
    for r in [found.coordinate, found.angular_momentum] {
        assert!((r.value / r.expected - 1.0).abs() < 0.2, "{r:?}");
    }
}

fn boosted(frame: &Frame, by: [f64; 3]) -> Frame {
    let all = frame.velocity.iter().flatten();
    let moved = all.map(|v| std::array::from_fn(|a| v[a] + by[a])).collect();
    Frame {
        velocity: Some(moved),
        ..frame.clone()
    }
}

/// (4.0.12) to (4.0.21): a frame that moves at V sees the same density, stress, internal energy, temperature, heat fluxes about v and source; π, e and l as mechanics has it,
/// and q_C, which is v·z, with V·z more.
#[test]
fn a_moving_frame_sees_what_mechanics_says() {
    let by = [3.0, -1.2, 0.7];
    let frame = gas(5);
    // of triplets in equal parts: z is not 0
    let method = Method {
        partition: Partition::Equal,
        ..asked(Shape::Polynomial(4), 1.7)
    };
    let targets = Targets::Grid([3; 3]);
    let of = |frame: &Frame| evaluate(frame, &Triplets, &targets, &method).unwrap();
    let (own, moved) = (of(&frame), of(&boosted(&frame, by)));
    let dot = |a: &[f64], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut churned = 0.0f64;
    for p in 0..own.len() {
        let get = |q| at(&own, q, p);
        let (rho, pi) = (get(Quantity::Density)[0], get(Quantity::Momentum));
        let (y, z) = (get(Quantity::Coordinate), get(Quantity::Churning));
        for q in Quantity::ALL {
            let added: Vec<f64> = match q {
                Quantity::Momentum => by.map(|v| rho * v).to_vec(),
                Quantity::Velocity => by.to_vec(),
                Quantity::Energy => vec![dot(pi, &by) + 0.5 * rho * dot(&by, &by)],
                Quantity::AngularMomentum => (0..3)
                    .map(|c| {
                        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
                        rho * (y[a] * by[b] - y[b] * by[a])
                    })
                    .collect(),
                Quantity::HeatChurning => (0..3).map(|a| dot(&z[3 * a..3 * a + 3], &by)).collect(),
                _ => vec![0.0; q.components()],
            };
            if q == Quantity::HeatChurning {
                churned = added.iter().fold(churned, |most, z| most.max(z.abs()));
            }
            for ((a, b), more) in get(q).iter().zip(at(&moved, q, p)).zip(&added) {
                let size = 1.0 + a.abs().max(more.abs());
                assert!((a + more - b).abs() < 1e-11 * size, "{q:?}: {a} {more} {b}");
            }
        }
    }
    assert!(churned > 1e-3, "{churned}");
}
