//! What `peridyne check` says of thin bodies and of equilibrium.

use std::process::Command;

fn check(text: &str, arguments: &[&str]) -> String {
    let dir = tempfile::tempdir().unwrap();
    let deck = dir.path().join("deck.toml");
    std::fs::write(&deck, text).unwrap();
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("check")
        .arg(&deck)
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{said}");
    String::from_utf8_lossy(&done.stdout).into_owned()
}

/// A plate of some layers.
fn plate(layers: usize, schedule: &str) -> String {
    format!(
        r#"
horizon = {{ m_ratio = 3 }}
[body]
lattice = "cubic"
spacing = "1 mm"
cells = [29, 13, {layers}]
[sets.left]
region = {{ block = {{ low = [0, 0, 0], high = ["0.5 mm", "12 mm", "9 mm"] }} }}
[material]
density = "2700 kg/m^3"
law = {{ lps = {{ young = "70 GPa", poisson = 0.35 }} }}
[[boundary_condition]]
set = "left"
displacement = {{ x = 0, y = 0, z = 0 }}
{schedule}
"#
    )
}

#[test]
fn a_thin_plate_has_moduli_along_its_axes() {
    let json = check(&plate(2, "[statics]"), &["--json"]);
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    let whole = &report["materials"][0]["whole"];
    // pulled in statics this plate is 57.7 % stiffer than asked for (crates/theory/tests/thin.rs)
    let young = whole["young"][0].as_f64().unwrap();
    assert!((young / 110.36e9 - 1.0).abs() < 0.05, "{whole}");
    for class in report["materials"][0]["places"].as_array().unwrap() {
        assert!(
            class["young"].is_null(),
            "no mean of what is not isotropic: {class}"
        );
        assert!(
            class["along_axes"]["young"][0].as_f64().unwrap() > 70e9,
            "{class}"
        );
    }
    let told = check(&plate(2, "[statics]"), &[]);
    assert!(told.contains("along the axes, sides free"), "{told}");
    assert!(!told.contains("softer than asked for"), "{told}");
    assert!(
        told.contains(
            "it is thinner than two horizons, no point is in the bulk, and its Young's modulus is off the target along x +5"
        ),
        "{told}"
    );
}

#[test]
fn a_thick_body_keeps_its_mean() {
    let json = check(&plate(9, "[statics]"), &["--json"]);
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    let bulk = &report["materials"][0]["places"][0];
    assert_eq!(bulk["place"], "bulk");
    // cubic: alike along its axes, where it is softer than in the mean of all directions, which is what was asked for
    let mean = bulk["young"].as_f64().unwrap();
    assert!((mean / 70e9 - 1.0).abs() < 0.05, "{bulk}");
    for a in 0..3 {
        let along = bulk["along_axes"]["young"][a].as_f64().unwrap();
        assert!(along < mean && along > 0.85 * mean, "{bulk}");
    }
}

#[test]
fn equilibrium_has_no_step() {
    for method in ["linear", "relaxation"] {
        let schedule = format!("[statics]\nmethod = \"{method}\"");
        let told = check(&plate(3, &schedule), &[]);
        assert!(!told.contains("stability limit"), "{told}");
        assert!(told.contains("1 increment of load,"), "{told}");
        let json = check(&plate(3, &schedule), &["--json"]);
        let report: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert!(report["time_step"].is_null(), "{report}");
    }
}
