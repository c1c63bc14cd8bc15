//! Every good deck, shortened, writes the same bytes on any number of threads.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;

/// Steps of a run; statics and relaxations are run whole.
const STEPS: i64 = 12;
/// What `run.json` says of the machine and the clock.
const CLOCK: [&str; 5] = [
    "seconds_stepping",
    "seconds",
    "ns_per_bond_step",
    "peak_memory_bytes",
    "threads",
];

/// A copy of the good decks and what they read, with short runs.
fn decks(to: &Path) -> Vec<PathBuf> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    let mut decks = vec![];
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        if !path.is_file() {
            continue;
        }
        let copy = to.join(path.file_name().unwrap());
        if path.extension().is_none_or(|e| e != "toml") {
            std::fs::copy(&path, &copy).unwrap();
            continue;
        }
        let mut deck: toml::Table = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        if let Some(toml::Value::Table(run)) = deck.get_mut("run") {
            run.remove("duration");
            run.insert("steps".into(), toml::Value::Integer(STEPS));
        }
        std::fs::write(&copy, toml::to_string(&deck).unwrap()).unwrap();
        decks.push(copy);
    }
    decks.sort();
    decks
}

/// All files of a folder by name, `run.json` without the clock.
fn files(dir: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![dir.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
                continue;
            }
            let mut bytes = std::fs::read(&path).unwrap();
            if path.file_name().is_some_and(|n| n == "run.json") {
                let mut report: Value = serde_json::from_slice(&bytes).unwrap();
                for key in CLOCK {
                    assert!(
                        report.as_object_mut().unwrap().remove(key).is_some(),
                        "{key}"
                    );
                }
                bytes = report.to_string().into_bytes();
            }
            if path.file_name().is_some_and(|n| n == "report.html") {
                bytes = without_clock(&bytes);
            }
            all.insert(path.strip_prefix(dir).unwrap().to_path_buf(), bytes);
        }
    }
    all
}

/// A report without what it says of the machine and the clock, and of how long `run.json` is.
fn without_clock(page: &[u8]) -> Vec<u8> {
    const BEGIN: &str = "<script type=\"application/json\" id=\"meta\">";
    let page = std::str::from_utf8(page).unwrap();
    let (before, rest) = page.split_once(BEGIN).unwrap();
    let (meta, after) = rest.split_once("</script>").unwrap();
    let mut meta: Value = serde_json::from_str(meta).unwrap();
    for key in CLOCK {
        let run = meta["run"].as_object_mut().unwrap();
        assert!(run.remove(key).is_some(), "{key}");
    }
    for key in ["facts", "files"] {
        assert!(meta.as_object_mut().unwrap().remove(key).is_some(), "{key}");
    }
    format!("{before}{meta}{after}").into_bytes()
}

/// One deck on one thread and on three, which halve no work evenly.
fn compare(dir: &Path, deck: &Path) {
    let name = deck.file_stem().unwrap().to_str().unwrap();
    let run = |threads: &str| {
        let out = dir.join(format!("{name}-{threads}"));
        let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .args(["run", deck.to_str().unwrap(), "--threads", threads, "--out"])
            .arg(&out)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(0), "{name}: {said}");
        assert!(!said.contains("energy balance"), "{name}: {said}");
        files(&out)
    };
    let one = run("1");
    assert!(one.len() >= 2, "{name}");
    let many = run("3");
    assert!(one.keys().eq(many.keys()), "{name}: other files");
    for (file, bytes) in &one {
        let same = many[file] == *bytes;
        assert!(same, "{name}: {} on 3 threads", file.display());
    }
}

#[test]
fn every_good_deck_writes_the_same_bytes_on_any_number_of_threads() {
    let dir = TempDir::new().unwrap();
    let decks = decks(dir.path());
    assert!(decks.len() >= 20);
    let next = AtomicUsize::new(0);
    // two at a time: much of a run is on one thread
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(deck) = decks.get(next.fetch_add(1, Ordering::Relaxed)) {
                    compare(dir.path(), deck);
                }
            });
        }
    });
}
