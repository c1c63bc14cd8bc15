//! The energy ledger closes: what goes in is what is there, up to the error of the time step.

use crate::sample::*;
use peridyne::observe::Ledger;
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn block(kind: LatticeKind) -> Place {
    let cells = match kind.dimension() {
        1 => [16, 1, 1],
        2 => [10, 6, 1],
        _ => [6, 4, 4],
    };
    Place {
        kind,
        plane: Plane::Strain,
        ratio: 2,
        cells,
    }
}

/// The same for a material, whose plane it may have to be.
fn block_of(name: &str, kind: LatticeKind) -> Place {
    let place = block(kind);
    match name {
        "laminae" => Place {
            plane: Plane::Stress,
            ..place
        },
        _ => place,
    }
}

fn ends(spec: &mut Spec, cells: usize) {
    let half = |x: f64, sign: f64| {
        Members::Region(Region::HalfSpace {
            point: [x, 0.0, 0.0],
            normal: [sign, 0.0, 0.0],
        })
    };
    for (name, members) in [
        ("low", half(1.1 * H, 1.0)),
        ("high", half((cells as f64 - 2.1) * H, -1.0)),
    ] {
        spec.sets.push(SetSpec {
            name: name.into(),
            members,
        });
    }
}

fn on(set: &str, kind: ConditionKind) -> ConditionSpec {
    ConditionSpec {
        set: set.into(),
        kind,
    }
}

/// Everything that may act on a body, by name.
fn loads() -> Vec<(&'static str, Vec<ConditionSpec>)> {
    use ConditionKind::*;
    let x = |s: &str| [Some(e(s)), None, None];
    vec![
        (
            "pulled at both ends",
            vec![
                on("low", Velocity(x("-0.05*min(t,1)"))),
                on("high", Velocity(x("0.05*min(t,1)"))),
            ],
        ),
        (
            "shaken by displacement",
            vec![on("low", Displacement(x("0.1*(1-cos(2*t))")))],
        ),
        ("body force", vec![on("all", BodyForce(x("0.1*sin(t)")))]),
        (
            "traction",
            vec![
                on(
                    "high",
                    Traction {
                        value: x("0.05*t"),
                        area: None,
                    },
                ),
                on("low", Displacement(x("0"))),
            ],
        ),
        (
            "damped body force",
            vec![
                on("all", BodyForce(x("0.1*sin(t)*x"))),
                on("all", Damping(e("0.3"))),
            ],
        ),
        (
            "force set on an end that is also loaded",
            vec![
                on("all", BodyForce(x("0.1*sin(t)"))),
                on("high", SetForce(x("0.2*sin(2*t)"))),
            ],
        ),
        (
            "a load on a moved end",
            vec![
                on("low", Velocity(x("0.1*sin(t)"))),
                on("low", BodyForce(x("0.2*t"))),
            ],
        ),
    ]
}

fn work(l: &Ledger) -> f64 {
    l.work_boundary_conditions.abs() + l.work_rigid_bodies.abs() + l.dissipated.abs()
}

#[test]
fn the_ledger_of_intact_bodies_closes_to_second_order() {
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        let mut laws = vec!["pmb", "lps mixed", "viscoelastic", "softening"];
        if kind != LatticeKind::Chain {
            laws.extend(["hypoelastic", "metal and soil", "laminae"]);
        }
        for name in laws {
            for (what, conditions) in loads() {
                let place = block_of(name, kind);
                let case = Case::of(name, place);
                let residual = |n: usize| {
                    let mut spec = case.spec();
                    ends(&mut spec, place.cells[0]);
                    spec.loading.conditions = conditions.clone();
                    spec.run.schedule.time_step = TimeStep::Fixed(4.0 / n as f64);
                    let mut sim = made(&spec);
                    sim.start(true);
                    let mut worst: f64 = 0.0;
                    for _ in 0..n {
                        sim.step().unwrap();
                        worst = worst.max(sim.ledger().unwrap().residual().abs());
                    }
                    worst / work(&sim.ledger().unwrap())
                };
                let (coarse, fine) = (residual(80), residual(160));
                println!("{name} {kind:?}, {what}: {coarse:.1e}, {fine:.1e} of the work");
                assert!(fine < 1e-3, "{} {what}: {fine}", case.name());
                let ratio = coarse / fine;
                assert!(
                    (3.3..5.0).contains(&ratio),
                    "{} {what}: {ratio}",
                    case.name()
                );
            }
        }
    }
}

