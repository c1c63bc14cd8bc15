//! A potential on the command line: its keys are those of decks, and take the way of all decks.

use super::units::Units;
use crate::deck::{Deck, DeckError, Flag};
use crate::read::Atoms;
use peridyne::law::descriptor::{Descriptor, Value};
use peridyne::law::terms::Sites;
use peridyne::run::Shelf;

/// A potential, term by term, and what its file says of atoms.
pub struct Model {
    pub name: String,
    pub sites: Box<dyn Sites>,
    /// The element that it is made for, where it says so.
    pub element: Option<String>,
    /// Mass of its atoms in the user's units, where its file says so.
    pub mass: Option<f64>,
}

impl Model {
    /// The kind that a species is for the potential.
    ///
    /// # Errors
    /// In words: a species that it does not know.
    pub fn kind(&self, name: &str, atoms: &Atoms) -> Result<u32, String> {
        let numbered = name.parse::<u32>().is_ok();
        if let Some(own) = &self.element
            && !numbered
            && own != name
        {
            return Err(format!(
                "the frame has {name}, which {} does not know: it is of {own}",
                self.name
            ));
        }
        let mut used: Vec<u32> = atoms.kind.clone();
        used.sort_unstable();
        used.dedup();
        if used.len() > 1 {
            let names: Vec<_> = used
                .iter()
                .map(|k| &*atoms.species[*k as usize].name)
                .collect();
            return Err(format!(
                "the frame has {} kinds of atoms, {}: {} knows one",
                names.len(),
                names.join(", "),
                self.name
            ));
        }
        Ok(0)
    }
}

/// What a user says of a potential.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Words {
    pub name: String,
    pub with: Vec<(String, String)>,
    pub file: Option<String>,
    pub element: Option<String>,
}

/// Other names.
const ALSO: [(&str, &str); 1] = [("lj", "lennard_jones")];
/// Kinds of files; the law is the one that takes tables.
const FILES: [&str; 4] = ["setfl", "funcfl", "eam/alloy", "eam"];

/// The key that takes a file, and whether it is a table, which says mass and everything else.
fn file_key(of: &Descriptor) -> Option<(&'static str, bool)> {
    of.keys.iter().find_map(|k| match k.value {
        Value::Table => Some((k.name, true)),
        Value::Entries(_) => Some((k.name, false)),
        Value::Number(..) | Value::List(..) | Value::Rows(_) | Value::Word(_) | Value::Name => None,
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

/// The potential that a user names.
///
/// # Errors
/// No such potential, constants that do not fit it, a file that cannot be read, no cut-off.
pub fn model(words: &Words, units: Units) -> Result<Model, ModelError> {
    let shelf = Shelf::standard();
    let potentials = || shelf.descriptors().filter(|d| shelf.is_potential(&d.name));
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
    let key = &descriptor.name;
    let flag = |name: &str, key: &str, value: String| Flag {
        name: format!("--{name}"),
        key: key.into(),
        value,
    };
    let mut flags = vec![
        flag("units", "units", format!("{:?}", units.deck().name())),
        flag("potential", &format!("material.law.{key}"), "{}".into()),
        flag("potential", "body.lattice", "\"cubic\"".into()),
        flag("potential", "body.spacing", "1".into()),
        flag("potential", "body.cells", "[1, 1, 1]".into()),
        flag("potential", "run.steps", "1".into()),
    ];
    let of = file_key(descriptor);
    match (of, &words.file) {
        (Some(_), Some(_)) if units == Units::Real => {
            return Err("files of potentials are in Å and eV: use --units metal"
                .to_string()
                .into());
        }
        (Some((of, _)), Some(file)) => {
            let place = format!("material.law.{key}.{of}");
            flags.push(flag("file", &place, format!("{file:?}")));
        }
        (Some((_, true)), None) => return Err(format!("{key} needs a file: --file FILE").into()),
        (Some((_, false)) | None, None) => {}
        (None, Some(_)) => {
            return Err(
                format!("{key} reads no file: give its constants by --with KEY=VALUE").into(),
            );
        }
    }
    let tables = of.is_some_and(|(_, table)| table);
    if !tables {
        flags.push(flag("potential", "material.mass", "1".into()));
    }
    if let Some(element) = &words.element {
        let place = format!("material.law.{key}.element");
        flags.push(flag("element", &place, format!("{element:?}")));
    }
    for (name, value) in &words.with {
        let place = format!("material.law.{key}.{name}");
        let mut with = flag("with", &place, value.clone());
        with.name = format!("--with {name}");
        flags.push(with);
    }
    let deck = Deck::of_flags(&flags).map_err(|e| ModelError::Deck(Box::new(e)))?;
    let Some(spec) = deck.spec.potential() else {
        return Err(format!("{key} is no potential").into());
    };
    if spec.cut_off().is_infinite() {
        return Err(format!("{key} has no cut-off: give --with cutoff=LENGTH").into());
    }
    let sites = shelf.sites(spec).map_err(|e| e.to_string())?;
    // an atom in a cube of edge 1
    let of_file = tables.then(|| {
        let density = deck.spec.materials.first().map_or(f64::NAN, |m| m.density);
        density / units.mass()
    });
    Ok(Model {
        name: words.name.clone(),
        sites,
        element: { deck.named.first().cloned().flatten() }.or(words.element.clone()),
        mass: of_file.filter(|m| *m > 0.0),
    })
}
