//! A potential on the command line: its keys are those of decks, and take the way of all decks. Of several kinds of atoms it is the elements
//! of files, or the materials of a deck.

use super::kinds::Kind;
use super::units::Units;
use crate::deck::{Deck, DeckError, Flag};
use crate::read::text_of;
use peridyne::law::descriptor::{Descriptor, Value};
use peridyne::law::terms::Sites;
use peridyne::run::Registry;
use peridyne::spec::BondedSpec;
use std::path::Path;
use std::sync::Arc;

/// A potential, term by term, and what its file says of atoms.
pub struct Model {
    pub name: String,
    pub sites: Box<dyn Sites>,
    /// As `sites` counts them.
    pub kinds: Vec<Kind>,
    /// What the deck bonds whatever moves.
    pub bonded: Option<Arc<BondedSpec>>,
    /// Of the deck, with the thickness of its plane or the section of its line (length, length²); 3 and 1 without one.
    pub dimension: usize,
    pub section: f64,
}

impl Model {
    /// [`beyond`] of the body of the deck.
    pub fn beyond(&self) -> f64 {
        beyond(self.dimension, self.section)
    }
}

/// Extent of a plane or a line along each axis that it does not have, by its thickness or section (length).
pub(super) fn beyond(dimension: usize, section: f64) -> f64 {
    libm::pow(section, 1.0 / (3 - dimension).max(1) as f64)
}

/// What a user says of a potential.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    pub name: String,
    pub with: Vec<(String, String)>,
    /// One, or one for each element.
    pub files: Vec<String>,
    /// In order of the types of frames.
    pub elements: Vec<String>,
}

/// Other names.
const ALSO: [(&str, &str); 1] = [("lj", "lennard_jones")];
/// Kinds of files; the law is the one that takes tables.
const FILES: [&str; 5] = ["setfl", "funcfl", "eam/alloy", "eam/fs", "eam"];

/// The key that takes a file, and whether it is a table, which says mass and everything else.
fn file_key(of: &Descriptor) -> Option<(&'static str, bool)> {
    of.keys.iter().find_map(|k| match k.value {
        Value::Table => Some((k.name, true)),
        Value::Entries(_) => Some((k.name, false)),
        Value::Number(..)
        | Value::List(..)
        | Value::Direction
        | Value::Rows(_)
        | Value::Word(_)
        | Value::Formula(..)
        | Value::Name => None,
    })
}

fn reads_tables(of: &Descriptor) -> bool {
    file_key(of).is_some_and(|(_, table)| table)
}

/// Why there is no potential.
#[derive(Debug)]
pub enum ModelError {
    Deck(Box<DeckError>),
    Words(String),
}

impl From<String> for ModelError {
    fn from(words: String) -> ModelError {
        ModelError::Words(words)
    }
}

fn flag(name: &str, key: &str, value: String) -> Flag {
    Flag {
        name: format!("--{name}"),
        key: key.into(),
        value,
    }
}

/// A body for materials that are on none, in whose unit cubes a mass is a density: `sets` are the places of the materials.
fn stage(sets: &[String]) -> Vec<Flag> {
    let mut flags = vec![
        flag("potential", "body.lattice", "\"cubic\"".into()),
        flag("potential", "body.spacing", "1".into()),
        flag("potential", "body.cells", "[1, 1, 1]".into()),
        flag("potential", "run.steps", "1".into()),
    ];
    for set in sets {
        let key = format!("sets.{set:?}.random");
        flags.push(flag("potential", &key, "{ part = 0.5, seed = 1 }".into()));
    }
    flags
}

