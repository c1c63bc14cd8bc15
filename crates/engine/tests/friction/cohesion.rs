//! Cohesion between bodies of points: its energy and traction, whatever way faces lie on each other, and that momentum and energy are kept.

use super::{piece, sets, square, text};
use peridyne::interaction::cohesion::{Adhesion, Faces};
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;
use std::f64::consts::PI;

const COHESION: CohesionSpec = CohesionSpec {
    energy: 0.3,
    strength: 0.4,
};
/// Where faces begin to repel.
const APART: f64 = 1.35;

fn cohesive(spec: &mut Spec) {
    spec.interactions.contact = Some(ContactSpec {
        bonded: 0.9,
        free: APART,
        stiffness: ContactStiffness::Laws,
        friction: None,
        cohesion: Some(COHESION),
        conductance: None,
    });
}

fn solid(d: usize, spacing: f64, low: [f64; 3], high: [f64; 3]) -> BodySpec {
    BodySpec::Lattice {
        kind: [LatticeKind::Square, LatticeKind::Cubic][d - 2],
        spacing,
        origin: low,
        region: Region::Block { low, high },
        perturb: None,
    }
}

/// Two bodies without ends along their faces, the upper one of which is told where to go; energy and force between them.
fn held(d: usize, spacing: f64, gap: f64, along: [f64; 2]) -> [f64; 2] {
    let (width, top) = (12.0, 9.5);
    // cells from 0 to the width, rows half a spacing inside
    let body = |h: f64, low: f64| {
        let first = |y: f64| [0.5 * h, y, if d == 3 { 0.5 * h } else { 0.0 }];
        let last = width - 0.4 * h;
        let high = [last, low + 6.0, if d == 3 { last } else { 0.0 }];
        solid(d, h, first(low + 0.5 * h), high)
    };
    let lower = body(1.0, -6.0);
    let upper = body(spacing, top);
    let pieces = vec![piece("lower", lower, true), piece("upper", upper, true)];
    let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
    let mut spec = Spec::new(d, BodySpec::Several(pieces), 1.0, law);
    spec.sets = sets(&["lower", "upper"]);
    spec.bonds.horizon = Horizon::Length(2.1);
    spec.space.periodic[0] = Some(width);
    if d == 3 {
        spec.space.periodic[2] = Some(width);
    }
    cohesive(&mut spec);
    spec.interactions.contact.as_mut().unwrap().free = APART / (0.5 * (1.0 + spacing));
    let rows = top + 0.5 * spacing + 0.5;
    let to = |x: f64| text(&format!("{x:e}"));
    let tell = |set: &str, u: [f64; 3]| ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement([
            to(u[0]),
            to(u[1]),
            if d == 3 { to(u[2]) } else { None },
        ]),
    };
    spec.loading.conditions = vec![
        tell("lower", [0.0; 3]),
        tell("upper", [along[0], gap - rows, along[1]]),
    ];
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec.run.probes = vec![ProbeSpec {
        name: "p".into(),
        set: "upper".into(),
        measure: Measure::Reaction,
    }];
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    let area = width * if d == 3 { width } else { 1.0 };
    [
        sim.ledger().unwrap().contact / area,
        sim.measure()[1] / area,
    ]
}

#[test]
fn faces_take_the_work_of_adhesion_to_be_pulled_apart() {
    for d in [2, 3] {
        for spacing in [1.0, 0.75] {
            let mut mean = 0.0;
            for along in [[0.0, 0.0], [0.5, 0.5], [0.25, 0.1], [0.4, 0.0]] {
                let [energy, force] = held(d, spacing, APART * (1.0 + 1e-9), along);
                println!("{d} {spacing} {along:?}: {energy:.5} {force:.5}");
                assert!((energy / -COHESION.energy - 1.0).abs() < 0.005, "{energy}");
                assert!((force / COHESION.strength - 1.0).abs() < 0.03, "{force}");
                mean += 0.25 * energy;
            }
            assert!((mean / -COHESION.energy - 1.0).abs() < 0.002, "{mean}");
        }
        // the work of the force on the way is the energy
        let n = 40;
        let (from, to) = (APART * (1.0 + 1e-9), APART + 3.5);
        let by = (to - from) / f64::from(n);
        let work: f64 = (0..=n)
            .map(|k| {
                let weight = if k == 0 || k == n { 0.5 } else { 1.0 };
                weight * by * held(d, 1.0, from + by * f64::from(k), [0.25, 0.25])[1]
            })
            .sum();
        assert!((work / COHESION.energy - 1.0).abs() < 0.02, "{work}");
    }
}

