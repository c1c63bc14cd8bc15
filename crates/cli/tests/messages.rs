//! What the program says of files that somebody else wrote: briefly, with the true cause, and nothing in it steers the terminal.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Exit code, and what was printed in both ways.
fn peridyne(dir: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let Output {
        status,
        stdout,
        stderr,
    } = Command::new(env!("CARGO_BIN_EXE_peridyne"))
        .args(arguments)
        .current_dir(dir)
        .output()
        .unwrap();
    let said = [stdout, stderr].map(|text| String::from_utf8(text).unwrap());
    (status.code(), said.concat())
}

/// What `check` says of files, the first of which is checked.
fn checked(files: &[(&str, &str)], more: &[&str]) -> (Option<i32>, String) {
    let dir = TempDir::new().unwrap();
    for (name, text) in files {
        fs::write(dir.path().join(name), text).unwrap();
    }
    peridyne(dir.path(), &[&["check", files[0].0], more].concat())
}

#[track_caller]
fn refused(files: &[(&str, &str)], more: &[&str]) -> String {
    let (code, said) = checked(files, more);
    assert_eq!(code, Some(2), "{}", &said[..said.len().min(2000)]);
    said
}

/// A screen has more.
#[track_caller]
fn brief(said: &str) {
    let (lines, characters) = (said.lines().count(), said.chars().count());
    assert!(
        lines < 24 && characters < 1500,
        "{lines} lines, {characters} characters"
    );
}

/// A deck of a square body, with more keys.
fn deck(body: &str, more: &str) -> String {
    format!(
        "horizon = {{ m_ratio = 3 }}\nrun = {{ steps = 2 }}\nmaterial = {{ density = 2200, law = {{ pmb = {{ young = \"14.9 GPa\" }} }} }}\nbody = {{ {body} }}\n{more}\n"
    )
}

const SQUARE: &str = "lattice = \"square\", spacing = \"1 mm\", cells = [8, 8]";

#[test]
fn mistakes_far_to_the_right_of_a_line_are_shown() {
    let blocks: String = (0..2100)
        .map(|n| {
            format!(
                "{{ block = {{ low = [{n}, 0], high = [{}, 1] }} }}, ",
                n + 1
            )
        })
        .collect();
    let region =
        format!("lattice = \"square\", spacing = \"1 mm\", region = {{ union = [{blocks}] }}");
    for (wrong, says) in [
        ("speling = 1", "unknown key `speling`"),
        ("origin = 2", "expected"),
    ] {
        let said = refused(&[("d.toml", &deck(&format!("{region}, {wrong}"), ""))], &[]);
        assert!(
            said.contains(says) && said.contains("…") && said.contains(wrong),
            "{said}"
        );
        // the column is that of the file
        assert!(said.contains("[d.toml:4:1"), "{said}");
        brief(&said);
    }
    // the whole line is at fault
    let said = refused(&[("d.toml", &format!("x{}", "y".repeat(70_000)))], &[]);
    brief(&said);
    // of an override, a script, a name
    let plain = deck(SQUARE, "");
    let long = format!("material.density={}", "9".repeat(70_000));
    brief(&refused(&[("d.toml", &plain)], &["--set", &long]));
    let script = format!("units si\nprint \"{}\" fast\n", "z ".repeat(40_000));
    let said = refused(&[("in.x", &script)], &[]);
    assert!(said.contains("in.x:2") && said.contains("fast"), "{said}");
    brief(&said);
    let name = format!("body = {{ {SQUARE} }}\n{}.x = 1\n", "a".repeat(70_000));
    brief(&refused(&[("d.toml", &name)], &[]));
}

#[test]
fn files_are_not_echoed() {
    let number = format!("0 0 0 1e-9\n0.001 0 0 1e-9{}\n", "1".repeat(10_000));
    let words = format!("{}\n", "word ".repeat(10_000));
    let entry = format!("Si Si Si {}\n", "no ".repeat(40_000));
    let body = |file: &str| deck(&format!("file = \"{file}\", spacing = \"1 mm\""), "");
    for (file, text) in [
        ("p.txt", &number),
        ("p.txt", &words),
        ("p.data", &words),
        ("p.inp", &words),
        ("p.msh", &words),
    ] {
        let said = refused(&[("d.toml", &body(file)), (file, text)], &[]);
        assert!(said.contains(file), "{said}");
        brief(&said);
    }
    let silicon = "units = \"metal\"\nbody = { lattice = \"diamond\", spacing = 5.431, cells = [2, 2, 2] }\nmaterial = { mass = 28, law = { stillinger_weber = { file = \"s.sw\" } } }\nrun = { steps = 1 }\n";
    brief(&refused(&[("d.toml", silicon), ("s.sw", &entry)], &[]));
}

