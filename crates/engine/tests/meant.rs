//! Warnings of bodies that are likely not what was meant, beside the same bodies put right.

use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build, ranks};
use peridyne::space::lattice::{Ends, Lattice, LatticeKind};
use peridyne::space::region::Region;
use peridyne::spec::*;
use peridyne_comm::on_threads;
use std::sync::Arc;

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
    spec.bonds.horizon = Horizon::Ratio(3);
    spec
}

fn whole() -> Spec {
    plate(block([0.0; 2], [20.0, 10.0]))
}

/// The same of one process and of ranks.
fn told(spec: &Spec) -> Vec<String> {
    let warnings = |sim: &dyn Simulation| -> Vec<String> {
        sim.info().warnings.iter().map(|w| w.to_string()).collect()
    };
    let one = warnings(build(spec, Options::default()).unwrap().as_ref());
    for count in [2, 3] {
        let all = on_threads(count, |comm| {
            let made = ranks::build(spec, Options::default(), &Arc::new(comm), |_, _, _| vec![]);
            made.unwrap().map(|sim| warnings(sim.as_ref()))
        });
        assert_eq!(all[0].as_ref(), Some(&one));
    }
    one
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
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-1.0, y, 0.0],
            to: [8.0, y, 0.0],
        },
        kind: CrackKind::Excluded,
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
    spec.damage.precracks[0].shape = CrackShape::Segment {
        from: [9.5, 4.5, 0.0],
        to: [10.5, 5.5, 0.0],
    };
    silent(&spec);
}

fn pulled(low: f64, area: Option<f64>) -> Spec {
    let mut spec = whole();
    spec.sets.push(SetSpec {
        name: "top".into(),
        members: Members::Region(block([0.0, low], [20.0, 10.0])),
    });
    spec.loading.conditions.push(ConditionSpec {
        set: "top".into(),
        kind: ConditionKind::Traction {
            value: [None, Some(Expression::parse("1e-3", &[]).unwrap()), None],
            area,
        },
    });
    spec
}

/// Area that the only load acts on, and its force.
fn load(spec: &Spec) -> (f64, [f64; 3]) {
    let mut sim = build(spec, Options::default()).unwrap();
    let told = sim.info().loads[0].clone();
    // the sum of what acts on points is what is told
    sim.start(true);
    let force = sim.vectors("force_density");
    let volume = sim.scalars("volume");
    let sum: [f64; 3] =
        std::array::from_fn(|a| force.iter().zip(&volume).map(|(f, v)| f[a] * v).sum());
    let told_force = told.force.unwrap();
    let size = told_force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    for a in 0..3 {
        assert!(
            (sum[a] - told_force[a]).abs() < 1e-9 * size,
            "{sum:?} {told_force:?}"
        );
    }
    (told.area.unwrap(), told_force)
}

fn refused(spec: &Spec, words: &str) {
    let told = match build(spec, Options::default()) {
        Ok(_) => panic!("expected: {words}"),
        Err(e) => {
            let help = e.help.map_or(String::new(), |h| h.to_string());
            format!("{} {help}", e.message)
        }
    };
    assert!(told.contains(words), "{told}");
}

#[test]
fn a_traction_acts_on_the_face_whatever_the_depth_of_its_set() {
    for low in [9.0, 8.0, 7.0, 5.0] {
        silent(&pulled(low, None));
        let (area, force) = load(&pulled(low, None));
        assert!(
            (area - 20.0).abs() < 1e-12 && (force[1] - 0.02).abs() < 1e-15,
            "{area} {force:?}"
        );
    }
    let (area, _) = load(&pulled(7.0, Some(13.0)));
    assert!((area - 13.0).abs() < 1e-12);
    // all of the body, its rim, a corner
    let mut spec = pulled(0.0, None);
    refused(&spec, "on no side, or on opposite ones");
    spec.sets[0].members = Members::Region(block([17.0, 7.0], [20.0, 10.0]));
    refused(&spec, "may stand for either face");
    spec.sets[0].members = Members::Where(Expression::parse("y > x", &[]).unwrap());
    refused(&spec, "write `area`");
    // both ends at once, pulled apart
    let mut spec = pulled(9.0, None);
    spec.sets[0].members = Members::Where(Expression::parse("abs(y - 5) > 4", &[]).unwrap());
    let (area, _) = load(&spec);
    assert!((area - 40.0).abs() < 1e-12, "{area}");
    // and of different depths
    spec.sets[0].members = Members::Where(Expression::parse("y < 1 || y > 7", &[]).unwrap());
    spec.loading.conditions[0].kind = ConditionKind::Traction {
        value: [
            None,
            Some(Expression::parse("if(y > 5, 1, 0)", &[]).unwrap()),
            None,
        ],
        area: None,
    };
    let (area, force) = load(&spec);
    assert!(
        (area - 40.0).abs() < 1e-12 && (force[1] - 20.0).abs() < 1e-12,
        "{force:?}"
    );
}

