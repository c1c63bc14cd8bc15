//! Several bodies as a user meets them: the gaps that `check` tells, the column of a frame.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

fn peridyne(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    output
}

#[test]
fn check_tells_the_gaps_between_bodies() {
    let path = deck("two_bodies.toml");
    let found = peridyne(&["check", path.to_str().unwrap(), "--json"]);
    let found: Value = serde_json::from_slice(&found.stdout).unwrap();
    let gap = &found["gaps"][0];
    assert_eq!(gap["bodies"][0], "ball");
    assert_eq!(gap["bodies"][1], "plate");
    // the lowest point of the ball is 1 mm above the plate, between four of its points
    let distance = (1e-3f64.powi(2) + 2.0 * 0.25e-3f64.powi(2)).sqrt();
    assert!((gap["distance"].as_f64().unwrap() / distance - 1.0).abs() < 1e-9);
    assert!((gap["contact"].as_f64().unwrap() / 0.675e-3 - 1.0).abs() < 1e-9);
    assert_eq!(found["bodies"][1]["points"], 3200);

    let path = deck("powder.toml");
    let output = peridyne(&["check", path.to_str().unwrap()]);
    let text = String::from_utf8_lossy(&output.stdout);
    for part in [
        "stone: 1 points",
        "plate: 40 points",
        "from powder",
        "which contact sets",
    ] {
        assert!(text.contains(part), "`{part}` is missing:\n{text}");
    }
}

