//! Decks of Peridigm converted, run, and compared with what Peridigm stored.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn peridyne(dir: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let Output {
        status,
        stdout,
        stderr,
    } = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap();
    let said = [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    (status.code(), said.concat())
}

/// Rows that Peridigm stored of a case; its source stands in the file.
fn stored(case: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../engine/tests/peers/peridigm.txt");
    let text = fs::read_to_string(path).unwrap();
    let head = format!("case {case}");
    let rows = text.lines().skip_while(|l| *l != head).skip(1);
    let rows = rows.take_while(|l| !l.is_empty() && !l.starts_with("case "));
    rows.map(|l| l.split_whitespace().map(|w| w.parse().unwrap()).collect())
        .collect()
}

/// Columns of a history by name: all their rows.
fn history(path: &Path) -> impl Fn(&str) -> Vec<f64> + use<> {
    let text = fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<String>> = { text.lines() }
        .map(|l| l.split(',').map(String::from).collect())
        .collect();
    move |name: &str| {
        let at = rows[0]
            .iter()
            .position(|c| c == name || c.starts_with(&format!("{name} [")));
        let at = at.unwrap_or_else(|| panic!("no {name} in {:?}", rows[0]));
        rows[1..].iter().map(|r| r[at].parse().unwrap()).collect()
    }
}

const STEEL: &str = "  Materials:
    Steel:
      Material Model: \"Elastic\"
      Apply Shear Correction Factor: false
      Density: 7800.0
      Bulk Modulus: 130.0e9
      Shear Modulus: 78.0e9
";

/// Two cells that approach: `Compression_2x1x1`, five steps.
#[test]
fn a_converted_motion_is_that_of_peridigm() {
    let dir = TempDir::new().unwrap();
    let deck = format!(
        "Peridigm:
  Discretization:
    Type: \"PdQuickGrid\"
    TensorProduct3DMeshGenerator:
      Type: \"PdQuickGrid\"
      X Origin: -2.0
      Y Origin: -0.5
      Z Origin: -0.5
      X Length: 4.0
      Y Length: 1.0
      Z Length: 1.0
      Number Points X: 2
      Number Points Y: 1
      Number Points Z: 1
{STEEL}  Blocks:
    All:
      Block Names: \"block_1\"
      Material: \"Steel\"
      Horizon: 2.1
  Boundary Conditions:
    Low: \"1\"
    High: \"2\"
    To the right:
      Type: \"Initial Velocity\"
      Node Set: \"Low\"
      Coordinate: \"x\"
      Value: \"1.0\"
    To the left:
      Type: \"Initial Velocity\"
      Node Set: \"High\"
      Coordinate: \"x\"
      Value: \"-1.0\"
  Solver:
    Initial Time: 0.0
    Final Time: 0.00005
    Verlet:
      Fixed dt: 0.00001
  Compute Class Parameters:
    U:
      Compute Class: \"Nearest_Point_Data\"
      X: -1.0
      Y: 0.0
      Z: 0.0
      Variable: \"Displacement\"
      Output Label: \"U\"
    V:
      Compute Class: \"Nearest_Point_Data\"
      X: -1.0
      Y: 0.0
      Z: 0.0
      Variable: \"Velocity\"
      Output Label: \"V\"
  Output:
    Output Filename: \"two\"
    Output Frequency: 1
    Output Variables:
      Displacement: true
      U: true
      V: true
"
    );
    fs::write(dir.path().join("two.yaml"), deck).unwrap();
    // everything maps
    let convert = ["convert", "two.yaml", "-o", "two.toml", "--strict"];
    let (code, said) = peridyne(dir.path(), &convert);
    assert_eq!(code, Some(0), "{said}");
    let run = [
        "run",
        "two.toml",
        "--out",
        "out",
        "--set",
        "output.history=1",
    ];
    let (code, said) = peridyne(dir.path(), &run);
    assert_eq!(code, Some(0), "{said}");
    let column = history(&dir.path().join("out/history.csv"));
    let (u, v) = (column("U_x"), column("V_x"));
    let rows = stored("Compression_2x1x1");
    assert_eq!(rows.len(), 5);
    for (n, row) in rows.iter().enumerate() {
        // the first row of the history is the start
        assert!(
            (u[n + 1] / row[0] - 1.0).abs() < 1e-9,
            "{} {}",
            u[n + 1],
            row[0]
        );
        assert!(
            (v[n + 1] / row[1] - 1.0).abs() < 1e-9,
            "{} {}",
            v[n + 1],
            row[1]
        );
    }
    assert!(dir.path().join("out/two.e").is_file());
}

