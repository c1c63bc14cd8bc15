//! Every good deck, shortened, and every small script writes the same bytes on any number of threads, and ends as `hashes.txt` says.

use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
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
/// The same of a conservation law.
const CLOCK_OF_LAW: [&str; 3] = ["seconds_stepping", "ns_per_point_step", "peak_memory_bytes"];

/// Takes that away.
fn stop_clock(run: &mut Value) {
    let clock = match run["kind"] == "conservation_law" {
        true => &CLOCK_OF_LAW[..],
        false => &CLOCK,
    };
    for key in clock {
        assert!(run.as_object_mut().unwrap().remove(*key).is_some(), "{key}");
    }
}

/// What is run.
struct Case {
    /// File stem of a deck; a script's file.
    name: String,
    path: PathBuf,
    /// May it solve equations by sparse factors?
    factors: bool,
}

impl Case {
    fn is_script(&self) -> bool {
        self.name.starts_with("in.")
    }
}

/// A copy of the good decks and what they read, with short runs.
fn decks(to: &Path) -> Vec<Case> {
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
        let mut factors = deck.contains_key("statics");
        if let Some(toml::Value::Table(run)) = deck.get_mut("run") {
            let integrator = run.get("integrator").and_then(|i| i.as_str());
            factors |= integrator.is_some_and(|i| ["newmark", "hht"].contains(&i));
            run.remove("duration");
            run.insert("steps".into(), toml::Value::Integer(STEPS));
        }
        std::fs::write(&copy, toml::to_string(&deck).unwrap()).unwrap();
        decks.push(Case {
            name: path.file_stem().unwrap().to_str().unwrap().to_string(),
            path: copy,
            factors,
        });
    }
    decks.sort_by(|a, b| a.name.cmp(&b.name));
    decks
}

/// The good decks of conservation laws, whole.
fn laws() -> Vec<Case> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/conservation");
    let paths = std::fs::read_dir(from).unwrap().map(|e| e.unwrap().path());
    let mut laws: Vec<Case> = paths
        .map(|path| Case {
            name: format!("law.{}", path.file_stem().unwrap().display()),
            path,
            factors: false,
        })
        .collect();
    laws.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(laws.len() >= 6);
    laws
}

/// The small scripts that LAMMPS has computed, too.
fn scripts() -> Vec<Case> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/cases");
    let paths = std::fs::read_dir(from).unwrap().map(|e| e.unwrap().path());
    let mut scripts: Vec<Case> = paths
        .map(|path| Case {
            name: path.file_name().unwrap().to_str().unwrap().to_string(),
            path,
            factors: false,
        })
        .filter(Case::is_script)
        .collect();
    scripts.sort_by(|a, b| a.name.cmp(&b.name));
    scripts
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
                stop_clock(&mut report);
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
    stop_clock(&mut meta["run"]);
    for key in ["facts", "files"] {
        assert!(meta.as_object_mut().unwrap().remove(key).is_some(), "{key}");
    }
    format!("{before}{meta}{after}").into_bytes()
}

/// The program on a case.
fn program(case: &Case, arguments: &[&str]) {
    let name = &case.name;
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{name} {arguments:?}: {said}");
    assert!(!said.contains("energy balance"), "{name}: {said}");
}

/// Runs a case; all that it wrote.
fn run(dir: &Path, case: &Case, threads: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let out = dir.join(format!("{}-{threads}", case.name));
    let to = out.to_str().unwrap();
    let deck = case.path.to_str().unwrap();
    program(case, &["run", deck, "--threads", threads, "--out", to]);
    files(&out)
}

/// The same in two parts: on one thread to a third of the steps, as if it were cut off there, and on three from there.
fn run_in_two(dir: &Path, case: &Case, steps: u64) -> BTreeMap<PathBuf, Vec<u8>> {
    let out = dir.join(format!("{}-two", case.name));
    let to = out.to_str().unwrap();
    let deck = case.path.to_str().unwrap();
    let third = (steps / 3).to_string();
    let first = [
        "run",
        deck,
        "--threads",
        "1",
        "--out",
        to,
        "--stop-after",
        &third,
    ];
    program(case, &first);
    assert!(out.join("checkpoint").is_dir(), "{}", case.name);
    program(case, &["resume", to, "--threads", "3"]);
    files(&out)
}

