//! Equilibria of bodies that ranks share.

use super::{acted, meeting, options, registry, same, scattered};
use crate::sample::*;
use peridyne::run::build_with;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// Bodies of a few blocks of 256 points.
fn place(kind: LatticeKind) -> Place {
    Place {
        kind,
        plane: Plane::Stress,
        ratio: 2,
        cells: match kind.dimension() {
            1 => [900, 1, 1],
            2 => [18, 41, 1],
            _ => [6, 7, 15],
        },
    }
}

/// Drawn out along its last axis, by so much of its length at the end.
fn drawn(case: &Case, statics: Statics, strain: f64) -> Spec {
    let mut spec = case.spec();
    spec.title = format!("{} {statics:?}", spec.title);
    let last = case.d() - 1;
    let axis = ["x", "y", "z"][last];
    let along = case.place.kind.edges()[last] * H;
    let length = case.place.cells[last] as f64 * along;
    let set = |name: &str, text: String| SetSpec {
        name: name.into(),
        members: Members::Where(e(&text)),
    };
    spec.sets.extend([
        set("begin", format!("{axis} < {}", 2.6 * along)),
        set("end", format!("{axis} > {}", length - 2.6 * along)),
    ]);
    let held = |set: &str, moved: String| {
        let all = std::array::from_fn(|a| match a {
            a if a == last => Some(e(&moved)),
            a if a < last => Some(e("0")),
            _ => None,
        });
        ConditionSpec {
            set: set.into(),
            kind: ConditionKind::Displacement(all),
        }
    };
    // cycles are of a load that stays
    let by = if statics.cycles.is_some() { "" } else { "*t" };
    let pulled = format!("{}{by}", strain * length);
    spec.loading.conditions = vec![held("begin", "0".into()), held("end", pulled)];
    spec.run.schedule = Schedule {
        steps: 2,
        time_step: TimeStep::Fixed(0.5),
        force_unstable: false,
        stepper: Stepper::Statics(statics),
    };
    let probe = |name: &str, set: &str, measure| ProbeSpec {
        name: name.into(),
        set: set.into(),
        measure,
    };
    spec.run.probes = vec![
        probe("pull", "end", Measure::Reaction),
        probe("energies", "all", Measure::Energy),
    ];
    spec
}

fn newton() -> Statics {
    Statics {
        method: Method::Newton,
        timed: true,
        ..Statics::default()
    }
}

/// Why there are no equilibria.
fn found(spec: &Spec) -> Result<(), String> {
    let made = build_with(spec, options(None), &registry());
    let mut sim = made.map_err(|e| e.to_string())?;
    sim.start(true);
    (0..spec.run.schedule.steps).try_for_each(|_| sim.step().map_err(|e| e.to_string()))
}

fn every_material(tries: impl Fn(usize) -> bool) {
    let kinds = [
        LatticeKind::Square,
        LatticeKind::Chain,
        LatticeKind::Cubic,
        LatticeKind::Triangular,
    ];
    let (mut tried, mut many) = (0, 0);
    for (n, material) in materials().into_iter().enumerate().filter(|m| tries(m.0)) {
        let lives = |kind: &&LatticeKind| (material.lives)(kind.dimension(), Plane::Stress);
        let kinds: Vec<_> = kinds.iter().filter(lives).collect();
        let Some(kind) = kinds.get(n % kinds.len().max(1)) else {
            continue;
        };
        many += 1;
        let case = Case {
            place: place(**kind),
            material,
        };
        let mut spec = drawn(&case, newton(), 0.004);
        if n % 3 == 0 {
            scattered(&mut spec);
        }
        // some have no tangent, or none that is positive
        let found = found(&spec);
        if let Err(why) = found {
            println!("{}: {why}", case.name());
            continue;
        }
        tried += 1;
        assert!(!same(&spec, &[2 + n % 2]), "{}", spec.title);
    }
    assert!(tried > many * 3 / 4, "{tried} of {many}");
}

#[test]
fn every_material_has_the_same_equilibria_on_any_number_of_ranks() {
    every_material(|n| n % 8 == 1);
}

#[test]
#[ignore = "minutes: some of it is in the test above"]
fn every_material_everywhere_has_the_same_equilibria_on_any_number_of_ranks() {
    every_material(|_| true);
}

/// A crack in the middle of a side, where bonds break.
fn notched(spec: &mut Spec, case: &Case) {
    let last = case.d() - 1;
    let [width, length] =
        [0, last].map(|a| case.place.kind.edges()[a] * H * case.place.cells[a] as f64);
    let middle = 0.5 * length + 0.03 * H;
    let mut at = [0.0; 3];
    at[last] = middle;
    let mut normal = [0.0; 3];
    normal[last] = 1.0;
    let shape = match case.d() {
        2 => CrackShape::Segment {
            from: [-H, middle, 0.0],
            to: [0.4 * width, middle, 0.0],
        },
        _ => CrackShape::Disk {
            center: at,
            normal,
            radius: 0.5 * width,
        },
    };
    spec.damage.precracks = vec![PrecrackSpec {
        kind: CrackKind::Broken,
        shape,
    }];
}

