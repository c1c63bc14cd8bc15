//! Probes against equilibrium and Newton's law.

use crate::sample::*;
use peridyne::run::{Options, Simulation, build};
use peridyne::space::Point;
use peridyne::spec::*;

fn over(fold: Fold, of: &str, part: Part) -> Measure {
    Measure::Over {
        fold,
        of: of.into(),
        part,
    }
}

/// A cantilever under forces along it and across: its support takes up force and moment.
#[test]
fn the_reaction_of_a_support_is_the_load() {
    for (d, law, method) in [
        (1, PMB, Method::Linear),
        (2, PMB, Method::Linear),
        (2, LPS, Method::Newton),
        (3, PMB, Method::Newton),
        (2, PMB, Method::Relaxation),
    ] {
        let mut spec = block([11, 5, 4], d, 0.5, law.clone());
        statics(&mut spec, method);
        if let Stepper::Statics(s) = &mut spec.run.schedule.stepper {
            s.tolerance = 1e-10;
        }
        hold(&mut spec, "low", [text("0"), text("0"), text("0")]);
        // weak: the arms of moments change little
        push(
            &mut spec,
            "high",
            [text("3e-5*t"), text("-2e-5*t"), text("1e-5*t")],
        );
        probe(&mut spec, "support", "low", Measure::Reaction);
        probe(&mut spec, "load", "high", Measure::Reaction);
        if d > 1 {
            probe(
                &mut spec,
                "turning",
                "low",
                Measure::Moment {
                    about: [0.2, 0.7, -0.3],
                },
            );
        }
        let mut sim = run(&spec);
        let (volume, x, u) = (
            sim.scalars("volume"),
            sim.vectors("reference"),
            sim.displacements(),
        );
        let loaded = sim.members("high").unwrap();
        let force = |i: u32, a: usize| [3e-5, -2e-5, 1e-5][a] * volume[i as usize];
        let size: f64 = loaded.iter().map(|i| force(*i, 0)).sum();
        for a in 0..d {
            let load: f64 = loaded.iter().map(|i| force(*i, a)).sum();
            let axis = ["x", "y", "z"][a];
            let support = shown(sim.as_mut(), &format!("support_{axis}"));
            assert!(
                (support + load).abs() < 1e-7 * size,
                "{d}-D {method:?}: {support} {load}"
            );
            assert_eq!(shown(sim.as_mut(), &format!("load_{axis}")), 0.0);
        }
        let bent = method != Method::Linear;
        for (axis, [a, b]) in [("x", [1, 2]), ("y", [2, 0]), ("z", [0, 1])] {
            if a >= d || b >= d {
                continue;
            }
            let arm = |i: u32, c: usize| {
                let moved = if bent { u[i as usize][c] } else { 0.0 };
                x[i as usize][c] + moved - [0.2, 0.7, -0.3][c]
            };
            let moment: f64 = loaded
                .iter()
                .map(|i| arm(*i, a) * force(*i, b) - arm(*i, b) * force(*i, a))
                .sum();
            let turning = shown(sim.as_mut(), &format!("turning_{axis}"));
            assert!(
                (turning + moment).abs() < 1e-6 * size,
                "{d}-D {method:?} {axis}: {turning} {moment}"
            );
        }
    }
}

