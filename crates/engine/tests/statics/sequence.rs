//! Bonds broken in turn: the load is what the next one bears, and may fall with its way.

use super::*;

fn breaking(spec: &mut Spec, critical: f64, equilibria: u64) {
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::Stretch(critical)));
    spec.run.schedule.steps = equilibria;
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        control: Control::SequentiallyLinear,
        ..Statics::default()
    });
}

#[test]
fn a_chain_bears_the_critical_stretch_of_all_its_springs() {
    let mut spec = block(
        [20.0, 0.0, 0.0],
        1,
        LawSpec::Pmb(PmbStiffness::Micromodulus(1.0)),
    );
    hold(&mut spec, "low", [number(0.0), None, None]);
    hold(&mut spec, "high", [text("3*t"), None, None]);
    breaking(&mut spec, 0.01, 1);
    let mut sim = solved(&spec);
    // 20 springs, 3 at t = 1
    assert!((sim.time() - 0.2 / 3.0).abs() < 1e-13, "{}", sim.time());
    let l = sim.ledger().unwrap();
    assert!((l.strain - 20.0 * 0.5e-4).abs() < 1e-14, "{l:?}");
    assert!(l.residual().abs() < 1e-15, "{l:?}");
    assert_eq!(sim.broken(), 0);
    // all break together, and nothing is left: the state is that of before
    let before = sim.displacements();
    let error = sim.step().unwrap_err().to_string();
    assert!(error.contains("increment 2"), "{error}");
    assert!(error.contains("nothing is left to break"), "{error}");
    assert_eq!((sim.step_number(), sim.broken()), (1, 0));
    assert_eq!(sim.displacements(), before);
    assert!((sim.time() - 0.2 / 3.0).abs() < 1e-13);
    assert_eq!(sim.ledger().unwrap().released, 0.0);
}

/// A chain of springs of the length 1 and the section 1: `E = c`, the stress of its points `E s`, of those at its ends half of that, and a bond has the
/// mean of both ends. So the load is what the inner springs bear, all of which let go together, and then nothing holds any more.
#[test]
fn a_chain_bears_the_stress_of_its_inner_springs() {
    let mut spec = block(
        [20.0, 0.0, 0.0],
        1,
        LawSpec::Pmb(PmbStiffness::Micromodulus(2.0)),
    );
    hold(&mut spec, "low", [number(0.0), None, None]);
    hold(&mut spec, "high", [text("3*t"), None, None]);
    breaking(&mut spec, 0.01, 1);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::VonMises(0.01)));
    let mut sim = solved(&spec);
    // 20 springs, 3 at t = 1
    assert!((sim.time() - 0.1 / 3.0).abs() < 1e-13, "{}", sim.time());
    let l = sim.ledger().unwrap();
    assert!((l.strain - 20.0 * 0.25e-4).abs() < 1e-14, "{l:?}");
    assert!(l.residual().abs() < 1e-15, "{l:?}");
    assert_eq!(sim.broken(), 0);
    let error = sim.step().unwrap_err().to_string();
    assert!(error.contains("nothing is left to break"), "{error}");
}

/// The energy closes to round-off where bonds break by stress, and the first equilibrium has twice the load where they bear twice as much.
#[test]
fn a_bar_of_bonds_that_break_by_stress_closes_its_ledger() {
    let run = |limit: f64| {
        let mut spec = slender();
        spec.space.plane = Plane::Strain;
        spec.materials[0].fracture = Some(FractureSpec::new(Criterion::VonMises(limit)));
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let mut times = vec![];
        for n in 1..=8 {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            let off = l.residual().abs() / l.work_boundary_conditions.abs().max(l.strain);
            assert!(off < 1e-9, "{n}: {off:e} {l:?}");
            assert_eq!(sim.broken() > 0, n > 1);
            times.push(sim.time());
        }
        times
    };
    let (one, two) = (run(0.01), run(0.02));
    for (a, b) in one.iter().zip(&two) {
        assert!((b / a - 2.0).abs() < 1e-9, "{one:?} {two:?}");
    }
}

