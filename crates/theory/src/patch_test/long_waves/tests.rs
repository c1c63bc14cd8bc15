//! Linear bodies with closed forms, and those of crystals whose constants and waves are known.

use crate::coarsen::thermal::tests::{embedded, fcc, model};
use crate::patch_test::{PatchTest, Place, patch_test};
use crate::upscale::crystal;
use crate::voigt::{Stiffness, axes, components};
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::spec::*;
use std::sync::Arc;

/// The patch test of a linear body.
fn tested<const D: usize>(body: LinearBody<D>) -> PatchTest {
    let cloud = Cloud {
        position: (body.position.iter())
            .map(|x| std::array::from_fn(|a| if a < D { x[a] } else { 0.0 }))
            .collect(),
        volume: body.volume.clone(),
        ..Cloud::default()
    };
    let (longest, period) = (body.longest(), body.period);
    let law = LawSpec::Micromoduli(Arc::new(AnyLinearBody::new(body).unwrap()));
    let mut spec = Spec::new(D, BodySpec::Cloud(cloud), 1.0, law);
    spec.space.periodic = std::array::from_fn(|a| if a < D { period[a] } else { None });
    spec.bonds.horizon = Horizon::Length(1.001 * longest);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    patch_test(model(&spec).as_mut(), None)
}

/// The only class of a crystal that is periodic along all axes.
fn only(found: &PatchTest) -> (&Stiffness, bool) {
    assert_eq!(found.classes.len(), 1, "{found:?}");
    let class = &found.classes[0];
    (class.stiffness.as_ref().unwrap(), class.long_waves)
}

/// `n^D` points of spacing 1: bonds within `√reach`, each along `ξ` of `a/ξ²` and across it of `b/ξ²`; periodic or with a surface.
fn springs<const D: usize>(n: i64, reach: i64, [a, b]: [f64; 2], periodic: bool) -> LinearBody<D> {
    let count = n.pow(D as u32);
    let place = |i: i64| -> [i64; D] { std::array::from_fn(|d| i / n.pow(d as u32) % n) };
    let mut body = LinearBody::<D> {
        period: [periodic.then_some(n as f64); D],
        ..LinearBody::nothing()
    };
    for i in 0..count {
        body.position.push(place(i).map(|x| x as f64));
        body.volume.push(1.0);
        body.density.push(1.0);
        for j in 0..count {
            let (from, to) = (place(i), place(j));
            let xi: [i64; D] = std::array::from_fn(|d| {
                let x = to[d] - from[d];
                match periodic {
                    true => (x + n / 2).rem_euclid(n) - n / 2,
                    false => x,
                }
            });
            let square: i64 = xi.iter().map(|x| x * x).sum();
            if square == 0 || square > reach {
                continue;
            }
            let q = square as f64;
            body.partner.push(j as u32);
            body.block.push(std::array::from_fn(|k| {
                std::array::from_fn(|l| {
                    let along = (xi[k] * xi[l]) as f64 / q;
                    let whole = if k == l { 1.0 } else { 0.0 };
                    (a * along + b * (whole - along)) / q
                })
            }));
        }
        body.start.push(body.partner.len());
    }
    body
}

/// `Σ_jl C_ijkl n_j n_l`
fn acoustic<const D: usize>(c: &Stiffness, n: [f64; D]) -> [[f64; D]; D] {
    let of = |i: usize, j: usize| {
        let mut all = 0..components(D);
        all.find(|v| axes(D, *v) == (i, j) || axes(D, *v) == (j, i))
            .unwrap()
    };
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let each = (0..D * D).map(|m| (m / D, m % D));
            each.map(|(j, l)| c.c[of(i, j)][of(k, l)] * n[j] * n[l])
                .sum()
        })
    })
}

/// `(1/2V) Σ K_ik (ξ·n)²` of the first point, whose bonds are those of all: what a long wave along n feels.
fn felt<const D: usize>(body: &LinearBody<D>, n: [f64; D]) -> [[f64; D]; D] {
    let (partners, blocks) = body.row(0);
    let mut sum = [[0.0; D]; D];
    for (j, block) in partners.iter().zip(blocks) {
        let xi = body.xi(0, *j as usize);
        let along: f64 = (0..D).map(|a| xi[a] * n[a]).sum();
        for i in 0..D {
            for k in 0..D {
                sum[i][k] += 0.5 * block[i][k] * along * along;
            }
        }
    }
    sum
}

fn directions<const D: usize>() -> impl Iterator<Item = [f64; D]> {
    (0..20).map(|m| {
        let n: [f64; D] =
            std::array::from_fn(|a| (1.7 * f64::from(m) + 2.3 * a as f64 + 0.4).sin());
        let long = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        n.map(|x| x / long)
    })
}

fn same<const D: usize>(found: [[f64; D]; D], expected: [[f64; D]; D], tolerance: f64) {
    let scale = expected
        .iter()
        .flatten()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    for (x, y) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!(
            (x - y).abs() < tolerance * scale,
            "{found:?} is not {expected:?}"
        );
    }
}

/// Nearest neighbours on a simple cubic lattice: `[xx,xx] = a`, `[yy,xx] = b`, so C11 = a, C12 = −b, C44 = b. Of the energy under strain they are
/// a, 0 and b/2.
#[test]
fn springs_along_and_across_have_their_closed_form() {
    let (a, b) = (3.0, 0.7);
    let found = tested(springs::<3>(4, 1, [a, b], true));
    let (c, long_waves) = only(&found);
    assert!(long_waves);
    for v in 0..6 {
        for w in 0..6 {
            let expected = match (v, w) {
                (v, w) if v != w && v.max(w) < 3 => -b,
                (v, w) if v != w => 0.0,
                (v, _) if v < 3 => a,
                _ => b,
            };
            assert!((c.c[v][w] - expected).abs() < 1e-9, "{v} {w}: {c:?}");
        }
    }
}

