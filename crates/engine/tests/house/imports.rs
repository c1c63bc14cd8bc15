//! What files import from each other.

use crate::reading::{Modules, code};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// `a::{b, c::d}` as `a::b` and `a::c::d`.
fn expand(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else {
        return vec![tree.to_string()];
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

/// Paths that a text names: in `use`, with the name that it gives them (`*`: all that is there), and where they stand.
fn paths(text: &str) -> Vec<(String, Option<String>)> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let (mut found, mut others) = (vec![], String::new());
    let mut rest = text;
    while let Some(at) = rest.find("use ") {
        let whole = !rest[..at].ends_with(word);
        others += &rest[..at];
        rest = &rest[at + 4..];
        if whole && let Some(end) = rest.find(';') {
            let tree: String = rest[..end].split_whitespace().collect::<Vec<_>>().join(" ");
            let tree = tree
                .replace(", ", ",")
                .replace("{ ", "{")
                .replace(" }", "}");
            found.extend(expand(&tree).into_iter().map(|leaf| {
                let (path, name) = leaf.split_once(" as ").unwrap_or((&leaf, ""));
                let path = path.strip_suffix("::self").unwrap_or(path);
                let last = path.rsplit("::").next().unwrap();
                let name = if name.is_empty() { last } else { name };
                (path.to_string(), Some(name.to_string()))
            }));
            rest = &rest[end..];
        }
    }
    others += rest;
    for root in ["crate::", "super::", "self::"] {
        for (at, _) in others.match_indices(root) {
            let path = |c: char| word(c) || c == ':';
            if !others[..at].ends_with(path) {
                let path: String = others[at..].chars().take_while(|c| path(*c)).collect();
                found.push((path, None));
            }
        }
    }
    found
}

/// What a file declares at its top, with its kind; of an `impl` what follows it.
fn declared(text: &str) -> BTreeSet<(&str, &str)> {
    let kinds = [
        "fn", "struct", "enum", "trait", "type", "const", "static", "impl",
    ];
    let item = |line| {
        let line: &str = match str::strip_prefix(line, "pub") {
            Some(rest) => rest.split_once(' ')?.1,
            None => line,
        };
        let functions = ["const fn ", "unsafe fn "];
        let line = match functions.iter().any(|f| line.starts_with(f)) {
            true => line.split_once(' ')?.1,
            false => line,
        };
        let kind = kinds.into_iter().find(|k| {
            let after = line.strip_prefix(k);
            after.is_some_and(|a| a.starts_with([' ', '<']))
        })?;
        let name = line[kind.len()..].trim_start_matches([' ', '<']);
        let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
        Some((kind, &name[..end.unwrap_or(name.len())]))
    };
    text.lines().filter_map(item).collect()
}

/// A file: what it declares, and the paths that it names, from the root of the crate.
struct Source {
    text: String,
    names: Vec<(Vec<String>, Option<String>)>,
}

/// The files of a crate.
pub struct Sources(BTreeMap<Vec<String>, Source>);

impl Sources {
    pub fn of(modules: &Modules) -> Sources {
        let of = |own: &Vec<String>, file: &Path| {
            let text = code(file);
            let names = paths(&text).into_iter().filter_map(|(path, name)| {
                let mut words: Vec<&str> = path.split("::").map(str::trim).collect();
                let mut full: Vec<String> = match words[0] {
                    "crate" => vec![],
                    "self" | "super" => own.clone(),
                    child => {
                        let child = [&own[..], &[child.to_string()]].concat();
                        modules.contains_key(&child).then_some(())?;
                        words.insert(0, "self");
                        own.clone()
                    }
                };
                for word in words {
                    match word {
                        "crate" | "self" | "" => {}
                        "super" => drop(full.pop()),
                        word => full.push(word.to_string()),
                    }
                }
                Some((full, name))
            });
            let names = names.collect();
            Source { text, names }
        };
        Sources(modules.iter().map(|(m, f)| (m.clone(), of(m, f))).collect())
    }

    /// The file that a path names; names in a file are that file.
    fn file<'a>(&self, path: &'a [String]) -> &'a [String] {
        let mut full = path;
        while !self.0.contains_key(full) && !full.is_empty() {
            full = &full[..full.len() - 1];
        }
        full
    }

    /// Where what a path names is declared: a file hands names on that it imports.
    fn declares(&self, path: &[String], seen: &mut BTreeSet<Vec<String>>) -> Vec<String> {
        let file = self.file(path);
        let rest = &path[file.len()..];
        let Some(name) = rest.first() else {
            return file.to_vec();
        };
        let Some(source) = self.0.get(file) else {
            return file.to_vec();
        };
        let is_here = |of: &Source| {
            declared(&of.text)
                .iter()
                .any(|(kind, n)| *kind != "impl" && n == name)
        };
        if is_here(source) || !seen.insert(path[..=file.len()].to_vec()) {
            return file.to_vec();
        }
        let mut handed = source.names.iter();
        let by_name = handed.find(|(_, own)| own.as_ref() == Some(name));
        if let Some((from, _)) = by_name {
            return self.declares(&[from, &rest[1..]].concat(), seen);
        }
        let all = source.names.iter();
        let all = all.filter(|(from, own)| own.as_deref() == Some("*") && !from.is_empty());
        for (from, _) in all {
            let from = &from[..from.len() - 1];
            if self.0.get(from).is_some_and(is_here) {
                return self.declares(&[from, rest].concat(), seen);
            }
        }
        file.to_vec()
    }

    /// Files that each file imports from, by module; where `declared`, those that declare what it imports.
    pub fn imports(&self, declared: bool) -> BTreeMap<&Vec<String>, BTreeSet<Vec<String>>> {
        let of = |own: &Vec<String>, source: &Source| {
            let all = source.names.iter().map(|(path, name)| {
                let path = match name.as_deref() {
                    Some("*") => &path[..path.len() - 1],
                    _ => path,
                };
                match declared {
                    true => self.declares(path, &mut BTreeSet::new()),
                    false => self.file(path).to_vec(),
                }
            });
            all.filter(|m| m != own && self.0.contains_key(m)).collect()
        };
        self.0.iter().map(|(m, s)| (m, of(m, s))).collect()
    }

    /// Is a file the face of a folder, with nothing of its own but lists of what the folder has?
    pub fn is_plain_face(&self, module: &[String]) -> bool {
        let lists = [("fn", "each"), ("trait", "Kinds"), ("const", "ALL")];
        let mut others = self.0.keys();
        others.any(|o| o.len() > module.len() && o.starts_with(module))
            && declared(&self.0[module].text).is_subset(&lists.into())
    }
}
