//! A rigid disk and a body in equilibrium by relaxation: what is stiff where they touch must not throw points away.

use super::{block, hold, number, text, with};
use peridyne::expression::Expression;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::space::rigid::RigidShape;
use peridyne::spec::*;

const INCREMENTS: u32 = 12;

/// The rows below a height, or with −1 above it.
fn rows(name: &str, way: f64, y: f64) -> SetSpec {
    SetSpec {
        name: name.into(),
        members: Members::Region(Region::HalfSpace {
            point: [0.0, y, 0.0],
            normal: [0.0, way, 0.0],
        }),
    }
}

/// Before the first of so many increments, in which t goes from 0 to 1.
fn relaxed(spec: &Spec, increments: u32) -> Box<dyn Simulation> {
    minimized(spec, Method::Relaxation, increments)
}

fn minimized(spec: &Spec, method: Method, increments: u32) -> Box<dyn Simulation> {
    let mut spec = with(spec, method, Solver::Auto, 1e-6);
    spec.run.schedule.steps = u64::from(increments);
    spec.run.schedule.time_step = TimeStep::Fixed(1.0 / f64::from(increments));
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

/// Force of the disk on the block (along, across) at every increment: the disk goes by `way` from above the middle of the block, and its floor by
/// `floor`; t goes from 0 to 1.
fn forces(way: [&str; 2], floor: [&str; 2], stiffness: f64) -> Vec<[f64; 2]> {
    forces_rubbed(Method::Relaxation, way, floor, stiffness, None)
}

fn forces_rubbed(
    method: Method,
    way: [&str; 2],
    floor: [&str; 2],
    stiffness: f64,
    friction: Option<FrictionSpec>,
) -> Vec<[f64; 2]> {
    let radius = 100.0;
    let mut spec = block([20.0, 8.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Ratio(3);
    spec.sets.push(rows("floor", 1.0, 2.1));
    hold(&mut spec, "floor", [text(floor[0]), text(floor[1]), None]);
    let center = [
        text(&format!("10 + {}", way[0])).unwrap(),
        text(&format!("{} + {}", 8.0 + radius, way[1])).unwrap(),
        number(0.0).unwrap(),
    ];
    let shape = RigidShape::Sphere { radius };
    let mut disk = RigidBodySpec::new(stiffness, shape, RigidBodyMotion::Kinematic(center));
    disk.name = "disk".into();
    disk.friction = friction;
    spec.loading.rigid_bodies = vec![disk];
    spec.run.probes = vec![ProbeSpec {
        name: "disk".into(),
        set: "all".into(),
        measure: Measure::RigidBody {
            rigid_body: "disk".into(),
            of: Some(RigidQuantity::Force),
        },
    }];
    let mut sim = minimized(&spec, method, INCREMENTS);
    let mut all = vec![];
    for n in 0..INCREMENTS {
        sim.step().unwrap_or_else(|e| panic!("{n}: {e}"));
        let force = sim.measure();
        all.push([force[0], force[1]]);
    }
    all
}

#[test]
fn a_stiff_disk_is_pressed_in_and_goes_sideways() {
    for stiffness in [2.5, 25.0, 250.0, 2500.0] {
        let down = "-0.5*min(2*t, 1)";
        let pressed = forces(["0", down], ["0", "0"], stiffness);
        let sideways = forces(["2*max(t - 0.5, 0)", down], ["0", "0"], stiffness);
        let [last, most] = [pressed[11][1], sideways[11][1]];
        // by one spacing; the contact is as wide as the block, so that its edges are felt
        println!("{stiffness}: {last:.4e} {most:.4e}");
        assert!(
            (most / last - 1.0).abs() < 0.05,
            "{stiffness}: {pressed:?} {sideways:?}"
        );
    }
}

/// The coefficient of statics is that at rest, though the disk goes somewhere.
#[test]
fn friction_of_statics_is_that_at_rest() {
    let falling = FrictionSpec {
        at_rest: Some(AtRest {
            coefficient: Expression::constant(0.2),
            speed: 1e-9,
        }),
        ..FrictionSpec::constant(0.0)
    };
    let way = ["2*max(t - 0.5, 0)", "-0.5*min(2*t, 1)"];
    for law in [falling, FrictionSpec::constant(0.2)] {
        let all = forces_rubbed(Method::Relaxation, way, ["0", "0"], 250.0, Some(law));
        let [along, across] = all[11];
        println!("{along} {across}");
        // as far as the normal of the disk leans: a contact of ten spacings on a radius of a hundred
        assert!(
            (along.abs() / across.abs() / 0.2 - 1.0).abs() < 0.1,
            "{all:?}"
        );
    }
}

/// Who moves does not matter, though in one case no point is deep in the disk when an increment begins.
#[test]
fn a_block_that_is_pressed_into_a_disk_bears_as_the_disk_in_the_block() {
    for stiffness in [25.0, 2500.0] {
        let disk = forces(["0", "-0.5*t"], ["0", "0"], stiffness);
        let floor = forces(["0", "0"], ["0", "0.5*t"], stiffness);
        for (a, b) in disk.iter().zip(&floor) {
            assert!(
                (a[1] / b[1] - 1.0).abs() < 1e-4,
                "{stiffness}: {disk:?} {floor:?}"
            );
        }
    }
}

/// A block, whole or cut across by a broken crack, whose upper rows are pressed down by a fifth of it: faces and bonds repel, much stiffer than bonds
/// are.
#[test]
fn faces_of_a_crack_are_pressed_together() {
    let pressed = |cut: bool| {
        let mut spec = block([12.0, 12.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
        spec.bonds.horizon = Horizon::Ratio(3);
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(0.5)));
        spec.interactions.contact = Some(ContactSpec {
            bonded: 0.9,
            free: 1.35,
            stiffness: ContactStiffness::Laws,
            friction: None,
            cohesion: None,
            conductance: None,
        });
        spec.sets
            .extend([rows("floor", 1.0, 2.1), rows("top", -1.0, 9.9)]);
        if cut {
            spec.damage.precracks.push(PrecrackSpec {
                shape: CrackShape::Segment {
                    from: [-1.0, 6.5, 0.0],
                    to: [13.0, 6.5, 0.0],
                },
                kind: CrackKind::Broken,
            });
        }
        hold(&mut spec, "floor", [number(0.0), number(0.0), None]);
        hold(&mut spec, "top", [number(0.0), text("-2*t"), None]);
        spec.run.probes = vec![ProbeSpec {
            name: "top".into(),
            set: "top".into(),
            measure: Measure::Reaction,
        }];
        let mut sim = relaxed(&spec, 20);
        let mut all = vec![];
        for n in 1..=20 {
            sim.step()
                .unwrap_or_else(|e| panic!("cut {cut}, increment {n}: {e}"));
            let l = sim.ledger().unwrap();
            all.push([
                -sim.measure()[1],
                l.residual() / l.work_boundary_conditions,
                l.contact,
            ]);
        }
        all
    };
    let [whole, cut] = [pressed(false), pressed(true)];
    println!("{whole:?}\n{cut:?}");
    for all in [&whole, &cut] {
        // the trapezoidal rule does not know when within an increment faces met
        let [_, residual, contact] = all[19];
        assert!(residual.abs() < 2e-2 && contact > 0.0, "{all:?}");
        assert!(all.windows(2).all(|w| w[1][0] > w[0][0] - 1e-9), "{all:?}");
    }
    // nothing until the faces meet, after a tenth of a spacing; then softer than the whole, by the surfaces and the springs between them: bounds set
    // after the fact
    assert!(cut[0][0].abs() < 1e-9, "{cut:?}");
    let slopes = [&whole, &cut].map(|all| all[6][0] - all[3][0]);
    assert!((0.5..1.0).contains(&(slopes[1] / slopes[0])), "{slopes:?}");
}

/// Upper rows of a strip without ends go down, until its cut is closed, and sideways, until it slips: rows face each other, so that all that touch
/// lean by the same angle θ, and what drags is tan(φ − θ) of what presses, φ the angle of friction.
#[test]
fn faces_of_a_crack_rub() {
    let mu = 0.1f64;
    let young = PmbStiffness::Young(1.0);
    let laws = [
        (LawSpec::Pmb(young), FamilyChoice::Auto),
        (LawSpec::Pmb(young), FamilyChoice::List),
    ];
    for (law, family) in laws {
        for friction in [None, Some(FrictionSpec::constant(mu))] {
            let mut spec = block([12.0, 8.0, 0.0], 2, law.clone());
            spec.body = BodySpec::Lattice {
                kind: LatticeKind::Square,
                spacing: 1.0,
                origin: [0.5, 0.5, 0.0],
                region: Region::Block {
                    low: [0.0; 3],
                    high: [12.0, 8.0, 0.0],
                },
                perturb: None,
            };
            spec.bonds.family = family;
            spec.space.periodic[0] = Some(12.0);
            spec.bonds.horizon = Horizon::Ratio(2);
            let rubs = friction.is_some();
            spec.interactions.contact = Some(ContactSpec {
                bonded: 0.9,
                free: 1.35,
                stiffness: ContactStiffness::Laws,
                friction,
                cohesion: None,
                conductance: None,
            });
            spec.sets = vec![rows("floor", 1.0, 2.1), rows("top", -1.0, 5.9)];
            spec.damage.precracks.push(PrecrackSpec {
                shape: CrackShape::Segment {
                    from: [-1.0, 4.0, 0.0],
                    to: [13.0, 4.0, 0.0],
                },
                kind: CrackKind::Broken,
            });
            let zero = || number(0.0);
            hold(&mut spec, "floor", [zero(), zero(), None]);
            // by friction it begins to slip at 0.042; further than 0.08 against each other, and the next rows touch
            let along = if rubs { "0.06" } else { "0.04" };
            let along = format!("{along}*max(0, 2*t - 1)");
            let ways = [along.as_str(), "-0.2*min(1, 2*t)"];
            hold(&mut spec, "top", [text(ways[0]), text(ways[1]), None]);
            spec.run.probes = vec![ProbeSpec {
                name: "top".into(),
                set: "top".into(),
                measure: Measure::Reaction,
            }];
            let mut sim = relaxed(&spec, 20);
            let mut all = vec![];
            for n in 1..=20 {
                sim.step().unwrap_or_else(|e| panic!("{n}: {e}"));
                let (x, u) = (sim.vectors("reference"), sim.displacements());
                let of = |y: f64| x.iter().position(|x| x[0] < 1.0 && (x[1] - y).abs() < 0.1);
                let [below, above] = [3.5, 4.5].map(|y| u[of(y).unwrap()]);
                let lean = (above[0] - below[0]) / (1.0 + above[1] - below[1]);
                let reaction = sim.measure();
                let l = sim.ledger().unwrap();
                all.push([reaction[0], -reaction[1], lean, l.dissipated, l.residual()]);
            }
            let [drag, press, lean, dissipated, residual] = all[19];
            println!("{drag:.4e} {press:.4e} {lean:.4e} {dissipated:.3e} {residual:.3e}");
            let angle = if rubs { mu.atan() } else { 0.0 };
            let exact = (angle - lean.atan()).tan();
            assert!(press > 0.1 && lean > 0.0, "{all:?}");
            assert!((drag / press - exact).abs() < 1e-4, "{exact} {all:?}");
            // without friction relaxation leaves 1e-10 of either sign
            assert_eq!(dissipated > 1e-6, rubs, "{all:?}");
            if rubs {
                // it sticks before it slips
                let [drag, press, lean, ..] = all[11];
                assert!(drag / press < 0.8 * (angle - lean.atan()).tan(), "{all:?}");
            }
        }
    }
}

/// A stiff disk, with and without friction, is met by FIRE as by relaxation.
#[test]
fn fire_finds_what_relaxation_finds() {
    let way = ["2*max(t - 0.5, 0)", "-0.5*min(2*t, 1)"];
    for friction in [None, Some(FrictionSpec::constant(0.2))] {
        let [relaxed, fire] = [Method::Relaxation, Method::Fire]
            .map(|method| forces_rubbed(method, way, ["0", "0"], 250.0, friction.clone()));
        let most = relaxed.iter().map(|f| f[1].abs()).fold(0.0, f64::max);
        for (a, b) in relaxed.iter().zip(&fire) {
            for k in 0..2 {
                let off = (a[k] - b[k]).abs();
                assert!(off < 1e-3 * most, "{off:e}: {relaxed:?} {fire:?}");
            }
        }
    }
}
