//! Statics before motion against closed forms; one ledger through both.

use super::*;
use std::f64::consts::PI;

/// Motion by this stepper from an equilibrium.
fn then(spec: &mut Spec, increments: u64, stepper: Stepper, step: f64) {
    spec.run.preload = Some(PreloadSpec {
        statics: Statics {
            method: Method::Newton,
            tolerance: 1e-12,
            ..Statics::default()
        },
        increments,
        duration: None,
        conditions: std::mem::take(&mut spec.loading.conditions),
        rigid_bodies: vec![],
        cuts: vec![],
    });
    spec.run.schedule.stepper = stepper;
    spec.run.schedule.time_step = TimeStep::Fixed(step);
}

fn started(spec: &Spec) -> Box<dyn Simulation> {
    let mut sim = build(spec, Options::default()).unwrap();
    sim.start(true);
    sim
}

fn condition(set: &str, kind: ConditionKind) -> ConditionSpec {
    ConditionSpec {
        set: set.into(),
        kind,
    }
}

/// A chain of unit springs and masses, held at its low end and loaded like its second mode, is let go: `u_j = a sin(θ j) cos(ω t)`,
/// `θ = 3π/(2N + 1)`, `ω = 2 sin(θ/2)`, and its energy is what the loads did, `½ a² ω² Σ sin²(θ j)`.
#[test]
fn a_bar_that_is_let_go_vibrates_with_the_energy_of_its_load() {
    let n = 20;
    let theta = 3.0 * PI / f64::from(2 * n + 1);
    let omega = 2.0 * (0.5 * theta).sin();
    let load = format!("{:e}*sin({theta:e}*x)*t", 0.01 * omega * omega);
    let squares: f64 = (1..=n).map(|j| (theta * f64::from(j)).sin().powi(2)).sum();
    let energy = 0.5 * 1e-4 * omega * omega * squares;
    let dt = 0.25;
    // how far each method turns a mode in a step
    let verlet = 2.0 * (0.5 * omega * dt).asin();
    let trapezoidal = 2.0 * (0.5 * omega * dt).atan();
    for (stepper, turn) in [
        (Stepper::Verlet, verlet),
        (Stepper::Newmark(Newmark::default()), trapezoidal),
    ] {
        for increments in [1, 5] {
            let mut spec = block([f64::from(n), 0.0, 0.0], 1, SPRINGS);
            hold(&mut spec, "low", [number(0.0), None, None]);
            let still = spec.loading.conditions.clone();
            let pulled = ConditionKind::BodyForce([text(&load), None, None]);
            spec.loading.conditions.push(condition("all", pulled));
            then(&mut spec, increments, stepper, dt);
            spec.loading.conditions = still;
            let mut sim = started(&spec);
            for k in 0..increments {
                let shown = (k as f64 - increments as f64) * dt;
                assert!((sim.clock() - shown).abs() < 1e-14);
                sim.step().unwrap();
            }
            let l = sim.ledger().unwrap();
            assert!((l.strain / energy - 1.0).abs() < 1e-11, "{l:?} {energy}");
            assert!(
                (l.work_boundary_conditions / energy - 1.0).abs() < 1e-11,
                "{l:?}"
            );
            assert_eq!((sim.clock(), l.kinetic), (0.0, 0.0));
            let mut exchanged = 0.0f64;
            for k in 1..=200 {
                sim.step().unwrap();
                let amplitude = 0.01 * (f64::from(k) * turn).cos();
                for (x, u) in sim.vectors("reference").iter().zip(sim.displacements()) {
                    let exact = amplitude * (theta * x[0]).sin();
                    assert!((u[0] - exact).abs() < 1e-12, "step {k}: {u:?}, not {exact}");
                }
                let l = sim.ledger().unwrap();
                exchanged = exchanged.max(l.kinetic / energy);
                // Verlet's energy swings by (ωΔt)²/4
                let bound = match stepper {
                    Stepper::Verlet => 0.25 * (omega * dt).powi(2),
                    _ => 1e-11,
                };
                assert!(l.residual().abs() < bound * energy, "step {k}: {l:?}");
                assert!((l.work_boundary_conditions / energy - 1.0).abs() < 1e-11);
            }
            assert!(exchanged > 0.9);
            assert!((sim.time() - 200.0 * dt).abs() < 1e-12);
            assert_eq!(sim.clock(), sim.time());
        }
    }
}

