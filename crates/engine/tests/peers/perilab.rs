//! PeriLab's own verification results: all cases of `test/fullscale_tests` that were at hand, and which of them are met.
//!
//! PeriLab.jl 2.2.4 (BSD 3-clause, Copyright 2024 Christian Willberg, Jan-Timo Hesse), commit 569325fe. Most cases prescribe every
//! displacement, so that the forces of the law are all that is tested: here they are taken under the displacements of the last state.
//! Tolerances are those of the cases; of displacements of 1e-12, which lengths in PeriLab know to 1e-16 of theirs, what that leaves.

use super::Answer::{Met, Not};
use super::{Answer, Off, cells, internal_forces, met, model, off, rows, set, worst};
use peridyne::space::Point;
use peridyne::spec::*;
use std::f64::consts::PI;

const HORIZON: f64 = 2.1;
const VOLUME: f64 = 0.1;

const NO_DETERMINANT: &str = "the peer's force state of correspondence lacks det F, takes F⁻¹ in place of its transpose, and uses a stress of Green's strain as Cauchy's";
const STALE: &str = "the peer's own law does not give the stored forces any more";
const DOUBLE_SHEAR: &str = "the peer's shear stress is 4 G ε";
const ZERO_ENERGY: &str =
    "as the case without control: it is affine, and the force state lacks det F";
const UNIFIED: &str = "the unified bond-based law is no law here";
const ONE_SIDED: &str =
    "the peer's bonds break at one end alone, by limits of that end; here a bond has one state";
const TOO_SMALL: &str = "stored displacements of at most 5e-10 are below the tolerance of 1e-8, which nothing would miss";

