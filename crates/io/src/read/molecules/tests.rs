use super::*;

const HEAD: &str = "title\n\n4 atoms\n\nAtoms # molecular\n\n7 1 1 0 0 0\n3 1 1 1 0 0\n5 1 1 1 1 0\n9 1 1 2 1 1\n\n";

fn parse(rest: &str) -> Result<BondedSpec, ReadError> {
    parse_molecules(
        &format!("{HEAD}{rest}"),
        "x.data",
        [0.0, 0.0, 0.5],
        2.0,
        3.0,
    )
}

#[test]
fn terms_name_places_and_constants_grow_with_units() {
    let made = parse(
        "Bond Coeffs # harmonic\n\n1 4 1.5\n\nDihedral Coeffs # opls\n\n2 1 2 3 4\n\n\
         Bonds\n\n1 1 3 5\n2 1 5 7\n\nDihedrals\n\n1 2 3 5 7 9\n",
    );
    let made = made.unwrap();
    let bond = Form::HarmonicBond {
        stiffness: 3.0,
        length: 3.0,
    };
    assert_eq!(made.forms[0], bond);
    assert_eq!(made.terms[0].points, [0, 1, 0, 0]);
    assert_eq!(made.terms[1].points, [1, 2, 0, 0]);
    assert_eq!(made.terms[2].points, [0, 1, 2, 3]);
    assert_eq!(made.special, [0.0, 0.0, 0.5]);
    let Form::Dihedral { powers } = &made.forms[1] else {
        panic!("{:?}", made.forms)
    };
    for n in 0..20 {
        let phi = 0.3 * f64::from(n);
        let waves = [(1.0, 1.0), (-2.0, 2.0), (3.0, 3.0), (-4.0, 4.0)];
        let sum = |(k, n): &(f64, f64)| 1.5 * (k.abs() + k * (n * phi).cos());
        let exact: f64 = waves.iter().map(sum).sum();
        let found: f64 = (0..).zip(powers).map(|(n, p)| p * phi.cos().powi(n)).sum();
        assert!((found - exact).abs() < 1e-12, "{phi}: {found} {exact}");
    }
}

#[test]
fn impropers_are_read_in_degrees() {
    let made = parse("Improper Coeffs # harmonic\n\n1 4 30\n\nImpropers\n\n1 1 3 5 7 9\n");
    let made = made.unwrap();
    let improper = Form::HarmonicImproper {
        stiffness: 12.0,
        angle: 30f64.to_radians(),
    };
    assert_eq!(made.forms, [improper]);
    assert_eq!(made.terms[0].points, [0, 1, 2, 3]);
}

#[test]
fn what_cannot_be_is_named_with_its_line() {
    let error = |rest: &str| parse(rest).unwrap_err().to_string();
    assert!(error("Bonds\n\n1 1 3 5\n").contains("type 1 has no coefficients"));
    assert!(error("Bond Coeffs\n\n1 4 1.5\n").contains("does not say its style"));
    assert!(error("Bond Coeffs # morse\n\n1 4 1 1.5\n").contains("`morse` is not known"));
    assert!(error("Bond Coeffs # harmonic\n\n1 4\n").contains("1 coefficients"));
    assert!(error("Bonds\n\n1 1 3\n").contains("and 2 atoms"));
    let bonds = "Bond Coeffs # harmonic\n\n1 4 1\n\nBonds\n\n1 1 3 6\n";
    assert!(error(bonds).contains("no atom with id 6"));
    let improper = "Improper Coeffs # cvff\n\n1 2 1 2\n";
    assert!(error(improper).contains("`cvff` is not known; known are harmonic"));
    let phase = "Dihedral Coeffs # charmm\n\n1 2 3 60 0\n";
    assert!(error(phase).contains("knows left from right"));
}
