//! What one rank meets alone, and all must know: states without an answer, mistakes, bodies of which it has nothing.

use super::heat::spreading;
use super::{among, colliding, made, meeting, mistakes, on_ranks, place, same, scattered, torn};
use crate::atoms::{atoms, potentials};
use crate::sample::*;
use peridyne::error::{BuildErrorKind, RunError};
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::space::region::Region;
use peridyne::spec::*;

fn square() -> Place {
    place(LatticeKind::Square)
}

/// Why forces mean nothing, of a model that begins so.
fn fault(sim: &mut dyn Simulation) -> [Option<RunError>; 2] {
    sim.start(true);
    let first = sim.ledger().err();
    [first, (0..3).find_map(|_| sim.step().err())]
}

/// A chain of atoms that have gone through each other where the last rank has them.
#[test]
fn a_state_without_an_answer_is_known_to_all() {
    let (_, potential) = &potentials()[1];
    let mut spec = atoms(
        LatticeKind::Chain,
        1200,
        potential,
        FamilyChoice::Stencil,
        false,
    );
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [Some(e("x > 1150 && x < 1151 ? 1.7 : 0")), None, None],
        velocity: [const { None }; 3],
    }];
    let one = fault(made(&spec).as_mut());
    assert!(
        matches!(one[0], Some(RunError::Crossing { .. })),
        "{:?}",
        one[0]
    );
    assert_eq!(on_ranks((&spec, None), 3, fault), one);
}

/// Of a law whose direction is none at the places of one rank.
#[test]
fn a_mistake_in_a_law_is_known_to_all() {
    let kinds = |spec: &Spec| -> Vec<_> {
        let all = mistakes(spec).into_iter();
        all.map(|e| e.map(|e| e.kind)).collect()
    };
    let found = |kinds: Vec<Option<BuildErrorKind>>| {
        let invalid = kinds
            .iter()
            .filter(|k| **k == Some(BuildErrorKind::Invalid));
        assert!(invalid.count() >= 1, "{kinds:?}");
        assert!(kinds.iter().all(Option::is_some), "{kinds:?}");
    };
    let case = Case::of("wound", square());
    let mut spec = case.spec();
    for material in &mut spec.materials {
        if let LawSpec::Named(law) = &mut material.law {
            let nowhere = ["abs(x) + max(20 - y, 0)", "0", "0"].map(e);
            law.parameters.set("fibre", Parameter::Direction(nowhere));
        }
    }
    found(kinds(&spec));
}

/// Contact of points with horizons of their own, which repel by what they are bonded with.
#[test]
fn what_ghosts_repel_by_is_theirs() {
    let mut spec = meeting(&Case::of("pmb", square()), false);
    scattered(&mut spec);
    let Horizon::Length(longest) = spec.bonds.horizon else {
        panic!("a length");
    };
    spec.bonds.variable_horizon = Some(e(&format!("{longest}*(0.85 + 0.15*sin(2*x))")));
    spec.bonds.calibration = Calibration::Continuum;
    same(&spec, &[2, 3]);
}

/// Bodies of unlike materials, with friction between the faces of their cracks.
#[test]
fn what_copies_repel_by_is_theirs() {
    let mut spec = colliding(&Case::of("pmb mixed", square()));
    // along the lower body, across the borders of ranks: its halves are pressed together and slide
    spec.damage.precracks = vec![PrecrackSpec {
        kind: CrackKind::Broken,
        shape: CrackShape::Segment {
            from: [17.1, -1.0, 0.0],
            to: [17.1, 25.0, 0.0],
        },
    }];
    let initial = &mut spec.loading.initial[0];
    initial.displacement[0] = Some(e("x > 17.1 && x < 22.6 ? -0.15 : 0"));
    initial.velocity[1] = Some(e("x > 17.1 ? 0.5 : -0.5"));
    let contact = spec.interactions.contact.as_mut().unwrap();
    contact.cohesion = None;
    contact.friction = Some(FrictionSpec::constant(0.4));
    same(&spec, &[2, 3]);
}

/// Ranks beyond the blocks of a cloud whose bonds break by work, and what they say of it.
#[test]
fn ranks_without_bonds_know_what_bonds_have() {
    let mut case = Case::of("pmb", square());
    case.place.cells = [20, 20, 1];
    let mut spec = torn(&case, false);
    scattered(&mut spec);
    for material in &mut spec.materials {
        material.fracture = Some(FractureSpec::new(Criterion::BondEnergy(1e-5)));
    }
    assert!(same(&spec, &[4]));
    let (_, all) = among(&spec, 4, None, None);
    assert!(all.columns.contains_key("critical_bond_work"));
}

/// Springs that expand hold energy by that.
#[test]
fn springs_expand_on_any_number_of_ranks() {
    let case = Case::of("pmb", square());
    let mut spec = torn(&case, false);
    super::faced(&mut spec, &case);
    let LawSpec::Pmb(stiffness) = spec.materials[0].law.clone() else {
        panic!("pmb");
    };
    spec.materials[0].law = LawSpec::Springs(stiffness);
    spec.materials[0].fracture = None;
    spec.interactions.diffusions = vec![spreading(
        Quantity::Heat,
        DiffusionMethod::Explicit { safety: 0.5 },
        0.02,
    )];
    same(&spec, &[2, 3]);
}

/// A traction that acts in statics before motion, on the face of a body whose points have moved from their sites.
#[test]
fn tractions_of_statics_before_motion_have_the_areas_of_the_whole() {
    let case = Case::of("pmb", square());
    let mut spec = torn(&case, false);
    spec.materials[0].fracture = None;
    spec.body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: H,
        origin: [0.5 * H; 3],
        region: Region::Block {
            low: [0.0; 3],
            high: [45.0 * H, 49.0 * H, 0.0],
        },
        perturb: Some(Perturbation {
            amplitude: 0.1 * H,
            seed: 7,
        }),
    };
    super::faced(&mut spec, &case);
    let on = |set: &str, kind| ConditionSpec {
        set: set.into(),
        kind,
    };
    let zero = || Some(e("0"));
    spec.run.preload = Some(PreloadSpec {
        statics: Statics {
            method: Method::Newton,
            ..Statics::default()
        },
        increments: 1,
        duration: None,
        conditions: vec![
            on("low", ConditionKind::Displacement([zero(), zero(), None])),
            on(
                "high",
                ConditionKind::Traction {
                    value: [zero(), Some(e("0.01*t")), zero()],
                    area: None,
                },
            ),
        ],
        rigid_bodies: vec![],
        cuts: vec![],
    });
    same(&spec, &[2, 3]);
}
