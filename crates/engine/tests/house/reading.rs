//! Files of the crates, and their code.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A crate's modules: path and file.
pub type Modules = BTreeMap<Vec<String>, PathBuf>;

/// A folder of this crate.
pub fn own(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)
}

/// Modules of the engine and of the mechanics that it runs, which it has under its own name.
pub fn engine() -> Modules {
    let mut all = modules(&own("../mechanics/src"));
    all.extend(modules(&own("src")));
    all
}

/// The sources of each crate.
pub fn crates() -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = fs::read_dir(own(".."))
        .unwrap()
        .map(|e| e.unwrap().path().join("src"))
        .filter(|p| p.is_dir())
        .collect();
    all.sort();
    assert!(all.len() >= 5, "{all:?}");
    all
}

/// All files of the language in a folder and its folders.
pub fn files(root: &Path) -> Vec<PathBuf> {
    let (mut open, mut found) = (vec![root.to_path_buf()], vec![]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The name of a file in a folder.
pub fn within(file: &Path, folder: &Path) -> String {
    file.strip_prefix(folder)
        .unwrap()
        .to_str()
        .unwrap()
        .to_string()
}

/// Files that are no tests, which may import what they like.
pub fn modules(root: &Path) -> Modules {
    let module = |file: PathBuf| {
        let name = within(&file, root);
        let path = name.strip_suffix(".rs").unwrap().split('/');
        let mut path: Vec<String> = path.map(String::from).collect();
        let test = |n: &String| n == "tests" || n == "samples" || n.ends_with("_tests");
        if path.iter().any(test) {
            return None;
        }
        let is_root = path.len() == 1 && matches!(&*path[0], "lib" | "main");
        if is_root || path.last().is_some_and(|n| n == "mod") {
            path.pop();
        }
        Some((path, file))
    };
    files(root).into_iter().filter_map(module).collect()
}

/// Code without comments, tests, and modules that visibilities name.
pub fn code(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let mut text = &*text;
    for tests in ["#[cfg(test)]\nmod tests {", "#[cfg(test)]\npub mod tests {"] {
        text = text.split(tests).next().unwrap();
    }
    let lines = text.lines().map(|l| l.split("//").next().unwrap());
    let text = lines.collect::<Vec<_>>().join("\n");
    let mut parts = text.split("pub(in ");
    let first = parts.next().unwrap().to_string();
    parts.fold(first, |all, part| {
        let (_, rest) = part.split_once(')').unwrap();
        all + "pub" + rest
    })
}

/// Code of all crates without tests, by the path from the folder of the crates.
pub fn sources() -> BTreeMap<String, String> {
    let of = |root: PathBuf| {
        let folder = root.parent().unwrap().parent().unwrap().to_path_buf();
        let files = modules(&root).into_values();
        files.map(move |file| (within(&file, &folder), code(&file)))
    };
    crates().into_iter().flat_map(of).collect()
}

/// Names of functions, how they are set in, and their lines.
pub fn functions(text: &str) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = vec![];
    for (n, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let set_in = line.len() - code.len();
        let words = ["pub ", "const ", "unsafe ", "async "];
        let mut rest = code;
        while let Some(word) = words.iter().find_map(|w| rest.strip_prefix(w)) {
            rest = word;
        }
        if let Some(inner) = rest.strip_prefix("pub(") {
            rest = inner.split_once(") ").map_or("", |(_, rest)| rest);
        }
        let Some(name) = rest.strip_prefix("fn ") else {
            continue;
        };
        // a signature that ends without a body
        let end = lines[n..]
            .iter()
            .position(|l| l.ends_with('{') || l.ends_with(';') || l.ends_with('}'));
        let signature = lines[n + end.unwrap_or(0)];
        let close = format!("{}}}", " ".repeat(set_in));
        let body = match signature.ends_with('{') {
            true => lines[n..].iter().position(|l| **l == close).unwrap_or(0) + 1,
            false => end.unwrap_or(0) + 1,
        };
        let name = name.split(['(', '<']).next().unwrap_or(name);
        found.push((name.to_string(), set_in, body));
    }
    found
}