/// A bond of the length 1 takes `w = ½ c s²`, and of a chain of such bonds a crack takes that of one: `s = √(2 G/c)`.
#[test]
fn a_chain_bears_the_work_of_its_springs() {
    let mut spec = block(
        [20.0, 0.0, 0.0],
        1,
        LawSpec::Pmb(PmbStiffness::Micromodulus(2.0)),
    );
    hold(&mut spec, "low", [number(0.0), None, None]);
    hold(&mut spec, "high", [text("3*t"), None, None]);
    breaking(&mut spec, 0.01, 1);
    spec.materials[0].fracture = Some(FractureSpec::new(Criterion::BondEnergy(1e-4)));
    let mut sim = solved(&spec);
    assert!((sim.time() - 0.2 / 3.0).abs() < 1e-13, "{}", sim.time());
    let l = sim.ledger().unwrap();
    assert!((l.strain - 20.0 * 1e-4).abs() < 1e-14, "{l:?}");
    assert!(l.residual().abs() < 1e-15, "{l:?}");
    let error = sim.step().unwrap_err().to_string();
    assert!(error.contains("nothing is left to break"), "{error}");
}

/// All loads go with the root of what bonds bear. The energy closes to round-off of laws of bonds; where a bond bears with its families, too, its path to
/// nothing is no line, and what it releases is known to some 1e-4, as where bonds break by their stretch.
#[test]
fn a_bar_of_bonds_that_break_by_work_closes_its_ledger() {
    let lps = LawSpec::Lps(Moduli {
        young: 1.0,
        poisson: 0.3,
    });
    let laws = [(LawSpec::Pmb(PmbStiffness::Young(1.0)), 1e-9), (lps, 1e-3)];
    for (law, bound) in laws {
        let run = |energy: f64| {
            let mut spec = slender();
            spec.materials[0].law = law.clone();
            spec.materials[0].fracture = Some(FractureSpec::new(Criterion::BondEnergy(energy)));
            let mut sim = build(&spec, Options::default()).unwrap();
            sim.start(true);
            let mut times = vec![];
            for n in 1..=6 {
                sim.step().unwrap();
                let l = sim.ledger().unwrap();
                let off = l.residual().abs() / l.work_boundary_conditions.abs().max(l.strain);
                assert!(off < bound, "{law:?} {n}: {off:e} {l:?}");
                assert_eq!(sim.broken() > 0, n > 1);
                times.push(sim.time());
            }
            times
        };
        let (one, four) = (run(1e-4), run(4e-4));
        for (a, b) in one.iter().zip(&four) {
            assert!((b / a - 2.0).abs() < 1e-9, "{law:?}: {one:?} {four:?}");
        }
    }
}