/// All cases of the folder.
const CASES: [(&str, Answer); 73] = [
    ("bcs__displacements", Not("conditions alone; not run")),
    ("bcs__temperature", Not("conditions alone; not run")),
    ("bond_based_elastic__test_bond_based_elastic_2d", Met(plane)),
    ("bond_based_elastic__test_bond_based_elastic_3d", Met(space)),
    (
        "bond_based_elastic__test_bond_based_elastic_4_points",
        Met(four),
    ),
    (
        "bond_based_elastic__test_static_bond_based_elastic_2d",
        Not("forces are stored as zero, and displacements are below the tolerance of the case"),
    ),
    (
        "bond_based_elastic__test_unified_bond_based_elastic_2d",
        Not(UNIFIED),
    ),
    (
        "bond_based_elastic__test_unified_bond_based_elastic_3d",
        Not(UNIFIED),
    ),
    ("calculation__calculation", Met(plane_stress)),
    ("correspondence_elastic_3d__strain_xx", Not(STALE)),
    ("correspondence_elastic_3d__strain_xy", Not(DOUBLE_SHEAR)),
    (
        "correspondence_elastic_3d__strain_xy_angles",
        Not(DOUBLE_SHEAR),
    ),
    ("correspondence_elastic_3d__strain_xz", Not(NO_DETERMINANT)),
    ("correspondence_elastic_3d__strain_yy", Not(STALE)),
    ("correspondence_elastic_3d__strain_yz", Not(NO_DETERMINANT)),
    ("correspondence_elastic_3d__strain_zz", Not(NO_DETERMINANT)),
    (
        "correspondence_elastic__ba_correspondence_strain_pstress_xx",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__ba_correspondence_strain_pstress_xy",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstrain_xx",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstrain_xy",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstrain_yy",
        Not(STALE),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstress_xx",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstress_xy",
        Not(NO_DETERMINANT),
    ),
    (
        "correspondence_elastic__correspondence_strain_pstress_yy",
        Not(STALE),
    ),
    (
        "correspondence_elastic_plastic__correspondence_elastic_plastic",
        Not(
            "the peer's return mapping ends at two thirds of the yield stress and loses the mean stress",
        ),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstrain_zc_xx",
        Not(STALE),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstrain_zc_xy",
        Not(ZERO_ENERGY),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstrain_zc_yy",
        Not(STALE),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstress_zc_xx",
        Not(ZERO_ENERGY),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstress_zc_xy",
        Not(ZERO_ENERGY),
    ),
    (
        "correspondence_elastic_with_zero_e_control__correspondence_strain_pstress_zc_yy",
        Not(STALE),
    ),
    (
        "critical_energy__critical_energy_field",
        Met(torn_by_energy_field),
    ),
    ("critical_energy__critical_energy_interface", Not(ONE_SIDED)),
    ("critical_energy__critical_energy_pressure", Not(ONE_SIDED)),
    (
        "critical_energy__critical_energy_tension",
        Met(torn_by_energy),
    ),
    (
        "critical_stretch__critical_stretch_field",
        Met(pulled_field),
    ),
    (
        "critical_stretch__critical_stretch_interface",
        Not(ONE_SIDED),
    ),
    (
        "critical_stretch__critical_stretch_only_tension",
        Not(
            "bonds break by stretch under tension only, and this bond is pulled: it says nothing of compression",
        ),
    ),
    ("critical_stretch__critical_stretch_pressure", Met(pushed)),
    ("critical_stretch__critical_stretch_tension", Met(pulled)),
    (
        "dcb__dcbmodel_correspondence_bond_associated",
        Not("the force state lacks det F, and stored stress is zero"),
    ),
    ("dcb__dcbmodel_pd_solid", Not(ONE_SIDED)),
    (
        "heat_transfer__heat_transfer",
        Not(
            "the peer finds surface points by counting neighbours, and lets heat out by a rule of its own",
        ),
    ),
    (
        "linear_static_matrix_based_solver__linear_static_matrix_based_solver_2d",
        Not(NO_DETERMINANT),
    ),
    (
        "linear_static_matrix_based_solver__linear_static_matrix_based_solver_3d",
        Not("forces and stress are stored as zero"),
    ),
    (
        "linear_static_matrix_based_solver__linear_static_matrix_based_tension",
        Not(NO_DETERMINANT),
    ),
    (
        "model_reduction_verlet_matrix__verlet_reduced",
        Not(
            "the peer condenses blocks statically inside its stepper; here `coarsen` makes another body",
        ),
    ),
    ("newmark__newmark_solver_2d", Not(NO_DETERMINANT)),
    ("newmark__newmark_solver_3d", Not(DOUBLE_SHEAR)),
    (
        "pd_solid_elastic_3d__strain_xx",
        Met(|| solid("pd_solid_elastic_3d__strain_xx", |x| [x[0], 0.0, 0.0])),
    ),
    (
        "pd_solid_elastic_3d__strain_xy",
        Met(|| solid("pd_solid_elastic_3d__strain_xy", |x| [x[1], x[0], 0.0])),
    ),
    (
        "pd_solid_elastic_3d__strain_xz",
        Met(|| solid("pd_solid_elastic_3d__strain_xz", |x| [x[0], 0.0, x[2]])),
    ),
    (
        "pd_solid_elastic_3d__strain_yy",
        Met(|| solid("pd_solid_elastic_3d__strain_yy u", |_| [0.0; 3])),
    ),
    (
        "pd_solid_elastic_3d__strain_yz",
        Met(|| solid("pd_solid_elastic_3d__strain_yz", |x| [0.0, x[1], x[2]])),
    ),
    (
        "pd_solid_elastic_3d__strain_zz",
        Met(|| solid("pd_solid_elastic_3d__strain_zz", |x| [0.0, 0.0, x[2]])),
    ),
    (
        "pd_solid_elastic__strain_xx",
        Met(|| solid("pd_solid_elastic__strain_xx", |x| [x[0], 0.0, 0.0])),
    ),
    (
        "pd_solid_elastic__strain_xy",
        Met(|| solid("pd_solid_elastic__strain_xy", |x| [x[1], x[0], 0.0])),
    ),
    (
        "pd_solid_elastic__strain_yy",
        Met(|| solid("pd_solid_elastic__strain_yy", |x| [0.0, x[1], 0.0])),
    ),
    (
        "pd_solid_plastic__strain_xy",
        Not("every stored force is zero"),
    ),
    (
        "penalty_contact__penalty_contact",
        Not("a contact of the peer's own, between surface points that it finds itself"),
    ),
    (
        "penalty_contact__penalty_contact_friction",
        Not("as without friction"),
    ),
    (
        "surface_correction__test_volume_correction",
        Not(
            "the published correction by volume is of bond-based laws here; state-based bodies have `surface = \"exact\"` on lattices",
        ),
    ),
    ("symmetry__symmetry_eng", Not(NO_DETERMINANT)),
    ("symmetry__symmetry_hooke", Not(NO_DETERMINANT)),
    (
        "thermal_expansion__thermal_expansion_bond_based",
        Not(TOO_SMALL),
    ),
    (
        "thermal_expansion__thermal_expansion_correspondence",
        Not("marked by the peer as not working"),
    ),
    (
        "thermal_expansion__thermal_expansion_lin_mat_const_t",
        Not(TOO_SMALL),
    ),
    (
        "thermal_expansion__thermal_expansion_lin_mat_var_t",
        Not(TOO_SMALL),
    ),
    (
        "thermal_expansion__thermal_expansion_pd_solid",
        Not(TOO_SMALL),
    ),
    (
        "thermal_expansion__thermal_expansion_pd_solid_static",
        Not(TOO_SMALL),
    ),
    (
        "thermal_flow__thermal_flow",
        Not(
            "the peer's conductances are those of a full disk without thickness; those of the engine are normalised by the family that is there",
        ),
    ),
    (
        "thermal_flow__thermal_flow_correspondence",
        Not("fluxes from a gradient of the family; those of the engine are of bonds"),
    ),
    (
        "thermal_flow_paper",
        Not(
            "the peer's conductances are those of a full disk without thickness; those of the engine are normalised by the family that is there",
        ),
    ),
];

