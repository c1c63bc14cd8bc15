//! Atoms that ranks share: on current neighbours, on families of the reference, in molecules, and in equilibrium.

use super::same;
use crate::atoms::{Noise, atoms, crystal, many_body, potentials};
use crate::sample::e;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::sync::Arc;

/// So fast that lists of neighbours are made anew, and that atoms meet others than in the reference.
fn thrown(spec: &mut Spec, speed: f64) {
    let all = ["x", "y", "z"];
    let wave = |a: usize| {
        let [own, next] = [all[a], all[(a + 1) % spec.space.dimension]];
        e(&format!(
            "{speed}*(sin(0.7*{own} + 0.4*{next}) + 0.3*cos(1.9*{next}))"
        ))
    };
    spec.loading.initial = vec![InitialSpec {
        set: "all".into(),
        displacement: [const { None }; 3],
        velocity: std::array::from_fn(|a| (a < spec.space.dimension).then(|| wave(a))),
    }];
    spec.run.probes = vec![ProbeSpec {
        name: "energies".into(),
        set: "all".into(),
        measure: Measure::Energy,
    }];
}

fn broken_by(spec: &mut Spec, criterion: Criterion) {
    for m in &mut spec.materials {
        m.fracture = Some(FractureSpec {
            criterion,
            alpha: 0.0,
            rate: None,
            fatigue: None,
        });
    }
}

#[test]
fn every_potential_has_the_same_bits_on_any_number_of_ranks() {
    let kinds = [
        (LatticeKind::Cubic, 10),
        (LatticeKind::Square, 30),
        (LatticeKind::Fcc, 9),
        (LatticeKind::Chain, 900),
    ];
    for (n, (name, potential)) in potentials().into_iter().enumerate() {
        let (kind, cells) = kinds[n % 4];
        // on the lattice bonds stay, beside them atoms come and go
        for family in [FamilyChoice::Neighbours, FamilyChoice::Stencil] {
            let mut spec = atoms(kind, cells, &potential, family, n / 4 % 2 == 0);
            spec.title = format!("{name}, {kind:?}, {family:?}");
            thrown(&mut spec, 20.0);
            same(&spec, &[2 + n % 2]);
        }
    }
}

#[test]
fn every_fan_has_the_same_bits_on_any_number_of_ranks() {
    // the families in turn; with each potential, where bonds break and where atoms rest
    let families = [FamilyChoice::Neighbours, FamilyChoice::Reference];
    for (n, (name, potential, edge, kinds)) in many_body().into_iter().enumerate() {
        let mut spec = crystal(&potential, edge, kinds, 5, n / 2 % 2 == 0);
        spec.bonds.family = families[n % 2];
        spec.title = format!("{name}, {:?}", spec.bonds.family);
        spec.bonds.horizon = Horizon::Length(4.2);
        thrown(&mut spec, 60.0);
        same(&spec, &[2 + n % 2]);
    }
}

/// Breaking by stretch and by work, of pairs, densities and fans; and what is left is state.
#[test]
fn bonds_of_potentials_break_alike_on_any_number_of_ranks() {
    // atoms without any neighbour have no density
    let some = [
        ("morse, shifted force", Criterion::Stretch(0.05), 20.0),
        ("morse, shifted force", Criterion::BondEnergy(0.02), 20.0),
        ("eam, closed form", Criterion::Stretch(0.05), 10.0),
    ];
    let mut broken = 0;
    for (n, (name, criterion, speed)) in some.into_iter().enumerate() {
        let all = potentials();
        let (_, potential) = all.iter().find(|(other, _)| other == name).unwrap();
        let family = FamilyChoice::Reference;
        let mut spec = atoms(LatticeKind::Cubic, 10, potential, family, n % 2 == 0);
        spec.title = format!("{name}, {criterion:?}");
        broken_by(&mut spec, criterion);
        thrown(&mut spec, speed);
        broken += usize::from(same(&spec, &[2]));
    }
    for (n, (name, potential, edge, kinds)) in many_body().into_iter().enumerate() {
        for criterion in [Criterion::Stretch(0.02), Criterion::BondEnergy(1e-3)] {
            let mut spec = crystal(&potential, edge, kinds, 5, n % 2 == 0);
            spec.title = format!("{name}, {criterion:?}");
            spec.bonds.family = FamilyChoice::Reference;
            spec.bonds.horizon = Horizon::Length(4.2);
            broken_by(&mut spec, criterion);
            thrown(&mut spec, 30.0);
            broken += usize::from(same(&spec, &[2 + n % 2]));
        }
    }
    assert!(broken > 8, "{broken} of 11");
}

