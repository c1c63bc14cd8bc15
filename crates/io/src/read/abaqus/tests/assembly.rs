//! Parts and instances; whose name is whose.

use super::*;

#[test]
fn instances_are_copies_that_are_shifted_then_turned() {
    // a quarter turn about the line x = 10, y = 0 takes (x, y) to (10 − y, x − 10); shifted by 12 before
    let text = assembly(
        "*Instance, name=one, part=PART-1\n*End Instance\n\
         *Instance, name=two, part=Part-1\n12., 0., 0.\n10,0,0, 10,0,1, 90.\n*End Instance\n",
    );
    let points = read(&text);
    assert_eq!(points.cloud.volume.len(), 4);
    near(&[volume(&points)], &[24.0]);
    near(&points.cloud.position[0], &[0.5, 1.0, 1.5]);
    near(&points.cloud.position[1], &[1.5, 1.0, 1.5]);
    near(&points.cloud.position[2], &[9.0, 2.5, 1.5]);
    near(&points.cloud.position[3], &[9.0, 3.5, 1.5]);
    // the axis has a point and a direction: its length and the sense of a turn do not
    let other = text.replace("10,0,0, 10,0,1, 90.", "10,0,-7, 10,0,-8, -90.");
    near(&read(&other).cloud.position[3], &[9.0, 3.5, 1.5]);
    // sets of the part are sets of each
    assert_eq!(set(&points, "one.FIRST"), Some(&[0][..]));
    assert_eq!(set(&points, "two.FIRST"), Some(&[2][..]));
    assert_eq!(set(&points, "one.LEFT"), Some(&[0][..]));
    assert_eq!(set(&points, "two.LEFT"), Some(&[2][..]));
    assert_eq!((set(&points, "FIRST"), set(&points, "LEFT")), (None, None));
    assert_eq!(points.cloud.mark, [1, 0, 2, 0]);
}

#[test]
fn a_line_of_seven_numbers_is_a_turn_alone() {
    let text = assembly("*Instance, name=i, part=Part-1\n0,0,0, 0,0,2, 180\n*End Instance\n");
    near(&centroid(&read(&text)), &[-1.0, -1.0, 1.5]);
    let text = assembly("*Instance, name=i, part=Part-1\n1,2,3\n0,0,0, 0,0,0, 0\n*End Instance\n");
    near(&centroid(&read(&text)), &[2.0, 3.0, 4.5]);
    refused(
        &assembly("*Instance, name=i, part=Part-1\n1,2,3\n0,0,0, 0,0,0, 5\n*End Instance\n"),
        "f:27: the two points of the axis of rotation are one",
    );
}

#[test]
fn names_are_those_of_their_part_instance_or_assembly() {
    let text = assembly(
        "*Instance, name=one, part=Part-1\n*End Instance\n\
         *Instance, name=two, part=Part-1\n5,0,0\n*End Instance\n\
         *Nset, nset=LEFT, instance=two\n3,6,9,12\n\
         *Nset, nset=ENDS\none.LEFT, LEFT\n\
         *Elset, elset=SECOND, instance=one\n2\n\
         *Elset, elset=SECOND, instance=two\n2\n\
         *Elset, elset=SAME\none.FIRST, A.two.FIRST, two.2\n",
    );
    let points = read(&text);
    // not united with those of the part: right of the second instance alone
    assert_eq!(set(&points, "LEFT"), Some(&[3][..]));
    assert_eq!(set(&points, "one.LEFT"), Some(&[0][..]));
    assert_eq!(set(&points, "two.LEFT"), Some(&[2][..]));
    assert_eq!(set(&points, "ENDS"), Some(&[0, 3][..]));
    assert_eq!(set(&points, "SECOND"), Some(&[1, 3][..]));
    assert_eq!(set(&points, "SAME"), Some(&[0, 2, 3][..]));
    refused(
        &text.replace("one.LEFT, LEFT", "FIRST2, LEFT"),
        "found `FIRST2`",
    );
    refused(
        &text.replace("one.FIRST, A.two.FIRST", "FIRST"),
        "`FIRST` is a set of an instance, not of the assembly: write one.FIRST or two.FIRST",
    );
    refused(
        &text.replace("LEFT, instance=two", "LEFT, instance=three"),
        "there is no instance three",
    );
}

#[test]
fn a_name_that_no_other_set_has_needs_no_instance() {
    let text = assembly("*Instance, name=one, part=Part-1\n4,0,0\n*End Instance\n");
    let points = read(&text);
    for name in ["FIRST", "one.FIRST", "LEFT", "one.LEFT"] {
        assert_eq!(set(&points, name), Some(&[0][..]), "{name}");
    }
    assert_eq!(area(&points, "LEFT"), Some(6.0));
    assert_eq!(area(&points, "one.LEFT"), Some(6.0));
    assert_eq!(points.cloud.names, [(1, "FIRST".to_string())]);
}

#[test]
fn instances_may_have_their_own_mesh_and_parts_none() {
    let text = format!(
        "*PART,NAME=P\n*END PART\n*PART,NAME=Q\n{BOXES}*END PART\n*ASSEMBLY,NAME=A\n\
         *INSTANCE,NAME=I,PART=P\n0,0,7\n{BOXES}*END INSTANCE\n*NODE\n1,99,99,99\n*END ASSEMBLY\n"
    );
    let points = read(&text);
    near(&centroid(&points), &[1.0, 1.0, 8.5]);
    near(&[volume(&points)], &[12.0]);
    assert_eq!(
        points.notes[0],
        "the part Q has no instance: it is no part of the body"
    );
    // without an assembly a part alone is the model
    let alone = format!("*PART,NAME=Q\n{BOXES}*END PART\n");
    near(&[volume(&read(&alone))], &[12.0]);
    let two = format!("{alone}*PART,NAME=R\n{BOXES}*END PART\n");
    refused(&two, "the parts Q, R have no *INSTANCE");
    refused(
        &format!("{alone}*ASSEMBLY\n*END ASSEMBLY\n"),
        "no *INSTANCE",
    );
    refused(
        &format!("*PART,NAME=Q\n{BOXES}"),
        "the part Q, which has no *END PART",
    );
    refused(
        &format!("{alone}*END PART\n"),
        "f:23: *END PART without *PART",
    );
    refused(
        "*ASSEMBLY\n*INSTANCE,NAME=I,PART=P\n*END INSTANCE\n",
        "f:2: there is no part P",
    );
    refused(
        "*ASSEMBLY\n*INSTANCE,NAME=I,INSTANCE=O,LIBRARY=l\n",
        "f:2: *INSTANCE with INSTANCE is not read",
    );
}
