//! Flow in a body that conducts heat: there is one temperature, by which it softens and which its plastic work raises.

use crate::sample::*;
use peridyne::observe::Values;
use peridyne::run::{Options, Simulation, build};
use peridyne::spec::*;

// copper of Johnson & Cook (1983)
const YOUNG: f64 = 124e9;
const POISSON: f64 = 0.34;
const DENSITY: f64 = 8960.0;
const YIELD: f64 = 90e6;
const HARDENING: f64 = 292e6;
const EXPONENT: f64 = 0.31;
const SENSITIVITY: f64 = 0.025;
const COLD: f64 = 298.0;
const MELTS: f64 = 1356.0;
const THERMAL: f64 = 1.09;
/// Hundred times warmer by the same work than copper.
const CAPACITY: f64 = 3.83;
/// Length of a step, and cell.
const DT: f64 = 1e-6;
const H: f64 = 1e-3;

fn copper(gradient: &str, capacity: Option<f64>) -> LawSpec {
    let mut all = Parameters::numbers(&[
        ("young", YOUNG),
        ("poisson", POISSON),
        ("yield_stress", YIELD),
        ("hardening", HARDENING),
        ("exponent", EXPONENT),
        ("rate_sensitivity", SENSITIVITY),
        ("reference_rate", 1.0),
        ("reference_temperature", COLD),
        ("melting_temperature", MELTS),
        ("thermal_exponent", THERMAL),
    ]);
    for (key, word) in [
        ("hardening_law", "ludwik"),
        ("rate_law", "johnson_cook"),
        ("gradient", gradient),
    ] {
        all.set(key, Parameter::Word(word.into()));
    }
    if let Some(c) = capacity {
        all.set("heat_capacity", Parameter::Number(c));
    }
    LawSpec::named("hypoelastic_plastic", all)
}

/// Heat at a temperature at first.
fn warm(method: DiffusionMethod, conductivity: f64, at: &str) -> DiffusionSpec {
    let mut heat = heat(method);
    heat.reference = COLD;
    heat.materials[0].conductivity = conductivity;
    heat.materials[0].capacity = CAPACITY;
    heat.initial = vec![("all".into(), text(at))];
    heat
}

/// A bar, whose ends are held and pulled so that it is a hundredth longer after six steps.
fn bar(law: LawSpec, stepper: Stepper, heat: Option<DiffusionSpec>) -> Spec {
    let body = cells(3, H, [0.0; 3], [7.0 * H, 3.0 * H, 3.0 * H]);
    let mut spec = Spec::new(3, body, DENSITY, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    spec.sets = vec![beyond("left", 2.0 * H, -1.0), beyond("right", 5.0 * H, 1.0)];
    let held = |set: &str, x: String| ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement([Some(text(&x)), Some(text("0")), Some(text("0"))]),
    };
    spec.loading.conditions = vec![
        held("left", "0".into()),
        held("right", format!("{:e}*t", 0.01 * 7.0 * H / (6.0 * DT))),
    ];
    timed(spec, stepper, heat)
}

/// A block of which every point is told its strain: what F sees is all.
fn told(law: LawSpec, stepper: Stepper, heat: Option<DiffusionSpec>) -> Spec {
    let body = cells(3, H, [0.0; 3], [4.0 * H; 3]);
    let mut spec = Spec::new(3, body, DENSITY, law);
    spec.bonds.horizon = Horizon::Ratio(2);
    let rate = 1e-3 / DT;
    let along = |e: String| Some(text(&e));
    spec.loading.conditions = vec![ConditionSpec {
        set: "all".into(),
        kind: ConditionKind::Displacement([
            along(format!("x*{rate:e}*t")),
            along(format!("-0.5*y*{rate:e}*t")),
            along(format!("-0.5*z*{rate:e}*t")),
        ]),
    }];
    timed(spec, stepper, heat)
}

fn timed(mut spec: Spec, stepper: Stepper, heat: Option<DiffusionSpec>) -> Spec {
    spec.run.schedule.stepper = stepper;
    let parts = if stepper == Stepper::Verlet {
        10.0
    } else {
        1.0
    };
    spec.run.schedule.time_step = TimeStep::Fixed(DT / parts);
    spec.interactions.diffusions.extend(heat);
    spec
}

const NEWMARK: fn() -> Stepper = || Stepper::Newmark(Newmark::default());
const STATICS: fn() -> Stepper = || {
    Stepper::Statics(Statics {
        method: Method::Newton,
        timed: true,
        ..Statics::default()
    })
};
const EXPLICITLY: fn() -> Stepper = || Stepper::Verlet;

