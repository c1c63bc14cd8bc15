use super::*;
use crate::netcdf::Version;
use crate::netcdf::tests::{Given, file};
use proptest::prelude::*;

type Variables = Vec<(
    &'static str,
    &'static [&'static str],
    Given,
    Option<&'static str>,
)>;

const DIMENSIONS: [(&str, usize); 14] = [
    ("num_nodes", 12),
    ("num_dim", 3),
    ("len_name", 33),
    ("num_el_blk", 2),
    ("num_el_in_blk1", 1),
    ("num_el_in_blk2", 1),
    ("eight", 8),
    ("six", 6),
    ("num_node_sets", 2),
    ("four", 4),
    ("two", 2),
    ("one", 1),
    ("num_side_sets", 1),
    ("num_elem_sets", 1),
];

/// Two cubes side by side along x, the second cut to a wedge; nodes 1 to 12, x from 0 to 2.
pub(super) fn cubes() -> Variables {
    let nodes: Vec<[f64; 3]> = (0..12)
        .map(|n| [n % 3, n / 3 % 2, n / 6].map(f64::from))
        .collect();
    let axis = |a: usize| Given::Doubles(nodes.iter().map(|x| x[a]).collect());
    vec![
        ("coordx", &["num_nodes"], axis(0), None),
        ("coordy", &["num_nodes"], axis(1), None),
        ("coordz", &["num_nodes"], axis(2), None),
        ("eb_prop1", &["num_el_blk"], Given::Ints(vec![10, 20]), None),
        (
            "eb_names",
            &["num_el_blk", "len_name"],
            Given::Text(vec!["steel", ""]),
            None,
        ),
        (
            "connect1",
            &["num_el_in_blk1", "eight"],
            Given::Ints(vec![1, 2, 5, 4, 7, 8, 11, 10]),
            Some("HEX8"),
        ),
        (
            "connect2",
            &["num_el_in_blk2", "six"],
            Given::Ints(vec![2, 3, 6, 8, 9, 12]),
            Some("wedge"),
        ),
        (
            "ns_prop1",
            &["num_node_sets"],
            Given::Ints(vec![3, 7]),
            None,
        ),
        (
            "ns_names",
            &["num_node_sets", "len_name"],
            Given::Text(vec!["left", ""]),
            None,
        ),
        ("node_ns1", &["four"], Given::Ints(vec![1, 4, 7, 10]), None),
        ("node_ns2", &["two"], Given::Ints(vec![9, 12]), None),
        ("ss_prop1", &["num_side_sets"], Given::Ints(vec![4]), None),
        ("elem_ss1", &["one"], Given::Ints(vec![2]), None),
        ("side_ss1", &["one"], Given::Ints(vec![2]), None),
        ("els_prop1", &["num_elem_sets"], Given::Ints(vec![5]), None),
        (
            "els_names",
            &["num_elem_sets", "len_name"],
            Given::Text(vec!["both"]),
            None,
        ),
        ("elem_els1", &["two"], Given::Ints(vec![2, 1]), None),
    ]
}

pub(super) fn bytes(variables: &Variables) -> Vec<u8> {
    file(Version::Offset64, &DIMENSIONS, variables)
}

fn failure(change: impl FnOnce(&mut Variables)) -> String {
    let mut variables = cubes();
    change(&mut variables);
    parse_exodus(bytes(&variables), "f")
        .unwrap_err()
        .to_string()
}

fn at<'a>(variables: &'a mut Variables, name: &str) -> &'a mut Given {
    let found = variables.iter_mut().find(|v| v.0 == name);
    &mut found.unwrap().2
}

