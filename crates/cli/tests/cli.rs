//! The program as a user runs it: exit codes, what is written, what is not.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks")
        .join(name)
}

fn peridyne(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap()
}

/// `peridyne run DECK --out OUT …`
fn run(deck: &Path, out: &Path, more: &[&str]) -> Output {
    let mut arguments = vec![
        "run",
        deck.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ];
    arguments.extend(more);
    peridyne(&arguments)
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn good(output: Output) -> Output {
    assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
    output
}

fn report(out: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(out.join("run.json")).unwrap()).unwrap()
}

/// A block that flies apart as soon as its step is too long.
const BLOCK: &str = r#"horizon = { m_ratio = 3 }
contact = false
[body]
lattice = "cubic"
spacing = "1 mm"
cells = [10, 10, 10]
[material]
density = "2200 kg/m^3"
law = { pmb = { bulk = "14.9 GPa" } }
[[initial]]
velocity = { x = "0.1*sin(1e6*y)" }
[run]
steps = 1000
time_step = "2 us"
force_unstable = true
[output]
history = 100000
picture = false
"#;

#[test]
fn wrong_input_exits_with_2_and_writes_nothing() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    for name in [
        "bad/unknown_key.toml",
        "bad/nan_in_file.toml",
        "bad/truncated_file.toml",
        "bad/build/step_above_limit.toml",
        "bad/build/overlapping_sets.toml",
        "good/no_such_deck.toml",
    ] {
        let output = run(&deck(name), &out, &[]);
        assert_eq!(output.status.code(), Some(2), "{name}: {}", errors(&output));
        assert!(!errors(&output).is_empty(), "{name} fails in silence");
        assert!(!out.exists(), "{name} left files");
        let output = peridyne(&["check", deck(name).to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2), "check {name}");
    }
    let impact = deck("good/ten_lines.toml");
    for more in [
        ["--threads", "0"],
        ["--simd", "sse9"],
        ["--set", "run.stepz=1"],
        ["--set", "run.steps"],
        ["--var", "a=1"],
    ] {
        let output = run(&impact, &out, &more);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        assert!(!out.exists(), "{more:?} left files");
    }
}

#[test]
fn an_error_names_file_and_line_and_shows_them() {
    let output = peridyne(&[
        "check",
        deck("bad/build/step_above_limit.toml").to_str().unwrap(),
    ]);
    let text = errors(&output);
    for part in [
        "step_above_limit.toml",
        "time_step = \"1 ms\"",
        "above the stability limit",
        "write time_step",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn what_cannot_be_written_exits_with_1() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("file");
    std::fs::write(&file, "in the way").unwrap();
    let crack = deck("good/minimal_crack.toml");
    let more = ["--set", "run.duration=1 us"];
    for out in [
        file.as_path(),
        &file.join("below"),
        Path::new("/dev/full/x"),
    ] {
        let output = run(&crack, out, &more);
        assert_eq!(output.status.code(), Some(1), "{}", out.display());
        assert!(
            errors(&output).contains("cannot create"),
            "{}: {}",
            out.display(),
            errors(&output)
        );
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "in the way");
}

#[test]
fn ten_lines_make_all_results() {
    let dir = TempDir::new().unwrap();
    let output = good(run(
        &deck("good/ten_lines.toml"),
        dir.path(),
        &["--set", "run.steps=20"],
    ));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains("done: 20 steps"), "{text}");
    let report = report(dir.path());
    for key in [
        "version",
        "deck_hash",
        "particles",
        "bonds",
        "steps",
        "time_step",
        "seconds_stepping",
        "seconds",
        "ns_per_bond_step",
        "peak_memory_bytes",
        "broken_bonds",
        "fragments",
        "state_hash",
        "ledger_hash",
        "threads",
    ] {
        assert!(!report[key].is_null(), "run.json has no {key}");
    }
    let [state, ledger] = ["state_hash", "ledger_hash"].map(|key| report[key].as_str().unwrap());
    let said = format!("state     {state} ledger {ledger}");
    assert_eq!(text.lines().last(), Some(&*said));
    assert_eq!(report["status"], "done");
    assert_eq!(report["particles"], 86_000);
    assert_eq!(report["steps"], 20);
    assert_eq!(report["time_step"], 1e-7);
    assert!(["portable", "avx2", "avx512"].contains(&report["simd"].as_str().unwrap()));
    for key in [
        "kinetic",
        "strain",
        "contact",
        "dissipated_by_breakage",
        "work_boundary_conditions",
        "work_rigid_bodies",
        "balance_error",
    ] {
        assert!(report["energy"][key].is_number(), "no energy.{key}");
    }
    let pvd = std::fs::read_to_string(dir.path().join("points.pvd")).unwrap();
    for frame in ["points_00000000.vtu", "points_00000020.vtu"] {
        assert!(
            pvd.contains(frame) && dir.path().join(frame).exists(),
            "{frame}"
        );
    }
    let history = std::fs::read_to_string(dir.path().join("history.csv")).unwrap();
    assert!(history.lines().count() > 20, "{history}");
    let picture = std::fs::read(dir.path().join("velocity.png")).unwrap();
    assert_eq!(&picture[..4], b"\x89PNG");
}