/// The potential that a user names.
///
/// # Errors
/// No such potential, constants that do not fit it, a file that cannot be read, no cut-off.
pub fn model(words: &Words, units: Units) -> Result<Model, ModelError> {
    let registry = Registry::standard();
    let potentials = || {
        registry
            .descriptors()
            .filter(|d| registry.is_potential(&d.name))
    };
    let also = ALSO.iter().find(|(other, _)| *other == words.name);
    let found = match FILES.contains(&words.name.as_str()) {
        true => potentials().find(|d| reads_tables(d)),
        false => {
            let name = also.map_or(words.name.as_str(), |(_, name)| name);
            potentials().find(|d| d.name == name)
        }
    };
    let Some(descriptor) = found else {
        let all: Vec<&str> = potentials().map(|d| d.name.as_ref()).collect();
        return Err(format!(
            "there is no potential named {}; known are {}, and setfl, funcfl with --file FILE",
            words.name,
            all.join(", ")
        )
        .into());
    };
    let deck = Deck::of_flags(&flags(words, descriptor, units)?);
    let deck = deck.map_err(|e| ModelError::Deck(Box::new(e)))?;
    let mut made = of_spec(&deck, &words.name)?;
    let tables = reads_tables(descriptor);
    for (n, kind) in made.kinds.iter_mut().enumerate() {
        // names of materials are places here
        kind.names.clear();
        kind.element = kind.element.take().or(words.elements.get(n).cloned());
        let density = deck.spec.materials[n].density;
        kind.mass = Some(density / units.mass()).filter(|m| tables && *m > 0.0);
    }
    Ok(made)
}

/// The deck of a potential on the command line.
fn flags(words: &Words, of: &Descriptor, units: Units) -> Result<Vec<Flag>, ModelError> {
    let key = &of.name;
    let file = file_key(of);
    let wrong = |message: String| Err(ModelError::Words(message));
    let count = words.elements.len().max(words.files.len()).max(1);
    match file {
        Some(_) if !words.files.is_empty() && units == Units::Real => {
            return wrong("files of potentials are read in Å and eV, those that say `UNITS: real` too, whose kcal/mol are converted: use --units metal".into());
        }
        Some((_, true)) if words.files.is_empty() => {
            return wrong(format!("{key} needs a file: --file FILE"));
        }
        None if !words.files.is_empty() => {
            return wrong(format!(
                "{key} reads no file: give its constants by --with KEY=VALUE"
            ));
        }
        Some(_) | None => {}
    }
    if count > 1 && words.files.is_empty() {
        return wrong(format!(
            "{count} elements need a file that knows them: --file FILE; constants of several kinds stand in a deck, --model DECK"
        ));
    }
    let [files, elements] = [words.files.len(), words.elements.len()];
    if files > 1 && elements > 0 && files != elements {
        return wrong(format!(
            "{files} files and {elements} elements: give one file, or one for each element in the same order"
        ));
    }
    let names: Vec<String> = (0..count).map(|n| format!("type{:03}", n + 1)).collect();
    let sets = if count > 1 { &names[..] } else { &[] };
    let mut flags = vec![flag("units", "units", format!("{:?}", units.deck().name()))];
    flags.extend(stage(sets));
    for (n, name) in names.iter().enumerate() {
        let material = match count {
            1 => "material".to_string(),
            _ => format!("material.{name}"),
        };
        let law = format!("{material}.law.{key}");
        flags.push(flag("potential", &law, "{}".into()));
        if let (Some((of, _)), Some(first)) = (file, words.files.first()) {
            let own = words.files.get(n).unwrap_or(first);
            flags.push(flag("file", &format!("{law}.{of}"), format!("{own:?}")));
        }
        if !file.is_some_and(|(_, table)| table) {
            flags.push(flag("potential", &format!("{material}.mass"), "1".into()));
        }
        if let Some(element) = words.elements.get(n) {
            flags.push(flag(
                "element",
                &format!("{law}.element"),
                format!("{element:?}"),
            ));
        }
        for (name, value) in &words.with {
            let mut with = flag("with", &format!("{law}.{name}"), value.clone());
            with.name = format!("--with {name}");
            flags.push(with);
        }
    }
    Ok(flags)
}

