//! Everything has a declaration, and every declaration has values.

use crate::sample::*;
use peridyne::columns::{Life, On};
use peridyne::observe::observables;
use peridyne::run::{Options, build};
use peridyne::spec::*;

#[test]
fn every_declared_column_can_be_read() {
    for d in 1..=3 {
        for law in [PMB, LPS] {
            let mut spec = block([9, 4, 3], d, 0.5, law.clone());
            spec.materials[0].fracture = Some(FractureSpec {
                criterion: Criterion::Stretch(0.1),
                alpha: 0.0,
                rate: None,
                fatigue: None,
            });
            spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
            let mut sim = made(&spec);
            let declared = sim.columns();
            let points = sim.info().points as usize;
            for wanted in declared {
                let column = sim.column(&wanted.name).unwrap();
                assert_eq!(column.declaration, wanted);
                assert_eq!(column.values.shape(), wanted.shape, "{}", wanted.name);
                let count = match wanted.on {
                    On::Points => points,
                    On::Bonds => sim.info().directed_bonds as usize,
                };
                assert_eq!(column.values.len(), count, "{}", wanted.name);
                assert!(!wanted.doc.is_empty());
            }
            let known: Vec<String> = sim.columns().iter().map(|c| c.name.to_string()).collect();
            let mut once = known.clone();
            once.sort();
            once.dedup();
            assert_eq!(once.len(), known.len(), "a name stands twice: {known:?}");
            for name in ["critical_stretch", "whole", "stress"] {
                assert!(known.iter().any(|k| k == name), "{name} in {known:?}");
            }
            // one body, no atoms
            for name in ["body", "temperature", "colour"] {
                assert!(sim.column(name).is_none(), "{name}");
            }
        }
    }
}

#[test]
fn what_is_moved_persists_and_what_follows_is_derived() {
    let of = |name| observables::named(name).unwrap().declaration.life;
    assert_eq!(of("displacement"), Life::Persistent);
    assert_eq!(of("velocity"), Life::Persistent);
    for observable in observables::ALL {
        if !observable.equation.is_empty() && of(&observable.declaration.name) == Life::Persistent {
            let primary = ["displacement", "velocity", "reference", "volume", "density"];
            assert!(primary.contains(&&*observable.declaration.name));
        }
    }
}

#[test]
fn a_snapshot_has_what_was_asked_for_and_no_more() {
    let mut spec = block([9, 4, 0], 2, 0.5, PMB);
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    let mut sim = made(&spec);
    let snapshot = sim.snapshot(&["damage", "displacement", "body", "nothing"], false);
    let names: Vec<&str> = snapshot.columns.iter().map(|c| c.name()).collect();
    assert_eq!(names, ["displacement", "damage"]);
    assert!(snapshot.bonds.is_none());
    let bonds = sim.snapshot(&[], true).bonds.unwrap();
    assert_eq!(2 * bonds.len() as u64, sim.info().directed_bonds);
}

#[test]
fn a_field_that_does_not_exist_is_refused_with_the_nearest() {
    let mut spec = block([9, 4, 0], 2, 0.5, PMB);
    for (name, message, help) in [
        ("strss", "unknown field `strss`", "`stress`"),
        ("colour", "unknown field `colour`", "known are displacement"),
        ("body", "there is one body", ""),
        ("temperature", "the points are no atoms", ""),
        ("whole", "a column of bonds", ""),
    ] {
        spec.run.fields = Some(vec!["velocity".into(), name.into()]);
        let Err(error) = build(&spec, Options::default()) else {
            panic!("{name} was taken")
        };
        assert_eq!(error.path, "output.fields[1]");
        assert!(error.message.contains(message), "{}", error.message);
        assert!(error.help.unwrap_or_default().contains(help));
    }
}

/// What bonds remember can be taken from one model and put into another.
#[test]
fn memory_goes_from_one_model_to_another() {
    let mut spec = block([12, 8, 0], 2, 0.5, PMB);
    spec.materials[0].fracture = Some(FractureSpec {
        criterion: Criterion::Stretch(0.02),
        alpha: 0.25,
        rate: None,
        fatigue: None,
    });
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    for family in [FamilyChoice::Stencil, FamilyChoice::List] {
        spec.bonds.family = family;
        let mut broken = made(&spec);
        let u: Vec<_> = (0..broken.info().points)
            .map(|i| [0.02 * (i as f64).sin(), 0.01 * (i as f64).cos(), 0.0])
            .collect();
        broken.set_displacements(&u);
        broken.start(true);
        let (whole, critical) = (
            broken.scalars("whole"),
            broken.scalars("critical_elongation"),
        );
        assert!(whole.contains(&0.0) && whole.contains(&1.0));
        let broken_bonds = whole.iter().filter(|w| **w == 0.0).count();
        assert_eq!(broken_bonds as u64, broken.broken());
        let mut fresh = made(&spec);
        assert!(!fresh.set_column("damage", &vec![0.0; whole.len()]));
        assert!(!fresh.set_column("whole", &whole[1..]));
        assert!(
            fresh.set_column("whole", &whole) && fresh.set_column("critical_elongation", &critical)
        );
        fresh.set_displacements(&u);
        for name in ["damage", "critical_stretch", "strain_energy_density"] {
            assert_eq!(
                fresh.scalars(name),
                broken.scalars(name),
                "{family:?} {name}"
            );
        }
        fresh.start(true);
        assert_eq!(fresh.vectors("force_density"), broken_forces(&mut *broken));
    }

    fn broken_forces(sim: &mut dyn peridyne::run::Simulation) -> Vec<[f64; 3]> {
        sim.start(true);
        sim.vectors("force_density")
    }
}