#[test]
fn threads_do_not_change_a_byte() {
    let small = "body.spacing=1.25 mm";
    let frame = |threads: &str| {
        let dir = TempDir::new().unwrap();
        let more = [
            "--threads",
            threads,
            "--set",
            small,
            "--set",
            "run.steps=60",
            "--set",
            "output.bonds=true",
        ];
        good(run(&deck("good/ten_lines.toml"), dir.path(), &more));
        assert_eq!(report(dir.path())["threads"].to_string(), threads);
        ["points_00000060.vtu", "bonds_00000060.vtu", "history.csv"]
            .map(|f| std::fs::read(dir.path().join(f)).unwrap_or_else(|e| panic!("{f}: {e}")))
    };
    let (one, two) = (frame("1"), frame("2"));
    for (a, b) in one.iter().zip(&two) {
        assert!(a == b);
    }
}

#[test]
fn an_unstable_run_stops_with_1_and_keeps_its_last_good_state() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("block.toml");
    std::fs::write(&file, BLOCK).unwrap();
    let end = |name: &str, more: &[&str]| {
        let out = dir.path().join(name);
        let output = run(&file, &out, more);
        let text = errors(&output);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(text.contains("step ") && text.contains("point "), "{text}");
        let report = report(&out);
        let steps = report["steps"].as_u64().unwrap();
        assert!(steps > 0 && steps < 1000, "{steps}");
        let status = report["status"].as_str().unwrap();
        assert!(status.starts_with("stopped: "));
        let last = format!("points_{steps:08}.vtu");
        let pvd = std::fs::read_to_string(out.join("points.pvd")).unwrap();
        assert!(pvd.contains(&last), "{pvd}");
        let last = std::fs::read(out.join(last)).unwrap();
        (
            steps,
            status.to_string(),
            report["state_hash"].clone(),
            last,
        )
    };
    let one = end("out", &[]);
    // and all ranks that share it do
    assert!(one == end("shared", &["--on-threads", "3"]));
}

