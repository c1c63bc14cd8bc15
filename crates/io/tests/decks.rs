//! Every deck of the repository: the good ones are understood, the bad ones say what their first line expects.

use peridyne::error::BuildErrorKind;
use peridyne::run::{Options, build};
use peridyne_io::deck::{Deck, UnitSystem};
use std::path::{Path, PathBuf};

fn decks(folder: &str) -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../decks")
        .join(folder);
    let mut decks: Vec<(PathBuf, String)> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| (path.clone(), std::fs::read_to_string(&path).unwrap()))
        .collect();
    decks.sort();
    decks
}

/// `# expect: MESSAGE (line N)`, the line being optional.
fn expectation(text: &str) -> Option<(&str, Option<usize>)> {
    let rest = text.lines().next()?.strip_prefix("# expect: ")?;
    Some(match rest.rsplit_once(" (line ") {
        Some((message, line)) => (message, line.strip_suffix(')')?.parse().ok()),
        None => (rest, None),
    })
}

#[test]
fn good_decks_are_understood() {
    let decks = decks("good");
    assert!(decks.len() >= 8);
    for (path, text) in decks {
        match Deck::parse(&text, path.to_str().unwrap(), &[]) {
            Ok(deck) => {
                let told = deck.describe();
                let said = told.contains("run  ") || told.contains("statics  ");
                assert!(said, "{}", path.display())
            }
            Err(error) => panic!(
                "{}:{:?}: {error} ({:?})",
                path.display(),
                error.line,
                error.help
            ),
        }
    }
}

