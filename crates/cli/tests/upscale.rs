//! `peridyne upscale` and `peridyne reproduce` as a user runs them.

use serde_json::Value;
use std::f64::consts::PI;
use std::path::Path;
use std::process::Command;

fn deck(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks");
    path.join(name).to_str().unwrap().to_string()
}

/// Runs the program, which must end with this status; what it said.
fn peridyne(arguments: &[&str], status: i32) -> String {
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(status), "{arguments:?}: {said}");
    said
}

fn card(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path.join("card.json")).unwrap()).unwrap()
}

/// Displacements at whole multiples of 1 about the middle of the pulse exp(−(x/4)²), which starts at rest, on an endless
/// chain of springs with K1 = ρ = 1: the sum over its waves, each with the time stepper's own frequency θ/Δt.
fn closed_form(spacing: f64, neighbours: i32, end: f64, steps: f64) -> Vec<f64> {
    // a ring of 1000; beyond k = 3 the pulse has nothing
    let dk = PI / 500.0;
    let mut u = vec![0.0; 1001];
    for m in 0..(3.0 / dk) as usize {
        let k = m as f64 * dk;
        let versines = (1..=neighbours).map(f64::from);
        let versines = versines.map(|j| 2.0 * (0.5 * j * k * spacing).sin().powi(2) / j);
        let n = f64::from(neighbours);
        // seleson2009 (4.1) with (A.2)
        let squared = 4.0 / (n * (n + 1.0) * spacing * spacing) * versines.sum::<f64>();
        let theta = 2.0 * (0.5 * end / steps * squared.sqrt()).asin();
        let half = if m == 0 { 0.5 } else { 1.0 };
        let amplitude = half * dk / PI * 4.0 * PI.sqrt() * (-4.0 * k * k).exp();
        let now = amplitude * (steps * theta).cos();
        for (i, u) in u.iter_mut().enumerate() {
            *u += now * (k * (i as f64 - 500.0)).cos();
        }
    }
    u
}

/// `√(Σ (a − b)² / Σ b²)`
fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let difference: f64 = a.iter().zip(b).map(|(x, y)| (x - y).powi(2)).sum();
    (difference / b.iter().map(|y| y * y).sum::<f64>()).sqrt()
}

#[test]
fn a_chain_of_springs_is_upscaled_and_both_decks_run() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let file = deck("good/spring_chain.toml");
    let factors = ["upscale", &file, "--factor", "2", "--factor", "4", "--run"];
    let step = ["--set", "run.time_step.safety=0.2"];
    let rest = ["--set", "run.duration=60", "--out", out];
    peridyne(&[&factors[..], &step, &rest].concat(), 0);
    for factor in [2.0, 4.0] {
        let h = dir.path().join(format!("h{factor}"));
        let card = card(&h);
        let number = |path: &str| card.pointer(path).and_then(Value::as_f64).unwrap();
        // (A.2): K1 is kept, and c_4 goes with N² + N over 24
        assert!((number("/coarse/stiffness/0/0") - 1.0).abs() < 1e-12);
        let n = 20.0 / factor;
        let spacing = 0.25 * factor;
        let exact = spacing * spacing * n * (n + 1.0) / 24.0;
        assert!((number("/gradient_coefficients/1/coarse") / exact - 1.0).abs() < 1e-10);
        // the difference of the two runs is that of the two chains, which is known; waves are so long that points every 1
        // have the same ratio as all that are compared
        let [a, b] = [0, 1].map(|k| number(&format!("/measured/steps/{k}")));
        let end = number("/measured/time");
        let fine = closed_form(0.25, 20, end, a);
        let coarse = closed_form(spacing, n as i32, end, b);
        let exact = relative_difference(&coarse, &fine);
        let error = number("/measured/displacement_error");
        assert!((error / exact - 1.0).abs() < 1e-6, "{error} {exact}");
        for name in [
            "card.md",
            "dispersion.png",
            "dispersion.svg",
            "energy.png",
            "coarse.toml",
        ] {
            assert!(h.join(name).is_file(), "{name}");
        }
        peridyne(&["check", h.join("coarse.toml").to_str().unwrap()], 0);
    }
}

/// The time of the last row of a run of a deck.
fn end_of(file: &Path) -> f64 {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    peridyne(&["run", file.to_str().unwrap(), "--out", out], 0);
    let history = std::fs::read_to_string(dir.path().join("history.csv")).unwrap();
    let column = |line: &str, n: usize| line.split(',').nth(n).unwrap().to_string();
    let titles = history.lines().next().unwrap();
    let time = titles
        .split(',')
        .position(|t| t.starts_with("time"))
        .unwrap();
    let last = history.lines().last().unwrap();
    column(last, time).parse().unwrap()
}

