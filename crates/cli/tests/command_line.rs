//! The command line itself: verbs, manual pages, laws by name, decks from standard input, completions, the pager.

use serde_json::Value;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_peridyne");

fn peridyne(dir: &Path, arguments: &[&str], stdin: &str) -> Output {
    let mut child = Command::new(PROGRAM)
        .args(arguments)
        .current_dir(dir)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut into = child.stdin.take().unwrap();
    // who refuses the words of the command line reads nothing
    let _ = into.write_all(stdin.as_bytes());
    drop(into);
    child.wait_with_output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[track_caller]
fn good(dir: &Path, arguments: &[&str], stdin: &str) -> String {
    let output = peridyne(dir, arguments, stdin);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    text(&output.stdout)
}

/// What is said of a mistake, in one line.
#[track_caller]
fn refused(dir: &Path, arguments: &[&str], stdin: &str) -> String {
    let output = peridyne(dir, arguments, stdin);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
    let words = said.split_whitespace().filter(|w| *w != "│" && *w != "×");
    words.collect::<Vec<_>>().join(" ")
}

const CHAIN: &str = r#"units = "none"
[body]
lattice = "chain"
spacing = 1
cells = [40]
[material]
density = 1
law = { springs = { young = 1 } }
[horizon]
m_ratio = 3
[[initial]]
displacement = ["0.001*exp(-((x-20)/4)^2)"]
[run]
steps = 20
"#;

#[test]
fn verbs_stand_in_groups_and_the_version_has_a_commit_or_none() {
    let here = Path::new(".");
    let help = good(here, &["--help"], "");
    let places = [
        "Run:",
        "Understand:",
        "Studies:",
        "Atoms to continuum:",
        "Files:",
        "Shell:",
    ];
    let places = places.map(|group| {
        help.find(group)
            .unwrap_or_else(|| panic!("{group}: {help}"))
    });
    assert!(places.is_sorted(), "{help}");
    assert!(help.find("\n  sweep").unwrap() > places[2], "{help}");
    assert_eq!(help, good(here, &["-h"], ""));
    let version = good(here, &["--version"], "");
    let own = concat!("peridyne ", env!("CARGO_PKG_VERSION"));
    let commit = version.trim().strip_prefix(own).unwrap();
    if !commit.is_empty() {
        let inner = commit.strip_prefix(" (").and_then(|c| c.strip_suffix(')'));
        let (hash, day) = inner.unwrap().split_once(", ").unwrap();
        assert!(
            hash.len() >= 7 && hash.chars().all(|c| c.is_ascii_hexdigit()),
            "{version}"
        );
        let parts: Vec<usize> = day.split('-').map(str::len).collect();
        assert_eq!(parts, [4, 2, 2], "{version}");
    }
}

#[test]
fn a_mistyped_verb_or_flag_is_answered_with_what_was_meant() {
    let here = Path::new(".");
    for (words, says) in [
        (&["rnu"][..], "did you mean `run`?"),
        (&["calib"], "did you mean `calibrate`?"),
        (&["xyzzy"], "`peridyne --help` lists them"),
        (&["mydeck.toml"], "`peridyne run mydeck.toml` runs a file"),
        (
            &["run", "x.toml", "--therads", "2"],
            "did you mean `--threads`?",
        ),
        (&["run", "x.toml", "--steps", "2"], "`--set run.steps=…`"),
        (&["run", "x.toml", "--stpes=2"], "`--set run.steps=…`"),
        (
            &["bar", "--horizon", "2"],
            "`peridyne bar --help` lists those that it has",
        ),
        (&["man", "rnu"], "did you mean `run`?"),
        (&["laws", "lsp"], "did you mean `lps`?"),
        (&["laws", "lsp", "--fields"], "did you mean `lps`?"),
        (&["doc", "run.stpes"], "did you mean `steps`?"),
    ] {
        let said = refused(here, words, "");
        assert!(said.contains(says), "{words:?}: {said}");
    }
}

#[test]
fn every_verb_has_a_manual_page_and_pages_name_each_other() {
    let dir = TempDir::new().unwrap();
    good(dir.path(), &["man", "--out", "pages"], "");
    let pages = dir.path().join("pages");
    let mut names: Vec<String> = std::fs::read_dir(&pages)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert!(
        names.len() > 20 && names.contains(&"peridyne.1".into()),
        "{names:?}"
    );
    for name in &names {
        let page = std::fs::read_to_string(pages.join(name)).unwrap();
        let own = name.strip_suffix(".1").unwrap();
        assert!(page.contains(&format!(".TH {own} 1")), "{name}: {page}");
        for section in [
            "NAME",
            "SYNOPSIS",
            "OPTIONS",
            "\"EXIT STATUS\"",
            "\"SEE ALSO\"",
        ] {
            assert!(
                page.contains(&format!(".SH {section}")),
                "{name} has no {section}"
            );
        }
        for other in page.split("\\fR(1)").filter_map(|t| t.rsplit_once("\\fB")) {
            let other = other.1.replace("\\-", "-");
            assert!(
                names.contains(&format!("{other}.1")),
                "{name} names {other}"
            );
        }
    }
    let run = std::fs::read_to_string(pages.join("peridyne-run.1")).unwrap();
    assert!(
        run.contains("\\fBperidyne run\\fR") && run.contains("\\-\\-set"),
        "{run}"
    );
    assert_eq!(
        run.trim_end(),
        good(dir.path(), &["man", "run"], "").trim_end()
    );
    assert_eq!(
        run.trim_end(),
        good(dir.path(), &["man", "peridyne-run"], "").trim_end()
    );
}

#[test]
fn a_law_is_explained_with_units_bounds_defaults_and_a_deck_that_runs() {
    let dir = TempDir::new().unwrap();
    for law in ["lps", "elastic_plastic", "lennard_jones", "fluid"] {
        let said = good(dir.path(), &["laws", law], "");
        assert_eq!(said, good(dir.path(), &["doc", law], ""), "{law}");
        let deck = said.split("\na deck\n").nth(1).unwrap();
        let deck: String = deck
            .lines()
            .map(|l| format!("{}\n", l.trim_start()))
            .collect();
        let out = format!("--out={law}");
        good(
            dir.path(),
            &["run", "-", &out, "--set", "run.steps=2"],
            &deck,
        );
        let record = std::fs::read(dir.path().join(law).join("run.json")).unwrap();
        let record: Value = serde_json::from_slice(&record).unwrap();
        assert_eq!(record["status"], "done", "{law}");
    }
    let said = good(dir.path(), &["laws", "elastic_plastic"], "");
    for part in [
        "yield_stress: Yield stress σ_y in tension (von Mises). — a pressure (Pa; in metal bar), positive",
        "below 0.5",
        "0 or more; default: 0",
        "plastic_strain ",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let force = good(dir.path(), &["laws", "absorbing_layer"], "");
    assert!(
        force.contains("[boundary_condition.force.absorbing_layer]"),
        "{force}"
    );
    // what is a key or a field is explained, too
    assert!(good(dir.path(), &["laws", "dilatation"], "").contains("a field of points"));
}

#[test]
fn fields_of_laws_are_listed_and_can_be_written() {
    let dir = TempDir::new().unwrap();
    let own = good(dir.path(), &["laws", "elastic_plastic", "--fields"], "");
    let names: Vec<&str> = own
        .lines()
        .filter_map(|l| l.split_whitespace().next())
        .collect();
    assert!(
        names.contains(&"plastic_strain") && names.contains(&"critical_stretch"),
        "{own}"
    );
    assert!(own.lines().all(|l| l.contains("; ")), "{own}");
    let said = good(dir.path(), &["laws", "elastic_plastic"], "");
    let deck = said.split("\na deck\n").nth(1).unwrap();
    let fields = format!("output = {{ fields = {names:?} }}\n");
    let fracture = "material.fracture = { critical_stretch = 0.01 }\n";
    good(
        dir.path(),
        &["run", "-"],
        &format!("{deck}{fracture}{fields}"),
    );
    let wrong = fields.replace("plastic_strain\"", "plastic_strian\"");
    let said = refused(
        dir.path(),
        &["run", "-"],
        &format!("{deck}{fracture}{wrong}"),
    );
    assert!(said.contains("plastic_strian"), "{said}");
    let none = good(dir.path(), &["laws", "springs", "--fields"], "");
    assert!(none.contains("no fields of its own"), "{none}");
}

#[test]
fn decks_come_from_standard_input() {
    let dir = TempDir::new().unwrap();
    let here = dir.path();
    good(here, &["run", "-", "--set", "run.steps=7"], CHAIN);
    let record = |folder: &str| -> Value {
        serde_json::from_slice(&std::fs::read(here.join(folder).join("run.json")).unwrap()).unwrap()
    };
    let piped = record("out/stdin");
    assert_eq!(
        (piped["status"].as_str(), piped["steps"].as_u64()),
        (Some("done"), Some(7))
    );
    // the same bits as of a file
    std::fs::write(here.join("chain.toml"), CHAIN).unwrap();
    good(here, &["run", "chain.toml", "--set", "run.steps=7"], "");
    assert_eq!(piped["state_hash"], record("out/chain")["state_hash"]);
    // every verb that reads a deck
    for words in [
        &["check", "-"][..],
        &["plan", "-", "--nodes", "1,2"],
        &["waves", "-"],
        &["sweep", "-", "--vary", "run.steps=2,3"],
        &["run", "-", "--on-threads", "2", "--out", "ranks"],
    ] {
        good(here, words, CHAIN);
    }
    assert!(here.join("out/stdin-waves").is_dir() && here.join("out/stdin-sweep").is_dir());
    assert_eq!(record("ranks")["status"], "done");
}

#[test]
fn mistakes_in_standard_input_have_its_name_and_a_line() {
    let dir = TempDir::new().unwrap();
    for verb in ["run", "check", "plan"] {
        let said = refused(dir.path(), &[verb, "-"], &CHAIN.replace("steps", "stpes"));
        assert!(
            said.contains("<stdin>:14:1") && said.contains("`steps`"),
            "{said}"
        );
    }
    let said = refused(dir.path(), &["run", "-"], "ITEM: TIMESTEP\n0\n");
    assert!(said.contains("<stdin>: this is a LAMMPS dump"), "{said}");
    assert!(!dir.path().join("out").exists());
    // files are relative to the folder of now
    let deck = CHAIN.replace(
        "lattice = \"chain\"\nspacing = 1\ncells = [40]",
        "file = \"points.xyz\"",
    );
    let said = refused(dir.path(), &["check", "-"], &deck);
    assert!(
        said.contains("points.xyz") && !said.contains("<stdin>/"),
        "{said}"
    );
}

#[test]
fn a_run_of_standard_input_is_resumed_without_it() {
    let dir = TempDir::new().unwrap();
    good(dir.path(), &["run", "-", "--stop-after", "8"], CHAIN);
    good(dir.path(), &["resume", "out/stdin"], "");
    good(dir.path(), &["run", "-", "--out", "whole"], CHAIN);
    let hash = |folder: &str| -> Value {
        let text = std::fs::read(dir.path().join(folder).join("run.json")).unwrap();
        serde_json::from_slice::<Value>(&text).unwrap()["state_hash"].clone()
    };
    assert_eq!(hash("out/stdin"), hash("whole"));
}

#[test]
fn keys_of_decks_are_completed() {
    let dir = TempDir::new().unwrap();
    let keys = good(dir.path(), &["doc", "--keys"], "");
    for key in [
        "run.steps",
        "boundary_condition.0.traction",
        "material.law.lps.young",
        "body.spacing",
    ] {
        assert!(keys.lines().any(|k| k == key), "{key}");
    }
    // one that is completed can be set
    let set = [
        "run",
        "-",
        "--set",
        "initial.0.displacement=[0.002]",
        "--set",
        "run.steps=3",
    ];
    good(dir.path(), &set, CHAIN);

    let script = good(dir.path(), &["completions", "bash"], "");
    std::fs::write(dir.path().join("peridyne.bash"), script).unwrap();
    let complete = |words: &str, at: usize| -> Vec<String> {
        let command = format!(
            "source peridyne.bash; COMP_WORDS=({words}); COMP_CWORD={at}; _peridyne_keys peridyne \"${{COMP_WORDS[COMP_CWORD]}}\" \"${{COMP_WORDS[COMP_CWORD-1]}}\"; printf '%s\\n' \"${{COMPREPLY[@]}}\""
        );
        let output = Command::new("bash")
            .args(["-c", &command])
            .current_dir(dir.path())
            .output()
            .unwrap();
        text(&output.stdout).lines().map(str::to_string).collect()
    };
    let program = format!("'{PROGRAM}'");
    assert_eq!(
        complete(&format!("{program} run x.toml --set run.st"), 4),
        ["run.steps="]
    );
    let all = complete(
        &format!("{program} sweep x.toml --vary = material.law.lps."),
        5,
    );
    assert!(
        all.contains(&"material.law.lps.young=".to_string()),
        "{all:?}"
    );
    // all else is as it was
    let flags = complete("peridyne run --thr", 2);
    assert_eq!(flags, ["--threads"], "{flags:?}");

    let zsh = good(dir.path(), &["completions", "zsh"], "");
    assert!(zsh.contains("KEY=VALUE:_peridyne_keys'"), "{zsh}");
    assert!(zsh.contains("\n_peridyne_keys() {"), "{zsh}");
    assert!(
        zsh.find("_peridyne_keys() {") < zsh.find("if [ \"$funcstack[1]\""),
        "{zsh}"
    );
    let fish = good(dir.path(), &["completions", "fish"], "");
    assert!(
        fish.contains("-l set -x -a \"(peridyne doc --keys"),
        "{fish}"
    );
}

/// What the program prints on a terminal of its own, and what PAGER was given.
#[cfg(target_os = "linux")]
fn at_a_terminal(
    arguments: &[&str],
    pager: Option<&str>,
    more: &[(&str, &str)],
) -> (String, Option<String>) {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    let dir = TempDir::new().unwrap();
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, vec![]).unwrap();
    let open = || {
        let path = Path::new(name.to_str().unwrap());
        let options = std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(path);
        options.unwrap()
    };
    let mut command = Command::new(PROGRAM);
    command
        .args(arguments)
        .current_dir(dir.path())
        .stdout(open());
    command.env_remove("NO_PAGER").env_remove("PAGER");
    if let Some(pager) = pager {
        command.env("PAGER", pager);
    }
    command.envs(more.iter().copied());
    let mut child = command.spawn().unwrap();
    drop(command);
    // the reader goes on until nobody has the terminal
    let mut shown = vec![];
    let mut master = std::fs::File::from(master);
    let mut buffer = [0; 4096];
    while let Ok(n @ 1..) = master.read(&mut buffer) {
        shown.extend_from_slice(&buffer[..n]);
    }
    assert!(child.wait().unwrap().success());
    let seen = std::fs::read_to_string(dir.path().join("seen")).ok();
    (text(&shown), seen)
}

#[cfg(target_os = "linux")]
#[test]
fn long_text_goes_through_the_pager_at_a_terminal_only() {
    let tee = Some("tee seen");
    let (shown, seen) = at_a_terminal(&["laws"], tee, &[]);
    let piped = good(Path::new("."), &["laws"], "");
    assert_eq!(seen.as_deref(), Some(&*piped));
    assert_eq!(shown.replace("\r\n", "\n"), piped);
    for (arguments, more) in [
        (&["laws", "lps", "--no-pager"][..], &[][..]),
        (&["doc", "lps"], &[("NO_PAGER", "1")]),
    ] {
        let (shown, seen) = at_a_terminal(arguments, tee, more);
        assert!(shown.contains("Poisson") && seen.is_none(), "{shown}");
    }
    // none, one that is not there, and one whose reader leaves at once
    for pager in ["", "no-such-pager -x"] {
        let (shown, _) = at_a_terminal(&["doc", "lps"], Some(pager), &[]);
        assert!(shown.contains("Poisson"), "{pager}: {shown}");
    }
    let (shown, _) = at_a_terminal(&["laws"], Some("head -n 1"), &[]);
    assert_eq!(shown.lines().count(), 1, "{shown}");
    // piped it is never asked for
    let dir = TempDir::new().unwrap();
    let output = Command::new(PROGRAM)
        .args(["doc", "lps"])
        .env("PAGER", "tee seen")
        .current_dir(dir.path())
        .output()
        .unwrap();
    assert!(output.status.success() && !dir.path().join("seen").exists());
}
