use super::*;
use crate::samples::{Random, lattice, sites};
use crate::space::lattice::LatticeKind;
use crate::spec::CrackKind;

fn crack<const D: usize>(shape: CrackShape) -> Crack<D> {
    Crack::new(&shape, [None; D]).unwrap()
}

/// Directed bonds that a crack cuts out of a box of lattice sites of spacing `h`.
fn cut<const D: usize>(
    kind: LatticeKind,
    box_of: [i32; 3],
    h: f64,
    ratio: u32,
    periodic: [bool; D],
    shape: &CrackShape,
) -> u64 {
    let (body, mut interaction) = lattice::<D>(kind, &sites(box_of, |_| true), h, ratio, periodic);
    let crack = Crack::<D>::new(shape, body.period).unwrap();
    interaction.cut(&body, CrackKind::Broken, &|a, b| crack.crosses(&a, &b))
}

#[test]
fn a_chain_loses_the_bonds_across_a_point() {
    // m_ratio 3: pairs at distance 1, 2, 3 across one plane: 1 + 2 + 3
    let h = 0.1;
    for x in [4.5 * h, 4.0 * h, 4.25 * h] {
        let n = cut(
            LatticeKind::Chain,
            [10, 1, 1],
            h,
            3,
            [false],
            &CrackShape::Point { x },
        );
        assert_eq!(n, 2 * 6, "x = {x}");
    }
    // in a ring of ten the same from every place, also across the seam
    for x in [0.5 * h, 0.0, -0.5 * h, 9.5 * h, 8.7 * h, 10.0 * h] {
        let n = cut(
            LatticeKind::Chain,
            [10, 1, 1],
            h,
            3,
            [true],
            &CrackShape::Point { x },
        );
        assert_eq!(n, 2 * 6, "periodic, x = {x}");
    }
}

#[test]
fn a_square_lattice_loses_the_bonds_across_a_segment() {
    // m_ratio 1: one bond per row that the crack passes, between planes or on one, ends on rows included
    let h = 1.0 / 3.0;
    let box_of = [8, 8, 1];
    let vertical = |x: f64, low: f64, high: f64| CrackShape::Segment {
        from: [x * h, low * h, 0.0],
        to: [x * h, high * h, 0.0],
    };
    for (x, low, high, rows) in [
        (3.5, 1.5, 5.5, 4),
        (3.5, 2.0, 5.0, 4),
        (3.0, 2.0, 5.0, 4),
        (3.0, 5.0, 2.0, 4),
        (3.5, 2.1, 2.9, 0),
        (3.5, -9.0, 99.0, 8),
        (0.0, -9.0, 99.0, 8), // the normal is −x: points on the plane lie beyond it
        (0.0, 99.0, -9.0, 0), // turned around, they lie on the side of the body
        (-0.5, -9.0, 99.0, 0),
    ] {
        let n = cut(
            LatticeKind::Square,
            box_of,
            h,
            1,
            [false; 2],
            &vertical(x, low, high),
        );
        assert_eq!(n, 2 * rows, "x = {x}, {low}..{high}");
    }
    // a diagonal between the sites: x + y = 7.5 cuts, in every row, the one bond that it meets, and in every column
    let n = cut(
        LatticeKind::Square,
        box_of,
        h,
        1,
        [false; 2],
        &CrackShape::Segment {
            from: [-h, 8.5 * h, 0.0],
            to: [8.5 * h, -h, 0.0],
        },
    );
    assert_eq!(n, 2 * 14);
}

