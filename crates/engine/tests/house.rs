//! The order of the house: folders of the engine import downwards only, and files import each other in a circle only
//! inside one folder.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the engine, from the ground up; those of one line do not know each other.
const FLOORS: &[&[&str]] = &[
    &["error"],
    &["execute"],
    &["space", "columns", "expression"],
    &["spec"],
    &["body"],
    &["family"],
    &["law"],
    &["interaction"],
    &["fracture"],
    &["condition", "dynamics", "statics"],
    &["observe"],
    &["run"],
];

/// Circles that may be, by one of their files, and why.
const CIRCLES: &[(&str, &str)] = &[];

/// A crate's modules: path and file.
type Modules = BTreeMap<Vec<String>, PathBuf>;

fn crates() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all: Vec<PathBuf> = fs::read_dir(root)
        .unwrap()
        .map(|e| e.unwrap().path().join("src"))
        .filter(|p| p.is_dir())
        .collect();
    all.sort();
    assert!(all.len() >= 5, "{all:?}");
    all
}

fn modules(root: &Path) -> Modules {
    fn walk(folder: &Path, path: &[String], found: &mut Modules) {
        for entry in fs::read_dir(folder).unwrap() {
            let entry = entry.unwrap().path();
            let name = entry.file_stem().unwrap().to_str().unwrap().to_string();
            // tests may import what they like
            if name == "tests" || name == "samples" || name.ends_with("_tests") {
                continue;
            }
            if entry.is_dir() {
                walk(&entry, &[path, &[name]].concat(), found);
            } else if entry.extension().is_some_and(|e| e == "rs") {
                let own = match &*name {
                    "mod" => path.to_vec(),
                    "lib" | "main" if path.is_empty() => vec![],
                    _ => [path, &[name]].concat(),
                };
                found.insert(own, entry);
            }
        }
    }
    let mut found = Modules::new();
    walk(root, &[], &mut found);
    found
}

/// Code without comments and tests.
fn code(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let lines = text.lines().map(|l| l.split("//").next().unwrap());
    lines.collect::<Vec<_>>().join("\n")
}

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn expand(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap().to_string()];
    };
    let inside = rest.rsplit_once('}').map_or(rest, |r| r.0);
    let (mut depth, mut part, mut parts) = (0, String::new(), vec![]);
    for c in inside.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            parts.push(std::mem::take(&mut part));
        } else {
            part.push(c);
        }
    }
    parts.push(part);
    let named = parts.iter().filter(|p| !p.is_empty());
    named
        .flat_map(|p| expand(p))
        .map(|p| format!("{head}{p}"))
        .collect()
}

/// Paths that a text names: in `use`, and where they stand.
fn paths(text: &str) -> Vec<String> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = vec![];
    let mut rest = text;
    while let Some(at) = rest.find("use ") {
        let whole = !rest[..at].ends_with(word);
        rest = &rest[at + 4..];
        if whole && let Some(end) = rest.find(';') {
            let tree: String = rest[..end].split_whitespace().collect::<Vec<_>>().join(" ");
            found.extend(expand(
                &tree
                    .replace(", ", ",")
                    .replace("{ ", "{")
                    .replace(" }", "}"),
            ));
        }
    }
    for root in ["crate::", "super::", "self::"] {
        for (at, _) in text.match_indices(root) {
            let path = |c: char| word(c) || c == ':';
            if !text[..at].ends_with(path) {
                found.push(text[at..].chars().take_while(|c| path(*c)).collect());
            }
        }
    }
    found
}

