//! Decks of conservation laws through the program: files, numbers in them, mistakes, signals.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

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

/// Numbers of a column of a CSV file.
fn column(path: &Path, name: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let place = lines.next().unwrap().split(',').position(|c| c == name);
    let place = place.unwrap_or_else(|| panic!("{name}: {text}"));
    lines
        .map(|l| l.split(',').nth(place).unwrap().parse().unwrap())
        .collect()
}

#[test]
fn a_run_writes_frames_history_pictures_and_a_report() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let file = deck("good/conservation/burgers_viscous.toml");
    let done = peridyne(&[
        "run",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--set",
        "points=256",
    ]);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    for name in [
        "frames.npz",
        "history.csv",
        "profiles.png",
        "space_time.png",
        "run.json",
    ] {
        assert!(out.join(name).metadata().unwrap().len() > 300, "{name}");
    }
    let history = out.join("history.csv");
    let get = |name: &str| column(&history, name);
    let (t, mass, energy) = (get("t"), get("mass"), get("energy"));
    assert_eq!(t.len(), 101);
    assert!((t[100] - 3.0).abs() < 1e-9);
    assert!(mass.iter().all(|m| (m - mass[0]).abs() < 1e-13), "{mass:?}");
    assert!(energy.windows(2).all(|w| w[1] < w[0]));
    let (measured, exact) = (get("energy_rate"), get("energy_rate_exact"));
    let most = exact.iter().fold(0.0f64, |m, e| m.max(e.abs()));
    for (m, e) in measured.iter().zip(&exact) {
        assert!((m - e).abs() < 1e-3 * most, "{m} {e}");
    }
    assert!(get("total_variation")[0] > 3.99 && get("min").len() == 101 && get("max").len() == 101);
    let report = std::fs::read_to_string(out.join("run.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!(report["status"], "done");
    assert_eq!(report["points"], 256);
}

#[test]
fn a_plane_has_its_pictures() {
    let dir = tempfile::tempdir().unwrap();
    let file = deck("good/conservation/swirl.toml");
    let out = dir.path().to_str().unwrap();
    let done = peridyne(&[
        "run",
        file.to_str().unwrap(),
        "--out",
        out,
        "--set",
        "run.duration=0.05",
    ]);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    assert!(dir.path().join("last.png").exists() && dir.path().join("profiles.svg").exists());
}

#[test]
fn check_says_what_would_run_and_writes_nothing() {
    let file = deck("good/conservation/riemann.toml");
    let told = peridyne(&["check", file.to_str().unwrap()]);
    let text = String::from_utf8_lossy(&told.stdout).to_string();
    for part in [
        "points    600 in 1-D",
        "= 10 spacings",
        "stable up to",
        "collars",
        "direct",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let told = peridyne(&["check", "--json", file.to_str().unwrap()]);
    let found: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
    assert_eq!(found["kind"], "conservation_law");
    assert!(found["stable_step"].as_f64().unwrap() > 0.0);
}

#[test]
fn numbers_in_quotes_without_a_unit_are_warned_of() {
    let dir = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(deck("good/conservation/riemann.toml")).unwrap();
    let text = text.replace("units = \"none\"\n", "");
    let line = 1 + text
        .lines()
        .position(|l| l.starts_with("duration"))
        .unwrap();
    let file = dir.path().join("quoted.toml");
    let told = text.lines().map(|l| match l.starts_with("duration") {
        true => "duration = \"0.25\"\n".to_string(),
        false => format!("{l}\n"),
    });
    std::fs::write(&file, told.collect::<String>()).unwrap();
    let name = file.to_str().unwrap();
    let expected = format!(
        "quoted.toml:{line}: \"0.25\" has no unit and is taken as 250 ms: write the unit, or the number without quotes"
    );
    let out = dir.path().join("out");
    let run = peridyne(&["run", name, "--out", out.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&run.stdout);
    assert!(said.contains(&format!("warning: {name}")), "{said}");
    assert!(said.contains(&expected), "{said}");
    let check = peridyne(&["check", name]);
    let said = String::from_utf8_lossy(&check.stderr);
    assert!(
        said.contains(&format!("warning: {name}")) && said.contains(&expected),
        "{said}"
    );
    let json = peridyne(&["check", "--json", name]);
    let record = std::fs::read_to_string(out.join("run.json")).unwrap();
    let found: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let warning = found["warnings"][0]["what"].as_str().unwrap();
    assert!(warning.ends_with(&expected), "{found}");
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    assert_eq!(record["warnings"][0], warning);
}

#[test]
fn mistakes_name_the_line_and_leave_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for name in ["collar_empty", "step_unstable", "kernel_of_half_the_moment"] {
        let file = deck(&format!("bad/conservation/{name}.toml"));
        let told = peridyne(&[
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ]);
        assert_eq!(told.status.code(), Some(2), "{name}");
        let text = String::from_utf8_lossy(&told.stderr);
        assert!(text.contains(&format!("{name}.toml:")), "{text}");
        assert!(!out.exists(), "{name}");
    }
    let file = deck("good/conservation/riemann.toml");
    let told = peridyne(&[
        "run",
        file.to_str().unwrap(),
        "--set",
        "run.time_step=1",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(told.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&told.stderr).contains("--set run.time_step"));
    let told = peridyne(&["waves", file.to_str().unwrap()]);
    assert_eq!(told.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&told.stderr).contains("has no body"));
}

/// Runs burgers_viscous with changes; gives its folder.
fn run_changed(dir: &Path, more: &[&str]) -> PathBuf {
    let file = deck("good/conservation/burgers_viscous.toml");
    let mut arguments = vec![
        "run",
        file.to_str().unwrap(),
        "--out",
        dir.to_str().unwrap(),
    ];
    arguments.extend(["--set", "output.pictures=false", "--set", "output.frames=2"]);
    arguments.extend(["--set", "output.history=2"]);
    arguments.extend(more);
    let done = peridyne(&arguments);
    let told = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{told}");
    dir.to_path_buf()
}

/// One, two and three threads write the same bytes.
#[test]
fn threads_do_not_show() {
    let dir = tempfile::tempdir().unwrap();
    let files = ["1", "2", "3"].map(|threads| {
        let more = [
            "--threads",
            threads,
            "--set",
            "points=40000",
            "--set",
            "horizon=0.003",
            "--set",
            "run.duration=1e-4",
        ];
        let out = run_changed(&dir.path().join(threads), &more);
        ["frames.npz", "history.csv"].map(|f| std::fs::read(out.join(f)).unwrap())
    });
    assert!(files[0] == files[1] && files[0] == files[2]);
}

/// A flux by expression that is a polynomial is one; what is none runs too.
#[test]
fn expressions_of_polynomials_are_polynomials() {
    let dir = tempfile::tempdir().unwrap();
    let energies = [
        "advection.flux=\"burgers\"",
        "advection.flux={ expression = \"u^2/2\" }",
        // the same for the u that occur, and no polynomial
        "advection.flux={ expression = \"u > 5 ? u : u^2/2\" }",
    ]
    .map(|flux| {
        let out = dir.path().join(flux.len().to_string());
        let out = run_changed(&out, &["--set", "points=256", "--set", flux]);
        let report = std::fs::read_to_string(out.join("run.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        let energy = column(&out.join("history.csv"), "energy");
        (energy, report["evaluation"].to_string())
    });
    for (energy, _) in &energies[1..] {
        for (a, b) in energy.iter().zip(&energies[0].0) {
            assert!((a - b).abs() < 1e-12 * b, "{energies:?}");
        }
    }
    assert_eq!(energies[0].1, energies[1].1);
    assert_eq!(energies[2].1, "\"direct\"");
}

/// SIGINT ends at the next step with the state so far, and the folder is held while the run goes on.
#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_last_state() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let file = deck("good/conservation/burgers_viscous.toml");
    let arguments = [
        "run",
        file.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
        "--set",
        "run.duration=100000",
    ];
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let rows = || std::fs::read_to_string(out.join("history.csv")).map_or(0, |t| t.lines().count());
    while rows() < 2 {
        assert!(begin.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(20));
    }
    let second = peridyne(&arguments);
    assert_eq!(second.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&second.stderr).contains("another run writes there"));
    Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    let ended = child.wait().unwrap();
    let mut said = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut said)
        .unwrap();
    assert_eq!(ended.code(), Some(130), "{said}");
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap();
    assert_eq!(report["ended_by"], "SIGINT");
    assert!(out.join("frames.npz").exists());
}

/// A law that nearly has its shock, at other output times: equal to the error that both runs state, which is within the tolerance.
#[test]
fn output_times_change_no_more_than_the_stated_error() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("law.toml");
    let text = "kind = \"conservation_law\"\nunits = \"none\"\ndomain = { x = [0, 6.283185307179586] }\npoints = 256\nboundary = \"periodic\"\nhorizon = 0.4\ninitial = \"sin(x)\"\n[advection]\nflux = \"burgers\"\nkernel = { bump = \"polynomial\", power = 3 }\n[run]\nduration = 0.9\n[output]\npictures = false\nreport = false\n";
    std::fs::write(&file, text).unwrap();
    let run = |name: &str, more: &[&str]| -> ([f64; 3], f64, f64) {
        let out = dir.path().join(name);
        let mut arguments = vec![
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ];
        arguments.extend(more);
        let done = peridyne(&arguments);
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(
            said.contains("error     of u by steps, estimated"),
            "{said}"
        );
        let report: serde_json::Value =
            serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap();
        let last = |name: &str| *column(&out.join("history.csv"), name).last().unwrap();
        assert!(last("time_error") <= report["time_error"].as_f64().unwrap());
        let allowed = report["time_error_allowed"]
            .as_f64()
            .unwrap_or(f64::INFINITY);
        (
            ["energy", "max", "total_variation"].map(last),
            report["time_error"].as_f64().unwrap(),
            allowed,
        )
    };
    let many = ["--set", "output.frames=100", "--set", "output.history=100"];
    let few = ["--set", "output.frames=1", "--set", "output.history=1"];
    let coarse = ["--set", "run.tolerance=1e-3"];
    let given = ["--set", "run.time_step=0.05"];
    let (best, best_error, _) = run("best", &["--set", "run.tolerance=1e-11"]);
    for (name, more) in [
        ("many", many.to_vec()),
        ("few", few.to_vec()),
        (
            "coarse",
            [few, [coarse[0], coarse[1], "--set", "title=\"\""]].concat(),
        ),
        (
            "given",
            [few, [given[0], given[1], "--set", "title=\"\""]].concat(),
        ),
    ] {
        let (found, error, allowed) = run(name, &more);
        assert!(error <= 3.0 * allowed, "{name}: {error} {allowed}");
        let error = error + best_error;
        // ∫u du over 2π, the largest u, and four times it where it rises and falls twice
        for ((a, b), factor) in found
            .iter()
            .zip(best)
            .zip([std::f64::consts::TAU, 1.0, 4.0])
        {
            assert!((a - b).abs() <= factor * error, "{name}: {a} {b} {error}");
        }
    }
}

