//! The same bits in every width and on any number of threads, little memory and no allocation.

use crate::allocations;
use crate::case::*;
use peridyne::body::{view, view_mut, zeros};
use peridyne::execute::simd::Simd;
use peridyne::family::horizon::HorizonList;
use peridyne::interaction::pairs::{BondConstants, BondTable};
use peridyne::interaction::{Interaction, PointConstants, PointEnergies, Sweep, Toughness};
use peridyne::law::Law;
use peridyne::law::solid::bond_based::{BondBased, BondBasedMixed};
use peridyne::law::solid::eam_like::{EamLike, Solid};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{BondMixing, Breakage, Influence};
use std::sync::Arc;

/// Everything that a few breaking steps leave behind.
fn trace<W: Law>(law: W, constants: PointConstants, simd: Simd, threads: usize) -> Vec<u64> {
    trace_of_pairs(law, constants, simd, threads, Arc::default())
}

fn trace_of_pairs<W: Law>(
    law: W,
    constants: PointConstants,
    simd: Simd,
    threads: usize,
    pairs: Arc<BondTable>,
) -> Vec<u64> {
    let case = Case {
        influence: Influence::Inverse,
        materials: true,
        ..Case::new(LatticeKind::Cubic, 3, [17, 11, 9])
    };
    let case = case.contact().breaking();
    let body = case.perturbed_cloud();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut it = case.list_of_pairs(&body, law, constants, simd, pairs);
        let mut bits = vec![];
        let mut f = zeros(body.len());
        for step in 0..3 {
            let u = displace(&body, case.amplitude * (step as f64 + 0.05), step);
            let tally = it.forces(
                &body,
                view(&u),
                view_mut(&mut f),
                Sweep::Evolve {
                    v: view(&displace(&body, case.amplitude, step + 7)),
                    steps: [0.3; 2],
                    breakage: [Breakage::AfterForce, Breakage::BeforeForce][step as usize % 2],
                },
                None,
            );
            assert_eq!(tally.broken > 0, step > 0);
            bits.extend([tally.broken, tally.lost.value().to_bits()]);
            bits.extend(f.iter().flatten().map(|x| x.to_bits()));
            let mut seen = PointEnergies::default();
            it.observe(&body, view(&u), &mut seen.for_slots(body.len()));
            bits.extend(seen.strain.iter().map(|x| x.to_bits()));
            let (alive, critical) = it.memory();
            bits.extend(alive.iter().map(|b| *b as u64));
            bits.extend(critical.iter().map(|x| x.to_bits()));
        }
        bits
    })
}

#[test]
fn every_width_and_number_of_threads_gives_the_same_bits() {
    let solids = lps(3).to_vec();
    let solid = EamLike {
        ratio: solids[0].ratio(),
    };
    let mixed = BondBasedMixed {
        rule: BondMixing::Arithmetic,
    };
    let both = |simd, threads| {
        let per = PointConstants::PerMaterial(vec![1.0, 2.0]);
        let eam = PointConstants::Solid(solids.clone());
        // unlike in everything
        let pair = |n: usize, volume: f64| BondConstants {
            horizon: [1.0, 0.8, 0.8, 0.9][n] * 3.0 * H,
            stiffness: [1.0, 0.6, 0.6, 2.0][n],
            volume,
            toughness: Toughness {
                s00: [0.02, 0.01, 0.01, 0.03][n],
                alpha: [0.25, 0.0, 0.0, 0.5][n],
            },
        };
        let table = |volume: [f64; 4]| {
            let pairs = (0..4).map(|n| pair(n, volume[n])).collect();
            Arc::new(BondTable::new(2, pairs, Some(H)))
        };
        let unit = Solid {
            n: 3.0,
            kappa: 1.0,
            beta: 1.0,
        };
        let units = PointConstants::Solid(vec![unit; 2]);
        let law = EamLike {
            ratio: unit.ratio(),
        };
        let volumes = table([0.3, 0.3, 0.7, 0.7]);
        let bond = BondBased { c: 1.0 };
        [
            trace(mixed, per, simd, threads),
            trace(solid, eam, simd, threads),
            trace_of_pairs(bond, PointConstants::None, simd, threads, table([0.0; 4])),
            trace_of_pairs(law, units, simd, threads, volumes),
        ]
    };
    let first = both(Simd::detect(), 1);
    for simd in Simd::available() {
        for threads in [1, 3] {
            let same = both(simd, threads) == first;
            assert!(same, "{} on {threads} threads", simd.name());
        }
    }
}

