//! A compact test: the area under its load–displacement curve is the fracture energy.

use super::{block, e};
use peridyne::run::{Options, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

/// Width and height of the specimen, depth of its notch (spacings).
const WIDTH: i32 = 40;
const HEIGHT: i32 = 40;
const NOTCH: f64 = 24.0;
/// Energy per area of crack, in the units of Young's modulus times a spacing.
const ENERGY: f64 = 2e-5;

fn softening() -> LawSpec {
    let all = Parameters::numbers(&[("young", 1.0), ("onset", 0.1)]);
    LawSpec::named("softening", all)
}

fn plate(sites: [i32; 3]) -> Spec {
    let mut spec = block(LatticeKind::Square, sites, 3, softening());
    spec.bonds.influence = Influence::Constant;
    spec.space.plane = Plane::Stress;
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Energy(ENERGY),
        alpha: 0.0,
        rate: None,
        fatigue: None,
    });
    spec
}

fn driven(set: &str, speed: f64) -> ConditionSpec {
    ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Velocity([None, Some(e(&format!("{speed:e}"))), None]),
    }
}

/// What it takes to separate two halves as they are, of a plate without ends, per length (energy / area).
fn separation() -> f64 {
    const LENGTH: i32 = 12;
    let mut spec = plate([LENGTH, 12, 1]);
    spec.space.periodic[0] = Some(f64::from(LENGTH));
    spec.sets = [("low", 1.0), ("high", -1.0)]
        .map(|(name, sign)| SetSpec {
            name: name.into(),
            members: Members::Region(Region::HalfSpace {
                point: [0.0; 3],
                normal: [0.0, sign, 0.0],
            }),
        })
        .to_vec();
    spec.loading.conditions = vec![driven("low", 0.0), driven("high", 1e-3)];
    // all points are led along y and none moves along x
    spec.run.schedule.time_step = TimeStep::Fixed(0.25);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    while sim.fragments() < 2 && sim.step_number() < 10_000 {
        sim.step().unwrap();
    }
    assert_eq!(sim.fragments(), 2);
    let ledger = sim.ledger().unwrap();
    (ledger.released + ledger.dissipated) / f64::from(LENGTH)
}

/// Two pins pull a notched plate of bonds that soften apart. The area under the curve, less what is stored and would come back, is the
/// energy of the crack.
#[test]
fn the_work_of_a_compact_test_is_its_fracture_energy() {
    let mut spec = plate([WIDTH, HEIGHT, 1]);
    let left = -0.5 * f64::from(WIDTH);
    spec.damage.precracks = vec![PrecrackSpec {
        shape: CrackShape::Segment {
            from: [left - 1.0, 0.0, 0.0],
            to: [left + NOTCH, 0.0, 0.0],
        },
        kind: CrackKind::Broken,
    }];
    // a column of points may turn; a disk would be a clamp
    let pin = |sign: f64| {
        let x = left + 8.5;
        let (low, high) = (
            f64::min(6.0 * sign, 14.0 * sign),
            f64::max(6.0 * sign, 14.0 * sign),
        );
        Members::Region(Region::Block {
            low: [x - 0.3, low, -1.0],
            high: [x + 0.3, high, 1.0],
        })
    };
    spec.sets = [("low", -1.0), ("high", 1.0)]
        .map(|(name, sign)| SetSpec {
            name: name.into(),
            members: pin(sign),
        })
        .to_vec();
    const SPEED: f64 = 1e-4;
    spec.loading.conditions = vec![driven("low", -SPEED), driven("high", SPEED)];
    spec.run.probes = vec![ProbeSpec {
        name: "load".into(),
        set: "high".into(),
        measure: Measure::Reaction,
    }];
    const STEP: f64 = 0.4;
    spec.run.schedule.time_step = TimeStep::Fixed(STEP);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let (mut area, mut peak, mut last) = (0.0, 0.0f64, 0.0);
    const STEPS: usize = 20_000;
    for _ in 0..STEPS {
        sim.step().unwrap();
        let load = sim.measure()[1];
        area += 0.5 * (load + last) * 2.0 * SPEED * STEP;
        peak = peak.max(load);
        last = load;
    }
    assert!(last < 0.3 * peak, "{last} of {peak}");
    let ledger = sim.ledger().unwrap();
    // the upper flank: where it is as damaged as in the notch, the plate is cracked
    let damage = sim.column("damage").unwrap().values;
    let flank: Vec<f64> = (HEIGHT / 2 * WIDTH..(HEIGHT / 2 + 1) * WIDTH)
        .map(|i| damage.at(i as usize, 0))
        .collect();
    let full = flank[NOTCH as usize / 2];
    let cracked = flank.iter().filter(|d| **d > 0.5 * full).count() as f64 - NOTCH;
    let energy = separation();
    let crack = energy * cracked;
    let left_over = ledger.kinetic + ledger.strain;
    println!(
        "peak {peak:.3e}, cracked {cracked} of {}; separation takes {:.4} of the fracture energy; area {:.4}, still stored {:.4} of what the crack takes",
        f64::from(WIDTH) - NOTCH,
        energy / ENERGY,
        area / crack,
        left_over / crack
    );
    // how well the lattice has the energy of the continuum
    assert!((energy / ENERGY - 1.0).abs() < 0.1);
    assert!(cracked > 0.6 * (f64::from(WIDTH) - NOTCH));
    // the probes' area is the work of the ledger
    assert!((area - ledger.work_boundary_conditions).abs() < 0.01 * area);
    assert!(
        (area - left_over - crack).abs() < 0.1 * crack,
        "{area} of {crack}"
    );
}
