//! Atoms in and out: extended XYZ, LAMMPS data files, dumps.

use peridyne_io::read::{Atoms, Frame, Species, data, dump, extxyz};
use peridyne_io::write::data::{data_to, write_data};
use peridyne_io::write::trajectory::{Format, Trajectory, write_atoms};

fn sample(step: u64) -> Atoms {
    let vectors = |f: fn(f64) -> [f64; 3]| (0..4).map(|i| f(f64::from(i))).collect::<Vec<_>>();
    Atoms {
        columns: vec![],
        species: [("Cu", 63.55), ("Ni", 58.69)]
            .map(|(name, mass)| Species {
                name: name.into(),
                mass: Some(mass),
            })
            .to_vec(),
        kind: vec![0, 1, 1, 0],
        position: vectors(|i| [0.1 + i, 1.0 / 3.0 * i, -0.5 + 1e-17 * i]),
        velocity: Some(vectors(|i| [i, -2e-300 * i, 3e300])),
        force: Some(vectors(|i| [0.1 * i, 0.2, -0.3])),
        energy: Some(vec![-3.5, -3.25, 1.0 / 7.0, 0.0]),
        low: [0.0, -1.0, -2.0],
        high: [4.0, 3.0, 2.5],
        periodic: [true, true, false],
        step: Some(step),
        time: Some(0.001 * step as f64),
        from_momenta: false,
        mass: None,
        units: None,
        bonded: false,
        edges: None,
    }
}

#[test]
fn extended_xyz_reads_back_frame_by_frame() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.xyz");
    let mut file = Trajectory::create(&path, Format::Extxyz).unwrap();
    for step in [0, 10, 20] {
        file.push(&sample(step)).unwrap();
    }
    file.finish().unwrap();
    assert_eq!(extxyz::frames(&path).unwrap(), 3);
    for (which, step) in [
        (Frame::Index(0), 0),
        (Frame::Index(1), 10),
        (Frame::Step(10), 10),
        (Frame::Last, 20),
    ] {
        assert_eq!(extxyz::extxyz(&path, which).unwrap(), sample(step));
    }
    let text = extxyz::extxyz(&path, Frame::Index(3))
        .unwrap_err()
        .to_string();
    assert!(
        text.ends_with("t.xyz: there is no frame 3: it has 3, the last is 2"),
        "{text}"
    );
}

#[test]
fn a_frame_that_cannot_be_written_leaves_those_before() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.xyz");
    let mut file = Trajectory::create(&path, Format::Extxyz).unwrap();
    file.push(&sample(0)).unwrap();
    let whole = std::fs::read(&path).unwrap();
    let bad = Atoms {
        force: Some(vec![]),
        ..sample(1)
    };
    let text = file.push(&bad).unwrap_err().to_string();
    assert!(
        text.contains("t.xyz") && text.contains("4 atoms, but 0 forces"),
        "{text}"
    );
    assert_eq!(std::fs::read(&path).unwrap(), whole);
    let mut more = Trajectory::append(&path, Format::Extxyz).unwrap();
    more.push(&sample(2)).unwrap();
    assert_eq!(extxyz::extxyz(&path, Frame::Last).unwrap(), sample(2));
}

