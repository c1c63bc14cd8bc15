//! How a run ends that is not left alone: closed and full outputs, signals, a second run in its folder, SIGKILL.

use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Is there a picture? What it shows depends on what the run was about when it ended.
fn drawn(out: &Path) -> bool {
    let files = std::fs::read_dir(out).unwrap();
    let mut names = files.map(|f| f.unwrap().file_name());
    names.any(|n| n.to_string_lossy().ends_with(".png"))
}

/// A small block that goes on as long as it is let.
const BLOCK: &str = r#"horizon = { m_ratio = 3 }
[body]
lattice = "cubic"
spacing = "1 mm"
cells = [10, 10, 10]
[material]
density = "2200 kg/m^3"
law = { pmb = { bulk = "14.9 GPa" } }
[[initial]]
velocity = { x = "0.1*sin(1e3*y)" }
[run]
steps = 100000000
[output]
history = 100
"#;

/// The same as a script of LAMMPS.
const SCRIPT: &str = "units si
boundary s s s
atom_style peri
atom_modify map array
lattice sc 0.001
region box block 0 9 0 9 0 9
create_box 1 box
create_atoms 1 box
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0030001 0.1 0.25
set group all density 2200
set group all volume 1e-9
velocity all set 0.1 0 0 units box
thermo 20
fix F1 all nve
timestep 1e-7
run 100000000
";

fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_peridyne"));
    command.args(arguments);
    command
}

struct Case {
    dir: TempDir,
    file: PathBuf,
    out: PathBuf,
}

impl Case {
    fn new(name: &str, text: &str) -> Case {
        let dir = TempDir::new().unwrap();
        let file = dir.path().join(name);
        std::fs::write(&file, text).unwrap();
        let out = dir.path().join("out");
        Case { dir, file, out }
    }

    fn command(&self, more: &[&str]) -> Command {
        let mut command = program(&["run", self.file.to_str().unwrap()]);
        command.args(["--threads", "1", "--out", self.out.to_str().unwrap()]);
        command.args(more);
        command.current_dir(self.dir.path());
        command
    }

    /// Starts it and waits until it steps.
    fn stepping(&self) -> Child {
        let mut child = self
            .command(&[])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let begun =
            |line: &str| line.starts_with("running ") || line.trim_start().starts_with("40 ");
        if !lines.any(|line| begun(&line.unwrap())) {
            panic!("it never ran: {}", code(child).1);
        }
        // the rest is read so that no pipe fills
        std::thread::spawn(move || lines.for_each(drop));
        let until = Instant::now() + Duration::from_secs(60);
        let history = self.out.join("history.csv");
        let rows = || std::fs::read_to_string(&history).map_or(0, |t| t.lines().count());
        while self.file.extension().is_some_and(|e| e == "toml") && rows() < 3 {
            assert!(Instant::now() < until, "no step was done");
            std::thread::sleep(Duration::from_millis(10));
        }
        child
    }
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill")
        .args([format!("-{name}"), child.id().to_string()])
        .status();
    assert!(status.unwrap().success());
}

/// What a signal may take: a second where nothing else runs.
const HEARD: Duration = Duration::from_secs(5);

