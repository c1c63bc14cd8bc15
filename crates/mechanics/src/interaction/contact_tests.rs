use super::*;
use crate::body::zeros;
use crate::samples::{Random, lattice, sites};
use crate::space::lattice::LatticeKind;

const STIFFNESS: f64 = 3.0e5;
const BONDED: f64 = 0.9;
const RANGE: f64 = 1.35;

fn rule() -> Repulsion {
    Repulsion::uniform(STIFFNESS, BONDED, RANGE)
}

/// Distance and vector in the reference (`u` 0) or now, to the nearest image.
fn separation<const D: usize>(body: &Body<D>, u: &Field<D>, i: usize, j: usize) -> ([f64; D], f64) {
    let (p, q) = (body.position(i), body.position(j));
    let y = crate::array::from_fn(|a| {
        let d = (q[a] + u[a][j]) - (p[a] + u[a][i]);
        d - body.period[a].map_or(0.0, |l| l * (d / l).round())
    });
    let square: f64 = y.iter().map(|c: &f64| c * c).sum();
    (y, square.sqrt())
}

/// Forces, energy and number of contacts over all pairs farther than `horizon` in the reference.
fn brute<const D: usize>(body: &Body<D>, u: &Field<D>, horizon: f64) -> (Field<D>, f64, usize) {
    let rest = zeros::<D>(body.len);
    let mut f = zeros::<D>(body.len);
    let (mut energy, mut count) = (0.0, 0);
    for (k, &i) in body.slots.iter().enumerate() {
        for &j in &body.slots[k + 1..] {
            let (i, j) = (i as usize, j as usize);
            let r0 = separation(body, &rest, i, j).1;
            let (y, r) = separation(body, u, i, j);
            let d = (BONDED * r0).min(RANGE);
            if r0 <= horizon * (1.0 + 1e-9) || r >= d {
                continue;
            }
            let (vi, vj) = (body.volume.at(i), body.volume.at(j));
            for a in 0..D {
                f[a][i] += STIFFNESS * vj * (r - d) * y[a] / r;
                f[a][j] -= STIFFNESS * vi * (r - d) * y[a] / r;
            }
            energy += 0.5 * STIFFNESS * (r - d) * (r - d) * vi * vj;
            count += 1;
        }
    }
    (f, energy, count)
}

/// How far the fastest point went.
fn longest<const D: usize>(from: &Field<D>, to: &Field<D>) -> f64 {
    let square = |i: usize| (0..D).map(|a| (to[a][i] - from[a][i]).powi(2)).sum::<f64>();
    (0..to[0].len()).map(square).fold(0.0, f64::max).sqrt()
}

/// One `Contact` through several configurations against all pairs.
fn check<const D: usize>(
    body: &Body<D>,
    in_family: &dyn Fn(usize, usize) -> bool,
    horizon: f64,
    configurations: &[Field<D>],
) -> u64 {
    let mut contact = Contact::new(rule(), body, horizon, &[]);
    let mut most = 0;
    for (n, u) in configurations.iter().enumerate() {
        contact.moved(longest(&configurations[n.saturating_sub(1)], u));
        let mut f = zeros::<D>(body.len);
        contact.add_forces(body, u, &mut f, in_family);
        let (expected, energy, count) = brute(body, u, horizon);
        most = most.max(count);
        assert_eq!(contact.pairs_in_contact(u), count, "configuration {n}");
        assert!((contact.energy(body, u).value() - energy).abs() <= 1e-9 * energy);
        let scale = STIFFNESS * RANGE * body.volume.at(body.slots[0] as usize);
        for a in 0..D {
            let mut momentum = 0.0;
            for &s in &body.slots {
                let s = s as usize;
                assert!(
                    (f[a][s] - expected[a][s]).abs() <= 1e-8 * scale,
                    "configuration {n}"
                );
                momentum += f[a][s] * body.volume.at(s);
            }
            let v = body.volume.at(body.slots[0] as usize);
            assert!(momentum.abs() <= 1e-10 * scale * v * (1.0 + count as f64));
        }
    }
    assert!(most > 0, "nothing touched");
    contact.builds()
}

/// Two blocks that move into each other with some noise.
fn approach<const D: usize>(
    body: &Body<D>,
    gap: f64,
    first: impl Fn([f64; 3]) -> bool,
) -> Vec<Field<D>> {
    let mut random = Random(21);
    let noise: Vec<[f64; D]> = body
        .slots
        .iter()
        .map(|_| crate::array::from_fn(|_| 0.1 * random.next()))
        .collect();
    (0..40)
        .map(|n| {
            let mut u = body.at_rest();
            for (&s, noise) in body.slots.iter().zip(&noise) {
                let s = s as usize;
                let side = if first(body.position(s)) { 0.5 } else { -0.5 };
                for a in 0..D {
                    u[a][s] = noise[a];
                }
                u[D - 1][s] += side * gap * n as f64 / 40.0;
            }
            u
        })
        .collect()
}