/// A bar five times as long as it is wide, with a notch, pulled by t.
pub(super) fn slender() -> Spec {
    let mut spec = block([40.0, 7.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.damage.precracks.push(PrecrackSpec {
        shape: CrackShape::Segment {
            from: [20.5, -1.0, 0.0],
            to: [20.5, 1.5, 0.0],
        },
        kind: CrackKind::Broken,
    });
    hold(&mut spec, "low", [number(0.0), number(0.0), None]);
    hold(&mut spec, "high", [text("t"), number(0.0), None]);
    breaking(&mut spec, 0.01, 12);
    spec
}

/// Energy to round-off through every break, and a curve that turns back.
#[test]
fn a_slender_bar_snaps_back_and_its_ledger_closes() {
    let spec = slender();
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let mut curve: Vec<(f64, f64)> = vec![];
    let mut released = 0.0;
    for n in 1..=12 {
        sim.step().unwrap();
        let l = sim.ledger().unwrap();
        let off = l.residual().abs() / l.work_boundary_conditions.abs().max(l.strain);
        println!("{n}: t {} {l:?}, broken {}", sim.time(), sim.broken());
        assert!(off < 1e-9, "{n}: {off:e} {l:?}");
        // ½ P Δ of a linear body
        curve.push((sim.time(), 2.0 * l.strain / sim.time()));
        assert_eq!(sim.broken() > 0, n > 1);
        assert!(l.released > released || n == 1);
        released = l.released;
    }
    for pair in curve.windows(2) {
        // every cut makes the bar softer
        assert!(pair[1].1 / pair[1].0 < pair[0].1 / pair[0].0, "{curve:?}");
    }
    let first = curve[0];
    let turned = curve.iter().filter(|c| c.0 < first.0 && c.1 < first.1);
    assert!(turned.count() > 3, "{curve:?}");
}

/// The first equilibrium is that at which load control breaks the first bond, and the same bond.
#[test]
fn the_first_bond_is_that_of_load_control() {
    let spec = slender();
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    sim.step().unwrap();
    let factor = sim.time();
    sim.step().unwrap();
    let broken = sim.broken();
    for (part, breaks) in [(0.99, false), (1.01, true)] {
        let mut told = spec.clone();
        told.loading.conditions.pop();
        hold(
            &mut told,
            "high",
            [text(&format!("{:e}*t", part * factor)), number(0.0), None],
        );
        told.run.schedule.steps = 1;
        told.run.schedule.stepper = Stepper::Statics(Statics::default());
        let mut sim = build(&told, Options::default()).unwrap();
        sim.start(true);
        // what follows may take the bar apart
        let _ = sim.step();
        assert_eq!(sim.broken() >= broken, breaks, "{part}: {}", sim.broken());
    }
}

#[test]
fn what_has_no_factor_is_refused() {
    let said = |change: &dyn Fn(&mut Spec)| {
        let mut spec = slender();
        change(&mut spec);
        build(&spec, Options::default()).err().unwrap()
    };
    let newton = said(&|spec| {
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            control: Control::SequentiallyLinear,
            method: Method::Newton,
            ..Statics::default()
        });
    });
    assert_eq!(newton.path, "statics.control");
    let whole = said(&|spec| spec.materials[0].fracture = None);
    assert_eq!(whole.path, "materials[0].fracture");
    let constant = said(&|spec| {
        let force = ConditionKind::BodyForce([None, number(1e-6), None]);
        spec.loading.conditions.push(ConditionSpec {
            set: "all".into(),
            kind: force,
        });
    });
    assert_eq!(constant.path, "conditions");
}

/// A strip that repeats across, with notches wherever they are: bonds through its faces break in turn like all others.
#[test]
fn bonds_through_periodic_faces_break_in_turn() {
    let strip = |notches: &[[f64; 3]]| {
        let mut spec = block([40.0, 7.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
        spec.bonds.horizon = Horizon::Ratio(2);
        spec.space.periodic[1] = Some(8.0);
        for [x, low, high] in notches {
            spec.damage.precracks.push(PrecrackSpec {
                shape: CrackShape::Segment {
                    from: [*x, *low, 0.0],
                    to: [*x, *high, 0.0],
                },
                kind: CrackKind::Broken,
            });
        }
        hold(&mut spec, "low", [number(0.0), number(0.0), None]);
        hold(&mut spec, "high", [text("t"), number(0.0), None]);
        breaking(&mut spec, 0.01, 6);
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            control: Control::SequentiallyLinear,
            solver: Solver::Direct,
            ..Statics::default()
        });
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let factors: Vec<(f64, u64)> = (0..6)
            .map(|_| {
                sim.step().unwrap();
                (sim.time(), sim.broken())
            })
            .collect();
        assert!(factors[5].1 > 0);
        let l = sim.ledger().unwrap();
        assert!(l.residual().abs() < 1e-8 * l.strain, "{l:?}");
        factors
    };
    let within = strip(&[[20.5, 2.6, 5.4], [12.5, 4.6, 5.4]]);
    // by half a period: the long one lies across the face
    let across = strip(&[[20.5, 6.6, 8.6], [20.5, -1.4, 1.4], [12.5, 0.6, 1.4]]);
    for ((a, broken), (b, also)) in within.iter().zip(&across) {
        assert!((a / b - 1.0).abs() < 1e-8, "{within:?} {across:?}");
        assert_eq!(broken, also);
    }
}