/// Two free blocks that meet slowly stay together; fast ones part.
#[test]
fn slow_blocks_stick_and_fast_ones_part() {
    let meet = |speed: f64| {
        let one = square(1.0, [0.0; 3], [7.0, 4.0, 0.0]);
        let other = square(0.8, [1.0, 8.0, 0.0], [6.6, 11.2, 0.0]);
        let pieces = vec![piece("one", one, true), piece("other", other, true)];
        let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
        let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, law);
        spec.sets = sets(&["one", "other"]);
        spec.bonds.horizon = Horizon::Length(2.2);
        cohesive(&mut spec);
        let thrown = |set: &str, v: f64| InitialSpec {
            set: set.into(),
            displacement: [None, None, None],
            velocity: [text("0"), text(&format!("{v}")), None],
        };
        spec.loading.initial = vec![thrown("one", speed), thrown("other", -speed)];
        spec.run.schedule.time_step = TimeStep::Fraction(0.2);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mass = |set: &str, sim: &mut dyn Simulation| {
            let ids = sim.members(set).unwrap();
            let (volume, v) = (sim.scalars("volume"), sim.velocities());
            let x = sim.vectors("position");
            let m: f64 = ids.iter().map(|i| volume[*i as usize]).sum();
            let of = |of: &[[f64; 3]]| {
                ids.iter()
                    .map(|i| volume[*i as usize] * of[*i as usize][1])
                    .sum::<f64>()
            };
            (m, of(&v), of(&x) / m)
        };
        let before = ["one", "other"].map(|s| mass(s, sim.as_mut()));
        let scale = before[0].1.abs() + before[1].1.abs();
        let mut worst = 0.0f64;
        while sim.time() < 60.0 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            worst = worst.max(l.residual().abs() / (l.initial + 7.0 * COHESION.energy));
        }
        let after = ["one", "other"].map(|s| mass(s, sim.as_mut()));
        let momentum = (after[0].1 + after[1].1) - (before[0].1 + before[1].1);
        assert!(momentum.abs() < 1e-11 * scale, "{momentum}");
        println!("residual {worst:.1e} of all");
        assert!(worst < 2e-2, "{worst}");
        after[1].2 - after[0].2
    };
    let [slow, fast] = [0.02, 1.0].map(meet);
    println!("{slow} {fast}");
    // centres of blocks that touch are five spacings apart
    assert!(slow < 7.0 && fast > 15.0, "{slow} {fast}");
}

#[test]
fn cohesion_that_cannot_be_is_refused() {
    let refused = |spec: &Spec| match build(spec, Options::default()) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("built"),
    };
    let one = square(1.0, [0.0; 3], [7.0, 4.0, 0.0]);
    let other = square(1.0, [0.0, 8.0, 0.0], [6.0, 11.0, 0.0]);
    let pieces = vec![piece("one", one.clone(), true), piece("other", other, true)];
    let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
    let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, law.clone());
    spec.bonds.horizon = Horizon::Length(2.2);
    cohesive(&mut spec);
    for (strength, why) in [(1.0, "second row"), (1e-3, "20 times")] {
        let cohesion = spec
            .interactions
            .contact
            .as_mut()
            .unwrap()
            .cohesion
            .as_mut()
            .unwrap();
        cohesion.strength = strength;
        let error = refused(&spec);
        assert!(error.contains(why), "{error}");
    }
    let mut single = Spec::new(2, one, 1.0, law);
    single.bonds.horizon = Horizon::Length(2.2);
    cohesive(&mut single);
    assert!(refused(&single).contains("there is one"));
}