#[test]
fn cases_of_perilab_are_met_at_their_tolerance() {
    met(&CASES);
    let names: std::collections::BTreeSet<&str> = CASES.iter().map(|(n, _)| *n).collect();
    assert_eq!(names.len(), CASES.len(), "a case stands twice");
}

fn stored(case: &str) -> Vec<Vec<f64>> {
    rows(include_str!("perilab.txt"), case)
}

/// Four points along x and three along y in each of these layers, x runs fastest.
fn points(layers: &[f64]) -> Vec<Point> {
    let mut at = vec![];
    for z in layers {
        for n in 0..12 {
            at.push([(n % 4) as f64 - 1.5, (n / 4) as f64, *z]);
        }
    }
    at
}

/// Points with a stiffer corner, of two laws, in `dimension` axes.
fn two_blocks(at: &[Point], dimension: usize, laws: [LawSpec; 2]) -> Spec {
    let mut spec = cells(at, VOLUME, 2.7e-9, HORIZON, laws[0].clone());
    spec.space.dimension = dimension;
    // each end of a bond answers for itself
    spec.interactions.interface = BondMixing::Arithmetic;
    set(&mut spec, "soft", at, |x| !(x[0] > 0.0 && x[1] > 0.5));
    set(&mut spec, "stiff", at, |x| x[0] > 0.0 && x[1] > 0.5);
    spec.materials = { ["soft", "stiff"].into_iter().zip(laws) }
        .map(|(name, law)| MaterialSpec {
            name: name.into(),
            set: name.into(),
            density: 2.7e-9,
            law,
            fracture: None,
        })
        .collect();
    spec
}

/// Forces under displacements against those that are stored.
fn forces(spec: &Spec, u: &[Point], stored: &[Vec<f64>], tolerance: f64) -> Vec<Off> {
    let mut sim = model(spec);
    sim.set_displacements(u);
    let found = internal_forces(sim.as_mut());
    assert_eq!(found.len(), stored.len());
    let pairs = { found.iter().zip(stored) }
        .flat_map(|(f, s)| s.iter().enumerate().map(|(a, s)| (f[a], *s)));
    vec![off("force", worst(pairs), tolerance)]
}

fn lps() -> [LawSpec; 2] {
    [(2500.0, 1150.0), (3500.0, 2150.0)]
        .map(|(bulk, shear)| LawSpec::Lps(Moduli::from_bulk_shear(bulk, shear)))
}

/// A tenth of a gradient, or displacements that stand before the forces; planar points have the constants of space.
fn solid(case: &str, gradient: fn(Point) -> Point) -> Vec<Off> {
    let mut stored = stored(case);
    let layers: &[f64] = if stored.len() == 12 {
        &[0.0]
    } else {
        &[0.0, 0.5, 1.0]
    };
    let at = points(layers);
    let u: Vec<Point> = match case.ends_with(" u") {
        true => stored.iter().map(|row| [row[0], row[1], row[2]]).collect(),
        false => at.iter().map(|x| gradient(*x).map(|c| 0.1 * c)).collect(),
    };
    if case.ends_with(" u") {
        stored.iter_mut().for_each(|row| drop(row.drain(..3)));
    }
    forces(&two_blocks(&at, 3, lps()), &u, &stored, 5e-8)
}

fn plane_stress() -> Vec<Off> {
    let at = points(&[0.0]);
    let u: Vec<Point> = at.iter().map(|x| [0.1 * x[0], 0.0, 0.0]).collect();
    let mut spec = two_blocks(&at, 2, lps());
    spec.space.plane = Plane::Stress;
    forces(&spec, &u, &stored("calculation__calculation"), 5e-8)
}

