//! What helps at the terminal: decks to begin with, explanations of keys, completions, the manual; and the pictures that a deck asks for.

use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const KINDS: [&str; 9] = [
    "crack",
    "wave",
    "impact",
    "statics",
    "atoms",
    "upscale",
    "coarsen",
    "fields",
    "conservation_law",
];

fn peridyne(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = peridyne(folder, arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        said(&output)
    );
    printed(&output)
}

#[test]
fn every_new_deck_passes_its_check_and_says_what_to_look_at() {
    let dir = TempDir::new().unwrap();
    let listed = good(dir.path(), &["new"]);
    for kind in KINDS {
        assert!(listed.contains(kind), "{listed}");
        let next = good(dir.path(), &["new", kind]);
        let deck = format!("{kind}.toml");
        assert!(next.contains(&format!("peridyne check {deck}")), "{next}");
        let found = good(dir.path(), &["check", &deck]);
        if kind != "conservation_law" {
            assert!(found.contains("Look at\n  1. "), "{kind}: {found}");
        }
    }
}

#[test]
fn new_decks_run() {
    let dir = TempDir::new().unwrap();
    for (kind, less) in [
        ("crack", "run.duration=4 us"),
        ("wave", "run.duration=8 us"),
        ("impact", "run.duration=10 us"),
        ("statics", "constants.d=1 mm"),
        ("atoms", "run.steps=10"),
        ("fields", "run.steps=20"),
        ("conservation_law", "points=300"),
    ] {
        good(dir.path(), &["new", kind]);
        let deck = format!("{kind}.toml");
        good(dir.path(), &["run", &deck, "--set", less]);
        assert!(
            dir.path()
                .join("out")
                .join(kind)
                .join("history.csv")
                .exists()
        );
    }
}