/// Nothing but lines and tabs, and no letters that run backwards.
#[track_caller]
fn harmless(said: &str) {
    let steers =
        |c: &char| c.is_control() && !"\n\t".contains(*c) || ('\u{202a}'..='\u{202e}').contains(c);
    if let Some(c) = said.chars().find(steers) {
        panic!("{c:?} in {said:?}");
    }
}

#[test]
fn nothing_that_files_say_steers_the_terminal() {
    let owned = "\u{1b}]0;owned\u{7}\u{202e}";
    let typed = "\\u001b]0;owned\\u0007\\u202e";
    let title = deck(SQUARE, "").replacen(
        "horizon",
        &format!("title = \"{typed}\\nwarning: no\"\nhorizon"),
        1,
    );
    let (code, said) = checked(&[("d.toml", &title)], &[]);
    assert_eq!(code, Some(0), "{said}");
    harmless(&said);
    assert!(
        said.contains("\\u{1b}]0;owned\\u{7}\\u{202e}\\u{a}warning: no"),
        "{said}"
    );
    let (_, json) = checked(&[("d.toml", &title)], &["--json"]);
    harmless(&json);
    let read: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(read["title"], format!("{owned}\nwarning: no"));

    let of = |more: &str| deck(SQUARE, &more.replace("OWNED", typed));
    let raw = |more: &str| deck(SQUARE, &more.replace("OWNED", owned));
    let points = format!("0 0 0 {owned}\n");
    let body = deck("file = \"p.txt\", spacing = \"1 mm\"", "");
    let shown: [&[(&str, &str)]; 14] = [
        // keys and names
        &[("d.toml", &of("[sets]\n\"OWNED\" = { where = \"x > 0\" }"))],
        &[(
            "d.toml",
            &of("probe = [{ name = \"OWNED\", set = \"all\", measure = \"energy\" }]"),
        )],
        &[("d.toml", &of("\"OWNED\" = 1"))],
        // values
        &[(
            "d.toml",
            &of("boundary_condition = [{ set = \"OWNED\", displacement = [0, 0] }]"),
        )],
        &[("d.toml", &of("dimension = \"OWNED\""))],
        &[("d.toml", &of("surface = \"OWNED\""))],
        &[("d.toml", &of("initial = [{ velocity = [\"1 OWNED\", 0] }]"))],
        &[(
            "d.toml",
            &of("output = { pictures = [{ field = \"OWNED\" }] }"),
        )],
        &[("d.toml", &deck("file = \"\\u001b[31m.txt\"", ""))],
        // comments and what is no TOML
        &[("d.toml", &raw("speling = 1 # OWNED"))],
        &[("d.toml", &raw("# OWNED\nspeling = 1"))],
        // other files
        &[("d.toml", &body), ("p.txt", &points)],
        &[(
            "in.x",
            &format!("units si # {owned}\nlattice {owned} 1 # {owned}\n"),
        )],
        &[(
            "in.x",
            &format!("print \"{owned}\"\nread_data \"{owned}\"\n"),
        )],
    ];
    for files in shown {
        let said = refused(files, &[]);
        harmless(&said);
        // as it is printed, or as it was typed
        let shown = ["\\u{1b}", "\\u001b"].iter().any(|s| said.contains(s));
        assert!(shown, "{said}");
    }
    // what somebody was asked to type
    for more in [
        ["--set", "run.steps=\u{1b}[31m"],
        ["--set", "\u{1b}[31m=1"],
        ["--simd", "\u{1b}[31m"],
        ["--threads", "\u{1b}[31m"],
    ] {
        harmless(&refused(&[("d.toml", &deck(SQUARE, ""))], &more));
    }
}

