//! Paths on which the load falls, against closed forms: bonds that soften, a truss that snaps through.

use super::*;

fn followed(spec: &mut Spec, control: Control, tolerance: f64) {
    spec.run.schedule.stepper = Stepper::Statics(Statics {
        method: Method::Newton,
        control,
        tolerance,
        ..Statics::default()
    });
}

fn softening(critical: f64) -> MaterialSpec {
    let constants = Parameters::numbers(&[("young", 1.0), ("onset", 0.2)]);
    let Spec { mut materials, .. } =
        block([4.0, 0.0, 0.0], 1, LawSpec::named("softening", constants));
    let mut material = materials.remove(0);
    material.fracture = Some(FractureSpec::new(Criterion::Stretch(critical)));
    material
}

/// A chain of 40 bonds of which the one in the middle softens, from a stretch of 0.01 to 0.05: the others are elastic, so all is known.
fn chain(increments: u64, opening: f64) -> Spec {
    chains(1, increments, opening)
}

/// So many of them beside each other, bonded across and through periodic faces; none moves across.
fn chains(rows: usize, increments: u64, opening: f64) -> Spec {
    let law = LawSpec::Pmb(PmbStiffness::Young(1.0));
    let mut spec = block([40.0, rows as f64 - 1.0, 0.0], rows.min(2), law);
    spec.bonds.horizon = Horizon::Ratio(1);
    if rows > 1 {
        spec.space.periodic[1] = Some(rows as f64);
        hold(&mut spec, "all", [None, number(0.0), None]);
    }
    let part = |name: &str, condition: &str| SetSpec {
        name: name.into(),
        members: Members::Where(text(condition).unwrap()),
    };
    spec.sets.push(part("weak", "abs(x - 20.5) < 1"));
    spec.sets.push(part("strong", "abs(x - 20.5) > 1"));
    let (mut strong, mut weak) = (softening(5.0), softening(0.05));
    (strong.name, strong.set) = ("strong".into(), "strong".into());
    (weak.name, weak.set) = ("weak".into(), "weak".into());
    spec.materials = vec![strong, weak];
    hold(&mut spec, "low", [number(0.0), None, None]);
    hold(&mut spec, "high", [text("t"), None, None]);
    spec.run.schedule.steps = increments;
    followed(&mut spec, Control::IndirectDisplacement(opening), 1e-12);
    spec
}

#[test]
fn a_softening_bond_takes_its_load_back_and_so_does_the_chain() {
    let mut sim = build(&chain(1, 0.001), Options::default()).unwrap();
    sim.start(true);
    let (mut most, mut least, mut peak) = (0.0f64, f64::INFINITY, 0.0);
    for n in 1..=49 {
        sim.step().unwrap();
        let x = sim.displacements();
        let stretch = |i: usize| x[i + 1][0] - x[i][0];
        let weak = stretch(20);
        let force = |s: f64| match s > 0.01 {
            true => 0.01 * (0.05 - s) / 0.04,
            false => s,
        };
        let elastic = force(weak);
        assert!((stretch(3) - elastic).abs() < 1e-12, "{n}: {weak}");
        let all = 39.0 * elastic + weak;
        assert!(
            (sim.time() - all).abs() < 1e-11,
            "{n}: {} {all}",
            sim.time()
        );
        // all bonds alike open alike, then the weak one alone
        let opened = if n <= 10 { 0.001 * f64::from(n) } else { weak };
        assert!((weak - opened).abs() < 1e-12, "{n}: {weak}");
        if n > 11 {
            assert!((weak - 0.001 * f64::from(n)).abs() < 1e-5, "{n}: {weak}");
        }
        if sim.time() > most {
            (most, peak) = (sim.time(), weak);
        }
        least = if n > 10 { least.min(sim.time()) } else { least };
    }
    assert!(
        (most - 0.4).abs() < 0.01 && (peak - 0.01).abs() < 1.1e-3,
        "{most} {peak}"
    );
    // most of the elongation came back
    assert!(least < 0.07, "{least}");
    // ½ c s0 s_c at the end, c that of a bond of 1 in 1; its two ends
    let ledger = sim.ledger().unwrap();
    assert_eq!(sim.broken(), 0);
    let off = ledger.residual().abs() / ledger.dissipated;
    assert!(off < 1e-9, "{off:e} {ledger:?}");
}

