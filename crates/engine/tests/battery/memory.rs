//! What a torn body of any law remembers goes to another model of it, which is then where the first one was, to the last bit.

use crate::sample::*;
use peridyne::columns::{Life, On, Shape};
use peridyne::observe::Values;
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

/// A crack across the lower left corner, askew, so that no family beside it is symmetric to anything.
fn torn(case: &Case) -> PrecrackSpec {
    let [x, y] = [0, 1].map(|a| H * case.place.kind.edges()[a] * case.place.cells[a] as f64);
    PrecrackSpec {
        kind: CrackKind::Broken,
        shape: match case.d() {
            1 => CrackShape::Point { x: 0.31 * x },
            _ => CrackShape::Segment {
                from: [-H, 0.23 * y, 0.0],
                to: [0.57 * x, 0.64 * y, 0.0],
            },
        },
    }
}

/// The values of a column as [`Simulation::set_column`] takes them.
fn stored(values: &Values, shape: Shape, d: usize) -> Vec<f64> {
    let there = |name: &&str| name.chars().all(|c| "xyz".find(c).unwrap() < d);
    let kept: Vec<usize> = match shape {
        Shape::Scalar => vec![0],
        _ => (0..shape.components().len())
            .filter(|c| there(&shape.components()[*c]))
            .collect(),
    };
    let each = |i: usize| kept.iter().map(move |c| values.at(i, *c));
    (0..values.len()).flat_map(each).collect()
}

/// All that `from` remembers, but where its points are.
fn pass_on(from: &mut dyn Simulation, to: &mut dyn Simulation) {
    let d = from.info().dimension;
    let known = |name: &str| ["displacement", "velocity"].contains(&name);
    for c in from.columns() {
        if c.life != Life::Persistent || known(&c.name) {
            continue;
        }
        let values = from.column(&c.name).unwrap().values;
        let set = to.set_column(&c.name, &stored(&values, c.shape, d));
        // of points what the body itself says; of bonds everything
        assert!(set || c.on == On::Points, "{}", c.name);
    }
}

fn place(from: &mut dyn Simulation, to: &mut dyn Simulation) {
    let (u, v) = (from.displacements(), from.velocities());
    to.set_displacements(&u);
    to.set_velocities(&v);
    to.set_time(from.step_number(), from.time());
}

/// Forces and energies.
fn bits(sim: &mut dyn Simulation) -> Vec<u64> {
    let u = sim.displacements();
    let ledger = sim.ledger().unwrap();
    let mut bits = vec![ledger.strain.to_bits(), ledger.kinetic.to_bits()];
    for field in [sim.forces_under(&u), sim.vectors("force_density"), u] {
        // no force has two signs
        bits.extend(field.iter().flatten().map(|x| (x + 0.0).to_bits()));
    }
    for name in ["damage", "strain_energy_density"] {
        bits.extend(sim.scalars(name).iter().map(|x| (x + 0.0).to_bits()));
    }
    bits
}

/// Does what a torn body remembers after some steps make another model go on like it? `None`: such a body there is not. Into a model that has
/// `started`, or before it does.
fn goes_over(name: &str, case: &Case, mut spec: Spec, started: bool) -> Option<()> {
    spec.run.schedule.time_step = TimeStep::Fixed(0.02 * H);
    let made = |spec: &Spec| {
        let options = peridyne::run::Options {
            trust_time_step: true,
            ..Default::default()
        };
        build(spec, options).ok()
    };
    let mut cut = spec.clone();
    cut.damage.precracks = vec![torn(case)];
    let (mut source, mut fresh) = (made(&cut)?, made(&spec)?);
    let n = source.vectors("reference").len();
    source.set_displacements(&Random(3).vectors(n, case.d(), 2e-3 * H));
    source.set_velocities(&Random(5).vectors(n, case.d(), 0.05));
    source.start(true);
    for _ in 0..12 {
        source.step().ok()?;
    }
    let whole = source.scalars("whole");
    assert!(whole.contains(&0.0), "{name}: nothing is torn");
    if started {
        place(source.as_mut(), fresh.as_mut());
        fresh.start(true);
        pass_on(source.as_mut(), fresh.as_mut());
        // forces of what is remembered, here too
        assert!(source.set_column("whole", &whole));
    } else {
        pass_on(source.as_mut(), fresh.as_mut());
        place(source.as_mut(), fresh.as_mut());
        source.start(true);
        fresh.start(true);
        assert!(
            bits(source.as_mut()) == bits(fresh.as_mut()),
            "{name}: not where the source is"
        );
    }
    for step in 0..3 {
        steps(source.as_mut(), 1);
        steps(fresh.as_mut(), 1);
        assert!(
            bits(source.as_mut()) == bits(fresh.as_mut()),
            "{name}: not where the source is after step {step}"
        );
        assert_eq!(source.fragments(), fresh.fragments());
    }
    Some(())
}

fn breaks(spec: &mut Spec, criterion: Criterion) {
    for m in &mut spec.materials {
        m.fracture = Some(FractureSpec::new(criterion));
    }
}

#[test]
fn what_a_torn_body_of_any_law_remembers_goes_to_another_model() {
    let (mut went, mut all) = (0, 0);
    for case in cases() {
        for family in [FamilyChoice::Stencil, FamilyChoice::List] {
            let mut spec = case.spec();
            spec.bonds.family = family;
            breaks(&mut spec, Criterion::Stretch(0.02));
            let name = format!("{} as {family:?}", case.name());
            all += 1;
            match goes_over(&name, &case, spec, false) {
                Some(()) => went += 1,
                None => println!("{name}: no such body"),
            }
        }
    }
    // springs have no list
    assert!(10 * went > 9 * all, "{went} of {all}");
}

/// Columns may also be set while a model runs: its next step begins with the forces of what they say.
#[test]
fn columns_set_in_a_run_hold_from_the_next_step_on() {
    let mut went = 0;
    for case in cases().iter().step_by(3) {
        let mut spec = case.spec();
        breaks(&mut spec, Criterion::Stretch(0.02));
        let name = format!("{} running", case.name());
        went += usize::from(goes_over(&name, case, spec, true).is_some());
    }
    assert!(went > 20, "{went}");
}

/// The same of what bonds break by beside their stretch: the work done on each counts on from where it was.
#[test]
fn what_criteria_measure_goes_over_too() {
    let place = |kind: LatticeKind| places().into_iter().find(|p| p.kind == kind).unwrap();
    for kind in [LatticeKind::Square, LatticeKind::Cubic] {
        for law in ["lps", "correspondence"] {
            for criterion in [
                Criterion::BondEnergy(2e-3),
                Criterion::BondEnergy(1e3),
                Criterion::VonMises(1.0),
            ] {
                for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                    let case = Case::of(law, place(kind));
                    let mut spec = case.spec();
                    spec.bonds.family = family;
                    breaks(&mut spec, criterion);
                    let name = format!("{} {criterion:?} {family:?}", case.name());
                    for started in [false, true] {
                        let went = goes_over(&name, &case, spec.clone(), started);
                        assert!(went.is_some(), "{name}: no such body");
                    }
                }
            }
        }
    }
}
