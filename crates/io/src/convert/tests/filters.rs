//! Bonds that filters cut in the other programs, by hand, against those that the new deck cuts.

use super::rules::{SHEET, cube, peridigm, perilab, read, times, told};
use super::*;
use peridyne::run::{Options, build};
use peridyne::spec::CrackShape;
use std::collections::HashSet;

/// A filter as a list.
fn filter(kind: &str, numbers: &[(&str, &[f64])]) -> String {
    let mut text = format!("    Bond Filters:\n      F:\n        Type: {kind}\n");
    for (name, values) in numbers {
        match values {
            [one] => text += &format!("        {name}: {one:?}\n"),
            all => {
                for (axis, v) in ["X", "Y", "Z"].iter().zip(*all) {
                    text += &format!("        {name}_{axis}: {v:?}\n");
                }
            }
        }
    }
    text
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Where a bond meets a plane, if it does, as both programs have it.
fn met(p: [f64; 3], q: [f64; 3], on: [f64; 3], n: [f64; 3]) -> Option<[f64; 3]> {
    let along = dot(minus(q, p), n);
    let t = dot(minus(on, p), n) / along;
    (along.abs() >= 1e-14 && (0.0..=1.0).contains(&t))
        .then(|| std::array::from_fn(|k| p[k] + t * (q[k] - p[k])))
}

/// Bonds of a cube that are there or not there otherwise than `cut` says, and how many that cuts; from both ends.
fn misses(deck: &Deck, cut: impl Fn([f64; 3], [f64; 3]) -> bool) -> (usize, usize) {
    let snapshot = build(&deck.spec, Options::default())
        .unwrap()
        .snapshot(&[], true);
    let place = |n: u32| -> [i64; 3] { snapshot.reference[n as usize].map(|c| c.round() as i64) };
    let there: HashSet<[[i64; 3]; 2]> = { snapshot.bonds.iter().flatten() }
        .flat_map(|(i, j)| [[place(*i), place(*j)], [place(*j), place(*i)]])
        .collect();
    let points: Vec<[i64; 3]> = (0..125).map(|n| [n % 5, n / 5 % 5, n / 25]).collect();
    let (mut misses, mut count) = (0, 0);
    for p in &points {
        for q in &points {
            let [a, b] = [p, q].map(|x| x.map(|c| c as f64));
            let d = minus(b, a);
            if p == q || dot(d, d) > 2.25 {
                continue;
            }
            let wanted = cut(a, b);
            count += usize::from(wanted);
            misses += usize::from(wanted == there.contains(&[*p, *q]));
        }
    }
    (misses, count)
}

#[test]
fn planes_cut_what_peridigm_cuts() {
    // normal, corner, bottom, lengths; the last ones are through points
    for (n, r, b, wide, high) in [
        ([1.0, 0.0, 0.0], [1.5, 0.5, 3.5], [0.0, 1.0, 0.0], 2.0, 2.0),
        // not of unit length: 2 r·b ≤ 4 is r ≤ 2, and 2·3 r·z ≤ 9 is r ≤ 1.5
        ([3.0, 0.0, 0.0], [1.5, 0.6, 3.4], [0.0, 2.0, 0.0], 4.0, 9.0),
        // not perpendicular: 0.8 r·y ≤ 1.2
        ([1.0, 0.0, 0.0], [1.5, 0.6, 3.4], [0.6, 0.8, 0.0], 1.2, 1.6),
        ([1.0, 1.0, 0.0], [2.5, 1.6, 0.4], [0.0, 0.0, 1.0], 2.2, 1.9),
        ([1.0, 0.0, 0.0], [2.0, 0.5, 3.5], [0.0, 1.0, 0.0], 2.0, 2.0),
        // the rim is cut: points on it
        ([1.0, 0.0, 0.0], [2.0, 1.0, 3.0], [0.0, 1.0, 0.0], 2.0, 2.0),
        ([1.0, 0.0, 0.0], [1.5, 1.0, 3.0], [0.0, 1.0, 0.0], 2.0, 2.0),
    ] {
        let text = filter(
            "Rectangular_Plane",
            &[
                ("Normal", &n),
                ("Lower_Left_Corner", &r),
                ("Bottom_Unit_Vector", &b),
                ("Bottom_Length", &[wide]),
                ("Side_Length", &[high]),
            ],
        );
        let (_, deck) = read(&cube(), &peridigm(&text, "", &times(0.0, 0.01)));
        let up = cross(b, n);
        let (misses, count) = misses(&deck, |p, q| {
            met(p, q, r, n).is_some_and(|x| {
                let d = minus(x, r);
                let within = |v: f64, most: f64| -1e-14 < v && v / most < 1.0 + 1e-14;
                within(dot(d, up), high) && within(dot(d, b), wide)
            })
        });
        assert!(
            misses == 0 && count > 4,
            "{n:?} {r:?} {b:?}: {misses} of {count}"
        );
    }
}

#[test]
fn disks_are_open_and_perilab_squares_their_radius() {
    // bonds along x at a distance of exactly 1 from the axis are not cut, also where points are on the disk
    for (center, radius) in [
        ([1.5, 2.0, 2.0], 1.0),
        ([2.0, 2.0, 2.0], 1.0),
        ([1.5, 2.0, 2.0], 1.3),
    ] {
        let n = [2.0, 0.0, 0.0];
        let numbers: [(&str, &[f64]); 3] =
            [("Center", &center), ("Normal", &n), ("Radius", &[radius])];
        let text = filter("Disk", &numbers);
        let (_, deck) = read(&cube(), &peridigm(&text, "", &times(0.0, 0.01)));
        let cut = |p, q| {
            met(p, q, center, n)
                .is_some_and(|x| dot(minus(x, center), minus(x, center)) < radius * radius)
        };
        let (misses, count) = misses(&deck, cut);
        assert!(
            misses == 0 && count > 4,
            "{center:?} {radius}: {misses} of {count}"
        );
    }
    let material = "        Material Model: PD Solid Elastic\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
    let numbers: [(&str, &[f64]); 3] = [
        ("Center", &[1.5, 2.0, 2.0]),
        ("Normal", &[1.0, 0.0, 0.0]),
        ("Radius", &[1.2]),
    ];
    let text = filter("Disk", &numbers).replace('_', " ");
    let deck =
        perilab(material, "", &times(0.0, 0.01)).replace("  Models:", &format!("{text}  Models:"));
    let (found, deck) = read(&cube(), &deck);
    let CrackShape::Disk { radius, .. } = deck.spec.damage.precracks[0].shape else {
        panic!("{}", found.text)
    };
    assert!((radius - 1.44).abs() < 1e-6, "{radius}");
}

#[test]
fn filters_that_cut_nothing_or_everything_are_refused() {
    let why = |n: [f64; 3], b: [f64; 3], wide: f64| {
        let text = filter(
            "Rectangular_Plane",
            &[
                ("Normal", &n),
                ("Lower_Left_Corner", &[1.5, 0.5, 0.5]),
                ("Bottom_Unit_Vector", &b),
                ("Bottom_Length", &[wide]),
                ("Side_Length", &[2.0]),
            ],
        );
        let (_dir, found) = told(&cube(), &peridigm(&text, "", &times(0.0, 0.01)));
        found
            .unwrap()
            .unmapped
            .first()
            .map(|u| u.why.clone())
            .unwrap()
    };
    assert!(why([0.0; 3], [0.0, 1.0, 0.0], 2.0).contains("normal is zero"));
    assert!(why([1.0, 0.0, 0.0], [2.0, 0.0, 0.0], 2.0).contains("the whole plane is cut"));
    assert!(why([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], -2.0).contains("expected a positive length"));
}

#[test]
fn planes_of_flat_bodies_are_lines() {
    // bottom along the line, at 45° to it, and of another length: PeriLab takes its direction alone
    for (b, to) in [
        ([0.0, 1.0], 0.8),
        ([0.0, 5.0], 0.8),
        ([1.0, 1.0], 0.8 * 2.0f64.sqrt()),
    ] {
        let numbers: [(&str, &[f64]); 5] = [
            ("Normal", &[3.0, 0.0]),
            ("Lower Left Corner", &[0.5, -0.1]),
            ("Bottom Unit Vector", &b),
            ("Bottom Length", &[0.8]),
            ("Side Length", &[1.0]),
        ];
        let text = filter("Rectangular_Plane", &numbers)
            .replace("r_", "r ")
            .replace("l_", "l ");
        let material = "        Material Model: PD Solid Elastic\n        Symmetry: isotropic plane stress\n        Bulk Modulus: 2.0\n        Shear Modulus: 1.0";
        let deck = perilab(material, "", &times(0.0, 0.01))
            .replace("  Models:", &format!("{text}  Models:"));
        let (found, deck) = read(SHEET, &deck.replace("r  ", "r "));
        let CrackShape::Segment { from, to: end } = &deck.spec.damage.precracks[0].shape else {
            panic!("{}", found.text)
        };
        let (low, high) = (from[1].min(end[1]), from[1].max(end[1]));
        assert!(
            (low + 0.1).abs() < 1e-9 && (high - to + 0.1).abs() < 1e-9,
            "{b:?}: {low} {high}"
        );
        assert_eq!([from[0], end[0]], [0.5, 0.5]);
    }
}