/// Six chains whose bonds across, through the faces too, are as long as they were: each follows the path of one, past where the load falls.
#[test]
fn rows_bonded_through_periodic_faces_soften_as_one_chain() {
    let rows = 6;
    // no increment ends where bonds begin to soften
    let opening = 0.0012;
    let mut sim = build(&chains(rows, 1, opening), Options::default()).unwrap();
    sim.start(true);
    let x = sim.vectors("reference");
    let at = |place: f64| {
        let near = |x: &[f64; 3]| (x[0] - place).abs() < 0.1;
        let ids = x.iter().enumerate().filter(|(_, x)| near(x));
        ids.map(|(id, _)| id).collect::<Vec<_>>()
    };
    let bonds = |place: f64| at(place).into_iter().zip(at(place + 1.0));
    assert_eq!(bonds(20.0).count(), rows);
    let force = |s: f64| match s > 0.01 {
        true => 0.01 * (0.05 - s) / 0.04,
        false => s,
    };
    let (mut weak, mut most) = (0.0, 0.0f64);
    for n in 1..=41 {
        sim.step().unwrap();
        let u = sim.displacements();
        let stretch = |(i, j): (usize, usize)| {
            assert_eq!((x[i][1], u[i][1], u[j][1]), (x[j][1], 0.0, 0.0));
            u[j][0] - u[i][0]
        };
        let opened: Vec<f64> = bonds(20.0).map(stretch).collect();
        weak = opened[0];
        assert!((weak - opening * f64::from(n)).abs() < 1e-5, "{n}: {weak}");
        let all = 39.0 * force(weak) + weak;
        assert!((sim.time() - all).abs() < 1e-11, "{n}: {all}");
        for (opened, elastic) in opened.iter().zip(bonds(3.0).map(stretch)) {
            assert!((opened - weak).abs() < 1e-11, "{n}: {opened} {weak}");
            assert!((elastic - force(weak)).abs() < 1e-11, "{n}: {elastic}");
        }
        most = most.max(sim.time());
    }
    assert!(most > 0.38 && sim.time() < 0.06, "{most} {}", sim.time());
    // ½ s0 s_c less what the bond would still take, beside 39 elastic bonds and what it gives back, in units of its stiffness
    let f = force(weak);
    let exact = 0.05 * (0.01 - f) / (f * (39.0 * f + weak));
    let ledger = sim.ledger().unwrap();
    let found = ledger.dissipated / ledger.strain;
    assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    // by the trapezoidal rule, over the corner of the load: a triangle of 2e-7 beside 2.45e-4
    assert!(ledger.residual().abs() < 1e-3 * ledger.dissipated);
}

/// A notched strip that repeats across softens along the same path wherever its faces are.
#[test]
fn a_path_does_not_see_periodic_faces() {
    let strip = |notches: &[[f64; 3]]| {
        let mut spec = block([40.0, 7.0, 0.0], 2, LawSpec::Pmb(PmbStiffness::Young(1.0)));
        spec.materials = vec![softening(0.01)];
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
        followed(&mut spec, Control::IndirectDisplacement(5e-4), 1e-9);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let path = (0..8).map(|_| {
            sim.step().unwrap();
            let l = sim.ledger().unwrap();
            [sim.time(), l.strain, l.dissipated]
        });
        path.collect::<Vec<_>>()
    };
    let within = strip(&[[20.5, 2.6, 5.4], [12.5, 4.6, 5.4]]);
    // by half a period: the long one lies across the face
    let across = strip(&[[20.5, 6.6, 8.6], [20.5, -1.4, 1.4], [12.5, 0.6, 1.4]]);
    assert!(within[7][2] > 0.0, "{within:?}");
    for (a, b) in within.iter().zip(&across) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() <= 1e-5 * a.abs(), "{within:?} {across:?}");
        }
    }
}

/// Points at (∓1, 0) are held, the one between and 0.3 above them is pushed down: `P = 2 c V² s sin φ`.
#[test]
fn a_shallow_truss_snaps_through() {
    let points = [[-1.0, 0.0, 0.0], [0.0, 0.3, 0.0], [1.0, 0.0, 0.0]];
    let cloud = Cloud {
        position: points.to_vec(),
        volume: vec![1.0; 3],
        spacing: Some(1.0),
        ..Cloud::default()
    };
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(1.0));
    let mut spec = Spec::new(2, BodySpec::Cloud(cloud), 1.0, law);
    spec.bonds.horizon = Horizon::Length(1.2);
    let of = |name: &str, ids: &[u32]| SetSpec {
        name: name.into(),
        members: Members::Points(ids.into()),
    };
    spec.sets = vec![of("feet", &[0, 2]), of("top", &[1])];
    hold(&mut spec, "feet", [number(0.0), number(0.0), None]);
    spec.loading.conditions.push(ConditionSpec {
        set: "top".into(),
        kind: ConditionKind::BodyForce([None, text("-t"), None]),
    });
    spec.run.schedule = Schedule {
        steps: 40,
        time_step: TimeStep::Fixed(1.0),
        force_unstable: false,
        stepper: Stepper::Still,
    };
    followed(&mut spec, Control::ArcLength(0.01), 1e-12);
    let long = 1.09f64.sqrt();
    let load = |down: f64| {
        let now = (1.0 + (0.3 - down) * (0.3 - down)).sqrt();
        2.0 * (1.0 - now / long) * (0.3 - down) / now
    };
    let off = |parts: i32| {
        let arc = 0.01 / f64::from(parts);
        followed(&mut spec, Control::ArcLength(arc), 1e-12);
        let mut sim = build(&spec, Options::default()).unwrap();
        sim.start(true);
        let (mut most, mut least) = (0.0f64, 0.0f64);
        for n in 1..=40 * parts {
            sim.step().unwrap();
            let down = -sim.displacements()[1][1];
            // of three points one goes
            assert!(
                (down - f64::from(n) * arc * 3f64.sqrt()).abs() < 1e-7,
                "{n}: {down}"
            );
            assert!(
                (sim.time() - load(down)).abs() < 1e-10,
                "{n}: {} {}",
                sim.time(),
                load(down)
            );
            (most, least) = (most.max(sim.time()), least.min(sim.time()));
        }
        // up, down to where it hangs as deep as it stood, and up again
        assert!(most > 0.009 && least < -0.009 && sim.time() > 0.009);
        let ledger = sim.ledger().unwrap();
        ledger.residual().abs() / ledger.strain
    };
    // the trapezoidal rule along the way
    let [coarse, fine] = [1, 2].map(off);
    assert!(
        coarse < 1e-2 && (3.8..4.2).contains(&(coarse / fine)),
        "{coarse} {fine}"
    );
}