/// A row of points in the plane under tension: `ω_k = 2 √(T/(ℓ m)) sin(kπ/2N)` across it, T the force of a bond and ℓ its length, which
/// on a long string is `f = √(T/μ)/2L`.
#[test]
fn a_string_sounds_as_its_tension_says() {
    let n = 40;
    let mut spec = block(
        [f64::from(n), 0.0, 0.0],
        2,
        LawSpec::Pmb(PmbStiffness::Micromodulus(1.0)),
    );
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    let low = spec.loading.conditions.clone();
    let stretch = 0.02;
    let end = stretch * f64::from(n);
    hold(
        &mut spec,
        "high",
        [text(&format!("{end}*t")), number(0.0), None],
    );
    // nothing resists across a row without tension
    hold(&mut spec, "all", [None, number(0.0), None]);
    then(&mut spec, 2, Stepper::Verlet, 0.1);
    spec.loading.conditions = low;
    hold(&mut spec, "high", [number(end), number(0.0), None]);
    let mut sim = started(&spec);
    sim.step().unwrap();
    sim.step().unwrap();
    let (tension, length) = (stretch, 1.0 + stretch);
    for (k, mode) in sim.modes(5).unwrap().iter().enumerate() {
        let part = (k + 1) as f64 * PI / f64::from(2 * n);
        let exact = 2.0 * (tension / length).sqrt() * part.sin() / (2.0 * PI);
        assert!(
            (mode.frequency / exact - 1.0).abs() < 1e-9,
            "mode {k}: {} {exact}",
            mode.frequency
        );
        if k == 0 {
            let string = (tension * length).sqrt() / (2.0 * f64::from(n) * length);
            let off = mode.frequency / string - 1.0;
            // (π/2N)²/6 of a string of points
            assert!(off.abs() < 3e-4, "{off}");
        }
    }
    // nothing moves: it is in equilibrium
    for _ in 0..100 {
        sim.step().unwrap();
    }
    assert!(sim.ledger().unwrap().kinetic < 1e-20);
}

/// A plate of a nonlinear law, pulled and held.
fn pulled(law: LawSpec) -> Spec {
    let mut spec = block([16.0, 12.0, 0.0], 2, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [text("0.3*t"), number(0.0), None]);
    then(&mut spec, 3, Stepper::Verlet, 0.1);
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [number(0.3), number(0.0), None]);
    spec
}

const LPS: LawSpec = LawSpec::Lps(Moduli {
    young: 1.0,
    poisson: 0.3,
});

#[test]
fn a_stretched_plate_rests_until_it_is_cut_and_its_cut_releases_what_its_bonds_held() {
    for law in [LawSpec::Pmb(PmbStiffness::Young(1.0)), LPS] {
        let mut spec = pulled(law.clone());
        let mut rests = started(&spec);
        for _ in 0..43 {
            rests.step().unwrap();
        }
        let l = rests.ledger().unwrap();
        assert!(l.kinetic < 1e-14 * l.strain, "{law:?}: {l:?}");
        // the trapezoidal rule of the loads' work, over three increments of a stretch of 2 %
        assert!(l.residual().abs() < 1e-3 * l.strain, "{law:?}: {l:?}");
        let Some(preload) = &mut spec.run.preload else {
            unreachable!()
        };
        preload.cuts.push(PrecrackSpec {
            shape: CrackShape::Segment {
                from: [8.5, -1.0, 0.0],
                to: [8.5, 6.5, 0.0],
            },
            kind: CrackKind::Broken,
        });
        let mut cut = started(&spec);
        for _ in 0..3 {
            cut.step().unwrap();
        }
        let before = cut.ledger().unwrap();
        assert_eq!((before.released, cut.info().cut), (0.0, 0));
        cut.step().unwrap();
        assert!(cut.info().cut > 0);
        let after = cut.ledger().unwrap();
        assert!(after.released > 0.01 * before.strain, "{after:?}");
        for _ in 0..200 {
            cut.step().unwrap();
        }
        let l = cut.ledger().unwrap();
        assert!(l.kinetic > 1e-3 * l.strain, "{law:?}: {l:?}");
        let off = l.residual() - before.residual();
        assert!(off.abs() < 1e-2 * l.kinetic, "{law:?}: {off:e} {l:?}");
    }
}