/// SIGTERM is heard within sums of a single step that take minutes, and what was there before it is kept.
#[cfg(unix)]
#[test]
fn a_long_step_hears_that_it_is_to_end() {
    use std::io::BufRead;
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (dir.path().join("law.toml"), dir.path().join("out"));
    let text = "kind = \"conservation_law\"\nunits = \"none\"\ndomain = { x = [0, 1] }\npoints = 400000\nboundary = { left = 0, right = 0 }\nhorizon = 0.9\ninitial = \"sin(pi*x)\"\n[advection]\nflux = \"burgers\"\nkernel = { bump = \"polynomial\", power = 3 }\n[run]\nduration = 1\n[output]\npictures = false\nreport = false\n";
    std::fs::write(&file, text).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args([
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
        ])
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let lines = std::io::BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(
        lines
            .map_while(Result::ok)
            .any(|l| l.contains("results in"))
    );
    std::thread::sleep(Duration::from_secs(2));
    let begin = Instant::now();
    Command::new("kill")
        .args(["-TERM", &child.id().to_string()])
        .status()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(143));
    // files of the state take their time too
    assert!(
        begin.elapsed() < Duration::from_secs(10),
        "{:?}",
        begin.elapsed()
    );
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap();
    assert_eq!(report["ended_by"], "SIGTERM");
    assert_eq!(report["steps"], 0);
    assert!(out.join("frames.npz").metadata().unwrap().len() > 1000);
}

