//! `peridyne coarsen --increments` as a user runs it.

use std::path::{Path, PathBuf};
use std::process::Command;

struct Case {
    dir: tempfile::TempDir,
}

fn good(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    std::fs::read_to_string(path.join(name)).unwrap()
}

impl Case {
    fn new(text: &str) -> Case {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("deck.toml"), text).unwrap();
        Case { dir }
    }

    /// Exit code, and all that was printed.
    fn peridyne(&self, verb: &str, out: &str, arguments: &[&str]) -> (Option<i32>, String) {
        let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .arg(verb)
            .arg(self.dir.path().join("deck.toml"))
            .arg("--out")
            .arg(self.out(out))
            .args(arguments)
            .output()
            .unwrap();
        let text = |b: &[u8]| String::from_utf8_lossy(b).into_owned();
        let said = text(&done.stdout) + &text(&done.stderr);
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        (done.status.code(), flat.join(" "))
    }

    fn out(&self, name: &str) -> PathBuf {
        self.dir.path().join(name)
    }

    fn coarsen(&self, out: &str, arguments: &[&str]) -> String {
        let (code, told) = self.peridyne("coarsen", out, arguments);
        assert_eq!(code, Some(0), "{told}");
        told
    }

    #[track_caller]
    fn refused(&self, arguments: &[&str], why: &str) {
        let (code, told) = self.peridyne("coarsen", "refused", arguments);
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains(why), "{told}");
        assert!(!self.out("refused").exists());
    }

    fn compared(&self, out: &str) -> serde_json::Value {
        let text = std::fs::read_to_string(self.out(out).join("compared.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    }

    /// A column of a table.
    fn column(&self, table: &str, name: &str) -> Vec<f64> {
        let text = std::fs::read_to_string(self.dir.path().join(table)).unwrap();
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        let place = header.split(',').position(|c| c.starts_with(name));
        let place = place.unwrap_or_else(|| panic!("{name}: {header}"));
        lines
            .map(|l| l.split(',').nth(place).unwrap().parse().unwrap())
            .collect()
    }
}

/// Displacements of retained points and of all, reactions.
fn errors(of: &serde_json::Value) -> [f64; 3] {
    [
        "displacement_of_retained_points",
        "displacement_of_all_points",
        "reaction",
    ]
    .map(|key| of[key].as_f64().unwrap())
}

#[test]
fn a_sheet_of_rubber_is_followed_to_a_fifth() {
    let case = Case::new(&good("holed_rubber.toml"));
    let told = case.coarsen("ten", &["--every", "2", "--increments", "10", "--run"]);
    let compared = case.compared("ten");
    let (followed, linear) = (errors(&compared["increments"]), errors(&compared["linear"]));
    // within 1 % of Newton's method on all points; the plain linear answer is not
    assert!(followed.iter().all(|e| *e < 0.01), "{told}");
    assert!(linear[2] > 0.05 && linear[1] > 0.01, "{told}");
    // what is written: all points after every increment, levels about the end
    let files = |ending: &str| {
        let all = std::fs::read_dir(case.out("ten")).unwrap();
        let names = all.map(|f| f.unwrap().file_name().into_string().unwrap());
        names.filter(|n| n.ends_with(ending)).count()
    };
    assert_eq!([files(".vtu"), files(".pvd"), files(".npz")], [11, 1, 1]);
    let t = case.column("ten/increments.csv", "t");
    assert!(t.len() == 10 && (t[9] - 1.0).abs() < 1e-12, "{t:?}");
    // energy is what loads and supports did
    let work: f64 = case.column("ten/increments.csv", "work").iter().sum();
    let energy = case.column("ten/increments.csv", "strain energy")[9];
    assert!((work / energy - 1.0).abs() < 0.01, "{work} {energy}");
}

#[test]
fn with_corrections_and_relaxed_points_the_answer_is_newtons() {
    let case = Case::new(&good("holed_rubber.toml"));
    let flags = [
        "--every",
        "2",
        "--increments",
        "4",
        "--corrections",
        "40",
        "--removed",
        "relaxed",
        "--run",
    ];
    let told = case.coarsen("relaxed", &flags);
    let found = errors(&case.compared("relaxed")["increments"]);
    // both are solved to 1e-10 of the forces
    assert!(found.iter().all(|e| *e < 1e-7), "{told}");
    // and the probe is that of a run
    let (code, said) = case.peridyne("run", "run", &[]);
    assert_eq!(code, Some(0), "{said}");
    for name in ["above_x", "above_y"] {
        let [coarse, whole] =
            ["relaxed/increments.csv", "run/history.csv"].map(|t| case.column(t, name));
        let (coarse, whole) = (coarse.last().unwrap(), whole.last().unwrap());
        assert!((coarse - whole).abs() < 1e-9, "{name}: {coarse} {whole}");
    }
    let pull = case.column("run/history.csv", "pull_x");
    let held = case.column("relaxed/increments.csv", "reaction_right_x");
    assert!((held.last().unwrap() / pull.last().unwrap() - 1.0).abs() < 1e-7);
}

/// A plate that is linear, with loads on removed points.
fn linear_plate(law: &str) -> String {
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
displacement = {{ x = "1e-3 * t", y = 0 }}
[[boundary_condition]]
set = "right"
body_force = {{ x = "1e-3 * t * (1 + y)", y = "2e-4 * t * x" }}
[[boundary_condition]]
set = "right"
traction = {{ y = "-1e-3 * t" }}
[statics]
[[probe]]
name = "p"
measure = "value"
of = "displacement"
at = [12, 4]
[output]
history = 1
"#
    )
}

#[test]
fn a_linear_plate_has_the_answer_of_its_level_whatever_the_increments() {
    let case = Case::new(&linear_plate("{ lps = { young = 1.0, poisson = 0.35 } }"));
    for scheme in ["energy", "schur"] {
        let flags = ["--every", "2", "--scheme", scheme];
        case.coarsen("levels", &flags);
        let level = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .args(["run", "level1.toml", "--out", "run"])
            .current_dir(case.out("levels"))
            .output()
            .unwrap();
        assert!(level.status.success());
        for increments in ["1", "3"] {
            let more = ["--increments", increments, "--run"];
            let told = case.coarsen("increments", &[&flags[..], &more].concat());
            for name in ["p_x", "p_y"] {
                let expected = case.column("levels/run/history.csv", name);
                let found = case.column("increments/increments.csv", name);
                let (expected, found) = (expected.last().unwrap(), found.last().unwrap());
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-9, "{scheme} {increments} {name}: {off}");
            }
            // and so of all points, held ends and all
            let compared = case.compared("increments");
            let (a, b) = (errors(&compared["increments"]), errors(&compared["linear"]));
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() < 1e-9, "{told}");
            }
        }
    }
}