#[test]
fn what_ranks_cannot_share_is_told_once_and_writes_nothing() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("block.toml");
    let out = dir.path().join("out");
    let refused = |text: &str, more: &[&str], why: &str| {
        std::fs::write(&file, text).unwrap();
        let output = run(&file, &out, &[&["--on-threads", "2"], more].concat());
        let said = errors(&output).replace("\n  │ ", " ");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(said.matches(why).count(), 1, "{why}: {said}");
        assert!(!out.exists() && output.stdout.is_empty());
    };
    refused(
        &BLOCK.replace("m_ratio", "m_raito"),
        &[],
        "did you mean `m_ratio`?",
    );
    refused(BLOCK, &["--threads", "0"], "at least one thread must run");
    // where one rank has its points
    let nowhere = r#"initial=[{ velocity = { x = "1 mm^2/s / max(z - 4 mm, 0 mm)" } }]"#;
    refused(BLOCK, &["--set", nowhere], "is inf at");
    // scripts: without a run, wrong before it, and wrong in it on all ranks
    let script = dir.path().join("in.block");
    let block = "units si\nboundary s s s\natom_style peri\natom_modify map array\nlattice sc 1\nregion b block 0 9 0 9 0 9 units box\ncreate_box 1 b\ncreate_atoms 1 region b\npair_style peri/pmb\n";
    for (text, code, said) in [
        ("units si\n".to_string(), 0, ""),
        (
            "units si\nregoin b block 0 1 0 1 0 1\n".to_string(),
            2,
            "regoin",
        ),
        (
            format!("{block}pair_coeff * * 1 0.5 1 0\nrun 1\n"),
            2,
            "horizon",
        ),
    ] {
        std::fs::write(&script, text).unwrap();
        let output = run(&script, &out, &["--on-threads", "3"]);
        assert_eq!(output.status.code(), Some(code), "{}", errors(&output));
        assert!(errors(&output).contains(said), "{}", errors(&output));
    }
    // a state goes on with any number of them
    std::fs::write(&file, BLOCK).unwrap();
    let more = [
        "--set",
        "run.time_step=\"1 ns\"",
        "--stop-after",
        "3",
        "--on-threads",
        "2",
    ];
    good(run(&file, &out, &more));
    good(peridyne(&["resume", out.to_str().unwrap()]));
}

#[test]
fn a_plan_is_of_what_a_step_costs_and_how_the_body_is_cut() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("block.toml");
    // whole layers of 256 cells: a part of four of them has copies of three on either side
    let layers = BLOCK.replace("[10, 10, 10]", "[16, 16, 32]");
    std::fs::write(&file, layers.replace("2 us", "0.2 us")).unwrap();
    let file = file.to_str().unwrap();
    let asked = [
        "--nodes",
        "1,2,8,40",
        "--cores",
        "8",
        "--steps",
        "3",
        "--threads",
        "1",
    ];
    let words = [&["plan", file, "--json"][..], &asked].concat();
    let found: Value = serde_json::from_slice(&good(peridyne(&words)).stdout).unwrap();
    let nodes = found["nodes"].as_array().unwrap();
    let of = |key: &str| -> Vec<u64> { nodes.iter().map(|n| n[key].as_u64().unwrap()).collect() };
    assert_eq!(of("points"), [8192, 4096, 1024, 256]);
    assert_eq!(of("idle"), [0, 0, 0, 8]);
    // rows of cells have guards on their ends, so that a layer is more than 256 cells
    let copies = of("copies");
    assert!(
        copies[0] == 0 && copies[1] >= 3 * 256 && copies[1] < 4 * 256,
        "{copies:?}"
    );
    assert!(copies[2] >= 6 * 256 && copies[2] < 8 * 256, "{copies:?}");
    // displacements and velocities are told once in a step, in one message, and how far the fastest point went
    assert_eq!(found["messages"], 1.0);
    assert_eq!(found["bytes_per_copy"], 48.0);
    assert_eq!(found["rounds"], 1.0);
    // nobody waits for them who has points inside
    let meanwhile = &found["meanwhile"];
    assert_eq!(meanwhile["messages"], 1.0);
    assert_eq!(meanwhile["bytes_per_copy"], 48.0);
    let part = meanwhile["part"].as_f64().unwrap();
    assert!(part > 0.0 && part <= 1.0, "{part}");
    let number = |n: usize, key: &str| nodes[n][key].as_f64().unwrap();
    let step = found["seconds_per_step"].as_f64().unwrap();
    assert!((number(0, "seconds_per_step") / (step / 8.0) - 1.0).abs() < 1e-12);
    assert!((number(0, "efficiency") - 1.0).abs() < 1e-12);
    assert!(number(3, "efficiency") < number(2, "efficiency"));
    assert!(number(2, "bytes") < number(1, "bytes") && number(1, "bytes") < number(0, "bytes"));
    for (wrong, why) in [
        ("--nodes=0", "at least one machine"),
        ("--cores=0", "one core"),
        ("--bandwidth=0", "more than 0"),
    ] {
        let output = peridyne(&["plan", file, wrong]);
        assert_eq!(output.status.code(), Some(2));
        assert!(errors(&output).contains(why), "{wrong}");
    }
    // a matrix is on one of the ranks
    let bar = deck("good/tent_bar.toml");
    let output = peridyne(&["plan", bar.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(errors(&output).contains("equations are solved on the first rank"));
}

#[test]
fn check_finds_the_moduli_that_were_asked_for() {
    let path = deck("good/periodic_wave.toml");
    let output = good(peridyne(&["check", path.to_str().unwrap(), "--json"]));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["particles"], 8000);
    let bulk = &found["materials"][0]["places"][0];
    assert_eq!(bulk["place"], "bulk");
    assert_eq!(bulk["points"], 8000);
    // the dilatation of a linear peridynamic solid is exact, its shear modulus calibrated
    let off = |key: &str, value: f64| (bulk[key].as_f64().unwrap() / value - 1.0).abs();
    assert!(off("bulk", 14.9e9) < 1e-5, "{bulk}");
    assert!(off("shear", 6e9) < 0.01, "{bulk}");
    let c = &bulk["stiffness"];
    assert!((c[0][1].as_f64().unwrap() / c[1][2].as_f64().unwrap() - 1.0).abs() < 1e-9);
}