/// √(3/2 s:s) of the deviator of every point.
fn mises(sim: &mut dyn Simulation) -> Vec<f64> {
    let Values::Tensors(stress) = sim.column("unrotated_stress").unwrap().values else {
        panic!("no tensors")
    };
    let mean = scalars(sim, "mean_stress");
    let each = stress.iter().zip(&mean);
    each.map(|(s, p)| {
        let square: f64 = (0..9)
            .map(|n| (s[n] - if n % 4 == 0 { *p } else { 0.0 }).powi(2))
            .sum();
        (1.5 * square).sqrt()
    })
    .collect()
}

/// `1 − T*ᵐ`
fn soft(t: f64) -> f64 {
    1.0 - ((t - COLD) / (MELTS - COLD)).clamp(0.0, 1.0).powf(THERMAL)
}

/// Steps, and of the last one at every point that flowed in it: the stress, that of Johnson and Cook at the temperature of its start, and where.
fn flown(sim: &mut dyn Simulation, steps: u64, dt: f64) -> Vec<(usize, f64, f64)> {
    run(sim, steps - 1);
    let (before, t) = (scalars(sim, "plastic_strain"), temperature(sim));
    run(sim, 1);
    let (now, q) = (scalars(sim, "plastic_strain"), mises(sim));
    let mut all = vec![];
    for i in 0..q.len() {
        let more = now[i] - before[i];
        if more > 1e-6 {
            let rate = 1.0 + SENSITIVITY * (more / dt).max(1.0).ln();
            let of = (YIELD + HARDENING * now[i].powf(EXPONENT)) * rate * soft(t[i]);
            all.push((i, q[i], of));
        }
    }
    all
}

/// σ = (A + B ε̄ⁿ) (1 + C ln ε̄̇/ε̇₀) (1 − T*ᵐ) at each point that flows, to what the search for ε̄ leaves: 3μ Δε̄ · 1e-14 of 5 MPa is 1e-12.
#[test]
fn the_flow_stress_is_that_of_the_temperature_of_the_body() {
    for (t, factor) in [
        (298.0, 1.0),
        (1000.0, 0.36053309274722734),
        (1300.0, 0.05755407993070383),
    ] {
        assert!((soft(t) - factor).abs() < 1e-14);
    }
    let cases: [(fn() -> Stepper, &[&str]); 3] = [
        (
            EXPLICITLY,
            &["298", "1000", "1300", "x < 0.0035 ? 298 : 1300"],
        ),
        (NEWMARK, &["1000", "y < 0.0015 ? 500 : 1200"]),
        (STATICS, &["1000"]),
    ];
    for (stepper, all) in cases {
        for at in all {
            for method in [EXPLICIT, EULER] {
                let heat = Some(warm(method, 0.0, at));
                let spec = bar(copper("family", None), stepper(), heat);
                let TimeStep::Fixed(dt) = spec.run.schedule.time_step else {
                    unreachable!()
                };
                let mut sim = built(&spec);
                let steps = (4.0 * DT / dt).round() as u64;
                let found = flown(&mut *sim, steps, dt);
                assert!(found.len() > 5, "{at}: {}", found.len());
                for (i, q, of) in found {
                    assert!(
                        (q / of - 1.0).abs() < 1e-10,
                        "{at}, point {i}: {q:e} {of:e}"
                    );
                }
            }
        }
    }
}

/// So it is bond by bond; and who holds the temperature holds the strength, whatever flow heats.
#[test]
fn who_holds_the_temperature_holds_the_strength() {
    for gradient in ["family", "bond"] {
        for stepper in [EXPLICITLY, NEWMARK] {
            for capacity in [None, Some(CAPACITY)] {
                let mut heat = warm(EXPLICIT, 1.0, "298");
                heat.conditions = vec![on("all", DiffusionKind::Value(text("1000")))];
                let spec = told(copper(gradient, capacity), stepper(), Some(heat));
                let TimeStep::Fixed(dt) = spec.run.schedule.time_step else {
                    unreachable!()
                };
                let mut sim = built(&spec);
                let steps = (5.0 * DT / dt).round() as u64;
                let found = flown(&mut *sim, steps, dt);
                assert_eq!(found.len(), 64, "{gradient}");
                for (_, q, of) in found {
                    assert!((q / of - 1.0).abs() < 1e-10, "{gradient}: {q:e} {of:e}");
                }
                assert!(temperature(&mut *sim).iter().all(|t| *t == 1000.0));
            }
        }
    }
}

