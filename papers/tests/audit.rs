//! The table of the papers, `AUDIT.md`: what it names is there, and what it calls done is held by a test or a claim.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn text() -> String {
    std::fs::read_to_string(root().join("papers/AUDIT.md")).unwrap()
}

/// A row of a paper: number, item, where, verdict, what holds it.
fn rows(text: &str) -> Vec<[&str; 5]> {
    let numbered = |line: &&str| line.starts_with("| ") && line.as_bytes()[2].is_ascii_digit();
    let cells = |line| str::trim_matches(line, '|').split('|').map(str::trim);
    text.lines()
        .filter(numbered)
        .map(|line| {
            let row: Vec<&str> = cells(line).collect();
            row.try_into()
                .unwrap_or_else(|row| panic!("a row has five cells, without | in them: {row:?}"))
        })
        .collect()
}

/// What stands between backticks and begins with a folder of the repository.
fn paths(text: &str) -> impl Iterator<Item = &str> {
    let folders = ["crates/", "decks/", "docs/", "papers/", "verify/"];
    text.lines()
        .flat_map(|line| line.split('`').skip(1).step_by(2))
        .filter(move |quoted| folders.iter().any(|folder| quoted.starts_with(folder)))
}

/// Is there a function of this name under `#[test]`?
fn has_test(source: &str, name: &str) -> bool {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let function = format!("fn {name}(");
    (0..lines.len())
        .filter(|&n| lines[n].starts_with(&function))
        .any(|n| {
            let above = lines[..n].iter().rev();
            above
                .take_while(|line| line.starts_with("#[") || line.starts_with("//"))
                .any(|line| *line == "#[test]")
        })
}

fn has_claim(claims: &str, key: &str) -> bool {
    let table: toml::Table = claims.parse().unwrap();
    let all = table["claim"].as_array().unwrap();
    all.iter().any(|claim| claim["key"].as_str() == Some(key))
}

/// Why this path, or the name behind its colon, is not there.
fn fault(reference: &str) -> Option<String> {
    let (path, name) = match reference.split_once(':') {
        Some((path, name)) => (path, Some(name)),
        None => (reference, None),
    };
    let file = root().join(path);
    if !file.exists() {
        return Some(format!("{reference}: no such file"));
    }
    let name = name?;
    let held = std::fs::read_to_string(&file).unwrap();
    let (there, what) = match path {
        _ if path.ends_with(".rs") => (has_test(&held, name), "test"),
        _ if path.ends_with("/claims.toml") => (has_claim(&held, name), "claim"),
        _ => (false, "file of tests or claims"),
    };
    (!there).then(|| format!("{reference}: no such {what}"))
}

fn none(faults: &[String]) {
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_the_table_names_is_there() {
    none(&paths(&text()).filter_map(fault).collect::<Vec<_>>());
}

#[test]
fn rows_follow_each_other_and_have_a_verdict() {
    let text = text();
    let mut last: BTreeMap<u32, u32> = BTreeMap::new();
    for [number, _, _, verdict, _] in rows(&text) {
        let (paper, n) = number.split_once('.').unwrap();
        let n: u32 = n.parse().unwrap();
        let before = last.insert(paper.parse().unwrap(), n);
        assert_eq!(n, before.unwrap_or(0) + 1, "row {number}");
        assert!(
            verdict.starts_with(['✓', '~', 'L', '≠', '✗', '!']),
            "row {number}: {verdict}"
        );
    }
    assert_eq!(last.into_keys().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 21]);
}

#[test]
fn what_is_done_has_a_test_or_a_claim() {
    let text = text();
    let bare = |row: &[&str; 5]| {
        let named = paths(row[4]).any(|reference| reference.contains(':'));
        row[3].contains('✓') && !named && !row[4].contains("TODO(")
    };
    let faults = rows(&text).into_iter().filter(bare);
    none(
        &faults
            .map(|row| format!("{}: nothing holds it", row[0]))
            .collect::<Vec<_>>(),
    );
}

#[test]
fn nothing_is_left_to_fill_in() {
    let text = text();
    let left = text.lines().filter(|line| line.contains("TODO"));
    none(
        &left
            .map(|line| line.chars().take(60).collect())
            .collect::<Vec<_>>(),
    );
}
