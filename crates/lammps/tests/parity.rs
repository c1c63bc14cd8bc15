//! Scripts of `verify/lammps/cases`, unchanged, against the numbers that LAMMPS computed for them.

#[path = "boxes/mod.rs"]
mod boxes;

use std::path::{Path, PathBuf};

use peridyne_lammps::host::Console;
use peridyne_lammps::model::ModelHost;
use peridyne_lammps::{Options, run_file};

/// Lattice constants.
const POSITION: f64 = 1e-10;
const DAMAGE: f64 = 1e-14;
const COLUMNS: [&str; 6] = ["id", "x", "y", "z", "c_dmg", "c_dil"];
/// Relative, of energies and dilatations.
const RELATIVE: f64 = 1e-9;

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/cases")
}

#[derive(Default)]
struct Paper(Vec<String>);

impl Console for Paper {
    fn print(&mut self, line: &str) {
        self.0.extend(line.lines().map(str::to_string));
    }
    fn note(&mut self, line: &str) {
        self.0.push(format!("note: {line}"));
    }
}

fn numbers(line: &str) -> Option<Vec<f64>> {
    line.split_whitespace().map(|w| w.parse().ok()).collect()
}

/// Rows of numbers under each `step N`.
fn golden(text: &str) -> Vec<(u64, Vec<Vec<f64>>)> {
    let mut frames: Vec<(u64, Vec<Vec<f64>>)> = vec![];
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        match (line.strip_prefix("step "), frames.last_mut()) {
            (Some(step), _) => frames.push((step.parse().unwrap(), vec![])),
            (None, Some(frame)) => frame.1.push(numbers(line).unwrap()),
            (None, None) => panic!("no step before {line}"),
        }
    }
    frames
}

/// Frames of a LAMMPS dump: step, names of the columns, rows.
fn dump(text: &str) -> Vec<(u64, Vec<String>, Vec<Vec<f64>>)> {
    let mut frames = vec![];
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line == "ITEM: TIMESTEP" {
            let step = lines.next().unwrap().parse().unwrap();
            frames.push((step, vec![], vec![]));
        } else if let Some(names) = line.strip_prefix("ITEM: ATOMS ") {
            frames.last_mut().unwrap().1 = names.split_whitespace().map(str::to_string).collect();
        } else if let Some(frame) = frames.last_mut().filter(|f| !f.1.is_empty()) {
            frame.2.push(numbers(line).unwrap());
        }
    }
    frames
}

fn compare(name: &str) {
    let dir = cases();
    let script = std::fs::read_to_string(dir.join(format!("in.{name}"))).unwrap();
    let output = tempfile::tempdir().unwrap();
    let mut paper = Paper::default();
    let options = Options {
        output: output.path().into(),
        ..Options::default()
    };
    let path = dir.join(format!("in.{name}"));
    if let Err(e) = run_file(&path, &options, &mut ModelHost::default(), &mut paper) {
        panic!("{name}: {e} ({:?})\n{}", e.help, paper.0.join("\n"));
    }
    let lattice = lattice_constant(&script);
    let found = dump(&std::fs::read_to_string(output.path().join(format!("{name}.dump"))).unwrap());
    let expected = golden(&std::fs::read_to_string(dir.join(format!("{name}.golden"))).unwrap());
    assert!(expected.len() == 2 && !expected[1].1.is_empty(), "{name}");
    for (step, rows) in &expected {
        let Some((_, names, ours)) = found.iter().rfind(|f| f.0 == *step) else {
            panic!("{name}: no snapshot of step {step}");
        };
        assert_eq!(rows.len(), ours.len(), "{name}: number of points");
        let column = |n: &str| names.iter().position(|m| m == n);
        let of = |k: usize| rows.iter().filter_map(move |r| r.get(k).copied());
        let dilatation = of(5).fold(0.0, |m: f64, t| m.max(t.abs()));
        for (k, what) in COLUMNS.iter().copied().enumerate().take(rows[0].len()) {
            let at = column(what).unwrap_or_else(|| panic!("{name}: no {what} in {names:?}"));
            let off = || {
                of(k)
                    .zip(ours)
                    .map(|(theirs, ours)| (ours[at] - theirs).abs())
            };
            let worst = off().fold(0.0, f64::max);
            let limit = match k {
                0 => 0.0,
                1..=3 => POSITION * lattice,
                4 => DAMAGE,
                _ => RELATIVE * dilatation,
            };
            assert!(
                worst <= limit,
                "{name}: step {step}: {what} is off by {worst:e}, allowed {limit:e}"
            );
        }
    }
    energies(name, &paper.0);
}