/// A notched plate whose bonds break.
fn notched() -> String {
    r#"
dimension = 2
thickness = 1.0
horizon = { m_ratio = 2 }
units = "none"
contact = false
[body]
lattice = "square"
spacing = 1.0
cells = [13, 13]
[sets.left]
region = { block = { low = [0, 0], high = [1.5, 12] } }
[sets.right]
region = { block = { low = [10.5, 0], high = [12, 12] } }
[material]
density = 1.0
law = { pmb = { young = 1.0 } }
fracture = { critical_stretch = 0.02 }
[[precrack]]
segment = { from = [6.5, -1.0], to = [6.5, 3.5] }
kind = "broken"
[[boundary_condition]]
set = "left"
displacement = { x = 0, y = 0 }
[[boundary_condition]]
set = "right"
displacement = { x = "0.14 * t", y = 0 }
[statics]
method = "newton"
increments = 4
[[probe]]
name = "pull"
set = "right"
measure = "reaction"
[output]
history = 1
"#
    .to_string()
}

#[test]
fn bonds_that_break_are_told_and_break_as_in_newtons_run() {
    let case = Case::new(&notched());
    let flags = [
        "--every",
        "2",
        "--increments",
        "4",
        "--corrections",
        "40",
        "--removed",
        "relaxed",
    ];
    let told = case.coarsen("increments", &flags);
    let (code, said) = case.peridyne("run", "run", &[]);
    assert_eq!(code, Some(0), "{said}");
    let whole = case.column("run/history.csv", "broken_bonds");
    let each = case.column("increments/increments.csv", "broken bonds");
    let sum: f64 = each.iter().sum();
    let run = whole.last().unwrap() - whole[0];
    assert!(run > 0.0 && sum == run, "{sum} {run}: {told}");
    assert!(told.contains("bonds broke"), "{told}");
    let pull = case.column("run/history.csv", "pull_x");
    let held = case.column("increments/increments.csv", "reaction_right_x");
    let off = held.last().unwrap() / pull.last().unwrap() - 1.0;
    assert!(off.abs() < 1e-6, "{off}");
}

#[test]
fn what_has_no_increments_is_refused() {
    let rubber = good("holed_rubber.toml");
    let case = Case::new(&rubber);
    let ten = ["--every", "2", "--increments", "10"];
    let with = |more: &[&'static str]| [&ten[..], more].concat();
    case.refused(&["--every", "2", "--increments", "0"], "such as 10");
    case.refused(
        &with(&["--scheme", "rows"]),
        "take --scheme energy or schur",
    );
    case.refused(&with(&["--removed", "gone"]), "expected carried or relaxed");
    case.refused(&["--every", "2", "--corrections", "3"], "--increments");
    case.refused(&["--increments", "3"], "say which points to retain");
    // balls shorter than bonds
    case.refused(&with(&["--radius", "0.5 mm"]), "radius");
    case.refused(&with(&["--radius", "1e-3"]), "below the longest bond");
    let moves = rubber.replace(
        "[statics]\nmethod = \"newton\"\nincrements = 4",
        "[run]\nsteps = 3",
    );
    let moves = moves.replace("6.4 mm * t", "6.4 mm");
    Case::new(&moves).refused(&ten, "this deck moves in time");
    let touch = rubber.replace(
        "[statics]\nmethod = \"newton\"",
        "[statics]\nmethod = \"relaxation\"",
    );
    let touch = touch.replace("[material]", "[contact]\n[material]");
    Case::new(&touch).refused(&ten, "contact has no tangent");
    let path = notched().replace("method = \"newton\"", "control = \"sequentially_linear\"");
    Case::new(&path).refused(&ten, "leave control out");
    let free = rubber.replace(
        "displacement = { x = 0, y = 0 }",
        "displacement = { x = 0 }",
    );
    let free = free.replace("x = \"6.4 mm * t\", y = 0", "x = \"6.4 mm * t\"");
    Case::new(&free).refused(&ten, "not held");
}
