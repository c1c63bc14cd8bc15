//! What theory says of a crystal, the engine does: forces of plane waves, energies of strains, stable steps.

use peridyne::run::{Options, Simulation, build};
use peridyne::space::lattice::LatticeKind;
use peridyne::spec::*;
use peridyne_theory::crystal::{Crystal, LatticeSolid};
use peridyne_theory::patch_test::patch_test;
use peridyne_theory::voigt::components;
use std::f64::consts::PI;

const H: f64 = 0.5;
const RHO: f64 = 2.0;

fn laws() -> Vec<(LawSpec, Influence)> {
    vec![
        (LawSpec::Pmb(PmbStiffness::Young(3.0)), Influence::Linear),
        (
            LawSpec::Lps(Moduli {
                young: 3.0,
                poisson: 0.35,
            }),
            Influence::Gaussian,
        ),
        (
            LawSpec::EamLike {
                pair: 20.0,
                volume: 2.0,
            },
            Influence::Inverse,
        ),
    ]
}

struct Case {
    spec: Spec,
    cells: [usize; 3],
    solid: LatticeSolid,
}

/// A periodic box, and the same as a crystal.
fn case(
    kind: LatticeKind,
    ratio: u32,
    cells: [usize; 3],
    law: LawSpec,
    influence: Influence,
) -> Case {
    let d = kind.dimension();
    let section = if d == 3 { 1.0 } else { 0.25 };
    let mut quarters = vec![];
    for z in 0..cells[2] as i32 {
        for y in 0..cells[1] as i32 {
            for x in 0..cells[0] as i32 {
                for b in kind.basis() {
                    quarters.push([4 * x + b[0], 4 * y + b[1], 4 * z + b[2]]);
                }
            }
        }
    }
    let mut periodic = [None; 3];
    for a in 0..d {
        periodic[a] = Some(H * kind.edges()[a] * cells[a] as f64);
    }
    let body = BodySpec::Sites {
        kind,
        spacing: H,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let mut spec = Spec::new(d, body, RHO, law);
    spec.space.section = section;
    spec.space.periodic = periodic;
    spec.bonds.horizon = Horizon::Ratio(ratio);
    spec.bonds.partial_volume_correction = true;
    spec.bonds.influence = influence;
    spec.run.schedule.time_step = TimeStep::Fraction(0.5);
    spec.run.schedule.force_unstable = true;
    let mut solid = LatticeSolid::new(kind, H, Horizon::Ratio(ratio));
    solid.section = section;
    solid.density = RHO;
    solid.influence = influence;
    solid.partial_volume_correction = true;
    Case { spec, cells, solid }
}

/// Which site of the primitive cell a point is.
fn site(kind: LatticeKind, x: [f64; 3]) -> usize {
    let quarter = (x[0] / H * 4.0).round() as i64;
    usize::from(kind == LatticeKind::Diamond && quarter.rem_euclid(2) == 1)
}

fn compare<const D: usize>(kind: LatticeKind, ratio: u32, cells: [usize; 3], wave: [f64; D]) {
    for (law, influence) in laws() {
        let name = format!("{kind:?} {law:?}");
        let case = case(kind, ratio, cells, law.clone(), influence);
        let crystal: Crystal<D> = case
            .solid
            .of_law(&law, Plane::Stress, Calibration::Discrete)
            .unwrap();
        let mut sim = build(&case.spec, Options::default()).unwrap();
        forces(sim.as_mut(), &crystal, kind, &case, wave, &name);
        energies(sim.as_mut(), &crystal, &name);
        // the box holds fewer waves than the zone
        let ratio = sim.info().stable_step / crystal.largest(6).time_step();
        assert!((0.93..1.07).contains(&ratio), "{name}: {ratio}");
    }
}

/// A mode's force density is −ρω² times its displacement.
fn forces<const D: usize>(
    sim: &mut dyn Simulation,
    crystal: &Crystal<D>,
    kind: LatticeKind,
    case: &Case,
    wave: [f64; D],
    name: &str,
) {
    let k: [f64; D] =
        std::array::from_fn(|a| 2.0 * PI * wave[a] / (H * kind.edges()[a] * case.cells[a] as f64));
    let modes = crystal.modes(k);
    let top = modes[modes.len() - 1].squared;
    let amplitude = 1e-8 * H;
    let reference = sim.vectors("reference");
    for mode in &modes {
        let u: Vec<[f64; 3]> = reference
            .iter()
            .map(|x| {
                let phase: f64 = (0..D).map(|a| k[a] * x[a]).sum();
                let (sin, cos) = phase.sin_cos();
                std::array::from_fn(|a| match a < D {
                    true => {
                        let v = mode.vector[site(kind, *x) * D + a];
                        amplitude * (v.re * cos - v.im * sin)
                    }
                    false => 0.0,
                })
            })
            .collect();
        sim.set_displacements(&u);
        sim.start(true);
        for (f, u) in sim.vectors("force_density").iter().zip(&u) {
            for a in 0..D {
                let expected = -RHO * mode.squared * u[a];
                let scale = RHO * top * amplitude;
                assert!(
                    (f[a] - expected).abs() < 1e-6 * scale,
                    "{name}: {f:?} {expected}"
                );
            }
        }
    }
}

/// The patch test is the stiffness of rigidly carried sites, per section.
fn energies<const D: usize>(sim: &mut dyn Simulation, crystal: &Crystal<D>, name: &str) {
    let found = patch_test(sim, None);
    let stiffness = found.classes[0].stiffness.as_ref().unwrap();
    let section = sim.info().section;
    let c = crystal.rigid_elastic_constants().c;
    for i in 0..components(D) {
        for j in 0..components(D) {
            let (a, b) = (stiffness.c[i][j], c[i][j] / section);
            assert!(
                (a - b).abs() < 1e-4 * c[0][0] / section,
                "{name} {i}{j}: {a} {b}"
            );
        }
    }
}

#[test]
fn chains() {
    compare::<1>(LatticeKind::Chain, 3, [16, 1, 1], [3.0]);
}

#[test]
fn planes() {
    compare::<2>(LatticeKind::Square, 3, [9, 8, 1], [2.0, 1.0]);
    compare::<2>(LatticeKind::Triangular, 2, [8, 6, 1], [2.0, -1.0]);
}

#[test]
fn solids() {
    compare::<3>(LatticeKind::Cubic, 2, [6, 5, 6], [1.0, 2.0, 1.0]);
    compare::<3>(LatticeKind::Bcc, 1, [4, 4, 4], [1.0, 0.0, 1.0]);
    compare::<3>(LatticeKind::Fcc, 1, [4, 4, 4], [1.0, -1.0, 0.0]);
    compare::<3>(LatticeKind::Diamond, 1, [4, 4, 4], [1.0, 1.0, 0.0]);
}
