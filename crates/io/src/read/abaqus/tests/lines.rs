//! Keywords, names, numbers, elements and included files.

use super::*;
use crate::read::{Frame, points};
use proptest::prelude::*;
use std::path::Path;

#[test]
fn lines_names_and_blank_fields_are_those_of_abaqus() {
    let text = "\u{feff}** a comment\n*Node ,\n** inside a keyword line\nN set = My Set\n1\n2, 1.D0\n3, 1, 1, 0, 0., 0., 1.\n 4 ,, 1\n\
        *ELEMENT, TYPE=CPS4,\n ELSET=\"Half, of it\"\n1, 1, 2, 3, 4,\n** between\n\n\
        *ELSET, ELSET=\"My set\"\n\"Half, of it\"\n*elset, elset=MYSET\n1\n*NSET,nset=Two Names\nmyset\n";
    let points = read(text);
    near(&points.cloud.volume, &[1.0]);
    near(&points.cloud.position[0], &[0.5, 0.5, 0.0]);
    let names: Vec<&str> = points.cloud.sets.iter().map(|(n, _)| &**n).collect();
    assert_eq!(
        names,
        ["Half, of it", "My set", "MYSET", "MySet", "TwoNames"]
    );
    refused(
        &text
            .replace("\"My set\"", "S")
            .replace("\"Half, of it\"\n*e", "\"half, of it\"\n*e"),
        "found `\"half, of it\"`",
    );
    refused("1,0,0\n*NODE\n", "f:1: expected a keyword, found `1,0,0`");
    refused("*NODE\n1,0,0,0,0,0,0,0\n", "f:2: a line of *NODE has");
    refused("*NODE\n1,0,1.x\n", "f:2: expected y, found `1.x`");
    refused("*NODE\n0,0,1\n", "f:2: a node number is 0");
    let long = format!("*NODE\n{}\n", "9".repeat(10_000));
    let error = parse(&long, "f", "inp").unwrap_err().to_string();
    assert!(error.len() < 200, "{error}");
}

#[test]
fn elements_of_many_nodes_go_on_in_the_next_line() {
    let nodes: String = BOXES.split("*ELEMENT").next().unwrap().into();
    // the twelve nodes between corners do not count, and need not be there
    let brick = "1,1,2,5,4,7,8,11,10,21,22,23,24,25,26,27";
    for line in [
        ",\n28,29,30,31,32\n",
        "\n28,29,30,31,32\n",
        ",\n28,29,30,31,32,\n",
    ] {
        let text = format!("{nodes}*ELEMENT,TYPE=C3D20R\n{brick}{line}");
        near(&read(&text).cloud.volume, &[6.0]);
    }
    let variable = format!("{nodes}*ELEMENT,TYPE=C3D27\n{brick},28,29,30,31,32,33\n");
    near(&read(&variable).cloud.volume, &[6.0]);
    let shell = format!("{nodes}*ELEMENT,TYPE=SC8R\n1,1,2,5,4,7,8,11,10\n");
    near(&read(&shell).cloud.volume, &[6.0]);
    refused(
        &format!("{nodes}*ELEMENT,TYPE=C3D20\n{brick}\n"),
        "f:15: element 1 of type C3D20 has 15 nodes instead of 20",
    );
    refused(
        &format!("{nodes}*ELEMENT,TYPE=COH3D8\n1\n"),
        "f:14: unknown element type COH3D8 (cohesive",
    );
    refused(
        &format!("{nodes}*ELEMENT,TYPE=C3D8,OFFSET=1\n1\n"),
        "f:14: *ELEMENT with OFFSET is not read",
    );
}

#[test]
fn what_may_change_the_mesh_is_refused_by_its_name_and_line() {
    for (keyword, message) in [
        (
            "*NMAP, NSET=N, TYPE=SPHERICAL\n0,0,0",
            "f:21: *NMAP is not read",
        ),
        (
            "*Imperfection, file=f, step=1\n1, 0.1",
            "f:21: *IMPERFECTION moves nodes",
        ),
        (
            "*PARAMETER\na = 1",
            "f:21: *PARAMETER is not read: write numbers",
        ),
        (
            "*Model Change, remove\nFIRST",
            "f:21: *MODEL CHANGE takes elements away",
        ),
        (
            "*NODES\n1,0,0",
            "f:21: *NODES is not known, and may change the mesh",
        ),
        (
            "*NODE, NST=N\n1,0,0",
            "f:21: *NODE with NST is not read; known are NSET, SYSTEM, INPUT",
        ),
        ("*NSET, NSET=N, SURFACE=S", "*NSET with SURFACE is not read"),
        ("*NSET, GENERATE\n1,2", "f:21: *NSET needs NSET="),
        ("*NSET, NSET=\"\"\n1", "f:21: *NSET needs NSET="),
        (
            "*INCLUDE, INPUT=other.inp",
            "f:21: *INCLUDE includes a file: put it in",
        ),
        (
            "*NODE, INPUT=other.inp",
            "f:21: *NODE includes a file: put it in",
        ),
    ] {
        refused(&format!("{BOXES}{keyword}\n"), message);
    }
    let silent = "*Solid Section, elset=FIRST, material=M\n,\n*SOLIDSECTION, ELSET=FIRST, MATERIAL=M\n1.\n\
        *Material, name=M\n*Elastic\n 2., 0.3\n*Amplitude, name=A\n0., 0., 1., 1.\n*Boundary\nLEFT, 1, 3\n\
        *Step, name=S, nlgeom=YES\n*Static\n1., 1.\n*Dsload\nS, P, 1.\n*Output, field\n*Node Output\nU,\n*End Step\n";
    assert_eq!(read(&format!("{BOXES}{silent}")), read(BOXES));
}

