//! Friction of points that ranks share: who touches, how it turns, and what sticks.

use super::interfaces::moved;
use super::{STEPS, colliding, meeting, options, place, registry, same, scattered};
use crate::sample::*;
use peridyne::run::build_with;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// Greater at rest, and less in time.
fn rubbing(spec: &mut Spec) {
    let contact = spec.interactions.contact.as_mut().unwrap();
    contact.friction = Some(FrictionSpec {
        kinetic: e("0.4 - 0.1*t"),
        at_rest: Some(AtRest {
            coefficient: e("0.7"),
            speed: 0.5,
        }),
    });
    spec.title = format!("{} that rubs", spec.title);
    // along the faces
    let axis = if spec.space.dimension == 2 { "y" } else { "z" };
    for initial in &mut spec.loading.initial {
        initial.velocity[0] = Some(e(&format!("0.4*sin(0.7*{axis})")));
    }
}

/// Friction moves points, by the same bits on so many ranks.
fn rubs_the_same(spec: &Spec, ranks: &[usize]) {
    println!("{}", spec.title);
    let mut smooth = spec.clone();
    smooth.interactions.contact.as_mut().unwrap().friction = None;
    let ends = [spec, &smooth].map(|spec| {
        let mut sim = build_with(spec, options(None), &registry()).unwrap();
        sim.start(true);
        (0..spec.run.schedule.steps.max(STEPS as u64)).for_each(|_| sim.step().unwrap());
        sim.state_hash()
    });
    assert_ne!(ends[0], ends[1], "nothing rubs");
    same(spec, ranks);
}

fn small(kind: LatticeKind) -> Place {
    let mut place = place(kind);
    if kind.dimension() == 3 {
        (place.ratio, place.cells) = (1, [7, 9, 23]);
    }
    place
}

#[test]
fn what_rubs_rubs_the_same_whichever_rank_has_it() {
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Bcc];
    for (n, (name, kind)) in [
        ("pmb", flat),
        ("lps", flat),
        ("pmb mixed", solid),
        ("elastic-plastic", flat),
        ("lps", solid),
    ]
    .into_iter()
    .enumerate()
    {
        let mut spec = meeting(&Case::of(name, small(kind)), n % 2 == 0);
        if n == 1 {
            scattered(&mut spec);
        }
        rubbing(&mut spec);
        rubs_the_same(&spec, &[2, 3 + n % 2]);
        // several bodies, one of loose points, that attract each other
        let mut spec = colliding(&Case::of(name, small(kind)));
        rubbing(&mut spec);
        rubs_the_same(&spec, &[3 - n % 2, 4]);
    }
}

#[test]
fn implicit_steps_of_what_rubs_are_the_same_on_any_number_of_ranks() {
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Cubic];
    let [direct, gradients] = [Solver::Direct, Solver::ConjugateGradients];
    for (n, (name, kind, solver)) in [
        ("lps", flat, direct),
        ("pmb", flat, gradients),
        ("pmb", solid, direct),
    ]
    .into_iter()
    .enumerate()
    {
        let mut place = place(kind);
        place.cells = if n < 2 { [18, 41, 1] } else { [6, 7, 15] };
        let mut spec = meeting(&Case::of(name, place), n % 2 == 0);
        rubbing(&mut spec);
        spec.run.schedule.stepper = Stepper::Newmark(Newmark {
            solver,
            ..Newmark::hht(-0.1)
        });
        spec.run.schedule.time_step = TimeStep::Fixed(0.03 * H);
        rubs_the_same(&spec, &[2 + n % 2]);
    }
}

/// A block that is pressed on another one and drawn along it.
fn pressed(case: &Case, statics: Statics) -> Spec {
    let mut spec = colliding(case);
    let BodySpec::Several(pieces) = &mut spec.body else {
        panic!("several bodies");
    };
    pieces.truncate(2);
    for material in &mut spec.materials {
        material.fracture = None;
    }
    spec.interactions.contact = Some(CONTACT);
    rubbing(&mut spec);
    spec.title = format!("{} {statics:?}", spec.title);
    spec.loading.initial.clear();
    moved(&mut spec, case, "0.1*t", "-0.2*t");
    spec.run.schedule = Schedule {
        steps: 2,
        time_step: TimeStep::Fixed(0.5),
        force_unstable: false,
        stepper: Stepper::Statics(statics),
    };
    spec
}

#[test]
fn equilibria_of_what_rubs_are_the_same_on_any_number_of_ranks() {
    let relaxed = |method| Statics {
        method,
        timed: true,
        tolerance: 1e-5,
        ..Statics::default()
    };
    let [flat, solid] = [LatticeKind::Square, LatticeKind::Cubic];
    for (n, (name, kind, method)) in [
        ("lps", flat, Method::Relaxation),
        ("pmb", flat, Method::Fire),
        ("pmb", solid, Method::Relaxation),
    ]
    .into_iter()
    .enumerate()
    {
        let mut place = place(kind);
        place.cells = if n < 2 { [18, 41, 1] } else { [6, 7, 15] };
        let spec = pressed(&Case::of(name, place), relaxed(method));
        rubs_the_same(&spec, &[2 + n % 2]);
    }
}
