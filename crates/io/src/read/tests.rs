use super::*;
use proptest::prelude::*;

mod foreign;

fn read(text: &str, extension: &str) -> Points {
    parse(text, "f", extension).unwrap_or_else(|e| panic!("{e}"))
}

fn failure(text: &str, extension: &str) -> String {
    parse(text, "f", extension).expect_err(text).to_string()
}

const PLATE: &str = "** two squares, one cut in halves
*HEADING
whatever
*NODE, NSET=N
1, 0., 0.
2, 2., 0.
3, 2., 2.
4, 0., 2.
5, 4., 0.
6, 4., 2.
*ELEMENT, TYPE=CPS4R, ELSET=LEFT
1, 1, 2,
3, 4
*Element, type=CPS3, elset=Right
2, 2, 5, 6
3, 2, 6, 3
*ELSET, ELSET=TIP
3
*ELSET, ELSET=EVERY, GENERATE
1, 3, 1
*MATERIAL, NAME=M
";

#[test]
fn abaqus_cells_become_points() {
    let points = read(PLATE, "inp");
    assert_eq!(points.dimension, Some(2));
    assert_eq!(points.cloud.volume, [4.0, 2.0, 2.0]);
    assert_eq!(points.cloud.position[0], [1.0, 1.0, 0.0]);
    assert!((points.cloud.position[1][0] - 10.0 / 3.0).abs() < 1e-15);
    // the smallest set that holds it names an element
    let names: Vec<(i32, &str)> = points
        .cloud
        .names
        .iter()
        .map(|(m, n)| (*m, n.as_str()))
        .collect();
    assert_eq!(points.cloud.mark, [1, 2, 3]);
    assert_eq!(names, [(1, "LEFT"), (2, "Right"), (3, "TIP")]);
    // sets may overlap, marks do not; N has all nodes
    let sets: Vec<(&str, &[u32])> = points
        .cloud
        .sets
        .iter()
        .map(|(n, s)| (&**n, &**s))
        .collect();
    let wanted: [(&str, &[u32]); 5] = [
        ("LEFT", &[0]),
        ("Right", &[1, 2]),
        ("TIP", &[2]),
        ("EVERY", &[0, 1, 2]),
        ("N", &[0, 1, 2]),
    ];
    assert_eq!(sets, wanted);
}

#[test]
fn solids_have_their_volumes() {
    let nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,2,0\n4,0,2,0\n5,0,0,3\n6,1,0,3\n7,1,2,3\n8,0,2,3\n";
    for (element, volume, centroid) in [
        ("C3D8\n1,1,2,3,4,5,6,7,8", 6.0, [0.5, 1.0, 1.5]),
        ("C3D4\n1,1,2,3,5", 1.0, [0.5, 0.5, 0.75]),
        ("C3D6\n1,1,2,3,5,6,7", 3.0, [2.0 / 3.0, 2.0 / 3.0, 1.5]),
        ("C3D5\n1,1,2,3,4,5", 2.0, [0.375, 0.75, 0.75]),
    ] {
        let points = read(&format!("{nodes}*ELEMENT,TYPE={element}\n"), "inp");
        assert!(
            (points.cloud.volume[0] - volume).abs() < 1e-14,
            "{element}: {}",
            points.cloud.volume[0]
        );
        for (got, wanted) in points.cloud.position[0].iter().zip(centroid) {
            assert!(
                (got - wanted).abs() < 1e-14,
                "{element}: {:?}",
                points.cloud.position
            );
        }
    }
}

const OLD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"edge\"\n2 5 \"glass plate\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n1 1 2 7 1 1 2\n2 2 2 5 1 1 2 3\n3 2 2 5 1 1 3 4\n$EndElements\n";

const NEW: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"edge\"\n2 5 \"glass plate\"\n$EndPhysicalNames\n$Entities\n1 1 1 0\n1 0 0 0 0\n1 0 0 0 1 0 0 1 7 2 1 1\n1 0 0 0 1 1 0 1 5 1 1\n$EndEntities\n$Nodes\n2 4 1 4\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n2 1 0 2\n3\n4\n1 1 0\n0 1 0\n$EndNodes\n$Elements\n2 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 2\n2 1 2 3\n3 1 3 4\n$EndElements\n";

