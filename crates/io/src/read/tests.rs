use super::*;
use proptest::prelude::*;

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

const NEW: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 5 \"glass plate\"\n$EndPhysicalNames\n$Entities\n1 1 1 0\n1 0 0 0 0\n1 0 0 0 1 0 0 0 2 1 1\n1 0 0 0 1 1 0 1 5 1 1\n$EndEntities\n$Nodes\n2 4 1 4\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n2 1 0 2\n3\n4\n1 1 0\n0 1 0\n$EndNodes\n$Elements\n2 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 2\n2 1 2 3\n3 1 3 4\n$EndElements\n";

#[test]
fn both_gmsh_formats_say_the_same() {
    let (old, new) = (read(OLD, "msh"), read(NEW, "msh"));
    assert_eq!(old, new);
    assert_eq!(old.cloud.volume, [0.5, 0.5]);
    assert_eq!(old.cloud.mark, [5, 5]);
    assert_eq!(old.cloud.names, [(5, "glass plate".to_string())]);
    assert_eq!(old.dimension, Some(2));
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
            "f:2: expected `x y z volume [mark]`, found 3 columns",
        ),
        (
            "0 0 0 1 3\n1 0 0 1",
            "txt",
            "f:2: 4 columns, where the lines before have 5",
        ),
        (
            "0 0 0 1 steel",
            "txt",
            "f:1: expected a whole number as mark, found `steel`",
        ),
        (
            "0 0 0 1\n1 0 0 1\n-0 0 0 1",
            "txt",
            "f:3: point 3 at (-0, 0, 0) coincides with that of line 1",
        ),
        ("# nothing", "txt", "no points"),
        (
            "*NODE\n1,0,0\n*ELEMENT, TYPE=S4\n",
            "inp",
            "f:3: unknown element type S4",
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
        ("$MeshFormat\n4.1 1 8", "msh", "binary"),
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
