//! J and K of a cracked plate against a handbook, and whether they depend on the rectangle.

use crate::sample::*;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A plate of width 2 and height 4 around 0 with a crack from −a to a along x, pulled along y by a stress of 1e-4; `n` spacings per
/// half width. Quarters of symmetry are not used.
fn plate(n: u32, a: f64, law: LawSpec) -> Spec {
    let h = 1.0 / f64::from(n);
    let mut spec = block([2 * n - 1, 4 * n - 1, 0], 2, h, law);
    if let BodySpec::Lattice { origin, region, .. } = &mut spec.body {
        *origin = [-1.0 + 0.5 * h, -2.0 + 0.5 * h, 0.0];
        *region = Region::Block {
            low: [-1.0, -2.0, 0.0],
            high: [1.0, 2.0, 0.0],
        };
    }
    let end = |name: &str, sign: f64| SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [0.0, -sign * (2.0 - 0.125), 0.0],
            normal: [0.0, sign, 0.0],
        }),
    };
    spec.sets = vec![end("bottom", 1.0), end("top", -1.0)];
    for (name, x, y) in [
        ("left", -1.0 + 0.5 * h, 0.5 * h),
        ("right", 1.0 - 0.5 * h, 0.5 * h),
    ] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Region(Region::Block {
                low: [x - 0.1 * h, y - 0.1 * h, 0.0],
                high: [x + 0.1 * h, y + 0.1 * h, 0.0],
            }),
        });
    }
    spec.damage.precracks = vec![PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-a, 0.0, 0.0],
            to: [a, 0.0, 0.0],
        },
        kind: CrackKind::Broken,
    }];
    // spread over whole rows
    push(&mut spec, "top", [None, text("1e-4/0.125"), None]);
    push(&mut spec, "bottom", [None, text("-1e-4/0.125"), None]);
    hold(&mut spec, "left", [text("0"), text("0"), None]);
    hold(&mut spec, "right", [None, text("0"), None]);
    statics(&mut spec, Method::Linear);
    spec
}

/// A square around the tip at (a, 0), `half` to each side.
fn around(a: f64, half: f64) -> Measure {
    Measure::JIntegral(JIntegralSpec {
        low: [a - half, -half],
        high: [a + half, half],
        direction: [1.0, 0.0],
    })
}

/// `σ √(πa)` with Tada's correction for the width 2 of the plate (Tada, Paris, Irwin, *The stress analysis of cracks handbook*,
/// 2.1; ±0.1 %), which is for long plates.
fn handbook(a: f64) -> f64 {
    let pi = std::f64::consts::PI;
    let width = (1.0 - 0.025 * a.powi(2) + 0.06 * a.powi(4)) / (0.5 * pi * a).cos().sqrt();
    1e-4 * (pi * a).sqrt() * width
}

const A: f64 = 0.4;

fn cracked(n: u32, law: LawSpec, halves: &[f64]) -> Box<dyn Simulation> {
    let mut spec = plate(n, A, law);
    for (k, half) in halves.iter().enumerate() {
        probe(&mut spec, &format!("{k}"), "all", around(A, *half));
    }
    run(&spec)
}

#[test]
fn k_converges_to_the_handbook() {
    let error = |n: u32| {
        let mut sim = cracked(n, PMB, &[0.5]);
        shown(sim.as_mut(), "0_K") / handbook(A) - 1.0
    };
    let errors = [24, 48].map(error);
    // the horizon over the crack is 0.31 and 0.16: first order
    assert!(errors[1].abs() < 0.05, "{errors:?}");
    assert!(errors[1].abs() < 0.7 * errors[0].abs(), "{errors:?}");
}

#[test]
fn j_does_not_depend_on_the_path() {
    for law in [PMB, LPS] {
        let mut sim = cracked(32, law.clone(), &[0.3, 0.4, 0.5]);
        let j = [0, 1, 2].map(|k| shown(sim.as_mut(), &format!("{k}_J")));
        for other in &j[1..] {
            assert!((other / j[0] - 1.0).abs() < 0.01, "{law:?}: {j:?}");
        }
    }
}

/// The energy that a longer crack would free, `J = −dΠ/2da` of both tips under constant loads, `Π = −U`.
#[test]
fn j_is_what_a_longer_crack_frees() {
    let n = 32;
    let h = 1.0 / f64::from(n);
    let energy = |a: f64| {
        let mut sim = run(&plate(n, a, PMB));
        sim.ledger().unwrap().strain
    };
    let (a, step) = (13.0 * h, h);
    let freed = (energy(a + step) - energy(a - step)) / (4.0 * step);
    let mut spec = plate(n, a, PMB);
    probe(&mut spec, "tip", "all", around(a, 0.4));
    let j = shown(run(&spec).as_mut(), "tip_J");
    assert!((j / freed - 1.0).abs() < 0.02, "{j:e} {freed:e}");
}

/// Without a crack there is no J, whatever the body does.
#[test]
fn a_whole_plate_has_no_j() {
    let mut spec = plate(24, A, LPS);
    spec.damage.precracks.clear();
    push(&mut spec, "top", [text("3e-4*x"), None, None]);
    push(&mut spec, "bottom", [text("3e-4*x"), None, None]);
    probe(&mut spec, "none", "all", around(0.1, 0.5));
    let j = shown(run(&spec).as_mut(), "none_J");
    // beside that of a crack
    let mut sim = cracked(24, LPS, &[0.5]);
    let crack = shown(sim.as_mut(), "0_J");
    assert!(j.abs() < 1e-3 * crack, "{j:e} {crack:e}");
}

#[test]
fn rectangles_that_mean_nothing_are_refused() {
    for (low, high, message) in [
        (
            [0.3, -0.1],
            [0.5, 0.1],
            "horizons on either side of the tip",
        ),
        ([0.0, -0.5], [1.2, 0.5], "leaves the body"),
        ([-0.9, 0.9], [0.9, 1.97], "held or loaded"),
    ] {
        let mut spec = plate(24, A, PMB);
        let direction = [1.0, 0.0];
        let j_integral = JIntegralSpec {
            low,
            high,
            direction,
        };
        probe(&mut spec, "tip", "all", Measure::JIntegral(j_integral));
        let Err(error) = build(&spec, Options::default()) else {
            panic!("{message}")
        };
        assert_eq!(error.path, "probes[0].corners");
        assert!(error.message.contains(message), "{}", error.message);
    }
    // statics before motion is not all of the run
    let mut spec = plate(24, A, PMB);
    probe(&mut spec, "tip", "all", around(A, 0.5));
    spec.run.preload = Some(PreloadSpec {
        statics: Statics {
            method: Method::Newton,
            ..Statics::default()
        },
        increments: 1,
        duration: None,
        conditions: std::mem::take(&mut spec.loading.conditions),
        rigid_bodies: vec![],
        cuts: vec![],
    });
    spec.run.schedule.stepper = Stepper::Verlet;
    let Err(error) = build(&spec, Options::default()) else {
        panic!("in motion")
    };
    assert_eq!(error.path, "probes[0]");
    assert!(
        error.message.contains("needs equilibrium"),
        "{}",
        error.message
    );
}