#[test]
fn both_gmsh_formats_say_the_same() {
    let (old, new) = (read(OLD, "msh"), read(NEW, "msh"));
    assert_eq!(old, new);
    assert_eq!(old.cloud.volume, [0.5, 0.5]);
    assert_eq!(old.cloud.mark, [5, 5]);
    assert_eq!(old.cloud.names, [(5, "glass plate".to_string())]);
    assert_eq!(old.dimension, Some(2));
    // the edge is one of the first triangle's
    let sets: Vec<(&str, &[u32])> = old.cloud.sets.iter().map(|(n, s)| (&**n, &**s)).collect();
    assert_eq!(sets, [("glass plate", &[0, 1][..]), ("edge", &[0])]);
    assert_eq!(
        old.notes,
        [
            "ignored 1 lines, as the body is 2-D; sets of the mesh: glass plate (2 points), edge (1 points)"
        ]
    );
}

/// Two cubes side by side along x: nodes 1 to 12, x from 0 to 2.
const CUBES: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n\
    7,0,0,1\n8,1,0,1\n9,2,0,1\n10,0,1,1\n11,1,1,1\n12,2,1,1\n\
    *ELEMENT,TYPE=C3D8\n1,1,2,5,4,7,8,11,10\n2,2,3,6,5,8,9,12,11\n";

#[test]
fn sets_of_nodes_surfaces_lines_and_vertices_are_sets_of_the_points_beside_them() {
    let more = "*ELEMENT,TYPE=S4R,ELSET=RIGHT\n3,3,6,12,9\n*ELEMENT,TYPE=T3D2,ELSET=EDGE\n4,1,4\n5,2,5\n\
        *ELEMENT,TYPE=MASS,ELSET=WEIGHT\n6,3\n*ELEMENT,TYPE=S4,ELSET=MIDDLE\n7,2,5,11,8\n\
        *NSET,NSET=LEFT\n1,4,7,10\n*NSET,NSET=TOP,GENERATE\n7,12,1\n*NSET,NSET=WALL\n2,5,8,11\n\
        *NSET,NSET=LINE\n3,6\n*NSET,NSET=CORNER\n12\n*NSET,NSET=BOTH\nLEFT,CORNER\n*NSET,NSET=FAR\n99\n\
        *NSET,NSET=FIRST\n1,2,5,4,7,8,11,10\n";
    let points = read(&format!("{CUBES}{more}"), "inp");
    let sets: std::collections::BTreeMap<&str, &[u32]> = points
        .cloud
        .sets
        .iter()
        .map(|(n, s)| (&**n, &**s))
        .collect();
    for (name, wanted) in [
        ("RIGHT", &[1][..]),
        // the second line is one of both cubes
        ("EDGE", &[0, 1]),
        ("MIDDLE", &[0, 1]),
        ("LEFT", &[0]),
        ("TOP", &[0, 1]),
        ("WALL", &[0, 1]),
        ("LINE", &[1]),
        ("CORNER", &[1]),
        // the corner alone is no side
        ("BOTH", &[0]),
        // the whole inner side belongs to the other cube, too
        ("FIRST", &[0]),
    ] {
        assert_eq!(sets.get(name), Some(&wanted), "{name}");
    }
    assert!(!sets.contains_key("FAR") && !sets.contains_key("WEIGHT"));
    assert_eq!(points.notes.len(), 2, "{:?}", points.notes);
    assert!(points.notes[0].contains("\"FAR\" of the mesh touches no cell"));
    assert!(points.notes[1].contains("2 quadrilaterals, 2 lines, 1 elements MASS"));
}

