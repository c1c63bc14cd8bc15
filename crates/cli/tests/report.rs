//! `report.html` at the end of runs, and by `peridyne report`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    root.join(name).to_str().unwrap().to_string()
}

fn peridyne(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Runs a deck into a folder; what it says.
fn run(out: &Path, name: &str, sets: &[&str]) -> String {
    let (file, out) = (deck(name), out.to_str().unwrap());
    let mut arguments = vec!["run", &file, "--out", out, "--threads", "1"];
    for set in sets {
        arguments.extend(["--set", set]);
    }
    let done = peridyne(&arguments);
    let said = String::from_utf8_lossy(&done.stdout).to_string();
    assert!(done.status.success(), "{said}");
    said
}

fn page(out: &Path) -> (PathBuf, String) {
    let path = out.join("report.html");
    let html = fs::read_to_string(&path).unwrap();
    assert!(html.ends_with("</html>\n") && !html.contains("https:"));
    (path, html)
}

#[test]
fn a_folder_gives_the_report_that_its_run_gave() {
    let dir = tempfile::tempdir().unwrap();
    let said = run(dir.path(), "kalthoff.toml", &["body.spacing=5 mm"]);
    assert!(said.contains("report: "), "{said}");
    let (path, html) = page(dir.path());
    for text in [
        "Kalthoff-Winkler",
        "--set 'body.spacing=5 mm'",
        "square lattice of 5 mm",
        "Silling",
        "\"name\":\"displacement\"",
    ] {
        assert!(html.contains(text), "{text}");
    }
    fs::remove_file(&path).unwrap();
    let done = peridyne(&["report", dir.path().to_str().unwrap()]);
    assert!(done.status.success());
    assert_eq!(page(dir.path()).1, html);
}

#[test]
fn atoms_and_laws_have_reports_and_decks_can_do_without() {
    let dir = tempfile::tempdir().unwrap();
    run(&dir.path().join("a"), "alloy.toml", &[]);
    let (_, html) = page(&dir.path().join("a"));
    assert!(html.contains("\"names\":[\"Aa\",\"Bb\",\"gas\"]"));
    run(&dir.path().join("b"), "conservation/diffusion.toml", &[]);
    let (_, html) = page(&dir.path().join("b"));
    assert!(html.contains("\"kind\":\"law\"") && html.contains("nonlocal diffusion"));
    let said = run(
        &dir.path().join("c"),
        "bar_wave.toml",
        &["output.report=false"],
    );
    assert!(!said.contains("report: ") && !dir.path().join("c/report.html").exists());
}

#[test]
fn a_folder_without_a_run_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let done = peridyne(&["report", dir.path().to_str().unwrap()]);
    let said = String::from_utf8_lossy(&done.stderr).to_string();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("no run.json"), "{said}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}