/// The bar of `sequence` with bonds that soften.
fn slender(opening: f64, increments: u64) -> Spec {
    let mut spec = super::sequence::slender();
    spec.materials = vec![softening(0.01)];
    spec.run.schedule.steps = increments;
    followed(&mut spec, Control::IndirectDisplacement(opening), 1e-9);
    spec
}

/// A notched bar tears in equilibrium, energy is what was dissipated, and the length of increments does not show but in second order.
#[test]
fn a_slender_bar_softens_through() {
    let path = |parts: u64| {
        let mut sim = build(&slender(1e-3 / parts as f64, 1), Options::default()).unwrap();
        sim.start(true);
        let mut curve: Vec<[f64; 2]> = vec![];
        let mut most = 0.0f64;
        while curve.is_empty() || sim.time() > 0.5 * most {
            sim.step().unwrap();
            most = most.max(sim.time());
            let l = sim.ledger().unwrap();
            curve.push([sim.time(), l.dissipated]);
            assert!(curve.len() < 400, "{:?}", curve.last());
        }
        let l = sim.ledger().unwrap();
        println!(
            "{parts}: {} increments, {:?}, broken {}, {l:?}",
            curve.len(),
            curve.last(),
            sim.broken()
        );
        assert!(sim.broken() > 0);
        (curve, l.residual().abs() / l.dissipated)
    };
    let [(coarse, off), (fine, fine_off)] = [1, 2].map(path);
    let peak = |curve: &[[f64; 2]]| curve.iter().map(|c| c[0]).fold(0.0, f64::max);
    println!(
        "peaks {} {}, off {off:e} {fine_off:e}",
        peak(&coarse),
        peak(&fine)
    );
    assert!((peak(&coarse) / peak(&fine) - 1.0).abs() < 0.01);
    assert!(fine_off < off && fine_off < 5e-3, "{off:e} {fine_off:e}");
}

#[test]
fn what_has_no_path_is_refused() {
    let said = |change: &dyn Fn(&mut Spec)| {
        let mut spec = slender(1e-3, 1);
        change(&mut spec);
        build(&spec, Options::default()).err().unwrap()
    };
    let method = said(&|spec| {
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            control: Control::IndirectDisplacement(1e-3),
            ..Statics::default()
        });
    });
    assert_eq!(method.path, "statics.method");
    let solver = said(&|spec| {
        spec.run.schedule.stepper = Stepper::Statics(Statics {
            method: Method::Newton,
            control: Control::IndirectDisplacement(1e-3),
            solver: Solver::ConjugateGradients,
            ..Statics::default()
        });
    });
    assert_eq!(solver.path, "statics.solver");
    let brittle = said(&|spec| spec.materials[0].law = LawSpec::Pmb(PmbStiffness::Young(1.0)));
    assert_eq!(brittle.path, "materials[0].fracture");
    let constant = said(&|spec| {
        let force = ConditionKind::BodyForce([None, number(1e-6), None]);
        spec.loading.conditions.push(ConditionSpec {
            set: "all".into(),
            kind: force,
        });
    });
    assert_eq!(constant.path, "conditions");
    // pressed, no bond opens
    let mut spec = chain(1, 1e-3);
    spec.loading.conditions[1].kind = ConditionKind::Displacement([text("-t"), None, None]);
    let mut sim = build(&spec, Options::default()).unwrap();
    sim.start(true);
    let error = sim.step().unwrap_err().to_string();
    assert!(error.contains("arc_length"), "{error}");
    assert_eq!((sim.step_number(), sim.time()), (0, 0.0));
}