/// What constraints exert is what the momentum of the body changes by, to the last digits.
#[test]
fn in_motion_reactions_change_the_momentum() {
    for kind in ["displacement", "velocity"] {
        for law in [PMB, LPS] {
            let mut spec = block([11, 5, 0], 2, 0.5, law.clone());
            spec.run.schedule.time_step = TimeStep::Fraction(0.5);
            let way = [text("0.02*sin(3*t)+0.01*t"), text("0.01*t*t"), None];
            let kind = match kind {
                "displacement" => ConditionKind::Displacement(way),
                _ => ConditionKind::Velocity(way),
            };
            spec.loading.conditions.push(ConditionSpec {
                set: "low".into(),
                kind,
            });
            // held twice is held once
            hold(&mut spec, "high", [text("0"), None, None]);
            hold(&mut spec, "high", [text("0"), text("0"), None]);
            probe(&mut spec, "all", "all", Measure::Reaction);
            let mut sim = made(&spec);
            let dt = sim.info().time_step;
            let mass: Vec<f64> = {
                let (v, rho) = (sim.scalars("volume"), sim.scalars("density"));
                v.iter().zip(rho).map(|(v, rho)| v * rho).collect()
            };
            // of the middle of the step between two states
            let momentum = |from: &[Point], to: &[Point]| -> Point {
                let way = |i: usize, a: usize| mass[i] * (to[i][a] - from[i][a]) / dt;
                std::array::from_fn(|a| (0..mass.len()).map(|i| way(i, a)).sum())
            };
            let mut reaction: Vec<f64> = vec![];
            let mut before: Option<Point> = None;
            let mut u = sim.displacements();
            for step in 0..12 {
                sim.step().unwrap();
                let now = sim.displacements();
                let after = momentum(&u, &now);
                if let Some(before) = before.replace(after) {
                    for a in 0..2 {
                        let (given, gained) = (dt * reaction[a], after[a] - before[a]);
                        let off = (given - gained).abs();
                        assert!(off < 1e-12, "{law:?} step {step}: {given:e} {gained:e}");
                    }
                }
                (u, reaction) = (now, sim.measure());
            }
            assert!(reaction.iter().all(|r| r.abs() > 1e-4), "{reaction:?}");
        }
    }
}

/// A load–displacement curve of a linear bar is straight, and the area below it is the work.
#[test]
fn a_load_displacement_curve_holds_the_work() {
    let mut spec = block([20, 6, 0], 2, 0.5, LPS);
    statics(&mut spec, Method::Linear);
    spec.run.schedule.steps = 5;
    spec.run.schedule.time_step = TimeStep::Fixed(0.2);
    hold(&mut spec, "low", [text("0"), text("0"), None]);
    hold(&mut spec, "high", [text("0.05*t"), None, None]);
    probe(&mut spec, "pull", "high", Measure::Reaction);
    probe(
        &mut spec,
        "end",
        "high",
        over(Fold::Mean, "displacement", Part::Component("x".into())),
    );
    probe(&mut spec, "body", "all", Measure::Energy);
    let mut sim = made(&spec);
    let (mut work, mut last) = (0.0, [0.0; 2]);
    let mut stiffness = vec![];
    for _ in 0..5 {
        sim.step().unwrap();
        let now = [shown(sim.as_mut(), "pull_x"), shown(sim.as_mut(), "end_x")];
        work += 0.5 * (now[0] + last[0]) * (now[1] - last[1]);
        stiffness.push(now[0] / now[1]);
        last = now;
    }
    assert!((last[1] - 0.05).abs() < 1e-15);
    let energy = shown(sim.as_mut(), "body_strain");
    assert!((work - energy).abs() < 1e-9 * work, "{work} {energy}");
    assert!((sim.ledger().unwrap().strain - energy).abs() < 1e-12 * energy);
    assert!(
        stiffness
            .iter()
            .all(|k| (k / stiffness[0] - 1.0).abs() < 1e-9)
    );
    assert!(stiffness[0] > 0.0);
}