/// Nodes that carry atoms along, at their places.
fn smoothed(spec: &mut Spec, reach: f64) {
    let squared = |d: [f64; 3]| d.iter().map(|x| x * x).sum::<f64>();
    let window = move |d| (1.0 - squared(d) / (reach * reach)).max(0.0).powi(3);
    spec.bonds.smooth = Some(SmoothSpec {
        window: Window::new(window),
        width: reach,
        reach,
        spacing: None,
    });
}

#[test]
fn fields_on_nodes_have_the_same_bits_on_any_number_of_ranks() {
    let (all, many_body) = (potentials(), many_body());
    let (_, morse) = { all.iter() }
        .find(|(name, _)| *name == "morse, shifted force")
        .unwrap();
    let (_, silicon, edge, kinds) = &many_body[0];
    let mut broken = 0;
    for breaks in [false, true] {
        let mut flat = atoms(
            LatticeKind::Square,
            30,
            morse,
            FamilyChoice::Reference,
            !breaks,
        );
        smoothed(&mut flat, 2.3 * 1.02);
        let mut solid = crystal(silicon, *edge, *kinds, 5, breaks);
        (solid.bonds.family, solid.bonds.horizon) = (FamilyChoice::Reference, Horizon::Length(4.2));
        smoothed(&mut solid, 0.85 * edge);
        for (mut spec, speed, stretch) in [(flat, 20.0, 0.05), (solid, 30.0, 0.02)] {
            spec.title = format!("nodes, {speed}, {breaks}");
            thrown(&mut spec, speed);
            if breaks {
                broken_by(&mut spec, Criterion::Stretch(stretch));
            }
            broken += usize::from(same(&spec, &[2]));
            if !breaks {
                spec.run.schedule.time_step = TimeStep::Fixed(1e-4);
                spec.run.schedule.stepper = Stepper::Newmark(Newmark::default());
                same(&spec, &[2]);
            }
        }
    }
    assert_eq!(broken, 2);
}

/// Atoms of two kinds anywhere in a periodic box.
fn mixed(more: bool, mixing: Option<Mixing>) -> Spec {
    let mut noise = Noise(11);
    let (mut position, mut mark) = (vec![], vec![]);
    for n in 0..1000 {
        let site = [n % 10, n / 10 % 10, n / 100];
        position.push(site.map(|c| 1.1 * f64::from(c) + 0.12 * noise.next()));
        mark.push(i32::from(noise.next() > 0.0));
    }
    let cloud = Cloud {
        volume: vec![0.5; position.len()],
        position,
        mark,
        ..Cloud::default()
    };
    let lj = |epsilon, sigma, cutoff| {
        PotentialSpec::of(LennardJones { epsilon, sigma }).ended(cutoff, End::ShiftedForce)
    };
    let own = [lj(1.0, 0.9, 2.2), lj(0.4, 1.1, 2.0)];
    let mut spec = Spec::new(
        3,
        BodySpec::Cloud(cloud),
        1.0,
        LawSpec::Atoms(own[0].clone()),
    );
    spec.space.periodic = [Some(11.0), Some(11.0), None];
    spec.materials = (0..2)
        .map(|n| MaterialSpec {
            name: format!("k{n}"),
            set: format!("k{n}"),
            density: 1.0 + n as f64,
            law: LawSpec::Atoms(own[n].clone()),
            fracture: None,
        })
        .collect();
    spec.sets = (0..2)
        .map(|n| SetSpec {
            name: format!("k{n}"),
            members: Members::Mark(n),
        })
        .collect();
    let between = |i, j, potential| ActingSpec {
        potential,
        on: Acting::Between([i, j]),
    };
    if mixing.is_none() {
        spec.interactions
            .potentials
            .push(between(0, 1, lj(0.7, 1.0, 2.1)));
    }
    if more {
        spec.interactions
            .potentials
            .push(between(0, 0, lj(0.2, 0.8, 1.9)));
    }
    spec.interactions.mixing = mixing;
    spec.run.schedule.time_step = TimeStep::Fixed(1e-3);
    spec.run.schedule.force_unstable = true;
    spec
}

