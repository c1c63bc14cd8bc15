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
        // its gradient equations are equal to order 2 and by (1 + 1/N)/(1 + 1/20) apart in the next
        assert_eq!(number("/upscaling/equal_to_order"), 2.0);
        assert_eq!(number("/upscaling/compared_to_order"), 8.0);
        assert_eq!(number("/upscaling/first_difference/order"), 4.0);
        let apart = 1.0 - (1.0 + 0.05) / (1.0 + n.recip());
        assert!((number("/upscaling/first_difference/relative") - apart).abs() < 1e-10);
        let length = (25.0 * (1.0 + n.recip()) / 24.0).sqrt();
        assert!((number("/coarse/length_scale") / length - 1.0).abs() < 1e-10);
        energies(&card, [0.25, spacing], [20, n as i32]);
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

/// The energies of a card of a chain of springs with K1 = 1 that starts at rest as exp(−(x/4)²): the strain energies of the start, Σ ½ K_j (u_{i+j} − u_i)²
/// with (A.2), that of all that strain and kinetic energy trade, and the largest differences of the rows themselves.
fn energies(card: &Value, spacing: [f64; 2], neighbours: [i32; 2]) {
    let row = |of: &str, name: &str| -> Vec<f64> {
        let rows = card.pointer(&format!("/measured/energies/{of}/{name}"));
        let rows = rows.and_then(Value::as_array).unwrap();
        rows.iter().map(|e| e.as_f64().unwrap()).collect()
    };
    for (k, of) in ["fine", "coarse"].into_iter().enumerate() {
        let (h, n) = (spacing[k], neighbours[k]);
        let u = |i: i32| (-(f64::from(i) * h / 4.0).powi(2)).exp();
        let half = (40.0 / h) as i32;
        let bond = |i: i32, j: i32| (u(i + j) - u(i)).powi(2) / f64::from(j);
        let sum: f64 = (-half..half)
            .flat_map(|i| (1..=n).map(move |j| bond(i, j)))
            .sum();
        let exact = sum / (f64::from(n * (n + 1)) * h);
        let [kinetic, strain, total] = ["kinetic", "strain", "total"].map(|name| row(of, name));
        assert!(
            (strain[0] / exact - 1.0).abs() < 1e-9,
            "{of}: {} {exact}",
            strain[0]
        );
        assert_eq!(kinetic[0], 0.0);
        // two pulses that run apart have half of it in motion
        let last = kinetic.len() - 1;
        assert!(
            (kinetic[last] / exact - 0.5).abs() < 0.02,
            "{of}: {}",
            kinetic[last]
        );
        assert!(total.iter().all(|t| (t / exact - 1.0).abs() < 0.05));
    }
    for name in ["kinetic", "strain", "total"] {
        let (a, b) = (row("fine", name), row("coarse", name));
        let size = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let most = a
            .iter()
            .zip(&b)
            .fold(0.0f64, |m, (x, y)| m.max((x - y).abs()));
        let told = card.pointer(&format!("/measured/energies/largest_difference/{name}"));
        let told = told.and_then(Value::as_f64).unwrap();
        assert!((told / (most / size) - 1.0).abs() < 1e-12, "{name}: {told}");
    }
}