fn blocks<const D: usize>(kind: LatticeKind, cells: [i32; 3], m: u32, periodic: [bool; D]) {
    // a gap of six cells across the last axis
    let middle = cells[D - 1] / 2;
    let quarters = sites(cells, |x| !(middle - 3..middle + 3).contains(&x[D - 1]));
    let (body, law) = lattice::<D>(kind, &quarters, 1.0, m, periodic);
    let in_family = |i: usize, j: usize| law.in_family(&body, i, j);
    let steps = approach(&body, 6.6, |x| x[D - 1] < middle as f64);
    let builds = check(&body, &in_family, m as f64, &steps);
    assert!(builds < 30, "{builds} builds");
}

#[test]
fn blocks_that_meet_push_each_other_away() {
    blocks::<1>(LatticeKind::Chain, [40, 1, 1], 3, [false]);
    blocks::<2>(LatticeKind::Square, [6, 14, 1], 3, [false; 2]);
    blocks::<3>(LatticeKind::Cubic, [5, 4, 13], 3, [false; 3]);
    blocks::<3>(LatticeKind::Cubic, [4, 4, 12], 2, [false; 3]);
    // a horizon shorter than the range of contact: neighbours on the diagonal are not in the family
    blocks::<2>(LatticeKind::Square, [6, 14, 1], 1, [false; 2]);
}

#[test]
fn blocks_meet_across_a_periodic_face() {
    blocks::<2>(LatticeKind::Square, [8, 14, 1], 3, [true, false]);
    blocks::<3>(LatticeKind::Cubic, [8, 6, 13], 2, [true, false, false]);
    // the last axis is periodic, and they part in the middle and meet at the ends
    let quarters = sites([7, 20, 1], |x| (4..16).contains(&x[1]));
    let frame: Vec<[i32; 3]> = [[0, 0, 0], [0, 76, 0]]
        .into_iter()
        .chain(quarters)
        .collect();
    let (body, law) = lattice::<2>(LatticeKind::Square, &frame, 1.0, 3, [false, true]);
    let in_family = |i: usize, j: usize| law.in_family(&body, i, j);
    let steps = approach(&body, 8.4, |x| x[1] > 9.5);
    check(&body, &in_family, 3.0, &steps);
}

#[test]
fn debris_far_away_still_touches() {
    let quarters = sites([6, 6, 14], |x| x[2] < 5 || x[2] >= 11);
    let (body, law) = lattice::<3>(LatticeKind::Cubic, &quarters, 1.0, 2, [false; 3]);
    let in_family = |i: usize, j: usize| law.in_family(&body, i, j);
    let mut steps = approach(&body, 6.8, |x| x[2] < 8.0);
    for (n, u) in steps.iter_mut().enumerate() {
        for (k, &s) in body.slots.iter().enumerate() {
            // both blocks in part at 1e6, in part at 3e4, and a few single points anywhere
            let s = s as usize;
            let x = body.position(s)[0];
            u[0][s] += if x < 2.0 { 1e6 + n as f64 } else { 0.0 };
            u[1][s] += if x > 4.0 { -3e4 } else { 0.0 };
            if k % 17 == 0 {
                u[1][s] += 1e6 * (k as f64 - 100.0);
            }
        }
    }
    check(&body, &in_family, 2.0, &steps);
}

#[test]
fn a_cloud_with_volumes_of_its_own() {
    let mut random = Random(5);
    let cloud: Vec<[f64; 3]> = (0..400)
        .map(|k| {
            let z = if k % 2 == 0 { 9.0 } else { 0.0 };
            [
                4.0 * random.next(),
                4.0 * random.next(),
                z + 1.5 * random.next(),
            ]
        })
        .collect();
    let volume: Vec<f64> = cloud.iter().map(|x| 1.0 + 0.1 * x[0]).collect();
    let body = Body::<3>::from_cloud(&cloud, &volume, &[], 1.0, [None; 3]).unwrap();
    let rest = zeros::<3>(body.len);
    let in_family = |i: usize, j: usize| separation(&body, &rest, i, j).1 <= 2.5;
    check(
        &body,
        &in_family,
        2.5,
        &approach(&body, 8.0, |x| x[2] < 4.5),
    );
    // the same without the promise
    let steps = approach(&body, 8.0, |x| x[2] < 4.5);
    let (mut f, mut g) = (zeros::<3>(body.len), zeros::<3>(body.len));
    Contact::new(rule(), &body, 0.0, &[]).add_forces(&body, &steps[35], &mut f, &in_family);
    Contact::new(rule(), &body, 2.5, &[]).add_forces(&body, &steps[35], &mut g, &in_family);
    assert!(f == g && f[0].iter().any(|x| *x != 0.0));
}