/// A block of a lattice, filled, with the top under a traction of 1 along z.
fn topped(kind: LatticeKind, depth: f64) -> Spec {
    let high = [6.0, 5.0, 4.0];
    let (low, d) = ([0.0; 3], kind.dimension());
    let origin = Lattice::filling(kind, 1.0, [low, high], Ends::Cells);
    let body = BodySpec::Lattice {
        kind,
        spacing: 1.0,
        origin,
        region: Region::Block { low, high },
        perturb: None,
    };
    let mut spec = Spec::new(d, body, 1.0, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Ratio(2);
    let axis = ["x", "y", "z"][d - 1];
    let on = format!("{axis} > {}", high[d - 1] - depth);
    spec.sets.push(SetSpec {
        name: "top".into(),
        members: Members::Where(Expression::parse(&on, &[]).unwrap()),
    });
    let one = || Some(Expression::parse("1", &[]).unwrap());
    spec.loading.conditions.push(ConditionSpec {
        set: "top".into(),
        kind: ConditionKind::Traction {
            value: std::array::from_fn(|a| if a + 1 == d { one() } else { None }),
            area: None,
        },
    });
    spec
}

#[test]
fn faces_of_every_lattice_carry_the_whole_traction() {
    for (kind, area, depths) in [
        (LatticeKind::Chain, 1.0, &[1.0, 2.0][..]),
        (LatticeKind::Square, 6.0, &[1.0, 3.0]),
        (LatticeKind::Triangular, 6.0, &[0.6, 2.0]),
        (LatticeKind::Cubic, 30.0, &[1.0, 2.0]),
        (LatticeKind::Bcc, 30.0, &[0.4, 0.9, 2.0]),
        (LatticeKind::Fcc, 30.0, &[0.4, 0.9, 2.0]),
        (LatticeKind::Diamond, 30.0, &[0.2, 0.45, 1.0]),
    ] {
        for depth in depths {
            let mut spec = topped(kind, *depth);
            let near = |spec: &Spec| {
                let (found, force) = load(spec);
                let along = force[kind.dimension() - 1];
                let off = [found / area - 1.0, along / area - 1.0];
                assert!(
                    off.iter().all(|o| o.abs() < 1e-9),
                    "{kind:?} {depth}: {found} {along}"
                );
            };
            near(&spec);
            // as a list, and moved off its sites
            spec.bonds.family = FamilyChoice::List;
            near(&spec);
            let BodySpec::Lattice { perturb, .. } = &mut spec.body else {
                unreachable!("it is one")
            };
            *perturb = Some(Perturbation {
                amplitude: 0.05,
                seed: 4,
            });
            near(&spec);
        }
    }
}

#[test]
fn points_of_a_file_know_no_faces_unless_they_lie_on_a_lattice() {
    let cloud = |stretch: f64, volume: f64| {
        let mut spec = pulled(9.0, None);
        let position: Vec<[f64; 3]> = (0..200)
            .map(|n| {
                [
                    0.5 + f64::from(n % 20),
                    0.5 + stretch * f64::from(n / 20),
                    0.0,
                ]
            })
            .collect();
        spec.body = BodySpec::Cloud(Cloud {
            volume: vec![volume; position.len()],
            position,
            ..Cloud::default()
        });
        spec.bonds.horizon = Horizon::Length(3.1);
        spec
    };
    assert!((load(&cloud(1.0, 1.0)).0 - 20.0).abs() < 1e-12);
    // flat cells, and as a cloud of another density of points
    let mut flat = cloud(0.5, 0.5);
    flat.sets[0].members = Members::Where(Expression::parse("y > 4.6", &[]).unwrap());
    refused(&flat, "their faces are not known");
    refused(&cloud(1.0, 0.9), "their faces are not known");
}

#[test]
fn a_region_that_cells_do_not_fill() {
    silent(&whole());
    // a percent more or less is a matter of the spacing
    silent(&plate(block([0.0; 2], [20.1, 10.0])));
    warns(
        &plate(block([0.0; 2], [20.3, 10.0])),
        "the body holds 200, 1.5 % less than its region of 203: along x its cells reach from 0 to 20, the region from 0 to 20.3",
    );
    // faces through points: half a spacing more on each side
    warns(
        &plate(block([0.5, 0.5], [19.5, 9.5])),
        "17 % more than its region of 171: along y its cells reach from 0 to 10, the region from 0.5 to 9.5",
    );
    // a disk of 121 cells is 3 % smaller than its circle, one of many is not
    warns(
        &plate(Region::Sphere {
            center: [10.5, 10.5, 0.0],
            radius: 6.3,
        }),
        "less than its region",
    );
    silent(&plate(Region::Sphere {
        center: [40.0, 40.0, 0.0],
        radius: 40.0,
    }));
}

/// A strip of points 20 long, of cells 1, with a period.
fn strip(period: f64) -> Spec {
    let mut spec = whole();
    let position: Vec<[f64; 3]> = (0..200)
        .map(|n| [0.5 + f64::from(n % 20), 0.5 + f64::from(n / 20), 0.0])
        .collect();
    spec.body = BodySpec::Cloud(Cloud {
        volume: vec![1.0; position.len()],
        position,
        ..Cloud::default()
    });
    spec.bonds.horizon = Horizon::Length(3.1);
    spec.space.periodic[0] = Some(period);
    spec
}

#[test]
fn periods_are_as_long_as_the_body() {
    silent(&strip(20.0));
    // bonds reach across what is shorter than the horizon, which is said of any gap
    warns(&strip(21.5), "bonds reach across a gap");
    for period in [15.3, 18.7] {
        refused(&strip(period), "the body lies in its own image");
    }
    let mut short = strip(19.1);
    short.bonds.horizon = Horizon::Length(3.3);
    warns(&short, "its last cells lie in those of its image");
    warns(
        &strip(23.5),
        "there is a gap of 3.5 spacings before its image",
    );
}

#[test]
fn a_condition_that_every_point_meets() {
    let mut spec = whole();
    spec.sets.push(SetSpec {
        name: "top".into(),
        members: Members::Where(Expression::parse("y > 0.009", &[]).unwrap()),
    });
    warns(
        &spec,
        "`y > 0.009` holds at every point: the set `top` is all of the body",
    );
    spec.sets[0].members = Members::Where(Expression::parse("y > 9", &[]).unwrap());
    silent(&spec);
    spec.sets[0].members = Members::Where(Expression::parse("y > 9000", &[]).unwrap());
    refused(&spec, "set `top` has no points");
}

#[test]
fn a_crack_that_cuts_everything() {
    let mut spec = plate(block([0.0; 2], [1.0, 2.0]));
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [-5.0, 1.0, 0.0],
            to: [5.0, 1.0, 0.0],
        },
        kind: CrackKind::Excluded,
    });
    for kind in [CrackKind::Excluded, CrackKind::Broken] {
        spec.damage.precracks[0].kind = kind;
        refused(
            &spec,
            "the pre-crack cuts all bonds: none of the 1 between 2 points is left",
        );
    }
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
    slot.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [8.0, 5.5, 0.0],
            to: [21.0, 5.5, 0.0],
        },
        kind: CrackKind::Excluded,
    });
    silent(&slot);
    // as wide as the horizon, a corner, a large hole
    silent(&without(block([8.0, 4.0], [21.0, 7.0])));
    silent(&without(block([8.0, 5.0], [21.0, 11.0])));
    silent(&without(Region::Sphere {
        center: [10.0, 5.0, 0.0],
        radius: 3.2,
    }));
}

