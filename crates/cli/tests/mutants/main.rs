//! Mutants: good files of every format that the program reads, changed in many ways. Whatever they say, the program ends soon, in little
//! memory, with the exit code 0, 1 or 2, and prints nothing that steers a terminal.
//!
//! `PERIDYNE_MUTANTS=100000 PERIDYNE_SEED=2 cargo test --workspace --test mutants -- --nocapture` is a long campaign. A mutant that shows a
//! fault is kept, with the place and the command said.

#![cfg(target_os = "linux")]

mod change;
mod judge;
mod seeds;

use change::{Dice, KINDS};
use judge::Verdict;
use seeds::Seed;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

const PROGRAM: &str = env!("CARGO_BIN_EXE_peridyne");

fn asked(name: &str, usual: u64) -> u64 {
    std::env::var(name).map_or(usual, |text| text.parse().unwrap())
}

fn good(arguments: &[String], folder: &Path, said: &Path) {
    let ended = judge::run(PROGRAM, arguments, folder, said);
    let told = || std::fs::read_to_string(said).unwrap();
    assert_eq!(ended, Ok(0), "{arguments:?}: {}", told());
}

/// What the file `file` of a seed becomes.
fn mutated(seed: &Seed, file: usize, kind: usize, dice: &mut Dice) -> Vec<u8> {
    let mut bytes = seed.files[file].1.clone();
    if !bytes.is_empty() {
        KINDS[kind].1(dice, &mut bytes);
    }
    bytes
}

struct Tried {
    /// Format and file.
    what: String,
    kind: usize,
    verdict: Verdict,
}

/// The mutant of this number, in a folder of its own.
fn attempt(seeds: &[Seed], number: usize, first: u64, room: &Path) -> Tried {
    let seed = &seeds[number % seeds.len()];
    let mut dice = Dice(first.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ number as u64);
    let file = *dice.pick(&seed.changed);
    let kind = dice.below(KINDS.len());
    let folder = room.join("files");
    seed.write(&folder);
    let name = &seed.files[file].0;
    std::fs::write(folder.join(name), mutated(seed, file, kind, &mut dice)).unwrap();
    let mut verdict = judge::run(PROGRAM, &seed.arguments, &folder, &room.join("said"));
    if let Err(why) = &mut verdict {
        let kept = kept(number);
        std::fs::rename(&folder, &kept).unwrap();
        *why = format!(
            "cd {} && peridyne {}: {why}",
            kept.display(),
            seed.arguments.join(" ")
        );
    } else {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    let end = Path::new(name)
        .extension()
        .unwrap_or(Path::new(name).as_os_str());
    Tried {
        what: format!("{} {}", seed.format, end.to_string_lossy()),
        kind,
        verdict,
    }
}

/// Where a mutant with a fault stays.
fn kept(number: usize) -> PathBuf {
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("mutants/{number}"));
    let _ = std::fs::remove_dir_all(&kept);
    std::fs::create_dir_all(kept.parent().unwrap()).unwrap();
    kept
}

/// Numbers of mutants of each kind by format, then those that were taken, that failed and that were refused, and faults.
fn table(all: &[Tried]) -> String {
    let mut rows: BTreeMap<&str, [usize; KINDS.len() + 4]> = BTreeMap::new();
    let mut sums = [0; KINDS.len() + 4];
    for tried in all {
        let end = match tried.verdict {
            Ok(code) => code as usize,
            Err(_) => 3,
        };
        let row = rows.entry(&tried.what).or_default();
        for counts in [row, &mut sums] {
            counts[tried.kind] += 1;
            counts[KINDS.len() + end] += 1;
        }
    }
    let heads = KINDS.iter().map(|(name, _)| *name);
    let heads = heads.chain(["0", "1", "2", "faults"]);
    let mut out = format!(
        "{:<24}{}\n",
        "",
        heads.map(|h| format!("{h:>8}")).collect::<String>()
    );
    for (what, counts) in rows.into_iter().chain([("all", sums)]) {
        let cells: String = counts.iter().map(|n| format!("{n:>8}")).collect();
        out += &format!("{what:<24}{cells}\n");
    }
    out
}

#[test]
fn mutants_are_taken_or_refused() {
    let count = asked("PERIDYNE_MUTANTS", 2000) as usize;
    let first = asked("PERIDYNE_SEED", 1);
    let room = tempfile::tempdir().unwrap();
    let said = room.path().join("said");
    let seeds = seeds::seeds(|arguments, folder| good(arguments, folder, &said));
    for seed in &seeds {
        // what is not changed is taken
        let folder = room.path().join(&seed.format);
        seed.write(&folder);
        good(&seed.arguments, &folder, &said);
    }
    let (next, all) = (AtomicUsize::new(0), Mutex::new(vec![]));
    std::thread::scope(|scope| {
        for worker in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            let room = room.path().join(format!("worker {worker}"));
            std::fs::create_dir(&room).unwrap();
            let (seeds, next, all) = (&seeds, &next, &all);
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        break;
                    }
                    let tried = attempt(seeds, number, first, &room);
                    all.lock().unwrap().push(tried);
                }
            });
        }
    });
    let all = all.into_inner().unwrap();
    println!("{}", table(&all));
    let faults: Vec<&String> = all
        .iter()
        .filter_map(|t| t.verdict.as_ref().err())
        .collect();
    assert!(faults.is_empty(), "{} faults\n{faults:#?}", faults.len());
    // mutants that are all refused at once would try nothing but the first line of a reader
    let taken = all.iter().filter(|t| t.verdict == Ok(0)).count();
    assert!(
        taken * 20 > count && taken * 20 < count * 19,
        "{taken} of {count} taken"
    );
}

#[test]
fn faults_are_seen() {
    let dir = tempfile::tempdir().unwrap();
    let verdict = |script: &str| {
        let arguments = ["-c".to_string(), script.to_string()];
        judge::run("/bin/sh", &arguments, dir.path(), &dir.path().join("said"))
    };
    assert_eq!(verdict("echo fine; exit 1"), Ok(1));
    for (script, part) in [
        ("echo broken; exit 101", "panics: broken"),
        ("kill -ABRT $$", "ends by signal: 6"),
        ("exit 139", "ends by exit status: 139"),
        ("sleep 60", "goes on"),
        ("printf '\\033[31mred'", "prints"),
        ("exit 2", "in silence"),
        ("seq 1000; exit 2", "in 1000 lines"),
    ] {
        let why = verdict(script).expect_err(script);
        assert!(why.contains(part), "{script}: {why}");
    }
}
