//! `peridyne converge` as a user runs it.

use peridyne_theory::dispersion::chain::SpringContinuum;
use serde_json::Value;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

fn converge(name: &str, arguments: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("converge")
        .arg(deck(name))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

/// The results of a study that must succeed.
fn study(arguments: &[&str]) -> (Value, String) {
    let dir = tempfile::tempdir().unwrap();
    let done = converge("convergence_bar.toml", arguments, dir.path());
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    for file in ["convergence.csv", "convergence.png", "convergence.svg"] {
        assert!(dir.path().join(file).is_file(), "{file}");
    }
    let text = std::fs::read_to_string(dir.path().join("convergence.json")).unwrap();
    (
        serde_json::from_str(&text).unwrap(),
        String::from_utf8_lossy(&done.stdout).into_owned(),
    )
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap()
}

const LOCAL: &str = "0.5*(exp(-((x-1-t)/0.15)^2) + exp(-((x-1+t)/0.15)^2))";

#[test]
fn the_horizon_shrinks_to_the_local_solution_with_order_two() {
    let (found, said) = study(&["--study", "delta", "--exact", LOCAL]);
    let order = number(&found, "/order_of_errors/fitted");
    assert!((order - 2.0).abs() < 0.05, "{order}");
    assert_eq!(found["order_of_errors"]["verdict"], "converges");
    assert!(said.contains("consistent order of convergence"), "{said}");
    let finest = number(&found, "/levels/3/error_rms");
    assert!(finest < 3e-4, "{finest}");
    assert!(number(&found, "/time_error_of_the_finest_level") < 0.1 * finest);
    // all levels end at the same time
    for level in found["levels"].as_array().unwrap() {
        assert_eq!(level["steps"], found["levels"][0]["steps"]);
    }
}

#[test]
fn differences_of_neighbouring_levels_have_the_same_order() {
    let (found, _) = study(&["--study", "delta"]);
    let order = number(&found, "/order_of_differences/fitted");
    assert!((order - 2.0).abs() < 0.05, "{order}");
    assert!(found["levels"][3]["error_rms"].is_null());
}

#[test]
fn the_spacing_shrinks_to_the_nonlocal_solution_with_order_one() {
    // a wave of length 2 stands on the ring with the frequency of the integral over the horizon
    let integral = SpringContinuum {
        k1: 1.0,
        density: 1.0,
        horizon: 0.04,
    };
    let exact = format!("sin(pi*x)*cos({}*t)", integral.frequency(PI));
    let set = [
        "--set",
        "initial=[{displacement=[\"sin(pi*x)\"]}]",
        "--set",
        "run.duration=4.3",
        "--substeps",
        "16",
    ];
    let mut arguments = vec!["--study", "m", "--exact", &exact];
    arguments.extend(set);
    let (found, _) = study(&arguments);
    // (1 + 1/N) in the gradient coefficients (seleson2009 (A.2))
    let order = number(&found, "/order_of_errors/fitted");
    assert!((order - 1.0).abs() < 0.1, "{order}");
    for level in found["levels"].as_array().unwrap() {
        assert!((level["horizon"].as_f64().unwrap() - 0.04).abs() < 1e-12);
    }
}

#[test]
fn the_nonlocal_model_stays_away_from_the_local_solution() {
    let (found, said) = study(&["--study", "m", "--exact", LOCAL]);
    assert!(
        said.contains("another solution than the exact one"),
        "{said}"
    );
    assert!(number(&found, "/order_of_errors/fitted") < 0.3);
    assert_ne!(found["order_of_errors"]["verdict"], "converges");
    // and yet its levels draw together
    let order = number(&found, "/order_of_differences/fitted");
    assert!((order - 1.0).abs() < 0.05, "{order}");
}

#[test]
fn both_shrink_to_the_local_solution() {
    let (found, _) = study(&["--study", "delta-m", "--exact", LOCAL]);
    assert!(number(&found, "/order_of_errors/fitted") > 1.9);
    let m = |k: usize| {
        number(&found, &format!("/levels/{k}/horizon"))
            / number(&found, &format!("/levels/{k}/spacing"))
    };
    assert!(m(3) > m(2) && m(2) > m(1) && m(1) > m(0));
}

#[test]
fn what_cannot_converge_says_why_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let bar = "convergence_bar.toml";
    for (name, arguments, expected) in [
        (
            "mesh_plate.toml",
            &["--study", "delta"][..],
            "only an unperturbed lattice body",
        ),
        ("copper_bar.toml", &["--study", "m"], "peridyne upscale"),
        (
            bar,
            &["--study", "m", "--levels", "2"],
            "takes 3 to 12 levels",
        ),
        (
            bar,
            &["--study", "m", "--levels", "1", "--exact", "x"],
            "takes 2 to 12 levels",
        ),
        (bar, &["--study", "m", "--substeps", "0"], "take 1 or more"),
        (bar, &["--study", "m", "--exact", "sin(x"], "--exact"),
        (
            bar,
            &["--study", "m", "--exact", "x", "--exact", "x"],
            "1 dimensions",
        ),
        (
            bar,
            &["--study", "m", "--exact", "0"],
            "nothing is displaced",
        ),
        (bar, &["--study", "m", "--exact", "1/0"], "no value"),
        (
            bar,
            &["--study", "m", "--set", "initial=[]"],
            "nothing is displaced",
        ),
        (
            bar,
            &["--study", "delta-m", "--set", "horizon.m_ratio=1"],
            "take 2 or more",
        ),
        (bar, &["--study", "m", "--set", "run.time_step=1"], "stab"),
        (bar, &["--study", "sideways"], "delta-m"),
    ] {
        let done = converge(name, arguments, &out);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}: {said}");
        let flat = said
            .split_whitespace()
            .filter(|w| *w != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(flat.contains(expected), "{arguments:?}: {said}");
        // what is wrong at the end leaves the runs, for another exact solution, and no result
        let ran = expected.contains("displaced") || expected == "no value";
        assert_eq!(out.exists(), ran, "{arguments:?}");
        assert!(!out.join("convergence.csv").exists(), "{arguments:?}");
        if ran {
            std::fs::remove_dir_all(&out).unwrap();
        }
    }
}