#[test]
fn dumps_read_back_in_order_of_ids() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.lammpstrj");
    write_atoms(&path, Format::Dump, &[sample(0), sample(5)]).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("ITEM: BOX BOUNDS pp pp ff\n0.0 4.0\n-1.0 3.0\n-2.0 2.5\n"));
    assert!(
        text.contains("ITEM: ATOMS id type x y z vx vy vz fx fy fz c_pe element mass\n1 1 0.1 ")
    );
    assert!(text.contains(" -3.5 Cu 63.55\n"));
    assert_eq!(dump::dump(&path, Frame::Last).unwrap(), sample(5));
    assert_eq!(dump::dump(&path, Frame::Step(5)).unwrap(), sample(5));
    // types say in which order the elements are
    let turned = "ITEM: TIMESTEP\n3\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 2\n0 4\n-1 1\nITEM: ATOMS id type element x y z\n1 2 Cu 0 0 0\n2 1 Ni 1 1 0\n";
    let atoms = dump::parse_dump(turned, "f", Frame::Last).unwrap();
    assert_eq!(
        (&*atoms.species[0].name, &atoms.kind[..]),
        ("Ni", &[1, 0][..])
    );
    // one kind has its type alone
    let mut one = sample(5);
    one.kind = vec![0; 4];
    one.species.pop();
    write_atoms(&path, Format::Dump, &[one.clone()]).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("fx fy fz c_pe\n"));
    one.species[0] = Species {
        name: "1".into(),
        mass: None,
    };
    assert_eq!(dump::dump(&path, Frame::Last).unwrap(), one);
    write_atoms(&path, Format::Dump, &[sample(0), sample(5)]).unwrap();
    assert_eq!(dump::frames(&path).unwrap(), 2);
    let mixed = "ITEM: TIMESTEP\n3\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 2\n0 4\n-1 1\nITEM: ATOMS id element xs ys zs\n7 Ni 0.5 0.25 0.5\n2 Cu 0 0 0\n";
    let atoms = dump::parse_dump(mixed, "f", Frame::Index(0)).unwrap();
    assert_eq!(atoms.position, [[0.0, 0.0, -1.0], [1.0, 1.0, 0.0]]);
    assert_eq!((atoms.name(0), atoms.name(1)), ("Cu", "Ni"));
}

#[test]
fn data_files_read_back() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("t.data");
    write_data(&path, &sample(0)).unwrap();
    let wanted = Atoms {
        force: None,
        energy: None,
        periodic: [true; 3],
        step: None,
        time: None,
        ..sample(0)
    };
    assert_eq!(data::data(&path).unwrap(), wanted);
    // without the comment of the style the columns tell it, and image flags may be there
    let bare = "t\n\n2 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms\n\n2 1 .5 .5 .5 0 0 1\n1 1 0 0 0 0 0 0\n";
    let atoms = data::parse_data(bare, "f").unwrap();
    assert_eq!(atoms.position, [[0.0; 3], [0.5; 3]]);
    assert_eq!(
        (atoms.name(0), atoms.species[0].mass, &atoms.velocity),
        ("1", None, &None)
    );
    let mut massless = sample(0);
    massless.species[1].mass = None;
    let text = data_to(&mut Vec::new(), &massless).unwrap_err().to_string();
    assert_eq!(text, "the species Ni has no mass");
}