#[test]
fn frames_and_the_report_know_the_bodies() {
    let dir = TempDir::new().unwrap();
    let (path, out) = (deck("powder.toml"), dir.path().to_str().unwrap());
    peridyne(&[
        "run",
        path.to_str().unwrap(),
        "--out",
        out,
        "--set",
        "run.steps=3",
    ]);
    let frame = std::fs::read(dir.path().join("points_00000003.vtu")).unwrap();
    let head = String::from_utf8_lossy(&frame);
    assert!(head.contains("Name=\"body\""), "no column for the body");
    let report = std::fs::read_to_string(dir.path().join("run.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    // every loose point, the stone and the plate
    assert_eq!(report["fragments"], 20 + 1 + 1);
}

/// What `check` finds of a deck in a folder with these files.
fn checked(deck: &str, files: &[(&str, &str)]) -> (Value, String) {
    let dir = TempDir::new().unwrap();
    for (name, text) in files.iter().chain(&[("deck.toml", deck)]) {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    let path = dir.path().join("deck.toml");
    let path = path.to_str().unwrap();
    let json = peridyne(&["check", path, "--json"]);
    let text = peridyne(&["check", path]);
    (
        serde_json::from_slice(&json.stdout).unwrap(),
        String::from_utf8_lossy(&text.stdout).into_owned(),
    )
}

/// Each body says what finds the forces of its bonds, and why.
#[test]
fn check_tells_what_finds_the_forces_of_bonds() {
    let body = |name: &str, low: u32| {
        format!(
            "[[body]]\nname = \"{name}\"\nmaterial = \"{name}\"\nlattice = \"square\"\nspacing = 1\n\
             region = {{ block = {{ low = [{low}, 0], high = [{}, 8] }} }}\n",
            low + 8
        )
    };
    let deck = format!(
        "units = \"none\"\nhorizon = {{ m_ratio = 3 }}\ncontact = false\n{}{}{}\
         [material.a]\ndensity = 1\nlaw = {{ pmb = {{ young = 1 }} }}\n\
         [material.b]\ndensity = 1\nlaw = {{ lps = {{ young = 1, poisson = 0.2 }} }}\n\
         fracture = {{ energy = 0.1, criterion = \"bond_energy\" }}\n\
         [material.c]\ndensity = 1\nlaw = {{ springs = {{ young = 1 }} }}\n[run]\nsteps = 1\n",
        body("a", 0),
        body("b", 20),
        body("c", 40),
    );
    let (found, text) = checked(&deck, &[]);
    let forces = &found["bond_forces"];
    let fused = json!({ "laws": ["pmb"], "fused": true, "reasons": [] });
    assert_eq!(forces[0], fused);
    let general =
        json!({ "laws": ["lps"], "fused": false, "reasons": ["breaks by work of bonds"] });
    assert_eq!(forces[1], general);
    assert_eq!(forces[2], Value::Null);
    for says in [
        "bond forces       a: fused kernels of pmb",
        "bond forces       b: general sweeps of lps (breaks by work of bonds)",
    ] {
        assert!(text.contains(says), "{says}\n{text}");
    }
    assert_eq!(text.matches("bond forces").count(), 2);
}

/// A plate of 20 × 10 quadrilaterals of 1 mm, whose right side has a name.
fn mesh() -> String {
    let mut text = String::from(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 2 \"right\"\n2 1 \"plate\"\n$EndPhysicalNames\n$Nodes\n231\n",
    );
    let node = |i: usize, j: usize| 1 + i + 21 * j;
    for j in 0..11 {
        for i in 0..21 {
            text += &format!("{} {i} {j} 0\n", node(i, j));
        }
    }
    text += "$EndNodes\n$Elements\n210\n";
    for j in 0..10 {
        for i in 0..20 {
            let corners = [
                node(i, j),
                node(i + 1, j),
                node(i + 1, j + 1),
                node(i, j + 1),
            ];
            let [a, b, c, d] = corners;
            text += &format!("{} 3 1 1 {a} {b} {c} {d}\n", 1 + i + 20 * j);
        }
        text += &format!("{} 1 1 2 {} {}\n", 201 + j, node(20, j), node(20, j + 1));
    }
    text + "$EndElements\n"
}

#[test]
fn check_prints_the_force_of_each_load() {
    // 1 MPa on 10 mm × 10 mm of a mesh, on a curve that it names
    let deck = r#"horizon = "3.1 mm"
thickness = "10 mm"
body = { file = "plate.msh", file_unit = "1 mm" }
material = { density = "1000 kg/m^3", law = { pmb = { young = "1 GPa" } } }
sets.left.where = "x < 1 mm"
[[boundary_condition]]
set = "left"
displacement = { x = 0, y = 0 }
[[boundary_condition]]
set = "right"
traction = { x = "1 MPa*t" }
[statics]
method = "linear"
[[probe]]
name = "R"
set = "left"
measure = "reaction"
"#;
    let (json, text) = checked(deck, &[("plate.msh", &mesh())]);
    let load = &json["loads"][0];
    assert!(
        (load["force"][0].as_f64().unwrap() - 100.0).abs() < 1e-9,
        "{load}"
    );
    assert!(
        (load["area"].as_f64().unwrap() - 1e-4).abs() < 1e-15,
        "{load}"
    );
    // the thickness makes volumes of areas, however the file is called
    assert!((json["volume"].as_f64().unwrap() - 2e-6).abs() < 1e-15);
    let (loud, _) = checked(
        &deck.replace("plate.msh", "PLATE.MSH"),
        &[("PLATE.MSH", &mesh())],
    );
    assert_eq!(
        (&loud["volume"], &loud["loads"]),
        (&json["volume"], &json["loads"])
    );
    assert!(
        text.contains("`right`: force up to 100 N along x, area 1e-4 m^2"),
        "{text}"
    );
}

#[test]
fn a_body_is_as_large_as_its_region() {
    let deck = |more: &str, body: &str| {
        format!(
            "horizon = {{ m_ratio = 2 }}\n{more}\nmaterial = {{ density = \"1000 kg/m^3\", law = {{ pmb = {{ young = \"1 GPa\" }} }} }}\n\
             run = {{ steps = 1 }}\n[body]\n{body}\n"
        )
    };
    let block = |d: usize| {
        let (low, high) = (["0", "0", "0"], ["\"20 mm\"", "\"10 mm\"", "\"6 mm\""]);
        format!(
            "region = {{ block = {{ low = [{}], high = [{}] }} }}",
            low[..d].join(", "),
            high[..d].join(", ")
        )
    };
    let volume = |text: &str| {
        let (json, _) = checked(text, &[]);
        assert!(
            !json["warnings"].to_string().contains("its region of"),
            "{}",
            json["warnings"]
        );
        (json["volume"].as_f64().unwrap(), json["extent"].clone())
    };
    let near =
        |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
    for (lattice, d, wanted) in [
        ("chain", 1, 20e-3),
        ("square", 2, 200e-6),
        ("cubic", 3, 1200e-9),
        ("bcc", 3, 1200e-9),
        ("fcc", 3, 1200e-9),
    ] {
        let body = format!("lattice = \"{lattice}\"\nspacing = \"1 mm\"\n{}", block(d));
        let (found, extent) = volume(&deck("", &body));
        near(found, wanted);
        assert_eq!(extent[0][0].as_f64().unwrap().abs(), 0.0);
        near(extent[0][1].as_f64().unwrap(), 20e-3);
    }
    // a period has no ends, and the same length
    let body = format!("lattice = \"square\"\nspacing = \"1 mm\"\n{}", block(2));
    near(volume(&deck("periodic = [\"x\"]", &body)).0, 200e-6);
    // also where the first plane of points lies just below its end
    let late = format!(
        "lattice = \"square\"\nspacing = \"1 mm\"\norigin = [\"0.95 mm\", \"0.5 mm\"]\n{}",
        block(2)
    );
    near(volume(&deck("periodic = [\"x\"]", &late)).0, 200e-6);
    // whole cells from an origin that is given
    let body = "lattice = \"square\"\nspacing = \"1 mm\"\norigin = [\"3 mm\", 0]\ncells = [20, 10]";
    let (json, _) = checked(&deck("", body), &[]);
    near(json["volume"].as_f64().unwrap(), 200e-6);
    near(json["low"][0].as_f64().unwrap(), 3e-3);
    // faces through points: said
    let body = format!(
        "lattice = \"square\"\nspacing = \"1 mm\"\norigin = [0, 0]\n{}",
        block(2)
    );
    let (json, text) = checked(&deck("", &body), &[]);
    near(json["volume"].as_f64().unwrap(), 21.0 * 11e-6);
    assert!(text.contains("15 % more than its region"), "{text}");
}

#[test]
fn a_rigid_body_without_stiffness_has_that_of_the_material() {
    let deck = r#"horizon = { m_ratio = 2 }
material = { density = "1000 kg/m^3", law = { lps = { bulk = "2 GPa", shear = "1 GPa" } } }
run = { steps = 1 }
body = { lattice = "cubic", spacing = "1 mm", cells = [6, 6, 6] }
rigid_body = [{ radius = "3 mm", center = ["3 mm", "3 mm", "8 mm"] }]
"#;
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("deck.toml");
    std::fs::write(&path, deck).unwrap();
    let output = peridyne(&["check", path.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    // ten times 2 GPa over 1 mm³
    assert!(
        said.contains("stiffness of rigid bodies that give none: 2e19"),
        "{said}"
    );
}