#[test]
fn folds_are_those_of_the_column() {
    let mut spec = block([9, 5, 0], 2, 0.5, PMB);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    for (name, fold) in [
        ("mean", Fold::Mean),
        ("least", Fold::Min),
        ("most", Fold::Max),
        ("sum", Fold::Sum),
    ] {
        probe(
            &mut spec,
            name,
            "high",
            over(fold, "displacement", Part::All),
        );
        probe(
            &mut spec,
            &format!("{name} size"),
            "high",
            over(fold, "displacement", Part::Magnitude),
        );
    }
    let at = [2.1, 1.4, 7.0];
    let value = Measure::Value {
        at,
        of: "strain".into(),
        part: Part::Component("xy".into()),
    };
    probe(&mut spec, "point", "all", value);
    probe(
        &mut spec,
        "damaged",
        "all",
        over(Fold::Sum, "damage", Part::All),
    );
    let mut sim = made(&spec);
    let x = sim.vectors("reference");
    let u: Vec<Point> = x
        .iter()
        .map(|x| [0.01 * x[1] * x[1] - 0.02, 0.03 * x[0] + x[1] * 0.01, 0.0])
        .collect();
    sim.set_displacements(&u);
    let high = sim.members("high").unwrap();
    let values = |of: &dyn Fn(Point) -> f64| -> Vec<f64> {
        high.iter().map(|i| of(u[*i as usize])).collect()
    };
    let same = |sim: &mut dyn Simulation, suffix: &str, v: Vec<f64>| {
        let (sum, n) = (v.iter().sum::<f64>(), v.len() as f64);
        for (name, wanted) in [
            ("mean", sum / n),
            ("least", v.iter().copied().fold(f64::INFINITY, f64::min)),
            ("most", v.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
            ("sum", sum),
        ] {
            let got = shown(sim, &format!("{name}{suffix}"));
            assert!(
                (got - wanted).abs() < 1e-15,
                "{name}{suffix}: {got} {wanted}"
            );
        }
    };
    same(sim.as_mut(), "_x", values(&|u| u[0]));
    same(sim.as_mut(), "_y", values(&|u| u[1]));
    same(
        sim.as_mut(),
        " size_magnitude",
        values(&|u| (u[0] * u[0] + u[1] * u[1]).sqrt()),
    );
    // the nearest point is (2, 1.5)
    let point = x.iter().position(|x| *x == [2.0, 1.5, 0.0]).unwrap();
    let wanted = sim.column("strain").unwrap().values.at(point, 3);
    assert_eq!(shown(sim.as_mut(), "point_xy"), wanted);
    assert_eq!(shown(sim.as_mut(), "damaged"), 0.0);
}

#[test]
fn probes_of_what_is_not_there_are_refused() {
    let part = |name: &str| Part::Component(name.into());
    let j_integral = |low, high| {
        Measure::JIntegral(JIntegralSpec {
            low,
            high,
            direction: [1.0, 0.0],
        })
    };
    for (set, measure, path, message) in [
        (
            "hgh",
            Measure::Reaction,
            "probes[1].set",
            "there is no set `hgh`",
        ),
        (
            "all",
            over(Fold::Mean, "strian", Part::All),
            "probes[1].of",
            "unknown field `strian`",
        ),
        (
            "all",
            over(Fold::Mean, "stress", part("yx")),
            "probes[1].component",
            "no component `yx`",
        ),
        (
            "all",
            over(Fold::Mean, "stress", part("zz")),
            "probes[1].component",
            "no component `zz`",
        ),
        (
            "all",
            over(Fold::Mean, "damage", part("x")),
            "probes[1].component",
            "no component `x`",
        ),
        (
            "all",
            j_integral([1.0, 1.0], [2.0, 2.0]),
            "probes[1]",
            "needs equilibrium",
        ),
        (
            "low",
            Measure::Reaction,
            "probes[1].name",
            "two probes write the column `first_x`",
        ),
    ] {
        let mut spec = block([9, 5, 0], 2, 0.5, PMB);
        probe(&mut spec, "first", "all", Measure::Reaction);
        let name = if set == "low" { "first" } else { "second" };
        probe(&mut spec, name, set, measure);
        let Err(error) = build(&spec, Options::default()) else {
            panic!("{message}")
        };
        assert_eq!(error.path, path);
        assert!(error.message.contains(message), "{}", error.message);
    }
}