#[test]
fn check_reads_well() {
    let path = deck("good/kalthoff.toml");
    let output = good(peridyne(&["check", path.to_str().unwrap()]));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    for part in [
        "20,000",
        "3.0000 spacings of 1 mm",
        "pre-cracks cut",
        "target          191.00",
        "% of the stability limit",
        "22200 J/m^2 (asked)",
        "steps/s",
        "No warnings",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

#[test]
fn check_warns_with_the_fix() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("odd.toml");
    let odd = BLOCK
        .replace("m_ratio = 3", "m_ratio = 2")
        .replace("[10, 10, 10]", "[10, 10, 1]")
        .replace("14.9 GPa", "14.9e9 GPa")
        .replace(
            "[[initial]]",
            "fracture = { critical_stretch = \"20 %\" }\n[[initial]]",
        )
        .replace("2 us", "1e-15 s");
    std::fs::write(&file, odd).unwrap();
    let output = good(peridyne(&["check", file.to_str().unwrap(), "--json"]));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let warnings = found["warnings"].to_string();
    for part in [
        "2.00 spacings",
        "thinner",
        "no point of `material` has a full family",
        "faster than in any solid",
        "beyond 5 %",
        "of the stability limit",
    ] {
        assert!(warnings.contains(part), "{part} is not in\n{warnings}");
    }
    for warning in found["warnings"].as_array().unwrap() {
        // those of the deck say it themselves, with their line
        let of_deck = warning["what"].as_str().unwrap().contains("odd.toml:");
        assert!(warning["fix"].is_string() != of_deck, "{warning}");
    }
}

#[test]
fn check_takes_a_script_as_it_stands_at_its_first_run() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../verify/lammps/cases");
    let path = cases.join("in.types_pull_pmb");
    let output = good(peridyne(&["check", path.to_str().unwrap(), "--json"]));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["particles"], 432);
    assert_eq!(found["steps"], 70);
    assert_eq!(found["bonds"], 15452);
    assert_eq!(found["materials"][1]["name"], "3");
    assert_eq!(found["materials"][1]["critical_stretch"], 0.012);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(notes.contains("`atom_modify` has no effect"), "{notes}");
    assert!(!Path::new("types_pull_pmb.dump").exists());

    let dir = TempDir::new().unwrap();
    let file = dir.path().join("in.nothing");
    std::fs::write(&file, "units si\natom_style peri\n").unwrap();
    let output = peridyne(&["check", file.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("the script has no `run`"), "{said}");
}