/// Atoms of one name may be isotopes: each has its own mass then, and the name has none.
#[test]
fn isotopes_have_their_own_masses() {
    let of = |masses: [u32; 2]| {
        let [a, b] = masses;
        let text =
            format!("2\nProperties=species:S:1:pos:R:3:masses:R:1\nCu 0 0 0 {a}\nCu 0 0 0 {b}\n");
        let atoms = extxyz::parse_extxyz(&text, "f", Frame::Index(0)).unwrap();
        (atoms.species[0].mass, atoms.mass)
    };
    assert_eq!(of([1, 2]), (None, Some(vec![1.0, 2.0])));
    assert_eq!(of([2, 2]), (Some(2.0), None));
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let cube = "Lattice=\"1 0 0 0 1 0 0 0 1\"";
    let cases: Vec<(String, &str)> = vec![
        (
            "two\n".into(),
            "f:1: expected the number of atoms, a whole number, found `two`",
        ),
        (
            "1\n".into(),
            "f:1: the file ends: the line with Lattice and Properties is missing",
        ),
        (
            format!("2\n{cube}\nCu 0 0 0\n"),
            "f:3: the file ends: 1 of 2 atoms are there",
        ),
        (format!("1\n{cube}\nCu 0 0 nan\n"), "f:3: a position is NaN"),
        (
            format!("1\n{cube}\nCu 0 0\n"),
            "f:3: atom 1 of 1 has 3 columns, Properties says 4",
        ),
        (
            "1\nLattice=\"1 0 0 .5 1 0 0 0 1\"\nCu 0 0 0\n".into(),
            "f:2: the lattice is not orthogonal",
        ),
        (
            "1\nLattice=\"1 0 0\"\nCu 0 0 0\n".into(),
            "f:2: Lattice has 9 numbers, found 3",
        ),
        (
            "1\nLattice=\"1 0 0\nCu 0 0 0\n".into(),
            "f:2: the value of Lattice has no closing \"",
        ),
        (
            "1\npbc=\"T F F\"\nCu 0 0 0\n".into(),
            "f:2: x is periodic (pbc), but Lattice gives it no length",
        ),
        (
            "1\nProperties=pos:R:3\n0 0 0\n".into(),
            "f:2: Properties has no species:S:1",
        ),
        (
            "1\nProperties=species:S:1:pos:R:2\nCu 0 0\n".into(),
            "f:2: Properties: expected pos:R:3, found pos:R:2",
        ),
        (
            "1\nProperties=species:S:1:pos:R:3:momenta:R:3\nCu 0 0 0 1 1 1\n".into(),
            "f:2: the column momenta needs the column masses",
        ),
        (String::new(), "f: the file has no frames"),
    ];
    for (text, message) in cases {
        let got = extxyz::parse_extxyz(&text, "f", Frame::Index(0))
            .unwrap_err()
            .to_string();
        assert!(got.starts_with(message), "{message}\n{got}");
    }
    let head =
        "ITEM: TIMESTEP\n3\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 2\n0 4\n-1 1\n";
    for (text, message) in [
        (
            format!("{head}ITEM: ATOMS id x y z\n1 0 0 0\n"),
            "f:9: the dump has no column `type` or `element`; it has id x y z",
        ),
        (
            format!("{head}ITEM: ATOMS id type x y z\n1 1 0 0\n"),
            "f:10: expected the 5 columns id type x y z, found 4",
        ),
        (
            format!("{head}ITEM: ATOMS id type x y z\n"),
            "f:9: the file ends: 0 of 1 atoms of step 3 are there",
        ),
        (
            head.replace("pp pp pp", "xy xz yz pp pp pp"),
            "f:5: tilted boxes are not read",
        ),
        (
            head.to_string(),
            "f:8: the file ends within the head of a frame",
        ),
    ] {
        let got = dump::parse_dump(&text, "f", Frame::Index(0))
            .unwrap_err()
            .to_string();
        assert!(got.starts_with(message), "{message}\n{got}");
    }
    let head = "t\n1 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n";
    for (text, message) in [
        (
            format!("{head}Masses\n\n1 -2\n\nAtoms # atomic\n\n1 1 0 0 0\n"),
            "f:9: the mass must be positive, found -2",
        ),
        (
            format!("{head}Atoms # sphere\n\n1 1 0 0 0\n"),
            "f:7: atom_style `sphere` is not supported (supported: peri, atomic, bond, angle, molecular",
        ),
        (
            format!("{head}Atoms # full\n\n1 1 0 0 0\n"),
            "f:9: an atom has 7 numbers (or 10 with image flags), found 5",
        ),
        (
            format!("{head}Atoms # atomic\n\n1 1 1.0 1.0 0 0 0\n"),
            "f:9: an atom has 5 numbers (or 8 with image flags), found 7",
        ),
        (
            format!("{head}Atoms\n\n1 1 1.0 1.0 0 0 0\n"),
            "f: the file is of atom_style peri",
        ),
    ] {
        let got = data::parse_data(&text, "f").unwrap_err().to_string();
        assert!(got.starts_with(message), "{message}\n{got}");
    }
}

#[test]
fn what_other_programs_write_is_read() {
    // momenta of ASE, quoted values with other keys, a cluster without lattice
    let text = "2\nLattice=\"2.0 0.0 0.0 0.0 2.0 0.0 0.0 0.0 2.0\" Properties=species:S:1:pos:R:3:masses:R:1:momenta:R:3:tags:I:1:forces:R:3 energy=-1.5 pbc=\"T F T\" note='a b'\nCu 0 0 0 2.0 1 2 4 0 9 8 7\nCu 1 1 1 2.0 0 0 0 0 1 1 1\n1\n\nH 1 2 3\n";
    let atoms = extxyz::parse_extxyz(text, "f", Frame::Index(0)).unwrap();
    assert_eq!(atoms.velocity.unwrap()[0], [0.5, 1.0, 2.0]);
    assert_eq!(atoms.force.unwrap()[0], [9.0, 8.0, 7.0]);
    assert_eq!(
        (atoms.periodic, atoms.species[0].mass),
        ([true, false, true], Some(2.0))
    );
    let cluster = extxyz::parse_extxyz(text, "f", Frame::Last).unwrap();
    assert_eq!(
        (cluster.low, cluster.high, cluster.periodic),
        ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [false; 3])
    );
}
