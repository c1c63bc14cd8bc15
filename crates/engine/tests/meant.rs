//! Warnings of bodies that are likely not what was meant, beside the same bodies put right.

use peridyne::expression::Expression;
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn block(low: [f64; 2], high: [f64; 2]) -> Region {
    Region::Block {
        low: [low[0], low[1], -1.0],
        high: [high[0], high[1], 1.0],
    }
}

/// A plate of unit cells from 0 on; points are their middles.
fn plate(region: Region) -> Spec {
    let body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.5, 0.5, 0.0],
        region,
        perturb: None,
    };
    let mut spec = Spec::new(2, body, 1.0, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.horizon = Horizon::Ratio(3);
    spec
}

fn whole() -> Spec {
    plate(block([0.0; 2], [20.0, 10.0]))
}

fn told(spec: &Spec) -> Vec<String> {
    let sim = build(spec, Options::default()).unwrap();
    sim.info().warnings.iter().map(|w| w.to_string()).collect()
}

/// One warning with these words.
fn warns(spec: &Spec, words: &str) {
    let told = told(spec);
    assert!(told.len() == 1 && told[0].contains(words), "{told:?}");
}

fn silent(spec: &Spec) {
    let told = told(spec);
    assert!(told.is_empty(), "{told:?}");
}

fn cracked(y: f64) -> Spec {
    let mut spec = whole();
    spec.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-1.0, y, 0.0],
            to: [8.0, y, 0.0],
        },
        kind: CrackKind::Absent,
    });
    spec
}

#[test]
fn a_crack_through_points() {
    silent(&cracked(5.0));
    warns(
        &cracked(5.5),
        "pre-crack 1 runs through 8 points, (0.5, 5.5)",
    );
    // it meets two points of rows that it crosses
    let mut spec = cracked(5.0);
    spec.precracks[0].shape = CrackShape::Segment {
        from: [9.5, 4.5, 0.0],
        to: [10.5, 5.5, 0.0],
    };
    silent(&spec);
}

fn pulled(layers: f64, area: Option<f64>) -> Spec {
    let mut spec = whole();
    spec.sets.push(SetSpec {
        name: "top".into(),
        members: Members::Region(block([0.0, 10.0 - layers], [20.0, 10.0])),
    });
    spec.conditions.push(ConditionSpec {
        set: "top".into(),
        kind: ConditionKind::Traction {
            value: [None, Some(Expression::parse("1e-3", &[]).unwrap()), None],
            area,
        },
    });
    spec
}

#[test]
fn a_traction_on_several_layers() {
    silent(&pulled(1.0, None));
    silent(&pulled(3.0, Some(20.0)));
    // 18 of 20 points of each deeper layer are inside
    warns(
        &pulled(2.0, None),
        "each of its 40 points, of which 18 are inside",
    );
    warns(
        &pulled(3.0, None),
        "each of its 60 points, of which 36 are inside",
    );
}

#[test]
fn a_region_that_cells_do_not_fill() {
    silent(&whole());
    // faces through points, on one side or both
    silent(&plate(block([0.5, 0.0], [19.5, 10.0])));
    silent(&plate(block([0.5, 0.0], [20.0, 10.0])));
    warns(
        &plate(block([0.0; 2], [20.3, 10.0])),
        "along x the region is 20.3 long, and its body 20: 20 cells of 1, from 0 to 20",
    );
    // a disk has no cells to fill
    silent(&plate(Region::Sphere {
        center: [10.0, 10.0, 0.0],
        radius: 6.3,
    }));
}

fn without(part: Region) -> Spec {
    plate(Region::Difference(
        Box::new(block([0.0; 2], [20.0, 10.0])),
        vec![part],
    ))
}

#[test]
fn a_slot_that_bonds_bridge() {
    let mut slot = without(block([8.0, 5.0], [21.0, 6.0]));
    warns(&slot, "bonds reach across a gap in the body");
    // cut in its middle
    slot.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [8.0, 5.5, 0.0],
            to: [21.0, 5.5, 0.0],
        },
        kind: CrackKind::Absent,
    });
    silent(&slot);
    // as wide as the horizon, a corner, a large hole
    silent(&without(block([8.0, 4.0], [21.0, 7.0])));
    silent(&without(block([8.0, 5.0], [21.0, 11.0])));
    silent(&without(Region::Sphere {
        center: [10.0, 5.0, 0.0],
        radius: 3.4,
    }));
}