/// A comma in a name is quoted; a break of the line would end a row of the history.
#[test]
fn names_have_one_line() {
    let dir = TempDir::new().unwrap();
    let probe = |name: &str| {
        deck(
            SQUARE,
            &format!("probe = [{{ name = \"{name}\", set = \"all\", measure = \"energy\" }}]"),
        )
    };
    fs::write(dir.path().join("comma.toml"), probe("a,b")).unwrap();
    let (code, said) = peridyne(dir.path(), &["run", "comma.toml", "--out", "o"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(dir.path().join("o/report.html").exists());
    fs::write(dir.path().join("line.toml"), probe("a\\nb")).unwrap();
    let (code, said) = peridyne(dir.path(), &["run", "line.toml", "--out", "p"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("[line.toml:5:") && said.contains("control character \\u{a}"),
        "{said}"
    );
    assert!(!dir.path().join("p").exists());
}

/// Without the ends of lines, which are those of the terminal.
fn flat(said: &str) -> String {
    let words: Vec<&str> = { said.split_whitespace() }
        .filter(|word| *word != "│")
        .collect();
    words.join(" ")
}

#[test]
fn causes_are_the_true_ones() {
    let plate: String = (0..16)
        .map(|n| format!("{}e-3 0 {}e-3 1e-9\n", n % 4, n / 4))
        .collect();
    let solid: String = (0..27)
        .map(|n| format!("{} {} {} 1\n", n % 3, n / 3 % 3, n / 9))
        .collect();
    let line: String = (0..9).map(|n| format!("0 {n} 0 1\n")).collect();
    let points = |more: &str| deck("file = \"p.txt\", spacing = \"1 mm\"", more);
    let body = |more: &str| deck(&format!("file = \"p.txt\"{more}"), "");
    for (files, says, help) in [
        (
            vec![("d.toml", points("dimension = 2")), ("p.txt", plate)],
            "z is not the same everywhere: it runs from 0 to 0.003",
            "a body in 2-D lies in x and y: exchange the coordinates",
        ),
        (
            vec![("d.toml", points("dimension = 2")), ("p.txt", solid)],
            "z is not the same everywhere: it runs from 0 to 2",
            "a shell) makes no body",
        ),
        (
            vec![("d.toml", points("dimension = 1")), ("p.txt", line.clone())],
            "It lies in y, and a body in 1-D lies in x",
            "exchange the coordinates",
        ),
        (
            vec![("d.toml", body(", file_unit = \"mm\"")), ("p.txt", line)],
            "the unit \"mm\" has no number",
            "write the number before it: \"1 mm\"",
        ),
        (
            vec![(
                "d.toml",
                deck(
                    "lattice = \"square\", spacing = \"2 * mm\", cells = [4, 4]",
                    "",
                ),
            )],
            "the unit \"mm\" has no number",
            "1 mm",
        ),
    ] {
        let files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (*n, &**t)).collect();
        // lines of messages are broken where the terminal ends
        let said = flat(&refused(&files, &[]));
        assert!(said.contains(says) && said.contains(help), "{said}");
    }
}

#[test]
fn overrides_of_lists_name_entries_that_are_there() {
    let two = deck(
        SQUARE,
        "sets = { foot = { where = \"y < 1 mm\" }, head = { where = \"y > 6 mm\" } }\n[[boundary_condition]]\nset = \"foot\"\ndisplacement = [0, 0]\n[[boundary_condition]]\nset = \"head\"\nvelocity = [0, 1]",
    );
    let files = [("d.toml", &*two)];
    let (code, said) = checked(&files, &["--set", "boundary_condition.1.velocity=[0, 2]"]);
    assert_eq!(code, Some(0), "{said}");
    for (set, says, help) in [
        (
            "boundary_condition.5.traction.y=1",
            "there is no entry 5 of `boundary_condition`: it has 2 entries",
            "numbered 0 to 1",
        ),
        (
            "boundary_condition.traction.y=1",
            "`boundary_condition` is a list, and traction is no entry of it",
            "boundary_condition.0",
        ),
        ("probe.0.name=a", "the deck has no `probe`", "add [[probe]]"),
    ] {
        let said = flat(&refused(&files, &["--set", set]));
        assert!(said.contains(says) && said.contains(help), "{said}");
        assert!(said.contains("--set "), "{said}");
    }
}

#[test]
fn one_is_not_many() {
    let one = deck(SQUARE, "initial = [{ velocity = [1, 0] }]");
    let (code, said) = checked(&[("d.toml", &one)], &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("1 initial value, 0 boundary conditions, 0 pre-cracks"),
        "{said}"
    );
}

/// One command installs and one tests; continuous integration runs that letter by letter.
#[test]
fn the_readme_installs_and_tests() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    let readme = read("README.md");
    let blocks: Vec<&str> = { readme.split("```sh\n").skip(1) }
        .map(|rest| rest.split("\n```").next().unwrap())
        .collect();
    let [install, test] = blocks[..] else {
        panic!("{blocks:?}")
    };
    assert!(
        read("docs/book/src/index.md").contains(&format!("```sh\n{install}\n```")),
        "{install}"
    );
    assert!(read(".ci/run").lines().any(|line| line == test), "{test}");
}