#[test]
fn a_range_of_nothing_or_next_to_nothing_is_harmless() {
    let quarters = sites([30, 30, 1], |_| true);
    let (body, law) = lattice::<2>(LatticeKind::Square, &quarters, 1.0, 2, [false; 2]);
    for range in [0.0, -1.0, f64::NAN, 1e-9, 1e-300] {
        let rule = Repulsion::uniform(STIFFNESS, BONDED, range);
        let mut contact = Contact::new(rule, &body, 2.0, &[]);
        let mut f = zeros::<2>(body.len);
        let calls = std::cell::Cell::new(0);
        contact.add_forces(&body, &body.at_rest(), &mut f, &|i, j| {
            calls.set(calls.get() + 1);
            law.in_family(&body, i, j)
        });
        assert!(f.iter().flatten().all(|x| *x == 0.0));
        assert_eq!(calls.get(), 0, "{range}");
    }
}

#[test]
fn force_is_the_gradient_of_energy() {
    let quarters = sites([5, 12, 1], |x| x[1] < 3 || x[1] >= 9);
    let (body, law) = lattice::<2>(LatticeKind::Square, &quarters, 1.0, 3, [false; 2]);
    let in_family = |i: usize, j: usize| law.in_family(&body, i, j);
    let mut u = approach(&body, 6.6, |x| x[1] < 6.0)[37].clone();
    let mut contact = Contact::new(rule(), &body, 3.0, &[]);
    let mut f = zeros::<2>(body.len);
    contact.add_forces(&body, &u, &mut f, &in_family);
    let mut pushed = 0;
    for &s in &body.slots {
        let s = s as usize;
        for a in 0..2 {
            let (x, step) = (u[a][s], 1e-6);
            u[a][s] = x + step;
            let up = contact.energy(&body, &u).value();
            u[a][s] = x - step;
            let down = contact.energy(&body, &u).value();
            u[a][s] = x;
            let force = f[a][s] * body.volume.at(s);
            let slope = (up - down) / (2.0 * step);
            assert!((force + slope).abs() < 1e-7 * STIFFNESS, "{force} {slope}");
            pushed += usize::from(force.abs() > 1e-3 * STIFFNESS);
        }
    }
    assert!(pushed > 8, "{pushed}");
}

#[test]
fn threads_do_not_show() {
    let quarters = sites([30, 30, 26], |x| x[2] < 10 || x[2] >= 16);
    let (body, law) = lattice::<3>(LatticeKind::Cubic, &quarters, 1.0, 2, [false; 3]);
    let steps = approach(&body, 7.0, |x| x[2] < 13.0);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut contact = Contact::new(rule(), &body, 2.0, &[]);
            let mut f = zeros::<3>(body.len);
            for (before, u) in steps[29..].iter().zip(&steps[30..]) {
                contact.moved(longest(before, u));
                contact.add_forces(&body, u, &mut f, &|i, j| law.in_family(&body, i, j));
            }
            (f, contact.builds())
        })
    };
    let one = run(1);
    assert!(one.0[2].iter().any(|x| *x != 0.0));
    for threads in [2, 3, 7] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

/// `in_family` of a stencil is the test of the reference distance, also around short periods.
#[test]
fn families_of_stencils_know_their_members() {
    fn all<const D: usize>(kind: LatticeKind, cells: [i32; 3], m: u32, periodic: [bool; D]) {
        let basis = kind.basis();
        let mut quarters = vec![];
        for c in sites(cells, |_| true) {
            for b in basis {
                quarters.push(crate::array::from_fn(|a| c[a] + b[a]));
            }
        }
        let (body, law) = lattice::<D>(kind, &quarters, 0.3, m, periodic);
        let rest = zeros::<D>(body.len);
        let mut inside = 0;
        for &i in &body.slots {
            for &j in &body.slots {
                let (i, j) = (i as usize, j as usize);
                if i == j {
                    continue;
                }
                let near = separation(&body, &rest, i, j).1 <= 0.3 * m as f64 * (1.0 + 1e-9);
                assert_eq!(law.in_family(&body, i, j), near, "{kind:?} {i} {j}");
                inside += usize::from(near);
            }
        }
        assert!(inside > 0);
    }
    all::<1>(LatticeKind::Chain, [9, 1, 1], 3, [false]);
    all::<1>(LatticeKind::Chain, [9, 1, 1], 3, [true]);
    all::<1>(LatticeKind::Chain, [4, 1, 1], 3, [true]);
    all::<2>(LatticeKind::Square, [9, 8, 1], 3, [false, true]);
    all::<2>(LatticeKind::Triangular, [6, 5, 1], 2, [true, false]);
    all::<3>(LatticeKind::Cubic, [5, 6, 4], 2, [true, false, true]);
    all::<3>(LatticeKind::Fcc, [4, 3, 3], 1, [false, true, false]);
    all::<3>(LatticeKind::Diamond, [3, 3, 2], 1, [true, false, false]);
}
