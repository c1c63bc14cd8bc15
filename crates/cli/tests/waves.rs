//! `peridyne waves` as a user runs it.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks")
        .join(name)
}

fn waves(file: &Path, arguments: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .arg("waves")
        .arg(file)
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap()
}

/// The JSON on the standard output of a run that must succeed.
fn report(name: &str, arguments: &[&str], out: &Path) -> Value {
    let mut all = vec!["--json"];
    all.extend(arguments);
    let done = waves(&deck(name), &all, out);
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(0), "{said}");
    serde_json::from_slice(&done.stdout).unwrap()
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap()
}

#[test]
fn a_chain_of_neighbours_is_the_textbook_chain() {
    let dir = tempfile::tempdir().unwrap();
    // ω = (2c/a) sin(ka/2), a = 0.25; at the sharp limit velocity Verlet turns the last wave into π/Δt
    let set = ["--set", "horizon.m_ratio=1", "--set", "run.time_step=0.25"];
    let found = report("good/spring_chain.toml", &set, dir.path());
    assert!((number(&found, "/stability/sharp_limit") - 0.25).abs() < 1e-14);
    // (4.12) of seleson2009 is sharp where there is one spring
    assert!((number(&found, "/stability/bound") - 0.25).abs() < 1e-14);
    assert!((number(&found, "/stability/time_step_over_sharp_limit") - 1.0).abs() < 1e-13);
    assert!((number(&found, "/special_points/1/omega/0") - 8.0).abs() < 1e-12);
    assert!((number(&found, "/elastic/lattice/C/0/0") - 1.0).abs() < 1e-13);
    let c4 = number(&found, "/directions/0/longitudinal_gradient_coefficients/1");
    assert!((c4 - 0.0625 / 12.0).abs() < 1e-14);
    // 2 a^(2p)/(2p+2)!
    assert_eq!(
        found["gradient_fractions"],
        serde_json::json!(["1", "1/12", "1/360", "1/20160"])
    );
    for file in [
        "dispersion.png",
        "dispersion.svg",
        "velocities.csv",
        "waves.json",
    ] {
        assert!(dir.path().join(file).is_file(), "{file}");
    }
    let table = std::fs::read_to_string(dir.path().join("dispersion.csv")).unwrap();
    assert!(
        table.starts_with("path,point,kx,omega 1,omega of Verlet 1,"),
        "{table}"
    );
    let svg = std::fs::read_to_string(dir.path().join("dispersion.svg")).unwrap();
    assert!(svg.contains(">Γ</text>") && svg.contains(">X</text>"));
}

/// Springs K_j = K/j to N = 20 neighbours: Σ j^(2p+1) over Σ j (seleson2009), in fractions to the order asked.
#[test]
fn coefficients_of_chains_are_fractions_to_the_order_asked() {
    let dir = tempfile::tempdir().unwrap();
    let found = report("good/spring_chain.toml", &["--order", "12"], dir.path());
    let fractions = found["gradient_fractions"].as_array().unwrap();
    assert_eq!(fractions.len(), 6);
    let sum = |power: u32| (1..=20u128).map(|j| j.pow(power)).sum::<u128>();
    for (p, fraction) in fractions.iter().enumerate() {
        let factorial: u128 = (1..=2 * p as u128 + 2).product();
        let (above, below) = fraction
            .as_str()
            .unwrap()
            .split_once('/')
            .unwrap_or((fraction.as_str().unwrap(), "1"));
        let [above, below]: [u128; 2] = [above, below].map(|t| t.parse().unwrap());
        assert_eq!(
            above * sum(1) * factorial,
            below * 2 * sum(2 * p as u32 + 1),
            "{p}"
        );
    }
    // √(35/2) a
    let length = number(&found, "/directions/0/length_scale");
    assert!(
        (length / (17.5f64.sqrt() * 0.25) - 1.0).abs() < 1e-12,
        "{length}"
    );
    let done = waves(
        &deck("good/spring_chain.toml"),
        &["--order", "12"],
        dir.path(),
    );
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(
        said.contains("∂^4: 35/2 a^2") && said.contains("∂^12: "),
        "{said}"
    );
    let wrong = waves(
        &deck("good/spring_chain.toml"),
        &["--order", "7"],
        dir.path(),
    );
    assert_eq!(wrong.status.code(), Some(2));
    // roots of whole numbers are no fractions
    let plate = report("good/exact_plate.toml", &[], dir.path());
    assert_eq!(plate["gradient_fractions"], serde_json::json!([]));
}