/// Influence functions of a chain by their sums: K_j ∝ ω(j/m)/j, so that c₄/c₂ = a² Σ ω j³ / (12 Σ ω j), and ω² ∝ Σ ω (1 − cos jka)/j over Σ ω j.
#[test]
fn kernels_are_compared_by_their_sums() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let file = deck("good/spring_chain.toml");
    peridyne(
        &["upscale", &file, "--factor", "4", "--kernels", "--out", out],
        0,
    );
    let card = card(&dir.path().join("h4"));
    let kernels = card["kernels"].as_array().unwrap();
    assert!(kernels.iter().filter(|k| k["horizon_kept"] == true).count() == 5);
    let weight = |name: &str, q: f64| match name {
        "constant" => 1.0,
        // up to a factor
        "inverse" => 1.0 / q,
        "linear" => 1.0 - q,
        "gaussian" => (-4.0 * q * q).exp(),
        _ if q <= 0.5 => 1.0 - 6.0 * q * q + 6.0 * q * q * q,
        _ => 2.0 * (1.0 - q).powi(3),
    };
    // c₄/c₂ and ω² by k, of unit speed
    type Chain<'a> = (&'a str, f64, f64);
    let sum = |(name, m, _): Chain, of: &dyn Fn(f64) -> f64| -> f64 {
        let each = (1..=m.round() as i32).map(f64::from);
        each.map(|j| weight(name, j / m) * of(j)).sum()
    };
    let fourth = |c: Chain| c.2 * c.2 * sum(c, &|j| j * j * j) / (12.0 * sum(c, &|j| j));
    let frequency = |c: Chain, k: f64| {
        let versines = sum(c, &|j| 4.0 * (0.5 * j * k * c.2).sin().powi(2) / j);
        (versines / (sum(c, &|j| j) * c.2 * c.2)).sqrt()
    };
    let fine = ("constant", 20.0, 0.25);
    let mut before = 0.0;
    for k in kernels {
        let number = |path: &str| k.pointer(path).and_then(Value::as_f64).unwrap();
        let (name, horizon) = (k["influence"].as_str().unwrap(), number("/horizon"));
        let coarse = (name, horizon, 1.0);
        assert_eq!(k["horizon_kept"] == true, horizon == 5.0, "{k}");
        assert_eq!(number("/upscaling/equal_to_order"), 2.0, "{k}");
        let exact = fourth(coarse) / fourth(fine) - 1.0;
        assert!(
            (number("/difference_of_c4") - exact).abs() < 1e-9,
            "{k} {exact}"
        );
        assert!(
            (number("/length_scale") / fourth(coarse).sqrt() - 1.0).abs() < 1e-9,
            "{k}"
        );
        let wavelength = number("/wavelength_below_which_the_error_exceeds_1_percent");
        let off = |l: f64| {
            let k = 2.0 * PI / l;
            (frequency(coarse, k) / frequency(fine, k) - 1.0).abs()
        };
        assert!(
            (off(wavelength) / 0.01 - 1.0).abs() < 1e-6,
            "{k} {}",
            off(wavelength)
        );
        assert!(
            (1..100).all(|i| off(wavelength * (1.0 + 0.05 * f64::from(i))) < 0.01),
            "{k}"
        );
        assert!(wavelength >= before, "{k}");
        before = wavelength;
    }
    // atoms have no influence function, and a micromodulus belongs to its own
    let own = dir.path().join("micromodulus.toml");
    let text = std::fs::read_to_string(deck("good/spring_chain.toml")).unwrap();
    std::fs::write(&own, text.replace("young = 1", "micromodulus = 1")).unwrap();
    for (file, expected) in [
        (deck("good/copper_bar.toml"), "no influence function"),
        (
            own.to_str().unwrap().to_string(),
            "belongs to its influence function",
        ),
    ] {
        let said = peridyne(&["upscale", &file, "--kernels", "--out", out], 2);
        let words = said.split_whitespace().filter(|word| *word != "│");
        let line = words.collect::<Vec<_>>().join(" ");
        assert!(line.contains(expected), "{file}: {said}");
    }
}

/// Statics of an endless chain of springs under b sin kx: u = b/(ρω²) sin kx of each model, ρω² = 4/(N(N + 1)a²) Σ 2 sin²(jka/2)/j.
#[test]
fn statics_are_upscaled_too() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let file = dir.path().join("pulled.toml");
    let text = r#"
