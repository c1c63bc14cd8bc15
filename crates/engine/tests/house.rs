//! The order of the house: folders of the engine import downwards only, no files import each other in a circle, and what is one of many (a potential, a law, a field) is one file and a line in the list of its folder.

use peridyne::law::descriptor::Shelved;
use peridyne::law::fan;
use peridyne::law::material::{self, Material};
use peridyne::law::potential::{self, Described};
use peridyne::observe::observables;
use std::any::type_name;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the engine, from the ground up; those of one line do not know each other.
const FLOORS: &[&[&str]] = &[
    &["quantity"],
    &["error"],
    &["execute"],
    &["state"],
    &["space", "columns", "expression"],
    &["spec"],
    &["body"],
    &["family"],
    &["law"],
    &["interaction"],
    &["fracture"],
    &["condition", "dynamics", "statics"],
    &["transfer"],
    &["observe"],
    &["run"],
];

/// Files of the engine that still import each other in a circle, faces that hold code among them: they may only become fewer.
const IN_CIRCLES: &[&str] = &[
    "body",
    "body/several",
    "condition/indenter",
    "condition/indenter/rub",
    "execute/lane",
    "execute/lane/avx2",
    "execute/lane/avx512",
    "execute/lane/eight",
    "execute/lane/pair",
    "family/neighbours/near",
    "family/neighbours/near/build",
    "interaction",
    "interaction/cohesion",
    "interaction/contact",
    "interaction/contact_forces",
    "interaction/contract",
    "interaction/friction",
    "interaction/history",
    "interaction/list",
    "interaction/list/assemble",
    "interaction/list/images",
    "interaction/list/kernel",
    "interaction/list/kernel/energies",
    "interaction/list/kernel/forces",
    "interaction/list/kernel/share",
    "interaction/material",
    "interaction/material/measured",
    "interaction/pull",
    "interaction/spin",
    "interaction/stencil",
    "interaction/stencil/assemble",
    "interaction/stencil/kernel",
    "interaction/stencil/kernel/chunk",
    "interaction/stencil/kernel/energies",
    "interaction/stencil/kernel/forces",
    "interaction/stencil/kernel/offsets",
    "interaction/stencil/kernel/share",
    "interaction/tangent",
    "law/fan",
    "law/fan/bulk",
    "law/fan/described",
    "law/fan/sites",
    "law/fan/tangent",
    "law/jet",
    "law/material",
    "law/material/bonds",
    "law/material/non_ordinary",
    "law/material/non_ordinary/bond",
    "law/material/non_ordinary/family",
    "law/material/thermoelastic",
    "law/material/thermoelastic_solid",
    "law/potential",
    "law/potential/bulk",
    "law/potential/cut",
    "law/potential/described",
    "law/potential/mixture",
    "law/slopes",
    "law/terms",
    "observe/observables",
    "observe/observables/temperature",
    "run",
    "run/atoms",
    "run/build",
    "run/build/bodies",
    "run/build/bonds",
    "run/build/made",
    "run/conditions",
    "run/constitutive",
    "run/constitutive/constants",
    "run/constitutive/pairs",
    "run/constitutive/shelf",
    "run/constitutive/shelf/atoms",
    "run/constitutive/shelf/materials",
    "run/equilibrium",
    "run/equilibrium/problem",
    "run/equilibrium/tried",
    "run/feasible",
    "run/gaps",
    "run/implicit",
    "run/model",
    "run/observation",
    "run/preload",
    "run/sets",
    "run/stages",
    "run/state_hash",
    "run/stepper",
    "run/stepper/increments",
    "run/stepper/newmark",
    "run/stepper/rest",
    "run/stepper/verlet",
    "run/system",
    "run/system/watch",
    "run/time_step",
    "run/torn",
    "run/traits",
    "run/traits/system",
    "run/transfers",
    "run/transfers/expansion",
    "run/transfers/make",
    "space/membership",
    "space/membership/compile",
    "state",
    "state/archive",
];

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

