//! A hash tells states apart that differ in a bit, and no others.

use crate::sample::*;
use peridyne::columns::{Life, On};
use peridyne::run::Simulation;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;

const SHEET: Place = Place {
    kind: LatticeKind::Square,
    plane: Plane::Stress,
    ratio: 2,
    cells: [45, 40, 1],
};

/// A sheet of two blocks of ids with a crack, on its way.
fn torn(name: &str, family: FamilyChoice) -> Box<dyn Simulation> {
    let mut spec = Case::of(name, SHEET).spec();
    spec.bonds.family = family;
    breaking(&mut spec, 0.2);
    spec.damage.precracks = vec![PrecrackSpec {
        kind: CrackKind::Broken,
        shape: CrackShape::Segment {
            from: [-H, 4.3 * H, 0.0],
            to: [9.2 * H, 11.6 * H, 0.0],
        },
    }];
    let mut sim = at_rest(&spec);
    let n = sim.vectors("reference").len();
    sim.set_velocities(&Random(3).vectors(n, 2, 0.01));
    sim
}

/// With the last bit of a number turned.
fn turned(x: f64) -> f64 {
    f64::from_bits(x.to_bits() ^ 1)
}

#[test]
fn a_bit_of_a_velocity_shows_and_looking_does_not() {
    for family in [FamilyChoice::Stencil, FamilyChoice::List] {
        let (mut looked, mut left) = (torn("pmb", family), torn("pmb", family));
        for sim in [&mut looked, &mut left] {
            sim.start(true);
        }
        for _ in 0..3 {
            looked.step().unwrap();
            left.step().unwrap();
            let hash = looked.state_hash();
            assert_eq!(looked.state_hash(), hash);
        }
        let hash = left.state_hash();
        assert_eq!(looked.state_hash(), hash);
        assert!(hash.ledger.is_some());
        let v = looked.velocities();
        for id in [0, 1023, 1024, v.len() - 1] {
            let mut other = v.clone();
            other[id][1] = turned(other[id][1]);
            looked.set_velocities(&other);
            assert_ne!(looked.state_hash().state, hash.state, "{family:?}: {id}");
        }
        looked.set_velocities(&v);
        assert_eq!(looked.state_hash(), hash);
    }
}

#[test]
fn how_points_and_bonds_lie_in_memory_does_not_show() {
    for name in ["pmb", "lps", "viscoelastic mixed", "softening"] {
        let of = |family| torn(name, family).state_hash().state;
        let [stencil, list] = [FamilyChoice::Stencil, FamilyChoice::List].map(of);
        assert_eq!(stencil, list, "{name}");
    }
}

#[test]
fn what_bonds_remember_shows() {
    for name in ["viscoelastic mixed", "softening"] {
        for family in [FamilyChoice::Stencil, FamilyChoice::List] {
            let mut sim = torn(name, family);
            sim.start(true);
            steps(sim.as_mut(), 2);
            let hash = sim.state_hash().state;
            let mut columns = sim.columns();
            columns.retain(|c| c.on == On::Bonds && c.life == Life::Persistent);
            // of a broken bond the point with the lower slot says it
            columns.retain(|c| c.name != "whole");
            assert!(!columns.is_empty(), "{name}");
            for column in columns {
                let values = sim.scalars(&column.name);
                for n in [0, values.len() / 2, values.len() - 1] {
                    let mut other = values.clone();
                    other[n] = turned(other[n]);
                    assert!(sim.set_column(&column.name, &other));
                    let said = format!("{name} {family:?}: {} {n}", column.name);
                    assert_ne!(sim.state_hash().state, hash, "{said}");
                    assert!(sim.set_column(&column.name, &values));
                    assert_eq!(sim.state_hash().state, hash, "{said}");
                }
            }
        }
    }
}

/// In a ring of four points the second neighbour to the left is the one to the right.
#[test]
fn every_bond_that_breaks_shows_also_of_one_pair() {
    let ring = Place {
        kind: LatticeKind::Chain,
        plane: Plane::Stress,
        ratio: 2,
        cells: [4, 1, 1],
    };
    let mut spec = Case::of("pmb", ring).periodic();
    spec.bonds.family = FamilyChoice::Stencil;
    let mut sim = at_rest(&spec);
    let whole = sim.scalars("whole");
    assert_eq!(whole, [1.0; 16]);
    let mut seen = vec![sim.state_hash().state];
    // the bonds of the first point, which is the first end of all of them
    for n in 0..4 {
        let mut cut = whole.clone();
        cut[n] = 0.0;
        assert!(sim.set_column("whole", &cut));
        let hash = sim.state_hash().state;
        assert!(!seen.contains(&hash), "bond {n}");
        seen.push(hash);
    }
    assert!(sim.set_column("whole", &whole));
    assert_eq!(sim.state_hash().state, seen[0]);
}