#[test]
fn blocks_are_marks_and_everything_named_is_a_set() {
    for version in [Version::Offset64, Version::Data64] {
        let points = parse_exodus(file(version, &DIMENSIONS, &cubes()), "f").unwrap();
        assert_eq!(points.dimension, Some(3));
        for (got, wanted) in points.cloud.volume.iter().zip([1.0, 0.5]) {
            assert!((got - wanted).abs() < 1e-15, "{got} {wanted}");
        }
        for got in points.cloud.position[0] {
            assert!((got - 0.5).abs() < 1e-15, "{got}");
        }
        for (got, wanted) in points.cloud.position[1]
            .iter()
            .zip([5.0 / 3.0, 1.0 / 3.0, 0.5])
        {
            assert!((got - wanted).abs() < 1e-15, "{got} {wanted}");
        }
        assert_eq!(points.cloud.mark, [10, 20]);
        let names = [(10, "steel".to_string()), (20, "block_20".to_string())];
        assert_eq!(points.cloud.names, names);
        let sets: Vec<(&str, &[u32])> = { points.cloud.sets.iter() }
            .map(|(n, s)| (&**n, &**s))
            .collect();
        let wanted: [(&str, &[u32]); 6] = [
            ("steel", &[0]),
            ("block_20", &[1]),
            ("left", &[0]),
            ("nodelist_7", &[1]),
            ("surface_4", &[1]),
            ("both", &[0, 1]),
        ];
        assert_eq!(sets, wanted);
        // the wedge's second side lies across x; one side of the first cube has all its nodes in a set
        let faces: Vec<(&str, &[f64])> = { points.cloud.faces.iter() }
            .map(|(n, a)| (&**n, &**a))
            .collect();
        assert_eq!(faces.len(), 2, "{faces:?}");
        assert_eq!(faces[0], ("left", &[1.0][..]));
        assert_eq!(faces[1], ("surface_4", &[1.0][..]));
    }
    // its third is the slanted one, and its ends are triangles
    for (side, wanted) in [(3, 2f64.sqrt()), (4, 0.5), (5, 0.5)] {
        let mut variables = cubes();
        *at(&mut variables, "side_ss1") = Given::Ints(vec![side]);
        let points = parse_exodus(bytes(&variables), "f").unwrap();
        let (name, areas) = &points.cloud.faces[1];
        assert!(
            name == "surface_4" && (areas[0] - wanted).abs() < 1e-15,
            "{areas:?}"
        );
    }
}

#[test]
fn sets_of_nodes_hold_cells_that_touch_them_or_lie_in_them() {
    // the cube and the wedge share nodes 2 and 8; the cube alone has all of the first eight
    let sets = |nodes: Vec<i32>, holds: Holds| -> Vec<u32> {
        let mut variables = cubes();
        variables.retain(|v| v.0 != "node_ns1");
        variables.push(("node_ns1", &["eight"], Given::Ints(nodes), None));
        let points = parse_holding(bytes(&variables), "f", holds).unwrap();
        let set = points.cloud.sets.iter().find(|(name, _)| name == "left");
        set.map_or(vec![], |(_, s)| s.to_vec())
    };
    let cube = vec![1, 2, 5, 4, 7, 8, 11, 10];
    assert_eq!(sets(cube.clone(), Holds::Touching), [0, 1]);
    assert_eq!(sets(cube, Holds::Enclosed), [0]);
    let all_but_one = vec![1, 2, 5, 4, 7, 8, 11, 11];
    assert!(sets(all_but_one, Holds::Enclosed).is_empty());
}

/// Three spheres in two blocks.
fn spheres(attributes: usize, values: Vec<f64>, names: Option<Vec<&'static str>>) -> Vec<u8> {
    let dimensions = [
        ("num_nodes", 3),
        ("num_el_blk", 2),
        ("num_el_in_blk1", 2),
        ("num_el_in_blk2", 1),
        ("num_nod_per_el", 1),
        ("num_att", attributes),
        ("len_name", 33),
    ];
    let second = values[..attributes].to_vec();
    let mut variables: Variables = vec![
        (
            "coordx",
            &["num_nodes"],
            Given::Doubles(vec![0.0, 1.0, 2.0]),
            None,
        ),
        ("coordy", &["num_nodes"], Given::Doubles(vec![0.5; 3]), None),
        ("eb_prop1", &["num_el_blk"], Given::Ints(vec![1, 2]), None),
        (
            "connect1",
            &["num_el_in_blk1", "num_nod_per_el"],
            Given::Ints(vec![3, 1]),
            Some("SPHERE"),
        ),
        (
            "connect2",
            &["num_el_in_blk2", "num_nod_per_el"],
            Given::Ints(vec![2]),
            Some("SPHERE"),
        ),
        (
            "attrib1",
            &["num_el_in_blk1", "num_att"],
            Given::Doubles(values),
            None,
        ),
        (
            "attrib2",
            &["num_el_in_blk2", "num_att"],
            Given::Doubles(second),
            None,
        ),
    ];
    if let Some(names) = names {
        for name in ["attrib_name1", "attrib_name2"] {
            let names = Given::Text(names.clone());
            variables.push((name, &["num_att", "len_name"], names, None));
        }
    }
    file(Version::Offset64, &dimensions, &variables)
}