#[test]
fn included_files_are_read_in_their_place() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
    let get = |name: &str| points(&dir.path().join(name), Frame::Last);
    let (nodes, rest) = BOXES.split_once("*ELEMENT").unwrap();
    write("all.inp", BOXES);
    write("nodes.txt", nodes.strip_prefix("*NODE\n").unwrap());
    write("rest.txt", &format!("*ELEMENT{rest}"));
    write(
        "a.inp",
        "*NODE\n*INCLUDE, INPUT=nodes.txt\n**\n*Include,\ninput=rest.txt\n",
    );
    write(
        "b.inp",
        "*NODE, INPUT=nodes.txt\n*INCLUDE, INPUT=\"rest.txt\"\n",
    );
    let wanted = get("all.inp").unwrap();
    assert_eq!(get("a.inp").unwrap(), wanted);
    assert_eq!(get("b.inp").unwrap(), wanted);
    // what is wrong in one is said with its name and line
    write("rest.txt", "\n*ELEMENT,TYPE=C3D8\n1,1,2,5,4,7,8,11,99\n");
    let error = get("a.inp").unwrap_err();
    assert!(Path::new(&error.file).ends_with("rest.txt"), "{error}");
    assert_eq!(error.line, Some(3));
    write("rest.txt", "*ELEMENT,TYPE=C3D8\n1,1,2,5,4,1,2,5,4\n");
    let error = get("a.inp").unwrap_err();
    assert!(Path::new(&error.file).ends_with("rest.txt"), "{error}");
    assert_eq!(error.line, Some(2));
    write("c.inp", "*HEADING\n*INCLUDE, INPUT=c.inp\n");
    let error = get("c.inp").unwrap_err();
    assert!(
        error
            .to_string()
            .contains("c.inp:2: c.inp is included by itself"),
        "{error}"
    );
    write("d.inp", "*INCLUDE, INPUT=none.inp\n");
    let error = get("d.inp").unwrap_err().to_string();
    assert!(
        error.contains("d.inp:1: cannot read the included file none.inp"),
        "{error}"
    );
    // not a plain file: a folder, or what never ends
    write("e.inp", "*INCLUDE, INPUT=/dev/zero\n");
    assert!(
        get("e.inp")
            .unwrap_err()
            .to_string()
            .contains("cannot read the included file")
    );
}

proptest! {
    /// No damage to a file makes the reader panic.
    #[test]
    fn damaged_files_are_read_or_refused(at in 0.0..1.0f64, cut in 0usize..40, put in "[-0-9$*,.\" =\\nA-Za-z]{0,12}") {
        let start = (at * WHOLE.len() as f64) as usize;
        let damaged = format!("{}{put}{}", &WHOLE[..start], &WHOLE[(start + cut).min(WHOLE.len())..]);
        if let Err(error) = parse(&damaged, "f", "inp") {
            prop_assert!(!error.message.is_empty());
        }
    }
}

/// Something of everything.
const WHOLE: &str = include_str!("../../../../../../decks/good/instances.inp");

#[test]
fn the_deck_of_instances_is_a_bar() {
    let points = read(WHOLE);
    assert_eq!(points.cloud.volume.len(), 32);
    near(&[volume(&points)], &[32.0]);
    near(&centroid(&points), &[4.0, 1.0, 1.0]);
    for (name, x) in [("left.End", 0.5), ("right.End", 7.5)] {
        assert_eq!(area(&points, name), Some(4.0), "{name}");
        let ids = set(&points, name).unwrap();
        assert_eq!(ids.len(), 4);
        for id in ids {
            near(&points.cloud.position[*id as usize][..1], &[x]);
        }
    }
}