/// The stored force of two points is c E (s/2 + s/2): a bond-based solid with c E of both ends in the mean.
fn bonds(case: &str, at: &[Point], dimension: usize, moduli: [f64; 2]) -> Vec<Off> {
    let stored = stored(&format!("{case} u"));
    let c = 48.0 / (5.0 * PI * HORIZON.powi(3));
    let law = |e: f64| LawSpec::Pmb(PmbStiffness::Micromodulus(c * e));
    let mut spec = two_blocks(at, dimension, moduli.map(law));
    if at.len() == 4 {
        spec.materials.truncate(1);
        spec.materials[0].set = "all".into();
    }
    let row = |row: &Vec<f64>, from: usize| -> Vec<f64> { row[from..from + dimension].to_vec() };
    let u: Vec<Point> = { stored.iter() }
        .map(|r| std::array::from_fn(|a| if a < dimension { r[a] } else { 0.0 }))
        .collect();
    let f: Vec<Vec<f64>> = stored.iter().map(|r| row(r, dimension)).collect();
    let size = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0f64, |m, x| m.max(x.abs()));
    let most = size(&mut f.iter().flatten().copied());
    let moved = size(&mut u.iter().flatten().copied());
    // a length of 2 is known to 4e-16, and so are differences of two
    forces(&spec, &u, &f, most * (1e-15 / moved).max(1e-12))
}

const BULK: [f64; 2] = [2500.0, 3500.0];

/// E = K where K alone is given in the plane.
fn plane() -> Vec<Off> {
    let at = points(&[0.0]);
    bonds(
        "bond_based_elastic__test_bond_based_elastic_2d",
        &at,
        2,
        BULK,
    )
}

/// E = 1.5 K in space, with the constant of plane strain.
fn space() -> Vec<Off> {
    let at = points(&[0.0, 1.0]);
    bonds(
        "bond_based_elastic__test_bond_based_elastic_3d",
        &at,
        3,
        BULK.map(|k| 1.5 * k),
    )
}

fn four() -> Vec<Off> {
    let at = [[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    bonds(
        "bond_based_elastic__test_bond_based_elastic_4_points",
        &at,
        2,
        BULK,
    )
}

/// Damage of two points two apart, of which one moves by this along x.
fn damage(moved: f64, criteria: [Criterion; 2], stored: f64) -> Vec<Off> {
    let at = [[-1.5, 0.0, 0.0], [0.5, 0.0, 0.0]];
    let mut spec = cells(&at, VOLUME, 2.7e-9, HORIZON, lps()[0].clone());
    spec.interactions.interface = BondMixing::Arithmetic;
    set(&mut spec, "soft", &at, |x| x[0] < 0.0);
    set(&mut spec, "stiff", &at, |x| x[0] > 0.0);
    spec.materials = { ["soft", "stiff"].into_iter().zip(lps()).zip(criteria) }
        .map(|((name, law), criterion)| MaterialSpec {
            name: name.into(),
            set: name.into(),
            density: 2.7e-9,
            law,
            fracture: Some(FractureSpec::new(criterion)),
        })
        .collect();
    let mut sim = model(&spec);
    sim.start(true);
    sim.set_displacements(&[[moved, 0.0, 0.0], [0.0; 3]]);
    sim.start(true);
    // bonds are tested in steps
    sim.step().unwrap();
    let pairs = sim.scalars("damage").into_iter().map(|d| (d, stored));
    vec![off("damage", worst(pairs), 1e-9)]
}

fn pulled() -> Vec<Off> {
    damage(-1.0, [Criterion::Stretch(0.1); 2], 1.0)
}

/// Critical stretches by point.
fn pulled_field() -> Vec<Off> {
    damage(-1.0, [0.1, 0.2].map(Criterion::Stretch), 1.0)
}

fn pushed() -> Vec<Off> {
    damage(1.0, [Criterion::Stretch(0.1); 2], 0.0)
}

/// Far beyond the limit, which is twice as far here (`tests/battery/criteria.rs`).
fn torn_by_energy() -> Vec<Off> {
    damage(-1.0, [Criterion::BondEnergy(0.1); 2], 1.0)
}

fn torn_by_energy_field() -> Vec<Off> {
    damage(-1.0, [0.1, 0.2].map(Criterion::BondEnergy), 1.0)
}
