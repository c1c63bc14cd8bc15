//! `peridyne upscale` of a law and a lattice on the command line, as a user runs it.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

fn copper() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/copper.eam.alloy");
    path.to_str().unwrap().to_string()
}

fn silicon() -> String {
    copper().replace("copper.eam.alloy", "Si.sw")
}

/// Runs the program, which must end with this status; what it said and complained.
fn peridyne(arguments: &[&str], status: i32) -> [String; 2] {
    let done = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .output()
        .unwrap();
    let [said, wrong] =
        [done.stdout, done.stderr].map(|b| String::from_utf8_lossy(&b).into_owned());
    assert_eq!(done.status.code(), Some(status), "{arguments:?}: {wrong}");
    [said, wrong]
}

/// The model of a few flags: its fine deck and the cards of its factors. All decks must be runnable.
fn upscaled(flags: &str, factors: &[&str]) -> (toml::Table, Vec<Value>) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let mut arguments = vec!["upscale", "--out", out];
    arguments.extend(flags.split_whitespace());
    for factor in factors {
        arguments.extend(["--factor", factor]);
    }
    peridyne(&arguments, 0);
    let fine = dir.path().join("fine.toml");
    peridyne(&["check", fine.to_str().unwrap()], 0);
    let cards = factors.iter().map(|factor| {
        let h = dir.path().join(format!("h{factor}"));
        peridyne(&["check", h.join("coarse.toml").to_str().unwrap()], 0);
        serde_json::from_str(&std::fs::read_to_string(h.join("card.json")).unwrap()).unwrap()
    });
    let cards = cards.collect();
    let text = std::fs::read_to_string(fine).unwrap();
    (text.parse().unwrap(), cards)
}

fn number(card: &Value, path: &str) -> f64 {
    card.pointer(path).and_then(Value::as_f64).unwrap()
}

#[test]
fn a_chain_of_lennard_jones_rests_where_its_sums_say() {
    let flags = "--potential lj --with epsilon=1 --with sigma=1 --lattice chain --m-ratio 4";
    let (fine, cards) = upscaled(flags, &["2", "4"]);
    let z = |n: i32| (1..=4).map(|j| f64::from(j).powi(-n)).sum::<f64>();
    let rest = (2.0 * z(12) / z(6)).powf(1.0 / 6.0);
    let spacing = fine["body"]["spacing"].as_float().unwrap();
    assert!((spacing / rest - 1.0).abs() < 1e-13, "{spacing}");
    for card in &cards {
        // seleson2009 (5.3): equal long waves at every stretch, other terms not
        let rows = card["nonlinear_gradient_equation"].as_array().unwrap();
        assert_eq!(rows.len(), 3 * (1 + 3 + 7));
        for row in rows {
            let (a, b) = (number(row, "/fine"), number(row, "/coarse"));
            let same = (a / b - 1.0).abs() < 1e-9;
            assert_eq!(same, row["order"] == 2, "{row}");
        }
    }
}

#[test]
fn copper_of_a_file_is_upscaled_at_its_own_constant() {
    let flags = format!("--potential setfl={} --lattice fcc --cells 8,8,8", copper());
    let (fine, cards) = upscaled(&flags, &["2"]);
    let spacing = fine["body"]["spacing"].as_float().unwrap();
    assert!((spacing - 3.615).abs() < 0.002, "{spacing}");
    assert_eq!(
        fine["material"]["law"]["eam"]["file"].as_str(),
        Some("copper.eam.alloy")
    );
    let card = &cards[0];
    assert!(number(card, "/fine/reference_pressure").abs() < 1e-10);
    for e in card["energies"].as_array().unwrap() {
        let (a, b) = (number(e, "/fine"), number(e, "/coarse"));
        assert!((a / b - 1.0).abs() < 1e-9, "{e}");
    }
}