/// A plate with a hole of points: `output.dump` of points has the given name and one file, periodic axes their periods.
#[test]
fn dumps_of_points_have_their_name_and_box() {
    let dir = TempDir::new().unwrap();
    let sets = ["--set", "run.steps=2", "--set", "output.every=1"];
    let more = [
        "--set",
        "output.dump=wave.dump",
        "--set",
        "output.vtu=false",
    ];
    good(run(
        &deck("good/periodic_wave.toml"),
        dir.path(),
        &[&sets[..], &more[..]].concat(),
    ));
    let text = std::fs::read_to_string(dir.path().join("wave.dump")).unwrap();
    assert_eq!(
        text.matches("ITEM: BOX BOUNDS pp pp pp\n0.0 0.02\n")
            .count(),
        3,
        "{}",
        &text[..200]
    );
}

#[test]
fn what_is_no_deck_and_what_looks_wrong_is_said() {
    let dir = TempDir::new().unwrap();
    for (file, message) in [
        (
            "good/plate.msh",
            "this is a mesh of gmsh, not a deck or script; write a deck (.toml) beside it, with body = { file = \"plate.msh\" }",
        ),
        ("good/groups.inp", "this is a mesh of Abaqus"),
        ("good/liquid.lammpstrj", "this is a LAMMPS dump"),
    ] {
        for verb in ["run", "check"] {
            let output = peridyne(&[verb, deck(file).to_str().unwrap()]);
            assert_eq!(output.status.code(), Some(2));
            let text = errors(&output).replace("\n  │ ", " ");
            let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(text.contains(message), "{text}");
        }
    }
    let text = "horizon = { m_ratio = 2 }\n[body]\nlattice = \"chain\"\nspacing = \"1 mm\"\ncells = [10]\n\
        [material]\ndensity = \"1 g/cm^3\"\nlaw = { pmb = { young = \"1 GPa\" } }\n[[precrack]]\npoint = \"4.5 mm\"\n[run]\nduration = \"300\"\nthreads = 200\n";
    let file = dir.path().join("slow.toml");
    std::fs::write(&file, text).unwrap();
    let output = good(peridyne(&["check", file.to_str().unwrap()]));
    let said = errors(&output);
    for part in [
        "warning: 200 threads on",
        "slow.toml:9: this crack never grows, as no material can break",
        "check the unit of run.duration",
        "slow.toml:12: \"300\" has no unit and is taken as 300 s",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    let file = dir.path().join("deck.txt");
    std::fs::write(&file, text).unwrap();
    let output = peridyne(&["run", file.to_str().unwrap()]);
    assert!(
        errors(&output).contains("name it .toml"),
        "{}",
        errors(&output)
    );
}

/// The folder of the results is relative to the deck.
#[test]
fn the_output_folder_lies_beside_the_deck() {
    let dir = TempDir::new().unwrap();
    let text = std::fs::read_to_string(deck("good/reduced_units.toml")).unwrap()
        + "[output]\ndir = \"results\"\n";
    let file = dir.path().join("deck.toml");
    std::fs::write(&file, text.replace("steps = 1000", "steps = 300")).unwrap();
    good(peridyne(&["run", file.to_str().unwrap()]));
    let history = std::fs::read_to_string(dir.path().join("results/history.csv")).unwrap();
    // a hundredth of the run between rows, both ends, and the header
    assert_eq!(history.lines().count(), 1 + 101, "{history}");
}

/// Everything that the schema names is there.
#[test]
fn laws_are_complete() {
    let said = String::from_utf8(good(peridyne(&["laws"])).stdout).unwrap();
    let words: Vec<&str> = said
        .split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .collect();
    for name in [
        "pmb",
        "lps",
        "lps_3d",
        "eam_like",
        "springs",
        "micromoduli",
        "lennard_jones",
        "morse",
        "buckingham",
        "eam",
        "eam_form",
        "truncated",
        "shifted_force",
        "smooth_from",
        "constant",
        "linear",
        "cubic_spline",
        "harmonic",
        "arithmetic",
        "minimum",
        "exact",
        "volume",
        "energy",
        "force",
        "critical_stretch",
        "alpha",
        "discrete",
        "stencil",
        "neighbours",
        "half_space",
        "difference",
        "newton",
        "relaxation",
        "cg",
        "broken",
        "dilatation",
        "fragment",
        "chain",
        "triangular",
        "diamond",
        "young",
        "dispersion",
        "length_scale",
    ] {
        assert!(words.contains(&name), "{name} is not in\n{said}");
    }
}

#[test]
fn scripts_write_where_they_may_and_checks_nowhere() {
    let dir = TempDir::new().unwrap();
    let script = |file: &str| {
        format!(
            "units si\nboundary f f f\natom_style peri\nlattice sc 0.5\nregion b block -4 4 -4 4 -4 4\ncreate_box 1 b\n\
             region c block 0 2 0 2 0 2\ncreate_atoms 1 region c\npair_style peri/pmb\npair_coeff * * 1.0 1.6 0.5 0.25\n\
             fix 1 all nve\nlog run.log\nprint hello file {file}\nwrite_data a.data\nrun 1\n"
        )
    };
    let path = dir.path().join("in.writes");
    let files = |folder: &Path| -> Vec<String> {
        let names = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = names
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    };
    std::fs::write(&path, script("hello.txt")).unwrap();
    good(peridyne(&["check", path.to_str().unwrap()]));
    assert_eq!(files(dir.path()), ["in.writes"]);
    assert!(!Path::new("run.log").exists() && !Path::new("hello.txt").exists());

    let out = dir.path().join("results");
    good(run(&path, &out, &[]));
    for name in ["hello.txt", "run.log", "a.data", "run.json"] {
        assert!(out.join(name).exists(), "{name}: {:?}", files(&out));
    }
    let outside = TempDir::new().unwrap();
    let target = outside.path().join("hello.txt");
    std::fs::write(&path, script(target.to_str().unwrap())).unwrap();
    let refused = run(&path, &out, &[]);
    assert_eq!(refused.status.code(), Some(2));
    let said = errors(&refused).replace("\n  │ ", " ");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("lies outside the output folder"), "{said}");
    assert!(!target.exists());
    good(run(&path, &out, &["--allow-outside"]));
    assert!(target.exists());
}