#[test]
fn velocities_that_are_given_begin_with_motion() {
    let mut spec = pulled(LPS);
    spec.loading.initial.push(InitialSpec {
        set: "all".into(),
        displacement: [None, None, None],
        velocity: [None, text("0.01*sin(x)"), None],
    });
    let mut sim = started(&spec);
    for _ in 0..3 {
        sim.step().unwrap();
        assert_eq!(sim.ledger().unwrap().kinetic, 0.0);
    }
    let strain = sim.ledger().unwrap().strain;
    sim.step().unwrap();
    let l = sim.ledger().unwrap();
    assert!((l.initial - l.kinetic).abs() < 1e-2 * l.kinetic, "{l:?}");
    assert!(l.kinetic > 0.1 * strain);
    assert!(l.residual().abs() < 1e-3 * strain, "{l:?}");
}

#[test]
fn what_cannot_begin_in_equilibrium_is_refused() {
    let spec = pulled(LPS);
    let said = |spec: &Spec| build(spec, Options::default()).err().unwrap();
    let of = |change: &dyn Fn(&mut PreloadSpec)| {
        let mut spec = spec.clone();
        spec.run.preload.iter_mut().for_each(change);
        said(&spec)
    };
    let linear = of(&|p| p.statics.method = Method::Linear);
    assert_eq!(linear.path, "preload.statics.method");
    assert_eq!(of(&|p| p.increments = 0).path, "preload.statics");
    assert_eq!(of(&|p| p.duration = Some(-1.0)).path, "preload.duration");
    let loose = of(&|p| p.conditions.clear());
    assert_eq!(loose.path, "preload.conditions", "{loose:?}");
    let mut jump = spec.clone();
    jump.loading.conditions.clear();
    hold(&mut jump, "low", [number(0.1), None, None]);
    let jump = said(&jump);
    assert!(
        jump.message.contains("begins with a displacement of 0.1"),
        "{jump:?}"
    );
    // where statics leaves a point nobody knows before
    let mut jump = spec.clone();
    hold(&mut jump, "all", [None, number(0.0), None]);
    let mut sim = started(&jump);
    for _ in 0..3 {
        sim.step().unwrap();
    }
    let error = sim.step().unwrap_err().to_string();
    assert!(error.contains("prescribe a velocity of 0"), "{error}");
    assert_eq!(sim.step_number(), 3);
    let mut held = spec.clone();
    held.loading.conditions.push(condition(
        "all",
        ConditionKind::Velocity([None, number(0.0), None]),
    ));
    let mut sim = started(&held);
    (0..10).for_each(|_| sim.step().unwrap());
}

/// The work that statics did on a bond counts in the motion that follows: a plate that is stretched nearly to its end breaks by little more, which
/// alone does nothing to it; and statics breaks it where statics alone does.
#[test]
fn work_on_bonds_goes_on_from_statics_to_motion() {
    let plate = |end: &str| {
        let mut spec = block([12.0, 4.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::BondEnergy(5e-4)));
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [text(end), number(0.0), None]);
        spec
    };
    let newton = |spec: &mut Spec, increments: u64| {
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            method: Method::Newton,
            tolerance: 1e-12,
            ..Statics::default()
        });
        spec.run.schedule.steps = increments;
        spec.run.schedule.time_step = TimeStep::Fixed(1.0 / increments as f64);
    };
    // where does the first bond break?
    let mut alone = plate("0.4*t");
    newton(&mut alone, 200);
    let mut sim = started(&alone);
    let most = loop {
        let before = sim.time();
        let broke = sim.step().is_err() || sim.broken() > 0;
        assert!(sim.time() <= 1.0, "nothing breaks");
        if broke {
            break 0.4 * before;
        }
    };
    let after = |stretch: f64, more: f64| {
        let mut spec = plate(&format!("{:e}*t", stretch * most));
        then(&mut spec, 10, Stepper::Verlet, 0.2);
        let pulled = format!("{:e} + {:e}*min(t/200, 1)", stretch * most, more * most);
        spec.loading.conditions = plate(&pulled).loading.conditions;
        let mut sim = started(&spec);
        (0..10).for_each(|_| sim.step().unwrap());
        let statics = sim.broken();
        (0..1500).for_each(|_| sim.step().unwrap());
        [statics, sim.broken()]
    };
    assert_eq!(after(0.9, 0.0), [0, 0]);
    let [none, some] = after(0.9, 0.2);
    assert!(none == 0 && some > 0, "{none} {some}");
    assert_eq!(after(0.0, 0.2), [0, 0]);
}
