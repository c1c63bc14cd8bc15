use super::*;
use crate::space::lattice::LatticeKind;

fn holds(kind: LatticeKind, spacing: f64, origin: [f64; 3], region: &Region, q: [i32; 3]) -> bool {
    Membership::new(
        &Lattice {
            kind,
            spacing,
            origin,
        },
        region,
    )
    .unwrap()
    .contains(q)
}

#[test]
fn a_radius_means_its_fraction() {
    // 37 mm at half a millimetre: (24, 70) lies on the circle, and floating point says it does not
    let disk = Region::Cylinder {
        axis: 1,
        center: [0.0; 3],
        radius: 0.037,
        low: 0.0,
        high: 1.0,
    };
    let spacing = 0.0005;
    assert!(!disk.contains(&[24.0 * spacing, 0.0, 70.0 * spacing]));
    assert!(holds(
        LatticeKind::Cubic,
        spacing,
        [0.0; 3],
        &disk,
        [96, 0, 280]
    ));
    assert!(!holds(
        LatticeKind::Cubic,
        spacing,
        [0.0; 3],
        &disk,
        [96, 0, 284]
    ));
    // a centre off the sites: distances² are in quarters, 2.5² + 6² = 6.5²
    let off = Region::Sphere {
        center: [0.05, 0.1, 0.1],
        radius: 0.65,
    };
    assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &off, [12, 28, 4]));
    // thirds: (1 + 2/3)² + 4² = (13/3)²
    let third = Region::Sphere {
        center: [0.1 / 3.0, 0.0, 0.0],
        radius: 1.3 / 3.0,
    };
    assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &third, [8, 16, 0]));
}

#[test]
fn blocks_and_planes_hold_their_faces() {
    let block = Region::Block {
        low: [0.1 + 0.2, 0.0, -f64::INFINITY],
        high: [0.7, f64::INFINITY, 0.0],
    };
    for (q, inside) in [
        ([12, 0, 0], true),
        ([28, 0, 0], true),
        ([11, 0, 0], false),
        ([29, 0, 0], false),
        ([12, -1, 0], false),
        ([12, 999, -999], true),
    ] {
        assert_eq!(
            holds(LatticeKind::Cubic, 0.1, [0.0; 3], &block, q),
            inside,
            "{q:?}"
        );
    }
    let n = 1.0 / 3.0f64.sqrt();
    let plane = Region::HalfSpace {
        point: [0.3, 0.3, 0.3],
        normal: [n, n, n],
    };
    assert!(holds(LatticeKind::Fcc, 0.1, [0.0; 3], &plane, [34, 2, 0]));
    assert!(!holds(LatticeKind::Fcc, 0.1, [0.0; 3], &plane, [34, 2, 1]));
    let skew = Region::HalfSpace {
        point: [0.0; 3],
        normal: [1.0, std::f64::consts::PI, 0.0],
    };
    assert!(holds(LatticeKind::Cubic, 0.1, [0.0; 3], &skew, [0, 0, 4]));
    assert!(!holds(
        LatticeKind::Cubic,
        0.1,
        [0.0; 3],
        &skew,
        [-12, 4, 0]
    ));
}

#[test]
fn triangular_rows_are_exact() {
    let s = 0.3;
    let radius = s * 7.0; // 7² = 5.5² + 3·2.5²
    let disk = Region::Sphere {
        center: [0.0; 3],
        radius,
    };
    assert!(holds(
        LatticeKind::Triangular,
        s,
        [0.0; 3],
        &disk,
        [22, 10, 0]
    ));
    let rows = Region::Block {
        low: [-1.0; 3],
        high: [1.0, 3f64.sqrt() / 2.0 * s * 3.0, 1.0],
    };
    assert!(holds(
        LatticeKind::Triangular,
        s,
        [0.0; 3],
        &rows,
        [2, 6, 0]
    ));
}

#[test]
fn the_origin_moves_the_sites_but_not_the_unused_axes() {
    let block = Region::Block {
        low: [1.0, 0.0, 0.0],
        high: [2.0, 0.0, 0.0],
    };
    assert!(holds(
        LatticeKind::Chain,
        0.1,
        [0.05, 9.0, 9.0],
        &block,
        [38, 0, 0]
    ));
    assert!(!holds(
        LatticeKind::Chain,
        0.1,
        [0.05, 9.0, 9.0],
        &block,
        [37, 0, 0]
    ));
}
