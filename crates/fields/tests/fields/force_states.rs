//! Chapter 4's circle: a potential of many bodies read as a peridynamic material, force states `T_j⟨ξ⟩ = ∂U^(j)/∂x_k` from its generalized forces on the
//! neighbours of a reference, has the fields that the atoms have.

use crate::sample::*;
use peridyne::law::terms::{Near, Sites};
use peridyne_fields::neighbours::{Neighbours, Partner};
use peridyne_fields::pairs::{self, Pull};
use peridyne_fields::residuals::{of_fields, of_frame};
use peridyne_fields::{Fields, Frame, Method, PairForce, Quantity, Shape, Targets, evaluate};

/// Families of the reference, and where the images of their members are.
fn families(reference: &Frame, reach: f64) -> Vec<Vec<Partner>> {
    let near = Neighbours::new(reference, reach).unwrap();
    let family = |i: usize| {
        let mut all = vec![];
        near.near(i, &mut all);
        all
    };
    (0..reference.len()).map(family).collect()
}

/// Force states of all points now: energies, and from i the bond, `∂U^(i)/∂x_k`.
fn states(
    reference: &Frame,
    now: &Frame,
    families: &[Vec<Partner>],
    sites: &dyn Sites,
) -> (Vec<f64>, Vec<(usize, usize, [f64; 3], [f64; 3])>) {
    let mut energy = vec![0.0; now.len()];
    let mut all = vec![];
    let u = |i: usize| -> [f64; 3] {
        std::array::from_fn(|c| now.position[i][c] - reference.position[i][c])
    };
    for (i, family) in families.iter().enumerate() {
        let near: Vec<Near> = family
            .iter()
            .map(|p| {
                let (own, other) = (u(i), u(p.atom as usize));
                Near {
                    kind: now.kind[p.atom as usize],
                    y: std::array::from_fn(|c| p.y[c] + other[c] - own[c]),
                }
            })
            .collect();
        let mut slope = vec![[0.0; 3]; near.len()];
        sites.terms(now.kind[i], &near, &mut |term| {
            energy[i] += term.energy;
            for &(a, b, g) in &term.pulls {
                let at = |n: u32| match n {
                    0 => [0.0; 3],
                    n => near[n as usize - 1].y,
                };
                let d: [f64; 3] = std::array::from_fn(|c| at(a)[c] - at(b)[c]);
                for (n, sign) in [(a, g), (b, -g)] {
                    if n > 0 {
                        (0..3).for_each(|c| slope[n as usize - 1][c] += sign * d[c]);
                    }
                }
            }
        });
        for ((p, near), slope) in family.iter().zip(&near).zip(slope) {
            all.push((i, p.atom as usize, near.y, slope));
        }
    }
    (energy, all)
}

/// The fields of the peridynamic body. The bond that leads back is found by its vector.
fn peridynamic(
    now: &Frame,
    (energy, states): &(Vec<f64>, Vec<(usize, usize, [f64; 3], [f64; 3])>),
    targets: &Targets,
    method: &Method,
) -> Fields {
    let back = |i: usize, k: usize, y: [f64; 3]| {
        let found = states
            .iter()
            .find(|(a, b, z, _)| *a == k && *b == i && (0..3).all(|c| (z[c] + y[c]).abs() < 1e-9));
        found.expect("families are mutual").3
    };
    let pulls: Vec<Pull> = states
        .iter()
        .map(|(i, k, y, own)| {
            let other = back(*i, *k, *y);
            Pull {
                i: *i as u32,
                k: *k as u32,
                y: *y,
                force: std::array::from_fn(|c| own[c] - other[c]),
                own: Some(*own),
            }
        })
        .collect();
    let mut each = |visit: &mut dyn FnMut(Pull)| pulls.iter().for_each(|p| visit(*p));
    pairs::evaluate(now, energy, &mut each, targets, method).unwrap()
}

/// In lengths of this size.
fn circle(reference: Frame, sites: &dyn Sites, length: f64, central: bool) {
    let mut now = reference.clone();
    let mut random = Random(11);
    for x in &mut now.position {
        let u = random.vector();
        (0..3).for_each(|c| x[c] += 0.1 * length * u[c]);
    }
    let families = families(&reference, sites.reach() + 0.4 * length);
    let states = states(&reference, &now, &families, sites);
    let points: Vec<[f64; 3]> = (0..12)
        .map(|_| random.vector().map(|c| 2.0 * length * c))
        .collect();
    let targets = Targets::Points(points.clone());
    let width = 1.4 * length;
    let own = pairs::method(method(Shape::Polynomial(4), width));
    assert_eq!(own.pair_force, PairForce::Differences);
    let body = peridynamic(&now, &states, &targets, &own);
    let atoms = evaluate(&now, sites, &targets, &own).unwrap();
    let largest = |x: &[f64]| x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let places = |q: &Quantity| Quantity::PLACES.contains(q);
    for quantity in Quantity::ALL.into_iter().filter(|q| !places(q)) {
        let (a, b) = (body.get(quantity).unwrap(), atoms.get(quantity).unwrap());
        // what is 0 but for round-off, beside stress
        let size = largest(b).max(largest(atoms.get(Quantity::Stress).unwrap()));
        let off = a
            .iter()
            .zip(b)
            .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(
            off < 1e-11 * size,
            "{}: {off:e} of {size:e}",
            quantity.name()
        );
    }
    assert!(largest(body.get(Quantity::Churning).unwrap()) == 0.0);
    // with central pair forces the stress is another, and its divergence the same
    let distances = Method {
        pair_force: PairForce::Distances,
        ..own.clone()
    };
    let other = evaluate(&now, sites, &targets, &distances).unwrap();
    let [a, b] = [&body, &other].map(|f| f.get(Quantity::Stress).unwrap());
    let off = a
        .iter()
        .zip(b)
        .fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
    match central {
        true => assert!(off < 1e-11 * largest(b), "{off:e}"),
        false => assert!(off > 1e-3 * largest(b), "{off:e}"),
    }
    let step = width / 40.0;
    let of_body = of_fields(&now, &own, &points, step, &mut |targets, method| {
        Ok(peridynamic(&now, &states, targets, method))
    })
    .unwrap();
    let of_atoms = of_frame(&now, sites, &distances, &points, step).unwrap();
    for residuals in [of_body, of_atoms] {
        for law in [residuals.mass, residuals.momentum, residuals.energy] {
            assert!(law.extrapolated < 1e-3 * law.scale, "{law:?}");
        }
    }
}

