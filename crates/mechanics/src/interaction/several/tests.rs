use super::*;
use crate::body::{view, zeros};
use crate::execute::simd::Simd;
use crate::family::horizon::HorizonList;
use crate::interaction::atoms::bonded::BondedAtoms;
use crate::interaction::atoms::current::CurrentAtoms;
use crate::interaction::list::{ListInteraction, ListParts};
use crate::interaction::micromoduli::MicromoduliInteraction;
use crate::interaction::weight::BondWeight;
use crate::interaction::{PointConstants, PointEnergies};
use crate::law::potential::cut::{Cut, Ends};
use crate::law::potential::lennard_jones::LennardJones;
use crate::law::potential::mixture::Mixture;
use crate::law::solid::bond_based::BondBased;
use crate::spec::{BondedSpec, End, Influence, LinearBody};
use std::sync::Arc;

type Bonds = Option<Box<dyn Interaction<3>>>;

/// Two points along x.
fn pair(at: f64) -> Body<3> {
    let x = [[at, 0.0, 0.0], [at + 1.0, 0.0, 0.0]];
    Body::from_cloud(&x, &[1.0; 2], &[], 1.0, [None; 3]).unwrap()
}

/// A spring that pulls unlike at its ends (force density / length).
fn springs(body: &Body<3>, ends: [f64; 2]) -> Bonds {
    let linear = LinearBody::<3> {
        position: vec![[0.0; 3], [1.0, 0.0, 0.0]],
        volume: vec![1.0; 2],
        density: vec![1.0; 2],
        period: [None; 3],
        start: vec![0, 1, 2],
        partner: vec![1, 0],
        block: ends
            .map(|c| {
                crate::array::from_fn(|a| crate::array::from_fn(|b| if a == b { c } else { 0.0 }))
            })
            .to_vec(),
        load_map: None,
        mass: None,
    };
    Some(Box::new(MicromoduliInteraction::new(
        body,
        &linear,
        Simd::detect(),
    )))
}

fn atoms(body: &Body<3>) -> Box<dyn Interaction<3>> {
    let (epsilon, sigma) = (1.0, 1.0);
    let ends = Ends {
        cutoff: 2.5,
        end: End::Smooth(2.0),
    };
    let potential = Cut::new(LennardJones { epsilon, sigma }, ends);
    Box::new(CurrentAtoms::new(
        body,
        Mixture::one(potential),
        Simd::detect(),
    ))
}

fn side_by_side(bonds: [fn(&Body<3>) -> Bonds; 3]) -> (Body<3>, MultiBodyInteraction<3>) {
    let bodies = [0.0, 10.0, 20.0].map(pair);
    let own = bodies.iter().zip(bonds).map(|(body, of)| of(body));
    let own = own.collect();
    let body = Body::several(bodies.to_vec());
    let made = MultiBodyInteraction::new(&body, own, vec![]);
    (body, made)
}

const UNLIKE: fn(&Body<3>) -> Bonds = |b| springs(b, [1.0, 3.0]);
const ALIKE: fn(&Body<3>) -> Bonds = |b| springs(b, [5.0, 5.0]);
const ATOMS: fn(&Body<3>) -> Bonds = |b| Some(atoms(b));
const LOOSE: fn(&Body<3>) -> Bonds = |_| None;

/// Each sweeps over its own part of the columns, and what was there before does not matter.
#[test]
fn each_has_its_part_of_the_columns() {
    let (body, mut it) = side_by_side([UNLIKE, LOOSE, ALIKE]);
    let slots: Vec<usize> = body.slots.iter().map(|s| *s as usize).collect();
    let mut u = body.at_rest();
    for (slot, moved) in slots.iter().zip([0.1, 0.4, 7.0, 9.0, -0.2, 0.6]) {
        u[0][*slot] = moved;
    }
    let mut f = zeros::<3>(body.len);
    let mut energies = PointEnergies::default();
    let mut seen = energies.for_slots(body.len);
    for slot in &slots {
        f[0][*slot] = f64::NAN;
        seen.strain[*slot] = f64::NAN;
    }
    let watch = Some(&mut seen);
    it.forces(&body, view(&u), view_mut(&mut f), Sweep::Hold, watch);
    // C (u_j − u_i), and ½ of ½ C η² at either end
    let pulls = [0.3, -0.9, 0.0, 0.0, 4.0, -4.0];
    let stored = [0.0225, 0.0675, 0.0, 0.0, 0.8, 0.8];
    for (n, slot) in slots.iter().enumerate() {
        assert!(
            (f[0][*slot] - pulls[n]).abs() < 1e-14,
            "{n}: {}",
            f[0][*slot]
        );
        let strain = energies.strain[*slot];
        assert!((strain - stored[n]).abs() < 1e-14, "{n}: {strain}");
    }
    let [strain, _] = it.energy(&body, view(&u));
    assert!((strain - stored.iter().sum::<f64>()).abs() < 1e-14);
}

