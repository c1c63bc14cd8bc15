//! Files of other programs that mean something else than their columns or coordinates seem to say.

use super::*;

/// A mesh of gmsh with these nodes and elements `type 0 nodes…`.
fn gmsh(nodes: &[[f64; 3]], elements: &[&str]) -> String {
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n",
        nodes.len()
    );
    for (n, [x, y, z]) in nodes.iter().enumerate() {
        text += &format!("{} {x} {y} {z}\n", n + 1);
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", elements.len());
    for (n, element) in elements.iter().enumerate() {
        text += &format!("{} {element}\n", n + 1);
    }
    text + "$EndElements\n"
}

const SQUARE: [[f64; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 2.0, 0.0],
    [0.0, 2.0, 0.0],
];

#[test]
fn plane_bodies_lie_in_x_and_y() {
    let of = |place: fn([f64; 3]) -> [f64; 3]| gmsh(&SQUARE.map(place), &["3 0 1 2 3 4"]);
    let tilted = failure(&of(|[x, y, _]| [x, 0.6 * y, 0.8 * y]), "msh");
    assert!(
        tilted.contains("z is not the same everywhere: it runs from 0 to 1.6"),
        "{tilted}"
    );
    assert!(tilted.contains("turn a plane that is tilted"), "{tilted}");
    let upright = failure(&of(|[x, y, _]| [x, 0.0, y]), "msh");
    assert!(upright.contains("It lies in x and z"), "{upright}");
    assert!(upright.contains("exchange the coordinates"), "{upright}");
    // anywhere along z, up to round-off
    let points = read(&of(|[x, y, _]| [x, y, 5.0 + 1e-9 * x]), "msh");
    assert_eq!(points.cloud.volume, [4.0]);
    assert_eq!(points.ends.unwrap()[1], [0.0, 2.0]);
    // two plates, one above the other
    let two: Vec<[f64; 3]> = { SQUARE.iter().copied() }
        .chain(SQUARE.map(|[x, y, _]| [x + 1.0, y, 3.0]))
        .collect();
    let said = failure(&gmsh(&two, &["3 0 1 2 3 4", "3 0 5 6 7 8"]), "msh");
    assert!(
        said.contains("take plates at several z one by one"),
        "{said}"
    );
    // surfaces beside a solid may lie anyhow
    let solid = [SQUARE[0], SQUARE[1], SQUARE[3], [0.0, 0.0, 3.0]];
    let points = read(&gmsh(&solid, &["4 0 1 2 3 4", "2 0 2 3 4"]), "msh");
    assert_eq!(points.cloud.volume, [2.0]);
}

#[test]
fn second_order_cells_say_that_corners_count() {
    let mut nodes = SQUARE.to_vec();
    nodes.extend([
        [1.0, -0.5, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 2.0, 0.0],
        [0.0, 1.0, 0.0],
    ]);
    let points = read(&gmsh(&nodes, &["16 0 1 2 3 4 5 6 7 8", "8 0 1 2 5"]), "msh");
    assert_eq!(points.cloud.volume, [4.0]);
    assert!(points.notes[0].starts_with("1 second-order cells are taken by their corners"));
}

/// Points of a block 3 × 2 × 2 with an edge of 1 as `line` writes them from number and place.
fn block(line: impl Fn(usize, [f64; 3]) -> String) -> String {
    let all = (0..12).map(|n| {
        let cell = [n % 3, n / 3 % 2, n / 6];
        line(n + 1, cell.map(|c| c as f64 + 0.5))
    });
    all.collect::<Vec<_>>().join("\n")
}

#[test]
fn columns_in_another_order_are_doubted() {
    for (text, part) in [
        // Peridigm, with a second block
        (
            block(|n, [x, y, z]| format!("{x} {y} {z} {} 1", 1 + n / 7)),
            "is the order x y z block volume",
        ),
        // and one whose volumes are no whole numbers
        (
            block(|_, [x, y, z]| format!("{x} {y} {z} 1 0.5")),
            "expected a whole number as block id, found `0.5`",
        ),
        // edges of 2
        (
            block(|_, [x, y, z]| format!("{} {} {} 1 8", 2.0 * x, 2.0 * y, 2.0 * z)),
            "is the order x y z block volume",
        ),
        (
            block(|n, [x, y, z]| format!("{n} {x} {y} {z} 1")),
            "the first column counts the lines",
        ),
        (
            block(|n, [x, y, z]| format!("{n} {x} {y} {z} 0.5 1")),
            "found 6 columns",
        ),
        // PeriLab in a plane: x y block volume
        (
            block(|n, [x, y, z]| format!("{} {y} {} 1", x + 3.0 * z, 1 + n / 7)),
            "are they blocks of a plane",
        ),
    ] {
        let said = failure(&text, "txt");
        assert!(said.contains(part), "{part:?} is not in {said:?}");
        assert!(
            said.starts_with("f:1: ") && said.contains("name the columns"),
            "{said}"
        );
    }
}

