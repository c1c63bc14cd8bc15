//! Exodus files as a user meets them: a mesh with blocks and sets, results of a run, and a body made of these.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn good(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    path.join(name).to_str().unwrap().into()
}

/// Exit code, what is printed, and what is said beside it.
fn peridyne(arguments: &[&str]) -> (Option<i32>, Vec<u8>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code(), output.stdout, said)
}

/// Runs the plate for four steps; its results.
fn plate(dir: &TempDir) -> PathBuf {
    let out = dir.path().join("out");
    let (code, _, said) = peridyne(&[
        "run",
        &good("exodus_plate.toml"),
        "--out",
        out.to_str().unwrap(),
        "--set",
        "run.steps=4",
        "--set",
        "output.every=2",
    ]);
    assert_eq!(code, Some(0), "{said}");
    out
}

#[test]
fn blocks_are_materials_and_results_are_a_body_again() {
    let dir = TempDir::new().unwrap();
    let out = plate(&dir);
    // the count of records stands after the mark
    let bytes = fs::read(out.join("plate.e")).unwrap();
    assert_eq!(bytes[..8], [b'C', b'D', b'F', 2, 0, 0, 0, 3]);
    let report: Value = serde_json::from_slice(&fs::read(out.join("run.json")).unwrap()).unwrap();
    let files = report["setting"]["files"].as_array().unwrap();
    assert!(files.iter().any(|f| f == "plate.e"), "{files:?}");
    let deck = dir.path().join("again.toml");
    let text = "horizon = \"16 mm\"\nbody = { file = \"out/plate.e\" }\n\
        [material.glass]\ndensity = 2440\nlaw = { pmb = { young = \"72 GPa\" } }\n\
        [material.steel]\ndensity = 7850\nlaw = { pmb = { young = \"200 GPa\" } }\n\
        [[condition]]\nset = \"left\"\ndisplacement = { x = 0 }\n[run]\nsteps = 1\n";
    fs::write(&deck, text).unwrap();
    let (code, found, said) = peridyne(&["check", deck.to_str().unwrap(), "--json"]);
    assert_eq!(code, Some(0), "{said}");
    let found: Value = serde_json::from_slice(&found).unwrap();
    assert_eq!(found["particles"], 192);
    // 192 cells of 5 mm, half of each material
    let mass = 96.0 * 1.25e-7 * (2440.0 + 7850.0);
    assert!((found["mass"].as_f64().unwrap() / mass - 1.0).abs() < 1e-12);
}

#[test]
fn files_stay_in_the_folder_and_a_mesh_is_no_deck() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    let set = "output.exodus=\"../plate.e\"";
    let run = ["run", &good("exodus_plate.toml"), "--set", set, "--out"];
    let (code, _, said) = peridyne(&[&run[..], &[out.to_str().unwrap()]].concat());
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("leads out of the folder"), "{said}");
    assert!(!dir.path().join("plate.e").exists());
    let (code, _, said) = peridyne(&["run", &good("exodus_plate.g")]);
    assert_eq!(code, Some(2), "{said}");
    let words = said.split_whitespace().filter(|w| *w != "│");
    let said = words.collect::<Vec<_>>().join(" ");
    assert!(said.contains("this is an Exodus mesh"), "{said}");
}
