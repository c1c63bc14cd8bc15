//! Data and dump files: written, read back, and broken.

use std::io::Cursor;

use peridyne_io::read::lammps::read_data;
use peridyne_lammps::{Options, read_frame};

use super::host::run;

const DATA: &str = "title

3 atoms
2 atom types

-1 1 xlo xhi
-1 1 ylo yhi
-1 1 zlo zhi

Atoms # peri

7 1 0.125 2200 0 0 0.5
3 2 0.125 2200 0.25 0 0 0 0 0
5 1 0.25 1100 -0.5 0.125 0

Velocities

3 1 2 3
5 0 0 0
7 -1 0 0
";

#[test]
fn data_files_are_read_in_order_of_id() {
    let data = read_data(Cursor::new(DATA), "a.data").unwrap();
    let a = &data.atoms;
    assert_eq!(a.ids, [3, 5, 7]);
    assert_eq!(a.position[1], [-0.5, 0.125, 0.0]);
    assert_eq!((a.types[0], a.volume[1], a.density[1]), (2, 0.25, 1100.0));
    assert_eq!(a.velocity.as_ref().unwrap()[2], [-1.0, 0.0, 0.0]);
    assert_eq!((data.low, data.high, data.types), ([-1.0; 3], [1.0; 3], 2));
}

#[test]
fn broken_data_files_are_errors_with_their_line() {
    for (from, to, message, line) in [
        (
            "3 atoms",
            "4 atoms",
            "the section `Atoms` ends after 3 lines",
            16,
        ),
        ("3 atoms\n", "", "no line `N atoms`", 9),
        (
            "2200 0 0 0.5",
            "2200 0 0 nan",
            "`nan` is not a finite number",
            12,
        ),
        ("2200 0 0 0.5", "2200 0 0", "an atom has 7 numbers", 12),
        ("2200 0 0 0.5", "-1 0 0 0.5", "density must be positive", 12),
        (
            "2200 0 0 0.5",
            "2200 0 0 x",
            "expected a number, found `x`",
            12,
        ),
        ("7 1", "7 3", "atom type 3 is not between 1 and 2", 12),
        ("\n5 1 0.25", "\n3 1 0.25", "atom id 3 occurs twice", 14),
        ("7 -1 0 0\n", "", "2 of 3 lines", 20),
        ("\n5 0 0 0", "\n6 0 0 0", "there is no atom with id 6", 19),
        ("-1 1 ylo yhi", "1 -1 ylo yhi", "the box is empty", 7),
        ("Velocities", "Bonds", "`Bonds` is not supported", 16),
        (
            "title",
            "title\n3 ellipsoids",
            "header line is not supported",
            2,
        ),
    ] {
        assert!(DATA.contains(from));
        let text = DATA.replacen(from, to, 1);
        let error = read_data(Cursor::new(text), "a.data").unwrap_err();
        assert!(
            error.message.contains(message),
            "{from} -> {to}: {}",
            error.message
        );
        assert_eq!(error.line.map(|l| l.0), Some(line), "{from} -> {to}");
    }
}

const DUMP: &str = "ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS ff ff ff
0 1
0 1
0 2
ITEM: ATOMS id x
1 9
ITEM: TIMESTEP
50
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS ff ff ff
0 1
0 1
0 2
ITEM: ATOMS id type x y zs vx
2 1 0.5 0.25 0.125 3
1 1 0.75 0.5 0.5 -3
";

#[test]
fn dumps_are_read_and_broken_ones_are_errors() {
    let wanted = [
        vec!["x".to_string()],
        vec!["z".to_string(), "zu".to_string(), "zs".to_string()],
    ];
    let (frame, choice) = read_frame(Cursor::new(DUMP), "a.dump", 50, &wanted).unwrap();
    assert_eq!((frame.ids, choice), (vec![2, 1], vec![0, 2]));
    assert_eq!(frame.columns, [[0.5, 0.75], [0.125, 0.5]]);
    assert_eq!(frame.high, [1.0, 1.0, 2.0]);
    for (step, text, message) in [
        (7, DUMP.to_string(), "no snapshot of step 7"),
        (
            50,
            DUMP.replace("1 1 0.75 0.5 0.5 -3\n", ""),
            "the file ends after 1 of 2 atoms",
        ),
        (50, DUMP.replace("0.75", "inf"), "not a finite number"),
        (
            50,
            DUMP.replace("id type x y zs vx", "id type y zs vx q"),
            "no column `x`",
        ),
        (
            50,
            DUMP.replace("0.5 -3", "-3"),
            "expected 6 columns, found 5",
        ),
        (0, "hello\n".to_string(), "is this a LAMMPS dump file"),
    ] {
        let error = read_frame(Cursor::new(text), "a.dump", step, &wanted).unwrap_err();
        assert!(error.message.contains(message), "{}", error.message);
    }
}

/// write_data then read_data, and write_dump then read_dump, give the same atoms.
#[test]
fn round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let options = Options {
        output: folder.path().into(),
        ..Options::default()
    };
    let start = "units si\nboundary f p f\natom_style peri\nlattice sc 0.5\n";
    let first = format!(
        "{start}region b block 0 4 0 4 0 4\ncreate_box 1 b\ncreate_atoms 1 box
variable x atom random(0.1,1.9,7)
set group all x v_x density 3 volume 0.1
velocity all set 1 v_x 0
write_data a.data
write_dump all custom a.dump id x vy modify format float %.17g
print \"> $(x[5]) $(vy[5]) $(atoms)\"\n"
    );
    let second = format!(
        "{start}read_data {}\nprint \"> $(x[5]) $(vy[5]) $(atoms)\"
set group all x 0 vy 0\nread_dump {} 0 x vy box no replace yes\nprint \"> $(x[5]) $(vy[5]) $(atoms)\"\n",
        at("a.data"),
        at("a.dump")
    );
    let mut printed = Vec::new();
    for script in [first, second] {
        let ran = run("in.test", &script, &options);
        if let Err(e) = &ran.outcome {
            panic!("{e}");
        }
        printed.extend(ran.lines.into_iter().filter(|l| l.starts_with("> ")));
    }
    assert_eq!(printed.len(), 3);
    assert!(printed.iter().all(|l| *l == printed[0]), "{printed:?}");
    assert!(printed[0].ends_with(" 64"), "{printed:?}");
}

/// A script has points with volumes; a file of atoms has none.
#[test]
fn a_file_of_atoms_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("atoms.data");
    let text = "t\n\n1 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nMasses\n\n1 63.55 # Cu\n\nAtoms # atomic\n\n1 1 0.5 0.5 0.5\n";
    std::fs::write(&path, text).unwrap();
    let script = format!(
        "units si\nboundary f f f\natom_style peri\nread_data {}\n",
        path.display()
    );
    let ran = run("in.test", &script, &Options::default());
    let Err(error) = ran.outcome else {
        panic!("the atoms were taken");
    };
    assert_eq!(error.line, 4);
    assert!(
        error
            .message
            .contains("is of atom_style atomic, without volumes"),
        "{error}"
    );
}