#[test]
fn bonds_break_in_equilibrium_on_any_number_of_ranks() {
    let linear = Statics {
        method: Method::Linear,
        ..Statics::default()
    };
    let with = |statics: Statics, solver| Statics { solver, ..statics };
    let relaxed = |method| Statics {
        method,
        tolerance: 1e-6,
        ..newton()
    };
    let by_gradients = |statics| with(statics, Solver::ConjugateGradients);
    let controlled = |statics: Statics, control| Statics {
        control,
        timed: false,
        ..statics
    };
    let cycles = Some(Cycles {
        load_ratio: 0.1,
        bonds: 2,
        most: f64::INFINITY,
    });
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Cubic];
    let all = [
        ("pmb", flat, linear),
        ("lps", flat, linear),
        ("lps", solid, linear),
        ("lps", flat, by_gradients(linear)),
        ("pmb", flat, newton()),
        ("lps", solid, by_gradients(newton())),
        ("elastic-plastic", flat, by_gradients(newton())),
        ("pmb", solid, relaxed(Method::Relaxation)),
        ("elastic-plastic", flat, relaxed(Method::Relaxation)),
        ("lps", flat, relaxed(Method::Fire)),
        ("pmb", flat, controlled(linear, Control::SequentiallyLinear)),
        (
            "lps",
            solid,
            controlled(linear, Control::SequentiallyLinear),
        ),
        (
            "pmb",
            flat,
            controlled(newton(), Control::ArcLength(0.01 * H)),
        ),
        (
            "lps",
            flat,
            controlled(newton(), Control::IndirectDisplacement(1e-3)),
        ),
        (
            "pmb",
            flat,
            Statics {
                cycles,
                timed: false,
                ..newton()
            },
        ),
    ];
    for (n, (name, kind, statics)) in all.into_iter().enumerate() {
        let case = Case::of(name, place(kind));
        let path = matches!(
            statics.control,
            Control::ArcLength(_) | Control::IndirectDisplacement(_)
        );
        let breaks = name != "elastic-plastic" && !path;
        let mut spec = drawn(&case, statics, if breaks { 0.01 } else { 0.004 });
        if breaks {
            notched(&mut spec, &case);
            breaking(&mut spec, 0.02);
        }
        for fracture in spec.materials.iter_mut().flat_map(|m| &mut m.fracture) {
            if statics.control != Control::Load || statics.cycles.is_some() {
                fracture.alpha = 0.0;
            }
            if statics.cycles.is_some() {
                fracture.criterion = Criterion::Stretch(0.2);
                fracture.fatigue = Some(FatigueSpec {
                    nucleation: Some([1e3, 3.0]),
                    limit: 0.0,
                    growth: Some([1e6, 3.0]),
                    crack: 0.3,
                });
            }
        }
        if n % 3 == 1 {
            scattered(&mut spec);
        }
        println!("{}", spec.title);
        assert_eq!(same(&spec, &[2 + n % 2]), breaks);
    }
}

#[test]
fn implicit_steps_are_the_same_on_any_number_of_ranks() {
    let [bar, flat, solid] = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic];
    let [direct, gradients] = [Solver::Direct, Solver::ConjugateGradients];
    for (n, (name, kind, solver, alpha)) in [
        ("pmb", bar, direct, 0.0),
        ("lps", flat, direct, -0.1),
        ("elastic-plastic", flat, direct, 0.0),
        ("pmb", solid, gradients, -0.2),
        ("lps", solid, direct, 0.0),
    ]
    .into_iter()
    .enumerate()
    {
        let case = Case::of(name, place(kind));
        let newmark = Newmark {
            solver,
            ..Newmark::hht(alpha)
        };
        // loads, what is told to move, bodies that push, and one that is pushed
        let mut spec = acted(&case);
        let tangent = |c: &ConditionSpec| !matches!(c.kind, ConditionKind::SetForce(_));
        spec.loading.conditions.retain(tangent);
        spec.title = format!("{} {newmark:?}", spec.title);
        spec.run.schedule.stepper = Stepper::Newmark(newmark);
        spec.run.schedule.time_step = TimeStep::Fixed(0.03 * H);
        println!("{}", spec.title);
        same(&spec, &[2 + n % 2]);
        // and bodies that meet
        let mut spec = meeting(&case, n % 2 == 0);
        spec.title = format!("{} {newmark:?}", spec.title);
        spec.run.schedule.stepper = Stepper::Newmark(newmark);
        spec.run.schedule.time_step = TimeStep::Fixed(0.03 * H);
        same(&spec, &[3 - n % 2]);
    }
}
