//! Sets and surfaces.

use super::*;

#[test]
fn sets_of_nodes_are_made_of_elements() {
    let text = format!("{BOXES}*NSET, NSET=OF, ELSET=FIRST\n*ELSET,ELSET=LATE\n9\n");
    assert_eq!(set(&read(&text), "OF"), Some(&[0][..]));
    refused(
        &format!("{text}*NSET,NSET=X,ELSET=LATE\n"),
        "f:24: an element of LATE is not defined before this line",
    );
    let text = assembly(
        "*Instance, name=one, part=Part-1\n*End Instance\n*Instance, name=two, part=Part-1\n5,0,0\n*End Instance\n\
         *Nset, nset=OF, elset=two.FIRST\n",
    );
    assert_eq!(set(&read(&text), "OF"), Some(&[2][..]));
}

#[test]
fn surfaces_are_sets_that_know_their_faces() {
    let text = format!(
        "{BOXES}*SURFACE, NAME=TOP\nBOTH, S2\n*SURFACE,NAME=right,TYPE=ELEMENT\n2,s4\n*SURFACE,NAME=HULL\nBOTH\n\
         *SURFACE,NAME=NODES,TYPE=NODE\nLEFT,\n*ELSET,ELSET=BOTH\n1,2\n*SURFACE,NAME=RIGID,TYPE=REVOLUTION\nSTART,1,2\n"
    );
    let points = read(&text);
    assert_eq!(set(&points, "TOP"), Some(&[0, 1][..]));
    assert_eq!(area(&points, "TOP"), Some(4.0));
    assert_eq!(set(&points, "right"), Some(&[1][..]));
    assert_eq!(area(&points, "right"), Some(6.0));
    // 2 (2·2 + 2·3 + 2·3) without the inner face
    assert_eq!(area(&points, "HULL"), Some(32.0));
    assert_eq!(area(&points, "NODES"), Some(6.0));
    assert_eq!(set(&points, "RIGID"), None);
    assert_eq!(
        points.notes[0],
        "the surface RIGID makes no set: REVOLUTION is not read"
    );
    refused(
        &format!("{BOXES}*SURFACE,NAME=S\n1,S7\n"),
        "f:22: element 1 has no face S7",
    );
    refused(
        &format!("{BOXES}*SURFACE,NAME=S\nNONE,S1\n"),
        "f:22: expected the number of an element or the name of a set",
    );
    // of a part it is one of each instance
    let part = BOXES.to_string() + "*SURFACE,NAME=S\n1,S1\n";
    let text = format!(
        "*PART,NAME=P\n{part}*END PART\n*ASSEMBLY\n*INSTANCE,NAME=A,PART=P\n*END INSTANCE\n*INSTANCE,NAME=B,PART=P\n0,9,0\n*END INSTANCE\n\
         *SURFACE,NAME=S\nA.2,S3\n*END ASSEMBLY\n"
    );
    let points = read(&text);
    assert_eq!(set(&points, "A.S"), Some(&[0][..]));
    assert_eq!(set(&points, "B.S"), Some(&[2][..]));
    assert_eq!(set(&points, "S"), Some(&[1][..]));
    assert_eq!(
        (area(&points, "B.S"), area(&points, "S")),
        (Some(2.0), Some(3.0))
    );
}

/// Areas of all faces of a cell by their numbers in the manual.
#[test]
fn faces_have_the_numbers_of_the_manual() {
    let slope = 14f64.sqrt();
    // the corners of a tetrahedron with legs 2, 4, 6; a wedge on its base of height 6; a pyramid
    for (cell, nodes, wanted) in [
        (
            "C3D4",
            "1,2,4,5",
            vec![4.0, 6.0, 4.0 * slope / 2.0 * 7.0 / slope, 12.0],
        ),
        (
            "C3D6",
            "1,2,4,5,6,8",
            vec![4.0, 4.0, 12.0, 6.0 * 20f64.sqrt(), 24.0],
        ),
        (
            "C3D5",
            "1,2,3,4,5",
            vec![
                8.0,
                6.0,
                4.0 * 40f64.sqrt() / 2.0,
                2.0 * 52f64.sqrt() / 2.0,
                12.0,
            ],
        ),
        (
            "C3D8",
            "1,2,3,4,5,6,7,8",
            vec![8.0, 8.0, 12.0, 24.0, 12.0, 24.0],
        ),
    ] {
        for (k, wanted) in wanted.into_iter().enumerate() {
            let text = format!(
                "*NODE\n1,0,0,0\n2,2,0,0\n3,2,4,0\n4,0,4,0\n5,0,0,6\n6,2,0,6\n7,2,4,6\n8,0,4,6\n\
                 *ELEMENT,TYPE={cell}\n1,{nodes}\n*SURFACE,NAME=S\n1,S{}\n",
                k + 1
            );
            near(&[area(&read(&text), "S").unwrap()], &[wanted]);
        }
    }
}

#[test]
fn cells_of_several_groups_keep_the_sides_of_surfaces() {
    // element 3 is element 1 again, in another set: one cell, and the sides stay where they were
    let text = BOXES.replace("*ELSET", "3,1,2,5,4,7,8,11,10\n4,2,3,6,5,8,9,12,11\n*ELSET")
        + "*ELSET,ELSET=X\n3\n*ELSET,ELSET=Y\n2\n*ELSET,ELSET=Z\n4\n*SURFACE,NAME=S\n4,S4\n";
    let points = read(&text);
    assert_eq!(points.cloud.volume, [6.0, 6.0]);
    assert_eq!(set(&points, "S"), Some(&[1][..]));
    assert_eq!(area(&points, "S"), Some(6.0));
}

#[test]
fn surfaces_of_plates_are_edges_and_those_of_shells_are_the_shells() {
    let plate = "*NODE\n1,0,0\n2,2,0\n3,2,5\n4,0,5\n*ELEMENT,TYPE=CPE4\n1,1,2,3,4\n";
    for (face, length) in [
        ("S1", 2.0),
        ("S2", 5.0),
        ("S3", 2.0),
        ("S4", 5.0),
        ("", 14.0),
    ] {
        let points = read(&format!("{plate}*SURFACE,NAME=S\n1,{face}\n"));
        assert_eq!(area(&points, "S"), Some(length), "{face}");
    }
    for skin in ["S4R", "M3D4", "CPS4"] {
        let solid = format!("{BOXES}*ELEMENT,TYPE={skin},ELSET=SKIN\n9,3,6,12,9\n");
        for face in ["", "SPOS", "SNEG"] {
            let points = read(&format!("{solid}*SURFACE,NAME=S\nSKIN,{face}\n"));
            assert_eq!(set(&points, "S"), Some(&[1][..]));
            assert_eq!(area(&points, "S"), Some(6.0));
        }
        let points = read(&format!("{solid}*SURFACE,NAME=S\nSKIN,E1\n"));
        assert_eq!(set(&points, "S"), None);
        assert!(points.notes[0].contains("the face E1 of a shell is not read"));
    }
}
