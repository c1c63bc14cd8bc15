//! Pre-cracks, damage, fragments, and perturbed lattices.

use crate::sample::*;
use peridyne::body::Body;
use peridyne::execute::simd::Simd;
use peridyne::family::stencil::Stencil;
use peridyne::interaction::stencil::{StencilInteraction, StencilParts};
use peridyne::interaction::{Interaction, PointConstants, Toughness};
use peridyne::law::solid::bond_based::BondBased;
use peridyne::space::lattice::{Lattice, LatticeKind};
use peridyne::space::region::Region;
use peridyne::spec::*;

/// A crack through the whole body at `x`.
fn through(d: usize, x: f64) -> CrackShape {
    let far = 1000.0;
    match d {
        1 => CrackShape::Point { x },
        2 => CrackShape::Segment {
            from: [x, -far, 0.0],
            to: [x, far, 0.0],
        },
        _ => CrackShape::Polygon {
            corners: vec![
                [x, -far, -far],
                [x, far, -far],
                [x, far, far],
                [x, -far, far],
            ],
        },
    }
}

#[test]
fn a_body_cut_in_two_has_two_fragments_and_damage_where_bonds_broke() {
    for case in cases() {
        for family in [FamilyChoice::Stencil, FamilyChoice::List] {
            let mut spec = case.spec();
            spec.bonds.family = family;
            let sim = at_rest(&spec);
            assert_eq!(sim.fragments(), 1, "{}", case.name());
            let (whole, reach) = (sim.info().directed_bonds, sim.info().horizon);
            let x = (case.place.cells[0] as f64 * 0.5 - 0.3) * H;
            for kind in [CrackKind::Broken, CrackKind::Excluded] {
                spec.damage.precracks = vec![PrecrackSpec {
                    shape: through(case.d(), x),
                    kind,
                }];
                let mut sim = at_rest(&spec);
                let info = sim.info().clone();
                assert_eq!(sim.fragments(), 2, "{}", case.name());
                assert!(info.cut > 0 && info.cut.is_multiple_of(2));
                let damage = sim.scalars("damage");
                let left = if kind == CrackKind::Excluded {
                    whole - info.cut
                } else {
                    whole
                };
                assert_eq!(info.directed_bonds, left, "{}", case.name());
                if kind == CrackKind::Excluded {
                    assert!(damage.iter().all(|d| *d == 0.0), "{}", case.name());
                } else {
                    // far away nothing is damaged, and bonds lost are bonds cut
                    for (x0, d) in sim.vectors("reference").iter().zip(&damage) {
                        assert!(*d == 0.0 || (x0[0] - x).abs() < reach, "{}", case.name());
                        assert!((0.0..=1.0).contains(d));
                    }
                    assert!(damage.iter().any(|d| *d > 0.0), "{}", case.name());
                }
                // the halves do not feel each other
                let d = case.d();
                let u: Vec<_> = sim
                    .vectors("reference")
                    .iter()
                    .map(|p| [if p[0] > x { 3.0 * H } else { 0.0 }, 0.0, 0.0])
                    .collect();
                let f = sim.forces_under(&u);
                assert!(f.iter().flatten().all(|c| *c == 0.0), "{} {d}", case.name());
            }
        }
    }
}

/// Lost bonds, counted by hand on a chain of five with m_ratio 1 cut in the middle.
#[test]
fn damage_is_the_fraction_of_lost_bonds() {
    let place = Place {
        kind: LatticeKind::Chain,
        plane: Plane::Stress,
        ratio: 2,
        cells: [6, 1, 1],
    };
    let mut spec = Case::of("pmb", place).spec();
    spec.damage.precracks = vec![PrecrackSpec {
        shape: through(1, 2.5 * H),
        kind: CrackKind::Broken,
    }];
    // families 2 3 4 4 3 2; cut: 1-3, 2-3, 2-4
    let damage = at_rest(&spec).scalars("damage");
    let expected = [0.0, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.0];
    for (d, e) in damage.iter().zip(expected) {
        assert!((d - e).abs() < 1e-15, "{damage:?}");
    }
}

