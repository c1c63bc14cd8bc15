//! The deck of an upscaled model: the old deck with the numbers of the new specification.

use super::{Deck, Dim};
use peridyne::run::Shelf;
use peridyne::spec::{BodySpec, Horizon, Spec, TimeStep};
use serde::Deserialize;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// A deck that was made of another.
#[derive(Debug, Clone, PartialEq)]
pub struct Rewritten {
    pub text: String,
    /// Files that it names, which belong beside it: from where, and under which name.
    pub files: Vec<(PathBuf, String)>,
    /// What was left out, in words.
    pub notes: Vec<String>,
}

pub(super) fn table(deck: &Deck) -> Result<Table, String> {
    let tree = deck.source.tree().map_err(|e| e.to_string())?;
    Table::deserialize(toml::de::Deserializer::from(tree)).map_err(|e| e.to_string())
}

fn inner<'t>(table: &'t mut Table, key: &str) -> Option<&'t mut Table> {
    table.get_mut(key).and_then(Value::as_table_mut)
}

/// The one material of a deck.
fn material(table: &mut Table) -> Option<&mut Table> {
    let written = inner(table, "material")?;
    if written.contains_key("law") {
        return Some(written);
    }
    written
        .iter_mut()
        .next()
        .and_then(|(_, m)| m.as_table_mut())
}

/// Files of the deck beside it under their own names.
fn beside(deck: &Deck, table: &mut Table) -> Vec<(PathBuf, String)> {
    let folder = Path::new(deck.file()).parent().unwrap_or(Path::new(""));
    let mut files = vec![];
    let mut place = |value: Option<&mut Value>| {
        if let Some(Value::String(file)) = value {
            let from = folder.join(&*file);
            let name = Path::new(&*file)
                .file_name()
                .map_or_else(|| file.clone(), |n| n.to_string_lossy().into_owned());
            *file = name.clone();
            files.push((from, name));
        }
    };
    place(inner(table, "body").and_then(|b| b.get_mut("file")));
    let shelf = Shelf::standard();
    let law = material(table).and_then(|m| inner(m, "law"));
    for (name, constants) in law.into_iter().flatten() {
        let keys = shelf.descriptor(name).into_iter().flat_map(|d| &d.keys);
        for key in keys.filter(|k| k.value.is_file()) {
            place(constants.get_mut(key.name));
        }
    }
    files
}

/// The deck itself, with its files beside it.
///
/// # Errors
/// The deck's own, in words.
pub fn copied(deck: &Deck) -> Result<Rewritten, String> {
    let mut table = table(deck)?;
    let files = beside(deck, &mut table);
    Ok(Rewritten {
        text: toml::to_string_pretty(&table).map_err(|e| e.to_string())?,
        files,
        notes: vec![],
    })
}

/// The deck of `coarse`, which was made of the deck's specification with points `factor` times as far apart.
///
/// # Errors
/// What of the deck does not go with the factor, in words.
pub fn upscaled(deck: &Deck, coarse: &Spec, factor: u32) -> Result<Rewritten, String> {
    let mut table = table(deck)?;
    let files = beside(deck, &mut table);
    let mut notes = vec![];
    let plain = |value: f64, dim: Dim| Value::Float(value / deck.units.plain_factor(dim));
    let title = deck.spec.title.clone();
    table.insert(
        "title".into(),
        format!(
            "{title}{}upscaled {factor} times",
            if title.is_empty() { "" } else { ", " }
        )
        .into(),
    );
    let spacing = match &coarse.body {
        BodySpec::Lattice { spacing, .. } | BodySpec::Sites { spacing, .. } => *spacing,
        BodySpec::Cloud(_) | BodySpec::Several(_) => {
            return Err("only a lattice body can be upscaled".into());
        }
    };
    let body = inner(&mut table, "body").ok_or("the deck has no body")?;
    body.insert("spacing".into(), plain(spacing, Dim::LENGTH));
    if let Some(Value::Array(cells)) = body.get_mut("cells") {
        for n in cells {
            let count = n.as_integer().unwrap_or(0);
            if count % i64::from(factor) != 0 {
                return Err(format!(
                    "body.cells: {count} cells are not divisible by {factor}"
                ));
            }
            *n = Value::Integer(count / i64::from(factor));
        }
    }
    let horizon = match coarse.horizon {
        Horizon::Ratio(m) => {
            let mut ratio = Table::new();
            ratio.insert("m_ratio".into(), Value::Integer(i64::from(m)));
            Value::Table(ratio)
        }
        Horizon::Length(d) => plain(d, Dim::LENGTH),
    };
    table.insert("horizon".into(), horizon);
    if table.remove("thermal").is_some() {
        notes.push(
            "Temperature was left out: the coarse model has no thermal motion of its own.".into(),
        );
    }
    if coarse.potential().is_some() {
        table.insert("family".into(), "stencil".into());
        let density = plain(coarse.materials[0].density, Dim::DENSITY);
        let material = material(&mut table).ok_or("the deck has no material")?;
        material.remove("mass");
        material.insert("density".into(), density);
        let law = inner(material, "law").ok_or("the material has no law")?;
        law_numbers(law, deck, coarse);
    }
    let run = inner(&mut table, "run").ok_or("the deck has no run")?;
    if let TimeStep::Fixed(dt) = coarse.schedule.time_step {
        run.insert("time_step".into(), plain(dt, Dim::TIME));
    }
    if run.contains_key("steps") {
        run.insert("steps".into(), Value::Integer(coarse.schedule.steps as i64));
    }
    if let Some(output) = inner(&mut table, "output") {
        for key in ["every", "history"] {
            if let Some(Value::Integer(n)) = output.get_mut(key) {
                *n = (*n + i64::from(factor) - 1) / i64::from(factor);
            }
        }
    }
    Ok(Rewritten {
        text: toml::to_string_pretty(&table).map_err(|e| e.to_string())?,
        files,
        notes,
    })
}

/// The numbers of the coarse potential that are others into the law's table.
fn law_numbers(law: &mut Table, deck: &Deck, coarse: &Spec) {
    let shelf = Shelf::standard();
    let (Some(fine), Some(coarse)) = (deck.spec.potential(), coarse.potential()) else {
        return;
    };
    let (Some(descriptor), Some((_, Value::Table(inside)))) =
        (shelf.descriptor(&coarse.name), law.iter_mut().next())
    else {
        return;
    };
    for key in &descriptor.keys {
        let Some(new) = coarse.parameters.number(key.name) else {
            continue;
        };
        if let Some(dimension) = key.dimension()
            && fine.parameters.number(key.name) != Some(new)
        {
            let factor = deck.units.plain_factor(dimension);
            inside.insert(key.name.to_string(), Value::Float(new / factor));
        }
    }
}