#[test]
fn a_cube_loses_the_bonds_across_flat_shapes() {
    let h = 0.0005;
    let box_of = [6, 6, 6];
    let count = |shape: &CrackShape| cut(LatticeKind::Cubic, box_of, h, 1, [false; 3], shape);
    let (x, mid) = (2.5 * h, 2.0 * h);
    // in the plane x = 2.5: sites within 1 of (2, 2): 5; within √2: 9
    for (radius, bonds) in [(0.5, 1), (1.0, 5), (1.4, 5), (1.5, 9)] {
        for x in [x, 2.0 * h, 3.0 * h] {
            let disk = CrackShape::Disk {
                center: [x, mid, mid],
                normal: [-3.0, 0.0, 0.0],
                radius: radius * h,
            };
            assert_eq!(count(&disk), 2 * bonds, "radius {radius}, x {x}");
        }
    }
    // extruded along z: 3 rows × 6 layers
    assert_eq!(
        count(&CrackShape::Segment {
            from: [x, 0.5 * h, 7.0],
            to: [x, 3.5 * h, -2.0]
        }),
        2 * 18
    );
    // an L in y–z, rim on sites: columns y 0..4 at z 0..1 (5 × 2), and y 0..1 at z 2..4 (2 × 3)
    let corner = |y: f64, z: f64| [x, y * h, z * h];
    let mut corners = vec![
        corner(0.0, 0.0),
        corner(4.0, 0.0),
        corner(4.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, 4.0),
        corner(0.0, 4.0),
    ];
    assert_eq!(
        count(&CrackShape::Polygon {
            corners: corners.clone()
        }),
        2 * 16
    );
    corners.reverse();
    assert_eq!(count(&CrackShape::Polygon { corners }), 2 * 16);
    // whole planes, m_ratio 3: pairs with Δx > 0 across, N_y N_z with all neighbours inside counted by brute force
    let all = CrackShape::Segment {
        from: [3.0 * h, -1.0, 0.0],
        to: [3.0 * h, 1.0, 0.0],
    };
    let mut pairs = 0;
    for a in 0..216 {
        for b in 0..216 {
            let (p, q) = ([a % 6, a / 6 % 6, a / 36], [b % 6, b / 6 % 6, b / 36]);
            let near: i32 = (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum();
            // the normal is −x: the plane x = 3 itself lies on the low side
            pairs += u64::from(near <= 9 && (p[0] <= 3) != (q[0] <= 3));
        }
    }
    assert_eq!(
        cut(LatticeKind::Cubic, box_of, h, 3, [false; 3], &all),
        pairs
    );
}

#[test]
fn the_direction_of_a_bond_does_not_matter() {
    let mut random = Random(7);
    let cracks = [
        crack::<3>(CrackShape::Disk {
            center: [0.1, 0.0, 0.0],
            normal: [1.0, 2.0, -0.5],
            radius: 0.7,
        }),
        crack::<3>(CrackShape::Polygon {
            corners: vec![
                [-0.8, -0.8, 0.0],
                [0.8, -0.8, 0.0],
                [0.0, 0.0, 0.0],
                [0.8, 0.8, 0.0],
            ],
        }),
        crack::<3>(CrackShape::Segment {
            from: [-0.5, 0.1, 0.0],
            to: [0.5, 0.3, 0.0],
        }),
    ];
    for crack in &cracks {
        let mut hits = 0;
        for _ in 0..2000 {
            let a: [f64; 3] = crate::array::from_fn(|_| random.next());
            let b: [f64; 3] = crate::array::from_fn(|_| random.next());
            assert_eq!(crack.crosses(&a, &b), crack.crosses(&b, &a));
            hits += u32::from(crack.crosses(&a, &b));
        }
        assert!(hits > 50 && hits < 1500, "{hits}");
    }
}

#[test]
fn the_notch_of_a_polygon_is_not_cracked() {
    let c = crack::<3>(CrackShape::Polygon {
        corners: vec![
            [0.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [4.0, 4.0, 0.0],
            [2.0, 1.0, 0.0],
            [0.0, 4.0, 0.0],
        ],
    });
    let through = |x: f64, y: f64| c.crosses(&[x, y, -0.5], &[x, y, 0.5]);
    assert!(through(2.0, 0.5) && through(0.5, 2.0) && through(3.5, 2.0));
    assert!(!through(2.0, 2.0) && !through(2.0, 3.9) && !through(-0.1, 1.0));
    assert!(
        through(2.0, 1.0) && through(4.0, 2.0),
        "the rim belongs to the crack"
    );
}

#[test]
fn shapes_that_are_none_are_refused() {
    let message = |e: Result<Crack<3>, BuildError>| e.unwrap_err().to_string();
    let three = |s: CrackShape| message(Crack::new(&s, [None; 3]));
    let zero = [0.0; 3];
    let disk = |normal, radius| CrackShape::Disk {
        center: zero,
        normal,
        radius,
    };
    assert!(three(disk(zero, 1.0)).contains("normal"));
    assert!(three(disk([0.0, 0.0, 1.0], 0.0)).contains("radius"));
    assert!(three(disk([0.0, f64::NAN, 1.0], 1.0)).contains("finite"));
    assert!(
        three(CrackShape::Segment {
            from: zero,
            to: [0.0, 0.0, 1.0]
        })
        .contains("length")
    );
    let polygon = |corners: Vec<[f64; 3]>| CrackShape::Polygon { corners };
    assert!(three(polygon(vec![zero, [1.0, 0.0, 0.0]])).contains("2 corners"));
    assert!(three(polygon(vec![zero, [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]])).contains("area"));
    assert!(
        three(polygon(vec![
            zero,
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.1],
            [0.0, 1.0, 0.0]
        ]))
        .contains("flat")
    );
    assert!(three(CrackShape::Point { x: 0.0 }).contains("point"));
    let two = Crack::<2>::new(&disk([0.0, 0.0, 1.0], 1.0), [None; 2]).unwrap_err();
    assert!(two.message.contains("disk") && two.help.unwrap().contains("segment"));
    let one = CrackShape::Segment {
        from: zero,
        to: [1.0, 0.0, 0.0],
    };
    assert!(Crack::<1>::new(&one, [None]).is_err());
    // very small shapes are shapes
    assert!(Crack::<3>::new(&disk([0.0, 0.0, 1e-200], 1e-12), [None; 3]).is_ok());
}
