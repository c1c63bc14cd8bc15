//! Loads, supports and rows without symmetry, as a user of `peridyne coarsen` meets them.

use std::path::Path;
use std::process::{Command, Output};

/// A plate held at its left layers, with forces on its right ones and all over it.
fn plate(law: &str, schedule: &str) -> String {
    format!(
        r#"
dimension = 2
thickness = 1.0
horizon = {{ m_ratio = 2 }}
units = "none"
[body]
lattice = "square"
spacing = 1.0
cells = [19, 10]
[sets.left]
region = {{ block = {{ low = [0, 0], high = [1.5, 9] }} }}
[sets.right]
region = {{ block = {{ low = [16.5, 0], high = [18, 9] }} }}
[material]
density = 1.0
law = {law}
[[boundary_condition]]
set = "left"
displacement = {{ x = 0, y = 0 }}
[[boundary_condition]]
set = "right"
body_force = {{ x = "1e-3 * (1 + y)", y = "2e-4 * x" }}
[[boundary_condition]]
set = "right"
traction = {{ y = -1e-3 }}
[[boundary_condition]]
set = "all"
body_force = {{ y = "-1e-5 * (1 + 0.1 * x)" }}
{schedule}
"#
    )
}

const LPS: &str = "{ lps = { young = 1.0, poisson = 0.35 } }";
const PMB: &str = "{ pmb = { young = 1.0 } }";

fn peridyne(verb: &str, deck: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg(verb)
        .arg(deck)
        .args(arguments)
        .output()
        .unwrap()
}

struct Case {
    dir: tempfile::TempDir,
}

impl Case {
    fn new(text: &str) -> Case {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("plate.toml"), text).unwrap();
        Case { dir }
    }

    fn coarsen(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let out = self.dir.path().join("out");
        let out = out.to_str().unwrap().to_string();
        let all = [&["--out", out.as_str()], arguments].concat();
        let done = peridyne("coarsen", &self.dir.path().join("plate.toml"), &all);
        let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
        let said = text(&done.stdout) + &text(&done.stderr);
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        (done.status.code(), flat.join(" "))
    }

    fn report(&self, level: &str) -> serde_json::Value {
        let path = self.dir.path().join("out").join(level);
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }
}

/// Displacement errors of the levels, as fractions.
fn errors(told: &str) -> Vec<f64> {
    let each = told.split("displacement error ").skip(1);
    each.map(|rest| rest.split(' ').next().unwrap().parse::<f64>().unwrap() / 100.0)
        .collect()
}

#[test]
fn the_exact_scheme_is_exact_under_loads_and_supports() {
    for law in [LPS, PMB] {
        let case = Case::new(&plate(law, "[statics]"));
        let flags = [
            "--every", "2", "--levels", "2", "--scheme", "schur", "--run",
        ];
        let (code, told) = case.coarsen(&flags);
        assert_eq!(code, Some(0), "{told}");
        let found = errors(&told);
        assert!(
            found.len() == 2 && found.iter().all(|e| *e < 1e-9),
            "{told}"
        );
        assert!(told.contains("loads condensed with the body"), "{told}");
        let report = case.report("level1.json");
        assert_eq!(report["loads"], "condensed");
        assert!(report["loads_lost"].as_f64().unwrap() < 1e-12, "{report}");
        // of 2 × 10 held points 5 are every second one
        assert_eq!(report["points"], 10 * 5 + 15, "{report}");
        assert_eq!(report["support_points"], 15);
    }
}