/// As rows come nearer to each other, half-spaces: `w = π c L⁵/120`, `t c L⁴/30`, `A c L³/24`, and the traction at contact is 4 w/L, in the plane 5π/4 w/L.
#[test]
fn fine_rows_are_half_spaces() {
    let (energy, range, section) = (0.7, 2.0, 0.3);
    let off = |n: f64| {
        let h = range / n;
        let faces = Faces {
            spacing: [h, 0.5 * h],
            apart: 0.75 * h,
            section,
        };
        let of = |c: Adhesion, traction: f64, exact: f64, factor: f64| {
            let strength = c.strength / exact - 1.0;
            let traction = traction / (factor * energy / range) - 1.0;
            strength.abs().max(traction.abs())
        };
        let line = Adhesion::new::<1>(energy, range, faces);
        let plane = Adhesion::new::<2>(energy, range, faces);
        let unit = Faces {
            section: 1.0,
            ..faces
        };
        let space = Adhesion::new::<3>(energy, range, unit);
        [
            of(
                line,
                line.traction::<1>(faces),
                24.0 * energy / (section * range.powi(3)),
                4.0,
            ),
            of(
                plane,
                plane.traction::<2>(faces),
                30.0 * energy / (section * range.powi(4)),
                1.25 * PI,
            ),
            of(
                space,
                space.traction::<3>(unit),
                120.0 * energy / (PI * range.powi(5)),
                4.0,
            ),
        ]
    };
    let [coarse, fine] = [off(40.0), off(80.0)];
    println!("{coarse:?} {fine:?}");
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(fine < 2e-3 && coarse / fine > 3.0, "{coarse} {fine}");
    }
    // and the range of a traction is the one that has it
    let faces = Faces {
        spacing: [1.0, 1.0],
        apart: APART,
        section: 1.0,
    };
    let found = Adhesion::of_strength::<3>(0.3, 0.4, faces).unwrap();
    assert!((found.traction::<3>(faces) / 0.4 - 1.0).abs() < 1e-6);
}

/// Newton's method knows no contact: motion does not begin from it where bodies attract each other, though none repel.
#[test]
fn statics_without_contact_does_not_pass_over_attraction() {
    let passage = |gap: f64| {
        let one = square(1.0, [0.0; 3], [7.0, 4.0, 0.0]);
        let other = square(1.0, [0.0, 4.0 + gap, 0.0], [7.0, 8.0 + gap, 0.0]);
        let pieces = vec![piece("one", one, true), piece("other", other, true)];
        let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
        let mut spec = Spec::new(2, BodySpec::Several(pieces), 1.0, law);
        spec.sets = sets(&["one"]);
        // free below its uppermost row
        let above = format!("y > {}", 7.5 + gap);
        spec.sets.push(SetSpec {
            name: "held".into(),
            members: Members::Where(text(&above).unwrap()),
        });
        spec.bonds.horizon = Horizon::Length(2.2);
        cohesive(&mut spec);
        let held = |set: &str| ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement([text("0"), text("0"), None]),
        };
        spec.run.preload = Some(PreloadSpec {
            statics: Statics {
                method: Method::Newton,
                ..Statics::default()
            },
            increments: 1,
            duration: None,
            conditions: vec![held("one"), held("held")],
            rigid_bodies: vec![],
            cuts: vec![],
        });
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        (0..3)
            .try_for_each(|_| sim.step())
            .map_err(|e| e.to_string())
    };
    let error = passage(2.0).unwrap_err();
    assert!(error.contains("attract each other"), "{error}");
    passage(9.0).unwrap();
}
