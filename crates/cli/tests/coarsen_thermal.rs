//! `peridyne coarsen --average`: a crystal at a temperature, as a user has it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/warm_crystal.toml")
}

fn peridyne(arguments: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

fn path(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn words(output: &Output) -> String {
    let both = [&output.stdout, &output.stderr].map(|t| String::from_utf8_lossy(t).into_owned());
    both.concat()
}

/// Runs the deck, and gives its frames.
fn frames(folder: &Path, set: &[&str]) -> PathBuf {
    let deck = deck();
    let mut arguments = vec!["run", path(&deck)];
    for set in set {
        arguments.extend(["--set", set]);
    }
    let done = peridyne(&arguments, folder);
    assert_eq!(done.status.code(), Some(0), "{}", words(&done));
    folder.join("warm.extxyz")
}

/// A crystal that is soon done: 256 atoms.
const SMALL: [&str; 3] = ["body.cells=[4,4,4]", "output.every=40", "run.steps=2000"];

fn json(file: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

/// C11, C12, C44 and their standard errors.
fn constants(report: &serde_json::Value) -> [[f64; 2]; 3] {
    let elastic = &report["elastic_constants"];
    let error = |v: usize, w: usize| elastic["standard_error"][v][w].as_f64().unwrap();
    let value = |name: &str| elastic["cubic"][name].as_f64().unwrap();
    [
        [value("c11"), error(0, 0)],
        [value("c12"), error(0, 1)],
        [value("c44"), error(3, 3)],
    ]
}

/// Stress against strain of the same crystal at kT = 0.1 by LAMMPS (difference quotients at strains of ±0.005, 1500 units of time each, Langevin's
/// thermostat), with standard errors.
const STRESS_STRAIN: [[f64; 2]; 3] = [[72.98, 0.12], [40.77, 0.10], [42.53, 0.05]];

#[test]
fn a_warm_crystal_is_as_stiff_as_its_stress_against_strain_says() {
    let dir = tempfile::tempdir().unwrap();
    let frames = frames(&dir.path().join("run"), &[]);
    let out = dir.path().join("out");
    let deck = deck();
    let done = peridyne(
        &[
            "coarsen",
            path(&deck),
            "--average",
            path(&frames),
            "--average-skip",
            "10",
            "--every",
            "2",
            "--radius",
            "5",
        ],
        &out,
    );
    let told = words(&done);
    assert_eq!(done.status.code(), Some(0), "{told}");
    assert!(told.contains("thermal force states of 41 frames"), "{told}");
    let report = json(&out.join("thermal.json"));
    let number = |name: &str| report[name].as_f64().unwrap();
    let [v, e] = ["temperature_by_velocities", "temperature_by_equipartition"].map(number);
    // 41 frames of 6141 degrees of freedom: below a percent; half of the deck's temperature is left up to anharmonic parts
    assert!((v / e - 1.0).abs() < 0.03, "{v} {e}");
    assert!((v / 0.1 - 1.0).abs() < 0.06, "{v}");
    for ([found, error], [expected, own]) in constants(&report).into_iter().zip(STRESS_STRAIN) {
        // the run is at its own energy, so that its temperature is some percent off: constants change by 1 % for 10 % of it
        let allowed = 4.0 * f64::hypot(error, own) + 0.01 * expected;
        // a bound from after a first run: C12 has 2.3 %
        assert!(error > 0.0 && error < 0.04 * expected, "{error} {expected}");
        assert!(
            (found - expected).abs() < allowed,
            "{found} {expected} {allowed}"
        );
    }
    // what is left over is a level like any other
    let level = json(&out.join("level1.json"));
    assert_eq!(level["points"], 256);
    assert_eq!(level["checked_positive_semidefinite"], true);
    let run = peridyne(
        &["run", path(&out.join("level1.toml"))],
        &dir.path().join("level1"),
    );
    assert_eq!(run.status.code(), Some(0), "{}", words(&run));
}

/// A run at a temperature of nearly nothing: constants are those of the Hessian that `peridyne coarsen` takes otherwise. Displacements
/// are some 1e-6 spacings, so that forces of second order are below 1e-4 of all, and at random in the fit.
#[test]
fn a_cold_crystal_has_the_hessian() {
    let dir = tempfile::tempdir().unwrap();
    let frames = frames(
        &dir.path().join("run"),
        &[&SMALL[..], &["initial_velocities.temperature=1e-10"]].concat(),
    );
    let deck = deck();
    let text = std::fs::read_to_string(&deck).unwrap();
    let cells = [("body.cells".to_string(), "[4,4,4]".to_string())];
    let spec = peridyne_io::deck::Deck::parse(&text, "warm_crystal.toml", &cells)
        .unwrap()
        .spec;
    let exact = peridyne_theory::lattice_dynamics::lattice_dynamics(&spec, 1e-3, 4).unwrap();
    let exact = exact.stress_strain.unwrap().cubic(1e-6).unwrap();
    let mut dumps = vec![];
    for symmetry in ["lattice", "none"] {
        let out = dir.path().join(symmetry);
        let done = peridyne(
            &[
                "coarsen",
                path(&deck),
                "--average",
                path(&frames),
                "--average-symmetry",
                symmetry,
                // what the Hessian has
                "--average-radius",
                "2.5",
                "--every",
                "2",
                "--set",
                SMALL[0],
            ],
            &out,
        );
        assert_eq!(done.status.code(), Some(0), "{}", words(&done));
        let report = json(&out.join("thermal.json"));
        assert!(
            report["unexplained_force"].as_f64().unwrap() < 1e-4,
            "{report}"
        );
        let found = constants(&report);
        for ([c, _], exact) in found.iter().zip([exact.c11, exact.c12, exact.c44]) {
            assert!((c / exact - 1.0).abs() < 1e-4, "{c} {exact}");
        }
        dumps.push(found);
    }
    assert_ne!(dumps[0], dumps[1]);
}

#[test]
fn frames_that_do_not_fit_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let short = frames(
        &dir.path().join("run"),
        &[SMALL[0], SMALL[1], "run.steps=80"],
    );
    let melting = frames(
        &dir.path().join("hot"),
        &[
            SMALL[0],
            SMALL[1],
            "run.steps=400",
            "initial_velocities.temperature=8",
        ],
    );
    let warm = deck();
    let good = |name: &str| warm.with_file_name(name);
    let out = dir.path().join("out");
    for (deck, frames, more, expected) in [
        (
            &warm,
            &short,
            vec!["--average-radius", "3.2"],
            "do not fit into a period of 6.28",
        ),
        (
            &warm,
            &short,
            vec!["--average-radius", "0"],
            "must be a positive number",
        ),
        (
            &warm,
            &short,
            vec!["--average-radius", "0.5"],
            "no two atoms are within",
        ),
        (&warm, &short, vec!["--average-skip", "9"], "has 3 frames"),
        (
            &warm,
            &short,
            vec!["--average-skip", "2"],
            "1 of the frames are taken, too few",
        ),
        (
            &warm,
            &short,
            vec!["--average-symmetry", "cubic"],
            "expected lattice or none",
        ),
        (
            &warm,
            &short,
            vec!["--set", "body.spacing=1.58"],
            "give the deck the lattice spacing of the run",
        ),
        (
            &warm,
            &short,
            vec!["--set", "body.cells=[4,4,5]"],
            "it has 256 atoms",
        ),
        (
            &warm,
            &short,
            vec!["--set", "body.origin=[0.39,0.39,0.39]"],
            "at no site of",
        ),
        (&warm, &melting, vec![], "has left its site"),
        (
            &good("fibre_plate.toml"),
            &short,
            vec![],
            "has no potential: leave it out",
        ),
        (
            &warm,
            &good("warm_crystal.toml"),
            vec![],
            "no file of atoms",
        ),
    ] {
        let mut arguments = vec![
            "coarsen",
            path(deck),
            "--average",
            path(frames),
            "--every",
            "2",
        ];
        if *deck == warm && !more.iter().any(|m| m.starts_with("body.cells")) {
            arguments.extend(["--set", SMALL[0]]);
        }
        arguments.extend(more.iter().copied());
        let done = peridyne(&arguments, &out);
        let told = words(&done);
        assert_eq!(done.status.code(), Some(2), "{told}");
        // lines are broken, with a bar before them
        let all = told.split_whitespace().filter(|word| *word != "│");
        let flat = all.collect::<Vec<_>>().join(" ");
        assert!(flat.contains(expected), "{expected}: {told}");
        assert!(!out.exists());
    }
    // flags of frames say nothing without
    let done = peridyne(
        &[
            "coarsen",
            path(&warm),
            "--every",
            "2",
            "--average-skip",
            "1",
        ],
        &out,
    );
    assert_eq!(done.status.code(), Some(2));
    assert!(
        words(&done).contains("--average <FRAMES>"),
        "{}",
        words(&done)
    );
}