/// Beside the characteristics: errors in the history, the report and the last line; they fall as δ².
#[test]
fn a_run_compares_itself_with_the_local_law() {
    let dir = tempfile::tempdir().unwrap();
    let file = deck("good/conservation/compare.toml");
    let mut last = vec![];
    for (name, horizon) in [("wide", "horizon=0.02"), ("near", "horizon=0.01")] {
        let out = dir.path().join(name);
        let done = peridyne(&[
            "run",
            file.to_str().unwrap(),
            "--out",
            out.to_str().unwrap(),
            "--set",
            horizon,
            "--set",
            "points=512",
        ]);
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        assert!(
            said.contains("compares  with the solution of the local law (characteristics)"),
            "{said}"
        );
        let report = std::fs::read_to_string(out.join("run.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!(report["compared"]["with"], "characteristics");
        let errors = ["error_l1", "error_l2", "error_max"].map(|key| {
            let all = column(&out.join("history.csv"), key);
            assert_eq!((all.len(), all[0]), (21, 0.0));
            assert!(all.windows(2).all(|w| w[0] < w[1]), "{all:?}");
            assert_eq!(report["compared"][key].as_f64().unwrap(), all[20]);
            all[20]
        });
        let told = format!(
            "u is off by {} of it",
            peridyne_io::deck::rounded(errors[0], 3)
        );
        assert!(said.contains(&told), "{said}");
        last.push(errors);
    }
    for (wide, near) in last[0].iter().zip(&last[1]) {
        let order = (wide / near).log2();
        assert!((order - 2.0).abs() < 0.2, "{last:?}");
    }
}