#[test]
fn a_study_goes_on_where_it_was_ended_and_compares_with_another_solution_without_a_run() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let made = |arguments: &[&str]| {
        let all = [&["--study", "delta", "--levels", "3"], arguments].concat();
        let done = converge("convergence_bar.toml", &all, &out);
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        (done.status.code(), said)
    };
    let found = || {
        let text = std::fs::read_to_string(out.join("convergence.json")).unwrap();
        let mut found: Value = serde_json::from_str(&text).unwrap();
        for level in found["levels"].as_array_mut().unwrap() {
            level["seconds"] = Value::Null;
        }
        found
    };
    let record = |name: &str| std::fs::read(out.join(name).join("run.json")).unwrap();
    let (code, said) = made(&["--exact", LOCAL]);
    assert_eq!(code, Some(0), "{said}");
    let (before, levels) = (found(), ["level1", "level2"].map(record));
    let said: Value = serde_json::from_slice(&levels[1]).unwrap();
    let command = said["setting"]["command"].as_str().unwrap();
    assert!(
        command.starts_with("peridyne converge ") && command.ends_with(" --study delta"),
        "{command}"
    );
    // as if it had been ended in the finest level
    std::fs::remove_dir_all(out.join("level3")).unwrap();
    std::fs::remove_dir_all(out.join("coarser-step")).unwrap();
    let (code, said) = made(&["--exact", LOCAL, "--jobs", "2"]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(found(), before);
    let records = || ["level1", "level2", "level3", "coarser-step"].map(record);
    assert_eq!(["level1", "level2"].map(record), levels);
    let all = records();
    let (code, said) = made(&[]);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(records(), all);
    assert!(found()["levels"][2]["error_rms"].is_null());
    let (code, said) = made(&["--substeps", "2"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("another study"), "{said}");
    // a file that was damaged is no result
    std::fs::write(out.join("level2/displacement.npz"), "no archive").unwrap();
    let (code, said) = made(&[]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("Take its folder away"), "{said}");
}
