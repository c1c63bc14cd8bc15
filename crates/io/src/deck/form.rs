//! Slips of form that are common, said in words before the deck is read key by key.

use super::error::DeckError;
use super::source::{SEVERAL, Source};
use crate::excerpt::steers;
use peridyne::run::Registry;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Tables that it has one of.
const ONE: [&str; 9] = [
    "healing",
    "run",
    "statics",
    "output",
    "initial_velocities",
    "heat",
    "species",
    "constants",
    "sets",
];

/// `kind` is a word of other decks than those of bodies.
pub(super) fn kind(source: &Source, deck: &DeTable) -> Result<(), DeckError> {
    let Some(at) = deck.get("kind") else {
        return Ok(());
    };
    let (message, help) = match at.get_ref().as_str() {
        Some("conservation_law") => (
            "a deck of a conservation law has no body",
            "it is for `peridyne run` and `peridyne check`",
        ),
        _ => (
            "this kind of deck is not known",
            "write kind = \"conservation_law\", or leave it out for a body",
        ),
    };
    Err(source.error(Some(at.span()), message, Some(help.into())))
}

pub(super) fn check(source: &Source, deck: &DeTable) -> Result<(), DeckError> {
    let error = |at: &Spanned<DeValue>, message: String, help: String| {
        Err(source.error(Some(at.span()), message, Some(help)))
    };
    for key in SEVERAL {
        if let Some(at) = deck.get(key)
            && at.get_ref().is_table()
        {
            let message = format!("a deck can have several of `{key}`: this is a list of tables");
            return error(
                at,
                message,
                format!("write [[{key}]], or {key} = [{{ … }}]"),
            );
        }
    }
    for key in ONE {
        if let Some(at) = deck.get(key)
            && tables(at)
        {
            let message = format!("a deck has one `{key}`, this is a list of tables");
            return error(at, message, format!("write [{key}]"));
        }
    }
    let Some(at) = deck.get("material") else {
        return Ok(());
    };
    if tables(at) {
        let message = "several materials have names".to_string();
        return error(
            at,
            message,
            "write [material.glass] and [material.steel], or one [material]".into(),
        );
    }
    let Some(material) = at.get_ref().as_table() else {
        return Ok(());
    };
    let registry = Registry::standard();
    let inner = material.values().filter_map(|m| m.get_ref().as_table());
    for table in std::iter::once(material).chain(inner) {
        let Some(law) = table.get("law") else {
            continue;
        };
        let known = |name: &str| {
            let found = registry.descriptor(name).filter(|d| !d.keys.is_empty());
            found.map(|d| (&d.name, &d.example))
        };
        if let DeValue::String(name) = law.get_ref()
            && let Some((name, keys)) = known(name)
        {
            let message = format!("the law \"{name}\" needs its constants");
            return error(law, message, format!("write law = {{ {name} = {keys} }}"));
        }
        if let DeValue::Table(one) = law.get_ref() {
            for (name, constants) in one {
                if let Some((name, keys)) = known(name.get_ref())
                    && !constants.get_ref().is_table()
                {
                    let message = format!("the constants of the law \"{name}\" are a table");
                    return error(
                        constants,
                        message,
                        format!("write law = {{ {name} = {keys} }}"),
                    );
                }
            }
        }
    }
    Ok(())
}

/// Keys and names become columns and files, and are told: they have one line, and nothing that steers a terminal.
pub(super) fn names(source: &Source, table: &DeTable) -> Result<(), DeckError> {
    let one = |text: &str, span: Range<usize>| {
        let Some(c) = text.chars().find(|c| steers(*c)) else {
            return Ok(());
        };
        let message = format!("this name has the control character {}", c.escape_unicode());
        let help = "write the name in letters, digits and blanks, on one line";
        Err(source.error(Some(span), message, Some(help.into())))
    };
    for (key, value) in table {
        one(key.get_ref(), key.span())?;
        if key.get_ref() == "name"
            && let DeValue::String(name) = value.get_ref()
        {
            one(name, value.span())?;
        }
        within(source, value.get_ref())?;
    }
    Ok(())
}

fn within(source: &Source, value: &DeValue) -> Result<(), DeckError> {
    match value {
        DeValue::Table(table) => names(source, table),
        DeValue::Array(items) => { items.iter() }.try_for_each(|v| within(source, v.get_ref())),
        _ => Ok(()),
    }
}

/// `[[key]]`, or a list of inline tables.
fn tables(at: &Spanned<DeValue>) -> bool {
    let list = at.get_ref().as_array();
    list.is_some_and(|items| items.iter().any(|i| i.get_ref().is_table()))
}
