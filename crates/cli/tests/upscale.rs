//! `peridyne upscale` and `peridyne reproduce` as a user runs them.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks")
        .join(name)
}

fn peridyne(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap()
}

fn card(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path.join("card.json")).unwrap()).unwrap()
}

#[test]
fn a_chain_of_springs_is_upscaled_and_both_decks_run() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let file = deck("good/spring_chain.toml");
    let done = peridyne(&[
        "upscale",
        file.to_str().unwrap(),
        "--factor",
        "2",
        "--factor",
        "4",
        "--run",
        "--out",
        out,
        "--set",
        "run.time_step.safety=0.2",
        "--set",
        "run.duration=60",
    ]);
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    for factor in [2.0, 4.0] {
        let h = dir.path().join(format!("h{factor}"));
        let card = card(&h);
        let number = |path: &str| card.pointer(path).and_then(Value::as_f64).unwrap();
        // (A.2): K1 is kept, and c_4 goes with N² + N over 24
        assert!((number("/coarse/stiffness/0/0") - 1.0).abs() < 1e-12);
        let n = 20.0 / factor;
        let spacing = 0.25 * factor;
        let exact = spacing * spacing * n * (n + 1.0) / 24.0;
        assert!((number("/gradient_coefficients/1/coarse") / exact - 1.0).abs() < 1e-10);
        // a pulse four wide: finite N shows in its dispersion
        let error = number("/measured/displacement_error");
        assert!(error < 0.07 * factor && error > 1e-6, "{error}");
        for name in [
            "card.md",
            "dispersion.png",
            "dispersion.svg",
            "energy.png",
            "coarse.toml",
        ] {
            assert!(h.join(name).is_file(), "{name}");
        }
        let run = peridyne(&["check", h.join("coarse.toml").to_str().unwrap()]);
        assert_eq!(
            run.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        );
    }
}

#[test]
fn copper_keeps_its_energy_and_moduli() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let file = deck("good/copper_bar.toml");
    let done = peridyne(&[
        "upscale",
        file.to_str().unwrap(),
        "--factor",
        "2",
        "--out",
        out,
    ]);
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let card = card(&dir.path().join("h2"));
    for e in card["energies"].as_array().unwrap() {
        let (a, b) = (e["fine"].as_f64().unwrap(), e["coarse"].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 1e-9, "{e}");
    }
    // eV/Å³: c11 of copper is 170 GPa = 1.06
    let c11 = card["fine"]["stiffness"][0][0].as_f64().unwrap();
    assert!((0.9..1.2).contains(&c11), "{c11}");
    assert!((card["predicted_cost_ratio"].as_f64().unwrap() - 16.0).abs() < 0.1);
}

#[test]
fn what_cannot_be_upscaled_says_why_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (name, factor, expected) in [
        ("good/spring_chain.toml", "3", "not divisible"),
        ("good/spring_chain.toml", "1", "2 or more"),
        ("good/mesh_plate.toml", "2", "only a lattice body"),
        ("good/copper_bar.toml", "5", "not divisible"),
        ("good/minimal_crack.toml", "9", "choose one of 3"),
        ("in.impact_disk", "2", "takes a deck"),
    ] {
        let file = deck(name);
        let done = peridyne(&[
            "upscale",
            file.to_str().unwrap(),
            "--factor",
            factor,
            "--out",
            out.to_str().unwrap(),
        ]);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{name}: {said}");
        let flat = said
            .split_whitespace()
            .filter(|w| *w != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(flat.contains(expected), "{name}: {said}");
        assert!(!out.exists(), "{name}");
    }
}

#[test]
fn a_table_is_reproduced_and_a_wrong_figure_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let done = peridyne(&[
        "reproduce",
        "seleson2009/table-4-1",
        "--small",
        "--out",
        out,
    ]);
    assert_eq!(
        done.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    assert!(
        dir.path()
            .join("seleson2009/table-4-1/report.json")
            .is_file()
    );
    let wrong = peridyne(&["reproduce", "seleson2009/table-4-2", "--out", out]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("table-4-1"));
}