/// An absent crack changes the weighted volume of state-based solids: a cut body is two bodies.
#[test]
fn a_body_cut_by_an_absent_crack_is_two_bodies() {
    for case in cases().into_iter().filter(|c| c.material.laws.len() == 1) {
        if case.place.kind.basis().len() > 1 {
            continue;
        }
        let cells = case.place.cells[0];
        let cut_at = cells / 2;
        let mut spec = case.spec();
        spec.damage.precracks = vec![PrecrackSpec {
            shape: through(case.d(), (cut_at as f64 - 0.5) * H),
            kind: CrackKind::Excluded,
        }];
        let mut cut = at_rest(&spec);
        let mut half = case.clone();
        half.place.cells[0] = cut_at;
        let mut half = at_rest(&half.spec());
        let u = Random(53).vectors(cut.vectors("reference").len(), case.d(), 0.05 * H);
        let left: Vec<usize> = (0..u.len())
            .filter(|i| cut.vectors("reference")[*i][0] < (cut_at as f64 - 0.5) * H)
            .collect();
        let pick = |v: Vec<[f64; 3]>| -> Vec<[f64; 3]> { left.iter().map(|i| v[*i]).collect() };
        let f = pick(cut.forces_under(&u));
        let g = half.forces_under(&pick(u));
        assert!(distance(&f, &g) < 1e-13 * largest(&f), "{}", case.name());
    }
}

/// A crack on the face of a periodic body cuts the bonds through it, seen from both sides.
#[test]
fn cracks_on_periodic_faces_cut_both_directions() {
    for name in ["pmb", "lps"] {
        for place in places() {
            let mut case = Case::of(name, place);
            case.place.cells = place.cells.map(|c| {
                if c > 1 {
                    c.max(2 * place.ratio as usize + 1)
                } else {
                    1
                }
            });
            for (face, x) in [(0.0, -0.05 * H), (0.0, 0.0), (1.0, -0.05 * H), (1.0, 0.0)] {
                let mut cuts = vec![];
                for family in [FamilyChoice::Stencil, FamilyChoice::List] {
                    let mut spec = case.periodic();
                    spec.bonds.family = family;
                    let period = spec.space.periodic[0].unwrap();
                    spec.damage.precracks = vec![PrecrackSpec {
                        shape: through(case.d(), face * period + x),
                        kind: CrackKind::Broken,
                    }];
                    let mut sim = at_rest(&spec);
                    assert!(sim.info().cut > 0 && sim.info().cut.is_multiple_of(2));
                    let u = Random(59).vectors(sim.vectors("reference").len(), case.d(), 0.05 * H);
                    let f = sim.forces_under(&u);
                    let total: [f64; 3] = std::array::from_fn(|a| f.iter().map(|f| f[a]).sum());
                    assert!(
                        largest(&[total]) < 1e-11 * largest(&f),
                        "{}: {total:?}",
                        case.name()
                    );
                    cuts.push((sim.info().cut, sim.scalars("damage")));
                }
                assert_eq!(cuts[0].0, cuts[1].0, "{}", case.name());
                for (a, b) in cuts[0].1.iter().zip(&cuts[1].1) {
                    assert!((a - b).abs() < 1e-14, "{}", case.name());
                }
            }
        }
    }
}