/// Files of fans: silicon rests where LAMMPS has no pressure, and of two elements one is named.
#[test]
fn silicon_of_a_file_is_upscaled() {
    let decks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good");
    let file = |name: &str| decks.join(name).to_str().unwrap().to_string();
    let crystal = "--lattice diamond --mass 28.0855 --cells 6,6,6";
    let [silicon, carbide] = ["Si.sw", "SiC.tersoff"].map(file);
    for (flags, rest) in [
        (format!("stillinger_weber={silicon}"), 5.4309498),
        (format!("tersoff={carbide} --element Si"), 5.4321148),
    ] {
        let (fine, cards) = upscaled(&format!("--potential {flags} {crystal}"), &["2"]);
        let spacing = fine["body"]["spacing"].as_float().unwrap();
        assert!((spacing - rest).abs() < 1e-6, "{spacing}");
        let card = &cards[0];
        assert!(number(card, "/fine/reference_pressure").abs() < 1e-10);
        for e in card["energies"].as_array().unwrap() {
            let (a, b) = (number(e, "/fine"), number(e, "/coarse"));
            assert!((a / b - 1.0).abs() < 1e-9, "{e}");
        }
    }
}

#[test]
fn what_is_kept_can_be_asked_for() {
    let flags = "--potential springs --with young=1 --lattice chain --spacing 0.25 --m-ratio 8";
    for (keep, bonds) in [("", 4.0), ("--keep reach", 4.0), ("--keep shells", 16.0)] {
        let (_, cards) = upscaled(&format!("{flags} {keep}"), &["4"]);
        assert_eq!(
            number(&cards[0], "/coarse/bonds_per_point"),
            bonds,
            "{keep}"
        );
        let [a, b] = ["fine", "coarse"].map(|s| number(&cards[0], &format!("/{s}/stiffness/0/0")));
        assert!((a / b - 1.0).abs() < 1e-12, "{keep}: {a} {b}");
    }
    let lj =
        "--potential lj --with epsilon=1 --with sigma=1 --lattice chain --m-ratio 2 --keep shells";
    let (_, cards) = upscaled(lj, &["2"]);
    assert_eq!(number(&cards[0], "/coarse/bonds_per_point"), 4.0);
}

#[test]
fn other_laws_and_lattices() {
    for (flags, factor, rest) in [
        (
            "--potential structured_eam --with pair=2 --with volume=0.3 --lattice square --spacing 1 --m-ratio 6",
            "2",
            1.0,
        ),
        (
            "--potential lps --with young=1 --with poisson=0.3 --lattice cubic --spacing 1 --m-ratio 4 --cells 10,10,10",
            "2",
            1.0,
        ),
        (
            "--potential morse --with depth=1 --with alpha=3 --with distance=1 --with cutoff=2.5 --with end=smooth --lattice triangular",
            "3",
            0.870275,
        ),
        (
            "--potential buckingham --with strength=1000 --with range=0.3 --with dispersion=50 --m-ratio 1 --lattice bcc --cells 6,6,6",
            "2",
            3.4561,
        ),
        (
            "--potential eam_form --units metal --mass 63.5 --with cohesive=3.54 --with pair=0.1287 --with alpha=5.0857 \
          --with beta=5.8509 --with gamma=8.0 --with lambda=5.7874 --with density_scale=0.08333333333333333 \
          --with density=[0.64085,-6.83764,26.75616,-47.16495,36.18925,-8.60834] --with near=1.75 --with cutoff=1.95 \
          --with nearest=2.55 --lattice fcc --cells 6,6,6",
            "2",
            // made for this crystal, at 2.55 √2; another, of higher energy, rests beyond
            3.606,
        ),
    ] {
        let (fine, cards) = upscaled(flags, &[factor]);
        let spacing = &fine["body"]["spacing"];
        let spacing = spacing
            .as_float()
            .or(spacing.as_integer().map(|n| n as f64))
            .unwrap();
        assert!((spacing / rest - 1.0).abs() < 0.02, "{flags}: {spacing}");
        assert!(
            number(&cards[0], "/fine/reference_pressure").abs() < 1e-9,
            "{flags}"
        );
        let [a, b] = ["fine", "coarse"].map(|s| number(&cards[0], &format!("/{s}/stiffness/0/0")));
        assert!(a > 0.0 && (a / b - 1.0).abs() < 0.25, "{flags}: {a} {b}");
    }
}

