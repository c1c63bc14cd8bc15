//! Friction and turning: angular momentum of bodies that rub, and what turns as one or rolls and does not rub.

use super::rigid::{made, seen, tumbling};
use super::{glancing, piece, sets, square, text};
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::*;

/// Momentum and angular momentum about the origin of all points, and by their sizes what round-off of each is measured by.
fn held(sim: &mut dyn Simulation) -> ([f64; 6], [f64; 2]) {
    let (volume, density) = (sim.scalars("volume"), sim.scalars("density"));
    let (x, v) = (sim.vectors("position"), sim.velocities());
    let (mut sum, mut size) = ([0.0; 6], [0.0; 2]);
    for (k, (x, v)) in x.iter().zip(&v).enumerate() {
        let m = volume[k] * density[k];
        let long = |x: &[f64; 3]| x.iter().map(|c| c * c).sum::<f64>().sqrt();
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            sum[a] += m * v[a];
            sum[3 + a] += m * (x[b] * v[c] - x[c] * v[b]);
        }
        size[0] += m * long(v);
        size[1] += m * long(x) * long(v);
    }
    (sum, size)
}

/// Runs to `end`: both momenta of the start stay, to round-off of some thousand steps, and friction takes energy.
fn keeps_both_momenta(spec: &Spec, end: f64) {
    let mut sim = made(spec);
    let (before, size) = held(sim.as_mut());
    let initial = sim.ledger().unwrap().initial;
    while sim.time() < end {
        sim.step().unwrap();
    }
    let (after, _) = held(sim.as_mut());
    for a in 0..6 {
        let off = (after[a] - before[a]).abs() / size[a / 3];
        assert!(off < 1e-12, "component {a}: {off:e}");
    }
    let l = sim.ledger().unwrap();
    println!("dissipated {} of {initial}", l.dissipated);
    assert!(l.dissipated > 1e-3 * initial, "they rubbed: {l:?}");
    assert!(l.residual().abs() < 5e-3 * initial, "{l:?}");
}

#[test]
fn bodies_that_rub_keep_their_angular_momentum() {
    keeps_both_momenta(&glancing(), 8.0);
}

/// Two bodies of a cubic lattice, one above the other.
fn solids(low: [[f64; 3]; 2], high: [[f64; 3]; 2], spacing: [f64; 2]) -> Spec {
    let body = |n: usize| BodySpec::Lattice {
        kind: LatticeKind::Cubic,
        spacing: spacing[n],
        origin: low[n],
        region: Region::Block {
            low: low[n],
            high: high[n],
        },
        perturb: None,
    };
    let pieces = vec![piece("one", body(0), true), piece("block", body(1), true)];
    let law = LawSpec::Pmb(PmbStiffness::Young(100.0));
    let mut spec = Spec::new(3, BodySpec::Several(pieces), 1.0, law);
    spec.sets = sets(&["one", "block"]);
    spec.bonds.horizon = Horizon::Length(2.2);
    spec.interactions.contact = glancing().interactions.contact;
    spec.run.schedule.time_step = TimeStep::Fraction(0.1);
    spec
}

fn moving(set: &str, displacement: [&str; 3], velocity: [&str; 3]) -> InitialSpec {
    InitialSpec {
        set: set.into(),
        displacement: displacement.map(text),
        velocity: velocity.map(text),
    }
}

#[test]
fn solids_that_rub_keep_all_of_their_angular_momentum() {
    let (low, high) = (
        [[0.0; 3], [0.6, 0.3, 3.3]],
        [[4.1, 3.1, 2.1], [3.1, 2.8, 5.0]],
    );
    let mut spec = solids(low, high, [1.0, 0.8]);
    spec.loading.initial = vec![moving("block", ["0"; 3], ["1.2", "0.5", "-1"])];
    keeps_both_momenta(&spec, 4.0);
}

/// A row of points takes no couple about itself: the other, which crosses it, takes that.
#[test]
fn rows_that_cross_keep_all_of_their_angular_momentum() {
    let (low, high) = (
        [[0.0; 3], [4.3, -3.8, 1.3]],
        [[8.1, 0.1, 0.1], [4.4, 4.3, 1.4]],
    );
    let mut spec = solids(low, high, [1.0, 1.0]);
    spec.loading.initial = vec![moving("block", ["0"; 3], ["0.8", "0.5", "-1"])];
    keeps_both_momenta(&spec, 2.0);
}

/// A stone of one point has no spin: friction on it acts where it is.
#[test]
fn a_stone_that_rubs_keeps_the_angular_momentum_of_both() {
    let mut spec = glancing();
    let block = square(1.0, [0.0; 3], [7.0, 4.0, 0.0]);
    let stone = square(0.8, [3.0, 5.4, 0.0], [3.1, 5.5, 0.0]);
    spec.body = BodySpec::Several(vec![
        piece("one", block, true),
        piece("block", stone, false),
    ]);
    keeps_both_momenta(&spec, 2.0);
}