/// Two and three dimensions, several shells.
#[test]
fn the_tensor_has_the_long_waves_of_the_bonds() {
    let body = springs::<3>(5, 3, [2.0, -0.4], true);
    let (found, whole) = (tested(body.clone()), 1e-9);
    let (c, long_waves) = only(&found);
    assert!(long_waves);
    directions::<3>().for_each(|n| same(acoustic(c, n), felt(&body, n), whole));
    let body = springs::<2>(7, 5, [2.0, 0.9], true);
    let found = tested(body.clone());
    let (c, long_waves) = only(&found);
    assert!(long_waves);
    directions::<2>().for_each(|n| same(acoustic(c, n), felt(&body, n), whole));
}

/// Bonds that resist stretches alone cost nothing under rotation: their energy under strain stands, near surfaces, too, and is that of their waves.
#[test]
fn central_bonds_keep_their_energy_under_strain() {
    let body = springs::<3>(5, 3, [2.0, 0.0], true);
    let found = tested(body.clone());
    let (c, long_waves) = only(&found);
    assert!(!long_waves);
    directions::<3>().for_each(|n| same(acoustic(c, n), felt(&body, n), 1e-9));
    let cut = tested(springs::<3>(6, 3, [2.0, 0.0], false));
    assert!(cut.classes.len() > 1);
    for class in &cut.classes {
        assert!(class.stiffness.is_some() && !class.long_waves, "{class:?}");
    }
    assert!(cut.whole(0).is_some());
}

/// A block keeps the constants of its bulk, and near its surface it has none.
#[test]
fn points_near_a_surface_have_no_long_waves() {
    let constants = [3.0, 0.7];
    let endless = tested(springs::<3>(7, 3, constants, true));
    let cut = tested(springs::<3>(7, 3, constants, false));
    let (class, found) = cut.best(0).unwrap();
    assert_eq!(class.place, Place::Bulk);
    let expected = only(&endless).0;
    for (x, y) in found.c.iter().flatten().zip(expected.c.iter().flatten()) {
        assert!((x - y).abs() < 1e-9, "{found:?}");
    }
    for class in &cut.classes {
        assert!(class.long_waves);
        assert_eq!(class.stiffness.is_some(), class.place == Place::Bulk);
    }
    assert_eq!(cut.whole(0), None);
}

/// Bonds along x under the tension t: the stress is t along x, the energy by Lagrange's strain has C11 = a − t along x, a along y and z, and no more. A pressure does
/// not show in waves, what is left of the stress does.
#[test]
fn a_crystal_under_tension_has_the_stiffness_of_stress() {
    let (a, t) = (3.0, 0.4);
    let mut body = springs::<3>(4, 1, [a, 0.0], true);
    for block in &mut body.block {
        if block[0][0] != 0.0 {
            block[1][1] = t;
            block[2][2] = t;
        }
    }
    let mut expected = Stiffness {
        dimension: 3,
        c: [[0.0; 6]; 6],
    };
    for (v, c) in [a - t, a, a].into_iter().enumerate() {
        expected.c[v][v] = c;
    }
    let expected = expected.under_stress(&[[t, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
    let found = tested(body);
    let (c, long_waves) = only(&found);
    assert!(long_waves);
    for (x, y) in c.c.iter().flatten().zip(expected.c.iter().flatten()) {
        assert!((x - y).abs() < 1e-9, "{c:?} is not {expected:?}");
    }
}

/// Those of the crystal's potential, whether a pressure acts on it or not: what the crystal says of itself shares no code with bonds of linear bodies.
#[test]
fn a_crystal_of_many_bodies_keeps_its_constants() {
    // at least two ranges of the linear body long
    for (potential, spacing, cells) in [
        (embedded(), 2.0f64.sqrt(), 6),
        (embedded(), 1.41, 6),
        (lennard_jones(), 1.56, 3),
    ] {
        let spec = fcc(potential, spacing, cells);
        let body = model(&spec).linear_body().of::<3>().unwrap();
        let (crystal, _) = crystal::<3>(&spec).unwrap();
        let expected = crystal.stress_strain().unwrap();
        let found = tested(body.clone());
        let (c, long_waves) = only(&found);
        assert!(long_waves);
        let worst = (0..36).map(|n| (c.c[n / 6][n % 6] - expected.c[n / 6][n % 6]).abs());
        let worst = worst.fold(0.0, f64::max) / expected.c[0][0];
        println!(
            "spacing {spacing}: C11 {} {}, C12 {} {}, C44 {} {}, pressure {}, worst {worst:.1e}",
            c.c[0][0],
            expected.c[0][0],
            c.c[0][1],
            expected.c[0][1],
            c.c[3][3],
            expected.c[3][3],
            crystal.pressure()
        );
        assert!(worst < 1e-9, "{worst}");
        // under a pressure the tensor of stress against strain has these waves
        directions::<3>()
            .for_each(|n| same(acoustic(c, n), crystal.acoustic_tensor(n).unwrap(), 1e-9));
    }
}

fn lennard_jones() -> PotentialSpec {
    let form = LennardJones {
        epsilon: 1.0,
        sigma: 1.0,
    };
    PotentialSpec::of(form).ended(2.0, End::ShiftedForce)
}
