//! Probes of cracks: where they end, how far they open, what they cut off.

use crate::sample::{PMB, block, hold, made, probe, run, shown, statics, text};
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A plate of 41 × 21 points at whole numbers with a crack of broken bonds.
fn cut(from: [f64; 2], to: [f64; 2]) -> Spec {
    let mut spec = block([40, 20, 0], 2, 1.0, PMB);
    let place = |x: [f64; 2]| [x[0], x[1], 0.0];
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: place(from),
            to: place(to),
        },
        kind: CrackKind::Broken,
    });
    spec
}

fn crack(from: [f64; 2], direction: [f64; 2]) -> Measure {
    Measure::CrackTip(CrackTipSpec {
        from: [from[0], from[1], 0.0],
        direction: [direction[0], direction[1], 0.0],
        damage: 0.3,
    })
}

/// Bonds of three spacings are counted by hand: ahead of the tip at x = 20.5, points at x = 20 and
/// y = 10 or 11 have lost 10 of 28, those at x = 21 have lost 3.
#[test]
fn the_tip_is_the_last_point_that_has_lost_so_many_bonds() {
    let mut spec = cut([-1.0, 10.5], [20.5, 10.5]);
    probe(&mut spec, "tip", "all", crack([0.0, 10.5], [1.0, 0.0]));
    probe(&mut spec, "back", "all", crack([20.5, 10.5], [-1.0, 0.0]));
    probe(&mut spec, "away", "all", crack([36.0, 10.5], [1.0, 0.0]));
    let mut sim = made(&spec);
    let damage = sim.column("damage").unwrap().values;
    let id = |x: usize, y: usize| y * 41 + x;
    assert!((28.0 * damage.at(id(20, 10), 0) - 10.0).abs() < 1e-12);
    assert!((28.0 * damage.at(id(21, 10), 0) - 3.0).abs() < 1e-12);
    let mut value = |name: &str| shown(sim.as_mut(), name);
    assert_eq!(
        [value("tip_x"), value("tip_length"), value("tip_branches")],
        [20.0, 20.0, 1.0]
    );
    // of the rows on either side the lower one has the lower ids
    assert_eq!(value("tip_y"), 10.0);
    assert_eq!([value("back_x"), value("back_length")], [0.0, 20.5]);
    assert_eq!(
        [value("away_x"), value("away_y"), value("away_length")],
        [36.0, 10.5, 0.0]
    );
    assert_eq!(value("away_branches"), 0.0);
}

/// A place beside the body is a slip, of units perhaps.
#[test]
fn a_crack_starts_in_the_body() {
    let mut spec = cut([-1.0, 10.5], [20.5, 10.5]);
    probe(&mut spec, "tip", "all", crack([44.0, 10.5], [1.0, 0.0]));
    let error = peridyne::run::build(&spec, peridyne::run::Options::default()).err();
    let error = error.unwrap();
    assert_eq!(error.path, "probes[0].from");
    let said = error.message.to_string();
    assert!(said.contains("within a horizon"), "{said}");
}

/// Lengths count along the direction, whichever it is; a set limits what counts.
#[test]
fn a_crack_is_followed_along_any_direction_and_in_a_set() {
    let mut spec = cut([20.5, -1.0], [20.5, 8.5]);
    spec.sets.push(SetSpec {
        name: "below".into(),
        members: Members::Region(Region::Block {
            low: [-1.0; 3],
            high: [50.0, 4.0, 1.0],
        }),
    });
    probe(&mut spec, "up", "all", crack([20.5, 0.0], [0.0, 1.0]));
    probe(&mut spec, "set", "below", crack([20.5, 0.0], [0.0, 1.0]));
    probe(&mut spec, "tilted", "all", crack([20.5, 0.0], [0.6, 0.8]));
    let mut sim = made(&spec);
    let mut value = |name: &str| shown(sim.as_mut(), name);
    assert_eq!(
        [value("up_x"), value("up_y"), value("up_length")],
        [20.0, 8.0, 8.0]
    );
    assert_eq!(value("set_length"), 4.0);
    // 0.6 · 0.5 + 0.8 · 8
    assert_eq!([value("tilted_x"), value("tilted_y")], [21.0, 8.0]);
    assert!((value("tilted_length") - 6.7).abs() < 1e-14);
}

/// The last two columns of points go where they want; no other.
#[test]
fn an_opening_is_between_the_points_nearest_to_two_places() {
    let mut spec = block([10, 6, 0], 2, 1.0, PMB);
    statics(&mut spec, Method::Linear);
    spec.sets.push(SetSpec {
        name: "told".into(),
        members: Members::Region(Region::Block {
            low: [-1.0; 3],
            high: [8.5, 9.0, 1.0],
        }),
    });
    hold(
        &mut spec,
        "told",
        [text("0.01*x - 0.02*y"), text("0.03*x + 0.001*x*y"), None],
    );
    let between = [[1.2, 0.9, 0.0], [7.0, 5.4, 0.0]];
    probe(&mut spec, "gauge", "all", Measure::Opening { between });
    let mut sim = run(&spec);
    let u = |x: f64, y: f64| [0.01 * x - 0.02 * y, 0.03 * x + 0.001 * x * y];
    let (a, b) = (u(1.0, 1.0), u(7.0, 5.0));
    let eta = [b[0] - a[0], b[1] - a[1]];
    let longer = (6.0 + eta[0]).hypot(4.0 + eta[1]) - 6f64.hypot(4.0);
    let mut value = |name: &str| shown(sim.as_mut(), name);
    for (name, right) in [("gauge", longer), ("gauge_x", eta[0]), ("gauge_y", eta[1])] {
        assert!(
            (value(name) - right).abs() < 1e-15,
            "{name}: {} {right}",
            value(name)
        );
    }
    spec.run.probes[0].measure = Measure::Opening {
        between: [[1.2, 0.9, 0.0], [0.8, 1.1, 0.0]],
    };
    let error = peridyne::run::build(&spec, peridyne::run::Options::default())
        .err()
        .unwrap();
    assert_eq!(error.path, "probes[0].between");
}

/// A cut between the columns x = 10 and 11: 11 × 21 and 30 × 21 points of density 3.
#[test]
fn fragments_are_counted_and_weighed() {
    let mut spec = cut([10.5, -1.0], [10.5, 30.0]);
    probe(&mut spec, "all", "all", Measure::Fragments { points: 1 });
    probe(
        &mut spec,
        "large",
        "all",
        Measure::Fragments { points: 300 },
    );
    let mut sim = made(&spec);
    let mass = sim.info().mass / (41.0 * 21.0);
    let mut value = |name: &str| shown(sim.as_mut(), name);
    assert_eq!([value("all_count"), value("large_count")], [2.0, 1.0]);
    for (name, points) in [("all_largest", 630.0), ("all_others", 231.0)] {
        assert!(
            (value(name) / (points * mass) - 1.0).abs() < 1e-12,
            "{name}"
        );
    }
}
