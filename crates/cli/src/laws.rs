//! `peridyne laws`: what a deck can name, read from its schema and the descriptors of laws, so that nothing is forgotten.

pub mod one;

use crate::doc;
use crate::failure::Failure;
use crate::pager::Paged;
use peridyne::columns::Declaration;
use peridyne::law::descriptor::{Descriptor, Value};
use peridyne::run::Registry;
use peridyne::space::lattice::LatticeKind;
use serde_json::Value as Json;
use std::fmt::Write;

/// Tables of names in this order, with where they stand; others follow.
const ORDER: [(&str, &str); 13] = [
    ("Fracture", "fracture (material.fracture)"),
    (
        "BreakageName",
        "when a bond past its critical stretch breaks (material.fracture.breakage)",
    ),
    ("InfluenceName", "influence functions (influence)"),
    (
        "BondMixingName",
        "bonds between unlike materials (bond_mixing)",
    ),
    (
        "SurfaceName",
        "surface corrections of a lattice body (surface)",
    ),
    (
        "CalibrationName",
        "calibration of the constants (calibration)",
    ),
    ("FamilyName", "families (family)"),
    ("Shape", "regions (region)"),
    ("MeasureName", "measures of probes (probe.measure)"),
    ("CrackName", "kinds of pre-crack (precrack.kind)"),
    ("MethodName", "methods of statics (statics.method)"),
    ("SolverName", "solvers of linear systems (statics.solver)"),
    (
        "Constants",
        "physical constants of metal units (units.constants)",
    ),
];

/// Said elsewhere, or plain.
const LEFT_OUT: [&str; 7] = [
    "Law",
    "Force",
    "LatticeName",
    "AxisName",
    "PlaneName",
    "UnitName",
    "Block",
];

#[derive(clap::Args)]
pub struct LawsArguments {
    /// A law, a force or a field: all that is known of it, with a deck that runs it.
    pub name: Option<String>,
    /// List the fields of points that output.fields, pictures and probes take: those of every body, and those that laws bring along.
    #[arg(long)]
    pub fields: bool,
    #[command(flatten)]
    pub paged: Paged,
}

pub fn laws(arguments: &LawsArguments) -> Result<(), Failure> {
    let registry = Registry::standard();
    let text = match (&arguments.name, arguments.fields) {
        (None, false) => list(&registry),
        (None, true) => fields(&registry),
        (Some(name), fields) => {
            let found = one::named(&registry, name);
            let [(_, law), ..] = found[..] else {
                // keys and fields are explained there
                return match fields {
                    false => doc::explained(name, arguments.paged),
                    true => Err(Failure::input(doc::unknown(name))),
                };
            };
            let each = found.iter();
            match fields {
                true => match one::field_lines(law, &registry) {
                    none if none.is_empty() => format!(
                        "{name} has no fields of its own; those of every body: peridyne laws --fields"
                    ),
                    own => own,
                },
                false => each
                    .map(|(place, law)| one::told(place, law, &registry))
                    .collect::<Vec<_>>()
                    .join("\n"),
            }
        }
    };
    arguments.paged.show(&text);
    Ok(())
}

/// The fields of every body.
fn usual_fields() -> String {
    let mut text = String::new();
    for observable in peridyne::observe::observables::ALL {
        let mut line = one::field_line(&observable.declaration);
        if !observable.equation.is_empty() {
            let _ = write!(line, " {}", observable.equation);
        }
        if !observable.source.is_empty() {
            let _ = write!(line, " [{}]", observable.source);
        }
        let _ = writeln!(text, "{line}");
    }
    text
}

/// All fields of points, law by law.
fn fields(registry: &Registry) -> String {
    let mut text = format!(
        "fields of points of every body (output.fields)\n{}",
        usual_fields()
    );
    let (mut own, mut none) = (String::new(), vec![]);
    // those of breaking bonds, with the laws that have them
    let mut broken: Vec<(Declaration, Vec<&str>)> = vec![];
    for law in registry.descriptors() {
        let all = one::fields(law, registry);
        let (breaks, always): (Vec<_>, Vec<_>) = all.into_iter().partition(|(_, b)| *b);
        match always.is_empty() {
            true => none.push(&*law.name),
            false => {
                let _ = writeln!(own, "fields of {}", law.name);
            }
        }
        for (column, _) in always {
            let _ = writeln!(own, "{}", one::field_line(&column));
        }
        for (column, _) in breaks {
            match broken.iter_mut().find(|(c, _)| c.name == column.name) {
                Some((_, laws)) => laws.push(&law.name),
                None => broken.push((column, vec![&law.name])),
            }
        }
    }
    let _ = writeln!(
        text,
        "fields of points whose bonds break (material.fracture)"
    );
    for (column, laws) in broken {
        let _ = writeln!(text, "{} Of {}.", one::field_line(&column), laws.join(", "));
    }
    let _ = writeln!(
        text,
        "{own}without fields of their own: {}",
        none.join(", ")
    );
    text
}

