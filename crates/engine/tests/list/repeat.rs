//! The same bits in every width and on any number of threads, little memory and no allocation.

use crate::allocations;
use crate::case::*;
use peridyne::body::zeros;
use peridyne::execute::simd::Simd;
use peridyne::family::horizon::HorizonList;
use peridyne::interaction::{Interaction, PointConstants, PointEnergies, Sweep};
use peridyne::law::Law;
use peridyne::law::solid::bond_based::BondBasedMixed;
use peridyne::law::solid::eam_like::EamLike;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::{Influence, InterfaceRule, Release};

/// Everything that a few breaking steps leave behind.
fn trace<W: Law>(law: W, constants: PointConstants, simd: Simd, threads: usize) -> Vec<u64> {
    let case = Case {
        influence: Influence::Inverse,
        materials: true,
        ..Case::new(LatticeKind::Cubic, 3, [17, 11, 9])
    };
    let case = case.contact().breaking();
    let body = case.perturbed_cloud();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut it = case.list(&body, law, constants, simd);
        let mut bits = vec![];
        let mut f = zeros(body.len);
        for step in 0..3 {
            let u = displace(&body, case.amplitude * (step as f64 + 0.05), step);
            let tally = it.forces(
                &body,
                &u,
                &mut f,
                Sweep::Evolve {
                    v: &displace(&body, case.amplitude, step + 7),
                    dt: 0.3,
                    release: [Release::AfterForce, Release::AtOnce][step as usize % 2],
                },
                None,
            );
            assert_eq!(tally.broken > 0, step > 0);
            bits.extend([tally.broken, tally.released.to_bits()]);
            bits.extend(f.iter().flatten().map(|x| x.to_bits()));
            let mut seen = PointEnergies::default();
            it.observe(&body, &u, &mut seen);
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
        rule: InterfaceRule::Parallel,
    };
    let both = |simd, threads| {
        let per = PointConstants::PerMaterial(vec![1.0, 2.0]);
        let eam = PointConstants::Solid(solids.clone());
        (
            trace(mixed, per, simd, threads),
            trace(solid, eam, simd, threads),
        )
    };
    let portable = both(Simd::Portable, 1);
    for simd in Simd::available() {
        for threads in [1, 3] {
            let same = both(simd, threads) == portable;
            assert!(same, "{} on {threads} threads", simd.name());
        }
    }
}

#[test]
fn forces_allocate_nothing_and_a_bond_takes_eight_bytes() {
    let case = Case::new(LatticeKind::Cubic, 3, [30, 30, 30]).breaking();
    let body = case.perturbed_cloud();
    let list = HorizonList::new(&body, case.delta()).unwrap();
    let stored = (list.bytes() + list.present.len()) as f64 / list.directed as f64;
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
        let mut f = zeros(body.len);
        let u = displace(&body, case.amplitude, 3);
        let still = zeros(body.len);
        let evolve = Sweep::Evolve {
            v: &still,
            dt: 0.0,
            release: Release::AfterForce,
        };
        it.forces(&body, &u, &mut f, evolve, None);
        let before = allocations();
        it.forces(&body, &u, &mut f, evolve, None);
        assert_eq!(allocations(), before);
    });
}
