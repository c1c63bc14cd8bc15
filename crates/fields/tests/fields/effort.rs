//! What fields will take is known beforehand, and whoever has had enough is heard.

use crate::sample::*;
use peridyne_fields::effort::{Effort, bonds_within};
use peridyne_fields::method::STOPPED;
use peridyne_fields::{Method, Shape, Targets, evaluate};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Images of every particle within φ about a grid of points, counted one by one.
#[test]
fn values_are_those_that_are_near() {
    let frame = gas(1);
    let targets = Targets::Grid([3, 4, 2]);
    for width in [1.3, 3.7] {
        let method = method(Shape::Polynomial(3), width);
        let mut near = 0usize;
        for x in targets.positions(&frame.cell) {
            for y in &frame.position {
                let range = -9..=9;
                for i in range.clone() {
                    for j in range.clone() {
                        for k in range.clone() {
                            let shift = frame.cell.shift([i, j, k]);
                            let square: f64 =
                                (0..3).map(|a| (y[a] + shift[a] - x[a]).powi(2)).sum();
                            near += usize::from(square < width * width);
                        }
                    }
                }
            }
        }
        let effort = Effort::of(&frame, 0.0, 0.0, &targets, &method);
        let ratio = effort.values / near as f64;
        // about: cells are not cubes, and gases have clusters
        assert!((0.5..2.0).contains(&ratio), "{width}: {ratio}");
    }
}

#[test]
fn what_never_ends_is_refused_with_its_numbers() {
    let frame = gas(1);
    let sites = embedded();
    let refused = |targets: &Targets, method: &Method| {
        let begun = Instant::now();
        let error = evaluate(&frame, &sites, targets, method).unwrap_err();
        assert!(begun.elapsed() < Duration::from_secs(1));
        error.to_string()
    };
    let points = Targets::Points(vec![[0.1, 0.2, 0.3]]);
    let wide = refused(&points, &method(Shape::CubicSpline, 1e6));
    assert!(
        wide.contains("images of the cell") && wide.contains("days") && wide.contains("narrower"),
        "{wide}"
    );
    // counts that overflow, and those that do not fit into memory
    let grid = refused(
        &Targets::Grid([1 << 30; 3]),
        &method(Shape::CubicSpline, 0.5),
    );
    assert!(grid.contains("points"), "{grid}");
    let within = bonds_within(&frame, 0.5);
    let effort = |n: usize| {
        let targets = Targets::Grid([n, n, n]);
        Effort::of(
            &frame,
            within,
            0.5,
            &targets,
            &method(Shape::CubicSpline, 0.5),
        )
    };
    // memory grows with the points
    let [small, large] = [100, 200].map(|n| effort(n).bytes);
    assert!((7.5..8.01).contains(&(large / small)), "{small} {large}");
    assert!(small > 1e6 * 8.0 * 64.0, "{small}");
}

static ENOUGH: AtomicBool = AtomicBool::new(false);

#[test]
fn whoever_has_had_enough_is_heard_at_once() {
    let frame = gas(1);
    let stop = || ENOUGH.load(Ordering::Relaxed);
    // ten seconds of work and more
    let wide = Method {
        stop,
        ..method(Shape::CubicSpline, 60.0)
    };
    let clock = std::thread::spawn(|| {
        std::thread::sleep(Duration::from_millis(200));
        let now = Instant::now();
        ENOUGH.store(true, Ordering::Relaxed);
        now
    });
    let error = evaluate(&frame, &embedded(), &Targets::Grid([12, 12, 12]), &wide).unwrap_err();
    let end = Instant::now();
    assert_eq!(error.to_string(), STOPPED);
    let heard = end.duration_since(clock.join().unwrap());
    assert!(heard < Duration::from_secs(1), "{heard:?}");
}
