//! Nodes and elements in coordinates of their own, and made of others.

use super::*;

/// Four cells of 10° between radii 10 and 12 in two rows, of height 1.
fn sector(system: &str, place: impl Fn(f64, f64, f64) -> String) -> String {
    let mut text = format!("*NODE{system}\n");
    for (layer, z) in [0.0, 1.0].into_iter().enumerate() {
        for angle in 0..5usize {
            for r in 0..3usize {
                let number = 15 * layer + 3 * angle + r + 1;
                let place = place(10.0 + r as f64, 10.0 * angle as f64, z);
                text += &format!("{number}, {place}\n");
            }
        }
    }
    text += "*ELEMENT, TYPE=C3D8\n1, 1, 2, 5, 4, 16, 17, 20, 19\n*ELGEN\n1, 2, 1, 1, 4, 3, 2\n";
    text
}

/// Of a sector with flat sides: half the sine of its angle times r².
fn flat(low: f64, high: f64, degrees: f64) -> f64 {
    0.5 * degrees.to_radians().sin() * (high * high - low * low)
}

#[test]
fn nodes_in_cylindrical_and_spherical_coordinates() {
    let wanted = 4.0 * flat(10.0, 12.0, 10.0);
    assert!((wanted - 15.281).abs() < 1e-3);
    let text = sector(", SYSTEM=C", |r, angle, z| format!("{r}, {angle}, {z}"));
    let points = read(&text);
    assert_eq!(points.cloud.volume.len(), 8);
    near(&[volume(&points)], &[wanted]);
    // a ball's coordinates of the same places: φ is counted from the x-y plane
    let text = sector(",system = s", |r, angle, z| {
        format!("{}, {angle}, {}", r.hypot(z), z.atan2(r).to_degrees())
    });
    let ball = read(&text);
    near(&[volume(&ball)], &[wanted]);
    near(&centroid(&ball), &centroid(&points));
    refused(
        "*NODE, SYSTEM=T\n1,0,0\n",
        "f:1: SYSTEM=T is none of R, C, S",
    );
}

#[test]
fn nodes_in_a_system_of_their_own() {
    // origin at (10, 0, 0), x along the old y, y along the old −x
    let system = "*SYSTEM\n10,0,0, 10,3,0\n5,0,0\n";
    let text = format!("{system}{BOXES}");
    near(&centroid(&read(&text)), &[9.0, 1.0, 1.5]);
    // the second line left out: z stays, x is along b in the plane
    let text = format!("*SYSTEM\n10,0,0, 10,3,8\n{BOXES}");
    near(&centroid(&read(&text)), &[9.0, 1.0, 1.5]);
    // origin alone
    let text = format!("*SYSTEM\n10,20,30\n{BOXES}");
    near(&centroid(&read(&text)), &[11.0, 21.0, 31.5]);
    // cylindrical coordinates in it
    let text = sector(", SYSTEM=C", |r, angle, z| format!("{r}, {angle}, {z}"));
    let (plain, moved) = (read(&text), read(&format!("{system}{text}")));
    let [x, y, z] = centroid(&plain);
    near(&centroid(&moved), &[10.0 - y, x, z]);
    // it ends with an empty one
    let text = format!("{system}*NODE\n99,0,0,0\n*SYSTEM\n{BOXES}");
    near(&centroid(&read(&text)), &[1.0, 1.0, 1.5]);
    refused(
        "*SYSTEM\n0,0,0,1,0,0\n2,0,0\n",
        "lie on one another, or on a line",
    );
}

#[test]
fn meshes_are_generated() {
    // 4 × 3 × 2 elements on 12 × 6 × 2, by lines, planes and a copy
    let text = "*NODE\n1,0,0,0\n5,12,0,0\n31,0,6,0\n35,12,6,0\n\
        *NGEN,NSET=FRONT\n1,5\n*NGEN,NSET=BACK\n31,35,1\n*NFILL,NSET=BOTTOM\nFRONT,BACK,3,10\n\
        *NCOPY,CHANGE NUMBER=200,OLD SET=BOTTOM,NEW SET=TOP,SHIFT\n0,0,2\n,\n\
        *NGEN\n1,201,100\n5,205,100\n*NFILL\nBOTTOM,TOP,2,100\n\
        *ELEMENT,TYPE=C3D8\n1,1,2,12,11,101,102,112,111\n*ELGEN,ELSET=ALL\n1,4,1,1,3,10,4,2,100,12\n";
    let points = read(text);
    assert_eq!(points.cloud.volume.len(), 24);
    near(&[volume(&points)], &[144.0]);
    near(&centroid(&points), &[6.0, 3.0, 1.0]);
    near(&points.cloud.volume[..1], &[6.0]);
    assert_eq!(set(&points, "ALL").map(<[u32]>::len), Some(24));
    assert_eq!(area(&points, "FRONT"), None);
    assert_eq!(area(&points, "TOP"), Some(72.0));
    refused(
        &text.replace("1,5\n", "1,5,3\n"),
        "f:7: steps of 3 do not lead from node 1 to node 5",
    );
    refused(
        &text.replace("FRONT,BACK,3,10", "FRONT,BACK,3,9"),
        "f:11: 3 intervals with an increment of 9",
    );
    refused(
        &text.replace("NFILL,NSET=BOTTOM", "NFILL,BIAS=2,NSET=BOTTOM"),
        "f:10: *NFILL with BIAS is not read",
    );
    refused(
        &text.replace("4,1,1,3,10,4", "4,1,1,3,10,3"),
        "element 4 is defined twice",
    );
    refused(
        &text.replace("2,100,12", "3,100,12"),
        "element 25 refers to node 301, which does not exist",
    );
    refused(
        &text.replace("1,4,1,1,3", "1,4000000,1,1,3000000"),
        "would take about",
    );
}