#[test]
fn columns_that_are_named_are_taken_by_their_names() {
    let usual = read(&block(|n, [x, y, z]| format!("{x} {y} {z} 1 {n}")), "txt");
    for (header, line) in [
        ("# x y z block_id volume", "X Y Z N 1"),
        ("header: x y z block_id volume", "X Y Z N 1"),
        ("# id, volume, mark, z, y, x", "N, 1, N, Z, Y, X"),
        ("# X Y Z V mark", "X Y Z 1.0 N.0"),
    ] {
        let lines = block(|n, place| {
            let [x, y, z] = place.map(|c| c.to_string());
            line.replace('X', &x)
                .replace('Y', &y)
                .replace('Z', &z)
                .replace('N', &n.to_string())
        });
        let named = read(&format!("{header}\n{lines}\n"), "txt");
        assert_eq!(named.cloud, usual.cloud, "{header}");
    }
    // a comment is no header, and a header has all columns
    let comments = block(|_, [x, y, z]| format!("# x y of points\n{x} {y} {z} 1"));
    assert!(read(&comments, "txt").cloud.mark.is_empty());
    let said = failure("# x y volume\n0 0 0 1\n", "txt");
    assert!(
        said.contains("4 columns, where the first line names 3"),
        "{said}"
    );
}

#[test]
fn whole_volumes_and_layers_that_are_meant_are_read() {
    // volumes of a graded row, marks of one material
    let graded = "0 0 0 1 1\n1 0 0 1 1\n2.26 0 0 2 1\n3.52 0 0 2 1\n";
    assert_eq!(read(graded, "txt").cloud.volume, [1.0, 1.0, 2.0, 2.0]);
    // a row along x that counts, and two layers at whole z
    assert_eq!(
        read("0 0 0 1\n1 0 0 1\n2 0 0 1\n3 0 0 1\n", "txt")
            .cloud
            .volume
            .len(),
        4
    );
    let layers = block(|_, [x, y, z]| format!("{x} {y} {} 1", z - 0.5));
    assert_eq!(read(&layers, "txt").cloud.volume.len(), 12);
    let marks = block(|n, [x, y, z]| format!("{x} {y} {z} 1 {n}"));
    assert_eq!(read(&marks, "txt").cloud.mark[11], 12);
}

#[test]
fn numbers_as_others_write_them() {
    let points = read("0.0D0 0 0 1.5D-3\n1.d+0 0 0 1.5-003\n", "txt");
    assert_eq!(points.cloud.volume, [1.5e-3, 1.5e-3]);
    for (text, extension) in [
        ("0,5 1,5 0 1", "txt"),
        ("0,5;1,5;0;1", "csv"),
        (
            &*gmsh(&SQUARE, &["3 0 1 2 3 4"]).replace("1 0 0 0", "1 0,0 0 0"),
            "msh",
        ),
        (&*DATA.replace("0.5 3 2", "0,5 3 2"), "data"),
        (
            "1\nLattice=\"2 0 0 0 2 0 0 0 2\" Properties=species:S:1:pos:R:3\nCu 0,5 0 0\n",
            "xyz",
        ),
    ] {
        let said = failure(text, extension);
        assert!(said.contains("decimal comma"), "{said}");
    }
}