/// The same as `OLD` and `NEW` in bytes, `swap` of the other order.
fn binary(new: bool, swap: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let text = |out: &mut Vec<u8>, t: &str| out.extend(t.as_bytes());
    let put = |out: &mut Vec<u8>, bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if swap {
            bytes.reverse();
        }
        out.extend(bytes);
    };
    let ints = |out: &mut Vec<u8>, all: &[i32]| all.iter().for_each(|i| put(out, &i.to_le_bytes()));
    let sizes =
        |out: &mut Vec<u8>, all: &[u64]| all.iter().for_each(|i| put(out, &i.to_le_bytes()));
    let reals =
        |out: &mut Vec<u8>, all: &[f64]| all.iter().for_each(|i| put(out, &i.to_le_bytes()));
    let version = if new { "4.1" } else { "2.2" };
    text(&mut out, &format!("$MeshFormat\n{version} 1 8\n"));
    ints(&mut out, &[1]);
    text(
        &mut out,
        "\n$EndMeshFormat\n$PhysicalNames\n2\n1 7 \"edge\"\n2 5 \"glass plate\"\n$EndPhysicalNames\n",
    );
    let nodes = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    if new {
        text(&mut out, "$Entities\n");
        sizes(&mut out, &[1, 1, 1, 0]);
        ints(&mut out, &[1]);
        reals(&mut out, &[0.0; 3]);
        sizes(&mut out, &[0]);
        for (group, bounds) in [(7, [1, 1]), (5, [1, 1])] {
            ints(&mut out, &[1]);
            reals(&mut out, &[0.0; 6]);
            sizes(&mut out, &[1]);
            ints(&mut out, &[group]);
            sizes(&mut out, &[2]);
            ints(&mut out, &bounds);
        }
        text(&mut out, "\n$EndEntities\n$Nodes\n");
        sizes(&mut out, &[2, 4, 1, 4]);
        for (dimension, first) in [(1, 0), (2, 2)] {
            ints(&mut out, &[dimension, 1, 0]);
            sizes(&mut out, &[2, first + 1, first + 2]);
            nodes[first as usize..][..2]
                .iter()
                .for_each(|x| reals(&mut out, x));
        }
        text(&mut out, "\n$EndNodes\n$Elements\n");
        sizes(&mut out, &[2, 3, 1, 3]);
        ints(&mut out, &[1, 1, 1]);
        sizes(&mut out, &[1, 1, 1, 2]);
        ints(&mut out, &[2, 1, 2]);
        sizes(&mut out, &[2, 2, 1, 2, 3, 3, 1, 3, 4]);
    } else {
        text(&mut out, "$Nodes\n4\n");
        for (id, x) in nodes.iter().enumerate() {
            ints(&mut out, &[id as i32 + 1]);
            reals(&mut out, x);
        }
        text(&mut out, "\n$EndNodes\n$Elements\n3\n");
        ints(&mut out, &[1, 1, 2, 1, 7, 1, 1, 2]);
        ints(&mut out, &[2, 2, 2, 2, 5, 1, 1, 2, 3, 3, 5, 1, 1, 3, 4]);
    }
    text(&mut out, "\n$EndElements\n$Other\n\u{1}\u{2}\n$EndOther\n");
    out
}

#[test]
fn binary_meshes_say_the_same_as_text() {
    let text = read(OLD, "msh");
    for (new, swap) in [(false, false), (false, true), (true, false), (true, true)] {
        let bytes = binary(new, swap);
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("plate.msh");
        std::fs::write(&path, &bytes).unwrap();
        assert_eq!(points(&path, Frame::Last).unwrap(), text);
        // cut off anywhere it is refused, unless nothing but the last section is lost
        let whole = bytes.len() - "$Other\n\u{1}\u{2}\n$EndOther\n".len();
        for cut in 0..whole - 1 {
            std::fs::write(&path, &bytes[..cut]).unwrap();
            let error = points(&path, Frame::Last).unwrap_err();
            assert!(!error.message.is_empty(), "{new} {swap} {cut}");
        }
    }
}

