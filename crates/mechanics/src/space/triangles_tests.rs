use super::*;
use crate::space::rigid::RigidShape;
use std::sync::Arc;

/// A box as triangles, edges of lengths `2 half`.
fn of_box(half: Point) -> Vec<[Point; 3]> {
    let at = |n: usize| -> Point {
        crate::array::from_fn(|a| if n >> a & 1 == 1 { half[a] } else { -half[a] })
    };
    // corners of the faces, counter-clockwise from outside
    let faces = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = |f: &[usize; 4]| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]];
    let all = faces.iter().flat_map(halves);
    all.map(|t| t.map(at)).collect()
}

/// A sphere as triangles: an octahedron whose faces are halved `times` times.
fn of_sphere(times: usize) -> Vec<[Point; 3]> {
    let mut all = vec![];
    for n in 0..8usize {
        let axis = |a: usize| -> Point {
            let mut x = [0.0; 3];
            x[a] = if n >> a & 1 == 1 { -1.0 } else { 1.0 };
            x
        };
        let odd = n.count_ones() % 2 == 1;
        all.push(if odd {
            [axis(0), axis(2), axis(1)]
        } else {
            [axis(0), axis(1), axis(2)]
        });
    }
    for _ in 0..times {
        let middle = |a: &Point, b: &Point| -> Point {
            let x: Point = crate::array::from_fn(|k| a[k] + b[k]);
            x.map(|c| c / length(&x))
        };
        all = all
            .iter()
            .flat_map(|[a, b, c]| {
                let (p, q, r) = (middle(a, b), middle(b, c), middle(c, a));
                [[*a, p, r], [p, *b, q], [r, q, *c], [p, q, r]]
            })
            .collect();
    }
    all
}

fn solid(all: &[[Point; 3]]) -> Solid {
    Solid::new(Triangles::new(all).unwrap()).unwrap()
}

/// Numbers from −1 to 1.
fn numbers() -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[test]
fn a_box_of_triangles_is_the_box() {
    let half = [0.5, 0.8, 1.1];
    let (exact, made) = (RigidShape::Box { half }, solid(&of_box(half)));
    assert!((made.volume() - exact.volume(3)).abs() < 1e-14);
    let (shape, mut next) = (RigidShape::Solid(Arc::new(made)), numbers());
    for (a, b) in shape
        .inertia(3)
        .iter()
        .flatten()
        .zip(exact.inertia(3).iter().flatten())
    {
        assert!((a - b).abs() < 1e-14, "{a} {b}");
    }
    let (mut inside, mut outside) = (0, 0);
    for _ in 0..4000 {
        let x: Point = crate::array::from_fn(|_| 2.0 * next());
        let ((d, n), (e, m)) = (exact.distance(&x), shape.distance(&x));
        *(if d < 0.0 { &mut inside } else { &mut outside }) += 1;
        assert!((d - e).abs() < 1e-14, "{x:?}: {d} {e}");
        let apart = (0..3).map(|a| (n[a] - m[a]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-12, "{x:?}: {n:?} {m:?}");
    }
    assert!(inside > 200 && outside > 2000);
}

#[test]
fn a_sphere_of_triangles_comes_to_the_sphere_at_second_order() {
    let exact = RigidShape::Sphere { radius: 1.0 };
    let mut before: Option<[f64; 3]> = None;
    for times in 2..6 {
        let made = solid(&of_sphere(times));
        let volume = (made.volume() - exact.volume(3)).abs();
        let shape = RigidShape::Solid(Arc::new(made));
        let inertia = (shape.inertia(3)[0][0] - exact.inertia(3)[0][0]).abs();
        let (mut next, mut worst) = (numbers(), 0.0f64);
        for _ in 0..400 {
            let x: Point = crate::array::from_fn(|_| 1.5 * next());
            worst = worst.max((shape.distance(&x).0 - exact.distance(&x).0).abs());
        }
        let now = [volume, inertia, worst];
        println!(
            "{times} halvings: volume {volume:.2e}, inertia {inertia:.2e}, distance {worst:.2e}"
        );
        if let Some(before) = before {
            for (a, b) in before.iter().zip(now) {
                // edges of half the length: a quarter
                assert!((3.3..4.7).contains(&(a / b)), "{before:?} {now:?}");
            }
        }
        before = Some(now);
    }
}

#[test]
fn the_tree_finds_what_all_triangles_have() {
    let all = of_sphere(4);
    let (made, mut next) = (solid(&all), numbers());
    for _ in 0..300 {
        let x: Point = crate::array::from_fn(|_| 1.5 * next());
        let each = (0..all.len()).map(|n| {
            let to = sub(&x, &nearest(&made.triangles.corners(n), &x).0);
            length(&to)
        });
        let least = each.fold(f64::INFINITY, f64::min);
        assert!((made.distance(&x).0.abs() - least).abs() < 1e-12);
    }
}

#[test]
fn what_is_no_surface_of_a_body_is_refused_in_words() {
    let whole = of_box([1.0; 3]);
    let said = |all: &[[Point; 3]]| match Triangles::new(all) {
        Err(message) => message,
        Ok(triangles) => Solid::new(triangles).err().unwrap_or_default(),
    };
    assert_eq!(said(&whole), "");
    assert!(said(&[]).contains("no triangles"));
    assert!(
        said(&whole[1..]).contains("not closed"),
        "{}",
        said(&whole[1..])
    );
    let turned = |n: usize, all: &mut Vec<[Point; 3]>| all[n].swap(0, 1);
    let mut one = whole.clone();
    turned(3, &mut one);
    assert!(said(&one).contains("has no inside"), "{}", said(&one));
    let mut in_side_out = whole.clone();
    (0..whole.len()).for_each(|n| turned(n, &mut in_side_out));
    assert!(said(&in_side_out).contains("inwards"));
    let twice = [whole.clone(), whole.clone()].concat();
    assert!(said(&twice).contains("no boundary"), "{}", said(&twice));
    let mut flat = whole.clone();
    flat[5][1] = flat[5][0];
    assert!(
        said(&flat).contains("triangle 6 has no area"),
        "{}",
        said(&flat)
    );
    let mut nan = whole;
    nan[2][1][0] = f64::NAN;
    assert!(said(&nan).contains("triangle 3 has the coordinate NaN"));
}