#[test]
fn kinds_sums_and_molecules_have_the_same_bits_on_any_number_of_ranks() {
    let bonds: Vec<u32> = (0..1000).filter(|n| n % 10 < 9).collect();
    let terms = |form: u32, length: u32| {
        let chains = bonds.iter().filter(move |n| *n % 10 + length < 11);
        chains.map(move |n| BondedTerm {
            form,
            points: [0, 1, 2, 3].map(|k| if k < length { n + k } else { 0 }),
        })
    };
    let bonded = BondedSpec {
        forms: vec![
            Form::HarmonicBond {
                stiffness: 20.0,
                length: 1.05,
            },
            Form::HarmonicAngle {
                stiffness: 2.0,
                angle: 2.0,
            },
        ],
        terms: terms(0, 2).chain(terms(1, 3)).collect(),
        special: [0.3, 0.0, 0.5],
    };
    for (name, more, mixing, bonded) in [
        ("pairs of kinds", false, None, None),
        ("mixed", false, Some(Mixing::Arithmetic), None),
        ("sums", true, None, None),
        ("molecules", false, None, Some(bonded.clone())),
        ("molecules and sums", true, None, Some(bonded)),
    ] {
        let mut spec = mixed(more, mixing);
        spec.title = name.into();
        spec.interactions.bonded = bonded.map(Arc::new);
        thrown(&mut spec, 25.0);
        same(&spec, &[2]);
        // as fast as they are by chance, and as slow as they must be
        spec.title = format!("{name}, warm");
        spec.loading.initial.clear();
        spec.loading.thermal = Some(ThermalSpec {
            energy: e("0.7 + 0.02*x"),
            seed: 3,
        });
        spec.run.schedule.time_step = TimeStep::Auto;
        spec.run.schedule.force_unstable = false;
        same(&spec, &[2]);
    }
}

#[test]
fn atoms_in_equilibrium_have_the_same_bits_on_any_number_of_ranks() {
    let [silicon, .., carbide] = &many_body()[..] else {
        panic!("several");
    };
    let all = potentials();
    let of = |name: &str| &all.iter().find(|(n, _)| n == name).unwrap().1;
    let family = FamilyChoice::Neighbours;
    let specs = [
        atoms(
            LatticeKind::Triangular,
            25,
            of("morse, shifted force"),
            family,
            true,
        ),
        atoms(LatticeKind::Fcc, 7, of("eam, table"), family, true),
        crystal(&silicon.1, silicon.2, 1, 4, true),
        crystal(&carbide.1, carbide.2, 2, 4, true),
    ];
    // the last is not stable where Newton's method would look
    let methods = [
        Method::Newton,
        Method::Fire,
        Method::Newton,
        Method::Relaxation,
    ];
    for (n, (mut spec, method)) in specs.into_iter().zip(methods).enumerate() {
        spec.title = format!("{n} {method:?}");
        spec.sets.push(SetSpec {
            name: "held".into(),
            members: Members::Where(e("x < 1.3")),
        });
        spec.loading.conditions = vec![ConditionSpec {
            set: "held".into(),
            kind: ConditionKind::Displacement(std::array::from_fn(|a| {
                (a < spec.space.dimension).then(|| e(["0.001*t", "0.002*t", "0"][a]))
            })),
        }];
        spec.run.schedule = Schedule {
            steps: 2,
            time_step: TimeStep::Fixed(0.5),
            force_unstable: false,
            stepper: Stepper::Statics(Statics {
                method,
                timed: true,
                tolerance: 1e-4,
                ..Statics::default()
            }),
        };
        same(&spec, &[2]);
    }
}