units = "none"
periodic = ["x"]
horizon = { m_ratio = 8 }
influence = "constant"
partial_volume_correction = false
body = { lattice = "chain", spacing = 0.25, cells = [160], origin = 0 }
material = { density = 1, law = { springs = { young = 1 } } }
condition = [
    { region = { block = { low = -0.1, high = 0.1 } }, displacement = [0] },
    { body_force = ["0.01*sin(2*pi*x/10)"] },
]
statics = { tolerance = 1e-11 }
[output]
vtu = false
picture = false
"#;
    std::fs::write(&file, text).unwrap();
    let run = [
        "upscale",
        file.to_str().unwrap(),
        "--factor",
        "4",
        "--run",
        "--out",
    ];
    peridyne(&[&run[..], &[out.to_str().unwrap()]].concat(), 0);
    let card = card(&out.join("h4"));
    let number = |path: &str| card.pointer(path).and_then(Value::as_f64).unwrap();
    let stiffness = |h: f64, n: i32| {
        let k = 2.0 * PI / 10.0;
        let versines = (1..=n).map(f64::from);
        let versines = versines.map(|j| 2.0 * (0.5 * j * k * h).sin().powi(2) / j);
        4.0 / (f64::from(n * (n + 1)) * h * h) * versines.sum::<f64>()
    };
    let exact = (stiffness(0.25, 8) / stiffness(1.0, 2) - 1.0).abs();
    let found = number("/measured/displacement_error");
    assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
    // half the work of the load, which the density of points does not change
    let energies = number("/measured/energies/largest_difference/strain");
    assert!((energies / exact - 1.0).abs() < 1e-6, "{energies} {exact}");
    // points × bonds
    assert_eq!(number("/predicted_cost_ratio"), 4.0 * 4.0);
    let coarse = std::fs::read_to_string(out.join("h4/coarse.toml")).unwrap();
    assert!(
        coarse.contains("[statics]") && !coarse.contains("[run]"),
        "{coarse}"
    );
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
partial_volume_correction = false
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

#[test]
fn reproduce_alone_says_what_there_is_and_runs_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| {
        let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
            .args(arguments)
            .current_dir(dir.path())
            .output()
            .unwrap();
        assert!(done.status.success(), "{arguments:?}: {done:?}");
        String::from_utf8(done.stdout).unwrap()
    };
    let papers = said(&["reproduce"]);
    let listed = said(&["reproduce", "--list"]);
    for paper in [
        "seleson2009",
        "seleson2014",
        "eriksson2020",
        "silling2010",
        "sandia2010",
        "gallery",
    ] {
        let line = papers.lines().find(|l| l.starts_with(paper)).unwrap();
        let figures = listed
            .lines()
            .filter(|l| l.starts_with(&format!("{paper}/")))
            .count();
        assert!(
            line.contains(&format!(" {figures} figures ")),
            "{line}: {figures}"
        );
    }
    assert!(papers.contains("peridyne reproduce all "), "{papers}");
    let of_a_paper = said(&["reproduce", "--list", "silling2010"]);
    assert!(
        of_a_paper.lines().all(|l| l.starts_with("silling2010/")),
        "{of_a_paper}"
    );
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

/// A critical stretch under a longer horizon is another fracture energy, of pmb and of potentials; where the horizon is kept nothing is to say.
#[test]
fn cards_say_what_a_kept_critical_stretch_means() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("deck.toml");
    let text = |law: &str, family: &str| {
        format!(
            "units = \"lj\"\n{family}horizon = 2.5\nperiodic = [\"x\", \"y\"]\nbody = {{ lattice = \"triangular\", spacing = 1.1, cells = [24, 20] }}\n\
             material = {{ density = 1, law = {{ {law} }}, fracture = {{ critical_stretch = 0.1 }} }}\nrun = {{ steps = 10, time_step = 0.001 }}\n"
        )
    };
    let atoms = text(
        "lennard_jones = { epsilon = 1, sigma = 1, cutoff = 2.5, end = \"smooth\" }",
        "family = \"reference\"\n",
    );
    let solid = text("pmb = { young = 1 }", "");
    for (deck, keep, longer) in [
        (&atoms, "shells", true),
        (&solid, "shells", true),
        (&solid, "horizon", false),
    ] {
        std::fs::write(&file, deck).unwrap();
        let out = dir.path().join(keep);
        let keep = match longer {
            true => vec!["--keep", "shells"],
            false => vec![],
        };
        let files = [file.to_str().unwrap(), "--out", out.to_str().unwrap()];
        let arguments = [&["upscale"][..], &files, &["--factor", "2"], &keep].concat();
        peridyne(&arguments, 0);
        let said = std::fs::read_to_string(out.join("h2/card.md")).unwrap();
        let told = said.contains("a crack takes 2 times the energy")
            && said.contains("critical_stretch = 0.07071");
        assert_eq!(told, longer, "{said}");
    }
}
