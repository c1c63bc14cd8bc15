//! `peridyne waves` and `peridyne upscale` of crystals with a basis, as a user runs them.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks/good")
        .join(name)
}

fn peridyne(verb: &str, file: &Path, arguments: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg(verb)
        .arg(file)
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

fn said(done: &Output) -> String {
    String::from_utf8_lossy(&done.stdout).into_owned() + &String::from_utf8_lossy(&done.stderr)
}

fn waves(file: &Path) -> Value {
    let dir = tempfile::tempdir().unwrap();
    let done = peridyne("waves", file, &["--json"], &dir.path().join("out"));
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    serde_json::from_slice(&done.stdout).unwrap()
}

/// Frequencies where all cells move alike.
fn at_centre(found: &Value) -> Vec<f64> {
    let points = found["special_points"].as_array().unwrap();
    let centre = points.iter().find(|p| p["name"] == "Γ").unwrap();
    let omega = centre["omega"].as_array().unwrap();
    omega.iter().map(|w| w.as_f64().unwrap()).collect()
}

fn cubic(found: &Value) -> [f64; 3] {
    ["c11", "c12", "c44"].map(|c| found["elastic"]["lattice"]["cubic"][c].as_f64().unwrap())
}

#[test]
fn silicon_has_optical_waves() {
    let found = waves(&deck("silicon.toml"));
    assert_eq!(found["sites_per_cell"], 2);
    let omega = at_centre(&found);
    assert_eq!((omega.len(), &omega[..3]), (6, &[0.0; 3][..]));
    // verify/phonons/sw_silicon.csv: ω² = 1.30108676 eV/(u Å²), and ps
    let raman = (1.30108676 / 1.0364269e-4f64).sqrt();
    for w in &omega[3..] {
        assert!((w / raman - 1.0).abs() < 1e-5, "{w} {raman}");
    }
    // Cowley 1988; numbers are in eV/Å³
    for (c, gpa) in cubic(&found).into_iter().zip([151.4, 76.4, 56.4]) {
        assert!((c * 160.2176634 - gpa).abs() < 0.1, "{c} {gpa}");
    }
    let dir = tempfile::tempdir().unwrap();
    let done = peridyne("waves", &deck("silicon.toml"), &[], &dir.path().join("out"));
    let text = said(&done);
    assert!(
        text.contains("2 sites: 3 acoustic and 3 optical branches"),
        "{text}"
    );
    assert!(text.contains("all waves of the zone oscillate"), "{text}");
}

#[test]
fn two_materials_in_a_cell() {
    let found = waves(&deck("silicon_carbide.toml"));
    assert_eq!(found["sites_per_cell"], 2);
    // verify/phonons/tersoff_carbide.csv
    let raman = (3.60087868 / 1.0364269e-4f64).sqrt();
    for w in &at_centre(&found)[3..] {
        assert!((w / raman - 1.0).abs() < 1e-5, "{w} {raman}");
    }
    let found = waves(&deck("ordered_alloy.toml"));
    assert_eq!(
        (&found["sites_per_cell"], at_centre(&found).len()),
        (&2.into(), 6)
    );
    let names: Vec<&str> = { found["special_points"].as_array().unwrap().iter() }
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    // the translations of B2 are those of a cubic lattice
    assert_eq!(names, ["Γ", "X", "M", "Γ", "R", "X"]);
}

#[test]
fn coarse_silicon_has_the_same_constants_and_long_waves() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("coarse");
    let set = ["--set", "body.cells=[8,8,8]", "--factor", "2"];
    let done = peridyne("upscale", &deck("silicon.toml"), &set, &out);
    let text = said(&done);
    assert_eq!(done.status.code(), Some(0), "{text}");
    assert!(text.contains("3 optical branches"), "{text}");
    assert!(text.contains("are lost"), "{text}");
    let (fine, coarse) = (
        waves(&out.join("fine.toml")),
        waves(&out.join("h2/coarse.toml")),
    );
    for (a, b) in cubic(&fine).into_iter().zip(cubic(&coarse)) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
    let density = |v: &Value| v["density"].as_f64().unwrap();
    assert!((density(&fine) / density(&coarse) - 1.0).abs() < 1e-12);
    for (a, b) in at_centre(&fine)[3..].iter().zip(&at_centre(&coarse)[3..]) {
        assert!((a / b - 2.0).abs() < 1e-9, "{a} {b}");
    }
    // constants of the file are keys now, and the coarse deck runs
    assert!(!out.join("h2/Si.sw").exists());
    let steps = ["--set", "run.steps=2"];
    let done = peridyne(
        "run",
        &out.join("h2/coarse.toml"),
        &steps,
        &dir.path().join("run"),
    );
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
}

#[test]
fn an_ordered_alloy_grows_with_its_sublattices() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("coarse");
    let set = ["--set", "body.cells=[10,10,10]", "--factor", "2"];
    let done = peridyne("upscale", &deck("ordered_alloy.toml"), &set, &out);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let (fine, coarse) = (
        waves(&out.join("fine.toml")),
        waves(&out.join("h2/coarse.toml")),
    );
    for (a, b) in cubic(&fine).into_iter().zip(cubic(&coarse)) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

/// What was said, in one line.
fn words(done: &Output) -> String {
    let text = said(done);
    let words = text.split_whitespace().filter(|word| *word != "│");
    words.collect::<Vec<_>>().join(" ")
}

#[test]
fn what_has_no_coarse_model_says_so() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("coarse");
    let set = ["--set", "body.cells=[8,8,8]", "--factor", "2"];
    let done = peridyne("upscale", &deck("silicon_carbide.toml"), &set, &out);
    let text = words(&done);
    assert_eq!(done.status.code(), Some(2), "{text}");
    assert!(text.contains("a file with several elements"), "{text}");
    // regions do not repeat
    let done = peridyne("waves", &deck("alloy.toml"), &[], &out);
    let text = words(&done);
    assert_eq!(done.status.code(), Some(2), "{text}");
    assert!(text.contains("do not repeat"), "{text}");
    assert!(!out.exists());
}