#[test]
fn spheres_have_their_volumes() {
    for (attributes, values, names) in [
        (2, vec![9.0, 0.25, 9.0, 0.5], None),
        (2, vec![9.0, 0.25, 9.0, 0.5], Some(vec!["", ""])),
        (1, vec![0.25, 0.5], Some(vec!["Volume"])),
        (
            3,
            vec![0.25, 1.0, 9.0, 0.5, 1.0, 9.0],
            Some(vec!["VOLUME", "r", "s"]),
        ),
    ] {
        let points = parse_exodus(spheres(attributes, values, names), "f").unwrap();
        assert_eq!(points.cloud.volume, [0.25, 0.5, 0.25]);
        let wanted = [[2.0, 0.5, 0.0], [0.0, 0.5, 0.0], [1.0, 0.5, 0.0]];
        assert_eq!(points.cloud.position, wanted);
        assert_eq!(points.cloud.mark, [1, 1, 2]);
        // points as in plain text: the deck says the dimension
        assert_eq!(points.dimension, None);
    }
    let told = parse_exodus(spheres(1, vec![0.25, 0.5], None), "f").unwrap_err();
    assert!(
        told.message.contains("SPHERE elements without volumes"),
        "{told}"
    );
    let none = spheres(2, vec![9.0, 0.0, 9.0, 0.5], None);
    let told = parse_exodus(none, "f").unwrap_err();
    assert!(
        told.message
            .contains("element 1 of block block_1 has the volume 0"),
        "{told}"
    );
}

#[test]
fn points_at_one_place_are_refused() {
    let dimensions = [
        ("num_nodes", 1),
        ("num_el_blk", 1),
        ("two", 2),
        ("one", 1),
        ("att", 2),
    ];
    let variables: Variables = vec![
        ("coordx", &["num_nodes"], Given::Doubles(vec![0.0]), None),
        ("eb_prop1", &["num_el_blk"], Given::Ints(vec![1]), None),
        (
            "connect1",
            &["two", "one"],
            Given::Ints(vec![1, 1]),
            Some("SPHERE"),
        ),
        (
            "attrib1",
            &["two", "att"],
            Given::Doubles(vec![1.0; 4]),
            None,
        ),
    ];
    let told = parse_exodus(file(Version::Offset64, &dimensions, &variables), "f").unwrap_err();
    assert!(told.message.contains("coincides"), "{told}");
}

#[test]
fn flat_cells_have_areas_and_shells_make_no_body() {
    let dimensions = [("num_nodes", 4), ("num_el_blk", 1), ("one", 1), ("four", 4)];
    let mesh = |kind: &'static str| {
        let variables: Variables = vec![
            (
                "coordx",
                &["num_nodes"],
                Given::Doubles(vec![0.0, 2.0, 2.0, 0.0]),
                None,
            ),
            (
                "coordy",
                &["num_nodes"],
                Given::Doubles(vec![0.0, 0.0, 3.0, 3.0]),
                None,
            ),
            (
                "connect1",
                &["one", "four"],
                Given::Ints(vec![1, 2, 3, 4]),
                Some(kind),
            ),
        ];
        parse_exodus(file(Version::Offset64, &dimensions, &variables), "f")
    };
    let points = mesh("QUAD4").unwrap();
    assert_eq!(
        (points.dimension, points.cloud.volume),
        (Some(2), vec![6.0])
    );
    // without ids blocks are counted
    assert_eq!(points.cloud.names, [(1, "block_1".to_string())]);
    let told = mesh("SHELL4").unwrap_err().to_string();
    assert!(told.contains("block block_1 has shells"), "{told}");
    let told = mesh("SUPER").unwrap_err().to_string();
    assert!(
        told.contains("elements \"SUPER\" of 4 nodes are not read"),
        "{told}"
    );
}