#[test]
fn forces_allocate_nothing_and_a_bond_takes_eight_bytes() {
    let case = Case::new(LatticeKind::Cubic, 3, [30, 30, 30]).breaking();
    let body = case.perturbed_cloud();
    let list = HorizonList::new(&body, case.delta()).unwrap();
    let stored = (list.bytes() + list.line_count()) as f64 / list.directed() as f64;
    assert!(stored < 5.5, "{stored} bytes per bond in the list");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        let solid = lps(3)[0];
        let law = EamLike {
            ratio: solid.ratio(),
        };
        let constants = PointConstants::Solid(vec![solid]);
        let mut it = case.list(&body, law, constants, Simd::detect());
        let bytes = it.bytes() as f64 / it.directed_bonds() as f64;
        assert!(bytes <= 8.0, "{bytes} bytes per bond in all");
        let mut f = zeros(body.len());
        let u = displace(&body, case.amplitude, 3);
        let still = zeros(body.len());
        let evolve = Sweep::Evolve {
            v: view(&still),
            steps: [0.0; 2],
            breakage: Breakage::AfterForce,
        };
        it.forces(&body, view(&u), view_mut(&mut f), evolve, None);
        let before = allocations();
        it.forces(&body, view(&u), view_mut(&mut f), evolve, None);
        assert_eq!(allocations(), before);
    });
}

/// Where all pairs have the constants of one material, a table says what the law says.
#[test]
fn a_table_of_equal_pairs_is_the_law() {
    let case = Case {
        influence: Influence::Inverse,
        materials: true,
        ..Case::new(LatticeKind::Cubic, 3, [9, 8, 7])
    };
    let case = case.contact().breaking();
    let body = case.perturbed_cloud();
    let simd = Simd::detect();
    let solid = lps(3)[0];
    let toughness = Toughness {
        s00: 0.02,
        alpha: 0.25,
    };
    let case = Case {
        toughness: vec![toughness],
        ..case
    };
    let table = |stiffness: f64, volume: f64| {
        let pair = BondConstants {
            horizon: case.delta(),
            stiffness,
            volume,
            toughness,
        };
        Arc::new(BondTable::new(2, vec![pair; 4], Some(H)))
    };
    let unit = Solid {
        kappa: 1.0,
        beta: 1.0,
        ..solid
    };
    let law = EamLike {
        ratio: solid.ratio(),
    };
    let units = EamLike {
        ratio: unit.ratio(),
    };
    let (one, all) = (
        PointConstants::Solid(vec![solid; 2]),
        PointConstants::Solid(vec![unit; 2]),
    );
    let (bond, none) = (BondBased { c: 7.0 }, PointConstants::None);
    let mut pairs: [[Box<dyn Interaction<3>>; 2]; 2] = [
        [
            Box::new(case.list(&body, bond, none.clone(), simd)),
            Box::new(case.list_of_pairs(&body, BondBased { c: 1.0 }, none, simd, table(7.0, 0.0))),
        ],
        [
            Box::new(case.list(&body, law, one, simd)),
            Box::new(case.list_of_pairs(&body, units, all, simd, table(solid.beta, solid.kappa))),
        ],
    ];
    for [plain, paired] in &mut pairs {
        for step in 0..3 {
            let u = displace(&body, case.amplitude * (step as f64 + 0.05), step);
            let v = displace(&body, case.amplitude, step + 7);
            let evolve = Sweep::Evolve {
                v: view(&v),
                steps: [0.3; 2],
                breakage: Breakage::BeforeForce,
            };
            let mut f = (zeros(body.len()), zeros(body.len()));
            let a = plain.forces(&body, view(&u), view_mut(&mut f.0), evolve, None);
            let b = paired.forces(&body, view(&u), view_mut(&mut f.1), evolve, None);
            assert_eq!(a.broken, b.broken);
            assert!((a.lost.value() - b.lost.value()).abs() <= 1e-12 * a.lost.value().abs());
            let (all, energy) = (
                plain.energy(&body, view(&u)),
                paired.energy(&body, view(&u)),
            );
            assert!((all[0] - energy[0]).abs() <= 1e-13 * all[0]);
            for axis in 0..3 {
                let (a, b) = (by_id(&body, &f.0[axis]), by_id(&body, &f.1[axis]));
                let largest = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                for (a, b) in a.iter().zip(&b) {
                    assert!((a - b).abs() <= 1e-13 * largest, "{a} {b}");
                }
            }
        }
        assert_eq!(plain.memory().0, paired.memory().0);
    }
}
