//! The order of the house: folders of the engine import downwards only, files import each other in a circle only inside one
//! folder, and what is one of many (a potential, a law, a field) is one file and a line in the list of its folder.

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
        [21, 104, 25],
    ),
    ("names.rs", "impl<const D: usize> Names<D> {", [5, 3, 2]),
    ("stages.rs", "impl<const D: usize> Stages<D> {", [3, 4, 1]),
    (
        "equilibrium/problem.rs",
        "impl<const D: usize> Problem<'_, D> {",
        [1, 45, 11],
    ),
];
/// Methods of `Simulation`, `Steered` and `Examined`. Where they are to end: 20, 12 and 10.
const ASKED: [usize; 3] = [22, 17, 10];
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
