//! The deck of an upscaled model: the old deck with the numbers of the new specification.

use super::{Deck, Dim};
use peridyne::law::many_body::FILE;
use peridyne::run::Registry;
use peridyne::spec::{BodySpec, FamilyChoice, Horizon, PotentialSpec, Spec, TimeStep};
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

/// The materials of a deck, in order.
fn materials(table: &mut Table) -> Option<Vec<&mut Table>> {
    let written = inner(table, "material")?;
    if written.contains_key("law") {
        return Some(vec![written]);
    }
    let mut named: Vec<(&String, &mut Table)> = { written.iter_mut() }
        .filter_map(|(name, m)| Some((name, m.as_table_mut()?)))
        .collect();
    named.sort_by_key(|(name, _)| (*name).clone());
    Some(named.into_iter().map(|(_, m)| m).collect())
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
            let entry = (from, name);
            if !files.contains(&entry) {
                files.push(entry);
            }
        }
    };
    place(inner(table, "body").and_then(|b| b.get_mut("file")));
    let registry = Registry::standard();
    for material in materials(table).into_iter().flatten() {
        for (name, constants) in inner(material, "law").into_iter().flatten() {
            let keys = registry.descriptor(name).into_iter().flat_map(|d| &d.keys);
            for key in keys.filter(|k| k.value.is_file()) {
                place(constants.get_mut(key.name));
            }
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

/// The deck of `coarse`, which was made of the deck's specification with points `factor` times as far apart. It ends at `end` (time), where that is
/// given, instead of after a number of steps.
///
/// # Errors
/// What of the deck does not go with the factor, in words.
pub fn upscaled(
    deck: &Deck,
    coarse: &Spec,
    factor: u32,
    end: Option<f64>,
) -> Result<Rewritten, String> {
    let mut table = table(deck)?;
    let mut files = beside(deck, &mut table);
    let mut notes = vec![];
    let title = deck.spec.title.clone();
    table.insert(
        "title".into(),
        format!(
            "{title}{}upscaled {factor} times",
            if title.is_empty() { "" } else { ", " }
        )
        .into(),
    );
    upscale_body(deck, coarse, factor, &mut table)?;
    let horizon = match coarse.bonds.horizon {
        Horizon::Ratio(m) => {
            let mut ratio = Table::new();
            ratio.insert("m_ratio".into(), Value::Integer(i64::from(m)));
            Value::Table(ratio)
        }
        Horizon::Length(d) => plain(deck, d, Dim::LENGTH),
    };
    table.insert("horizon".into(), horizon);
    if table.remove("initial_velocities").is_some() {
        notes.push(
            "Temperature is not transferred: the coarse model has no thermal motion of its own."
                .into(),
        );
    }
    if coarse.potential().is_some() {
        upscale_potentials(deck, coarse, &mut table)?;
        // a file whose rows became keys is no longer named
        let named = toml::to_string(&table).map_err(|e| e.to_string())?;
        files.retain(|(_, name)| named.contains(&**name));
    }
    upscale_times(deck, coarse, factor, end, &mut table);
    Ok(Rewritten {
        text: toml::to_string_pretty(&table).map_err(|e| e.to_string())?,
        files,
        notes,
    })
}

/// A number as the deck writes it without a unit.
fn plain(deck: &Deck, value: f64, dim: Dim) -> Value {
    Value::Float(value / deck.units.plain_factor(dim))
}

/// Spacing, origin and cells of the coarse body.
fn upscale_body(deck: &Deck, coarse: &Spec, factor: u32, table: &mut Table) -> Result<(), String> {
    let spacing = match &coarse.body {
        BodySpec::Lattice { spacing, .. } | BodySpec::Sites { spacing, .. } => *spacing,
        BodySpec::Cloud(_) | BodySpec::Several(_) => {
            return Err("only a lattice body can be upscaled".into());
        }
    };
    let body = inner(table, "body").ok_or("the deck has no body")?;
    body.insert("spacing".into(), plain(deck, spacing, Dim::LENGTH));
    // coarse points are points of the fine body
    if let BodySpec::Lattice { origin, .. } = &coarse.body
        && !body.contains_key("origin")
        && *origin != [0.0; 3]
    {
        let along = origin[..coarse.space.dimension].iter();
        let along = along.map(|c| plain(deck, *c, Dim::LENGTH));
        body.insert("origin".into(), Value::Array(along.collect()));
    }
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
    Ok(())
}

/// The family of atoms, their density, and the numbers of their potentials.
fn upscale_potentials(deck: &Deck, coarse: &Spec, table: &mut Table) -> Result<(), String> {
    match coarse.bonds.family {
        FamilyChoice::Neighbours => {
            // of atoms that are near now the cut-off is the potential's
            table.remove("horizon");
            table.remove("family");
        }
        FamilyChoice::Auto
        | FamilyChoice::Stencil
        | FamilyChoice::List
        | FamilyChoice::Reference => {
            table.insert("family".into(), "stencil".into());
        }
    }
    let written = materials(table).ok_or("the deck has no material")?;
    for (n, material) in written.into_iter().enumerate() {
        let [Some(fine), Some(new)] = [&deck.spec, coarse].map(|s| s.materials.get(n)) else {
            return Err("the deck has more materials than its body".into());
        };
        material.remove("mass");
        material.insert("density".into(), plain(deck, new.density, Dim::DENSITY));
        let law = inner(material, "law").ok_or("the material has no law")?;
        if let (Some(fine), Some(new)) = (fine.law.potential(), new.law.potential()) {
            law_numbers(law, deck, fine, new)?;
        }
    }
    if let Some(Value::Array(pairs)) = table.get_mut("pair") {
        let both = deck
            .spec
            .interactions
            .potentials
            .iter()
            .zip(&coarse.interactions.potentials);
        for (pair, (fine, new)) in pairs.iter_mut().zip(both) {
            let law = pair.as_table_mut().and_then(|p| inner(p, "law"));
            if let Some(law) = law {
                law_numbers(law, deck, &fine.potential, &new.potential)?;
            }
        }
    }
    Ok(())
}

/// Steps, and how often something is written.
fn upscale_times(deck: &Deck, coarse: &Spec, factor: u32, end: Option<f64>, table: &mut Table) {
    // statics have increments of load, which stay
    if let Some(run) = inner(table, "run") {
        if let TimeStep::Fixed(dt) = coarse.run.schedule.time_step {
            run.insert("time_step".into(), plain(deck, dt, Dim::TIME));
        }
        if let Some(end) = end {
            run.remove("steps");
            run.insert("duration".into(), plain(deck, end, Dim::TIME));
        } else if run.contains_key("steps") {
            run.insert(
                "steps".into(),
                Value::Integer(coarse.run.schedule.steps as i64),
            );
        }
    }
    let [before, after] = [&deck.spec, coarse].map(|spec| spec.run.schedule.steps as f64);
    let fewer = match deck.duration {
        _ if deck.spec.run.schedule.statics().is_some() => 1.0,
        // their number is not known before they run
        Some(_) => 1.0 / f64::from(factor),
        None => after / before,
    };
    if let Some(output) = inner(table, "output") {
        for key in ["every", "history"] {
            if let Some(Value::Integer(n)) = output.get_mut(key) {
                *n = ((*n as f64 * fewer).ceil() as i64).max(1);
            }
        }
    }
}

/// The numbers of the coarse potential that are others into the law's table.
///
/// # Errors
/// They are rows of a file that several elements share.
fn law_numbers(
    law: &mut Table,
    deck: &Deck,
    fine: &PotentialSpec,
    coarse: &PotentialSpec,
) -> Result<(), String> {
    let registry = Registry::standard();
    let (Some(descriptor), Some((_, Value::Table(inside)))) =
        (registry.descriptor(&coarse.name), law.iter_mut().next())
    else {
        return Ok(());
    };
    if let Some(rows) = coarse.parameters.rows(FILE) {
        let [row] = rows else {
            return Err(format!(
                "the constants of {} are those of a file with several elements, which has no coarse one: upscale a body of one element, or \
                 write the file of the coarse atoms yourself (lengths times the factor, energies times its cube)",
                coarse.name
            ));
        };
        // the kinds come first
        inside.clear();
        let columns = descriptor.keys.iter().filter(|k| k.dimension().is_some());
        for (key, number) in columns.zip(&row[3..]) {
            let factor = key.dimension().map_or(1.0, |d| deck.units.plain_factor(d));
            inside.insert(key.name.to_string(), Value::Float(number / factor));
        }
        return Ok(());
    }
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
    Ok(())
}
