use super::super::{LinearBody, Options, Radius, Scheme, coarsen};
use super::bodies::{chain, lattice};

fn told<const D: usize>(
    body: &LinearBody<D>,
    retained: &[u32],
    scheme: Scheme,
    radius: Radius,
) -> String {
    let options = Options {
        scheme,
        radius,
        ..Options::default()
    };
    match coarsen(body, retained, &options) {
        Ok(_) => "nothing".into(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn requests_that_mean_nothing_are_named() {
    let bar = chain(9, &[1.0, 0.5]);
    let four = Radius::Fixed(4.0);
    for (retained, radius, message) in [
        (vec![], four, "no point is retained"),
        (
            vec![0, 9],
            four,
            "point 9 is to be retained, but the body has 9 points",
        ),
        (vec![0, 4, 0], four, "point 0 is to be retained twice"),
        (
            vec![0, 4, 8],
            Radius::Fixed(1.5),
            "below the longest bond 2 of the body below (two horizons for state-based laws): use 2 or more",
        ),
        (
            vec![0, 4, 8],
            Radius::Fixed(f64::NAN),
            "must be a positive number",
        ),
        (
            vec![0, 4, 8],
            Radius::Tolerance(0.0),
            "between 0 and 1, not 0",
        ),
        (
            vec![0, 8],
            Radius::Fixed(2.0),
            "removed point 3 lies in no ball of radius 2",
        ),
    ] {
        let said = told(&bar, &retained, Scheme::Energy, radius);
        assert!(said.contains(message), "{said}");
    }
    let said = told(&bar, &[0, 1, 8], Scheme::Rows, Radius::Fixed(2.0));
    assert!(
        said.contains("ball of radius 2 about retained point 8 holds no other retained point"),
        "{said}"
    );
    let said = told(&bar, &[0, 1, 7, 8], Scheme::Rows, Radius::Fixed(2.0));
    assert!(
        said.contains(
            "retained points 0 and 7 are connected by bonds below, but not in the coarse body"
        ),
        "{said}"
    );
    let mut broken = bar.clone();
    broken.block[3][0][0] = f64::NAN;
    assert!(told(&broken, &[0, 8], Scheme::Energy, four).contains("not finite at point"));
}

#[test]
fn bodies_that_cannot_be_coarsened_are_named() {
    let four = Radius::Fixed(4.0);
    // two halves without bonds between them
    let halves = lattice([10], 1.0, false, |x, y| {
        f64::from(u8::from((x[0] < 5) == (y[0] < 5)))
    });
    let said = told(&halves, &[0, 4], Scheme::Energy, four);
    assert!(
        said.contains("a part of 5 points that are bonded to no others (point 5 is one)"),
        "{said}"
    );
    assert_eq!(
        told(&halves, &[0, 4, 5, 9], Scheme::Energy, four),
        "nothing"
    );
    // a bond that pushes
    let mut unstable = chain(9, &[1.0]);
    let k = unstable.start[4];
    unstable.block[k][0][0] = -3.0;
    let k = unstable.start[3] + 1;
    unstable.block[k][0][0] = -3.0;
    for scheme in [Scheme::Energy, Scheme::Rows, Scheme::Schur] {
        let said = told(&unstable, &[0, 8], scheme, Radius::Fixed(9.0));
        assert!(said.contains("no stable equilibrium"), "{said}");
    }
    // it is between retained points: every ball is sound, the whole is not
    let said = told(&unstable, &[0, 3, 4, 8], Scheme::Energy, four);
    assert!(
        said.contains("the coarse body has unstable modes"),
        "{said}"
    );
    let mut unsymmetric = chain(9, &[1.0]);
    unsymmetric.block[3][0][0] = 1.5;
    let said = told(&unsymmetric, &[0, 4, 8], Scheme::Energy, four);
    assert!(
        said.contains("action is not reaction in the body below"),
        "{said}"
    );
    assert_eq!(
        told(&unsymmetric, &[0, 4, 8], Scheme::Rows, four),
        "nothing"
    );
}
