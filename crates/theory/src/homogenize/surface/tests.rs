use super::*;
use peridyne::law::potential::lennard_jones::LennardJones;
use peridyne::space::region::Region;
use peridyne::spec::{End, Horizon, PmbStiffness, PotentialSpec};

fn block(d: usize, n: [i32; 3], m: u32) -> Spec {
    let kind = [LatticeKind::Chain, LatticeKind::Square, LatticeKind::Cubic][d - 1];
    let mut quarters = vec![];
    for z in 0..n[2] {
        for y in 0..n[1] {
            for x in 0..n[0] {
                quarters.push([4 * x, 4 * y, 4 * z]);
            }
        }
    }
    let body = BodySpec::Sites {
        kind,
        spacing: 1.0,
        origin: [0.0; 3],
        quarters,
        volume: None,
    };
    let law = LawSpec::Pmb(PmbStiffness::Micromodulus(1.0));
    let mut spec = Spec::new(d, body, 1.0, law);
    spec.bonds.horizon = Horizon::Ratio(m);
    spec
}

fn found(spec: &Spec) -> Report {
    correct(spec, SurfaceMethod::Exact).unwrap().1.unwrap()
}

#[test]
fn plates_have_positive_factors_in_the_outermost_layer() {
    for (m, unknowns) in [(2, 15), (3, 47), (4, 102)] {
        let report = found(&block(2, [30, 24, 1], m));
        assert!(report.exact && report.residual < 1e-13, "{report:?}");
        assert_eq!((report.layers, report.unknowns), (1, unknowns));
        assert_eq!(report.floor, 0.25);
        assert!(
            report.lowest > 0.2499 && report.vanishing == 0,
            "{report:?}"
        );
    }
}

#[test]
fn blocks_have_factors_without_negative_ones() {
    for (m, layers, unknowns) in [(2, 2, 78), (3, 1, 348)] {
        let report = found(&block(3, [14, 15, 16], m));
        assert!(report.exact && report.residual < 1e-13, "{report:?}");
        assert_eq!((report.layers, report.unknowns), (layers, unknowns));
        // T_xyz at a corner is a sum of terms of one sign that must vanish
        assert!(report.vanishing > 0 && report.lowest == 0.0);
    }
}

#[test]
fn horizon_two_in_the_plane_is_the_closed_form_along_an_edge() {
    for (scaling, inward) in [(false, 2.0), (true, 1.5)] {
        let mut spec = block(2, [20, 20, 1], 2);
        spec.bonds.partial_volume_correction = scaling;
        let (factors, _) = correct(&spec, SurfaceMethod::Exact).unwrap();
        // half a cell, far from corners
        let row = factors.row[10] as usize;
        assert_eq!(factors.part[row], 0.5);
        let of = |o: [i32; 3]| {
            let found = factors.rows[row].iter().find(|(offset, _)| *offset == o);
            found.map_or(1.0, |(_, x)| x.pair)
        };
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-9, "{x} is not {y}");
        // ½ on average over the bonds in the edge; the solver shares it out among one and two spacings
        let in_edge = of([1, 0, 0]) + of([2, 0, 0]) * if scaling { 1.0 } else { 2.0 };
        near(in_edge, if scaling { 1.0 } else { 1.5 });
        near(of([0, 1, 0]), inward);
        near(of([0, 2, 0]), 1.0);
        near(of([1, 1, 0]), 1.0);
    }
}

#[test]
fn chains_carry_what_missing_bonds_would() {
    for m in [1, 2, 3, 5] {
        let report = found(&block(1, [40, 1, 1], m));
        assert!(report.exact && report.residual < 1e-13, "{report:?}");
        assert!(report.lowest > 0.2499);
    }
}

const LPS: LawSpec = LawSpec::Lps(peridyne::spec::Moduli {
    young: 1.0,
    poisson: 0.3,
});

#[test]
fn state_based_plates_and_blocks_are_exact_with_factors_of_any_sign() {
    for (d, n, m) in [
        (1, [40, 1, 1], 3),
        (2, [24, 20, 1], 2),
        (2, [24, 20, 1], 3),
        (2, [24, 20, 1], 4),
        (3, [10, 11, 12], 2),
        (3, [13, 13, 13], 3),
    ] {
        let mut spec = block(d, n, m);
        spec.materials[0].law = LPS;
        spec.bonds.influence = peridyne::spec::Influence::Inverse;
        let report = found(&spec);
        let [low, high] = report.shares.unwrap();
        assert!(
            report.exact && report.residual < 1e-12,
            "{d} {m} {report:?}"
        );
        assert!(low > -10.0 && high < 20.0, "{d} {m} {report:?}");
    }
}

#[test]
fn refused_with_a_reason() {
    let mut spec = block(2, [10, 10, 1], 2);
    spec.materials[0].law = LawSpec::Atoms(
        PotentialSpec::of(LennardJones {
            epsilon: 1.0,
            sigma: 1.0,
        })
        .ended(2.5, End::Shifted),
    );
    let refused = |spec: &Spec| correct(spec, SurfaceMethod::Exact).unwrap_err();
    assert_eq!(refused(&spec), SurfaceError::Law);
    spec.materials[0].law = LPS;
    let volume = correct(&spec, SurfaceMethod::Volume).unwrap_err();
    assert_eq!(volume, SurfaceError::Published);
    let mut spec = block(2, [10, 10, 1], 2);
    spec.bonds.family = FamilyChoice::List;
    assert_eq!(refused(&spec), SurfaceError::Lattice);
    // a disk of radius 6: four points stick out
    spec.bonds.family = FamilyChoice::Auto;
    spec.body = BodySpec::Lattice {
        kind: LatticeKind::Square,
        spacing: 1.0,
        origin: [0.0; 3],
        region: Region::Sphere {
            center: [0.0; 3],
            radius: 6.0,
        },
        perturb: None,
    };
    assert!(matches!(
        refused(&spec),
        SurfaceError::Loose { count: 4, .. }
    ));
}

#[test]
fn a_body_and_its_period_have_no_surface_there() {
    let mut spec = block(2, [9, 12, 1], 2);
    spec.space.periodic = [Some(9.0), None, None];
    let (factors, report) = correct(&spec, SurfaceMethod::Exact).unwrap();
    assert!(report.unwrap().exact);
    // all points of a row are alike
    for y in 0..12 {
        let row = &factors.row[9 * y..9 * (y + 1)];
        assert!(row.iter().all(|r| *r == row[0]));
    }
}
