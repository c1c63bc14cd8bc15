//! `peridyne bar` as a user runs it.

use serde_json::{Value, json};
use std::process::{Command, Output};

fn bar(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("bar")
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

fn found(arguments: &str) -> Value {
    let done = bar(&format!("{arguments} --json"));
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    serde_json::from_slice(&done.stdout).unwrap()
}

#[test]
fn homogenized_bars_are_those_of_the_paper() {
    let full = found("--m 3 --points 100 --ends full --homogenize");
    assert_eq!(full["f"], "1");
    assert_eq!(full["f_decimal"], 1.0);
    assert_eq!(full["f_limit"], "1");
    assert_eq!(full["alpha"], json!(["5/2", "3/2"]));
    assert_eq!(full["stiffness_scale"], 6);
    let corner = json!([
        ["-41/2", 15, "9/2", 1],
        [15, -25, 6, 3],
        ["9/2", 6, "-41/2", 6],
        [1, 3, 6, -20]
    ]);
    assert_eq!(full["stiffness_corner"], corner);
    assert_eq!(full["energy_density"], json!(["7", "7", "17/2", "9"]));
    assert_eq!(full["micromodulus_factor"], "49/48");
    let half = found("--m 4 --points 9 --ends half --homogenize");
    assert_eq!(half["f"], "32/31");
    assert_eq!(half["f_limit"], "1.032258064516129032258064516129");
    assert_eq!(half["alpha"], json!(["7", "5", "3"]));
    assert_eq!(half["stiffness_corner"][0], json!([-255, 168, 60, 24, 3]));
}

#[test]
fn others_depend_on_the_number_of_points() {
    let short = found("--m 2 --points 5 --ends half");
    assert_eq!(short["f"], "2");
    assert_eq!(short["alpha"], json!(["1"]));
    // 8/(5+√2), not the 5/4 of Table 1
    assert_eq!(short["f_limit"], "1.247230065261532156938543052449");
    let long = found("--m 3 --points 1000 --ends full");
    let (f, decimal) = (
        long["f"].as_str().unwrap(),
        long["f_decimal"].as_f64().unwrap(),
    );
    assert!(
        f.len() > 500 && decimal > 1.002 && decimal < 1.0023,
        "{decimal}"
    );
    // too long a fraction: the number alone
    let longer = found("--m 3 --points 100000 --ends full");
    assert!(longer["f"].is_null());
    assert!((longer["f_decimal"].as_f64().unwrap() - 1.0).abs() < 1e-4);
    assert_eq!(
        found("--m 3 --points 100000 --ends half --homogenize")["f"],
        "18/17"
    );
}

/// Numbers that JSON readers would round are texts: nothing is lost.
#[test]
fn long_horizons_have_numbers_too() {
    let long = found("--m 60 --points 121 --ends full --homogenize");
    let digits = |value: &Value| value.as_str().unwrap().to_string();
    let (scale, entry) = (
        digits(&long["stiffness_scale"]),
        digits(&long["stiffness_corner"][0][1]),
    );
    assert!(
        scale.len() > 16 && scale.chars().all(|c| c.is_ascii_digit()),
        "{scale}"
    );
    // 119/2 of the scale, whole
    assert!(entry.chars().all(|c| c.is_ascii_digit()), "{entry}");
    let ratio = entry.parse::<f64>().unwrap() / scale.parse::<f64>().unwrap();
    assert!((ratio - 59.5).abs() < 1e-12, "{ratio}");
    assert_eq!(long["f"], "1");
}

#[test]
fn the_report_says_the_same() {
    let done = bar("--m 2 --points 5 --ends full --homogenize");
    let said = String::from_utf8_lossy(&done.stdout);
    for line in [
        "bar       m = 2, 5 points, full-weight ends, homogenized",
        "f(5)  1 = 1",
        "alpha     3/2",
        "energy    5/2  7/2  4",
        "in units of cA/4",
        " -7    6    1",
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
}

#[test]
fn bad_input_says_what_to_write() {
    for (arguments, expected) in [
        (
            "--m 0 --points 9 --ends full",
            "at least 1; write for example --m 3",
        ),
        ("--m -2 --points 9 --ends full", "--m -2 is no horizon"),
        (
            "--m 3 --points -7 --ends full",
            "--points -7 is no number of points",
        ),
        ("--m 3 --points 6 --ends half", "write --points 7 or more"),
        ("--m 3 --points 0 --ends half", "write --points 7 or more"),
        ("--m 101 --points 1000 --ends half", "at most 100"),
        ("--m 3 --points 99999999999 --ends half", "at most 10000000"),
        (
            "--m 3 --points 9 --ends quarter",
            "possible values: full, half",
        ),
        ("--m 2.5 --points 9 --ends full", "invalid value '2.5'"),
        ("--m 3 --points many --ends full", "invalid value 'many'"),
        ("--m 3 --points 9", "--ends"),
    ] {
        let done = bar(arguments);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{arguments}: {said}");
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        assert!(flat.join(" ").contains(expected), "{arguments}: {said}");
        assert!(done.stdout.is_empty());
    }
}