/// Code without comments, tests, and modules that visibilities name.
fn code(file: &Path) -> String {
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
struct Sources(BTreeMap<Vec<String>, Source>);

impl Sources {
    fn of(modules: &Modules) -> Sources {
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
    fn imports(&self, declared: bool) -> BTreeMap<&Vec<String>, BTreeSet<Vec<String>>> {
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
    fn is_plain_face(&self, module: &[String]) -> bool {
        let lists = [("fn", "each"), ("trait", "Kinds"), ("const", "ALL")];
        let mut others = self.0.keys();
        others.any(|o| o.len() > module.len() && o.starts_with(module))
            && declared(&self.0[module].text).is_subset(&lists.into())
    }
}

#[test]
fn folders_of_the_engine_import_downwards() {
    let modules = modules(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let floor = |folder: &str| FLOORS.iter().position(|f| f.contains(&folder));
    let mut wrong = vec![];
    for (module, all) in Sources::of(&modules).imports(false) {
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
/// folder's own files, their declaration and what is handed on, ties nothing, unless it holds code of its own.
fn circles(modules: &Modules) -> Vec<Vec<String>> {
    let sources = Sources::of(modules);
    let imports = sources.imports(true);
    let plain: BTreeSet<_> = modules
        .keys()
        .filter(|m| sources.is_plain_face(m))
        .collect();
    let reached = |from: &Vec<String>| {
        let mut all: BTreeSet<&Vec<String>> = BTreeSet::new();
        let mut next = vec![from];
        while let Some(module) = next.pop() {
            for other in &imports[module] {
                let own = other.len() > module.len() && other.starts_with(module);
                if !(own && plain.contains(module)) && all.insert(other) {
                    next.push(other);
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
    let (mut wrong, mut left) = (vec![], BTreeSet::new());
    for root in crates() {
        let engine = root == Path::new(env!("CARGO_MANIFEST_DIR")).join("../engine/src");
        for circle in circles(&modules(&root)) {
            let known = |file: &String| engine && IN_CIRCLES.contains(&&**file);
            match circle.iter().all(known) {
                true => left.extend(circle),
                false => wrong.push(format!("{}: {}", root.display(), circle.join(", "))),
            }
        }
    }
    assert!(wrong.is_empty(), "files import each other: {wrong:#?}");
    let gone: Vec<_> = IN_CIRCLES.iter().filter(|f| !left.contains(**f)).collect();
    assert!(gone.is_empty(), "out of the circles: {gone:#?}");
}

#[test]
fn a_circle_is_seen() {
    let folder = std::env::temp_dir().join(format!("peridyne-house-{}", std::process::id()));
    for part in ["part", "face"] {
        fs::create_dir_all(folder.join(part)).unwrap();
    }
    let files = [
        ("lib.rs", "mod a;\nmod part;\n"),
        ("a.rs", "use crate::part::{b::B, c};\n"),
        ("part/mod.rs", "pub mod b;\npub use b::B;\npub use d::*;\n"),
        ("part/b.rs", "// use crate::a;\npub struct B;\n"),
        ("part/c.rs", "fn f() -> crate::a::A { super::B }\n"),
        // by what the face hands on
        ("part/d.rs", "use super::e::E;\npub struct D;\n"),
        ("part/e.rs", "use super::D;\npub struct E;\n"),
        // a face with code
        ("face/mod.rs", "mod g;\npub use g::G;\npub fn f() {}\n"),
        (
            "face/g.rs",
            "pub(in crate::face) struct G;\nfn g() { super::f() }\n",
        ),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    let found = circles(&modules(&folder));
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(
        found,
        [["a", "part/c"], ["face", "face/g"], ["part/d", "part/e"]]
    );
}

/// A name in code outside of the file that it belongs to and of the list of its folder, and why it may be there.
const ELSEWHERE: &[(&str, &str, &str)] = &[
    (
        "Thermoelastic",
        "engine/src/run/constitutive/general.rs",
        "what pmb is among the laws of law/material",
    ),
    (
        "ThermoelasticSolid",
        "engine/src/run/constitutive/general.rs",
        "what lps is among the laws of law/material",
    ),
    (
        "elastic_plastic",
        "lammps/src/model/types.rs",
        "the law of LAMMPS's peri/eps",
    ),
    (
        "viscoelastic",
        "lammps/src/model/types.rs",
        "the law of LAMMPS's peri/ves",
    ),
    (
        "elastic_plastic",
        "io/src/convert/laws.rs",
        "a model of Peridigm or PeriLab",
    ),
    (
        "correspondence",
        "io/src/convert/laws.rs",
        "a model of Peridigm or PeriLab",
    ),
    (
        "hypoelastic",
        "io/src/convert/laws.rs",
        "a model of Peridigm or PeriLab",
    ),
    (
        "hypoelastic_plastic",
        "io/src/convert/laws.rs",
        "a model of Peridigm or PeriLab",
    ),
    (
        "lennard_jones",
        "cli/src/upscale/crystal.rs",
        "reduced units are those of this potential",
    ),
    (
        "lennard_jones",
        "theory/src/gradient/power_law.rs",
        "its chain in exact fractions, which the papers print",
    ),
    (
        "lennard_jones",
        "lammps/src/command/molecular.rs",
        "LAMMPS has another word for it",
    ),
    (
        "morse",
        "lammps/src/command/molecular.rs",
        "a word of LAMMPS",
    ),
    (
        "buckingham",
        "lammps/src/command/molecular.rs",
        "LAMMPS has another word for it",
    ),
    ("eam", "lammps/src/command/molecular.rs", "a word of LAMMPS"),
    (
        "no_potential",
        "engine/src/run/constitutive/shelf/atoms.rs",
        "a message says what to write",
    ),
    (
        "lennard_jones",
        "io/src/continuum/potential.rs",
        "the other words of --potential",
    ),
    (
        "eam",
        "io/src/continuum/potential.rs",
        "the other words of --potential",
    ),
    (
        "stillinger_weber",
        "lammps/src/command/molecular.rs",
        "LAMMPS has another word for it",
    ),
    (
        "tersoff",
        "lammps/src/command/molecular.rs",
        "a word of LAMMPS",
    ),
    (
        "eam",
        "io/src/deck/lower/atoms.rs",
        "a module: the format of files",
    ),
    (
        "eam",
        "io/src/deck/lower/files.rs",
        "a module: the format of files",
    ),
    (
        "eam",
        "io/src/write/setfl.rs",
        "a module: the format of files",
    ),
];

/// All names of everything on a list.
#[derive(Default)]
struct Listed(Vec<String>);

impl Listed {
    fn put(&mut self, name: &str, of: &str) {
        // a law of bonds or of gradients is the path inside what makes a material of it
        let law = of.rsplit(['<', ',', '>']).find(|p| p.contains("::"));
        let own = law.unwrap().rsplit("::").next().unwrap();
        self.0.extend([name.to_string(), own.to_string()]);
    }
}

impl potential::Kinds for Listed {
    fn kind<P: Described>(&mut self) {
        self.put(P::NAME, type_name::<P>());
    }
}

impl fan::Kinds for Listed {
    fn fan<F: fan::Described>(&mut self) {
        self.put(F::NAME, type_name::<F>());
    }
}

impl material::Kinds for Listed {
    fn law<M: Shelved + Material<1> + Material<2> + Material<3>>(&mut self) {
        self.put(&M::descriptor().name, type_name::<M>());
    }
    fn solid<M: Shelved + Material<2> + Material<3>>(&mut self) {
        self.put(&M::descriptor().name, type_name::<M>());
    }
}

fn has_word(text: &str, word: &str) -> bool {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(letter) && !text[at + word.len()..].starts_with(letter)
    })
}

/// Code of all crates without tests, by the path from the folder of the crates.
fn sources() -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    for root in crates() {
        let name = root
            .parent()
            .unwrap()
            .file_name()
            .unwrap()
            .to_str()
            .unwrap();
        for file in modules(&root).values() {
            let path = file.strip_prefix(&root).unwrap().to_str().unwrap();
            all.insert(format!("{name}/src/{path}"), code(file));
        }
    }
    all
}

/// Does code know a name: as its own word or as a whole string, not in a sentence for people, nor where it declares a module?
fn knows(text: &str, name: &str) -> bool {
    let lines = text.lines();
    let mut lines = lines.filter(|l| *l != format!("pub mod {name};"));
    lines.any(|line| {
        let mut parts = line.split('"').enumerate();
        parts.any(|(n, part)| match n % 2 {
            0 => has_word(part, name),
            _ => part == name,
        })
    })
}

/// Files of `folder` and others that know a name.
fn touched(
    sources: &BTreeMap<String, String>,
    folder: &str,
    word: &str,
) -> (Vec<String>, Vec<String>) {
    let known = sources.iter().filter(|(_, text)| knows(text, word));
    known
        .map(|(path, _)| path.clone())
        .partition(|path| path.starts_with(folder))
}

#[test]
fn a_law_or_potential_is_a_file_and_a_line() {
    let sources = sources();
    let mut potentials = Listed::default();
    let (mut fans, mut laws) = (Listed::default(), Listed::default());
    potential::each(&mut potentials);
    fan::each(&mut fans);
    material::each(&mut laws);
    assert!(potentials.0.len() >= 12 && fans.0.len() >= 4 && laws.0.len() >= 8);
    let (mut wrong, mut used) = (vec![], BTreeSet::new());
    for (listed, folder) in [
        (potentials, "engine/src/law/potential/"),
        (fans, "engine/src/law/fan/"),
        (laws, "engine/src/law/material/"),
    ] {
        for word in &listed.0 {
            let (own, others) = touched(&sources, folder, word);
            // a list, that of a folder inside too
            let files: Vec<&String> = own.iter().filter(|f| !f.ends_with("/mod.rs")).collect();
            if files.len() != 1 {
                wrong.push(format!("{word} is known to {files:?}"));
            }
            for path in others {
                match ELSEWHERE.iter().find(|(w, p, _)| w == word && *p == path) {
                    Some(known) => drop(used.insert(known)),
                    None => wrong.push(format!("{word} is known to {path}")),
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(
        used.len(),
        ELSEWHERE.len(),
        "one is gone: take it from the list"
    );
}

#[test]
fn a_field_of_points_is_a_file_and_a_line() {
    let sources = sources();
    let folder = "engine/src/observe/observables/";
    let files = sources.keys().filter(|p| p.starts_with(folder)).count();
    assert_eq!(
        files,
        observables::ALL.len() + 1,
        "a file each, and their list"
    );
    let mut wrong = vec![];
    for observable in observables::ALL {
        let name = &*observable.declaration.name;
        assert!(
            sources.contains_key(&format!("{folder}{name}.rs")),
            "{name}"
        );
        // by its module, that is; who wants its values asks for the column by name
        let ways = [
            format!("{name}::OBSERVABLE"),
            format!("observables::{name}::"),
        ];
        for (path, text) in &sources {
            let list = *path == format!("{folder}mod.rs");
            if !list && ways.iter().any(|way| text.contains(way)) {
                wrong.push(format!("{name} is known to {path}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_stepper_is_a_file_and_a_line() {
    let sources = sources();
    let folder = "engine/src/run/stepper/";
    let list = format!("{folder}mod.rs");
    let lines = sources[&list].lines();
    let steppers = lines.filter_map(|l| l.strip_prefix("use self::")?.strip_suffix(';'));
    let steppers: Vec<_> = steppers.filter_map(|l| l.split_once("::")).collect();
    assert!(steppers.len() >= 4, "{steppers:?}");
    let mut wrong = vec![];
    for (file, name) in steppers {
        let own = format!("{folder}{file}.rs");
        let engine = sources.iter().filter(|(p, _)| p.starts_with("engine/"));
        let others = engine.filter(|(p, text)| **p != own && **p != list && knows(text, name));
        wrong.extend(others.map(|(path, _)| format!("{name} is known to {path}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// What the middle of the house is made of, and where it stands: fields, inherent methods and the files that these are in, as many as there
/// are, which may only become fewer. None but `System` has more than 16 fields.
const MIDDLE: &[(&str, &str, [usize; 3])] = &[
    ("model.rs", "impl<const D: usize> Model<D> {", [6, 16, 7]),
    (
        "system/mod.rs",
        "impl<const D: usize> System<D> {",
        [21, 103, 25],
    ),
    ("names.rs", "impl<const D: usize> Names<D> {", [5, 4, 2]),
    ("stages.rs", "impl<const D: usize> Stages<D> {", [3, 4, 1]),
    (
        "equilibrium/problem.rs",
        "impl<const D: usize> Problem<'_, D> {",
        [1, 45, 11],
    ),
];
/// Methods of `Simulation`, `Steered` and `Examined`. Where they are to end: 20, 12 and 10.
const ASKED: [usize; 3] = [20, 15, 10];
/// Lines of a function.
const LONG: usize = 120;
/// Functions that are longer, with their lines: none may be added, and none may grow.
const LONGER: &[(&str, &str, usize)] = &[];

/// Names of functions, how they are set in, and their lines.
fn functions(text: &str) -> Vec<(String, usize, usize)> {
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

/// A block of the source from the line that begins with this on.
fn block<'a>(text: &'a str, begin: &str) -> &'a str {
    let at = text.find(begin).unwrap_or_else(|| panic!("{begin}"));
    let end = text[at..].find("\n}").unwrap_or(text.len() - at);
    &text[at..at + end]
}

#[test]
fn the_middle_of_the_house_only_shrinks() {
    let run = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/run");
    let (mut open, mut files) = (vec![run.clone()], vec![]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => open.push(path),
                false => files.push(path),
            }
        }
    }
    let texts = files.iter().map(|f| fs::read_to_string(f).unwrap());
    let texts: Vec<String> = texts.collect();
    let own = MIDDLE.iter().map(|(file, begin, _)| {
        let name = begin.split_once("> ").unwrap().1.split('<').next().unwrap();
        let text = fs::read_to_string(run.join(file)).unwrap();
        let fields = block(&text, &format!("struct {name}<")).lines().skip(1);
        let fields = fields.filter(|l| {
            let code = l.trim_start();
            l.starts_with("    ") && !code.starts_with("//") && code.contains(": ")
        });
        let methods = texts.iter().map(|text| {
            let begin = format!("\n{begin}");
            let blocks = text.split(&begin).skip(1);
            let methods = blocks.map(|b| {
                let end = b.find("\n}").unwrap_or(b.len());
                functions(&b[..end]).iter().filter(|f| f.1 == 4).count()
            });
            methods.sum::<usize>()
        });
        let methods: Vec<usize> = methods.filter(|n| *n > 0).collect();
        (name, [fields.count(), methods.iter().sum(), methods.len()])
    });
    let own: Vec<_> = own.collect();
    let asked = fs::read_to_string(run.join("mod.rs")).unwrap();
    let asked = ["Simulation", "Steered", "Examined"].map(|name| {
        let text = block(&asked, &format!("pub trait {name}"));
        functions(text).iter().filter(|f| f.1 == 4).count()
    });
    let mut long = vec![];
    for root in crates() {
        let mut open = vec![root.clone()];
        while let Some(folder) = open.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    open.push(path);
                } else if path.extension().is_some_and(|e| e == "rs") {
                    let text = fs::read_to_string(&path).unwrap();
                    let name = path.strip_prefix(root.parent().unwrap().parent().unwrap());
                    let name = name.unwrap().to_str().unwrap().to_string();
                    let all = functions(&text).into_iter().filter(|f| f.2 > LONG);
                    long.extend(all.map(|f| (name.clone(), f.0, f.2)));
                }
            }
        }
    }
    let too_long = long.iter().filter(|(file, name, lines)| {
        let known = LONGER.iter().find(|k| k.0 == file && k.1 == name);
        known.is_none_or(|k| *lines > k.2)
    });
    let too_long: Vec<_> = too_long.collect();
    assert!(
        too_long.is_empty(),
        "functions over {LONG} lines: {too_long:#?}"
    );
    let gone: Vec<_> = LONGER
        .iter()
        .filter(|k| {
            !long
                .iter()
                .any(|(file, name, lines)| k.0 == file && k.1 == name && *lines == k.2)
        })
        .collect();
    assert!(gone.is_empty(), "say how short they are now: {gone:#?}");
    for ((name, found), (.., said)) in own.iter().zip(MIDDLE) {
        assert_eq!(
            found, said,
            "fields, methods and files of {name}: the numbers of today stand here"
        );
        assert!(found[0] <= 16 || *name == "System", "{name} is too much");
    }
    assert_eq!(asked, ASKED, "methods of Simulation, Steered, Examined");
}

/// Files whose methods of one structure may call each other in a circle.
const CIRCLE: usize = 6;

/// Files of methods of a structure that can be reached from each other by calls.
#[test]
fn no_large_circle_of_methods() {
    let run = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/run");
    let texts: Vec<(PathBuf, String)> = modules(&run)
        .into_values()
        .map(|file| (file.clone(), fs::read_to_string(&file).unwrap()))
        .collect();
    for (_, begin, _) in MIDDLE {
        // the methods of each file, as text
        let own = texts.iter().filter_map(|(file, text)| {
            let begin = format!("\n{begin}");
            let blocks = text.split(&begin).skip(1);
            let text: String = blocks
                .map(|b| &b[..b.find("\n}").unwrap_or(b.len())])
                .collect();
            (!text.is_empty()).then_some((file, text))
        });
        let own: Vec<_> = own.collect();
        let names = own.iter().enumerate().flat_map(|(n, (_, text))| {
            let all = functions(text).into_iter().filter(|f| f.1 == 4);
            all.map(move |f| (f.0, n))
        });
        let home: BTreeMap<String, usize> = names.collect();
        let calls = |text: &str| -> BTreeSet<usize> {
            let own = |at: &usize| ["self", "system"].iter().any(|r| text[..*at].ends_with(r));
            let dots = text.match_indices('.').map(|(at, _)| at).filter(own);
            let words = dots.map(|at| {
                let rest = &text[at + 1..];
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
                rest.split_at(end.unwrap_or(rest.len()))
            });
            let called = words.filter(|(_, after)| after.starts_with('('));
            called
                .filter_map(|(name, _)| home.get(name))
                .copied()
                .collect()
        };
        let next: Vec<_> = own.iter().map(|(_, text)| calls(text)).collect();
        let reached = |from: usize| {
            let (mut all, mut open) = (BTreeSet::new(), vec![from]);
            while let Some(n) = open.pop() {
                open.extend(next[n].iter().filter(|m| all.insert(**m)));
            }
            all
        };
        let ways: Vec<BTreeSet<usize>> = (0..own.len()).map(reached).collect();
        for (n, way) in ways.iter().enumerate() {
            let circle = way.iter().filter(|m| ways[**m].contains(&n));
            let circle: Vec<_> = circle.map(|m| own[*m].0).collect();
            assert!(circle.len() <= CIRCLE, "{begin} {circle:#?}");
        }
    }
}