#[test]
fn bad_decks_say_what_is_wrong_and_where() {
    let decks = decks("bad");
    assert!(decks.len() >= 40);
    let mut wrong = Vec::new();
    for (path, text) in &decks {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let Some((message, line)) = expectation(text) else {
            wrong.push(format!(
                "{name}: its first line is not `# expect: MESSAGE (line N)`"
            ));
            continue;
        };
        match Deck::parse(text, path.to_str().unwrap(), &[]) {
            Ok(_) => wrong.push(format!("{name}: was accepted")),
            Err(error) if !error.message.contains(message) => {
                wrong.push(format!("{name}: said {:?}", error.message))
            }
            Err(error) if line.is_some() && error.line != line => {
                wrong.push(format!("{name}: line {:?}, not {line:?}", error.line));
            }
            Err(_) => {}
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// What only the engine can tell passes the deck, and finds its way back to the line that is to blame.
#[test]
fn decks_that_fail_in_the_build_say_what_is_wrong_and_where() {
    let decks = decks("bad/build");
    assert!(decks.len() >= 20);
    let mut wrong = Vec::new();
    for (path, text) in &decks {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let (message, line) = expectation(text).unwrap_or_else(|| panic!("{name}"));
        let deck = match Deck::parse(text, path.to_str().unwrap(), &[]) {
            Ok(deck) => deck,
            Err(error) => {
                wrong.push(format!("{name}: refused by the deck: {error}"));
                continue;
            }
        };
        match build(&deck.spec, Options::default()) {
            Ok(_) => wrong.push(format!("{name}: was built")),
            Err(error) => {
                let told = deck.explain(&error);
                if !told.message.contains(message) || told.line != line {
                    wrong.push(format!(
                        "{name}: said {:?} at line {:?} ({})",
                        told.message, told.line, error.path
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// A number of a sentence that nobody would write so: `5.72e0`, or one as a power of ten without a unit.
fn odd_number(text: &str, units: UnitSystem) -> Option<String> {
    let plain = |w: &str| {
        w.trim_matches(|c: char| "(),;:".contains(c) || c == '.' || c == '`')
            .to_string()
    };
    let words: Vec<String> = text.split_whitespace().map(plain).collect();
    let unit = |w: &str| {
        ["m", "s", "Pa", "N", "J", "K", "kg", "W", "1"]
            .iter()
            .any(|u| {
                w == *u
                    || w.strip_prefix(u)
                        .is_some_and(|rest| rest.starts_with(['/', '^']))
            })
    };
    for (n, word) in words.iter().enumerate() {
        let Some((_, power)) = word.split_once('e').filter(|_| word.parse::<f64>().is_ok()) else {
            continue;
        };
        let next = words.get(n + 1).map_or("", |w| w);
        // how many there are has no unit
        let counted = ["bonds", "points", "lattice", "particles"].contains(&next);
        let named = unit(next) || counted || matches!(units, UnitSystem::Lj | UnitSystem::None);
        if power == "0" || !named {
            return Some(format!("{word} {next}"));
        }
    }
    None
}

/// What the engine says has numbers for people, whatever units the deck has.
/// A law keeps its name, and what finds the forces of its bonds is said with the reason.
#[test]
fn fused_kernels_or_general_sweeps_are_said_with_the_reason() {
    let pmb = "{ pmb = { young = 1 } }";
    let lps = "{ lps = { young = 1, poisson = 0.2 } }";
    let typed = "{ lps_3d = { bulk = 2, shear = 1 } }";
    let eam = "{ eam_like = { pair = 2, volume = 0.1 } }";
    let plastic = "{ elastic_plastic = { young = 1, poisson = 0.2, yield_stress = 0.1 } }";
    let springs = "{ springs = { young = 1 } }";
    let work = "fracture = { energy = 0.1, criterion = \"bond_energy\" }";
    let stress = "fracture = { von_mises = 0.1 }";
    let rate =
        "fracture = { critical_stretch = 0.1, rate = { coefficient = 0.05, reference = 1 } }";
    let fatigue = "fracture = { critical_stretch = 0.1, fatigue = { nucleation = [1, 3] } }";
    let run = "[run]\nsteps = 1";
    let cycles = "[statics]\nmethod = \"newton\"\nincrements = 1\ncycles = { load_ratio = 0.1 }";
    let warm = "heat = { conductivity = 1, capacity = 1, expansion = 0.1 }\n[heat]\nreference = 1";
    let horizons =
        "variable_horizon = \"2.5 + 0.1*x\"\nfamily = \"list\"\ncalibration = \"continuum\"";
    let directed = "influence = \"1 + 0.1*xi_x/r\"";
    for (law, top, of_material, end, says) in [
        (pmb, "", "", run, "fused kernels of pmb"),
        (lps, "", "", run, "fused kernels of lps"),
        (typed, "", "", run, "fused kernels of lps_3d"),
        (eam, "", "", run, "fused kernels of eam_like"),
        (pmb, horizons, "", run, "fused kernels of pmb"),
        (pmb, directed, "", run, "fused kernels of pmb"),
        (plastic, "", "", run, "general sweeps of elastic_plastic"),
        (plastic, "", work, run, "general sweeps of elastic_plastic"),
        (
            pmb,
            "",
            work,
            run,
            "general sweeps of pmb (breaks by work of bonds)",
        ),
        (
            typed,
            "",
            work,
            run,
            "general sweeps of lps_3d (breaks by work of bonds)",
        ),
        (
            lps,
            "",
            stress,
            run,
            "general sweeps of lps (breaks by von Mises stress)",
        ),
        (
            pmb,
            "",
            rate,
            run,
            "general sweeps of pmb (has a critical stretch that grows with the rate)",
        ),
        (
            pmb,
            "",
            fatigue,
            cycles,
            "general sweeps of pmb (has fatigue)",
        ),
        (eam, "", warm, run, "general sweeps of eam_like (expands)"),
        (
            lps,
            horizons,
            "",
            run,
            "general sweeps of lps (has a variable horizon)",
        ),
        (
            lps,
            directed,
            "",
            run,
            "general sweeps of lps (has an influence function that knows directions)",
        ),
        (springs, "", "", run, ""),
    ] {
        let text = format!(
            "units = \"none\"\nplane = \"strain\"\nhorizon = 3.3\ncontact = false\n{top}\n\
             [body]\nlattice = \"square\"\nspacing = 1\ncells = [8, 8]\n\
             [material]\ndensity = 1\nlaw = {law}\n{of_material}\n\
             [[boundary_condition]]\nregion = {{ block = {{ low = [0, 0], high = [8, 1] }} }}\ndisplacement = [0, 0]\n{end}\n"
        );
        let deck = Deck::parse(&text, "deck.toml", &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let sim = build(&deck.spec, Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let [sweeps] = &sim.info().sweeps[..] else {
            panic!("{:?}", sim.info().sweeps)
        };
        let said = sweeps.as_ref().map_or(String::new(), |s| s.to_string());
        assert_eq!(said, says, "{text}");
    }
}

#[test]
fn numbers_of_warnings_and_errors_have_units() {
    assert_eq!(
        odd_number("the spacing 5.72e0 is", UnitSystem::Si).unwrap(),
        "5.72e0 is"
    );
    assert_eq!(
        odd_number("the period is 1.0e-3, less", UnitSystem::Si).unwrap(),
        "1.0e-3 less"
    );
    assert_eq!(
        odd_number("a stiffness of 2e18 N/m^6; 3e9 bonds", UnitSystem::Si),
        None
    );
    assert_eq!(odd_number("apart by 2e-4", UnitSystem::Lj), None);
    let mut wrong = Vec::new();
    let (mut told, mut looked) = (0, 0);
    for folder in ["good", "bad/build"] {
        for (path, text) in decks(folder) {
            let name = path.to_str().unwrap();
            // those of many points say nothing that smaller ones do not
            let large = name.contains("impact.toml") || name.contains("too_");
            let Some(deck) = Deck::parse(&text, name, &[]).ok().filter(|_| !large) else {
                continue;
            };
            looked += 1;
            let mut said: Vec<String> = deck.warnings.clone();
            match build(&deck.spec, Options::default()) {
                Ok(sim) => {
                    said.extend(sim.info().warnings.iter().map(|w| deck.units.tell(w)));
                    let lints = deck.lints(sim.info());
                    assert!(folder != "good" || lints.is_empty(), "{name}: {lints:?}");
                    said.extend(lints);
                }
                Err(e) => {
                    let e = deck.explain(&e);
                    said.extend([e.message].into_iter().chain(e.help));
                }
            }
            told += said.len();
            for text in said {
                if let Some(number) = odd_number(&text, deck.units) {
                    wrong.push(format!("{name}: `{number}` in: {text}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(
        looked > 60 && told > 30,
        "{looked} decks said {told} things"
    );
}

/// A unit or prefix that was likely meant otherwise is told with its line; rubber, foam and lead are believed.
#[test]
fn numbers_that_no_solid_has_are_doubted() {
    let lints = |density: &str, law: &str, fracture: &str, run: &str| {
        let text = format!(
            "horizon = {{ m_ratio = 3 }}\nrun = {run}\nbody = {{ lattice = \"cubic\", spacing = \"1 mm\", cells = [6, 6, 6] }}\n[material]\ndensity = \"{density}\"\nlaw = {{ {law} }}\n{fracture}\n"
        );
        let deck = Deck::parse(&text, "deck.toml", &[]).unwrap_or_else(|e| panic!("{e}: {text}"));
        let sim = build(&deck.spec, Options::default()).unwrap();
        deck.lints(sim.info())
    };
    let steps = "{ steps = 10 }";
    let pmb = |young: &str| format!("pmb = {{ young = \"{young}\" }}");
    for (density, young, expected) in [
        (
            "7.8 kg/m^3",
            "210 GPa",
            "deck.toml:5: the density of `material`, 7.8 kg/m^3, is below that of any solid: is 7800 kg/m^3 meant?",
        ),
        (
            "7800 g/cm^3",
            "210 GPa",
            "deck.toml:5: the density of `material`, 7.8e6 kg/m^3, is above that of any solid: is 7800 kg/m^3 meant?",
        ),
        (
            "7800 kg/m^3",
            "210 MPa",
            "deck.toml:6: waves along a bar of `material` run at 164.1 m/s, slower than in any solid so dense, with a Young's modulus of 210 MPa and a density of 7800 kg/m^3: is 210 GPa meant?",
        ),
        (
            "2200 kg/m^3",
            "14.9 kPa",
            "slower than in any solid so dense, with a Young's modulus of 14.9 kPa and a density of 2200 kg/m^3: is 14.9 GPa meant?",
        ),
        ("1100 kg/m^3", "500 Pa", "slower than in any solid, with"),
        (
            "2200 kg/m^3",
            "14.9e12 Pa",
            "faster than in any solid, with a Young's modulus of 14900 GPa and a density of 2200 kg/m^3: is 14.9 GPa meant?",
        ),
    ] {
        let told = lints(density, &pmb(young), "", steps);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].contains(expected), "{told:?}");
    }
    // rubber, foam, cork, lead, diamond
    for (density, young) in [
        ("1100 kg/m^3", "1 MPa"),
        ("30 kg/m^3", "2 MPa"),
        ("240 kg/m^3", "20 MPa"),
        ("11340 kg/m^3", "16 GPa"),
        ("3515 kg/m^3", "1100 GPa"),
    ] {
        let told = lints(density, &pmb(young), "", steps);
        assert!(told.is_empty(), "{told:?}");
    }
    let energy = |young: &str, energy: &str| {
        let fracture = format!("fracture = {{ energy = \"{energy}\" }}");
        lints("1200 kg/m^3", &pmb(young), &fracture, steps)
    };
    for (young, of, expected) in [
        ("70 GPa", "10 GJ/m^2", Some("above 100 %")),
        ("70 GPa", "1e-6 J/m^2", Some("below 0.0001 %")),
        ("70 GPa", "10 J/m^2", None),
        // rubber tears beyond twice its length
        ("1 MPa", "10 kJ/m^2", None),
    ] {
        let told = energy(young, of);
        match expected {
            Some(part) => assert!(
                told[0].contains(part) && told[0].starts_with("deck.toml:7: "),
                "{told:?}"
            ),
            None => assert!(told.is_empty(), "{told:?}"),
        }
    }
    for (stress, meant) in [
        ("350 GPa", Some("350 MPa")),
        ("350 Pa", Some("350 MPa")),
        ("350 MPa", None),
    ] {
        let law = format!(
            "elastic_plastic = {{ young = \"210 GPa\", poisson = 0.3, yield_stress = \"{stress}\" }}"
        );
        let told = lints("7800 kg/m^3", &law, "", steps);
        match meant {
            Some(meant) => assert!(
                told[0].starts_with("deck.toml:6: the yield stress of `material`, ")
                    && told[0].ends_with(&format!("is {meant} meant?")),
                "{told:?}"
            ),
            None => assert!(told.is_empty(), "{told:?}"),
        }
    }
}

/// A program need not read the message.
#[test]
fn decks_that_fail_in_the_build_fail_by_a_kind() {
    use BuildErrorKind::*;
    let unknown = |name: &str| Unknown { name: name.into() };
    let expected = [
        ("crack_without_length", Invalid),
        ("gamma_below_a_half", Invalid),
        ("implicit_without_a_step", Missing),
        ("points_without_material", Missing),
        ("probe_of_unknown_field", unknown("strian")),
        ("unknown_field_to_write", unknown("damge")),
        ("conditions_disagree", Conflict),
        ("period_below_horizon", Conflict),
        ("implicit_beside_held_points", Unsupported),
        ("springs_on_a_cloud", Unsupported),
        ("empty_region", Empty),
        ("cloud_too_thin_for_its_horizon", Empty),
        ("too_many_sites", TooMany),
        ("plate_not_held", IllPosed),
        ("density_of_electrons_negative", IllPosed),
    ];
    let decks = decks("bad/build");
    for (name, kind) in expected {
        let named = |d: &&(PathBuf, String)| d.0.file_stem().is_some_and(|n| n == name);
        let (path, text) = decks.iter().find(named).unwrap();
        let deck = Deck::parse(text, path.to_str().unwrap(), &[]).unwrap();
        let error = build(&deck.spec, Options::default()).err().unwrap();
        assert_eq!(error.kind, kind, "{name}: {error}");
    }
}

/// Each point has the density of the file, unless the materials have one.
#[test]
fn densities_come_from_the_data_file_or_from_the_materials() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/lammps_points.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let densities = |overrides: &[(String, String)]| {
        let deck = Deck::parse(&text, path.to_str().unwrap(), overrides).unwrap();
        let mut sim = build(&deck.spec, Options::default()).unwrap();
        (sim.scalars("density"), sim.families().material)
    };
    let (density, material) = densities(&[]);
    assert_eq!(density.len(), 128);
    for (d, m) in density.iter().zip(&material) {
        assert_eq!(*d, [2700.0, 2200.0][usize::from(*m)]);
    }
    let over = |k: &str| (format!("material.{k}.density"), "1000".to_string());
    let (density, _) = densities(&[over("left"), over("right")]);
    assert!(density.iter().all(|d| *d == 1000.0));
}

/// The disk of the impact, with fracture and contact: state, bonds and lists.
#[test]
fn a_lattice_takes_at_most_155_bytes_per_point() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../decks/good/impact.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let deck = Deck::parse(&text, path.to_str().unwrap(), &[]).unwrap();
    let mut sim = build(&deck.spec, Options::default()).unwrap();
    sim.start(true);
    for _ in 0..3 {
        sim.step().unwrap();
    }
    let info = sim.info();
    let bytes = info.bytes as f64 / info.points as f64;
    assert!((72.0..=155.0).contains(&bytes), "{bytes} bytes per point");
}

/// Laws: the good ones run, the bad ones say what their first line expects.
#[test]
fn decks_of_conservation_laws() {
    use peridyne_io::deck::conservation::LawDeck;
    let good = decks("good/conservation");
    assert!(good.len() >= 5);
    for (path, text) in good {
        let name = path.to_str().unwrap();
        assert!(LawDeck::is_one(&text, &[]), "{name}");
        let mut deck = LawDeck::parse(&text, name, &[])
            .unwrap_or_else(|e| panic!("{name}:{:?}: {e} ({:?})", e.line, e.help));
        let step = deck.evolution.next_step(deck.duration).unwrap();
        deck.evolution.step(step).unwrap();
        // bodies have no kind
        let told = Deck::parse(&text, name, &[]).unwrap_err();
        assert!(told.message.contains("has no body"), "{told}");
    }
    let bad = decks("bad/conservation");
    assert!(bad.len() >= 20);
    let mut wrong = Vec::new();
    for (path, text) in &bad {
        let name = path.file_stem().unwrap().to_str().unwrap();
        // other systems do not say what is left
        if name.ends_with("_beyond_memory") && !cfg!(target_os = "linux") {
            continue;
        }
        let (message, line) = expectation(text).unwrap_or_else(|| panic!("{name}"));
        match LawDeck::parse(text, path.to_str().unwrap(), &[]) {
            Ok(_) => wrong.push(format!("{name}: was accepted")),
            Err(e) if !e.message.contains(message) || line.is_some() && e.line != line => {
                wrong.push(format!("{name}: said {:?} at line {:?}", e.message, e.line));
            }
            Err(_) => {}
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Frames of a law have the solution of the local one and what flows through the faces beside u: between two faces u changes by that.
#[test]
fn frames_of_a_law_have_its_reference_and_its_flux() {
    use ndarray::ArrayD;
    use peridyne_io::conservation::{Listener, RunInputs, run};
    use peridyne_io::deck::conservation::LawDeck;

    struct Silent;
    impl Listener for Silent {
        fn step(&mut self, _: f64, _: u64) {}
        fn ended(&mut self) -> Option<String> {
            None
        }
        fn wants_checkpoint(&mut self) -> bool {
            false
        }
        fn warning(&mut self, text: &str) {
            panic!("{text}");
        }
    }
    let dir = tempfile::tempdir().unwrap();
    let all = decks("good/conservation");
    let (path, text) = { all.iter() }
        .find(|(path, _)| path.ends_with("compare.toml"))
        .unwrap();
    let mut deck = LawDeck::parse(text, path.to_str().unwrap(), &[]).unwrap();
    let report = run(
        &mut deck,
        dir.path(),
        RunInputs::default(),
        &mut Silent,
        None,
    )
    .unwrap();
    let file = std::fs::File::open(dir.path().join("frames.npz")).unwrap();
    let mut archive = ndarray_npy::NpzReader::new(file).unwrap();
    let mut read = |name: &str| -> ArrayD<f64> { archive.by_name(name).unwrap() };
    let [u, exact, flux, faces] = ["u", "exact", "flux", "faces"].map(&mut read);
    assert_eq!((u.shape(), exact.shape()), (&[21, 256][..], &[21, 256][..]));
    assert_eq!((flux.shape(), faces.shape()), (&[21, 257][..], &[257][..]));
    let off: f64 = (0..256).map(|k| (u[[20, k]] - exact[[20, k]]).abs()).sum();
    let size: f64 = (0..256).map(|k| exact[[20, k]].abs()).sum();
    let stated = report.compared.unwrap().error_l1;
    assert!((off / size / stated - 1.0).abs() < 1e-12);
    // x = u t + foot of the exact one
    for k in 0..256 {
        let (x, v) = ((k as f64 + 0.5) / 256.0, exact[[20, k]]);
        assert!((v - (std::f64::consts::TAU * (x - 0.1 * v)).sin()).abs() < 1e-12);
    }
    // Simpson's rule over 20 intervals of time
    let (a, b) = (30, 90);
    let out = |n: usize| flux[[n, b]] - flux[[n, a]];
    let weight = |n: usize| match n {
        0 | 20 => 1.0,
        n if n % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let flown: f64 = (0..=20).map(|n| weight(n) * out(n) * 0.005 / 3.0).sum();
    let mass = |n: usize| (a..b).map(|k| u[[n, k]]).sum::<f64>() / 256.0;
    let change = mass(20) - mass(0);
    assert!(
        (change + flown).abs() < 1e-4 * change.abs(),
        "{change} {flown}"
    );
}