/// A run goes on with what it left only: another deck, a changed or missing file, a damaged state are told, and nothing is lost.
#[test]
fn a_run_that_was_cut_off_goes_on_only_with_what_it_left() {
    let dir = TempDir::new().unwrap();
    let own = dir.path().join("deck.toml");
    let mesh = dir.path().join("plate.msh");
    std::fs::copy(deck("good/plate.msh"), &mesh).unwrap();
    let text = std::fs::read_to_string(deck("good/mesh_plate.toml")).unwrap();
    std::fs::write(&own, &text).unwrap();
    let out = dir.path().join("out");
    let to = out.to_str().unwrap();
    good(run(&own, &out, &["--stop-after", "40"]));
    assert_eq!(report(&out)["ended_by"], "--stop-after 40");
    let refused = |why: &str| {
        let output = peridyne(&["resume", to]);
        let said = errors(&output).replace("\n  │ ", " ");
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{why}: {said}");
    };
    // another deck; one that says the same otherwise, or that goes on longer, is none
    let other = text.replacen("2440 kg/m^3", "2300 kg/m^3", 1);
    assert_ne!(other, text);
    std::fs::write(&own, other).unwrap();
    refused("this is not the deck that the run began with");
    std::fs::write(&own, format!("# the same\n{text}")).unwrap();
    // another mesh
    let bytes = std::fs::read_to_string(&mesh).unwrap();
    std::fs::write(&mesh, format!("{bytes}\n")).unwrap();
    refused("this is not the file that the run began with");
    std::fs::write(&mesh, bytes).unwrap();
    // a file that is another, and one that is gone
    let history = out.join("history.csv");
    let rows = std::fs::read_to_string(&history).unwrap();
    std::fs::write(&history, rows.replacen('0', "1", 1)).unwrap();
    refused("it is not as the run left it");
    std::fs::write(&history, &rows).unwrap();
    let first = out.join("points_00000000.vtu");
    let frame = std::fs::read(&first).unwrap();
    std::fs::remove_file(&first).unwrap();
    refused("points_00000000.vtu");
    let mut bytes = frame.clone();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&first, bytes).unwrap();
    refused("points_00000000.vtu`: it is not as the run left it");
    std::fs::write(&first, frame).unwrap();
    // a state that is damaged
    let states = std::fs::read_dir(out.join("checkpoint")).unwrap();
    let state = states.map(|e| e.unwrap().path()).next().unwrap();
    let whole = std::fs::read(&state).unwrap();
    let mut bytes = whole.clone();
    bytes[whole.len() / 2] ^= 1;
    std::fs::write(&state, &bytes).unwrap();
    refused("is damaged");
    std::fs::write(&state, &whole[..whole.len() / 2]).unwrap();
    refused("ends too early");
    std::fs::write(&state, &whole).unwrap();
    good(peridyne(&["resume", to]));
    assert_eq!(report(&out)["status"], "done");
    let seconds = &report(&out)["seconds"];
    let parts: Vec<f64> = { seconds["parts"].as_array().unwrap().iter() }
        .map(|part| part.as_f64().unwrap())
        .collect();
    assert_eq!(parts.len(), 2);
    let all = seconds["all"].as_f64().unwrap();
    assert!(
        (parts.iter().sum::<f64>() - all).abs() < 1e-9 * all,
        "{seconds}"
    );
    refused("there is no state to go on from: the run is done");
}

