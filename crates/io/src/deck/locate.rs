//! Places of spec entries in the deck.

use super::renamed;
use super::source::Source;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// Keys of one material; a table under `material` with none of them holds named materials.
const MATERIAL: [&str; 7] = [
    "set", "density", "mass", "law", "fracture", "heat", "species",
];

/// Name that the material of `[material]` gets.
const UNNAMED: &str = "material";

fn is_one_material(table: &DeTable) -> bool {
    table.is_empty()
        || table.iter().any(|(key, value)| {
            MATERIAL.contains(&key.get_ref().as_ref()) || !value.get_ref().is_table()
        })
}

/// Gives the material of a plain `[material]` its name, so that the deck always holds named materials.
pub(super) fn name_material(tree: &mut DeTable) {
    let Some(entry) = tree.get_mut("material") else {
        return;
    };
    let span = entry.span();
    if let DeValue::Table(table) = entry.get_mut()
        && is_one_material(table)
    {
        let one = std::mem::take(table);
        table.insert(
            Spanned::new(span.clone(), UNNAMED.into()),
            Spanned::new(span, DeValue::Table(one)),
        );
    }
}

/// Where the other bodies of `[[body]]` go: no key that anybody types.
const MORE_BODIES: &str = "[[body]]";

/// Puts the bodies of `[[body]]` after the first under a key of their own.
pub(super) fn first_body<'a>(tree: &mut DeTable<'a>) {
    let Some(entry) = tree.get_mut("body") else {
        return;
    };
    let DeValue::Array(bodies) = entry.get_mut() else {
        return;
    };
    if bodies.is_empty() {
        return;
    }
    let all = std::mem::replace(bodies, DeArray::new());
    let span = all[0].span();
    let mut rest = DeArray::new();
    let mut first = None;
    for body in all {
        match first {
            None => first = Some(body),
            Some(_) => rest.push(body),
        }
    }
    if let Some(first) = first {
        *entry = first;
    }
    tree.insert(
        Spanned::new(span.clone(), MORE_BODIES.into()),
        Spanned::new(span, DeValue::Array(rest)),
    );
}

/// A set that a region of the deck makes is called after its entry: `"boundary condition 2"` is `boundary_condition[1].region`. Other
/// sets that the deck does not write come with the body's file.
fn made_set(tree: &DeTable, path: &str) -> Option<String> {
    let name = path.strip_prefix("sets.")?;
    let written = tree.get("sets").and_then(|s| s.get_ref().as_table());
    if written.is_some_and(|sets| sets.contains_key(name)) {
        return None;
    }
    let tables = [
        ("boundary condition", "boundary_condition"),
        ("initial", "initial"),
    ];
    let entry = tables.into_iter().find_map(|(called, key)| {
        let number: usize = name.strip_prefix(called)?.trim_start().parse().ok()?;
        Some(format!("{key}[{}].region", number.checked_sub(1)?))
    });
    Some(entry.unwrap_or_else(|| "body.file".into()))
}

/// The key in the deck of a top-level entry of the spec.
fn deck_key(spec_key: &str) -> &str {
    match spec_key {
        "materials" => "material",
        "precracks" => "precrack",
        "bonds" => "bond_stiffness",
        "conditions" => "boundary_condition",
        "rigid_bodies" => "rigid_body",
        "probes" => "probe",
        "potentials" => "pair",
        "schedule" => "run",
        other => other,
    }
}

pub(super) fn locate(source: &Source, path: &str) -> Option<Range<usize>> {
    let tree = source.tree().ok()?;
    let made = made_set(tree.get_ref(), path);
    let path = made.as_deref().unwrap_or(path);
    let path = path.replace('[', ".").replace(']', "");
    let path = match path.split_once('.') {
        Some((first, rest)) => format!("{}.{rest}", deck_key(first)),
        None => deck_key(&path).to_string(),
    };
    let path = renamed::path(&path).unwrap_or(path);
    let mut segments = path.split('.').filter(|s| !s.is_empty());
    let first = segments.next()?;
    let top = match first {
        "section" => ["thickness", "area"]
            .into_iter()
            .find_map(|key| tree.get_ref().get(key)),
        key => tree.get_ref().get(key),
    }?;
    let mut here = top;
    for segment in segments {
        let index = segment.parse::<usize>().ok();
        let next = match here.get_ref() {
            DeValue::Array(items) => index.and_then(|i| items.get(i)),
            DeValue::Table(table)
                if std::ptr::eq(here, top) && first == "material" && is_one_material(table) =>
            {
                // one unnamed material is the deck's `material` itself
                if index == Some(0) || segment == UNNAMED {
                    continue;
                }
                table.get(segment)
            }
            DeValue::Table(table) => match index {
                Some(i) if !table.contains_key(segment) => table.values().nth(i),
                _ => table.get(segment),
            },
            _ => None,
        };
        match next {
            Some(next) => here = next,
            None => break,
        }
    }
    Some(here.span())
}
