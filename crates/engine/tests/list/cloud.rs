//! Clouds without order: the textbook's formulas, and families at the horizon.

use crate::case::*;
use peridyne::body::{Body, view, view_mut, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::horizon::HorizonList;
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::{Interaction, PointConstants, PointEnergies, Sweep, Toughness};
use peridyne::law::solid::bond_based::BondBased;
use peridyne::law::solid::eam_like::{EamLike, Solid};
use peridyne::spec::{Breakage, CrackKind, Influence};

/// ξ to the nearest image along y, and its square.
fn distance<const D: usize>(a: [f64; 3], b: [f64; 3], period: f64) -> ([f64; 3], f64) {
    let mut xi = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    if D > 1 && xi[1].abs() > 0.5 * period {
        xi[1] -= period * xi[1].signum();
    }
    (xi, xi.iter().map(|x| x * x).sum())
}

/// A cloud without order: positions, volumes, the body, and its period along y.
fn random_cloud<const D: usize>(n: usize) -> (Vec<[f64; 3]>, Vec<f64>, Body<D>, f64) {
    let mut random = Random(D as u64);
    let volume: Vec<f64> = (0..n).map(|_| 1.0 + 0.4 * random.next()).collect();
    let edge = 0.6 * (n as f64).powf(1.0 / D as f64);
    let period = 2.0 * edge;
    let mut position: Vec<[f64; 3]> = vec![];
    while position.len() < n {
        let x = std::array::from_fn(|a| if a < D { edge * random.next() } else { 0.0 });
        let free = |p: &[f64; 3]| distance::<D>(*p, x, period).1 > 0.1;
        if position.iter().all(free) {
            position.push(x);
        }
    }
    let periods = std::array::from_fn(|a| (a == 1).then_some(period));
    let body = Body::<D>::from_cloud(&position, &volume, &[], 1.0, periods).unwrap();
    (position, volume, body, period)
}

fn norm(x: [f64; 3]) -> f64 {
    x.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The formulas as printed, over all pairs: PMB (sandia2010 (3.0.5)-(3.0.7)) and LPS (Algorithm 2).
fn textbook<const D: usize>() {
    let n = [30, 300, 500][D - 1];
    let (x, volume, body, period) = random_cloud::<D>(n);
    let delta = 2.3;
    let (c, bulk, shear) = (2.0, 3.0, 1.3);
    let mut random = Random(99);
    let u: Vec<[f64; 3]> = (0..n)
        .map(|_| std::array::from_fn(|a| if a < D { 0.02 * random.next() } else { 0.0 }))
        .collect();
    // partner, reference distance, bond vector
    let family: Vec<Vec<(usize, f64, [f64; 3])>> = (0..n)
        .map(|i| {
            let others = (0..n).filter(|j| *j != i);
            let pair = |j: usize| {
                let (xi, square) = distance::<D>(x[i], x[j], period);
                let y = std::array::from_fn(|a| xi[a] + u[j][a] - u[i][a]);
                (square <= delta * delta).then(|| (j, square.sqrt(), y))
            };
            others.filter_map(pair).collect()
        })
        .collect();
    let nu = |r0: f64| {
        if (r0 - delta).abs() <= 0.5 {
            (delta - r0) + 0.5
        } else {
            1.0
        }
    };
    let sum = |i: usize, of: &dyn Fn(f64, f64) -> f64| -> f64 {
        let term = |(j, r0, y): &(usize, f64, [f64; 3])| of(*r0, norm(*y)) * nu(*r0) * volume[*j];
        family[i].iter().map(term).sum()
    };
    // ω = 1/r0: m = Σ ω r0² ν V, θ = 3/m Σ ω r0 e ν V
    let m: Vec<f64> = (0..n).map(|i| sum(i, &|r0, _| r0)).collect();
    let theta: Vec<f64> = (0..n)
        .map(|i| 3.0 / m[i] * sum(i, &|r0, r| r - r0))
        .collect();
    let mut expected = [vec![[0.0; 3]; n], vec![[0.0; 3]; n]];
    for i in 0..n {
        for &(j, r0, y) in &family[i] {
            let (r, w) = (norm(y), 1.0 / r0);
            let pmb = c * (r - r0) / r0;
            let lps = (3.0 * bulk - 5.0 * shear) * (theta[i] / m[i] + theta[j] / m[j]) * w * r0
                + 15.0 * shear * (w / m[i] + w / m[j]) * (r - r0);
            for a in 0..3 {
                expected[0][i][a] += pmb * nu(r0) * volume[j] * y[a] / r;
                expected[1][i][a] += lps * nu(r0) * volume[j] * y[a] / r;
            }
        }
    }

    let mut field = body.at_rest();
    for (s, u) in body.slots().iter().zip(&u) {
        for a in 0..D {
            field[a][*s as usize] = u[a];
        }
    }
    // Algorithm 2 is three-dimensional: n = 3, κ = K − 5G/3, β = 15 G
    let solid = Solid {
        n: 3.0,
        kappa: bulk - 5.0 / 3.0 * shear,
        beta: 15.0 * shear,
    };
    let list = HorizonList::new(&body, delta).unwrap();
    let bonds: usize = family.iter().map(Vec::len).sum();
    assert_eq!(list.directed(), bonds as u64);
    let mut pmb = ListInteraction::new(ListParts {
        body: &body,
        list: list.clone(),
        law: BondBased { c },
        weight: BondWeight::new(Influence::Constant, delta, Some(1.0)),
        point_constants: PointConstants::None,
        toughness: vec![],
        repulsion: None,
        simd: Simd::detect(),
    });
    let mut lps = ListInteraction::new(ListParts {
        body: &body,
        list,
        law: EamLike {
            ratio: solid.ratio(),
        },
        weight: BondWeight::new(Influence::Inverse, delta, Some(1.0)),
        point_constants: PointConstants::Solid(vec![solid]),
        toughness: vec![],
        repulsion: None,
        simd: Simd::detect(),
    });
    let laws: [&mut dyn Interaction<D>; 2] = [&mut pmb, &mut lps];
    for (law, expected) in laws.into_iter().zip(expected) {
        law.prepare(&body);
        let mut f = zeros(body.len());
        law.forces(
            &body,
            view(&field),
            view_mut(&mut f),
            Sweep::Evolve {
                v: view(&zeros(body.len())),
                steps: [0.0; 2],
                breakage: Breakage::AfterForce,
            },
            None,
        );
        for a in 0..D {
            let plain: Vec<f64> = expected.iter().map(|f| f[a]).collect();
            let force = by_id(&body, &f[a]);
            close("force", &plain, &force, 1e-12);
            let momentum: f64 = force.iter().zip(&volume).map(|(f, v)| f * v).sum();
            let size: f64 = force.iter().map(|f| f.abs()).sum();
            assert!(momentum.abs() <= 1e-14 * size, "{momentum:e} of {size:e}");
        }
        let mut damage = vec![1.0; body.len()];
        law.damage(&body, &mut damage);
        assert!(damage.iter().all(|d| *d == 0.0));
        // with volumes that differ: half of the body falls off
        let half = |a: [f64; D], b: [f64; D]| (a[0] < 0.0) != (b[0] < 0.0);
        law.cut(&body, CrackKind::Broken, &half);
        law.damage(&body, &mut damage);
        let plain: Vec<f64> = (0..n)
            .map(|i| {
                let whole = |j: usize| (x[i][0] < 0.0) == (x[j][0] < 0.0);
                let all: f64 = family[i].iter().map(|b| volume[b.0]).sum();
                let whole = family[i].iter().filter(|b| whole(b.0));
                1.0 - whole.map(|b| volume[b.0]).sum::<f64>() / all
            })
            .collect();
        close("damage", &plain, &by_id(&body, &damage), 1e-13);
    }
    let mut lps = {
        let list = HorizonList::new(&body, delta).unwrap();
        ListInteraction::new(ListParts {
            body: &body,
            list,
            law: EamLike {
                ratio: solid.ratio(),
            },
            weight: BondWeight::new(Influence::Inverse, delta, Some(1.0)),
            point_constants: PointConstants::Solid(vec![solid]),
            toughness: vec![],
            repulsion: None,
            simd: Simd::detect(),
        })
    };
    lps.prepare(&body);
    let mut seen = PointEnergies::default();
    lps.observe(&body, view(&field), &mut seen.for_slots(body.len()));
    close("dilatation", &theta, &by_id(&body, &seen.dilatation), 1e-12);
}

#[test]
fn random_clouds_follow_the_textbook() {
    textbook::<1>();
    textbook::<2>();
    textbook::<3>();
}

#[test]
fn a_body_at_rest_has_exactly_no_force() {
    let (_, _, body, _) = random_cloud::<3>(200);
    let mut it = ListInteraction::new(ListParts {
        body: &body,
        list: HorizonList::new(&body, 2.0).unwrap(),
        law: BondBased { c: 1.0 },
        weight: BondWeight::new(Influence::Constant, 2.0, None),
        point_constants: PointConstants::None,
        toughness: vec![Toughness {
            s00: 0.1,
            alpha: 0.25,
        }],
        repulsion: None,
        simd: Simd::detect(),
    });
    let mut f = zeros(body.len());
    for _ in 0..2 {
        it.forces(
            &body,
            view(&body.at_rest()),
            view_mut(&mut f),
            Sweep::Evolve {
                v: view(&zeros(body.len())),
                steps: [0.0; 2],
                breakage: Breakage::AfterForce,
            },
            None,
        );
        assert!(f.iter().flatten().all(|f| *f == 0.0));
    }
    let mut critical = vec![];
    assert!(it.read_column(
        &body,
        view(&body.at_rest()),
        "critical_stretch",
        &mut critical
    ));
    assert!((critical[0] - 0.1).abs() < 1e-16);
}

#[test]
fn bad_clouds_are_refused_with_help() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let cloud = |period| Body::<3>::from_cloud(&points, &[1.0; 4], &[], 1.0, [period, None, None]);
    let body = cloud(None).unwrap();
    let error = HorizonList::new(&body, 1.5).unwrap_err();
    assert!(error.message.starts_with("points 2 and 4 are in one place"));
    let body = cloud(Some(3.0)).unwrap();
    let error = HorizonList::new(&body, 1.5).unwrap_err();
    assert!(error.message.contains("period along x is 3,"), "{error}");
    assert!(error.help.is_some());
    assert!(HorizonList::new(&body, f64::NAN).is_err());
}

#[test]
fn bonds_at_the_horizon_are_inclusive_and_counted() {
    let points: Vec<[f64; 3]> = (0..10).map(|i| [i as f64, 0.0, 0.0]).collect();
    let body = Body::<1>::from_cloud(&points, &[1.0; 10], &[], 1.0, [Some(10.0)]).unwrap();
    let counts = |horizon| {
        let list = HorizonList::new(&body, horizon).unwrap();
        (list.directed(), list.near_horizon())
    };
    assert_eq!(counts(3.0), (60, 20));
    assert_eq!(counts(3.5), (60, 0));
    assert_eq!(counts(3.0 - 1e-10), (40, 20));
}
