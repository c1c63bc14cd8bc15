//! Bits of bonds of lists and stencils: what cracks take away, what heals, columns and states.

use peridyne::body::{Body, view};
use peridyne::execute::simd::Simd;
use peridyne::family::horizon::HorizonList;
use peridyne::family::stencil::Stencil;
use peridyne::interaction::list::{ListInteraction, ListParts};
use peridyne::interaction::stencil::{StencilInteraction, StencilParts};
use peridyne::interaction::weight::BondWeight;
use peridyne::interaction::{BondStatus, Interaction, PointConstants, Toughness};
use peridyne::law::solid::bond_based::BondBased;
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::spec::{CrackKind, Horizon, Influence};
use peridyne::state::Archive;

const POINTS: usize = 20;
/// Neighbours and next neighbours of a chain, in both directions.
const BONDS: usize = 2 * (POINTS - 1 + POINTS - 2);
/// One bond to a neighbour and two to next neighbours cross a place between two points, in both directions.
const ACROSS: usize = 6;

type Bonds = Box<dyn Interaction<1>>;

fn toughness() -> Vec<Toughness> {
    vec![Toughness {
        s00: 0.1,
        alpha: 0.0,
    }]
}

fn cloud() -> Body<1> {
    let points: Vec<[f64; 3]> = (0..POINTS).map(|n| [n as f64, 0.0, 0.0]).collect();
    Body::<1>::from_cloud(&points, &[1.0; POINTS], &[], 1.0, [None]).unwrap()
}

fn of_list(body: &Body<1>) -> Bonds {
    Box::new(ListInteraction::new(ListParts {
        body,
        list: HorizonList::new(body, 2.0 * (1.0 + 1e-9)).unwrap(),
        law: BondBased { c: 1.0 },
        weight: BondWeight::new(Influence::Constant, 2.0, None),
        point_constants: PointConstants::None,
        toughness: toughness(),
        repulsion: None,
        simd: Simd::detect(),
    }))
}

fn stencil() -> Stencil {
    Stencil::new(LatticeKind::Chain, 1.0, Horizon::Ratio(2))
}

fn lattice() -> Body<1> {
    let sites: Vec<[i32; 3]> = (0..POINTS as i32).map(|n| [4 * n, 0, 0]).collect();
    let chain = Lattice {
        kind: LatticeKind::Chain,
        spacing: 1.0,
        origin: [0.0; 3],
    };
    Body::<1>::on_lattice(chain, &sites, stencil().reach(), [false], 1.0).unwrap()
}

fn of_stencil(body: &Body<1>) -> Bonds {
    Box::new(StencilInteraction::new(StencilParts {
        body,
        stencil: &stencil(),
        law: BondBased { c: 1.0 },
        weight: &|_, _| 1.0,
        point_constants: PointConstants::None,
        toughness: toughness(),
        repulsion: None,
        simd: Simd::detect(),
    }))
}

/// The same chain as a cloud and as a lattice, and what makes bonds of each.
fn chains() -> [(Body<1>, fn(&Body<1>) -> Bonds); 2] {
    [(cloud(), of_list), (lattice(), of_stencil)]
}

/// An absent crack between points 4 and 5, a broken one between 9 and 10.
fn cracked(body: &Body<1>, mut it: Bonds) -> Bonds {
    for (kind, place) in [(CrackKind::Excluded, 4.5), (CrackKind::Broken, 9.5)] {
        let crosses = |a: [f64; 1], b: [f64; 1]| (a[0] < place) != (b[0] < place);
        assert_eq!(it.cut(body, kind, &crosses), ACROSS as u64);
    }
    it.prepare(body);
    it
}

fn damage(body: &Body<1>, it: &dyn Interaction<1>) -> Vec<f64> {
    let mut damage = vec![f64::NAN; body.len()];
    it.damage(body, &mut damage);
    let slots = body.slots().iter();
    slots.map(|s| damage[*s as usize]).collect()
}

fn whole(body: &Body<1>, it: &dyn Interaction<1>) -> Vec<f64> {
    let mut values = vec![];
    assert!(it.read_column(body, view(&body.at_rest()), "whole", &mut values));
    values
}

/// Points near the broken crack miss one or two of four bonds, those near the absent one miss none.
fn expected() -> Vec<f64> {
    let mut damage = vec![0.0; POINTS];
    for (id, part) in [(8, 0.25), (9, 0.5), (10, 0.5), (11, 0.25)] {
        damage[id] = part;
    }
    damage
}