#[test]
fn a_header_is_told_how_to_begin() {
    for text in ["x y z volume\n0 0 0 1\n", "x,y,z,V,mark\n0,0,0,1,2\n"] {
        let said = failure(text, "csv");
        assert!(
            said.starts_with("f:1: ") && said.contains("a header begins with #"),
            "{said}"
        );
    }
}

#[test]
fn plain_text_with_comments_and_marks() {
    let points = read(
        "# x y z V mark\n0 0 0 1e-9 1\n\n1, 0, 0, 2e-9, -4 # last\n",
        "txt",
    );
    assert_eq!(points.cloud.position, [[0.0; 3], [1.0, 0.0, 0.0]]);
    assert_eq!(points.cloud.volume, [1e-9, 2e-9]);
    assert_eq!(points.cloud.mark, [1, -4]);
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    for (text, extension, message) in [
        ("0 0 0 1\n0 0 nan 1", "txt", "f:2: z is NaN"),
        (
            "0 0 0 1\n0 0 1 -1",
            "txt",
            "f:2: the volume must be positive, it is -1",
        ),
        (
            "0 0 0 1\n1 0 0",
            "txt",
            "f:2: expected `x y z volume [block_id]`, found 3 columns",
        ),
        (
            "0 0 0 1 3\n1 0 0 1",
            "txt",
            "f:2: 4 columns, where the lines before have 5",
        ),
        (
            "0 0 0 1 steel",
            "txt",
            "f:1: expected a whole number as block id, found `steel`",
        ),
        (
            "0 0 0 1\n1 0 0 1\n-0 0 0 1",
            "txt",
            "f:3: point 3 at (-0, 0, 0) coincides with that of line 1",
        ),
        ("# nothing", "txt", "no points"),
        (
            "*NODE\n1,0,0\n*ELEMENT, TYPE=CAX4\n",
            "inp",
            "f:3: unknown element type CAX4",
        ),
        (
            "*NODE\n1,0,0\n1,1,0\n",
            "inp",
            "f:3: node 1 is defined twice",
        ),
        (
            "*NODE\n1,0,0\n2,1,0\n*ELEMENT,TYPE=CPS3\n9,1,2,3",
            "inp",
            "f:5: element 9 refers to node 3",
        ),
        (
            "*NODE\n1,0,0\n2,1,0\n3,2,0\n*ELEMENT,TYPE=CPS3\n9,1,2,3",
            "inp",
            "f:6: element 9 has no positive area",
        ),
        (
            "*NODE\n1,0,0\n*ELEMENT,TYPE=CPS3\n9,1,2",
            "inp",
            "f:4: element 9 of type CPS3 has 2 nodes instead of 3",
        ),
        ("*NODE\n1,0,x", "inp", "f:2: expected y, found `x`"),
        ("*HEADING", "inp", "no *NODE block"),
        ("*NODE\n1,0,0", "inp", "no cells"),
        ("solid", "msh", "f:1: expected $MeshFormat"),
        ("$MeshFormat\n4.0 0 8", "msh", "format 4.0 is not read"),
        (
            "*NODE\n1,0,0\n2,1,0\n3,1,1\n*ELEMENT,TYPE=S3R\n1,1,2,3",
            "inp",
            "the elements S3R are shells or membranes",
        ),
        (
            OLD.split("3 2 2 5").next().unwrap_or(""),
            "msh",
            "the file ends where an element should follow",
        ),
        (
            NEW.split("2 1 2 3\n").next().unwrap_or(""),
            "msh",
            "the file ends where an element should follow",
        ),
        (
            &OLD.replace("2 2 2 5 1 1 2 3", "2 31 2 5 1 1 2 3"),
            "msh",
            "unknown element type 31",
        ),
        (
            &OLD.replace("3 1 1 0", "3 1 inf 0"),
            "msh",
            "f:13: y is inf",
        ),
    ] {
        let got = failure(text, extension);
        assert!(got.contains(message), "{message:?} is not in {got:?}");
    }
    assert!(
        points(Path::new("no/such/file.txt"), Frame::Last)
            .unwrap_err()
            .message
            .contains("cannot read it")
    );
    assert!(
        points(Path::new("mesh.vtk"), Frame::Last)
            .unwrap_err()
            .message
            .contains("unknown kind of file")
    );
}

