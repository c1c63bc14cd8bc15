use super::*;
use crate::write::setfl::{setfl_to, write_setfl};
use proptest::prelude::*;

const ALLOY: &str = include_str!("../../../tests/data/toy.eam.alloy");
const SINGLE: &str = include_str!("../../../tests/data/toy.eam");

fn cube(r: f64) -> f64 {
    (1.0 - r / 6.3).max(0.0).powi(3)
}

#[test]
fn an_alloy_has_its_tables() {
    let file = parse_setfl(ALLOY, "toy").unwrap();
    assert_eq!(
        (file.drho, file.dr, file.cutoff),
        (0.05, 0.1, 6.300000000000001)
    );
    assert_eq!(file.comments.len(), 3);
    let expected = EamElement {
        name: "Ni".into(),
        number: 28,
        mass: 58.69,
        lattice_constant: 3.52,
        lattice: "FCC".into(),
    };
    assert_eq!(file.elements[file.element("Ni").unwrap()], expected);
    assert_eq!(
        (
            file.embedding[1].len(),
            file.density[1].len(),
            file.pair.len()
        ),
        (60, 64, 3)
    );
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} {b}");
    near(file.embedding[1][7], -1.3 * 0.35f64.sqrt());
    near(file.density[0][11], cube(1.1));
    let pair = &file.pair[EamFile::pair_index(0, 1)];
    near(pair[11], 3.0 * 1.3 * cube(1.1) * (1.5 - 0.55));
    assert_eq!(EamFile::pair_index(2, 1), 4);
}

/// An eam/fs file has a density at each element: element by element, F, then those.
#[test]
fn densities_that_know_both_ends() {
    let row = |first: f64| -> String {
        let values = (0..6).map(|m| format!("{} ", first + f64::from(m)));
        values.collect::<String>() + "\n"
    };
    let mut text = "a\nb\nc\n2 Fe P\n6 0.1 6 0.5 2.5\n".to_string();
    for (element, first) in [("26 55.8 2.8 BCC\n", 100.0), ("15 31 3.3 FCC\n", 200.0)] {
        text += element;
        for table in 0..3 {
            text += &row(first + 10.0 * f64::from(table));
        }
    }
    for pair in 0..3 {
        text += &row(300.0 + 10.0 * f64::from(pair));
    }
    let file = parse_fs(&text, "toy").unwrap();
    assert_eq!(file.embedding[1][0], 200.0);
    let of = |of: usize, at: usize| file.density_of(of, at)[0];
    assert_eq!(
        [of(0, 0), of(0, 1), of(1, 0), of(1, 1)],
        [110.0, 120.0, 210.0, 220.0]
    );
    assert_eq!([file.density[0][0], file.density[1][0]], [110.0, 220.0]);
    assert_eq!(file.pair[EamFile::pair_index(1, 0)][0], 310.0);
    assert!(parse_setfl(&text, "toy").is_err());
    let message = setfl_to(&mut Vec::new(), &file).unwrap_err().to_string();
    assert!(message.contains("eam/fs"), "{message}");
}

#[test]
fn single_elements_become_one_potential_on_one_grid() {
    let one = parse_funcfl(&[(SINGLE, "toy")]).unwrap();
    // 50 knots at 0.13, of which 49 stay
    assert_eq!((one.pair[0].len(), one.embedding[0].len()), (49, 39));
    let z = |r: f64| 4.0 * cube(r);
    for m in 0..49 {
        let wanted = 27.2 * 0.529 * z(0.13 * f64::from(m)).powi(2);
        assert!((one.pair[0][m as usize] - wanted).abs() < 1e-12, "{m}");
    }
    // a coarser second element decides on the step
    let other = SINGLE
        .replace("29 63.55", "28 58.69")
        .replace("1.3000000000000000D-01", "1.5000000000000000D-01");
    let both = parse_funcfl(&[(SINGLE, "a"), (&other, "b")]).unwrap();
    assert_eq!((both.dr, both.density[0].len()), (0.15, 49));
    assert_eq!(both.element("Ni").unwrap(), 1);
    let cross = &both.pair[EamFile::pair_index(0, 1)];
    for m in [1, 7, 20] {
        let wanted = 27.2 * 0.529 * z(0.15 * m as f64) * z(0.13 * m as f64);
        assert!(
            (cross[m] - wanted).abs() < 1e-3 * wanted,
            "{m}: {} {wanted}",
            cross[m]
        );
    }
    let twice = parse_funcfl(&[(SINGLE, "a"), (SINGLE, "b")]).unwrap_err();
    assert!(
        twice.to_string().contains("b: a second file for Cu"),
        "{twice}"
    );
}

#[test]
fn what_is_written_reads_back() {
    for file in [
        parse_setfl(ALLOY, "toy").unwrap(),
        parse_funcfl(&[(SINGLE, "toy")]).unwrap(),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("t.eam.alloy");
        write_setfl(&path, &file).unwrap();
        let back = setfl(&path).unwrap();
        assert_eq!(back.comments.len(), 3);
        assert_eq!(back.comments[0], file.comments[0]);
        let same = EamFile {
            source: file.source.clone(),
            comments: file.comments.clone(),
            ..back
        };
        assert_eq!(same, file);
    }
}