/// Waits until a run writes its history.
fn begun(case: &Case, child: &mut Child) {
    let until = Instant::now() + Duration::from_secs(60);
    while !case.out.join("history.csv").exists() {
        assert!(Instant::now() < until, "it never began");
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn code(mut child: Child) -> (Option<i32>, String) {
    let mut errors = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut errors)
        .unwrap();
    (child.wait().unwrap().code(), errors)
}

fn report(out: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap()
}

fn temporaries(dir: &Path) -> usize {
    let names = std::fs::read_dir(dir).unwrap();
    names
        .filter(|e| {
            let name = e.as_ref().unwrap().file_name();
            name.to_string_lossy().starts_with(".peridyne-")
        })
        .count()
}

fn full() -> File {
    File::options().write(true).open("/dev/full").unwrap()
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_run_with_a_full_output_computes_everything_and_says_so() {
    for (name, text) in [("block.toml", BLOCK), ("in.block", SCRIPT)] {
        let case = Case::new(name, &text.replace("100000000", "20"));
        let output = case.command(&[]).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", errors(&output));
        assert!(
            errors(&output).contains("standard output"),
            "{}",
            errors(&output)
        );
        assert_eq!(report(&case.out)["status"], "done");
        assert_eq!(report(&case.out)["steps"], 20);
        assert!(drawn(&case.out));
    }
}

#[test]
fn a_run_whose_reader_leaves_computes_everything() {
    for (name, text) in [("block.toml", BLOCK), ("in.block", SCRIPT)] {
        let case = Case::new(name, &text.replace("100000000", "20"));
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = case.command(&[]).stdout(writer).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        assert_eq!(report(&case.out)["steps"], 20);
        assert!(drawn(&case.out));
    }
}

#[test]
fn every_verb_notices_that_its_output_is_lost() {
    let case = Case::new("block.toml", &BLOCK.replace("100000000", "20"));
    let deck = case.file.to_str().unwrap();
    for arguments in [
        &["laws"][..],
        &["schema"],
        &["--help"],
        &["--version"],
        &["check", deck],
        &["check", deck, "--json"],
        &["waves", deck],
        &["bar", "--m", "2", "--points", "11", "--ends", "half"],
    ] {
        let output = program(arguments)
            .current_dir(case.dir.path())
            .stdout(full())
            .output()
            .unwrap();
        assert_eq!(
            output.status.code(),
            Some(1),
            "{arguments:?}: {}",
            errors(&output)
        );
        assert!(errors(&output).contains("No space left"), "{arguments:?}");
    }
}

#[test]
fn a_lost_standard_error_hides_no_exit_code() {
    let case = Case::new("block.toml", &BLOCK.replace("m_ratio", "m_rati"));
    let output = case.command(&[]).stderr(full()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_signal_ends_a_run_with_its_last_state_written() {
    for (name, code_, by) in [("INT", 130, "SIGINT"), ("TERM", 143, "SIGTERM")] {
        for (file, text) in [("block.toml", BLOCK), ("in.block", SCRIPT)] {
            let case = Case::new(file, text);
            let child = case.stepping();
            signal(&child, name);
            let (found, errors) = code(child);
            assert_eq!(found, Some(code_), "{file} {name}: {errors}");
            let report = report(&case.out);
            assert_eq!(report["status"], "ended", "{file}");
            assert_eq!(report["ended_by"], by);
            let steps = report["steps"].as_u64().unwrap();
            assert!(steps > 0, "{file}");
            let last = format!("points_{steps:08}.vtu");
            assert!(case.out.join(&last).exists(), "{file}: {last}");
            assert!(drawn(&case.out));
            if file.ends_with("toml") {
                let history = std::fs::read_to_string(case.out.join("history.csv")).unwrap();
                let row = history.lines().last().unwrap();
                assert!(row.starts_with(&format!("{steps},")), "{row}");
            }
        }
    }
}

#[test]
fn a_second_run_is_locked_out_until_the_first_is_gone() {
    let case = Case::new("block.toml", BLOCK);
    let first = case.stepping();
    let second = case.command(&["--set", "run.steps=5"]).output().unwrap();
    let text = errors(&second);
    assert_eq!(second.status.code(), Some(1), "{text}");
    assert!(text.contains("another run writes there"), "{text}");
    assert!(text.contains("--out"), "{text}");
    // however it goes
    signal(&first, "KILL");
    code(first);
    let third = case.command(&["--set", "run.steps=5"]).output().unwrap();
    assert_eq!(third.status.code(), Some(0), "{}", errors(&third));
    assert_eq!(report(&case.out)["steps"], 5);
}

#[test]
fn temporaries_of_a_killed_run_are_swept_by_the_next() {
    // frames at every step: the kill most likely falls into the writing of one; few enough that a small disk takes them
    let case = Case::new(
        "block.toml",
        &BLOCK
            .replace("100000000", "2000")
            .replace("history = 100", "history = 5\nevery = 1"),
    );
    let first = case.stepping();
    signal(&first, "KILL");
    code(first);
    std::fs::write(case.out.join(".peridyne-Ab1Cd2"), "half a file").unwrap();
    assert!(temporaries(&case.out) >= 1);
    let next = case.command(&["--set", "run.steps=2"]).output().unwrap();
    assert_eq!(next.status.code(), Some(0), "{}", errors(&next));
    assert_eq!(temporaries(&case.out), 0);
}

const ATOMS: &str = r#"units = "lj"
periodic = ["x", "y", "z"]
[body]
lattice = "fcc"
spacing = 1.6
cells = [5, 5, 5]
[material]
mass = 1
law = { lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5 } }
[run]
steps = 2
time_step = 0.002
[output]
vtu = false
"#;

#[test]
fn a_deck_writes_inside_its_folder_unless_it_may_not() {
    for (key, name) in [
        ("data", "../last.data"),
        ("trajectory", "sub/../../frames.extxyz"),
        ("data", "/dev/shm/peridyne_last.data"),
        ("dir", "../elsewhere"),
        ("dir", "/dev/shm/peridyne_elsewhere"),
    ] {
        let case = Case::new("atoms.toml", &format!("{ATOMS}{key} = \"{name}\"\n"));
        for verb in ["run", "check"] {
            let output = program(&[verb, case.file.to_str().unwrap()])
                .current_dir(case.dir.path())
                .output()
                .unwrap();
            let text = errors(&output);
            assert_eq!(output.status.code(), Some(2), "{verb} {key} {name}: {text}");
            assert!(
                text.contains("--allow-outside") && text.contains(name),
                "{text}"
            );
        }
        assert_eq!(
            std::fs::read_dir(case.dir.path()).unwrap().count(),
            1,
            "{name}"
        );
    }
    let case = Case::new("atoms.toml", &format!("{ATOMS}data = \"../last.data\"\n"));
    let output = case.command(&["--allow-outside"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    assert!(case.dir.path().join("last.data").exists());
}

#[test]
fn check_writes_nothing() {
    for (name, text) in [("block.toml", BLOCK), ("in.block", SCRIPT)] {
        let case = Case::new(name, text);
        let output = program(&["check", case.file.to_str().unwrap()])
            .current_dir(case.dir.path())
            .env("TMPDIR", case.dir.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        assert_eq!(std::fs::read_dir(case.dir.path()).unwrap().count(), 1);
    }
}

/// A search for an equilibrium that never comes near enough ends, too, with the increment before.
#[test]
fn a_long_increment_of_statics_ends_when_asked() {
    let text = BLOCK
        .split("[[initial]]")
        .next()
        .map(|body| {
            format!(
                r#"{body}
[sets]
left.where = "x < 0.002"
[[boundary_condition]]
set = "left"
displacement = {{ x = 0, y = 0, z = 0 }}
[[boundary_condition]]
body_force = {{ x = "1e6*t" }}
[statics]
method = "relaxation"
tolerance = 1e-300
iterations = 1000000000
"#
            )
        })
        .unwrap();
    let case = Case::new("block.toml", &text);
    let mut child = case.command(&[]).stderr(Stdio::piped()).spawn().unwrap();
    begun(&case, &mut child);
    // the first increment is under way some time after its file
    std::thread::sleep(Duration::from_millis(500));
    signal(&child, "INT");
    let (code, errors) = code(child);
    assert_eq!(code, Some(130), "{errors}");
    let report = report(&case.out);
    assert_eq!(report["status"], "ended");
    assert_eq!(report["steps"], 0);
    assert!(drawn(&case.out));
}

/// Fields with a φ that reaches over many periods take long, and a frame of them ends, too; more than a day of them is not begun.
#[test]
fn a_long_frame_of_fields_ends_when_asked() {
    let deck = |width: &str| {
        format!(
            r#"units = "lj"
periodic = ["x", "y", "z"]
body = {{ lattice = "fcc", spacing = 1.6, cells = [3, 3, 3] }}
material = {{ mass = 1, law = {{ lennard_jones = {{ epsilon = 1, sigma = 1, cutoff = 1.5, end = "smooth" }} }} }}
run = {{ steps = 3, time_step = 0.001 }}
output = {{ vtu = false, picture = false, report = false }}
[[fields]]
kernel = "bspline"
width = {width}
grid = [12, 12, 12]
residuals = 0
every = 1
"#
        )
    };
    let case = Case::new("wide.toml", &deck("100"));
    let mut child = case.command(&[]).stderr(Stdio::piped()).spawn().unwrap();
    begun(&case, &mut child);
    std::thread::sleep(Duration::from_millis(500));
    signal(&child, "TERM");
    let asked = Instant::now();
    let (code, errors) = code(child);
    assert_eq!(code, Some(143), "{errors}");
    assert!(asked.elapsed() < HEARD, "{errors}");
    assert_eq!(report(&case.out)["status"], "ended");
    let case = Case::new("wider.toml", &deck("1e6"));
    for verb in ["run", "check"] {
        let begun = Instant::now();
        let output = program(&[verb, case.file.to_str().unwrap()])
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).replace("\n  │ ", " ");
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains("images of the cell"), "{errors}");
        assert!(begun.elapsed() < Duration::from_secs(10));
    }
}

/// A bar whose increments of load take minutes.
const SLOW: &str = r#"units = "none"
horizon = 3.1
influence = "constant"
partial_volume_correction = false
calibration = "continuum"
body = { lattice = "cubic", spacing = 1, cells = [14, 40, 9] }
[sets]
low.where = "y < 3"
high.where = "y > 36"
[material]
density = 8.0
law = { hypoelastic = { bulk = 1.5e12, shear = 6.9e11, increment = "end" } }
[[boundary_condition]]
set = "low"
displacement = { x = 0, y = 0, z = 0 }
[[boundary_condition]]
set = "high"
displacement = { x = 0, y = "0.01*t", z = 0 }
[statics]
method = "newton"
increments = 4
"#;

#[test]
fn check_says_what_it_knows_and_hears_signals() {
    use std::io::BufRead;
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("slow.toml");
    std::fs::write(&file, SLOW).unwrap();
    for (name, expected) in [("INT", 130), ("TERM", 143)] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .arg("check")
            .arg(&file)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let out = std::io::BufReader::new(child.stdout.take().unwrap());
        // the first lines are there before the trial
        let mut lines = out.lines().map_while(Result::ok);
        assert!(lines.any(|l| l.contains("family size")));
        signal(&child, name);
        let begin = Instant::now();
        let (found, errors) = code(child);
        assert_eq!(found, Some(expected), "{errors}");
        assert!(begin.elapsed() < HEARD, "{:?}", begin.elapsed());
    }
}