#[test]
fn balls_come_near_and_the_conventions_differ() {
    let case = Case::new(&plate(LPS, "[statics]"));
    let (code, told) = case.coarsen(&["--every", "2", "--run"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(errors(&told)[0] < 0.02, "{told}");
    // in the paper nothing acts on removed points: a quarter of the points, a quarter of the forces, and no face to pull at
    let silling = [
        "--every", "2", "--scheme", "schur", "--loads", "silling", "--run",
    ];
    let (code, told) = case.coarsen(&silling);
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("write body_force in its place"), "{told}");
    let pulled = "traction = { y = -1e-3 }";
    let text = plate(LPS, "[statics]");
    assert!(text.contains(pulled));
    let case = Case::new(&text.replace(pulled, "body_force = { y = -5e-4 }"));
    let (code, told) = case.coarsen(&silling);
    assert_eq!(code, Some(0), "{told}");
    assert!(errors(&told)[0] > 0.3, "{told}");
    assert!(told.contains("loads as in the paper"), "{told}");
    assert_eq!(case.report("level1.json")["loads"], "silling");
    let (code, told) = case.coarsen(&["--every", "2", "--supports", "thinned", "--run"]);
    assert_eq!(code, Some(0), "{told}");
    assert_eq!(case.report("level1.json")["points"], 50);
    let (code, told) = case.coarsen(&["--every", "2", "--loads", "both"]);
    assert_eq!(code, Some(2));
    assert!(
        told.contains("--loads both: expected condensed or silling"),
        "{told}"
    );
}

#[test]
fn published_rows_of_bonds_run_as_they_are() {
    let case = Case::new(&plate(PMB, "[statics]"));
    let rows = ["--every", "2", "--scheme", "rows", "--radius", "5"];
    let (code, told) = case.coarsen(&[&rows[..], &["--run"]].concat());
    assert_eq!(code, Some(0), "{told}");
    assert!(
        told.contains("no unstable mode of the operator as it is"),
        "{told}"
    );
    let report = case.report("level1.json");
    assert_eq!(report["symmetric"], false);
    assert_eq!(report["stability"], "stable");
    assert!(report["rotation"].as_f64().unwrap() < 1e-12, "{report}");
    assert!(errors(&told)[0] < 0.5, "{told}");
    // the archive says it
    let level = case.dir.path().join("out/level1.toml");
    let checked = peridyne("check", &level, &[]);
    let told = String::from_utf8_lossy(&checked.stdout).into_owned();
    assert!(told.contains("action is not reaction"), "{told}");
    // made symmetric, rotations meet forces
    let (code, told) = case.coarsen(&[&rows[..], &["--symmetrise", "yes"]].concat());
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("rigid rotation"), "{told}");
}

#[test]
fn solvers_that_need_symmetry_refuse_rows_without() {
    let rows = ["--every", "2", "--scheme", "rows", "--radius", "5"];
    for (schedule, expected) in [
        (
            "[statics]\nsolver = \"cg\"",
            "conjugate gradients need a symmetric body",
        ),
        (
            "[statics]\nmethod = \"relaxation\"",
            "this method seeks the least energy",
        ),
    ] {
        let case = Case::new(&plate(PMB, schedule));
        let (code, told) = case.coarsen(&rows);
        assert_eq!(code, Some(0), "{told}");
        let done = peridyne("run", &case.dir.path().join("out/level1.toml"), &[]);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        assert_eq!(done.status.code(), Some(2), "{said}");
        assert!(flat.join(" ").contains(expected), "{said}");
    }
}

#[test]
fn rows_without_symmetry_run_in_time() {
    let case = Case::new(&plate(PMB, "[run]\nduration = 20.0"));
    let rows = ["--every", "2", "--scheme", "rows", "--radius", "8", "--run"];
    let (code, told) = case.coarsen(&rows);
    assert_eq!(code, Some(0), "{told}");
    assert!(errors(&told)[0] < 1.0, "{told}");
}

#[test]
fn loads_that_were_not_condensed_are_refused() {
    let case = Case::new(&plate(PMB, "[statics]").replace(
        "[[boundary_condition]]\nset = \"all\"\nbody_force = { y = \"-1e-5 * (1 + 0.1 * x)\" }\n",
        "",
    ));
    let (code, told) = case.coarsen(&["--every", "2"]);
    assert_eq!(code, Some(0), "{told}");
    let level = case.dir.path().join("out/level1.toml");
    let text = std::fs::read_to_string(&level).unwrap();
    let more = "\n[[boundary_condition]]\nset = \"all\"\nbody_force = { x = 1e-3 }\n";
    std::fs::write(&level, text + more).unwrap();
    let done = peridyne("check", &level, &[]);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(2), "{said}");
    let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
    assert!(
        flat.join(" ")
            .contains("the body was condensed for other loads"),
        "{said}"
    );
}