/// Steps of coarse decks are stable, that of a chain is seleson2009 (4.13), and they end where the fine one does, to one step: whichever way its steps
/// are given. The card is that of the decks as they are written.
#[test]
fn coarse_decks_have_stable_steps_and_end_with_the_fine_one() {
    let dir = tempfile::tempdir().unwrap();
    let chain = r#"
units = "none"
horizon = { m_ratio = 20 }
influence = "constant"
volume_scaling = false
body = { lattice = "chain", spacing = 0.25, region = { block = { low = 0, high = 100 } } }
material = { density = 1, law = { springs = { young = 1 } } }
[[initial]]
displacement = ["0.01*exp(-((x-50)/8)^2)"]
[output]
vtu = false
picture = false
"#;
    let plane = r#"
units = "none"
periodic = ["x", "y"]
plane = "stress"
thickness = 1
horizon = { m_ratio = 6 }
body = { lattice = "square", spacing = 0.02, region = { block = { low = [0, 0], high = [1, 1] } } }
material = { density = 1, law = { pmb = { young = 1 } } }
[[initial]]
displacement = ["0.001*sin(2*pi*x)", 0]
[output]
vtu = false
picture = false
"#;
    let neighbours = |n: i32| {
        let n1 = f64::from(n);
        let harmonic: f64 = (1..=n).map(|j| f64::from(j).recip()).sum();
        (n1 * (n1 + 1.0) / (2.0 * harmonic)).sqrt()
    };
    // (4.13): 0.85 Δx √(ρ/(K(N) H_N)), K(N) = 2 K1/(N (N + 1))
    let [step, coarse_step] = [(0.25, 20), (0.5, 10)].map(|(dx, n)| 0.85 * dx * neighbours(n));
    assert!((coarse_step - 1.8416747869437702).abs() < 1e-12);
    let cases = [
        (chain, format!("steps = 184\ntime_step = {step:?}")),
        (chain, format!("duration = 60\ntime_step = {step:?}")),
        (chain, "steps = 50".into()),
        (chain, "steps = 50\ntime_step = { safety = 0.4 }".into()),
        (chain, "duration = 30".into()),
        (plane, "duration = 0.5\ntime_step = 0.04".into()),
        (plane, "steps = 12\ntime_step = 0.04".into()),
    ];
    for (n, (body, run)) in cases.iter().enumerate() {
        let file = dir.path().join(format!("{n}.toml"));
        std::fs::write(&file, format!("{body}[run]\n{run}\n")).unwrap();
        let out = dir.path().join(n.to_string());
        let arguments = [
            "upscale",
            file.to_str().unwrap(),
            "--run",
            "--out",
            out.to_str().unwrap(),
        ];
        peridyne(&arguments, 0);
        let deck = out.join("h2/coarse.toml");
        let [fine, coarse] = [&file, &deck].map(|deck| end_of(deck));
        let card = card(&out.join("h2"));
        let number = |path: &str| card.pointer(path).and_then(Value::as_f64).unwrap();
        let compared = number("/measured/time");
        assert!(
            (compared / coarse - 1.0).abs() < 1e-12,
            "{run}: {compared} {coarse}"
        );
        let one = coarse / number("/measured/steps/1");
        assert!(
            (coarse - fine).abs() <= one * (1.0 + 1e-9),
            "{run}: {coarse} {fine} {one}"
        );
        if n == 0 {
            assert!((one / coarse_step - 1.0).abs() < 1e-12, "{one}");
            assert_eq!(number("/measured/steps/1"), 162.0);
        }
    }
}

#[test]
fn copper_keeps_its_energy_and_moduli() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let file = deck("good/copper_bar.toml");
    peridyne(&["upscale", &file, "--factor", "2", "--out", out], 0);
    let card = card(&dir.path().join("h2"));
    for e in card["energies"].as_array().unwrap() {
        let (a, b) = (e["fine"].as_f64().unwrap(), e["coarse"].as_f64().unwrap());
        assert!((a / b - 1.0).abs() < 1e-9, "{e}");
    }
    // eV/Å³: c11 of copper is 170 GPa = 1.06
    let c11 = card["fine"]["stiffness"][0][0].as_f64().unwrap();
    assert!((0.9..1.2).contains(&c11), "{c11}");
    assert!((card["predicted_cost_ratio"].as_f64().unwrap() - 16.0).abs() < 0.1);
}

#[test]
fn what_cannot_be_upscaled_says_why_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (name, factor, expected) in [
        ("good/spring_chain.toml", "3", "not divisible"),
        ("good/spring_chain.toml", "1", "2 or more"),
        ("good/mesh_plate.toml", "2", "only a lattice body"),
        ("good/copper_bar.toml", "5", "not divisible"),
        ("good/minimal_crack.toml", "9", "choose one of 3"),
        ("in.impact_disk", "2", "takes a deck"),
    ] {
        let out = out.to_str().unwrap();
        let said = peridyne(
            &["upscale", &deck(name), "--factor", factor, "--out", out],
            2,
        );
        let flat = said
            .split_whitespace()
            .filter(|w| *w != "│")
            .collect::<Vec<_>>()
            .join(" ");
        assert!(flat.contains(expected), "{name}: {said}");
        assert!(!Path::new(out).exists(), "{name}");
    }
}

#[test]
fn a_table_is_reproduced_and_a_wrong_figure_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let table = "seleson2009/table-4-1";
    peridyne(&["reproduce", table, "--small", "--out", out], 0);
    assert!(
        dir.path()
            .join("seleson2009/table-4-1/report.json")
            .is_file()
    );
    let wrong = peridyne(&["reproduce", "seleson2009/table-4-2", "--out", out], 2);
    assert!(wrong.contains("table-4-1"), "{wrong}");
}