#[test]
fn both_models_run_from_the_command_line() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let flags = "upscale --potential lj --with epsilon=1 --with sigma=1 --with cutoff=2.5 --with end=smooth \
                 --lattice triangular --factor 2 --run --out";
    let mut arguments: Vec<&str> = flags.split_whitespace().collect();
    arguments.push(out);
    let [said, _] = peridyne(&arguments, 0);
    assert!(said.contains("the lattice has no pressure there"), "{said}");
    let card: Value =
        serde_json::from_str(&std::fs::read_to_string(dir.path().join("h2/card.json")).unwrap())
            .unwrap();
    let error = number(&card, "/measured/displacement_error");
    assert!(error > 1e-5 && error < 0.05, "{error}");
}

#[test]
fn what_is_wrong_names_the_flag_and_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let copper = format!("--potential setfl={} --lattice fcc", copper());
    let lj = "--potential lj --with epsilon=1 --with sigma=1";
    for (flags, expected) in [
        ("".to_string(), vec!["--potential"]),
        ("--potential quartz --lattice fcc".into(), vec!["--potential", "setfl=FILE"]),
        ("--potential setfl --lattice fcc".into(), vec!["--potential", "setfl=FILE"]),
        ("--potential setfl=none.alloy --lattice fcc".into(), vec!["--potential", "none.alloy"]),
        (format!("{copper} --element Au"), vec!["--element", "Au"]),
        (format!("{copper} --keep reach"), vec!["keep their reach"]),
        (format!("{copper} --cells 7,7,7"), vec!["--cells", "not divisible by 2"]),
        (format!("{copper} --cells 8,8"), vec!["--cells"]),
        (format!("{copper} --spacing -3"), vec!["--spacing"]),
        (lj.into(), vec!["--lattice is missing"]),
        (format!("{lj} --lattice hcp"), vec!["--lattice", "hcp"]),
        (format!("{lj} --lattice fcc"), vec!["--spacing", "cutoff=LENGTH"]),
        (format!("{lj} --lattice chain --m-ratio none"), vec!["--m-ratio"]),
        (format!("{lj} --lattice chain --m-ratio 3"), vec!["--factor 2", "choose one of 3"]),
        ("--potential lj --with sigma=1 --lattice fcc --m-ratio 1".into(), vec!["--potential", "epsilon"]),
        ("--potential lj --with epsilon=1 --with sigma=-1 --lattice fcc --m-ratio 1".into(), vec!["--with sigma"]),
        ("--potential springs --with young=1 --lattice chain --spacing 1".into(), vec!["--m-ratio is missing"]),
        ("--potential springs --with young=1 --lattice chain --m-ratio 4".into(), vec!["--spacing is missing"]),
        (
            "--potential springs --with micromodulus=1 --lattice chain --spacing 1 --m-ratio 4 --keep shells".into(),
            vec!["young"],
        ),
        ("--potential morse --units si --lattice chain --m-ratio 1".into(), vec!["--mass is missing"]),
        (format!("--potential stillinger_weber={} --lattice diamond", silicon()), vec!["--mass is missing"]),
        (
            format!("--potential stillinger_weber={} --mass 28 --lattice diamond --m-ratio 2", silicon()),
            vec!["lives on current neighbours"],
        ),
        ("deck.toml --potential lj --lattice fcc".into(), vec!["cannot be used with"]),
    ] {
        let mut arguments = vec!["upscale", "--out", out.to_str().unwrap()];
        arguments.extend(flags.split_whitespace());
        let [_, said] = peridyne(&arguments, 2);
        let flat: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        let flat = flat.join(" ");
        for words in expected {
            assert!(flat.contains(words), "{flags}: {said}");
        }
        assert!(!out.exists(), "{flags}");
    }
}