proptest! {
    /// No damage to a file makes a reader panic.
    #[test]
    fn damaged_files_are_read_or_refused(which in 0usize..4, at in 0.0..1.0f64, cut in 0usize..40, put in "[-0-9$*,. \\nA-Za-z]{0,12}") {
        let (text, extension) = [
            (PLATE, "inp"),
            (OLD, "msh"),
            (NEW, "msh"),
            ("# x y z V mark\n0 0 0 1e-9 1\n\n1, 0, 0, 2e-9, -4 # last\n", "txt"),
        ][which];
        let start = (at * text.len() as f64) as usize;
        let damaged = format!("{}{put}{}", &text[..start], &text[(start + cut).min(text.len())..]);
        if let Err(error) = parse(&damaged, "f", extension) {
            prop_assert!(!error.message.is_empty());
        }
    }
}

const DATA: &str = "points\n\n3 atoms\n2 atom types\n0 4 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms # peri\n\n\
    7 2 0.5 3 2 0 0 0 0 0\n2 1 1 2.5 1 0 0 0 0 0\n1 1 1 2 0 0 0 0 0 0\n\nVelocities\n\n1 0 0 0\n2 0 0 0\n7 0 0 0\n";

#[test]
fn lammps_atoms_become_points_in_order_of_their_ids() {
    for extension in ["data", "lmp"] {
        let points = read(DATA, extension);
        assert_eq!(points.dimension, None);
        let cloud = points.cloud;
        assert_eq!(
            cloud.position,
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
        );
        assert_eq!(cloud.volume, [1.0, 1.0, 0.5]);
        assert_eq!(cloud.density, [2.0, 2.5, 3.0]);
        assert_eq!(cloud.mark, [1, 1, 2]);
    }
}

/// Areas of the sets of a mesh that stand for faces.
fn faces(points: &Points) -> Vec<(&str, Vec<f64>)> {
    let each = points.cloud.faces.iter();
    each.map(|(name, areas)| (&**name, areas.to_vec()))
        .collect()
}

#[test]
fn named_curves_and_sets_of_nodes_know_their_lengths() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 2 \"right\"\n2 1 \"plate\"\n1 4 \"joint\"\n$EndPhysicalNames\n\
        $Nodes\n6\n1 0 0 0\n2 3 0 0\n3 4 0 0\n4 0 2 0\n5 3 2 0\n6 4.5 2 0\n$EndNodes\n\
        $Elements\n4\n1 3 1 1 1 2 5 4\n2 3 1 1 2 3 6 5\n3 1 1 2 3 6\n4 1 1 4 2 5\n$EndElements\n";
    let points = read(text, "msh");
    let slanted = (0.25f64 + 4.0).sqrt();
    // an edge inside belongs to both of its cells, and is as long as it is
    assert_eq!(
        faces(&points),
        [("right", vec![slanted]), ("joint", vec![1.0, 1.0])]
    );
    // nodes of the right side of a plate of two squares, cut in triangles; of the whole plate no face
    let sides = format!("{PLATE}*NSET, NSET=SIDE\n5, 6\n");
    assert_eq!(faces(&read(&sides, "inp")), [("SIDE", vec![2.0])]);
}

#[test]
fn named_surfaces_of_a_solid_know_their_areas() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 2 \"top\"\n3 1 \"solid\"\n$EndPhysicalNames\n\
        $Nodes\n8\n1 0 0 0\n2 3 0 0\n3 3 2 0\n4 0 2 0\n5 0 0 1\n6 3 0 1\n7 3 2 1\n8 0 2 1\n$EndNodes\n\
        $Elements\n3\n1 5 1 1 1 2 3 4 5 6 7 8\n2 2 1 2 5 6 7\n3 2 1 2 5 7 8\n$EndElements\n";
    assert_eq!(faces(&read(text, "msh")), [("top", vec![6.0])]);
}