#[test]
fn a_file_that_exists_is_left_alone() {
    let dir = TempDir::new().unwrap();
    std::fs::write(dir.path().join("mine.toml"), "mine").unwrap();
    let refused = peridyne(dir.path(), &["new", "crack", "mine.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        said(&refused).contains("mine.toml exists"),
        "{}",
        said(&refused)
    );
    assert_eq!(
        std::fs::read_to_string(dir.path().join("mine.toml")).unwrap(),
        "mine"
    );
}

#[test]
fn keys_tables_laws_and_fields_are_explained() {
    let here = Path::new(".");
    let key = good(here, &["doc", "run.time_step"]);
    assert!(
        key.contains("in [run]") && key.contains("a time (s; in metal ps)"),
        "{key}"
    );
    assert!(good(here, &["doc", "time_step"]).contains("run.time_step"));
    let table = good(here, &["doc", "[material.fracture]"]);
    assert!(
        table.contains("critical_stretch") && table.contains("energy"),
        "{table}"
    );
    let law = good(here, &["doc", "lps"]);
    assert!(
        law.contains("young") && law.contains("material.law = { lps = {"),
        "{law}"
    );
    assert!(good(here, &["doc", "stress"]).contains("a field of points"));
    assert!(good(here, &["doc"]).contains("[[probe]]"));
    let wrong = peridyne(here, &["doc", "run.tme_step"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(
        said(&wrong).contains("did you mean `time_step`?"),
        "{}",
        said(&wrong)
    );
}

#[test]
fn the_reference_has_a_page_for_every_table_and_its_links_lead_somewhere() {
    let dir = TempDir::new().unwrap();
    let decks = concat!(env!("CARGO_MANIFEST_DIR"), "/../../decks/good");
    good(dir.path(), &["doc", "--book", "pages", "--decks", decks]);
    let pages = dir.path().join("pages");
    let mut links = 0;
    for entry in std::fs::read_dir(&pages).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        for link in text.split("](").skip(1) {
            let file = link.split(')').next().unwrap();
            assert!(pages.join(file).exists(), "{file}");
            links += 1;
        }
    }
    assert!(links > 100, "{links}");
    let run = std::fs::read_to_string(pages.join("run.md")).unwrap();
    assert!(
        run.contains("<a id=\"time_step\">") && run.contains("Example: "),
        "{run}"
    );
}

#[test]
fn completions_and_the_manual() {
    let here = Path::new(".");
    assert!(good(here, &["completions", "bash"]).contains("_peridyne"));
    assert!(good(here, &["completions", "fish"]).contains("complete -c peridyne"));
    let manual = good(here, &["man"]);
    assert!(
        manual.contains(".TH peridyne") && manual.contains("peridyne\\-upscale\\fR(1)"),
        "{manual}"
    );
}

/// A plate that is pulled, with what it should draw.
fn plate(dir: &Path, output: &str) {
    let deck = format!(
        r#"horizon = {{ m_ratio = 3 }}
body = {{ lattice = "square", spacing = 1, cells = [21, 11] }}
units = "none"
material = {{ density = 1, law = {{ lps = {{ young = 1, poisson = 0.3 }} }} }}
condition = [
  {{ region = {{ block = {{ low = [0, 0], high = [2, 10] }} }}, displacement = [0, 0] }},
  {{ region = {{ block = {{ low = [18, 0], high = [20, 10] }} }}, displacement = {{ x = "0.1*t" }} }},
]
[statics]
modes = 2
[output]
{output}
"#
    );
    std::fs::write(dir.join("plate.toml"), deck).unwrap();
}

#[test]
fn pictures_show_what_the_run_is_about_or_what_is_asked_for() {
    let dir = TempDir::new().unwrap();
    plate(dir.path(), "");
    let told = good(dir.path(), &["run", "plate.toml"]);
    assert!(told.contains("displacement.png"), "{told}");
    let out = dir.path().join("out/plate");
    assert!(out.join("displacement.png").exists() && !out.join("damage.png").exists());
    assert!(out.join("modes/mode_01.png").exists() && out.join("modes/mode_02.png").exists());

    plate(
        dir.path(),
        r#"pictures = [{ field = "stress", component = "xx", scale = 20, range = [0, 0.01], film = true }, { field = "velocity" }]"#,
    );
    good(dir.path(), &["run", "plate.toml", "--out", "more"]);
    let out = dir.path().join("more");
    assert!(out.join("stress_xx.png").exists() && out.join("velocity.png").exists());
    assert!(!out.join("displacement.png").exists());
    let film = std::fs::read(out.join("stress_xx_film.png")).unwrap();
    // an animated PNG says so before its pixels, and how many frames it has
    let place = film.windows(4).position(|w| w == b"acTL").unwrap();
    assert_eq!(film[place + 4..place + 8], [0, 0, 0, 2]);
}

#[test]
fn a_film_of_statics_is_magnified_like_its_picture() {
    let dir = TempDir::new().unwrap();
    plate(
        dir.path(),
        r#"pictures = [{ field = "displacement", film = true }]"#,
    );
    good(dir.path(), &["run", "plate.toml", "--out", "auto"]);
    plate(
        dir.path(),
        r#"pictures = [{ field = "displacement", film = true, scale = 1 }]"#,
    );
    good(dir.path(), &["run", "plate.toml", "--out", "plain"]);
    let film =
        |out: &str| std::fs::read(dir.path().join(out).join("displacement_film.png")).unwrap();
    assert!(film("auto") != film("plain"));
}

#[test]
fn a_load_that_is_over_is_drawn_as_a_load() {
    let dir = TempDir::new().unwrap();
    let picture = |velocity: &str, out: &str| {
        let deck = format!(
            r#"horizon = {{ m_ratio = 3 }}
units = "none"
body = {{ lattice = "square", spacing = 1, cells = [21, 11] }}
material = {{ density = 1, law = {{ lps = {{ young = 1, poisson = 0.3 }} }} }}
boundary_condition = [{{ region = {{ block = {{ low = [18, 0], high = [20, 10] }} }}, velocity = {{ x = "{velocity}" }} }}]
run = {{ steps = 10, time_step = 0.1 }}
output = {{ vtu = false, report = false, pictures = [{{ field = "block" }}] }}
"#
        );
        std::fs::write(dir.path().join("pulse.toml"), deck).unwrap();
        good(dir.path(), &["run", "pulse.toml", "--out", out]);
        std::fs::read(dir.path().join(out).join("block.png")).unwrap()
    };
    // so slow that points stay on their pixels: pictures differ by what is drawn over them
    let held = picture("0", "held");
    assert!(picture("t < 0.5 ? 1e-9 : 0", "pulse") == picture("1e-9", "pull"));
    assert!(picture("t < 0.5 ? 1e-9 : 0", "again") != held);
}

#[test]
fn a_picture_of_nothing_is_refused_before_anything_runs() {
    let dir = TempDir::new().unwrap();
    for (output, word) in [
        (r#"pictures = [{ field = "strss" }]"#, "no field `strss`"),
        (
            r#"pictures = [{ field = "stress", component = "q" }]"#,
            "no component q",
        ),
        (
            r#"pictures = [{ field = "damage", range = [1, 0] }]"#,
            "[low, high]",
        ),
    ] {
        plate(dir.path(), output);
        let refused = peridyne(dir.path(), &["run", "plate.toml"]);
        assert_eq!(refused.status.code(), Some(2), "{output}");
        let said = said(&refused);
        assert!(
            said.contains(word) && said.contains("plate.toml:"),
            "{said}"
        );
        assert!(!dir.path().join("out").exists());
    }
}