/// A cut that is told of one image of a bond only finds it from either end.
#[test]
fn a_cut_of_one_image_cuts_both_directions() {
    let n = 12;
    let stencil = Stencil::new(LatticeKind::Chain, 1.0, Horizon::Ratio(2));
    let lattice = Lattice {
        kind: LatticeKind::Chain,
        spacing: 1.0,
        origin: [0.0; 3],
    };
    let quarters: Vec<[i32; 3]> = (0..n).map(|i| [4 * i, 0, 0]).collect();
    let body = Body::<1>::on_lattice(lattice, &quarters, stencil.reach(), [true], 1.0).unwrap();
    for (face, kind) in [
        (-0.5, CrackKind::Broken),
        (n as f64 - 0.5, CrackKind::Excluded),
    ] {
        let mut it = StencilInteraction::new(StencilParts {
            body: &body,
            stencil: &stencil,
            law: BondBased { c: 1.0 },
            weight: &|_, _| 1.0,
            point_constants: PointConstants::None,
            toughness: vec![Toughness {
                s00: f64::INFINITY,
                alpha: 0.0,
            }],
            repulsion: None,
            simd: Simd::detect(),
        });
        let crosses = |a: [f64; 1], b: [f64; 1]| (a[0] < face) != (b[0] < face);
        // 0–11, 0–10, 1–11
        assert_eq!(it.cut(&body, kind, &crosses), 6);
        assert_eq!(it.cut(&body, kind, &crosses), 0);
        let mut damage = vec![0.0; body.len()];
        it.damage(&body, &mut damage);
        let lost: Vec<f64> = body.slots().iter().map(|s| damage[*s as usize]).collect();
        let family: Vec<usize> = body
            .slots()
            .iter()
            .map(|s| it.family_size(&body, *s as usize))
            .collect();
        if kind == CrackKind::Broken {
            assert_eq!(
                (lost[0], lost[1], lost[10], lost[11]),
                (0.5, 0.25, 0.25, 0.5)
            );
        } else {
            assert_eq!((family[0], family[1], family[10], family[11]), (2, 3, 3, 2));
        }
    }
}

#[test]
fn a_seed_gives_the_same_body_again() {
    for place in places() {
        let d = place.kind.dimension();
        let body = |seed: Option<u64>| {
            let mut spec = Case::of("pmb", place).spec();
            spec.body = BodySpec::Lattice {
                kind: place.kind,
                spacing: H,
                origin: [0.0; 3],
                region: Region::Block {
                    low: [0.0; 3],
                    high: [
                        2.0,
                        if d > 1 { 2.0 } else { 0.0 },
                        if d > 2 { 2.0 } else { 0.0 },
                    ],
                },
                perturb: seed.map(|seed| Perturbation {
                    amplitude: 0.1 * H * place.kind.nearest(),
                    seed,
                }),
            };
            at_rest(&spec).vectors("reference")
        };
        let (a, b, c, straight) = (body(Some(1)), body(Some(1)), body(Some(2)), body(None));
        assert_eq!(a, b);
        assert!(a.iter().zip(&c).all(|(a, c)| a != c));
        let moved = distance(&a, &straight);
        let amplitude = 0.1 * H * place.kind.nearest();
        assert!(
            moved > 0.8 * amplitude && moved <= amplitude * (1.0 + 1e-12),
            "{moved}"
        );
    }
}

/// Two points fly apart: the bond pulls in the evaluation that finds it past its critical stretch, or no more.
#[test]
fn a_bond_lets_go_at_once_or_after_its_force() {
    for family in [FamilyChoice::Stencil, FamilyChoice::List] {
        for name in ["pmb", "lps"] {
            let mut held = vec![];
            for breakage in [Breakage::BeforeForce, Breakage::AfterForce] {
                let place = Place {
                    kind: LatticeKind::Chain,
                    plane: Plane::Strain,
                    ratio: 1,
                    cells: [2, 1, 1],
                };
                let mut spec = Case::of(name, place).spec();
                (spec.bonds.family, spec.damage.breakage) = (family, breakage);
                breaking(&mut spec, 0.05);
                spec.run.schedule.time_step = TimeStep::Fixed(0.01);
                let mut sim = made(&spec);
                sim.set_velocities(&[[-0.4, 0.0, 0.0], [0.4, 0.0, 0.0]]);
                sim.start(true);
                let mut last = 0.0;
                while sim.broken() == 0 {
                    last = largest(&sim.vectors("force_density"));
                    sim.step().unwrap();
                    assert!(sim.step_number() < 100, "{name}: nothing breaks");
                }
                let now = largest(&sim.vectors("force_density"));
                match breakage {
                    Breakage::BeforeForce => assert_eq!(now, 0.0, "{name} {family:?}"),
                    Breakage::AfterForce => assert!(now > last, "{name} {family:?}: {now}"),
                }
                sim.step().unwrap();
                assert_eq!(largest(&sim.vectors("force_density")), 0.0);
                held.push((sim.step_number(), sim.velocities()[1][0]));
            }
            // in the same step; what pulled once more is slower
            assert_eq!(held[0].0, held[1].0);
            assert!(held[1].1 < held[0].1, "{name}: {held:?}");
        }
    }
}
