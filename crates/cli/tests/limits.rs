//! What would not fit is refused before anything is asked for, at once, with the likely cause.

use std::process::{Command, Output};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const BLOCK: &str = r#"horizon = HORIZON
[body]
lattice = "cubic"
spacing = "SPACING"
origin = [0, 0, 0]
region = { block = { low = [0, 0, 0], high = ["20 mm", "20 mm", "20 mm"] } }
MORE
[material]
density = "2200 kg/m^3"
law = { pmb = { bulk = "14.9 GPa" } }
[run]
steps = STEPS
OUTPUT
"#;

struct Case {
    horizon: &'static str,
    spacing: &'static str,
    more: &'static str,
    steps: &'static str,
    output: &'static str,
    says: &'static [&'static str],
}

const USUAL: Case = Case {
    horizon: "{ m_ratio = 3 }",
    spacing: "1 mm",
    more: "",
    steps: "10",
    output: "",
    says: &[],
};

fn peridyne(verb: &str, text: &str, dir: &TempDir) -> Output {
    let file = dir.path().join("deck.toml");
    std::fs::write(&file, text).unwrap();
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args([verb, file.to_str().unwrap(), "--threads", "1"])
        .current_dir(dir.path())
        .output()
        .unwrap()
}

#[test]
fn what_does_not_fit_is_refused_at_once() {
    for case in [
        Case {
            horizon: "{ m_ratio = 1000 }",
            says: &["bonds per point are too many", "m_ratio = 3"],
            ..USUAL
        },
        Case {
            horizon: "\"1.5001 m\"",
            says: &[
                "bonds per point are too many",
                "1500.1 spacings",
                "decimal point",
            ],
            ..USUAL
        },
        // every point of a cloud bonded with every other
        Case {
            horizon: "\"1.5001 m\"",
            spacing: "0.1 mm",
            more: "perturb = { amplitude = \"0.01 mm\", seed = 1 }",
            says: &["too many", "decimal point"],
            ..USUAL
        },
        Case {
            spacing: "0.002 mm",
            says: &["a body of 1.00e12 points", "check the units of the spacing"],
            ..USUAL
        },
        Case {
            spacing: "0.005 mm",
            says: &["a body of 6.4", "GB", "check the units of the spacing"],
            ..USUAL
        },
        Case {
            steps: "1000000000000",
            output: "[output]\nevery = 1",
            says: &["of frames", "output.every"],
            ..USUAL
        },
        Case {
            steps: "100000000000000",
            output: "[output]\nhistory = 1",
            says: &["TB", "output.history"],
            ..USUAL
        },
    ] {
        let text = BLOCK
            .replace("HORIZON", case.horizon)
            .replace("SPACING", case.spacing)
            .replace("MORE", case.more)
            .replace("STEPS", case.steps)
            .replace("OUTPUT", case.output);
        for verb in ["check", "run"] {
            let dir = TempDir::new().unwrap();
            let begin = Instant::now();
            let output = peridyne(verb, &text, &dir);
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(
                output.status.code(),
                Some(2),
                "{verb} {:?}: {said}",
                case.says
            );
            // lines break anywhere
            let words: Vec<&str> = said.split(['│', ' ', '\n']).collect();
            let words = words.into_iter().filter(|w| !w.is_empty());
            let said = words.collect::<Vec<_>>().join(" ");
            for part in case.says {
                // the cells of a region cannot all be numbered either
                let other = "the region spans";
                assert!(
                    said.contains(part) || said.contains(other),
                    "{part} is not in\n{said}"
                );
            }
            assert!(
                begin.elapsed() < Duration::from_secs(30),
                "{verb} {:?}",
                case.says
            );
            assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
        }
    }
}

#[test]
fn a_small_body_of_long_bonds_still_runs() {
    // all 216 points bonded with each other: odd, and possible
    let text = BLOCK
        .replace("HORIZON", "\"40 mm\"")
        .replace("SPACING", "4 mm")
        .replace("MORE", "perturb = { amplitude = \"0.01 mm\", seed = 1 }")
        .replace("STEPS", "2")
        .replace("OUTPUT", "");
    let dir = TempDir::new().unwrap();
    let output = peridyne("run", &text, &dir);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn check_of_a_periodic_cloud_takes_no_longer_where_the_period_is_short() {
    // a period of little more than two horizons: 101 places per axis once
    let dir = TempDir::new().unwrap();
    let text = r#"horizon = { m_ratio = 3 }
periodic = ["x", "y", "z"]
contact = false
body = { lattice = "cubic", spacing = "1 mm", cells = [7, 7, 7], perturb = { amplitude = "0.01 mm", seed = 1 } }
material = { density = "2200 kg/m^3", law = { pmb = { bulk = "14.9 GPa" } } }
run = { steps = 10 }
"#;
    let begin = Instant::now();
    let output = peridyne("check", text, &dir);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        begin.elapsed() < Duration::from_secs(20),
        "{:?}",
        begin.elapsed()
    );
}