/// The greatest force density at the start that friction adds, over the greatest of all.
fn rubs(spec: &Spec) -> f64 {
    let forces = |friction: bool| {
        let mut spec = spec.clone();
        if !friction {
            spec.interactions.contact.as_mut().unwrap().friction = None;
        }
        made(&spec).vectors("force_density")
    };
    let (with, without) = (forces(true), forces(false));
    let most = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0f64, |m, x| m.max(x.abs()));
    let all = most(&mut without.iter().flatten().copied());
    let pairs = with.iter().flatten().zip(without.iter().flatten());
    most(&mut pairs.map(|(f, g)| f - g)) / all
}

/// Two bodies that touch and turn as one, about any axis and wherever they go, have nothing that slides; what slides has the part μ of what presses.
#[test]
fn bodies_that_turn_as_one_do_not_rub() {
    let mut spec = glancing();
    // the block begins 0.3 below its place of the reference
    let turned = |y: &str| InitialSpec {
        displacement: [None, None, None],
        ..moving(
            "one",
            ["0"; 3],
            [&format!("3 - 0.2*({y} - 2)"), "0.2*(x - 1) - 1", "0"],
        )
    };
    let lowered = [None, text("-0.3"), None];
    let block = InitialSpec {
        set: "block".into(),
        displacement: lowered.clone(),
        ..turned("(y - 0.3)")
    };
    spec.loading.initial = vec![turned("y"), block];
    let off = rubs(&spec);
    assert!(off < 1e-12, "{off:e}");
    spec.loading.initial = vec![InitialSpec {
        displacement: lowered,
        ..moving("block", ["0"; 3], ["1", "0", "0"])
    }];
    let slides = rubs(&spec);
    assert!(slides > 0.1, "{slides}");

    let (low, high) = (
        [[0.0; 3], [0.6, 0.3, 3.3]],
        [[4.1, 3.1, 2.1], [3.1, 2.8, 5.0]],
    );
    let mut spec = solids(low, high, [1.0, 0.8]);
    // ω × x + v, ω = (0.3, -0.2, 0.1)
    let spun = |set: &str, z: &str| {
        let v = [
            format!("-0.2*{z} - 0.1*y + 2"),
            format!("0.1*x - 0.3*{z} - 1"),
            "0.3*y + 0.2*x".to_string(),
        ];
        moving(set, ["0", "0", if set == "one" { "0" } else { "-0.2" }], {
            let [x, y, z] = &v;
            [x, y, z]
        })
    };
    spec.loading.initial = vec![spun("one", "z"), spun("block", "(z - 0.2)")];
    let off = rubs(&spec);
    assert!(off < 1e-12, "{off:e}");
}

/// A block of whose points one touches turns about the place of contact, midway between the points: it rolls, and friction has no force.
#[test]
fn what_rolls_does_not_rub() {
    let mut spec = glancing();
    let one = square(1.0, [0.0; 3], [7.0, 4.0, 0.0]);
    // its corner above the corner of the other, 1.1 apart where they begin
    let other = square(0.8, [7.0, 5.4, 0.0], [11.1, 8.7, 0.0]);
    spec.body = BodySpec::Several(vec![piece("one", one, true), piece("block", other, true)]);
    let with = |v: [&str; 2]| InitialSpec {
        set: "block".into(),
        displacement: [None, text("-0.3"), None],
        velocity: [text(v[0]), text(v[1]), None],
    };
    spec.loading.initial = vec![with(["-0.2*(y - 0.3 - 4.55)", "0.2*(x - 7)"])];
    let rolls = rubs(&spec);
    assert!(rolls < 1e-12, "{rolls:e}");
    // about its own corner the place of contact slides
    spec.loading.initial = vec![with(["-0.2*(y - 0.3 - 5.1)", "0.2*(x - 7)"])];
    let slides = rubs(&spec);
    assert!(slides > 0.1, "{slides}");
}

/// A ball that rolls over one point when a run begins is pushed across the surface only: the difference of its speeds is round-off, not sliding.
#[test]
fn a_ball_that_rolls_does_not_rub() {
    let begins = |velocity: f64| {
        let friction = Some(FrictionSpec::constant(0.4));
        let mut spec = tumbling(RigidShape::Sphere { radius: 2.0 }, friction, 0.005);
        let RigidBodyMotion::Free(free) = &mut spec.loading.rigid_bodies[0].motion else {
            panic!()
        };
        // 1.9 above the point (2, 2, 2), and further than its radius from all others
        free.center = [2.0, 2.0, 3.9];
        (free.velocity, free.spin) = ([velocity, 0.0, 0.0], [0.0, 0.41, 0.0]);
        let mut sim = made(&spec);
        let force = seen(sim.as_mut(), "force");
        force[0].abs() / force[2].abs()
    };
    let (rolls, slides) = (begins(0.41 * 1.9), begins(1.0));
    assert!(rolls < 1e-12, "{rolls:e}");
    assert!((slides / 0.4 - 1.0).abs() < 1e-9, "{slides}");
}