/// Slots and pieces that several blocks of 256 cells have parts of, on and beside their borders.
#[test]
fn gaps_of_large_bodies() {
    let large = |part: Region| {
        plate(Region::Difference(
            Box::new(block([0.0; 2], [60.0, 50.0])),
            vec![part],
        ))
    };
    for x in [10.0, 25.0, 30.0, 41.0] {
        let along = block([x, 5.0], [x + 1.0, 51.0]);
        warns(&large(along), "bonds reach across a gap in the body");
        let across = block([8.0, x], [61.0, x + 1.0]);
        warns(&large(across), "bonds reach across a gap in the body");
        let pieces = large(block([x, -1.0], [x + 1.0, 51.0]));
        // of 50 rows: two cells apart to five rows, but for ends, and three apart straight on from two columns
        let bonds = 5 * 50 - 2 * (1 + 2) + 2 * 50;
        let words = format!("the body is in separate pieces that {bonds} bonds join");
        warns(&pieces, &words);
    }
}

#[test]
fn corners_of_a_large_body_that_a_traction_tears_off() {
    let mut spec = plate(block([0.0; 2], [60.0, 50.0]));
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.01)));
    for (name, low, high) in [("left", 0.0, 1.0), ("right", 59.0, 60.0)] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members: Members::Region(block([low, 0.0], [high, 50.0])),
        });
        let value = [Some(Expression::parse("0.1", &[]).unwrap()), None, None];
        spec.loading.conditions.push(ConditionSpec {
            set: name.into(),
            kind: ConditionKind::Traction { value, area: None },
        });
    }
    // of bonds up to 3 long a corner has 4 between its edges and 3 along each
    warns(&spec, "at once: that at (0.5, 0.5) has 10,");
}

#[test]
fn a_corner_that_a_traction_tears_off() {
    let mut spec = pulled(9.0, None);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.01)));
    silent(&spec);
    let pull = |spec: &mut Spec, traction: &str| {
        spec.loading.conditions[0].kind = ConditionKind::Traction {
            value: [None, Some(Expression::parse(traction, &[]).unwrap()), None],
            area: None,
        };
    };
    // a tenth of the modulus, and a tenth of that
    pull(&mut spec, "0.1");
    warns(&spec, "a traction breaks off");
    pull(&mut spec, "0.0001");
    silent(&spec);
}
