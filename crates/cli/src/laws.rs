//! `peridyne laws`: what a deck can name, read from its schema and the descriptors of laws, so that nothing is forgotten.

use crate::failure::{Failure, say};
use peridyne::columns::Dimension;
use peridyne::law::descriptor::{Bounds, Descriptor, Key, Need, Value};
use peridyne::run::Shelf;
use peridyne::space::lattice::LatticeKind;
use serde_json::Value as Json;
use std::fmt::Write;

/// Tables of names in this order, with where they stand; others follow.
const ORDER: [(&str, &str); 13] = [
    ("Fracture", "fracture (material.fracture)"),
    (
        "ReleaseName",
        "when a bond past its critical stretch lets go (material.fracture.release)",
    ),
    ("InfluenceName", "influence functions (influence)"),
    (
        "InterfaceName",
        "bonds between unlike materials (interface)",
    ),
    (
        "SurfaceName",
        "factors of bonds near the surface of a lattice body (surface)",
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
    "Mark",
];

pub fn print() -> Result<(), Failure> {
    let schema = peridyne_io::deck::schema();
    let none = serde_json::Map::new();
    let all = schema["$defs"].as_object().unwrap_or(&none);
    let others = all.iter().filter(|(name, table)| {
        let known = ORDER.iter().any(|(o, _)| o == name) || LEFT_OUT.contains(&name.as_str());
        !known && (table.get("oneOf").is_some() || table.get("enum").is_some())
    });
    let shelf = Shelf::standard();
    say(&format!(
        "laws (material.law)\n{}",
        named(shelf.descriptors())
    ));
    say(&format!(
        "forces on points (condition.force)\n{}",
        named(shelf.forces())
    ));
    let titled = ORDER.iter().map(|(name, title)| (*name, *title));
    for (name, title) in titled.chain(others.map(|(name, _)| (name.as_str(), name.as_str()))) {
        if let Some(table) = all.get(name) {
            say(&format!("{title}\n{}", names(table, all)));
        }
    }
    say("fields of points (output.fields), beside those that laws declare");
    for observable in peridyne::observe::observables::ALL {
        let declaration = &observable.declaration;
        let shape = match declaration.shape.components() {
            [] => String::new(),
            components => format!(" ({})", components.join(" ")),
        };
        let mut line = format!(
            "  {:<26} {}{shape}; {}",
            declaration.name, declaration.dimension, declaration.doc
        );
        if !observable.equation.is_empty() {
            let _ = write!(line, " {}", observable.equation);
        }
        if !observable.source.is_empty() {
            let _ = write!(line, " [{}]", observable.source);
        }
        say(&line);
    }
    say("lattices (body.lattice), spacing = edge of the cell (triangular: nearest neighbours)");
    for kind in LatticeKind::ALL {
        say(&format!(
            "  {:<14} {}-D, {} sites per cell, nearest neighbours at {:.4} spacings",
            kind.name(),
            kind.dimension(),
            kind.basis().len(),
            kind.nearest()
        ));
    }
    Ok(())
}

/// All of a list of the shelf with their keys; words that several share are explained at the first.
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
            let _ = writeln!(text, "  {:<16} {}", "", explain(key));
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

/// `young: Young's modulus E. (a pressure, positive; one of those)`.
fn explain(key: &Key) -> String {
    let number = |dimension: Dimension, bounds: &Bounds| match bounds {
        b if *b == Bounds::ANY => format!("{dimension}"),
        b => format!("{dimension}, {}", b.words()),
    };
    let value = match key.value {
        Value::Number(dimension, bounds) => number(dimension, &bounds),
        Value::List(count, dimension, bounds) => {
            format!("{count} numbers, each {}", number(dimension, &bounds))
        }
        Value::Rows(columns) => {
            let each = columns
                .iter()
                .map(|(name, d, b)| format!("{name} ({})", number(*d, b)));
            format!("rows of {}", each.collect::<Vec<_>>().join(", "))
        }
        Value::Direction => "three numbers or expressions of x, y, z".into(),
        Value::Word(words) => {
            let words: Vec<&str> = words.iter().map(|(w, _)| *w).collect();
            format!("one of {}", words.join(", "))
        }
        Value::Name => "a name".into(),
        Value::Formula(variables, dimension) => {
            let measures = dimension.map(|d| format!(", {d}")).unwrap_or_default();
            format!("an expression of {}{measures}", variables.join(", "))
        }
        Value::Table | Value::Entries(_) => "a file".into(),
    };
    let need = match key.need {
        Need::Given | Need::Refused => String::new(),
        Need::Default(x) => format!("; {x} when left out"),
        Need::Word(word) => format!("; {word} when left out"),
        Need::Optional => "; may be left out".into(),
        Need::OneOf => "; one of these is given".into(),
        Need::TwoOf => "; two of these are given".into(),
    };
    format!("{}: {} ({value}{need})", key.name, key.doc)
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
        (false, false) => format!("keys: {}; may be left out: {}", list(must), list(may)),
    })
}
