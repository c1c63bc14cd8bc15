//! Interfaces between bodies that ranks share.

use super::heat::spreading;
use super::{colliding, place, same, torn};
use crate::sample::*;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

fn small(kind: LatticeKind) -> Place {
    let mut place = place(kind);
    match kind.dimension() {
        2 => place.cells = [18, 41, 1],
        // nearest neighbours alone resist no shear
        _ if kind == LatticeKind::Cubic => place.cells = [7, 9, 13],
        _ => (place.ratio, place.cells) = (1, [7, 9, 13]),
    }
    place
}

/// A lattice, another one above it and a cloud beside it, both of them glued to it.
fn glued(case: &Case, fracture: Option<FractureSpec>) -> Spec {
    let mut spec = colliding(case);
    spec.title = format!("{} glued", spec.title);
    let BodySpec::Several(pieces) = &mut spec.body else {
        panic!("several bodies");
    };
    pieces.truncate(3);
    let law = Case::of("pmb", case.place).spec().materials[0].law.clone();
    let glue = |other: &str| InterfaceSpec {
        name: format!("glue of {other}"),
        bodies: ["block".into(), other.into()],
        law: law.clone(),
        horizon: Horizon::Length(2.6 * H),
        influence: Influence::Constant,
        fracture,
    };
    spec.interactions.interfaces = vec![glue("small"), glue("beside")];
    spec.interactions.contact = Some(CONTACT);
    // apart, and to and fro
    let (last, side) = (case.d() - 1, case.place.cells[0] as f64 * H);
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: std::array::from_fn(|a| match a {
            0 => Some(e(&format!("x > {side} ? 0.2 : 0"))),
            _ if a == last => Some(e("0.2*sin(0.9*x)")),
            _ => None,
        }),
    }];
    spec
}

#[test]
fn glued_bodies_are_the_same_on_any_number_of_ranks() {
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Cubic];
    let mut torn = 0;
    for (n, (name, kind, criterion)) in [
        ("pmb", flat, Criterion::Stretch(0.01)),
        ("lps", flat, Criterion::BondEnergy(1e-5)),
        ("pmb mixed", solid, Criterion::Stretch(0.01)),
        ("elastic-plastic", solid, Criterion::Stretch(0.01)),
        ("lps", LatticeKind::Bcc, Criterion::BondEnergy(1e-5)),
    ]
    .into_iter()
    .enumerate()
    {
        let case = Case::of(name, small(kind));
        let glue = FractureSpec {
            rate: (n == 2).then_some(RateSpec {
                coefficient: 0.1,
                reference: 1e-3,
            }),
            ..FractureSpec::new(criterion)
        };
        let mut spec = glued(&case, Some(glue));
        if n % 2 == 0 {
            spec.interactions.contact = None;
        }
        if n == 3 {
            // what comes apart heals
            spec.damage.healing = Some(HealingSpec {
                set: "all".into(),
                below: e("0.015"),
            });
            spec.materials[0].fracture = None;
        }
        if n == 0 {
            spec.bonds.factors = vec![BondFactorSpec::Field(e("1 + 0.1*sin(x + 2*y)"))];
        }
        torn += u32::from(same(&spec, &[2, 3 + n % 2]));
    }
    assert!(torn >= 4, "{torn}");
}

#[test]
fn heat_crosses_glue_on_any_number_of_ranks() {
    let case = Case::of("pmb", small(LatticeKind::Square));
    let mut spec = glued(&case, Some(FractureSpec::new(Criterion::Stretch(0.01))));
    let set = |name: &str, text: &str| SetSpec {
        name: name.into(),
        members: Members::Where(e(text)),
    };
    spec.sets.extend([
        set("low", "y < 1.1"),
        set("high", "y > 20.5"),
        set("middle", "abs(y - 10) < 3"),
    ]);
    let mut heat = spreading(
        Quantity::Heat,
        DiffusionMethod::Explicit { safety: 0.5 },
        0.02,
    );
    for c in &mut heat.conditions {
        if let DiffusionKind::Exchange { area, .. } = &mut c.kind {
            *area = Some(3.0);
        }
    }
    spec.interactions.diffusions = vec![heat];
    same(&spec, &[3]);
}

/// The foot of the lower of two bodies is held, and the head of the upper one goes along the first axis and the last one.
pub(super) fn moved(spec: &mut Spec, case: &Case, along: &str, up: &str) {
    let (d, last) = (case.d(), case.d() - 1);
    let axis = ["x", "y", "z"][last];
    let top = case.place.cells[last] as f64 * H;
    let set = |name: &str, text: String| SetSpec {
        name: name.into(),
        members: Members::Where(e(&text)),
    };
    spec.sets.extend([
        set("foot", format!("{axis} < {}", 1.6 * H)),
        set("head", format!("{axis} > {}", top + 3.5 * H)),
    ]);
    let to = |set: &str, along: &str, up: &str| ConditionSpec {
        set: set.into(),
        kind: ConditionKind::Displacement(std::array::from_fn(|a| match a {
            _ if a == last => Some(e(up)),
            0 => Some(e(along)),
            _ if a < d => Some(e("0")),
            _ => None,
        })),
    };
    spec.loading.conditions = vec![to("foot", "0", "0"), to("head", along, up)];
}

