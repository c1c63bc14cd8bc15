//! The deck of a coarsened body: the old deck on the points and micromoduli of a file.

use super::Deck;
use super::upscaled::{Rewritten, table};
use toml::{Table, Value};

/// What belongs to the old body and its law.
const GONE: [&str; 13] = [
    "bond_factor",
    "horizon",
    "influence",
    "volume_scaling",
    "calibration",
    "family",
    "precrack",
    "contact",
    "thermal",
    "interface",
    "periodic",
    "indenter",
    "surface",
];

/// The deck on the linear body in `file` (beside it): the same sets, conditions and schedule.
///
/// # Errors
/// What of the deck does not go with given micromoduli, in words.
pub fn coarsened(deck: &Deck, file: &str, level: usize) -> Result<Rewritten, String> {
    let mut table = table(deck)?;
    if table.contains_key("indenter") {
        return Err("indenter: linear bodies have no contact".into());
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
        Value::Integer(deck.spec.dimension as i64),
    );
    let mut body = Table::new();
    body.insert("file".into(), file.into());
    table.insert("body".into(), Value::Table(body));
    let mut material = Table::new();
    material.insert("law".into(), "micromoduli".into());
    table.insert("material".into(), Value::Table(material));
    let sets = table.get("sets").and_then(Value::as_table);
    if let Some((name, _)) = sets.and_then(|s| s.iter().find(|(_, s)| s.get("mark").is_some())) {
        return Err(format!(
            "sets.{name} is a mark of the old file: give it a region, so that coarse points have it, too"
        ));
    }
    Ok(Rewritten {
        text: toml::to_string_pretty(&table).map_err(|e| e.to_string())?,
        files: vec![],
        notes: vec![],
    })
}
