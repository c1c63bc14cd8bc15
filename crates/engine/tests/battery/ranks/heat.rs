//! Heat and species on ranks.

use super::{place, same, scattered, torn};
use crate::sample::*;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

pub(super) fn spreading(
    quantity: Quantity,
    method: DiffusionMethod,
    expansion: f64,
) -> DiffusionSpec {
    let on = |set: &str, kind: DiffusionKind| DiffusionCondition {
        set: set.into(),
        kind,
    };
    let mut conditions = vec![
        on("low", DiffusionKind::Value(e("1 + 0.2*sin(30*t)"))),
        on(
            "high",
            DiffusionKind::Exchange {
                law: Exchange::Convection {
                    coefficient: e("0.7 + 0.1*x"),
                    ambient: e("0.2 + t"),
                },
                area: None,
            },
        ),
        on(
            "middle",
            DiffusionKind::Flux {
                value: e("0.3"),
                area: Some(2.0),
            },
        ),
        on("all", DiffusionKind::Source(e("0.1*sin(x)*cos(40*t)"))),
    ];
    if quantity == Quantity::Heat {
        let law = Exchange::Radiation {
            coefficient: e("0.01"),
            ambient: e("2"),
        };
        conditions.push(on(
            "high",
            DiffusionKind::Exchange {
                law,
                area: Some(1.5),
            },
        ));
    }
    DiffusionSpec {
        quantity,
        method,
        reference: 0.5,
        across_broken: quantity == Quantity::Species,
        deformation: false,
        materials: vec![DiffusionMaterial {
            conductivity: 1.3,
            capacity: 0.7,
            expansion,
        }],
        initial: vec![("all".into(), e("1 + 0.3*sin(2*x)"))],
        conditions,
    }
}

/// Sets of the faces across the last axis, and of what lies about the middle.
pub(super) fn faced(spec: &mut Spec, case: &Case) {
    let last = case.d() - 1;
    let axis = ["x", "y", "z"][last];
    let along = case.place.kind.edges()[last] * H;
    // points lie from the middle of the first cell on
    let all = case.place.cells[last] as f64 * along;
    let set = |name: &str, which: String| SetSpec {
        name: name.into(),
        members: Members::Where(e(&which)),
    };
    spec.sets = vec![
        set("low", format!("{axis} < {}", 0.9 * along)),
        set("high", format!("{axis} > {}", all - 1.9 * along)),
        set(
            "middle",
            format!("abs({axis} - {}) < {}", 0.4 * all, 0.3 * all),
        ),
    ];
}

#[test]
fn heat_and_species_spread_on_any_number_of_ranks() {
    let methods = [
        DiffusionMethod::Explicit { safety: 0.5 },
        DiffusionMethod::Implicit {
            theta: 0.5,
            tolerance: 1e-9,
        },
        DiffusionMethod::Steady { tolerance: 1e-9 },
    ];
    let kinds = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic];
    let mut n = 0;
    for kind in kinds {
        for (method, name) in methods.into_iter().zip(["pmb", "lps", "elastic-plastic"]) {
            n += 1;
            // one of each dimension and method
            let still = [2, 4, 9].contains(&n);
            let case = Case::of(name, place(kind));
            let mut spec = torn(&case, false);
            faced(&mut spec, &case);
            spec.interactions.diffusions = vec![
                spreading(Quantity::Heat, method, if still { 0.0 } else { 0.02 }),
                spreading(Quantity::Species, methods[n % 3], 0.0),
            ];
            if n % 2 == 0 {
                scattered(&mut spec);
                for t in &mut spec.interactions.diffusions {
                    for c in &mut t.conditions {
                        if let DiffusionKind::Exchange { area, .. } = &mut c.kind {
                            *area = Some(3.0);
                        }
                    }
                }
            }
            if still {
                spec.run.schedule.stepper = Stepper::Still;
                spec.loading.initial = vec![];
            }
            spec.title = format!("{} {method:?} {still}", spec.title);
            let broke = match kind.dimension() {
                1 => same(&spec, &[3]),
                2 => same(&spec, &[2]),
                _ => same(&spec, &[3]),
            };
            assert_eq!(broke, !still, "{}", spec.title);
        }
    }
}

/// Two plates, the faces of which ranks share; still, sliding on each other, and in implicit steps.
#[test]
fn heat_crosses_contact_on_any_number_of_ranks() {
    let case = Case::of("pmb", place(LatticeKind::Square));
    let plate = |x: f64, y: f64| BodySpec::Sites {
        kind: LatticeKind::Square,
        spacing: H,
        origin: [x, y, 0.0],
        quarters: (0..800).map(|n| [4 * (n % 20), 4 * (n / 20), 0]).collect(),
        volume: None,
    };
    let methods = [
        DiffusionMethod::Explicit { safety: 0.5 },
        DiffusionMethod::Implicit {
            theta: 0.5,
            tolerance: 1e-9,
        },
    ];
    for (n, method) in [methods[0], methods[1], methods[0]].into_iter().enumerate() {
        let mut spec = case.spec();
        spec.title = format!("contact {n} {method:?}");
        spec.body = BodySpec::Several(vec![
            PieceSpec::new("left", plate(0.0, 0.0)),
            PieceSpec::new("right", plate(20.0 * H, 0.3 * H)),
        ]);
        spec.sets = vec![];
        let mut heat = spreading(Quantity::Heat, method, 0.0);
        heat.conditions.clear();
        heat.initial = vec![("all".into(), e("1 + 0.3*sin(x) + 0.1*y"))];
        spec.interactions.diffusions = vec![heat];
        spec.interactions.contact = Some(ContactSpec {
            conductance: Some(0.8),
            ..CONTACT
        });
        match n {
            0 => spec.run.schedule.stepper = Stepper::Still,
            _ => {
                spec.loading.initial = vec![InitialSpec {
                    set: "all".into(),
                    displacement: [const { None }; 3],
                    velocity: [None, Some(e("x > 9.9 ? 2 : -1")), None],
                }];
            }
        }
        spec.run.schedule.time_step = TimeStep::Fixed(0.02 * H);
        same(&spec, &[2, 3]);
    }
}