/// Drawn apart, or turned in steps that begin from rest.
fn drawn(case: &Case, stepper: Stepper, fracture: Option<FractureSpec>) -> Spec {
    let mut spec = glued(case, fracture);
    spec.title = format!("{} {stepper:?}", spec.title);
    for material in &mut spec.materials {
        material.fracture = None;
    }
    let BodySpec::Several(pieces) = &mut spec.body else {
        panic!("several bodies");
    };
    pieces.truncate(2);
    spec.interactions.interfaces.truncate(1);
    spec.interactions.contact = None;
    spec.loading.initial.clear();
    let statics = matches!(stepper, Stepper::Statics(_));
    let cycles = matches!(
        stepper,
        Stepper::Statics(Statics {
            cycles: Some(_),
            ..
        })
    );
    let up = match cycles {
        true => "0.02",
        false if statics => "0.05*t",
        false => "0.1*t",
    };
    moved(&mut spec, case, "0", up);
    spec.run.schedule = Schedule {
        steps: 2,
        time_step: TimeStep::Fixed(0.5),
        force_unstable: false,
        stepper,
    };
    spec
}

#[test]
fn glued_bodies_have_the_same_equilibria_on_any_number_of_ranks() {
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Cubic];
    let statics = |method| Statics {
        method,
        timed: method != Method::Linear,
        tolerance: if method == Method::Linear {
            1e-10
        } else {
            1e-5
        },
        ..Statics::default()
    };
    let control = Statics {
        control: Control::SequentiallyLinear,
        timed: false,
        ..statics(Method::Linear)
    };
    let cycles = Statics {
        timed: false,
        cycles: Some(Cycles {
            load_ratio: 0.1,
            bonds: 2,
            most: f64::INFINITY,
        }),
        ..statics(Method::Newton)
    };
    let stretch = |s: f64| FractureSpec::new(Criterion::Stretch(s));
    let worn = FractureSpec {
        fatigue: Some(FatigueSpec {
            nucleation: Some([1e3, 3.0]),
            limit: 0.0,
            growth: Some([1e6, 3.0]),
            crack: 0.3,
        }),
        ..stretch(0.2)
    };
    let by_work = FractureSpec::new(Criterion::BondEnergy(1e-6));
    let mut torn = vec![];
    for (n, (name, kind, stepper, fracture)) in [
        (
            "lps",
            flat,
            Stepper::Statics(statics(Method::Linear)),
            stretch(0.005),
        ),
        (
            "pmb",
            flat,
            Stepper::Statics(statics(Method::Newton)),
            stretch(0.005),
        ),
        (
            "pmb",
            solid,
            Stepper::Statics(statics(Method::Relaxation)),
            stretch(0.005),
        ),
        ("pmb", flat, Stepper::Statics(control), stretch(0.005)),
        ("lps", flat, Stepper::Statics(control), by_work),
        ("pmb", flat, Stepper::Statics(cycles), worn),
        (
            "lps",
            flat,
            Stepper::Newmark(Newmark::hht(-0.1)),
            stretch(0.005),
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let case = Case::of(name, small(kind));
        let spec = drawn(&case, stepper, Some(fracture));
        torn.push(same(&spec, &[2 + n % 2]));
    }
    assert_eq!(torn, [true; 7]);
}

/// What pairs of materials have instead of what follows from the two.
#[test]
fn constants_of_pairs_are_those_of_the_whole_body() {
    for (n, kind) in [LatticeKind::Square, LatticeKind::Cubic]
        .into_iter()
        .enumerate()
    {
        let case = Case::of("pmb", place(kind));
        let mut spec = torn(&case, n == 0);
        spec.title = format!("{} of pairs", spec.title);
        spec.bonds.family = FamilyChoice::List;
        for (name, which) in [("left", "x < 3.1"), ("right", "x > 3.1")] {
            spec.sets.push(SetSpec {
                name: name.into(),
                members: Members::Where(e(which)),
            });
        }
        spec.materials = ["left", "right"]
            .map(|name| MaterialSpec {
                name: name.into(),
                set: name.into(),
                ..spec.materials[0].clone()
            })
            .into();
        let pairs = [0.03, 0.02, 0.02, 0.07].map(|c| PairSpec {
            horizon: 2.0 * H,
            law: LawSpec::Pmb(PmbStiffness::Micromodulus(c)),
            critical_stretch: 0.001,
            alpha: 0.25,
        });
        spec.interactions.pairs = pairs.into();
        assert!(same(&spec, &[2, 3]));
    }
}
