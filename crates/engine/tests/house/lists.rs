//! What is one of many is one file, and a line in the list of its folder.

use crate::reading::sources;
use peridyne::law::descriptor::Registered;
use peridyne::law::many_body;
use peridyne::law::material::{self, Material};
use peridyne::law::potential::{self, Described};
use peridyne::observe::observables;
use std::any::type_name;
use std::collections::{BTreeMap, BTreeSet};

/// A name in code outside of the file that it belongs to and of the list of its folder, and why it may be there.
const ELSEWHERE: &[(&str, &str, &str)] = &[
    (
        "Thermoelastic",
        "mechanics/src/constitutive/sweeps.rs",
        "what pmb is among the laws of law/material",
    ),
    (
        "Thermoelastic",
        "io/src/deck/lower/interface.rs",
        "bonds of unlike materials follow a rule, as those of pmb",
    ),
    (
        "ThermoelasticSolid",
        "mechanics/src/constitutive/sweeps.rs",
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
    ("pals", "io/src/deck/renamed.rs", "it had another name"),
    (
        "no_potential",
        "mechanics/src/constitutive/registry/atoms.rs",
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

impl many_body::Kinds for Listed {
    fn many_body<F: many_body::Described>(&mut self) {
        self.put(F::NAME, type_name::<F>());
    }
}

impl material::Kinds for Listed {
    fn law<M: Registered + Material<1> + Material<2> + Material<3>>(&mut self) {
        self.put(&M::descriptor().name, type_name::<M>());
    }
    fn solid<M: Registered + Material<2> + Material<3>>(&mut self) {
        self.put(&M::descriptor().name, type_name::<M>());
    }
}

fn has_word(text: &str, word: &str) -> bool {
    let letter = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].ends_with(letter) && !text[at + word.len()..].starts_with(letter)
    })
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
    let (mut many_body, mut laws) = (Listed::default(), Listed::default());
    potential::each(&mut potentials);
    many_body::each(&mut many_body);
    material::each(&mut laws);
    assert!(potentials.0.len() >= 12 && many_body.0.len() >= 4 && laws.0.len() >= 8);
    let (mut wrong, mut used) = (vec![], BTreeSet::new());
    for (listed, folder) in [
        (potentials, "mechanics/src/law/potential/"),
        (many_body, "mechanics/src/law/many_body/"),
        (laws, "mechanics/src/law/material/"),
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
    let folder = "mechanics/src/observe/observables/";
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
