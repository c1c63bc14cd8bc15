//! A point's bits do not depend on where in its tile it stands, nor on what else is in the body.

use crate::sample::*;
use peridyne::execute::simd::Simd;
use peridyne::run::Options;
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use std::collections::HashMap;

/// Steps of every run.
const STEPS: usize = 40;
/// Cells between two pieces: no bond and no contact reaches that far.
const APART: i32 = 40;

/// Site of a point, in quarters of a cell.
type Site = [i32; 3];

/// A plate, bar or block that breaks and touches itself, with strains of all sizes side by side.
fn busy(name: &str, kind: LatticeKind) -> Spec {
    let (ratio, cells) = match kind.dimension() {
        1 => (3, [150, 1, 1]),
        2 => (3, [21, 13, 1]),
        _ => (2, [9, 6, 5]),
    };
    let plane = Plane::Stress;
    let place = Place {
        kind,
        plane,
        ratio,
        cells,
    };
    let mut spec = Case::of(name, place).spec();
    breaking(&mut spec, 0.02);
    spec.interactions.contact = Some(CONTACT);
    spec.run.schedule.time_step = TimeStep::Fixed(0.05 * H);
    spec.loading.conditions = vec![
        ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::Damping(e("0.01")),
        },
        ConditionSpec {
            set: "all".into(),
            kind: ConditionKind::BodyForce([Some(e("0.1*sin(t+x)")), None, None]),
        },
    ];
    spec
}

fn sites(spec: &Spec) -> &Vec<Site> {
    match &spec.body {
        BodySpec::Sites { quarters, .. } => quarters,
        _ => unreachable!("samples are made of sites"),
    }
}

fn with_sites(spec: &Spec, new: Vec<Site>) -> Spec {
    let mut made = spec.clone();
    if let BodySpec::Sites { quarters, .. } = &mut made.body {
        *quarters = new;
    }
    made
}

/// The same with a few points so far to the left that all others stand `by` slots further on.
fn shifted(spec: &Spec, by: i32) -> Spec {
    let mut all: Vec<Site> = (0..3).map(|x| [4 * (x - APART - by), 0, 0]).collect();
    all.extend(sites(spec));
    with_sites(spec, all)
}

/// Velocity of a site: of all sizes, and its own.
fn velocity(site: Site, d: usize) -> [f64; 3] {
    let seed = (site[0] * 7919 + site[1] * 104_729 + site[2] * 1_299_709) as u64;
    let mut random = Random(seed);
    let size = 0.15 * 10f64.powf(-3.0 + 3.0 * (0.05 * site[0] as f64).sin());
    std::array::from_fn(|a| if a < d { size * random.next() } else { 0.0 })
}

/// All that a point has after some steps, by site.
fn run(spec: &Spec, simd: Simd) -> HashMap<Site, Vec<u64>> {
    let options = Options {
        simd: Some(simd),
        trust_time_step: true,
    };
    let mut sim = build(spec, options).unwrap();
    let sites = sites(spec);
    let v: Vec<_> = sites
        .iter()
        .map(|s| velocity(*s, spec.space.dimension))
        .collect();
    sim.set_velocities(&v);
    sim.start(true);
    steps(sim.as_mut(), STEPS);
    assert!(sim.broken() > 0 && sim.broken() < sim.info().directed_bonds);
    let mut state: Vec<Vec<u64>> = vec![vec![]; sites.len()];
    for field in [
        sim.displacements(),
        sim.velocities(),
        sim.vectors("force_density"),
    ] {
        for (bits, x) in state.iter_mut().zip(&field) {
            bits.extend(x.map(f64::to_bits));
        }
    }
    for field in [
        sim.scalars("damage"),
        sim.scalars("critical_stretch"),
        sim.scalars("energy_density"),
    ] {
        for (bits, x) in state.iter_mut().zip(&field) {
            bits.push(x.to_bits());
        }
    }
    sites.iter().copied().zip(state).collect()
}

/// How many of the sites of `part` have other bits than in `whole`.
fn different(part: &HashMap<Site, Vec<u64>>, whole: &HashMap<Site, Vec<u64>>) -> usize {
    part.iter().filter(|(s, bits)| whole[*s] != **bits).count()
}

#[test]
fn the_same_bits_in_every_place_of_a_tile() {
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        for name in ["pmb", "pmb mixed", "lps", "lps mixed"] {
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                let mut spec = busy(name, kind);
                spec.bonds.family = family;
                let first = run(&spec, Simd::detect());
                for by in 1..8 {
                    // every set in turn, to spare time
                    let all = Simd::available();
                    let simd = all[by as usize % all.len()];
                    let other = run(&shifted(&spec, by), simd);
                    let off = different(&first, &other);
                    assert_eq!(off, 0, "{name} {kind:?} {family:?}, {by} slots on");
                }
            }
        }
    }
}

#[test]
fn two_pieces_are_what_each_is_alone() {
    for kind in [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic] {
        for name in ["pmb", "lps"] {
            for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                let mut spec = busy(name, kind);
                spec.bonds.family = family;
                let left = sites(&spec).clone();
                let far = |s: &Site| [s[0] + 4 * (APART + left.len() as i32), s[1], s[2]];
                let right: Vec<Site> = left.iter().map(far).collect();
                let both = left.iter().chain(&right).copied().collect();
                let both = run(&with_sites(&spec, both), Simd::detect());
                for piece in [left, right] {
                    let alone = run(&with_sites(&spec, piece), Simd::detect());
                    assert_eq!(different(&alone, &both), 0, "{name} {kind:?} {family:?}");
                }
            }
        }
    }
}