#[test]
fn embedded_atoms_as_a_peridynamic_body_have_the_stress_of_atoms() {
    circle(gas(4), &pairs(), 1.0, true);
    circle(gas(4), &embedded(), 1.0, true);
}

/// Force states that are not along their bonds.
#[test]
fn fans_as_a_peridynamic_body_have_the_stress_of_atoms() {
    circle(gas(4), &Triplets, 1.0, false);
    circle(silicon(), &*stillinger_weber(), 2.0, false);
}

/// The averaged material, `T̄[x]⟨q − x⟩ = Σ_jk ∂U^(j)/∂x_k φ(x − X_j) φ(q − X_k)`: `∫{T̄[x]⟨q − x⟩ − T̄[q]⟨x − q⟩} dq = Σ F_j φ(x − X_j)`, with forces
/// of the fields' own sums and `∫φ` by Simpson's rule.
fn averaged(reference: Frame, sites: &dyn Sites, length: f64) {
    let mut now = reference.clone();
    let mut random = Random(13);
    for x in &mut now.position {
        let u = random.vector();
        (0..3).for_each(|c| x[c] += 0.1 * length * u[c]);
    }
    let families = families(&reference, sites.reach() + 0.4 * length);
    let (_, states) = states(&reference, &now, &families, sites);
    let width = 1.4 * length;
    let method = method(Shape::Polynomial(4), width);
    let kernel = &method.kernel;
    let radial = |n: usize| {
        let r = width * n as f64 / 20_000.0;
        4.0 * std::f64::consts::PI * r * r * kernel.value([r, 0.0, 0.0])
    };
    let whole: f64 = (0..10_000)
        .map(|n| radial(2 * n) + 4.0 * radial(2 * n + 1) + radial(2 * n + 2))
        .sum::<f64>()
        * width
        / 60_000.0;
    assert!((whole - 1.0).abs() < 1e-13, "{whole}");
    let all = evaluate(&now, sites, &Targets::Grid([2; 3]), &method).unwrap();
    let images: Vec<[f64; 3]> = (0..125)
        .map(|n| now.cell.shift([n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2]))
        .collect();
    let phi = |x: [f64; 3], y: [f64; 3]| {
        let value = |s: &[f64; 3]| kernel.value(std::array::from_fn(|c| y[c] + s[c] - x[c]));
        images.iter().map(value).sum::<f64>()
    };
    let [mut off, mut size] = [0.0f64; 2];
    for _ in 0..20 {
        let x = random.vector().map(|c| 2.0 * length * c);
        let (mut left, mut right) = ([0.0; 3], [0.0; 3]);
        for (i, _, y, own) in &states {
            let from = now.position[*i];
            let to = std::array::from_fn(|c| from[c] + y[c]);
            // what the state of i says of i itself is on both sides alike
            let weight = whole * (phi(x, from) - phi(x, to));
            (0..3).for_each(|c| left[c] += weight * own[c]);
        }
        for (place, force) in now.position.iter().zip(&all.force) {
            let weight = phi(x, *place);
            (0..3).for_each(|c| right[c] += weight * force[c]);
        }
        for c in 0..3 {
            off = off.max((left[c] - right[c]).abs());
            size = size.max(right[c].abs());
        }
    }
    println!("{off:e} of {size:e}");
    assert!(size > 0.0 && off < 1e-12 * size, "{off:e} of {size:e}");
}

#[test]
fn averaged_force_states_integrate_to_averaged_forces() {
    averaged(gas(4), &pairs(), 1.0);
    averaged(gas(4), &embedded(), 1.0);
    averaged(gas(4), &Triplets, 1.0);
    averaged(silicon(), &*stillinger_weber(), 2.0);
}

#[test]
fn pulls_that_make_no_sense_are_refused() {
    let frame = gas(4);
    let targets = Targets::Points(vec![[0.0; 3]]);
    let own = pairs::method(method(Shape::Polynomial(4), 1.4));
    let mut none = |_: &mut dyn FnMut(Pull)| {};
    let few = pairs::evaluate(&frame, &[0.0], &mut none, &targets, &own);
    assert!(few.unwrap_err().to_string().contains("energies"));
    let mut wild = |visit: &mut dyn FnMut(Pull)| {
        visit(Pull {
            i: 2,
            k: 3,
            y: [1.0, 0.0, 0.0],
            force: [f64::NAN; 3],
            own: None,
        });
    };
    let energy = vec![0.0; frame.len()];
    let wrong = pairs::evaluate(&frame, &energy, &mut wild, &targets, &own);
    assert!(wrong.unwrap_err().to_string().contains("particle 3"));
}
