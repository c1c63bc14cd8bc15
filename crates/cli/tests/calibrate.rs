//! Calibration: keys of a deck from a measured curve.

use serde_json::Value;
use std::fmt::Write;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A bar whose ends follow one strain, 1e-3 at the end: its pull is E times it, on a section of 1 m².
const BAR: &str = r#"title = "A bar"
horizon = { m_ratio = 3 }
[body]
lattice = "chain"
spacing = "1 mm"
region = { block = { low = [0], high = ["20 mm"] } }
[sets]
left.where = "x < 3 mm"
right.where = "x > 17 mm"
[material]
density = "1000 kg/m^3"
law = { pmb = { young = "10 GPa" } }
[[boundary_condition]]
set = "left"
displacement = { x = "1e-3 * x * t" }
[[boundary_condition]]
set = "right"
displacement = { x = "1e-3 * x * t" }
[[probe]]
name = "pull"
set = "right"
measure = "reaction"
[[probe]]
name = "move"
set = "right"
measure = "mean"
of = "displacement"
component = "x"
[statics]
increments = 2
[output]
picture = false
report = false
"#;

/// Of the right set, at its mean place and the full strain.
const MOVED: f64 = 18.5e-3 * 1e-3;

fn calibrate(dir: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .current_dir(dir)
        .args(["calibrate", "bar.toml", "--out", "fit", "--threads", "2"])
        .args(more)
        .output()
        .unwrap()
}

fn told(output: &Output) -> String {
    let streams = [&output.stdout, &output.stderr].map(|s| String::from_utf8_lossy(s));
    let words: Vec<&str> = streams.iter().flat_map(|s| s.split_whitespace()).collect();
    words.join(" ").replace("│ ", "")
}

fn with(deck: &str, curve: &str) -> TempDir {
    let dir = TempDir::new().unwrap();
    std::fs::write(dir.path().join("bar.toml"), deck).unwrap();
    std::fs::write(dir.path().join("curve.csv"), curve).unwrap();
    dir
}

fn found(dir: &TempDir) -> Value {
    let text = std::fs::read(dir.path().join("fit/calibrate.json")).unwrap();
    serde_json::from_slice(&text).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

fn near(found: f64, known: f64, within: f64) {
    assert!((found / known - 1.0).abs() < within, "{found} for {known}");
}

const CURVE: [&str; 6] = ["--measured", "curve.csv", "--x", "move_x", "--y", "pull_x"];

fn fit_young<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [
        &CURVE[..],
        &["--fit", "material.law.pmb.young=5 GPa:20 GPa"],
        more,
    ]
    .concat()
}

/// Ends of the pull in so many points, with errors added in kN.
fn line(young: f64, errors: &[f64]) -> (String, Vec<[f64; 2]>) {
    let mut text = String::from("pull_x [kN],specimen,move_x[um]\n");
    let mut points = vec![];
    for (n, error) in errors.iter().enumerate() {
        let part = (n + 1) as f64 / errors.len() as f64;
        let pull = young * 1e-3 * part / 1e3 + error;
        writeln!(text, "{pull},a {n},{}", MOVED * part * 1e6).unwrap();
        points.push([MOVED * part, pull * 1e3]);
    }
    (text, points)
}