/// The potentials between the materials of a deck, which may have nothing but `units`, `[material]`, `[[pair]]` and `mixing`; and the
/// units of the deck.
///
/// # Errors
/// The deck is wrong, or its materials are no atoms.
pub fn of_deck(path: &Path) -> Result<(Model, Units), ModelError> {
    let (text, name) = text_of(path).map_err(|e| format!("--model {e}"))?;
    // what is wrong with the text the deck says, with its line
    let written: toml::Table = text.parse().unwrap_or_default();
    let bare = !written.contains_key("body");
    let (flags, unknown) = match bare {
        true => lacking(&written),
        false => (vec![], vec![]),
    };
    let deck = Deck::with_flags(&text, &name, &flags);
    let deck = deck.map_err(|e| ModelError::Deck(Box::new(e)))?;
    let units = Units::Deck(deck.units);
    let mut made = of_spec(&deck, &name)?;
    if !bare {
        let space = &deck.spec.space;
        (made.dimension, made.section) = (space.dimension, space.section);
    }
    for (n, (kind, mass)) in made.kinds.iter_mut().zip(deck.masses()).enumerate() {
        let name = &deck.spec.materials[n].name;
        kind.mass = mass
            // of a plane or a line per its thickness or section
            .map(|m| m * made.section / units.mass())
            .filter(|_| !unknown.contains(name));
    }
    Ok((made, units))
}

/// What a deck without a body lacks, and the materials that do not say their mass.
fn lacking(written: &toml::Table) -> (Vec<Flag>, Vec<String>) {
    let registry = Registry::standard();
    let none = toml::Table::new();
    let materials = written.get("material").and_then(|m| m.as_table());
    let materials = materials.unwrap_or(&none);
    if materials.contains_key("law") {
        let mut flags = stage(&[]);
        return match has_mass(materials, &registry) {
            true => (flags, vec![]),
            false => {
                flags.push(flag("model", "material.mass", "1".into()));
                (flags, vec!["material".into()])
            }
        };
    }
    let (mut sets, mut masses, mut unknown) = (vec![], vec![], vec![]);
    for (name, material) in materials {
        let Some(material) = material.as_table() else {
            continue;
        };
        let set = material.get("set").and_then(|s| s.as_str());
        sets.push(set.unwrap_or(name).to_string());
        if !has_mass(material, &registry) {
            let key = format!("material.{name:?}.mass");
            masses.push(flag("model", &key, "1".into()));
            unknown.push(name.clone());
        }
    }
    let own: Vec<String> = match sets.len() > 1 {
        true => sets,
        false => sets.into_iter().filter(|s| s != "all").collect(),
    };
    let written = written.get("sets").and_then(|s| s.as_table());
    let own = own.into_iter();
    let own: Vec<String> = own
        .filter(|s| written.is_none_or(|w| !w.contains_key(s)))
        .collect();
    let mut flags = stage(&own);
    flags.extend(masses);
    (flags, unknown)
}

/// Does a material say its mass, or the file of its law?
fn has_mass(material: &toml::Table, registry: &Registry) -> bool {
    let law = material.get("law").and_then(|l| l.as_table());
    let mut names = law.into_iter().flat_map(|l| l.keys());
    let of_file = names.any(|name| registry.descriptor(name).is_some_and(reads_tables));
    of_file || material.contains_key("mass") || material.contains_key("density")
}

fn of_spec(deck: &Deck, name: &str) -> Result<Model, ModelError> {
    let registry = Registry::standard();
    let kind = |n: usize| {
        let material = &deck.spec.materials[n];
        let mut names = vec![material.name.clone(), material.set.clone()];
        names.dedup();
        Kind {
            names,
            element: deck.named.get(n).cloned().flatten(),
            mass: None,
        }
    };
    for material in &deck.spec.materials {
        let Some(potential) = material.law.potential() else {
            return Err(format!("{name}: its materials are no atoms").into());
        };
        if potential.cut_off().is_infinite() {
            return Err(format!(
                "{} has no cut-off: give --with cutoff=LENGTH",
                potential.name
            )
            .into());
        }
    }
    let sites = registry.sites_of(&deck.spec);
    let sites = sites.map_err(|e| ModelError::Deck(Box::new(deck.explain(&e))))?;
    Ok(Model {
        name: name.to_string(),
        sites,
        kinds: (0..deck.spec.materials.len()).map(kind).collect(),
        bonded: deck.spec.interactions.bonded.clone(),
        dimension: 3,
        section: 1.0,
    })
}
