//! `peridyne coarsen` as a user runs it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks")
        .join(name)
}

fn coarsen(name: &str, out: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("coarsen")
        .arg(deck(name))
        .arg("--out")
        .arg(out)
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn a_plate_of_fibres_is_coarsened_and_runs() {
    let dir = tempfile::tempdir().unwrap();
    let done = coarsen(
        "good/fibre_plate.toml",
        dir.path(),
        &["--every", "3", "--supports", "thinned", "--run"],
    );
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let json = std::fs::read_to_string(dir.path().join("level1.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["points"], 31 * 21);
    assert!(report["asymmetry"].as_f64().unwrap() < 1e-12);
    let mass: Vec<f64> = serde_json::from_value(report["mass"].clone()).unwrap();
    assert!((mass[1] / mass[0] - 1.0).abs() < 1e-10);
    // the ends are held at fewer points than they were, and the modulus is within its tolerance
    let (_, after) = told.split_once("displacement error ").unwrap();
    let error: f64 = after.split(' ').next().unwrap().parse().unwrap();
    assert!(error < 5.0 && error > 1e-3, "{told}");
}

#[test]
fn a_crystal_with_a_vacancy_is_relaxed_coarsened_twice_and_runs() {
    let dir = tempfile::tempdir().unwrap();
    let done = coarsen(
        "good/crystal_with_vacancy.toml",
        dir.path(),
        &["--every", "2", "--levels", "2", "--run"],
    );
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    assert!(told.contains("relaxed without load"), "{told}");
    let read = |name: &str| -> serde_json::Value {
        let json = std::fs::read_to_string(dir.path().join(name)).unwrap();
        serde_json::from_str(&json).unwrap()
    };
    // of 13 × 33 + 12 × 32 − 1 atoms the triangular lattices of twice and four times the spacing
    for (name, points) in [
        ("level1.json", 7 * 17 + 6 * 16),
        ("level2.json", 4 * 9 + 3 * 8),
    ] {
        let report = read(name);
        assert_eq!(report["points"], points, "{name}");
        for what in ["asymmetry", "rotation"] {
            assert!(report[what].as_f64().unwrap() < 1e-8, "{name}: {report}");
        }
        assert_eq!(report["checked_positive_semidefinite"], true);
    }
    let errors = told
        .split("displacement error ")
        .skip(1)
        .map(|rest| rest.split(' ').next().unwrap().parse::<f64>().unwrap());
    let errors: Vec<f64> = errors.collect();
    assert_eq!(errors.len(), 2, "{told}");
    // all levels are held at the same atoms: what is left is the radius of balls
    assert!(errors.iter().all(|e| *e < 0.1), "{told}");
}

/// Silicon of Stillinger and Weber with one of its two lattices taken out: a set of sites, which coarse points have no more.
#[test]
fn a_layer_of_silicon_keeps_one_of_its_lattices_and_moves_as_before() {
    let dir = tempfile::tempdir().unwrap();
    let done = coarsen(
        "good/silicon_layer.toml",
        dir.path(),
        &["--keep", "kept", "--scheme", "schur", "--run"],
    );
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    let json = std::fs::read_to_string(dir.path().join("level1.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    // 4 of 8 atoms of a cell, and of the others those of the layers at the faces
    assert_eq!(report["points"], 4 * 24 + 16);
    assert_eq!(report["checked_positive_semidefinite"], true);
    let (_, after) = told.split_once("displacement error ").unwrap();
    let error: f64 = after.split(' ').next().unwrap().parse().unwrap();
    assert!(error < 1e-8, "{told}");
}

/// What is held by a set of sites cannot be held so where there are no sites.
#[test]
fn sets_of_old_points_are_refused_where_they_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let text = std::fs::read_to_string(deck("good/silicon_layer.toml")).unwrap();
    std::fs::copy(deck("good/Si.sw"), dir.path().join("Si.sw")).unwrap();
    let region = "region = { block = { low = [\"-a\", \"-a\", \"-a\"], high = [\"0.3*a\", \"9*a\", \"9*a\"] } }";
    assert!(text.contains(region));
    for (members, expected) in [
        (
            "basis = [1]",
            "sets.left is sites of the old lattice's cell: give it a region",
        ),
        (
            "random = { part = 0.2, seed = 1 }",
            "sets.left is drawn from the old points",
        ),
    ] {
        let file = dir.path().join("layer.toml");
        std::fs::write(&file, text.replace(region, members)).unwrap();
        let arguments = ["--keep", "kept", "--scheme", "schur"];
        let done = coarsen(file.to_str().unwrap(), &out, &arguments);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(2), "{said}");
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        assert!(flat.join(" ").contains(expected), "{said}");
        assert!(!out.exists());
    }
}

#[test]
fn what_is_wrong_is_named_and_nothing_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (name, arguments, expected) in [
        ("good/fibre_plate.toml", &[][..], "--every K"),
        (
            "good/fibre_plate.toml",
            &["--keep", "nothing"],
            "no such set",
        ),
        (
            "good/fibre_plate.toml",
            &["--every", "3", "--radius", "0.001"],
            "below the longest bond",
        ),
        (
            "good/fibre_plate.toml",
            &["--every", "3", "--scheme", "rough"],
            "energy, rows or schur",
        ),
        ("in.impact_disk", &["--every", "3"], "takes a deck"),
    ] {
        let done = coarsen(name, &out, arguments);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {said}");
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        assert!(flat.join(" ").contains(expected), "{arguments:?}: {said}");
        assert!(!out.exists(), "{arguments:?}");
    }
}

/// Displacement error (%) and all that was told of a chain in motion.
fn moved(arguments: &[&str]) -> (f64, String, tempfile::TempDir) {
    let dir = tempfile::tempdir().unwrap();
    let all = [&["--every", "4", "--run"], arguments].concat();
    let done = coarsen("good/pulse_on_a_chain.toml", dir.path(), &all);
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let (_, after) = told.split_once("displacement error ").unwrap();
    let error = after.split(' ').next().unwrap().parse().unwrap();
    (error, told, dir)
}

#[test]
fn a_chain_in_motion_runs_with_masses_that_couple_and_is_warned_of_where_it_is_off() {
    let (blend, told, dir) = moved(&[]);
    assert!(blend < 5.0 && !told.contains("warning: level1"), "{told}");
    let json = std::fs::read_to_string(dir.path().join("level1.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["masses"], "blend");
    let error = |spacings: f64| {
        let waves = report["frequencies"]["waves"].as_array().unwrap();
        let wave = waves.iter().find(|w| w["coarse_spacings"] == spacings);
        100.0 * wave.unwrap()["error"].as_f64().unwrap()
    };
    assert!(error(25.0).abs() < 0.3 && error(10.0).abs() < 5.5, "{told}");
    let steps = ["stable_step", "stable_step_of_level_0"].map(|k| report[k].as_f64().unwrap());
    assert!(steps[0] > steps[1], "{steps:?}");
    let table = std::fs::read_to_string(dir.path().join("level1-waves.csv")).unwrap();
    assert!(
        table.starts_with("along,moves,coarse spacings per wave"),
        "{table}"
    );
    // two and a half coarse spacings: no mass repairs it
    let (narrow, told, _) = moved(&["--set", "constants.w=0.05"]);
    assert!(narrow > 5.0 && told.contains("warning: level1"), "{told}");
    let (lumped, told, _) = moved(&["--mass", "lumped"]);
    assert!(lumped > 15.0 && told.contains("warning: level1"), "{told}");
    let (wide, told, _) = moved(&["--set", "constants.w=0.2"]);
    assert!(wide < 0.3, "{told}");
}

#[test]
fn a_level_in_motion_is_coarsened_further() {
    let (_, _, first) = moved(&["--mass", "consistent"]);
    let out = tempfile::tempdir().unwrap();
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("coarsen")
        .arg(first.path().join("level1.toml"))
        .args(["--every", "2", "--out"])
        .arg(out.path())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&done.stdout).into_owned();
    assert_eq!(done.status.code(), Some(0), "{told}");
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("run")
        .arg(out.path().join("level1.toml"))
        .arg("--out")
        .arg(out.path().join("run"))
        .output()
        .unwrap();
    assert_eq!(done.status.code(), Some(0));
}