/// One case on one thread and on three, which halve no work evenly. How it ended: a line of the table.
fn compare(dir: &Path, case: &Case) -> String {
    let name = &case.name;
    let one = run(dir, case, "1");
    assert!(one.len() >= 2, "{name}");
    let report = Path::new("run.json");
    let steps = |of: &[u8]| serde_json::from_slice::<Value>(of).unwrap()["steps"].as_u64();
    let many = match steps(&one[report]) {
        Some(steps) if steps > 0 && !case.is_script() => run_in_two(dir, case, steps),
        _ => run(dir, case, "3"),
    };
    let names = |of: &BTreeMap<PathBuf, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&many), "{name}: other files");
    for (file, bytes) in &one {
        // LAMMPS's own output has the clock
        if !case.is_script() || file == report {
            let same = many[file] == *bytes;
            assert!(
                same,
                "{name}: {} in two parts on 1 and 3 threads",
                file.display()
            );
        }
    }
    let report: Value = serde_json::from_slice(&one[report]).unwrap();
    let [state, ledger] = ["state_hash", "ledger_hash"].map(|key| report[key].as_str());
    let mut line = format!("{name} {} {}", state.unwrap(), ledger.unwrap_or("-"));
    if case.factors {
        line += " factors";
    }
    line
}

/// What the table says of itself, after the line with the features of the machine that wrote it.
const HEADER: &str = "\
# How each good deck of 12 steps, each law and each script of verify/lammps/cases ends: its name, state_hash and ledger_hash
# of its run.json (-: none). PERIDYNE_RENEW_HASHES=1 cargo test -p peridyne-cli --test threads writes this table anew.
# `factors`: the deck has [statics] or an implicit integrator, and so may solve by sparse factors, for which faer takes
# the instructions that it finds; such a line is compared where the processor has the features of the first line.
";

fn table() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hashes.txt")
}

/// What faer chooses by.
fn features() -> String {
    #[cfg(target_arch = "x86_64")]
    let found = [
        ("avx2", std::is_x86_feature_detected!("avx2")),
        ("fma", std::is_x86_feature_detected!("fma")),
        ("avx512f", std::is_x86_feature_detected!("avx512f")),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let found = [(std::env::consts::ARCH, true)];
    let found = found.iter().filter(|(_, there)| *there);
    let names: Vec<&str> = found.map(|(name, _)| *name).collect();
    format!("# {}", names.join(" "))
}

/// Lines of the table that are wrong, as they would have to be.
fn wrong(table: &str, lines: &[String]) -> Vec<String> {
    let alike = table.lines().next() == Some(&*features());
    let name = |line: &str| line.split(' ').next().unwrap().to_string();
    let known = table.lines().filter(|l| !l.starts_with('#'));
    let mut known: BTreeMap<String, &str> = known.map(|l| (name(l), l)).collect();
    let mut wrong = vec![];
    for line in lines {
        let before = known.remove(&name(line));
        let counts = alike || !line.ends_with(" factors");
        if before.is_none_or(|before| before != line && counts) {
            wrong.push(line.clone());
        }
    }
    wrong.extend(known.into_keys().map(|name| format!("{name}: is gone")));
    wrong
}

#[test]
fn every_good_deck_writes_the_same_bytes_on_any_number_of_threads_and_ends_as_it_did() {
    let dir = TempDir::new().unwrap();
    let mut cases = decks(dir.path());
    assert!(cases.len() >= 20);
    cases.extend(laws());
    cases.extend(scripts());
    let next = AtomicUsize::new(0);
    let lines = Mutex::new(BTreeMap::new());
    let failed = Mutex::new(vec![]);
    // two at a time: much of a run is on one thread
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let n = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(n) else { break };
                    // all that fail are told
                    match catch_unwind(AssertUnwindSafe(|| compare(dir.path(), case))) {
                        Ok(line) => drop(lines.lock().unwrap().insert(n, line)),
                        Err(_) => failed.lock().unwrap().push(&*case.name),
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap();
    assert!(failed.is_empty(), "{failed:?}");
    let lines: Vec<String> = lines.into_inner().unwrap().into_values().collect();
    if std::env::var_os("PERIDYNE_RENEW_HASHES").is_some() {
        let text = format!("{}\n{HEADER}{}\n", features(), lines.join("\n"));
        return std::fs::write(table(), text).unwrap();
    }
    let wrong = wrong(&std::fs::read_to_string(table()).unwrap(), &lines);
    assert!(
        wrong.is_empty(),
        "{} ends are not those of {}:\n{}",
        wrong.len(),
        table().display(),
        wrong.join("\n")
    );
}

#[test]
fn a_wrong_line_of_the_table_is_found() {
    let lines = ["a 1 2", "b 3 -", "c 4 5 factors"].map(String::from);
    let of = |first: &str, text: &str| wrong(&format!("{first}\n# x\n{text}"), &lines);
    let here = features();
    assert!(of(&here, "a 1 2\nb 3 -\nc 4 5 factors\n").is_empty());
    assert_eq!(of(&here, "a 1 2\nb 3 4\nc 4 6 factors\n"), lines[1..]);
    // the factors of another machine, a new line and an old one
    let other = of("# none", "a 1 2\nc 4 6 factors\nd 7 8\n");
    assert_eq!(other, ["b 3 -", "d: is gone"]);
}
