//! Several bodies as a user meets them: the gaps that `check` tells, the column of a frame.

use serde_json::Value;
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
    // the lowest point of the ball is 1.5 mm above the plate, between four of its points
    let distance = (1.5e-3f64.powi(2) + 2.0 * 0.5e-3f64.powi(2)).sqrt();
    assert!((gap["distance"].as_f64().unwrap() / distance - 1.0).abs() < 1e-9);
    assert!((gap["contact"].as_f64().unwrap() / 1.35e-3 - 1.0).abs() < 1e-9);
    assert_eq!(found["bodies"][1]["points"], 400);

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