/// Families, and when their bonds let go.
const WAYS: [(FamilyChoice, Breakage); 4] = [
    (FamilyChoice::Stencil, Breakage::BeforeForce),
    (FamilyChoice::Stencil, Breakage::AfterForce),
    (FamilyChoice::List, Breakage::BeforeForce),
    (FamilyChoice::List, Breakage::AfterForce),
];

/// Bonds that break give up what they held, whenever they let go.
#[test]
fn the_ledger_of_breaking_bodies_closes() {
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        let laws: &[&str] = match kind {
            // there plasticity is at home
            LatticeKind::Cubic => &[
                "pmb",
                "lps",
                "lps mixed",
                "elastic-plastic",
                "plastic mixed",
            ],
            _ => &["pmb", "lps", "lps mixed", "viscoelastic", "softening"],
        };
        for name in laws {
            for (family, breakage) in WAYS {
                let place = block(kind);
                let case = Case::of(name, place);
                let mut spec = case.spec();
                spec.bonds.family = family;
                spec.damage.breakage = breakage;
                ends(&mut spec, place.cells[0]);
                spec.loading.conditions = vec![
                    on(
                        "low",
                        ConditionKind::Velocity([Some(e("-0.2")), None, None]),
                    ),
                    on(
                        "high",
                        ConditionKind::Velocity([Some(e("0.2")), None, None]),
                    ),
                ];
                spec.interactions.contact = Some(CONTACT);
                breaking(&mut spec, 0.05);
                spec.run.schedule.time_step = TimeStep::Fixed(0.005);
                let mut sim = made(&spec);
                sim.start(true);
                steps(sim.as_mut(), 800);
                let l = sim.ledger().unwrap();
                assert!(sim.fragments() > 1 && sim.broken() > 0, "{}", case.name());
                let off = l.residual().abs() / work(&l);
                println!(
                    "{name} {kind:?} {family:?} {breakage:?}, torn: residual {off:.1e} of the work, released {:.2} of it",
                    l.released / work(&l)
                );
                // bonds that soften dissipate before they break
                let gone = l.released + l.dissipated;
                assert!(gone > 0.02 * work(&l), "{}: {l:?}", case.name());
                // what is across relaxes through the step of a break as if it had been torn from its start
                let most = if *name == "viscoelastic" { 1e-2 } else { 1e-3 };
                assert!(off < most, "{}: {off}", case.name());
            }
        }
    }
}

/// What the energies of breaking bodies do not account for falls with the square of the step: of laws with a point scalar too,
/// whose other bonds pull with the pressure of before over half a step, and of bonds through periodic faces.
#[test]
fn what_breaking_bodies_lose_is_of_second_order() {
    for (kind, periodic) in [
        (LatticeKind::Square, false),
        (LatticeKind::Square, true),
        (LatticeKind::Cubic, false),
    ] {
        let laws = [
            "pmb",
            "lps",
            "lps mixed",
            "correspondence",
            "hypoelastic",
            "viscoelastic",
            "viscoelastic mixed",
            "laminae",
        ];
        for name in laws {
            for (family, breakage) in WAYS {
                let place = block_of(name, kind);
                let case = Case::of(name, place);
                let residual = |n: usize| {
                    let mut spec = case.spec();
                    if periodic {
                        spec.space.periodic[1] = case.periodic().space.periodic[1];
                    }
                    spec.bonds.family = family;
                    spec.damage.breakage = breakage;
                    ends(&mut spec, place.cells[0]);
                    spec.loading.conditions = [("low", "-0.2"), ("high", "0.2")]
                        .map(|(set, v)| on(set, ConditionKind::Velocity([Some(e(v)), None, None])))
                        .to_vec();
                    breaking(&mut spec, 0.05);
                    spec.run.schedule.time_step = TimeStep::Fixed(4.0 / n as f64);
                    let mut sim = made(&spec);
                    sim.start(true);
                    steps(sim.as_mut(), n);
                    let l = sim.ledger().unwrap();
                    assert!(sim.broken() > 0);
                    l.residual() / work(&l)
                };
                let [coarse, fine] = [400, 3200].map(residual).map(f64::abs);
                println!(
                    "{name} {kind:?} {family:?} {breakage:?}, periodic {periodic}: {coarse:.2e}, {fine:.2e}"
                );
                // second order is 64 and first order 8; bonds do not break at the same time in both
                // 25 and 28 of what relaxes across a plane, whose bonds let go after the force
                let plane = name.starts_with("viscoelastic") && kind == LatticeKind::Square;
                let late = plane && breakage == Breakage::AfterForce;
                let least = if late { 20.0 } else { 30.0 };
                assert!(
                    fine < coarse / least,
                    "{name} {kind:?} {family:?} {breakage:?}"
                );
            }
        }
    }
}