#[test]
fn mistakes_are_named() {
    for (told, expected) in [
        (
            failure(|v| *at(v, "connect1") = Given::Ints(vec![1, 2, 5, 4, 7, 8, 11, 99])),
            "element 1 refers to node 99, which does not exist",
        ),
        (
            failure(|v| *at(v, "connect1") = Given::Ints(vec![-1, 2, 5, 4, 7, 8, 11, 10])),
            "element 1 refers to node 0",
        ),
        (
            failure(|v| *at(v, "coordy") = Given::Doubles(vec![f64::NAN; 12])),
            "node 1 is at",
        ),
        (
            failure(|v| *at(v, "coordz") = Given::Doubles(vec![0.0; 12])),
            "element 1 has no positive volume",
        ),
        (
            failure(|v| *at(v, "elem_ss1") = Given::Ints(vec![3])),
            "set surface_4 refers to element 3",
        ),
        (
            failure(|v| *at(v, "elem_els1") = Given::Ints(vec![0, 1])),
            "set both refers to element 0",
        ),
        (
            failure(|v| v.retain(|v| v.0 != "connect2")),
            "block block_20 has no elements",
        ),
        (
            failure(|v| v.retain(|v| !v.0.starts_with("coord"))),
            "it is no Exodus mesh",
        ),
        (
            failure(|v| v.retain(|v| !v.0.starts_with("connect"))),
            "block steel has no elements",
        ),
        (
            failure(|v| at_type(v, "connect2", "HEX8")),
            "elements \"HEX8\" of 6 nodes are not read",
        ),
        (
            failure(|v| *at(v, "coordx") = Given::Ints(vec![0; 12])),
            "coordx should hold numbers with a point, it holds Int",
        ),
    ] {
        assert!(told.contains(expected), "{told}: {expected}");
        assert!(told.starts_with("f: "), "{told}");
    }
}

fn at_type(variables: &mut Variables, name: &str, kind: &'static str) {
    let found = variables.iter_mut().find(|v| v.0 == name);
    found.unwrap().3 = Some(kind);
}

#[test]
fn nodes_in_one_table_are_read_as_old_files_have_them() {
    let mut variables = cubes();
    let axes = ["coordx", "coordy", "coordz"].map(|a| match at(&mut variables, a) {
        Given::Doubles(x) => x.clone(),
        Given::Text(_) | Given::Ints(_) | Given::Floats(_) => panic!(),
    });
    variables.retain(|v| !v.0.starts_with("coord"));
    let all = Given::Doubles(axes.concat());
    variables.push(("coord", &["num_dim", "num_nodes"], all, None));
    let old = parse_exodus(bytes(&variables), "f").unwrap();
    assert_eq!(old, parse_exodus(bytes(&cubes()), "f").unwrap());
}

#[test]
fn a_mesh_that_is_cut_short_is_refused_at_every_byte() {
    let whole = bytes(&cubes());
    for length in 0..whole.len() {
        let told = parse_exodus(whole[..length].to_vec(), "f").unwrap_err();
        assert!(!told.message.is_empty());
    }
}

proptest! {
    #[test]
    fn damaged_meshes_are_read_or_refused(
        places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut damaged = bytes(&cubes());
        for (place, byte) in places {
            let at = place.index(damaged.len());
            damaged[at] = byte;
        }
        if let Err(told) = parse_exodus(damaged, "f") {
            prop_assert!(!told.message.is_empty());
        }
    }
}