#[test]
fn what_is_broken_heals_and_what_is_absent_does_not() {
    for (body, bonds) in chains() {
        let mut it = cracked(&body, bonds(&body));
        let left = BONDS - ACROSS;
        assert_eq!(it.directed_bonds() as usize, left);
        let size = |id: usize| it.family_size(&body, body.slots()[id] as usize);
        assert_eq!([0, 1, 3, 4, 9].map(size), [2, 3, 3, 2, 4]);
        assert_eq!(damage(&body, &*it), expected());
        let u = body.at_rest();
        // no bond is stretched
        assert_eq!(it.mend(&body, view(&u), &|_, _, e| e != 0.0), Some(0));
        let all = it.mend(&body, view(&u), &|_, _, _| true);
        assert_eq!(all, Some(ACROSS as u64));
        assert_eq!(it.mend(&body, view(&u), &|_, _, _| true), Some(0));
        assert_eq!(damage(&body, &*it), vec![0.0; POINTS]);
        // those of the absent crack still repel, and join nothing
        let (mut broken, mut gone) = (0, 0);
        it.each_broken(&body, &mut |_, _, _| broken += 1);
        it.each_bond(&body, &mut |_, _, _, state| {
            gone += usize::from(state == BondStatus::Absent);
        });
        // from both of their points, and once
        assert_eq!([broken, gone], [ACROSS, ACROSS / 2]);
    }
}

/// Second neighbours and nearer ones, whatever cracks say.
#[test]
fn a_family_has_its_pairs_also_across_cracks() {
    for (body, bonds) in chains() {
        let it = cracked(&body, bonds(&body));
        let slot = |id: usize| body.slots()[id] as usize;
        for a in 0..POINTS {
            for b in (0..POINTS).filter(|b| *b != a) {
                let joined = it.in_family(&body, slot(a), slot(b));
                assert_eq!(joined, a.abs_diff(b) <= 2, "{a} {b}");
            }
        }
    }
}

/// Without absent cracks damage counts what is there, which takes no bits.
#[test]
fn what_damage_counts_is_stored_once_a_crack_is_absent() {
    for (body, bonds) in chains() {
        let mut it = bonds(&body);
        let crosses = |place: f64| move |a: [f64; 1], b: [f64; 1]| (a[0] < place) != (b[0] < place);
        let before = it.bytes();
        it.cut(&body, CrackKind::Broken, &crosses(9.5));
        assert_eq!(it.bytes(), before);
        // nothing lies there
        assert_eq!(it.cut(&body, CrackKind::Excluded, &crosses(-0.5)), 0);
        assert_eq!(it.bytes(), before);
        it.cut(&body, CrackKind::Excluded, &crosses(4.5));
        assert_eq!(it.bytes(), before + it.memory().0.len());
    }
}

#[test]
fn columns_of_bonds_are_in_order_of_slots_without_what_is_absent() {
    for (body, bonds) in chains() {
        let mut it = cracked(&body, bonds(&body));
        let mut ids = vec![usize::MAX; body.len()];
        for (id, s) in body.slots().iter().enumerate() {
            ids[*s as usize] = id;
        }
        let (values, mut n, mut last) = (whole(&body, &*it), 0, 0);
        it.each_directed(&body, "whole", &mut |i, j, xi| {
            assert!(last <= i);
            last = i;
            let (a, b) = (ids[i], ids[j]);
            assert_eq!(xi[0], b as f64 - a as f64);
            assert!(a.abs_diff(b) <= 2 && (a < 5) == (b < 5));
            assert_eq!(values[n], f64::from((a < 10) == (b < 10)));
            n += 1;
        });
        assert_eq!([n, values.len()], [BONDS - ACROSS; 2]);
        // of another number of bonds nothing is changed
        assert!(!it.write_column(&body, "whole", &[0.0; BONDS]));
        assert_eq!(whole(&body, &*it), values);
        assert!(it.write_column(&body, "whole", &[0.0; BONDS - ACROSS]));
        assert_eq!(damage(&body, &*it), vec![1.0; POINTS]);
        assert!(it.write_column(&body, "whole", &values));
        assert_eq!(damage(&body, &*it), expected());
    }
}

#[test]
fn a_state_knows_which_bonds_are_whole() {
    for (body, bonds) in chains() {
        let mut it = cracked(&body, bonds(&body));
        let mut bytes = vec![];
        let mut saved = Archive::save(&mut bytes);
        it.archive(&body, &mut saved);
        saved.done().unwrap();
        // one whose crack has healed since
        let mut other = cracked(&body, bonds(&body));
        other.mend(&body, view(&body.at_rest()), &|_, _, _| true);
        let mut from = bytes.as_slice();
        let mut loaded = Archive::load(&mut from);
        other.archive(&body, &mut loaded);
        loaded.done().unwrap();
        assert!(from.is_empty());
        assert_eq!(damage(&body, &*other), expected());
        assert_eq!(whole(&body, &*other), whole(&body, &*it));
        assert_eq!(other.memory(), it.memory());
    }
}