/// 3 × 2 × 2 cells between two plates at rest: `Compression_QS_3x2x2`, in XML, with a text file and node sets.
#[test]
fn a_converted_equilibrium_is_that_of_peridigm() {
    let dir = TempDir::new().unwrap();
    let mut points = String::from("# x y z block_id volume\n");
    for x in [-1.0, 0.0, 1.0] {
        for (y, z) in [(-0.5, 0.5), (-0.5, -0.5), (0.5, 0.5), (0.5, -0.5)] {
            points += &format!("{x} {y} {z} 1 1.0\n");
        }
    }
    fs::write(dir.path().join("points.txt"), points).unwrap();
    fs::write(dir.path().join("low.txt"), "1\n2\n3\n4\n").unwrap();
    let entry = |name: &str, value: &str| {
        format!("<Parameter name=\"{name}\" type=\"string\" value=\"{value}\"/>\n")
    };
    let list = |name: &str, inside: String| {
        format!("<ParameterList name=\"{name}\">\n{inside}</ParameterList>\n")
    };
    let hold = |set: &str, axis: &str, value: &str| {
        let kind = entry("Type", "Prescribed Displacement");
        let rest = entry("Node Set", set) + &entry("Coordinate", axis) + &entry("Value", value);
        list(&format!("{set} {axis}"), kind + &rest)
    };
    let conditions = entry("Low", "low.txt")
        + &entry("High", "9 10 11 12")
        + &entry("Y", "2 4")
        + &entry("Z", "1 2")
        + &hold("Low", "x", "0.0")
        + &hold("High", "x", "-0.1*t/0.00005")
        + &hold("Y", "z", "0.0")
        + &hold("Z", "y", "0.0");
    let steel = entry("Material Model", "Elastic")
        + &entry("Density", "7800.0")
        + &entry("Bulk Modulus", "130.0e9")
        + &entry("Shear Modulus", "78.0e9");
    let block =
        entry("Block Names", "block_1") + &entry("Material", "Steel") + &entry("Horizon", "1.75");
    let nearest = |label: &str, x: &str| {
        let place = entry("X", x) + &entry("Y", "0.5") + &entry("Z", "0.5");
        let what =
            entry("Compute Class", "Nearest_Point_Data") + &entry("Variable", "Displacement");
        list(label, place + &what + &entry("Output Label", label))
    };
    let statics = list(
        "QuasiStatic",
        entry("Number of Load Steps", "4") + &entry("Absolute Tolerance", "1.0e-2"),
    );
    let deck = format!(
        "<ParameterList>\n{}{}{}{}{}{}</ParameterList>\n",
        list(
            "Discretization",
            entry("Type", "Text File") + &entry("Input Mesh File", "points.txt")
        ),
        list("Materials", list("Steel", steel)),
        list("Blocks", list("All", block)),
        list("Boundary Conditions", conditions),
        list("Solver", entry("Final Time", "0.00005") + &statics),
        list(
            "Compute Class Parameters",
            nearest("low", "-1.0") + &nearest("middle", "0.0") + &nearest("high", "1.0")
        ),
    );
    fs::write(dir.path().join("qs.xml"), &deck).unwrap();
    let (code, said) = peridyne(dir.path(), &["convert", "qs.xml", "-o", "qs.toml"]);
    assert_eq!(code, Some(0), "{said}");
    let line = deck
        .lines()
        .position(|l| l.contains("Absolute Tolerance"))
        .unwrap()
        + 1;
    let told = format!("qs.xml:{line}: not mapped: Solver / QuasiStatic / Absolute Tolerance");
    assert!(said.contains(&told), "{said}");
    let run = [
        "run",
        "qs.toml",
        "--out",
        "out",
        "--set",
        "output.history=1",
    ];
    let (code, said) = peridyne(dir.path(), &run);
    assert_eq!(code, Some(0), "{said}");
    let column = history(&dir.path().join("out/history.csv"));
    let rows = stored("Compression_QS_3x2x2");
    for ((place, row), x) in ["low", "middle", "high"]
        .into_iter()
        .zip(&rows)
        .zip([0.0, 1.0, 2.0])
    {
        let at = |axis: &str| *column(&format!("{place}_{axis}")).last().unwrap();
        assert!((at("x") + 0.05 * x).abs() < 1e-9, "{place}: {}", at("x"));
        // Peridigm stops at a residual: its own digits agree to 1e-12
        assert!(
            (at("y") - row[0]).abs() < 1e-9,
            "{place}: {} {}",
            at("y"),
            row[0]
        );
    }
}

#[test]
fn strict_writes_nothing_where_something_is_left() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("a.txt"), "0 0 0 1 1\n1 0 0 1 1\n").unwrap();
    let deck = format!(
        "Peridigm:
  Discretization:
    Type: Text File
    Input Mesh File: a.txt
{STEEL}  Blocks:
    All:
      Block Names: block_1
      Material: Steel
      Horizon: 1.1
  Contact:
    Search Radius: 2.0
  Solver:
    Final Time: 1.0e-5
    Verlet:
      Safety Factor: 0.7
"
    );
    fs::write(dir.path().join("a.yaml"), &deck).unwrap();
    let line = deck
        .lines()
        .position(|l| l.contains("Search Radius"))
        .unwrap()
        + 1;
    let told = format!("a.yaml:{line}: not mapped: Contact / Search Radius = 2.0");
    let (code, said) = peridyne(
        dir.path(),
        &["convert", "a.yaml", "-o", "a.toml", "--strict"],
    );
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains(&told), "{said}");
    assert!(!dir.path().join("a.toml").exists() && !dir.path().join("a.g").exists());
    let (code, said) = peridyne(dir.path(), &["convert", "a.yaml", "-o", "a.toml"]);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = peridyne(dir.path(), &["check", "a.toml"]);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = peridyne(dir.path(), &["convert", "a.yaml", "-o", "a.yml"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("a deck is called .toml"), "{said}");
}