/// At the melting temperature nothing is left of the deviator but the round-off of a trial of 2μ Δε; pressure stays.
#[test]
fn what_is_molten_bears_no_shear() {
    let trial = YOUNG / (1.0 + POISSON) * 1e-3;
    for gradient in ["family", "bond"] {
        for stepper in [EXPLICITLY, NEWMARK] {
            for t in ["1356", "1700"] {
                let heat = Some(warm(EXPLICIT, 0.0, t));
                let mut sim = built(&told(copper(gradient, None), stepper(), heat));
                run(&mut *sim, 5);
                let most = mises(&mut *sim).into_iter().fold(0.0, f64::max);
                assert!(most < 1e-12 * trial, "{gradient} {t}: {most:e}");
            }
        }
    }
}

/// Adds `T_r` to the temperature rise of a run without [heat].
fn adiabatic(spec: &Spec, steps: u64) -> [Vec<f64>; 3] {
    let mut alone = spec.clone();
    alone.interactions.diffusions.clear();
    let mut sim = built(&alone);
    run(&mut *sim, steps);
    let t = scalars(&mut *sim, "temperature_rise");
    let t = t.iter().map(|rise| COLD + rise).collect();
    [t, scalars(&mut *sim, "plastic_strain"), mises(&mut *sim)]
}

/// Where nothing is conducted a body heats as each point would alone. Explicit steps differ by the round-off of T, 6e-14 of a rise of tens of kelvins
/// a step; implicit ones and equilibria by what their solver leaves, 1e-10 of the forces, which shifts small strains by more.
#[test]
fn without_conduction_flow_is_adiabatic() {
    let cases: [(fn() -> Stepper, f64); 3] =
        [(EXPLICITLY, 1e-10), (NEWMARK, 1e-7), (STATICS, 1e-7)];
    for (stepper, bound) in cases {
        for method in [EXPLICIT, EULER] {
            let heat = Some(warm(method, 0.0, "298"));
            let spec = bar(copper("family", Some(CAPACITY)), stepper(), heat);
            let steps = if stepper() == Stepper::Verlet { 60 } else { 5 };
            let [t, strain, q] = adiabatic(&spec, steps);
            let mut sim = built(&spec);
            run(&mut *sim, steps);
            let found = [
                temperature(&mut *sim),
                scalars(&mut *sim, "plastic_strain"),
                mises(&mut *sim),
            ];
            let rise = t.iter().fold(0.0f64, |m, t| m.max(t - COLD));
            assert!(rise > 5.0, "{rise}");
            let scales = [
                rise,
                strain.iter().fold(0.0f64, |m, x| m.max(*x)),
                q.iter().fold(0.0f64, |m, x| m.max(*x)),
            ];
            for ((found, alone), scale) in found.iter().zip([&t, &strain, &q]).zip(scales) {
                for (a, b) in found.iter().zip(alone) {
                    assert!((a - b).abs() < bound * scale, "{method:?}: {a:e} {b:e}");
                }
            }
        }
    }
}

/// The same bond by bond, of bonds that are all deformed alike.
#[test]
fn bonds_share_the_temperature_of_their_point() {
    let heat = Some(warm(EXPLICIT, 0.0, "298"));
    let spec = told(copper("bond", Some(CAPACITY)), Stepper::Verlet, heat);
    let [t, strain, q] = adiabatic(&spec, 60);
    let mut sim = built(&spec);
    run(&mut *sim, 60);
    let found = [
        temperature(&mut *sim),
        scalars(&mut *sim, "plastic_strain"),
        mises(&mut *sim),
    ];
    assert!(t[0] - COLD > 5.0, "{}", t[0]);
    for (found, alone) in found.iter().zip([&t, &strain, &q]) {
        for (a, b) in found.iter().zip(alone) {
            // the round-off of means over bonds
            assert!((a / b - 1.0).abs() < 1e-10, "{a:e} {b:e}");
        }
    }
}

