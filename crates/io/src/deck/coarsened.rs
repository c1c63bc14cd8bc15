//! The deck of a coarsened body: the old deck on the points and micromoduli of a file.

use super::Deck;
use super::upscaled::{Rewritten, table};
use toml::{Table, Value};

/// What belongs to the old body and its law.
const GONE: [&str; 16] = [
    "bond_stiffness",
    "toughness",
    "healing",
    "horizon",
    "influence",
    "partial_volume_correction",
    "calibration",
    "family",
    "precrack",
    "contact",
    "initial_velocities",
    "interface",
    "bond_mixing",
    "periodic",
    "rigid_body",
    "surface",
];

/// Keys of sets that mean points of the old body, and what such a set is.
const OF_POINTS: [(&str, &str); 3] = [
    ("block", "a block of the old file"),
    ("basis", "sites of the old lattice's cell"),
    ("random", "drawn from the old points"),
];

/// Sets that belong to the old points: those that nothing names any more are left out.
///
/// # Errors
/// One is named.
fn sets(table: &mut Table) -> Result<(), String> {
    let Some(mut sets) = table.remove("sets") else {
        return Ok(());
    };
    let mut wrong = None;
    if let Some(all) = sets.as_table_mut() {
        all.retain(|name, set| {
            let what = OF_POINTS.iter().find(|(key, _)| set.get(*key).is_some());
            let named = { table.iter() }.any(|(key, v)| key != "title" && names(v, name));
            if let (Some((_, what)), true) = (what, named) {
                wrong.get_or_insert(format!(
                    "sets.{name} is {what}: give it a region, or where, so that coarse points have it, too"
                ));
            }
            what.is_none()
        });
    }
    table.insert("sets".into(), sets);
    wrong.map_or(Ok(()), Err)
}

/// Is the name one of the texts of a value?
fn names(value: &Value, name: &str) -> bool {
    match value {
        Value::String(text) => text == name,
        Value::Array(all) => all.iter().any(|v| names(v, name)),
        Value::Table(all) => all.values().any(|v| names(v, name)),
        Value::Integer(_) | Value::Float(_) | Value::Boolean(_) | Value::Datetime(_) => false,
    }
}

/// The deck on the linear body in `file` (beside it): the same sets, conditions and schedule.
///
/// # Errors
/// What of the deck does not go with given micromoduli, in words.
pub fn coarsened(deck: &Deck, file: &str, level: usize) -> Result<Rewritten, String> {
    let mut table = table(deck)?;
    if table.contains_key("rigid_body") {
        return Err("rigid_body: linear bodies have no contact".into());
    }
    for key in GONE {
        table.remove(key);
    }
    // files of atoms are not written of points
    if let Some(output) = table.get_mut("output").and_then(Value::as_table_mut) {
        output.remove("trajectory");
        output.remove("data");
    }
    let title = &deck.spec.title;
    let comma = if title.is_empty() { "" } else { ", " };
    table.insert(
        "title".into(),
        format!("{title}{comma}level {level}").into(),
    );
    table.insert(
        "dimension".into(),
        Value::Integer(deck.spec.space.dimension as i64),
    );
    let mut body = Table::new();
    body.insert("file".into(), file.into());
    table.insert("body".into(), Value::Table(body));
    let mut material = Table::new();
    material.insert("law".into(), "micromoduli".into());
    table.insert("material".into(), Value::Table(material));
    sets(&mut table)?;
    Ok(Rewritten {
        text: toml::to_string_pretty(&table).map_err(|e| e.to_string())?,
        files: vec![],
        notes: vec![],
    })
}
