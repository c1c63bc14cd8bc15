//! Studies: many values of a deck's keys, one table.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A bar pulled by its ends; E is asked for, and found again from its reaction.
const BAR: &str = r#"title = "A bar"
horizon = { m_ratio = 3 }
[body]
lattice = "chain"
spacing = "1 mm"
region = { block = { low = [0], high = ["40 mm"] } }
[sets]
left.where = "x < 3 mm"
right.where = "x > 37 mm"
[material]
density = "1000 kg/m^3"
law = { pmb = { young = "10 GPa" } }
[[boundary_condition]]
set = "left"
displacement = { x = 0 }
[[boundary_condition]]
set = "right"
displacement = { x = "10 um" }
[[probe]]
name = "pull"
set = "right"
measure = "reaction"
[statics]
increments = 2
[output]
picture = false
report = false
"#;

fn sweep(file: &Path, out: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("sweep")
        .args([file, Path::new("--out"), out])
        .args(["--threads", "2"])
        .args(more)
        .output()
        .unwrap()
}

fn told(output: &Output) -> String {
    let streams = [&output.stdout, &output.stderr].map(|s| String::from_utf8_lossy(s));
    let words: Vec<&str> = streams.iter().flat_map(|s| s.split_whitespace()).collect();
    words.join(" ").replace("│ ", "")
}

/// Columns of the table by the names of their titles.
fn table(out: &Path) -> BTreeMap<String, Vec<String>> {
    let text = std::fs::read_to_string(out.join("sweep.csv")).unwrap();
    let cells = |line: &str| -> Vec<String> {
        let (mut all, mut quoted) = (vec![String::new()], false);
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => all.push(String::new()),
                c => all.last_mut().unwrap().push(c),
            }
        }
        all
    };
    let rows: Vec<Vec<String>> = text.lines().map(cells).collect();
    let column = |n: usize| rows[1..].iter().map(|row| row[n].clone()).collect();
    { rows[0].iter().enumerate() }
        .map(|(n, title)| (title.clone(), column(n)))
        .collect()
}

fn bar(dir: &TempDir) -> std::path::PathBuf {
    let file = dir.path().join("bar.toml");
    std::fs::write(&file, BAR).unwrap();
    file
}

#[test]
fn a_grid_is_a_table_of_its_runs() {
    let dir = TempDir::new().unwrap();
    let (file, out) = (bar(&dir), dir.path().join("study"));
    let vary = [
        "--vary",
        "material.law.pmb.young=10 GPa,20 GPa,40 GPa",
        "--vary",
        "horizon.m_ratio=2,3",
    ];
    let done = sweep(&file, &out, &vary);
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    let columns = table(&out);
    assert_eq!(columns["run"], ["1", "2", "3", "4", "5", "6"]);
    assert_eq!(columns["horizon.m_ratio"], ["2", "3", "2", "3", "2", "3"]);
    assert!(columns["status"].iter().all(|s| s == "done"));
    let pull: Vec<f64> = { columns["pull_x, last [N]"].iter() }
        .map(|cell| cell.parse().unwrap())
        .collect();
    // in proportion to the modulus, with ends that are the same
    for n in 0..4 {
        assert!((pull[n + 2] / pull[n] - 2.0).abs() < 1e-9, "{pull:?}");
    }
    // a run by itself is the same
    let alone = dir.path().join("alone");
    let run = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args([Path::new("run"), &file, Path::new("--out"), &alone])
        .args([
            "--set",
            "material.law.pmb.young=20 GPa",
            "--set",
            "horizon.m_ratio=2",
        ])
        .output()
        .unwrap();
    assert_eq!(run.status.code(), Some(0), "{}", told(&run));
    let record = |dir: &Path| -> Value {
        serde_json::from_slice(&std::fs::read(dir.join("run.json")).unwrap()).unwrap()
    };
    let (study, alone) = (record(&out.join("3")), record(&alone));
    assert_eq!(study["state_hash"], alone["state_hash"]);
    assert!(
        study["setting"]
            .to_string()
            .contains("material.law.pmb.young=20 GPa")
            || study.to_string().contains("young=20 GPa")
    );
    // what is done is not done again, and the rest is
    std::fs::remove_dir_all(out.join("2")).unwrap();
    let before = std::fs::metadata(out.join("1/run.json"))
        .unwrap()
        .modified()
        .unwrap();
    let text = std::fs::read(out.join("sweep.csv")).unwrap();
    let again = sweep(&file, &out, &[&vary[..], &["--jobs", "2"]].concat());
    assert_eq!(again.status.code(), Some(0), "{}", told(&again));
    let after = std::fs::metadata(out.join("1/run.json"))
        .unwrap()
        .modified()
        .unwrap();
    assert_eq!(before, after);
    let columns = |text: &[u8]| {
        let text = String::from_utf8_lossy(text).into_owned();
        text.lines().count()
    };
    assert_eq!(
        columns(&text),
        columns(&std::fs::read(out.join("sweep.csv")).unwrap())
    );
    assert!(out.join("2/run.json").is_file());
    // another study does not write over it
    let other = sweep(&file, &out, &["--vary", "horizon.m_ratio=2,4"]);
    assert_eq!(other.status.code(), Some(2));
    assert!(told(&other).contains("another study"), "{}", told(&other));
}

