//! Right values are sums of boxes, of flat-sided sectors and of faces, by hand.

use crate::read::body::Points;

use crate::read::parse;

mod assembly;
mod generated;
mod lines;
mod sets;

fn read(text: &str) -> Points {
    parse(text, "f", "inp").unwrap_or_else(|e| panic!("{e}"))
}

#[track_caller]
fn refused(text: &str, message: &str) {
    let got = match parse(text, "f", "inp") {
        Ok(points) => panic!("{} points of {text}", points.cloud.volume.len()),
        Err(error) => error.to_string(),
    };
    assert!(got.contains(message), "{message:?} is not in {got:?}");
}

fn volume(points: &Points) -> f64 {
    points.cloud.volume.iter().sum()
}

fn centroid(points: &Points) -> [f64; 3] {
    let cloud = &points.cloud;
    let each = || cloud.position.iter().zip(&cloud.volume);
    std::array::from_fn(|a| each().map(|(x, v)| x[a] * v).sum::<f64>() / volume(points))
}

#[track_caller]
fn near(got: &[f64], wanted: &[f64]) {
    assert_eq!(got.len(), wanted.len());
    for (g, w) in got.iter().zip(wanted) {
        assert!((g - w).abs() < 1e-12, "{got:?} is not {wanted:?}");
    }
}

fn set<'a>(points: &'a Points, name: &str) -> Option<&'a [u32]> {
    let mut all = points.cloud.sets.iter();
    all.find(|(known, _)| known == name).map(|(_, ids)| &**ids)
}

fn area(points: &Points, name: &str) -> Option<f64> {
    let mut all = points.cloud.faces.iter();
    all.find(|(known, _)| known == name)
        .map(|(_, areas)| areas.iter().sum())
}

/// A box of 1 × 2 × 3 at the origin, and one of 1 × 2 × 3 beside it along x.
const BOXES: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,2,0\n5,1,2,0\n6,2,2,0\n\
    7,0,0,3\n8,1,0,3\n9,2,0,3\n10,0,2,3\n11,1,2,3\n12,2,2,3\n\
    *ELEMENT,TYPE=C3D8R\n1,1,2,5,4,7,8,11,10\n2,2,3,6,5,8,9,12,11\n\
    *ELSET,ELSET=FIRST\n1\n*NSET,NSET=LEFT\n1,4,7,10\n";

fn assembly(instances: &str) -> String {
    format!(
        "*HEADING\n*PART, NAME=Part-1\n{BOXES}*END PART\n*ASSEMBLY, NAME=A\n{instances}*END ASSEMBLY\n"
    )
}