/// A state that cannot be written is told, and the run goes on without.
#[cfg(unix)]
#[test]
fn a_state_that_cannot_be_written_costs_no_run() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("out");
    std::fs::create_dir(&out).unwrap();
    std::fs::write(out.join("checkpoint"), "a file of somebody").unwrap();
    let more = [
        "--set",
        "output.checkpoint.every=\"1e-9 s\"",
        "--set",
        "run.duration=2",
    ];
    let output = run(&deck("good/spring_chain.toml"), &out, &more);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains("no state to go on from was written"),
        "{said}"
    );
    let kept = std::fs::read_to_string(out.join("checkpoint")).unwrap();
    assert_eq!(kept, "a file of somebody");
}

/// Nothing in this deck depends on t: begun anew from a state it moves as it would have gone on, to the last bit.
#[test]
fn a_run_that_begins_anew_from_a_state_moves_as_the_one_before() {
    let dir = TempDir::new().unwrap();
    let chain = deck("good/spring_chain.toml");
    let every = ["--set", "output.history=1"];
    let energies = |out: &Path| -> Vec<String> {
        let text = std::fs::read_to_string(out.join("history.csv")).unwrap();
        let row = |line: &str| {
            line.split(',')
                .skip(2)
                .take(2)
                .collect::<Vec<_>>()
                .join(" ")
        };
        text.lines().skip(1).map(row).collect()
    };
    let [whole, part, anew] = ["whole", "part", "anew"].map(|name| dir.path().join(name));
    good(run(&chain, &whole, &every));
    good(run(
        &chain,
        &part,
        &[&every[..], &["--stop-after", "30"]].concat(),
    ));
    // its deck has no `output.history`: a row for each of so few steps anyway
    let [from, to] = [&part, &anew].map(|p| p.to_str().unwrap());
    let again = [
        "resume",
        from,
        "--as-initial",
        chain.to_str().unwrap(),
        "--out",
        to,
    ];
    good(peridyne(&again));
    let (before, after) = (energies(&whole), energies(&anew));
    let both = before.len() - 30;
    assert!(both > 20 && after.len() == before.len());
    assert_eq!(before[30..], after[..both]);
    // and a run that has no time ends at once
    let short = dir.path().join("short");
    good(run(&chain, &short, &["--for", "1e-9 s"]));
    assert_eq!(report(&short)["ended_by"], "--for 1e-9 s");
    assert_eq!(report(&short)["steps"], 0);
}