#[test]
fn arcs_and_parabolas_are_generated() {
    // a quarter of a ring between radii 1 and 2 in three cells: flat sides
    let arc = |line: &str, data: [&str; 2]| {
        format!(
            "*NODE\n1,1,0\n4,0,1\n11,2,0\n14,0,2\n99,0,0\n*NGEN,{line}\n1,4,1,{}\n11,14,1,{}\n\
             *ELEMENT,TYPE=CPE4\n1,1,11,12,2\n*ELGEN\n1,3\n",
            data[0], data[1]
        )
    };
    let ring = 3.0 * flat(1.0, 2.0, 30.0);
    near(&[volume(&read(&arc("LINE=C", ["99", "99"])))], &[ring]);
    near(
        &[volume(&read(&arc("LINE=C", [",0,0,0", ",0,0,0"])))],
        &[ring],
    );
    // with a normal the long way round: 270° in three cells of 90°
    let long = arc("LINE=C", ["99,,,,0,0,-1", "99,,,,0,0,-1"]);
    near(&[volume(&read(&long))], &[3.0 * flat(1.0, 2.0, 90.0)]);
    refused(&arc("LINE=C", ["", ""]), "need an extra point");
    refused(&arc("LINE=Q", ["99", "99"]), "LINE=Q is none of C, P");
    refused(&arc("NSET=A", ["99", "99"]), "needs LINE=C or LINE=P");
    let half = arc("LINE=C", ["99", "99"]).replace("4,0,1\n", "4,-1,0\n");
    refused(&half, "an arc of 180° or more needs a normal");
    let other = arc("LINE=C", ["99", "99"]).replace("4,0,1\n", "4,0,1.1\n");
    refused(&other, "the ends of the arc are 1 and 1.1 from its centre");
    // y = x²/4 from x = 0 to 4: middle at (2, 1); nodes at x = 1, 3
    let text = "*NODE\n1,0,0\n5,4,4\n11,0,-1\n15,4,-1\n99,2,1\n*NGEN,LINE=P\n1,5,1,99\n*NGEN\n11,15\n\
        *ELEMENT,TYPE=CPS4\n1,11,12,2,1\n*ELGEN\n1,4\n";
    let height = |x: f64| x * x / 4.0 + 1.0;
    let wanted: f64 = (0..4)
        .map(|k| 0.5 * (height(f64::from(k)) + height(f64::from(k + 1))))
        .sum();
    near(&[volume(&read(text))], &[wanted]);
}

#[test]
fn nodes_and_elements_are_copied() {
    let copy = |how: &str, data: &str| {
        let all = "*NSET,NSET=N,GENERATE\n1,12\n*ELSET,ELSET=E\n1,2\n";
        format!(
            "{BOXES}{all}*NCOPY,CHANGE NUMBER=100,OLD SET=N,NEW SET=M,{how}\n{data}\n\
             *ELCOPY,ELEMENT SHIFT=50,OLD SET=E,SHIFT NODES=100,NEW SET=F{}\n",
            if how.starts_with("REFLECT") {
                ",REFLECT"
            } else {
                ""
            }
        )
    };
    for (how, data, wanted) in [
        ("SHIFT", "5,6,7", [6.0, 7.0, 8.5]),
        // shifted, then a quarter turn about the z axis, twice
        (
            "SHIFT,MULTIPLE=2",
            "5,0,0\n0,0,0,0,0,1,90",
            [-6.0, -1.0, 1.5],
        ),
        ("REFLECT=POINT", "0,0,0", [-1.0, -1.0, -1.5]),
        ("REFLECT=LINE", "0,0,-1,0,0,9", [-1.0, -1.0, 1.5]),
        ("REFLECT=MIRROR", "0,5,0,1,5,0\n0,5,1", [1.0, 9.0, 1.5]),
    ] {
        let points = read(&copy(how, data));
        assert_eq!(points.cloud.volume.len(), 4, "{how}");
        near(&points.cloud.volume, &[6.0; 4]);
        let new = &points.cloud.position[2..];
        let middle: Vec<f64> = (0..3).map(|a| 0.5 * (new[0][a] + new[1][a])).collect();
        near(&middle, &wanted);
        assert_eq!(set(&points, "F"), Some(&[2, 3][..]), "{how}");
        assert_eq!(set(&points, "M"), Some(&[2, 3][..]), "{how}");
    }
    // from a pole twice as far: eight times the volume
    let points = read(&copy("POLE", "0,0,-10"));
    near(&points.cloud.volume, &[6.0, 6.0, 48.0, 48.0]);
    near(&[points.cloud.position[2][2]], &[13.0]);
    refused(
        &copy("NEWSET=K", "1"),
        "f:25: *NCOPY needs one of SHIFT, REFLECT=, POLE",
    );
    refused(&copy("REFLECT=PLANE", "1"), "REFLECT=PLANE is none of");
    refused(
        &copy("SHIFT", "0,0,0").replace("NUMBER=100", "NUMBER=1"),
        "node 2 is defined twice",
    );
    refused(
        &copy("SHIFT", "1,0,0").replace("NUMBER=100", "NUMBER=-7"),
        "numbers go from 1 to 999999999",
    );
    refused(
        &copy("SHIFT", "1,0,0").replace("OLD SET=E", "OLD SET=X"),
        "found `X`",
    );
}
