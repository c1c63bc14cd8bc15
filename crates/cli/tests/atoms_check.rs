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

/// Under pressure the energy of its bonds changes under rotations: the constants of the linear body are by long waves, and those of stress against strain.
#[test]
fn the_linear_body_of_a_crystal_has_the_moduli_of_the_crystal() {
    let dir = TempDir::new().unwrap();
    let deck = |name: &str, text: &str| {
        let file = dir.path().join(name);
        std::fs::write(&file, text).unwrap();
        file
    };
    let crystal = deck(
        "crystal.toml",
        "units = \"lj\"\nperiodic = [\"x\", \"y\", \"z\"]\nbody = { lattice = \"fcc\", spacing = 1.5, cells = [3, 3, 3] }\nmaterial = { mass = 1, law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 1.6 } } }\nrun = { steps = 1, time_step = 1e-6 }\noutput = { vtu = false, linear_body = true }\n",
    );
    let linear = deck(
        "linear.toml",
        "units = \"lj\"\nperiodic = { x = 4.5, y = 4.5, z = 4.5 }\nbody = { file = \"out/linear_body.npz\" }\nmaterial = { law = \"micromoduli\" }\nrun = { steps = 0 }\n",
    );
    let out = dir.path().join("out");
    peridyne(&[
        "run",
        crystal.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]);
    let found = [&crystal, &linear].map(|file| check(file, &[]));
    let places = found.each_ref().map(|f| &f["materials"][0]["places"]);
    assert_eq!(places.map(|p| p.as_array().unwrap().len()), [1, 1]);
    let classes = places.map(|p| &p[0]);
    assert_eq!(
        classes.map(|c| c["long_waves"].as_bool().unwrap()),
        [false, true]
    );
    let [c, linear_c] =
        classes.map(|class| move |i: usize, j: usize| class["stiffness"][i][j].as_f64().unwrap());
    // under pressure C12 is not C44, although atoms act in pairs
    assert!(c(0, 1) > 1.2 * c(3, 3), "{} {}", c(0, 1), c(3, 3));
    for v in 0..6 {
        for w in 0..6 {
            let off = (linear_c(v, w) - c(v, w)).abs() / c(0, 0);
            assert!(off < 1e-6, "{v} {w}: {} {}", linear_c(v, w), c(v, w));
        }
    }
    let told = peridyne(&["check", linear.to_str().unwrap()]);
    assert!(told.contains("Effective moduli by long waves"), "{told}");
}

/// A gas has its energy from a stress: its bulk modulus is γ p, and it resists no shear.
#[test]
fn a_gas_has_the_bulk_modulus_of_its_pressure() {
    let found = check(&good("shock_tube.toml"), &[]);
    let bulk = &found["materials"][0]["places"][0];
    assert_eq!(bulk["place"], "bulk");
    assert_eq!(bulk["long_waves"], false);
    let c = |i: usize, j: usize| bulk["stiffness"][i][j].as_f64().unwrap();
    for (found, expected) in [(c(0, 0), 1.4), (c(1, 1), 1.4), (c(2, 2), 0.0)] {
        assert!((found - expected).abs() < 0.02, "{found}, {expected}");
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
        energy("balance_error"),
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
            "initial_velocities = { temperature = \"600 K\", seed = 7 }",
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