/// The constant of the last `lattice` line, which may be a variable's formula.
fn lattice_constant(script: &str) -> f64 {
    let line = script.lines().rfind(|l| l.starts_with("lattice ")).unwrap();
    let word = line.split_whitespace().nth(2).unwrap();
    word.parse().unwrap_or_else(|_| {
        let variable = word.trim_matches(['$', '{', '}']);
        let line = script
            .lines()
            .find(|l| numbers_of(l, variable).is_some())
            .unwrap();
        numbers_of(line, variable).unwrap()
    })
}

fn numbers_of(line: &str, variable: &str) -> Option<f64> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words[..] {
        ["variable", name, "equal", value] if name == variable => value.parse().ok(),
        _ => None,
    }
}

/// Thermo lines of the last run.
fn energies(name: &str, lines: &[String]) {
    let start = lines
        .iter()
        .rposition(|l| l.trim_start().starts_with("Step "))
        .unwrap();
    let ours: Vec<Vec<f64>> = lines[start + 1..]
        .iter()
        .map_while(|l| numbers(l))
        .collect();
    let text = std::fs::read_to_string(cases().join(format!("{name}.thermo"))).unwrap();
    let head = text.lines().rfind(|l| l.starts_with("# step")).unwrap();
    let head: Vec<&str> = head.split_whitespace().skip(1).collect();
    let theirs: Vec<Vec<f64>> = text.lines().filter_map(numbers).collect();
    assert!(theirs.len() > 5, "{name}: {} thermo lines", theirs.len());
    assert_eq!(theirs.len(), ours.len(), "{name}: thermo lines: {lines:?}");
    // the largest number stands for none and is no measure
    let there = |x: &f64| *x != f64::MAX;
    let greatest = |k: usize| {
        let column = theirs.iter().map(|r| r[k].abs()).filter(there);
        column.fold(0.0, f64::max)
    };
    let is_pressure = |what: &str| what.starts_with('p') && what != "pe" || what.contains("press");
    let pressures = |row: &[f64]| {
        let columns = row.iter().zip(&head).filter(|(_, h)| is_pressure(h));
        columns.fold(0.0, |m: f64, (x, _)| m.max(x.abs()))
    };
    for (ours, theirs) in ours.iter().zip(&theirs) {
        assert_eq!(ours[0], theirs[0], "{name}: step");
        for (k, what) in head.iter().enumerate().skip(1) {
            let (a, b) = (ours[k], theirs[k]);
            let slack = RELATIVE
                * match is_pressure(what) {
                    // at rest a pressure is far smaller: each row is its own measure
                    true => pressures(theirs),
                    false => greatest(k),
                };
            assert!(
                (a - b).abs() <= slack || a == b,
                "{name}: step {}: {what} is {a:e}, LAMMPS has {b:e}",
                ours[0]
            );
        }
    }
}

macro_rules! parity {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            compare(stringify!($name));
        })*

        /// A case that nobody runs proves nothing.
        #[test]
        fn every_case_is_run() {
            let mut known = vec![$(stringify!($name)),*];
            known.sort_unstable();
            let mut there: Vec<String> = std::fs::read_dir(cases())
                .unwrap()
                .filter_map(|e| Some(e.unwrap().file_name().to_str()?.strip_prefix("in.")?.to_string()))
                .collect();
            there.sort();
            assert_eq!(there, known);
        }
    };
}

parity! {
    block_pmb_smooth block_pmb_displaced block_pmb_random
    block_lps_smooth block_lps_displaced block_lps_random
    cloud_pmb_smooth cloud_pmb_break
    cloud_lps_smooth cloud_lps_displaced cloud_lps_break
    pull_pmb_a0 pull_pmb_a25 pull_lps_a0 pull_lps_a25
    collide_pmb indent_pmb indent_lps
    plate_pmb plate_lps periodic_pmb
    press_contact_pmb moved_pmb
    types_pull_pmb types_pull_lps types_collide_pmb types_apart_lps
    units_metal_pmb units_metal_lps units_real_pmb units_real_lps units_electron_pmb
    units_lj_lps units_cgs_pmb units_micro_lps units_nano_pmb
    crack_pmb crack_lps weak_pmb weak_lps across_pmb unlike_lps horizons_pmb horizons_lps touch_pmb
    sqrt2_pmb three_pmb shatter_pmb shatter_lps
    indent_lattice_pmb move_pmb velocity_pmb displace_pmb regions_pmb
    cube_ves cube_eps
    forces_pmb walls_pmb lost_pmb lost_lps stress_pmb random_pmb flat_pmb drag_lps
}