/// All that a deck can name.
fn list(registry: &Registry) -> String {
    let schema = peridyne_io::deck::schema();
    let none = serde_json::Map::new();
    let all = schema["$defs"].as_object().unwrap_or(&none);
    let others = all.iter().filter(|(name, table)| {
        let known = ORDER.iter().any(|(o, _)| o == name) || LEFT_OUT.contains(&name.as_str());
        !known && (table.get("oneOf").is_some() || table.get("enum").is_some())
    });
    let mut text = format!(
        "laws (material.law); peridyne laws NAME explains one, with a deck\n{}\n",
        named(registry.descriptors())
    );
    let _ = writeln!(
        text,
        "forces on points (boundary_condition.force)\n{}",
        named(registry.forces())
    );
    let titled = ORDER.iter().map(|(name, title)| (*name, *title));
    for (name, title) in titled.chain(others.map(|(name, _)| (name.as_str(), name.as_str()))) {
        if let Some(table) = all.get(name) {
            let _ = writeln!(text, "{title}\n{}", names(table, all));
        }
    }
    let _ = writeln!(
        text,
        "fields of points (output.fields); those that laws bring along: peridyne laws --fields\n{}",
        usual_fields()
    );
    let _ = writeln!(
        text,
        "lattices (body.lattice), spacing = edge of the cell (triangular: nearest neighbours)"
    );
    for kind in LatticeKind::ALL {
        let _ = writeln!(
            text,
            "  {:<14} {}-D, {} sites per cell, nearest neighbours at {:.4} spacings",
            kind.name(),
            kind.dimension(),
            kind.basis().len(),
            kind.nearest()
        );
    }
    text
}

/// All of a list of the registry with their keys; words that several share are explained at the first.
fn named<'a>(all: impl Iterator<Item = &'a Descriptor>) -> String {
    let mut text = String::new();
    let mut explained: Vec<&[(&str, &str)]> = vec![];
    for d in all {
        let source = match &*d.source {
            "" => String::new(),
            source => format!(" [{source}]"),
        };
        let _ = writeln!(text, "  {:<14} {}{source}", d.name, d.doc);
        for key in d.taken() {
            let _ = writeln!(text, "  {:<16} {}", "", one::explain(key));
            if let Value::Word(words) = key.value
                && !explained.contains(&words)
            {
                explained.push(words);
                for (word, said) in words {
                    let _ = writeln!(text, "  {:<18} {word}: {said}", "");
                }
            }
        }
    }
    text
}

/// One line for each name: what it is, and its keys; those that must be given are marked.
fn names(table: &Json, all: &serde_json::Map<String, Json>) -> String {
    let mut text = String::new();
    if let Some(keys) = keys(table, all) {
        let _ = writeln!(text, "  {keys}");
    }
    let one = std::slice::from_ref(table);
    let variants = table["oneOf"].as_array().map_or(one, Vec::as_slice);
    for variant in variants {
        let said = variant["description"]
            .as_str()
            .unwrap_or("")
            .replace('\n', " ");
        let line = |text: &mut String, name: &str| {
            let _ = writeln!(text, "{}", format!("  {name:<14} {said}").trim_end());
        };
        if let Some(name) = variant["const"].as_str() {
            line(&mut text, name);
        }
        let plain: Vec<&str> = variant["enum"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Json::as_str)
            .collect();
        if !plain.is_empty() {
            let _ = writeln!(text, "  {}", plain.join("   "));
        }
        if table.get("oneOf").is_some()
            && let Some(properties) = variant["properties"].as_object()
        {
            for (name, inner) in properties {
                line(&mut text, name);
                if let Some(keys) = keys(inner, all) {
                    let _ = writeln!(text, "  {:<14} {keys}", "");
                }
            }
        }
    }
    text
}

/// Keys of a table or of the table that it refers to.
fn keys(table: &Json, all: &serde_json::Map<String, Json>) -> Option<String> {
    let table = match table["$ref"].as_str() {
        Some(name) => all.get(name.rsplit('/').next()?)?,
        None => table,
    };
    let properties = table["properties"].as_object()?;
    let needed = |key: &str| {
        let required = table["required"].as_array();
        required.is_some_and(|r| r.iter().any(|k| k == key))
    };
    let (must, may): (Vec<&String>, Vec<&String>) = properties.keys().partition(|k| needed(k));
    let list = |keys: Vec<&String>| keys.into_iter().cloned().collect::<Vec<_>>().join(", ");
    Some(match (must.is_empty(), may.is_empty()) {
        (_, true) => format!("keys: {}", list(must)),
        (true, false) => format!("keys: {}", list(may)),
        (false, false) => format!("keys: {}; optional: {}", list(must), list(may)),
    })
}