#[test]
fn action_is_as_far_from_reaction_as_in_the_worst() {
    // (3 − 1)/3
    let (_, it) = side_by_side([ALIKE, UNLIKE, LOOSE]);
    assert_eq!(it.asymmetry(), 2.0 / 3.0);
    let (_, it) = side_by_side([ALIKE, ATOMS, LOOSE]);
    assert_eq!(it.asymmetry(), 0.0);
}

#[test]
fn atoms_alone_are_a_potential() {
    for (bonds, potential) in [
        ([ATOMS, LOOSE, ATOMS], true),
        ([ATOMS, ALIKE, LOOSE], false),
        ([LOOSE, LOOSE, LOOSE], false),
    ] {
        let (_, it) = side_by_side(bonds);
        assert_eq!((it.is_potential(), it.has_many_body()), (potential, false));
    }
}

#[test]
fn one_with_angles_has_terms_of_three() {
    let molecules: fn(&Body<3>) -> Bonds = |body| {
        let spec = BondedSpec {
            forms: vec![],
            terms: vec![],
            special: [0.0; 3],
        };
        let none = Box::new(|_: [usize; 2], _: f64| None);
        let simd = Simd::detect();
        let made = BondedAtoms::new(atoms(body), body, Arc::new(spec), none, simd);
        Some(Box::new(made))
    };
    let (_, it) = side_by_side([ATOMS, molecules, LOOSE]);
    assert!(it.has_many_body() && it.is_potential());
}

/// Between points at 0 and 1 and those at 2 and 3 two bonds are absent and the third is broken: of one whole bond and it half is lost.
#[test]
fn absent_bonds_between_bodies_are_no_damage() {
    let bodies = [0.0, 2.0].map(pair);
    let own = bodies.iter().map(|b| springs(b, [1.0; 2])).collect();
    let body = Body::several(bodies.to_vec());
    let place: Vec<[f64; 3]> = (0..4).map(|n| [f64::from(n), 0.0, 0.0]).collect();
    let cloud = Body::<3>::from_cloud(&place, &[1.0; 4], &[], 1.0, [None; 3]).unwrap();
    let side = |slot: usize| cloud.position(slot)[0] < 1.5;
    let across = |i, j| if side(i) == side(j) { 0.0 } else { 2.1 };
    let mut bonds = ListInteraction::new(ListParts {
        body: &cloud,
        list: HorizonList::within(&cloud, 2.1, across).unwrap(),
        law: BondBased { c: 1.0 },
        weight: BondWeight::new(Influence::Constant, 2.1, None),
        point_constants: PointConstants::None,
        toughness: vec![],
        repulsion: None,
        simd: Simd::detect(),
    });
    let long = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).abs() > 1.5;
    assert_eq!(bonds.cut(&cloud, CrackKind::Excluded, &long), 4);
    let interface = Interface::new(&body, cloud, body.slots.clone(), Box::new(bonds));
    let mut it = MultiBodyInteraction::new(&body, own, vec![interface]);
    // that of the springs does not break
    assert_eq!(it.cut(&body, CrackKind::Broken, &|_, _| true), 2);
    it.prepare(&body);
    let mut damage = vec![f64::NAN; body.len];
    it.damage(&body, &mut damage);
    let of: Vec<f64> = body.slots.iter().map(|s| damage[*s as usize]).collect();
    assert_eq!(of, [0.0, 0.5, 0.5, 0.0]);
}
