//! A compact test: the area under its load–displacement curve is the fracture energy.

use super::{block, e};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

/// Width and height of the specimen, depth of its notch (spacings).
const WIDTH: i32 = 40;
const HEIGHT: i32 = 40;
const NOTCH: f64 = 16.0;
/// Energy per area of crack, in the units of Young's modulus times a spacing.
const ENERGY: f64 = 2e-5;

/// Two pins pull a notched plate of bonds that soften apart until it is in two.
#[test]
fn the_work_of_a_compact_test_is_its_fracture_energy() {
    let law = LawSpec::named(
        "softening",
        Parameters::numbers(&[("young", 1.0), ("onset", 0.1)]),
    );
    let mut spec = block(LatticeKind::Square, [WIDTH, HEIGHT, 1], 3, law);
    spec.influence = Influence::Constant;
    spec.plane = Plane::Stress;
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Energy(ENERGY),
        alpha: 0.0,
    });
    let left = -0.5 * f64::from(WIDTH);
    spec.precracks = vec![PrecrackSpec {
        shape: CrackShape::Segment {
            from: [left - 1.0, 0.0, 0.0],
            to: [left + NOTCH, 0.0, 0.0],
        },
        kind: CrackKind::Broken,
    }];
    let pin = |sign: f64| {
        Members::Region(Region::Sphere {
            center: [left + 8.0, 10.0 * sign, 0.0],
            radius: 2.5,
        })
    };
    spec.sets = [("low", -1.0), ("high", 1.0)]
        .map(|(name, sign)| SetSpec {
            name: name.into(),
            members: pin(sign),
        })
        .to_vec();
    const SPEED: f64 = 1e-4;
    spec.conditions = [("low", -1.0), ("high", 1.0)]
        .map(|(set, sign)| ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Velocity([None, Some(e(&format!("{:e}", sign * SPEED))), None]),
        })
        .to_vec();
    spec.probes = vec![ProbeSpec {
        name: "load".into(),
        set: "high".into(),
        measure: Measure::Reaction,
    }];
    const STEP: f64 = 0.4;
    spec.schedule.time_step = TimeStep::Fixed(STEP);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let (mut area, mut peak, mut last) = (0.0, 0.0f64, 0.0);
    let mut steps = 0;
    while sim.fragments() < 2 && steps < 60_000 {
        sim.step().unwrap();
        steps += 1;
        let load = sim.measure()[1];
        area += 0.5 * (load + last) * 2.0 * SPEED * STEP;
        peak = peak.max(load);
        last = load;
    }
    let ledger = sim.ledger().unwrap();
    let crack = ENERGY * (f64::from(WIDTH) - NOTCH);
    let left_over = ledger.kinetic + ledger.strain;
    println!(
        "{steps} steps, peak {peak:.3e}, last load {last:.1e}: area {:.4}, still moving {:.4} of the fracture energy",
        area / crack,
        left_over / crack
    );
    assert!(sim.fragments() == 2, "it is in {} pieces", sim.fragments());
    assert!(last.abs() < 0.02 * peak, "{last} of {peak}");
    // the probes' area is the work of the ledger
    assert!((area - ledger.work_conditions).abs() < 0.01 * area);
    assert!(
        (area - left_over - crack).abs() < 0.1 * crack,
        "{area} of {crack}"
    );
}
