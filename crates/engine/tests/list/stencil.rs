//! A list over the points of a lattice is the lattice's stencil.

use crate::case::*;
use peridyne::body::{Body, Field, view, view_mut, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::volume_fraction;
use peridyne::interaction::stencil::{StencilInteraction, StencilParts};
use peridyne::interaction::{
    BondForce, BondStatus, Interaction, PointConstants, PointEnergies, Sweep, Tally,
};
use peridyne::law::Law;
use peridyne::law::influence::influence;
use peridyne::law::solid::bond_based::{BondBased, BondBasedMixed};
use peridyne::law::solid::eam_like::EamLike;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{BondMixing, Breakage, CrackKind, Influence};
use std::collections::BTreeSet;

/// Bonds as pairs of ids, and whether they are whole.
fn bonds<const D: usize>(
    body: &Body<D>,
    it: &dyn Interaction<D>,
) -> BTreeSet<(usize, usize, bool)> {
    let mut id = vec![usize::MAX; body.len()];
    for (n, s) in body.slots().iter().enumerate() {
        id[*s as usize] = n;
    }
    let mut all = BTreeSet::new();
    it.each_bond(body, &mut |i, j, _, state| {
        let (i, j) = (id[i].min(id[j]), id[i].max(id[j]));
        let new = all.insert((i, j, state == BondStatus::Whole));
        assert!(new, "twice: {i}-{j}");
    });
    all
}

/// Energies seen along with the forces are those of `observe`, and the forces are the same bits.
fn watching_changes_nothing<const D: usize>(
    it: &mut impl Interaction<D>,
    body: &Body<D>,
    u: &Field<D>,
) {
    let (mut f, mut g) = (zeros(body.len()), zeros(body.len()));
    let (mut seen, mut observed) = (PointEnergies::default(), PointEnergies::default());
    it.forces(body, view(u), view_mut(&mut f), Sweep::Hold, None);
    it.observe(body, view(u), &mut observed.for_slots(body.len()));
    it.forces(
        body,
        view(u),
        view_mut(&mut g),
        Sweep::Hold,
        Some(&mut seen.for_slots(body.len())),
    );
    for a in 0..D {
        assert!(by_id(body, &f[a]) == by_id(body, &g[a]), "axis {a}");
    }
    assert!(seen.strain.iter().any(|e| *e > 0.0));
    assert!(seen.strain == observed.strain, "strain");
    assert!(seen.repulsion == observed.repulsion, "repulsion");
    assert!(seen.dilatation == observed.dilatation, "dilatation");
}

fn same_as_stencil<const D: usize, W: Law>(
    case: &Case<D>,
    law: W,
    constants: PointConstants,
) -> Tally {
    let body = case.body();
    let cloud = body.to_cloud().unwrap();
    let weight = |xi: &[f64; D], r0: f64| {
        influence(case.influence, xi, r0, case.delta()) * volume_fraction(r0, case.delta(), H)
    };
    let mut stencil = StencilInteraction::new(StencilParts {
        body: &body,
        stencil: &case.stencil(),
        law,
        weight: &weight,
        point_constants: constants.clone(),
        toughness: case.toughness.clone(),
        repulsion: case.repulsion.clone(),
        simd: Simd::detect(),
    });
    let mut list = case.list(&cloud, law, constants, Simd::detect());
    assert_eq!(stencil.directed_bonds(), list.directed_bonds());
    // a crack that ends inside, its tip absent, the rest broken
    for (kind, from, to) in [
        (CrackKind::Excluded, 2.2, 3.2),
        (CrackKind::Broken, 0.5, 2.2),
    ] {
        let crosses = |a: [f64; D], b: [f64; D]| {
            let x = (0.13 + 0.5 * case.cells[0] as f64) * H;
            let last = 0.5 * (a[D - 1] + b[D - 1]) / H;
            let split = a[0].min(b[0]) < x && x < a[0].max(b[0]);
            split && (D == 1 || (from..to).contains(&last))
        };
        let before = list.directed_bonds();
        let cut = list.cut(&cloud, kind, &crosses);
        assert_eq!(stencil.cut(&body, kind, &crosses), cut);
        assert!(cut > 0 || (D == 1 && kind == CrackKind::Broken));
        let absent = (kind == CrackKind::Excluded) as u64 * cut;
        assert_eq!(list.directed_bonds(), before - absent);
    }
    stencil.prepare(&body);
    list.prepare(&cloud);
    let mut total = Tally::default();
    let mut f = (zeros(body.len()), zeros(cloud.len()));
    for step in 0..4 {
        let amplitude = case.amplitude * (1.0 + 0.5 * step as f64);
        let breakage = [Breakage::BeforeForce, Breakage::AfterForce][step as usize % 2];
        let u = (
            displace(&body, amplitude, step),
            displace(&cloud, amplitude, step),
        );
        watching_changes_nothing(&mut stencil, &body, &u.0);
        watching_changes_nothing(&mut list, &cloud, &u.1);
        let a = stencil.forces(
            &body,
            view(&u.0),
            view_mut(&mut f.0),
            Sweep::Evolve {
                v: view(&displace(&body, case.amplitude, step + 7)),
                steps: [0.3; 2],
                breakage,
            },
            None,
        );
        let b = list.forces(
            &cloud,
            view(&u.1),
            view_mut(&mut f.1),
            Sweep::Evolve {
                v: view(&displace(&cloud, case.amplitude, step + 7)),
                steps: [0.3; 2],
                breakage,
            },
            None,
        );
        for axis in 0..D {
            let (a, b) = (by_id(&body, &f.0[axis]), by_id(&cloud, &f.1[axis]));
            close("force", &a, &b, 1e-13);
        }
        assert_eq!(a.broken, b.broken, "step {step}");
        assert!((a.lost.value() - b.lost.value()).abs() <= 1e-12 * a.lost.value().abs());
        total += b;

        let mut seen = (PointEnergies::default(), PointEnergies::default());
        stencil.observe(&body, view(&u.0), &mut seen.0.for_slots(body.len()));
        list.observe(&cloud, view(&u.1), &mut seen.1.for_slots(cloud.len()));
        for (what, a, b) in [
            ("strain", &seen.0.strain, &seen.1.strain),
            ("repulsion", &seen.0.repulsion, &seen.1.repulsion),
            ("dilatation", &seen.0.dilatation, &seen.1.dilatation),
        ] {
            close(what, &by_id(&body, a), &by_id(&cloud, b), 2e-13);
        }
        let repelled = seen.1.repulsion.iter().any(|e| *e > 0.0);
        assert_eq!(repelled, case.repulsion.is_some());
        // what single bonds do adds up to what all do
        let mut held = (zeros(body.len()), zeros(cloud.len()));
        stencil.forces(&body, view(&u.0), view_mut(&mut held.0), Sweep::Hold, None);
        list.forces(&cloud, view(&u.1), view_mut(&mut held.1), Sweep::Hold, None);
        let mut summed = (zeros(body.len()), zeros(cloud.len()));
        let add = |sum: &mut Field<D>, bond: BondForce<D>| {
            for a in 0..D {
                sum[a][bond.i] += bond.force[a];
            }
        };
        assert!(stencil.each_force(&body, view(&u.0), &mut |bond| add(&mut summed.0, bond)));
        assert!(list.each_force(&cloud, view(&u.1), &mut |bond| add(&mut summed.1, bond)));
        for axis in 0..D {
            let (a, b) = (by_id(&body, &summed.0[axis]), by_id(&body, &held.0[axis]));
            close("forces of the stencil's bonds", &a, &b, 1e-12);
            let (a, b) = (by_id(&cloud, &summed.1[axis]), by_id(&cloud, &held.1[axis]));
            close("forces of the list's bonds", &a, &b, 1e-12);
        }
        let mut damage = (vec![0.0; body.len()], vec![0.0; cloud.len()]);
        stencil.damage(&body, &mut damage.0);
        list.damage(&cloud, &mut damage.1);
        let (a, b) = (by_id(&body, &damage.0), by_id(&cloud, &damage.1));
        close("damage", &a, &b, 1e-14);
        let mut critical = [vec![], vec![]];
        let known = [
            stencil.read_column(&body, view(&u.0), "critical_stretch", &mut critical[0]),
            list.read_column(&cloud, view(&u.1), "critical_stretch", &mut critical[1]),
        ];
        assert_eq!(known[0], known[1]);
        for (g, c) in body.slots().iter().zip(cloud.slots()) {
            let (g, c) = (*g as usize, *c as usize);
            assert_eq!(stencil.family_size(&body, g), list.family_size(&cloud, c));
            if known[0] {
                let (a, b) = (critical[0][g], critical[1][c]);
                assert!(a == b || (a - b).abs() <= 1e-14, "{a} {b}");
            }
        }
    }
    let (a, b) = (bonds(&body, &stencil), bonds(&cloud, &list));
    let different: Vec<_> = a.symmetric_difference(&b).take(9).collect();
    assert!(
        different.is_empty(),
        "{different:?} of {} {}",
        a.len(),
        b.len()
    );
    for id in 1..body.points() {
        let pair = |b: &Body<D>| (b.slots()[0] as usize, b.slots()[id] as usize);
        let ((gi, gj), (ci, cj)) = (pair(&body), pair(&cloud));
        assert_eq!(
            stencil.in_family(&body, gi, gj),
            list.in_family(&cloud, ci, cj)
        );
    }
    total
}

/// PMB, mixed PMB, LPS, mixed LPS: intact and breaking, without and with repulsion.
fn all_laws<const D: usize>(case: Case<D>) {
    let [soft, hard] = lps(D);
    let series = BondBasedMixed {
        rule: BondMixing::Harmonic,
    };
    let solid = EamLike {
        ratio: soft.ratio(),
    };
    for contact in [false, true] {
        for breaking in [false, true] {
            let dress = |materials| {
                let c = Case {
                    materials,
                    ..case.clone()
                };
                let c = if contact { c.contact() } else { c };
                if breaking { c.breaking() } else { c }
            };
            let (plain, mixed) = (dress(false), dress(true));
            let two = PointConstants::PerMaterial(vec![2.0, 5.0]);
            for t in [
                same_as_stencil(&plain, BondBased { c: 2.0 }, PointConstants::None),
                same_as_stencil(&mixed, series, two),
                same_as_stencil(&plain, solid, PointConstants::Solid(vec![soft])),
                same_as_stencil(&mixed, solid, PointConstants::Solid(vec![soft, hard])),
            ] {
                assert_eq!(t.broken > 0, breaking);
            }
        }
    }
}

#[test]
fn list_is_stencil_in_one_dimension() {
    all_laws(Case::new(LatticeKind::Chain, 3, [41]));
    all_laws(Case {
        periodic: [true],
        ..Case::new(LatticeKind::Chain, 4, [23])
    });
}

#[test]
fn list_is_stencil_in_two_dimensions() {
    all_laws(Case {
        influence: Influence::Inverse,
        ..Case::new(LatticeKind::Square, 3, [13, 11])
    });
    all_laws(Case {
        periodic: [false, true],
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Triangular, 2, [9, 7])
    });
}

#[test]
fn list_is_stencil_in_three_dimensions() {
    all_laws(Case {
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Cubic, 3, [9, 8, 7])
    });
    all_laws(Case {
        periodic: [true, false, true],
        influence: Influence::Inverse,
        ..Case::new(LatticeKind::Fcc, 1, [4, 4, 4])
    });
    all_laws(Case {
        influence: Influence::Gaussian,
        ..Case::new(LatticeKind::Diamond, 1, [3, 4, 5])
    });
}

/// These vanish at the horizon, where round-off would decide alone about points with no other bonds left: intact only.
#[test]
fn list_is_stencil_with_fading_influence() {
    for influence in [Influence::Linear, Influence::CubicSpline] {
        let case = Case {
            influence,
            ..Case::new(LatticeKind::Cubic, 3, [8, 6, 7])
        };
        let [solid, _] = lps(3);
        let law = EamLike {
            ratio: solid.ratio(),
        };
        same_as_stencil(&case, BondBased { c: 2.0 }, PointConstants::None);
        same_as_stencil(&case, law, PointConstants::Solid(vec![solid]));
    }
}
