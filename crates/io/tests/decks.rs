//! Every deck of the repository: the good ones are understood, the bad ones say what their first line expects.

use peridyne::error::BuildErrorKind;
use peridyne::run::{Options, build};
use peridyne_io::deck::Deck;
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
        ("friction_in_statics", Unsupported),
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
fn a_lattice_takes_at_most_150_bytes_per_point() {
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
    assert!((72.0..=150.0).contains(&bytes), "{bytes} bytes per point");
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