#[test]
fn styles_that_are_not_said_are_doubted() {
    let notes = read(DATA, "data").notes;
    assert_eq!(notes, Vec::<String>::new());
    let unnamed = DATA.replace(" # peri", "");
    assert!(read(&unnamed, "data").notes[0].contains("taken as peri"));
    // diameters of spheres, a millimetre apart, in the place of volumes
    let head = "p\n\n8 atoms\n2 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n";
    let sphere = |line: fn(usize, [f64; 3]) -> String| {
        let place = |n: usize| [n % 2, n / 2 % 2, n / 4].map(|c| 1e-3 * (c as f64 + 0.5));
        let all: Vec<String> = (0..8).map(|n| line(n + 1, place(n))).collect();
        format!("{head}{}\n", all.join("\n"))
    };
    let said = failure(
        &sphere(|n, [x, y, z]| format!("{n} 1 1e-3 2000 {x} {y} {z}")),
        "data",
    );
    assert!(
        said.contains("does not say its atom_style") && said.contains("1.0e6 times"),
        "{said}"
    );
    assert!(said.contains("sphere has diameters there"), "{said}");
    let peri = sphere(|n, [x, y, z]| format!("{n} 1 1e-9 2000 {x} {y} {z}"));
    assert_eq!(read(&peri, "data").cloud.volume, [1e-9; 8]);
    // id type charge x y z, or id molecule type x y z
    let charges = sphere(|n, [x, y, z]| format!("{n} {} 1 {x} {y} {z}", 1 + n % 2));
    let said = failure(&charges, "data");
    assert!(
        said.contains("id type charge x y z") && said.contains("`Atoms # molecular`"),
        "{said}"
    );
    let named = charges.replace("Atoms\n", "Atoms # molecular\n");
    assert_eq!(read(&named, "data").cloud.position.len(), 8);
    let part = failure(
        &sphere(|n, [x, y, z]| format!("{n} 1 -0.82 {x} {y} {z}")),
        "data",
    );
    assert!(
        part.contains("found `-0.82`") && part.contains("guessed from the number of columns"),
        "{part}"
    );
}

/// Two triangles of a plate that gmsh cut into two partitions.
const CUT: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 5 \"plate\"\n$EndPhysicalNames\n\
    $Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 5 0\n$EndEntities\n\
    $PartitionedEntities\n2\n0\n0 1 2 0\n7 2 1 2 1 2 0 0 0 1 1 0 0 0\n2 2 1 1 1 0 0 0 1 1 0 0 0\n3 2 1 1 2 0 0 0 1 1 0 0 0\n$EndPartitionedEntities\n\
    $Nodes\n1 4 1 4\n2 2 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n\
    $Elements\n2 2 1 2\n2 2 2 1\n1 1 2 3\n2 3 2 1\n2 1 3 4\n$EndElements\n";

#[test]
fn cells_of_partitions_are_in_the_groups_of_what_was_cut() {
    let points = read(CUT, "msh");
    assert_eq!(points.cloud.mark, [5, 5]);
    assert_eq!(points.cloud.names, [(5, "plate".to_string())]);
    let part = CUT
        .replace("0 1 2 0\n", "0 1 1 0\n")
        .replace("3 2 1 1 2 0 0 0 1 1 0 0 0\n", "");
    let said = failure(&part, "msh");
    assert!(said.contains("the file has partition 1 of 2"), "{said}");
}

#[test]
fn marks_of_encodings_and_returns_change_no_file() {
    let dir = tempfile::tempdir().unwrap();
    let frame = "1\nLattice=\"2 0 0 0 2 0 0 0 2\" Properties=species:S:1:pos:R:3\nCu 0.5 0 0\n";
    let mesh = gmsh(&SQUARE, &["3 0 1 2 3 4"]);
    for (text, name) in [
        (PLATE, "a.inp"),
        (&*mesh, "a.msh"),
        (DATA, "a.data"),
        ("0 0 0 1\n1 0 0 1\n", "a.txt"),
        (frame, "a.extxyz"),
        (frame, "a.xyz"),
    ] {
        let path = dir.path().join(name);
        let read = |bytes: &[u8]| {
            std::fs::write(&path, bytes).unwrap();
            points(&path, Frame::Last)
        };
        let plain = read(text.as_bytes()).unwrap();
        assert_eq!(
            read(format!("\u{feff}{text}").as_bytes()).unwrap(),
            plain,
            "{name}"
        );
        assert_eq!(
            read(text.replace('\n', "\r\n").as_bytes()).unwrap(),
            plain,
            "{name}"
        );
        assert_eq!(
            read(text.replace('\n', "\r").as_bytes()).unwrap(),
            plain,
            "{name}"
        );
        let wide = format!("\u{feff}{text}");
        let wide: Vec<u8> = wide.encode_utf16().flat_map(u16::to_le_bytes).collect();
        match read(&wide) {
            Ok(points) => assert_eq!(points, plain, "{name}"),
            Err(error) => assert!(error.message.contains("UTF-16"), "{name}: {error}"),
        }
        let latin = [&b"\xe4"[..], text.as_bytes()].concat();
        let error = match read(&latin) {
            // its first line is a title
            Ok(points) => {
                assert_eq!((name, points), ("a.data", plain));
                continue;
            }
            Err(error) => error,
        };
        assert_eq!(error.line, Some(1), "{name}: {error}");
        assert!(
            error.message.contains("0xE4 in column 1"),
            "{name}: {error}"
        );
    }
}