#[test]
fn copper_has_the_constants_of_its_table() {
    let dir = tempfile::tempdir().unwrap();
    let found = report("good/copper_bar.toml", &[], dir.path());
    let c = |name: &str| number(&found, &format!("/elastic/lattice/cubic/{name}"));
    // eV/Å³
    let gpa = 160.217_663_4;
    assert!((c("c11") * gpa - 168.0).abs() < 4.0 && (c("c44") * gpa - 76.0).abs() < 4.0);
    assert!(c("zener_ratio") > 3.0 && c("c12_minus_c44") > 0.0);
    assert!(found["elastic"]["continuum"].is_null());
    assert_eq!(number(&found, "/stability/unstable_part"), 0.0);
    let names: Vec<&str> = found["special_points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| p["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["Γ", "X", "W", "K", "Γ", "L", "U"]);
    // ρ v² of long waves along x
    let (rho, v) = (
        number(&found, "/density"),
        number(&found, "/directions/0/long_wave_speeds/2"),
    );
    let c11 = number(&found, "/elastic/stress_strain/cubic/c11");
    assert!((rho * v * v / c11 - 1.0).abs() < 1e-3);
}

#[test]
fn stretched_copper_grows_waves_and_says_which() {
    let dir = tempfile::tempdir().unwrap();
    let set = ["--set", "body.spacing=4.5"];
    let found = report("good/copper_bar.toml", &set, dir.path());
    assert!(number(&found, "/stability/unstable_part") > 0.0);
    assert!(number(&found, "/stability/growing_waves/0/rate") > 0.0);
    assert!(number(&found, "/reference/pressure") < 0.0);
    let done = waves(&deck("good/copper_bar.toml"), &set, dir.path());
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(
        said.contains("UNSTABLE") && said.contains("worst: k = ("),
        "{said}"
    );
}

#[test]
fn a_solid_stands_beside_the_continuum_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let found = report("good/periodic_wave.toml", &[], dir.path());
    let bulk = |who: &str| number(&found, &format!("/elastic/{who}/cubic/bulk"));
    assert!((bulk("lattice") / bulk("continuum") - 1.0).abs() < 1e-9);
    assert!((number(&found, "/stability/time_step_over_sharp_limit") - 0.5).abs() < 0.01);
}

#[test]
fn what_has_no_plane_waves_says_what_to_do_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (name, expected) in [
        ("good/mesh_plate.toml", "cloud, a mesh"),
        ("good/layered_block.toml", "perturbed lattice"),
        ("in.impact_disk", "takes a deck"),
        ("good/nowhere.toml", "nowhere.toml"),
    ] {
        let done = waves(&deck(name), &[], &out);
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{name}: {said}");
        let flat = said
            .split_whitespace()
            .filter(|w| *w != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(flat.contains(expected), "{name}: {said}");
        assert!(!out.exists(), "{name}");
    } // two materials on a plain lattice
    let text = std::fs::read_to_string(deck("good/layered_block.toml")).unwrap();
    let plain: Vec<&str> = text.lines().filter(|l| !l.starts_with("perturb")).collect();
    let file = dir.path().join("layers.toml");
    std::fs::write(&file, plain.join("\n")).unwrap();
    let done = waves(&file, &[], &out);
    let said = String::from_utf8_lossy(&done.stderr);
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("several materials"), "{said}");
    assert!(!out.exists());
}

#[test]
fn a_chain_of_atoms_has_its_nonlinear_equation() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("chain.toml");
    let text = "units = \"none\"\nfamily = \"stencil\"\nhorizon = { m_ratio = 1 }\nperiodic = [\"x\"]\n\
                body = { lattice = \"chain\", spacing = 1.25, cells = [20] }\n\
                material = { mass = 1, law = { morse = { depth = 2, alpha = 1.5, distance = 1.2 } } }\n\
                run = { steps = 1, time_step = 0.01 }\n";
    std::fs::write(&file, text).unwrap();
    let found = report(file.to_str().unwrap(), &[], &dir.path().join("out"));
    for (n, stretch) in [0.98, 1.0, 1.02].into_iter().enumerate() {
        let at = |path: &str| format!("/nonlinear_gradient_equation/{n}/{path}");
        assert_eq!(number(&found, &at("stretch")), stretch);
        // derivatives of D [e^(−2α(r − r0)) − 2 e^(−α(r − r0))] by hand
        let a = 1.25f64;
        let slope = |order: i32| {
            let e = (-1.5 * (a * stretch - 1.2)).exp();
            2.0 * ((-3f64).powi(order) * e * e - 2.0 * (-1.5f64).powi(order) * e)
        };
        let terms = found.pointer(&at("terms")).unwrap().as_array().unwrap();
        assert_eq!(terms.len(), 1 + 3 + 7);
        for (term, expected) in [
            ("y''", a * slope(2)),
            ("y(4)", a.powi(3) * slope(2) / 12.0),
            ("y''' y''", a.powi(4) * slope(3) / 6.0),
            ("y''^3", a.powi(5) * slope(4) / 24.0),
            ("y(6)", a.powi(5) * slope(2) / 360.0),
        ] {
            let row = terms.iter().find(|t| t["term"] == term).unwrap();
            let c = number(row, "/coefficient");
            assert!((c / expected - 1.0).abs() < 1e-12, "{term}: {c} {expected}");
        }
    }
    let said = waves(&file, &[], &dir.path().join("out"));
    let said = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.contains("nonlinear gradient equation"), "{said}");
}