/// Files that each file imports from, by module.
fn imports(modules: &Modules) -> BTreeMap<&Vec<String>, BTreeSet<&Vec<String>>> {
    let of = |own: &Vec<String>, file: &Path| {
        let mut all = BTreeSet::new();
        for path in paths(&code(file)) {
            let mut words: Vec<&str> = path.split("::").map(str::trim).collect();
            let mut full: Vec<String> = match words[0] {
                "crate" => vec![],
                "self" | "super" => own.clone(),
                child => match modules.contains_key(&[&own[..], &[child.to_string()]].concat()) {
                    true => {
                        words.insert(0, "self");
                        own.clone()
                    }
                    false => continue,
                },
            };
            for word in words {
                match word {
                    "crate" | "self" => {}
                    "super" => drop(full.pop()),
                    word => full.push(word.to_string()),
                }
            }
            // names in a file are that file
            while !modules.contains_key(&full) && !full.is_empty() {
                full.pop();
            }
            if let Some((module, _)) = modules.get_key_value(&full)
                && module != own
            {
                all.insert(module);
            }
        }
        all
    };
    modules.iter().map(|(m, f)| (m, of(m, f))).collect()
}

#[test]
fn folders_of_the_engine_import_downwards() {
    let modules = modules(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let floor = |folder: &str| FLOORS.iter().position(|f| f.contains(&folder));
    let mut wrong = vec![];
    for (module, all) in imports(&modules) {
        let Some(own) = module.first() else { continue };
        let here = floor(own).unwrap_or_else(|| panic!("the floor of {own} is not known"));
        for other in all.iter().filter_map(|m| m.first()).filter(|o| *o != own) {
            if floor(other).is_none_or(|there| there >= here) {
                wrong.push(format!("{} imports from {other}", module.join("/")));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Files that can be reached from each other. What the face of a folder (`mod.rs`, or the file of its name) says of the
/// folder's own files, their declaration and what is handed on, ties nothing.
fn circles(modules: &Modules) -> Vec<Vec<String>> {
    let imports = imports(modules);
    let reached = |from: &Vec<String>| {
        let mut all: BTreeSet<&Vec<String>> = BTreeSet::new();
        let mut next = vec![from.clone()];
        while let Some(module) = next.pop() {
            for other in &imports[&module] {
                let own = other.len() > module.len() && other.starts_with(&module);
                if !own && all.insert(other) {
                    next.push((*other).clone());
                }
            }
        }
        all
    };
    let all: BTreeMap<_, _> = modules.keys().map(|m| (m, reached(m))).collect();
    let mut found: BTreeSet<Vec<String>> = BTreeSet::new();
    for (module, ways) in &all {
        if ways.contains(module) {
            let back = ways.iter().filter(|w| all[**w].contains(module));
            found.insert(back.map(|m| m.join("/")).collect());
        }
    }
    found.into_iter().collect()
}

#[test]
fn no_circle_of_files() {
    let mut wrong = vec![];
    let mut known = BTreeSet::new();
    for root in crates() {
        for circle in circles(&modules(&root)) {
            let reason = CIRCLES
                .iter()
                .find(|(file, _)| circle.iter().any(|c| c == file));
            match reason {
                Some((file, _)) => drop(known.insert(*file)),
                None => wrong.push(format!("{}: {}", root.display(), circle.join(", "))),
            }
        }
    }
    assert!(wrong.is_empty(), "files import each other: {wrong:#?}");
    assert_eq!(
        known.len(),
        CIRCLES.len(),
        "a circle is gone: take it from the list"
    );
}

#[test]
fn a_circle_is_seen() {
    let folder = std::env::temp_dir().join(format!("peridyne-house-{}", std::process::id()));
    fs::create_dir_all(folder.join("part")).unwrap();
    let files = [
        ("lib.rs", "mod a;\nmod part;\n"),
        ("a.rs", "use crate::part::{b::B, c};\n"),
        ("part/mod.rs", "pub mod b;\npub mod c;\npub use b::B;\n"),
        ("part/b.rs", "// use crate::a;\npub struct B;\n"),
        ("part/c.rs", "fn f() -> crate::a::A { super::B }\n"),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    let found = circles(&modules(&folder));
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(found, [["a", "part/c"]]);
}