#[test]
fn a_modulus_is_found_and_so_is_its_standard_error() {
    let known = 13.7e9;
    let (exact, _) = line(known, &[0.0; 5]);
    let dir = with(BAR, &exact);
    let done = calibrate(dir.path(), &fit_young(&[]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    near(number(&found(&dir)["keys"][0]["value"]) * 1e9, known, 1e-6);

    // errors in kN, the same in each run of this test
    let errors = [31.0, -52.0, 17.0, 44.0, -23.0, -36.0, 8.0, 29.0];
    let (noisy, points) = line(known, &errors);
    std::fs::write(dir.path().join("curve.csv"), noisy).unwrap();
    // runs of the same deck are taken from the fit before
    let first = dir.path().join("fit/12.5/run.json");
    let before = std::fs::metadata(&first).unwrap().modified().unwrap();
    let done = calibrate(dir.path(), &fit_young(&["--jobs", "2"]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    assert_eq!(
        std::fs::metadata(&first).unwrap().modified().unwrap(),
        before
    );
    // a line through the origin: pull = E 1e-3 move / MOVED
    let rise = |p: &[f64; 2]| 1e-3 * p[0] / MOVED;
    let squares: f64 = points.iter().map(|p| rise(p) * rise(p)).sum();
    let young = points.iter().map(|p| rise(p) * p[1]).sum::<f64>() / squares;
    let rest: f64 = points
        .iter()
        .map(|p| (p[1] - young * rise(p)).powi(2))
        .sum();
    let s = (rest / 7.0).sqrt();
    let fit = found(&dir);
    let key = &fit["keys"][0];
    near(number(&key["value"]) * 1e9, young, 1e-6);
    near(
        number(&key["standard_error"]) * 1e9,
        s / squares.sqrt(),
        1e-6,
    );
    near(number(&fit["s"]), s, 1e-6);
    // tables of Student's t: 2.36462 with 7 degrees of freedom
    let half = 2.364_624 * s / squares.sqrt();
    near(number(&key["interval_95"][0]) * 1e9, young - half, 1e-6);
    near(number(&key["interval_95"][1]) * 1e9, young + half, 1e-6);
    assert_eq!(fit["converged"], true);
    let out = told(&done);
    assert!(
        out.contains("standard error") && out.contains("run it: peridyne run bar.toml --set"),
        "{out}"
    );
    assert!(dir.path().join("fit/calibrate.png").is_file());
    let table = std::fs::read_to_string(dir.path().join("fit/calibrate.csv")).unwrap();
    assert!(
        table.starts_with(
            "folder,material.law.pmb.young [GPa],status,residual norm [N],why\n12.5,12.5,done,"
        ),
        "{table}"
    );
}

/// Weights are as if the points of small deviation had been measured alone where the others say nothing.
#[test]
fn standard_deviations_weigh_points() {
    let mut text = String::from("move_x [um],pull_x [kN],sd [N]\n");
    for (part, young, sd) in [
        (0.25, 12e9, 1.0),
        (0.5, 12e9, 1.0),
        (0.75, 18e9, 1e9),
        (1.0, 6e9, 1e9),
    ] {
        writeln!(
            text,
            "{},{},{sd}",
            MOVED * part * 1e6,
            young * 1e-3 * part / 1e3
        )
        .unwrap();
    }
    let dir = with(BAR, &text);
    let done = calibrate(dir.path(), &fit_young(&["--sigma", "sd"]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    near(number(&found(&dir)["keys"][0]["value"]), 12.0, 1e-6);
    assert_eq!(found(&dir)["residual_unit"], "");
}

/// A twin: the curve of a run with known yield stress and hardening gives them back.
#[test]
fn yield_stress_and_hardening_are_found() {
    let law = r#"law = { elastic_plastic = { young = "70 GPa", poisson = 0.33, yield_stress = "230 MPa", hardening = "9 GPa" } }"#;
    let deck = BAR
        .replace(r#"law = { pmb = { young = "10 GPa" } }"#, law)
        .replace("horizon =", "dimension = 1\nhorizon =")
        .replace("1e-3 * x * t", "1e-2 * x * t")
        .replace("increments = 2", "method = \"newton\"\nincrements = 8")
        .replace("\"20 mm\"", "\"14 mm\"")
        .replace("17 mm", "11 mm");
    let dir = with(&deck, "");
    let twin = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .current_dir(dir.path())
        .args(["run", "bar.toml", "--out", "twin"])
        .output()
        .unwrap();
    assert_eq!(twin.status.code(), Some(0), "{}", told(&twin));
    let fit = |key: &str, bounds: &str| format!("material.law.elastic_plastic.{key}={bounds}");
    let keys = [
        fit("yield_stress", "150 MPa:400 MPa"),
        fit("hardening", "1 GPa:30 GPa"),
    ];
    let more = ["--fit", &keys[0], "--fit", &keys[1], "--jobs", "2"];
    let curve = [
        "--measured",
        "twin/history.csv",
        "--x",
        "move_x",
        "--y",
        "pull_x",
    ];
    let done = calibrate(dir.path(), &[&curve[..], &more].concat());
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    let found = found(&dir);
    near(number(&found["keys"][0]["value"]), 230.0, 1e-5);
    near(number(&found["keys"][1]["value"]), 9.0, 1e-4);
    let r = number(&found["correlation"][0][1]);
    assert!(r.abs() < 1.0 && found["correlation"][1][0] == r, "{r}");
    assert!(told(&done).contains("correlation of"), "{}", told(&done));
}

/// Two factors of one stiffness.
#[test]
fn what_cannot_be_known_is_told() {
    let (curve, _) = line(30e9, &[0.0; 4]);
    let dir = with(BAR, &curve);
    let done = calibrate(dir.path(), &fit_young(&[]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    let out = told(&done);
    assert!(
        out.contains("ends at its bound, 20 GPa") && !out.contains("standard error"),
        "{out}"
    );
    assert_eq!(found(&dir)["keys"][0]["at_bound"], true);
    // a density changes no equilibrium
    std::fs::remove_dir_all(dir.path().join("fit")).unwrap();
    let more = ["--fit", "material.density=500 kg/m^3:2000 kg/m^3"];
    let done = calibrate(dir.path(), &fit_young(&more));
    assert_eq!(done.status.code(), Some(1), "{}", told(&done));
    assert!(
        told(&done).contains("the curve does not depend on material.density"),
        "{}",
        told(&done)
    );
    // factors of one product
    std::fs::remove_dir_all(dir.path().join("fit")).unwrap();
    let deck = BAR.replace("title =", "constants = { a = 1, b = 1 }\ntitle =");
    let deck = deck.replace("\"10 GPa\"", "\"1 GPa * a * b\"");
    std::fs::write(dir.path().join("bar.toml"), deck).unwrap();
    let both = ["--fit", "constants.a=1:8", "--fit", "constants.b=1:9"];
    let done = calibrate(dir.path(), &[&CURVE[..], &both].concat());
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    assert!(
        told(&done).contains("constants.a, constants.b are not determined by this curve"),
        "{}",
        told(&done)
    );
}

#[test]
fn mistakes_are_found_before_the_first_run() {
    let good = "move_x [um],pull_x [kN]\n5,3\n10,6\n";
    let young = fit_young(&[]);
    let and = |more: &[&'static str]| fit_young(more);
    for (curve, words, why) in [
        ("", young.clone(), "curve.csv: it is empty"),
        (
            "move_x [um],pull_x [kN]\n",
            young.clone(),
            "curve.csv:1: no rows",
        ),
        (
            "move_x [um],pull [kN]\n1,2\n",
            young.clone(),
            "curve.csv:1: one column `pull_x`",
        ),
        (
            "move_x [um],pull_x [kn]\n1,2\n",
            young.clone(),
            "did you mean `kN`",
        ),
        (
            "move_x [kg],pull_x [kN]\n1,2\n",
            young.clone(),
            "it is a mass",
        ),
        (
            "move_x [um],pull_x [kN]\n1,2\n2,NaN\n",
            young.clone(),
            "curve.csv:3: expected a number",
        ),
        (
            "move_x [um],pull_x [kN]\n1,2\n",
            and(&["--fit", "material.density=1:2"]),
            "1 points do not determine 2 keys",
        ),
        (good, and(&["--sigma", "sd"]), "one column `sd`"),
        (
            "move_x [um],pull_x [kN],sd\n1,2,0\n",
            and(&["--sigma", "sd"]),
            "curve.csv:2: a standard deviation is above 0",
        ),
        (good, and(&["--fit", "material.densty=1:2"]), "density"),
        (good, and(&["--fit", "material.density=1,2"]), "low:high"),
        (
            good,
            and(&["--fit", "material.density=2:1"]),
            "lower bound comes first",
        ),
        (good, and(&["--fit", "material.law.pmb.young=1:2"]), "twice"),
        (
            good,
            and(&["--start", "material.law.pmb.young=30 GPa"]),
            "not between 5 GPa and 20 GPa",
        ),
        (
            good,
            and(&["--start", "material.law.pmb.young=9e9 Pa"]),
            "in the unit of the bounds, GPa",
        ),
        (good, and(&["--start", "material.density=1"]), "not fitted"),
        (good, and(&["--jobs", "0"]), "--jobs 0"),
        (good, and(&["--evaluations", "2"]), "takes 4 runs"),
        (good, and(&["--difference", "2"]), "--difference 2"),
    ] {
        let dir = with(BAR, curve);
        let wrong = calibrate(dir.path(), &words);
        assert_eq!(wrong.status.code(), Some(2), "{words:?} {}", told(&wrong));
        assert!(told(&wrong).contains(why), "{words:?} {}", told(&wrong));
        assert!(!dir.path().join("fit").exists(), "{words:?}");
    }
    let dir = with(BAR, good);
    let wrong = calibrate(
        dir.path(),
        &[&young[..4], &["--y", "pull", "--fit", young[7]]].concat(),
    );
    assert_eq!(wrong.status.code(), Some(2), "{}", told(&wrong));
    let out = told(&wrong);
    assert!(
        out.contains("--y pull: history.csv") && out.contains("pull_x, move_x"),
        "{out}"
    );
    // nothing is continued beyond the end of a run
    let dir = with(BAR, "move_x [um],pull_x [kN]\n5,3\n30,6\n");
    let short = calibrate(dir.path(), &young);
    assert_eq!(short.status.code(), Some(1), "{}", told(&short));
    assert!(
        told(&short).contains("curve.csv:3 is at 3e-5"),
        "{}",
        told(&short)
    );
}

#[test]
fn a_fit_that_was_ended_goes_on() {
    let (curve, _) = line(8e9, &[10.0, -10.0, 5.0, 0.0]);
    let dir = with(BAR, &curve);
    let spent = calibrate(dir.path(), &fit_young(&["--evaluations", "4"]));
    assert_eq!(spent.status.code(), Some(1), "{}", told(&spent));
    assert!(
        told(&spent).contains("--evaluations are spent"),
        "{}",
        told(&spent)
    );
    assert_eq!(found(&dir)["converged"], false);
    let folder = |name: &str| -> PathBuf { dir.path().join("fit").join(name) };
    // a run of which nothing is left is done again, others are not
    std::fs::remove_dir_all(folder("12.485")).unwrap();
    let time = |name: &str| {
        std::fs::metadata(folder(name).join("run.json"))
            .unwrap()
            .modified()
            .unwrap()
    };
    let before = time("12.515");
    let done = calibrate(dir.path(), &fit_young(&[]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    assert_eq!(time("12.515"), before);
    assert!(folder("12.485/run.json").is_file());
    let whole = found(&dir);
    // as if it had not been ended
    std::fs::remove_dir_all(dir.path().join("fit")).unwrap();
    assert_eq!(
        calibrate(dir.path(), &fit_young(&[])).status.code(),
        Some(0)
    );
    assert_eq!(whole, found(&dir));
    // another study does not write over it
    let other = calibrate(dir.path(), &fit_young(&["--set", "horizon.m_ratio=2"]));
    assert_eq!(other.status.code(), Some(2));
    assert!(told(&other).contains("another study"), "{}", told(&other));
}

#[cfg(unix)]
#[test]
fn a_signal_ends_it_and_the_same_command_goes_on() {
    let (curve, _) = line(8e9, &[10.0, -10.0, 5.0, 0.0]);
    let dir = with(&BAR.replace("increments = 2", "increments = 400"), &curve);
    let mut child = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .current_dir(dir.path())
        .args(["calibrate", "bar.toml", "--out", "fit", "--threads", "1"])
        .args(fit_young(&[]))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    // the first run is done
    assert!(
        lines
            .by_ref()
            .any(|l| l.unwrap().trim_start().starts_with("1 "))
    );
    let id = child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &id]).status();
    assert!(kill.unwrap().success());
    let rest: Vec<String> = lines.map_while(Result::ok).collect();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{rest:?}");
    assert!(!dir.path().join("fit/calibrate.json").exists());
    let done = calibrate(dir.path(), &fit_young(&[]));
    assert_eq!(done.status.code(), Some(0), "{}", told(&done));
    assert_eq!(found(&dir)["converged"], true);
}