#[test]
fn one_key_has_a_plot_and_a_hypercube_its_runs() {
    let dir = TempDir::new().unwrap();
    let (file, out) = (bar(&dir), dir.path().join("study"));
    let vary = ["--vary", "material.law.pmb.young=10 GPa:20 GPa"];
    let drawn = ["--design", "latin", "--samples", "4", "--seed", "7"];
    let done = sweep(&file, &out, &[&vary[..], &drawn].concat());
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    let columns = table(&out);
    let mut modulus: Vec<f64> = { columns["material.law.pmb.young"].iter() }
        .map(|cell| cell.trim_end_matches(" GPa").parse().unwrap())
        .collect();
    modulus.sort_by(f64::total_cmp);
    for (n, value) in modulus.iter().enumerate() {
        let part = 10.0 + 2.5 * n as f64;
        assert!(*value >= part && *value < part + 2.5, "{modulus:?}");
    }
    assert!(out.join("pull_x.png").is_file() && out.join("pull_x.svg").is_file());
}

#[test]
fn a_run_that_goes_bad_leaves_the_others() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("bar.toml");
    let motion = BAR.replace(
        "[statics]\nincrements = 2\n",
        "[run]\nsteps = 400\ntime_step = \"0.1 us\"\nforce_unstable = true\n",
    );
    std::fs::write(&file, motion).unwrap();
    let out = dir.path().join("study");
    let done = sweep(&file, &out, &["--vary", "run.time_step=0.1 us,9 us"]);
    assert_eq!(done.status.code(), Some(1), "{}", told(&done));
    let columns = table(&out);
    assert_eq!(columns["status"], ["done", "stopped"]);
    assert!(
        columns["why"][0].is_empty() && columns["why"][1].contains("step"),
        "{:?}",
        columns["why"]
    );
    assert!(told(&done).contains("1 of 2 runs did not come to their end"));
}

#[test]
fn mistakes_are_found_before_the_first_run() {
    let dir = TempDir::new().unwrap();
    let (file, out) = (bar(&dir), dir.path().join("study"));
    for (words, why) in [
        (&["--vary", "horizon.m_ratoi=2,3"][..], "m_ratio"),
        (&["--vary", "horizon.m_ratio=2,many"], "horizon.m_ratio"),
        (&["--vary", "horizon.m_ratio=2:3"], "--design latin"),
        (
            &["--vary", "horizon.m_ratio=2,3", "--design", "latin"],
            "low:high",
        ),
        (
            &[
                "--vary",
                "horizon.m_ratio=2,3",
                "--vary",
                "horizon.m_ratio=4",
            ],
            "twice",
        ),
        (
            &[
                "--vary",
                "horizon.m_ratio=2,3",
                "--vary",
                "statics.increments=1",
                "--design",
                "list",
            ],
            "as many of each",
        ),
        (&["--vary", "horizon.m_ratio=2", "--jobs", "0"], "--jobs 0"),
        (&["--vary", "horizon.m_ratio"], "key=value"),
    ] {
        let wrong = sweep(&file, &out, words);
        assert_eq!(wrong.status.code(), Some(2), "{words:?} {}", told(&wrong));
        assert!(told(&wrong).contains(why), "{words:?} {}", told(&wrong));
        assert!(!out.exists(), "{words:?}");
    }
}