/// A mass thrown at a free block: momentum and energy of both, before and after.
#[test]
fn a_thrown_mass_gives_what_it_loses() {
    for kind in [LatticeKind::Square, LatticeKind::Cubic] {
        for name in ["pmb", "lps"] {
            let place = block(kind);
            let mut spec = Case::of(name, place).spec();
            let (mass, v0) = (0.02, -0.4);
            let top = (place.cells[1] as f64 - 1.0) * H;
            spec.loading.rigid_bodies = vec![RigidBodySpec::sphere(
                40.0,
                1.5 * H,
                RigidBodyMotion::Free(FreeSpec::new(
                    mass,
                    [1.3, top + 1.55 * H, 0.4],
                    [0.0, v0, 0.0],
                )),
            )];
            spec.run.schedule.time_step = TimeStep::Fixed(0.01);
            let mut sim = made(&spec);
            sim.start(true);
            steps(sim.as_mut(), 300);
            // the mass has left when nothing works any more
            let before = sim.ledger().unwrap();
            steps(sim.as_mut(), 200);
            let l = sim.ledger().unwrap();
            assert_eq!(
                before.work_rigid_bodies, l.work_rigid_bodies,
                "{name}: still touching"
            );
            assert!(l.work_rigid_bodies > 0.0);
            let given = momentum(sim.as_mut());
            let w = given.map(|p| -p / mass);
            let lost = 0.5 * mass * (v0 * v0 - w[0].powi(2) - (v0 + w[1]).powi(2) - w[2].powi(2));
            assert!(given[1] < 0.0 && v0 + w[1] > v0, "{given:?}");
            let (energy, balance) = (
                (lost - l.work_rigid_bodies).abs() / l.work_rigid_bodies,
                l.residual().abs() / l.work_rigid_bodies,
            );
            println!(
                "{name} {kind:?}, thrown mass: energy lost = work to {energy:.1e}, residual {balance:.1e}"
            );
            assert!(
                energy < 1e-3 && balance < 1e-3,
                "{name} {kind:?}: {energy} {balance}"
            );
        }
    }
}

/// Linear momentum of the body.
fn momentum(sim: &mut dyn Simulation) -> [f64; 3] {
    let (volume, density) = (sim.scalars("volume"), sim.scalars("density"));
    let mut sum = [0.0; 3];
    for (i, v) in sim.velocities().iter().enumerate() {
        for a in 0..3 {
            sum[a] += volume[i] * density[i] * v[a];
        }
    }
    sum
}

/// What the conditions give in momentum is what the body has: gravity on a free body, exactly.
#[test]
fn a_free_fall_is_a_parabola() {
    for case in cases() {
        let mut spec = case.spec();
        spec.loading.conditions = vec![on(
            "all",
            ConditionKind::BodyForce([Some(e("0.003")), None, None]),
        )];
        spec.materials.iter_mut().for_each(|m| m.density = RHO);
        let mut sim = made(&spec);
        sim.start(true);
        steps(sim.as_mut(), 100);
        let fall = 0.5 * 0.003 / RHO * sim.time().powi(2);
        for u in sim.displacements() {
            assert!((u[0] / fall - 1.0).abs() < 1e-11, "{}: {u:?}", case.name());
        }
        let l = sim.ledger().unwrap();
        assert!(l.residual().abs() < 1e-11 * l.kinetic && l.strain < 1e-20 * l.kinetic);
    }
}