/// What plastic work heats is conducted away, and every part of it once: the heat made is β times the plastic work of all points, and the account of heat
/// closes, both to round-off. What the motion dissipates is that work and what the control lost.
#[test]
fn the_heat_of_flow_is_conducted_and_counted_once() {
    const PART: f64 = 0.9;
    for method in [EXPLICIT, EULER] {
        let heat = Some(warm(method, 3e5, "298"));
        let spec = bar(copper("family", Some(CAPACITY)), Stepper::Verlet, heat);
        let [alone, ..] = adiabatic(&spec, 60);
        let mut sim = built(&spec);
        run(&mut *sim, 60);
        let volume = H * H * H;
        let sum = |x: Vec<f64>| volume * x.iter().sum::<f64>();
        let work = sum(scalars(&mut *sim, "plastic_work"));
        let lost = sum(scalars(&mut *sim, "control_loss"));
        let account = sim.diffusions()[0].1;
        assert!(work > 0.0);
        assert!(
            (account.made / (PART * work) - 1.0).abs() < 1e-10,
            "{account:?} {work:e}"
        );
        assert!(
            account.residual().abs() < 1e-12 * account.content,
            "{account:?}"
        );
        let ledger = sim.ledger().unwrap();
        let all = work + lost;
        assert!(
            (ledger.dissipated / all - 1.0).abs() < 1e-10,
            "{ledger:?} {all:e}"
        );
        // to second order in the step, as without heat
        assert!(
            ledger.residual().abs() < 1e-3 * ledger.work_boundary_conditions,
            "{ledger:?}"
        );
        let spread = |t: &[f64]| {
            let most = t.iter().fold(f64::NEG_INFINITY, |m, t| m.max(*t));
            most - t.iter().fold(f64::INFINITY, |m, t| m.min(*t))
        };
        let t = temperature(&mut *sim);
        assert!(
            spread(&t) < 0.5 * spread(&alone),
            "{} {}",
            spread(&t),
            spread(&alone)
        );
    }
}

/// Bodies side by side have their own laws: one melts, the other has no temperature.
#[test]
fn bodies_have_their_own_temperatures() {
    let block = |low: f64| {
        let mut body = cells(3, H, [low, 0.0, 0.0], [low + 4.0 * H, 4.0 * H, 4.0 * H]);
        if let BodySpec::Lattice { origin, .. } = &mut body {
            *origin = [low + 0.5 * H, 0.5 * H, 0.5 * H];
        }
        body
    };
    let heat = Some(warm(EXPLICIT, 0.0, "x < 0.01 ? 1000 : 700"));
    let mut spec = told(copper("family", None), Stepper::Verlet, heat);
    spec.body = BodySpec::Several(vec![
        PieceSpec::new("melts", block(0.0)),
        PieceSpec::new("stays", block(20.0 * H)),
    ]);
    let within = |name: &str| SetSpec {
        name: name.into(),
        members: Members::Within {
            body: name.into(),
            members: Box::new(Members::All),
        },
    };
    spec.sets = vec![within("melts"), within("stays")];
    let elastic = Parameters::numbers(&[("young", YOUNG), ("poisson", POISSON)]);
    spec.materials[0].set = "melts".into();
    spec.materials.push(MaterialSpec {
        name: "stays".into(),
        set: "stays".into(),
        law: LawSpec::named("correspondence", elastic),
        ..spec.materials[0].clone()
    });
    let own = spec.interactions.diffusions[0].materials[0];
    spec.interactions.diffusions[0].materials.push(own);
    let mut sim = built(&spec);
    let found = flown(&mut *sim, 50, 0.1 * DT);
    assert_eq!(found.len(), 64);
    for (i, q, of) in found {
        assert!((q / of - 1.0).abs() < 1e-10, "point {i}: {q:e} {of:e}");
    }
}

/// Two heat capacities of one material, heat that nothing keeps, and a pressure that would have it twice.
#[test]
fn heat_of_flow_that_cannot_be_is_refused() {
    let said = |law: LawSpec, heat: DiffusionSpec| {
        let spec = bar(law, Stepper::Verlet, Some(heat));
        let refused = build(&spec, Options::default()).err().unwrap();
        assert_eq!(refused.path, "materials[0].law", "{}", refused.message);
        refused.message.to_string()
    };
    let cold = || warm(EXPLICIT, 1.0, "298");
    let message = said(copper("family", Some(2.0 * CAPACITY)), cold());
    assert!(message.contains("two heat capacities"), "{message}");
    let mut steady = warm(STEADY, 1.0, "298");
    steady.conditions = vec![on("left", DiffusionKind::Value(text("298")))];
    let message = said(copper("family", Some(CAPACITY)), steady);
    assert!(message.contains("steady"), "{message}");
    let mut pressed = copper("family", Some(CAPACITY));
    if let LawSpec::Named(law) = &mut pressed {
        let word = Parameter::Word("mie_gruneisen".into());
        law.parameters.set("equation_of_state", word);
        for (key, x) in [("hugoniot_slope", 1.5), ("gruneisen", 2.0)] {
            law.parameters.set(key, Parameter::Number(x));
        }
    }
    let mut expands = cold();
    expands.materials[0].expansion = 1e-5;
    let message = said(pressed, expands);
    assert!(message.contains("equation of state"), "{message}");
    // written in other units it is the same
    let mut close = cold();
    close.materials[0].capacity *= 1.0 + 1e-15;
    built(&bar(
        copper("family", Some(CAPACITY)),
        Stepper::Verlet,
        Some(close),
    ));
}
