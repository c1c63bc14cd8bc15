use super::*;
use crate::body::{FieldView, view};
use crate::samples::{Random, lattice, sites};
use crate::space::lattice::LatticeKind;

type Pairs = Vec<(usize, usize)>;

fn listed<const D: usize>(list: &Neighbours<D>) -> Pairs {
    list.rows()
        .flat_map(|(i, row)| row.iter().map(move |j| (i, *j as usize)))
        .collect()
}

/// All pairs closer than `reach`, by looking at all.
fn brute<const D: usize>(body: &Body<D>, u: FieldView<D>, reach: f64) -> Pairs {
    let mut slots: Vec<usize> = body.slots.iter().map(|s| *s as usize).collect();
    slots.sort_unstable();
    let mut pairs = vec![];
    for (k, &i) in slots.iter().enumerate() {
        for &j in &slots[k + 1..] {
            let (p, q) = (body.position(i), body.position(j));
            let mut square = 0.0;
            for a in 0..D {
                let mut d = (q[a] + u[a][j]) - (p[a] + u[a][i]);
                if let Some(l) = body.period[a] {
                    d -= l * (d / l).round();
                }
                square += d * d;
            }
            if square.sqrt() < reach {
                pairs.push((i, j));
            }
        }
    }
    pairs
}

/// How far the fastest point went.
fn longest<const D: usize>(from: FieldView<D>, to: FieldView<D>) -> f64 {
    let square = |i: usize| (0..D).map(|a| (to[a][i] - from[a][i]).powi(2)).sum::<f64>();
    (0..to[0].len()).map(square).fold(0.0, f64::max).sqrt()
}

/// A random walk, now and then with a leap: at every step no near pair is missing; after a build the list is exact.
fn walk<const D: usize>(body: &Body<D>, h: f64, seed: u64) {
    let (cutoff, skin) = (1.2 * h, 0.4 * h);
    let mut list = Neighbours::new(body, cutoff, skin);
    let mut u = body.at_rest();
    let mut random = Random(seed);
    let keep = |i: usize, j: usize| !(i + j).is_multiple_of(5);
    let mut kept_old = 0;
    for step in 0..60 {
        let before = u.clone();
        for &s in &body.slots {
            let leap = step % 20 == 13 && random.next() > 0.95;
            for c in &mut u {
                c[s as usize] += h * random.next() * if leap { 1e6 } else { 0.05 };
            }
        }
        list.moved(longest(view(&before), view(&u)));
        let built = list.update(body, &mut Ghosts::default(), view(&u), &keep);
        let have = listed(&list);
        assert!(have.is_sorted());
        if built {
            let mut all = brute(body, view(&u), cutoff + skin);
            all.retain(|p| keep(p.0, p.1));
            assert_eq!(have, all, "step {step}");
        } else {
            kept_old += 1;
        }
        for p in brute(body, view(&u), cutoff) {
            assert!(
                !keep(p.0, p.1) || have.binary_search(&p).is_ok(),
                "step {step}: {p:?}"
            );
        }
    }
    assert!(
        kept_old > 20 && list.builds() > 5,
        "{kept_old} {}",
        list.builds()
    );
}

#[test]
fn a_walk_never_loses_a_pair() {
    let h = 0.01;
    let line = sites([40, 1, 1], |_| true);
    let sheet = sites([12, 9, 1], |_| true);
    let block = sites([9, 4, 7], |x| x[0] != 4 || x[2] < 2);
    for p in [false, true] {
        walk(&lattice::<1>(LatticeKind::Chain, &line, h, 2, [p]).0, h, 3);
        walk(
            &lattice::<2>(LatticeKind::Square, &sheet, h, 2, [false, p]).0,
            h,
            4,
        );
        walk(
            &lattice::<3>(LatticeKind::Cubic, &block, h, 2, [p, p, false]).0,
            h,
            5,
        );
    }
    let mut random = Random(9);
    let cloud: Vec<[f64; 3]> = (0..300)
        .map(|_| crate::array::from_fn(|_| 0.035 * random.next()))
        .collect();
    let volume = vec![1e-6; cloud.len()];
    for period in [[None; 3], [Some(0.07), None, Some(0.07)], [Some(0.07); 3]] {
        walk(
            &Body::from_cloud(&cloud, &volume, &[], h, period).unwrap(),
            h,
            6,
        );
    }
}

#[test]
fn the_skin_is_measured_from_the_build() {
    let (body, _) = lattice::<2>(
        LatticeKind::Square,
        &sites([5, 5, 1], |_| true),
        1.0,
        2,
        [false; 2],
    );
    for far in [0.0, 1e6, -3e7] {
        let mut list = Neighbours::new(&body, 1.1, 0.2);
        let mut u = body.at_rest();
        let s = body.slots[7] as usize;
        u[0][s] = far;
        assert!(list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true));
        // many small steps: 0.09 is within skin/2, 0.1 is not
        for k in 1..=9 {
            u[0][s] = far + 0.01 * k as f64;
            list.moved(0.01);
            assert!(
                !list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true),
                "{far}: {k}"
            );
        }
        u[0][s] = far + 0.101;
        list.moved(0.011);
        assert!(list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true));
        assert!(!list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true));
    }
}

#[test]
fn cells_that_moved_together_are_passed_over() {
    // two blocks, four apart, the second moved onto the first; inside a block displacements differ by little
    let quarters = sites([6, 14, 6], |x| x[1] < 5 || x[1] >= 9);
    let (body, _) = lattice::<3>(LatticeKind::Cubic, &quarters, 1.0, 2, [false; 3]);
    let mut u = body.at_rest();
    let mut random = Random(11);
    for &s in &body.slots {
        u[0][s as usize] = 0.1 * random.next();
        u[1][s as usize] = if body.position(s as usize)[1] > 7.0 {
            -4.3
        } else {
            0.0
        };
    }
    let reach = 1.8;
    let mut list = Neighbours::new(&body, 1.5, 0.3).apart(1.0);
    list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true);
    let mut expected = brute(&body, view(&u), reach);
    let all = expected.len();
    expected.retain(|&(i, j)| (u[1][i] < -1.0) != (u[1][j] < -1.0));
    assert!(expected.len() > 100 && expected.len() < all / 2);
    assert_eq!(listed(&list), expected);
}

#[test]
fn what_is_not_finite_does_no_harm() {
    let (body, _) = lattice::<2>(
        LatticeKind::Square,
        &sites([5, 5, 1], |_| true),
        1.0,
        2,
        [false; 2],
    );
    let mut list = Neighbours::new(&body, 1.1, 0.2);
    let mut u = body.at_rest();
    list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true);
    let whole = list.len();
    u[0][body.slots[12] as usize] = f64::INFINITY;
    u[1][body.slots[11] as usize] = 1e300;
    list.moved(f64::INFINITY);
    assert!(list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true));
    assert_eq!(list.len(), whole - 7);
    u[0][body.slots[12] as usize] = f64::NAN;
    list.moved(f64::NAN);
    list.update(&body, &mut Ghosts::default(), view(&u), &|_, _| true);
    assert_eq!(list.len(), whole - 7);
}
