//! `check` of atoms, and the time step that atoms get if nobody gives one.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

fn peridyne(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

fn check(deck: &Path, more: &[&str]) -> Value {
    let mut arguments = vec!["check", deck.to_str().unwrap(), "--json"];
    arguments.extend(more);
    serde_json::from_str(&peridyne(&arguments)).unwrap()
}

/// GPa in eV/Å³.
const GPA: f64 = 1.0 / 160.217_663_4;

#[test]
fn moduli_of_copper_are_those_of_its_crystal() {
    let found = check(
        &good("copper_bar.toml"),
        &["--set", "body.cells=[16, 8, 8]"],
    );
    let bulk = &found["materials"][0]["places"][0];
    assert_eq!(bulk["place"], "bulk");
    let c = |i: usize, j: usize| bulk["stiffness"][i][j].as_f64().unwrap() / GPA;
    // ASE 3.26, EAM of the same file at the same spacing: second differences of energies of strained cells (GPa)
    for (name, found, expected) in [
        ("C11", c(0, 0), 167.838),
        ("C12", c(0, 1), 122.853),
        ("C44", c(3, 3), 76.637),
    ] {
        assert!(
            (found / expected - 1.0).abs() < 1e-3,
            "{name} {found}, {expected}"
        );
    }
    let warnings = found["warnings"].to_string();
    for word in ["m_ratio", "horizon", "calibration", "pre-crack"] {
        assert!(!warnings.contains(word), "{warnings}");
    }
}

#[test]
fn check_of_a_liquid_takes_no_minutes() {
    let begin = Instant::now();
    let found = check(&good("liquid_from_dump.toml"), &[]);
    assert!(
        begin.elapsed() < Duration::from_secs(30),
        "{:?}",
        begin.elapsed()
    );
    let bulk = &found["materials"][0]["places"][0];
    // the affine modulus of a Lennard-Jones liquid near its triple point, in ε/σ³; 108 atoms are not isotropic
    let c = |i: usize, j: usize| bulk["stiffness"][i][j].as_f64().unwrap();
    let k = (0..9).map(|n| c(n / 3, n % 3)).sum::<f64>() / 9.0;
    assert!((10.0..100.0).contains(&k), "{k}");
}

/// Energies of a run of a deck without `time_step`: (step, kinetic, residual).
fn default_step(text: &str, more: &str) -> [f64; 3] {
    let dir = TempDir::new().unwrap();
    for file in ["copper.eam.alloy", "liquid.lammpstrj"] {
        std::fs::copy(good(file), dir.path().join(file)).unwrap();
    }
    let file = dir.path().join("deck.toml");
    std::fs::write(&file, text).unwrap();
    let out = dir.path().join("out");
    peridyne(&[
        "run",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--set",
        more,
    ]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap();
    let energy = |key: &str| report["energy"][key].as_f64().unwrap();
    [
        report["time_step"].as_f64().unwrap(),
        energy("kinetic"),
        energy("residual"),
    ]
}

#[test]
fn the_default_step_of_atoms_runs() {
    let text = |name: &str| {
        let text = std::fs::read_to_string(good(name)).unwrap();
        let without = text.replace(", time_step = 0.005", "");
        assert_ne!(text, without, "{name}");
        without
    };
    let hot = text("copper_bar.toml")
        .replace("cells = [120, 12, 12]", "cells = [8, 5, 5]")
        .replace(
            "initial = [{ displacement = [\"0.8*exp(-((x-216.9)/60)^2)\", 0, 0] }]",
            "thermal = { temperature = \"600 K\", seed = 7 }",
        )
        .replace("duration = 2", "steps = 400");
    for (name, text, more) in [
        (
            "a crystal that melts",
            text("lennard_jones_liquid.toml"),
            "run.steps=1500",
        ),
        ("a liquid", text("liquid_from_dump.toml"), "run.steps=400"),
        ("hot copper", hot, "run.steps=400"),
    ] {
        let [step, kinetic, residual] = default_step(&text, more);
        assert!(
            residual.abs() < 0.01 * kinetic,
            "{name}: {residual} of {kinetic} with {step}"
        );
    }
}