#[test]
fn tables_that_do_not_fit_are_not_written() {
    let good = parse_setfl(ALLOY, "toy").unwrap();
    let fails = |change: fn(&mut EamFile), message: &str| {
        let mut file = good.clone();
        change(&mut file);
        let text = setfl_to(&mut Vec::new(), &file).unwrap_err().to_string();
        assert!(text.contains(message), "{text}");
    };
    fails(
        |f| f.pair.truncate(2),
        "take 3 tables of pair energies, there are 2",
    );
    fails(|f| f.density[1].truncate(9), "has 9 values instead of 64");
    fails(
        |f| f.embedding[0][3] = f64::NAN,
        "embedding energies is not finite",
    );
    fails(|f| f.elements[0].name = "C u".into(), "`C u` is no name");
}

fn failure_of(text: &str) -> String {
    parse_setfl(text, "f").unwrap_err().to_string()
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let lines: Vec<&str> = ALLOY.lines().collect();
    let with = |line: usize, text: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = text;
        failure_of(&lines.join("\n"))
    };
    for (line, text, message) in [
        (
            4,
            "3 Cu Ni",
            "f:4: 3 elements are announced and 2 named: write `2 Cu Ni`",
        ),
        (4, "2 Cu Cu", "f:4: the element Cu is named twice"),
        (
            4,
            "two Cu Ni",
            "f:4: expected the number of elements, found `two`",
        ),
        (
            5,
            "60 0.05 64 0.1",
            "f:5: expected the five numbers `Nrho drho Nr dr cutoff`, found 4",
        ),
        (
            5,
            "60 -0.05 64 0.1 6.3",
            "f:5: drho must be positive, found -0.05",
        ),
        (5, "60 0.05 64 0 6.3", "f:5: dr must be positive, found 0"),
        (5, "60 0.05 4 0.1 6.3", "f:5: Nr must be between 5"),
        (
            5,
            "60 0.05 64 0.1 7",
            "f:5: the cutoff 7 lies beyond the tables, which end at (Nr - 1) dr = 6.3",
        ),
        (5, "60 0.05 64 inf 7", "f:5: dr is inf"),
        (
            5,
            "59 0.05 64 0.1 6.3",
            "where `number mass lattice_constant lattice` of Ni should follow on a line of its own",
        ),
        (
            5,
            "61 0.05 65 0.1 6.3",
            "f:35: `3.52` stands after the last value of a table",
        ),
        (
            6,
            "29 -1 3.6 FCC",
            "f:6: the mass must be positive, found -1",
        ),
        (
            7,
            "0 1 2 x 4",
            "f:7: expected value 4 of 60 of the embedding energy F of Cu, a number such as 1.5E-3, found `x`",
        ),
        (
            8,
            "0 1 2 NaN 4",
            "f:8: value 9 of 60 of the embedding energy F of Cu is NaN",
        ),
    ] {
        let got = with(line, text);
        assert!(got.contains(message), "{message}\n{got}");
    }
    let text = failure_of(&format!("{ALLOY}1.0\n"));
    assert!(
        text.contains("stands after the last table") && text.contains("eam/fs"),
        "{text}"
    );
    let last = lines.len();
    let text = failure_of(&lines[..last - 1].join("\n"));
    let wanted = format!(
        "f:{}: the file ends within the table of r φ of the pair Ni-Ni: 4 of its 64 values are missing",
        last - 1
    );
    assert!(text.starts_with(&wanted), "{text}");
    assert!(failure_of("a\nb").contains("three comment lines"));
    assert!(
        failure_of("a\nb\nc\n1 Cu\n5 1 4000000000 1 5\n29 1 1 FCC\n1 2")
            .contains("3 of its 5 values are missing")
    );
    // the cutoff of a single element lies within its table, so that it still does on the common grid
    let single = SINGLE.replace("6.2999999999999998D+00", "6.4D+00");
    let text = parse_funcfl(&[(&single, "f")]).unwrap_err().to_string();
    assert!(
        text.starts_with("f:3: the cutoff 6.4 lies beyond the tables"),
        "{text}"
    );
    let single = SINGLE.replace("29 63.55", "129 63.55");
    let text = parse_funcfl(&[(&single, "f")]).unwrap_err().to_string();
    assert!(
        text.starts_with("f:2: no element has the atomic number 129"),
        "{text}"
    );
}

#[test]
fn an_element_that_is_not_there_names_the_closest() {
    let file = parse_setfl(ALLOY, "toy").unwrap();
    let text = file.element("NI").unwrap_err().to_string();
    assert_eq!(
        text,
        "toy: no element `NI` in this file; it has Cu, Ni; did you mean Ni?"
    );
    let one = parse_funcfl(&[(SINGLE, "toy")]).unwrap();
    assert!(
        one.element("Al")
            .unwrap_err()
            .to_string()
            .ends_with("it has Cu; write Cu")
    );
}

proptest! {
    #[test]
    fn no_text_breaks_the_reader(cut in 0usize..ALLOY.len(), junk in "[ -~\n]{0,12}") {
        let mut text: String = ALLOY.chars().take(cut).collect();
        text += &junk;
        text += &ALLOY[cut..].chars().skip(junk.len()).collect::<String>();
        let _ = parse_setfl(&text, "f");
        let _ = parse_funcfl(&[(&text, "f")]);
    }
}
